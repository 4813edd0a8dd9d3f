//! Tests of the program from outside: commands, files and recordings as other programs use them.

mod commands;
mod damage;
mod documents;
mod drivers;
mod exports;
mod faults;
mod handed_over;
mod injected;
mod merging;
mod motion;
mod outside;
mod recordings;
mod regions;
mod reports;
mod runs;
mod strength;
mod support;
mod survival;
#[cfg(feature = "explorer")]
mod window;
