//! The program from outside: commands, files and recordings as other programs meet them.

mod commands;
mod outside;
mod recordings;
mod runs;
mod support;
#[cfg(feature = "explorer")]
mod window;
