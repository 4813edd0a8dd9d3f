//! The JSON that commands print and other programs rely on. Keys are a contract: new ones may be added, none may be renamed.

mod assembly_modes;
mod certificate;

pub use assembly_modes::AssemblyModesJson;
pub use certificate::CertificateJson;
