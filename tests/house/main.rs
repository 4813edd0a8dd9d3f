//! What ARCHITECTURE.md states about the packages and modules, checked by what their sources import and by what they do not mention;
//! and what stands in several files alike.

mod documents;
mod imports;
mod locks;
mod sources;
mod words;
