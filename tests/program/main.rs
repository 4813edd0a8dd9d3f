//! Tests of the program from outside: commands, files and recordings as other programs use them.

// Tests that need signals, links or faults of the kernel are compiled where these exist.
#![cfg_attr(not(target_os = "linux"), allow(unused_imports, dead_code))]

mod commands;
mod damage;
mod documents;
mod drivers;
mod exports;
mod faults;
mod fronts;
mod fuzzed;
mod handed_over;
mod identities;
mod injected;
mod merging;
mod motion;
mod outside;
mod reach;
mod recordings;
mod regions;
mod reports;
mod runs;
mod selected_drives;
mod strength;
mod support;
mod survival;
#[cfg(feature = "explorer")]
mod window;
mod wishes;
