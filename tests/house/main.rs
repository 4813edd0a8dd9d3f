//! What ARCHITECTURE.md states about the packages and modules, checked by what their sources import and by what they do not mention.

mod documents;
mod imports;
mod sources;
mod words;
