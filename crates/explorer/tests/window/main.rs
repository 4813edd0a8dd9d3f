//! Tests that operate the window as a user would: by the text it shows, with the mouse and with keys.

mod asking;
mod clipping;
mod controls;
mod dragging;
mod dynamics;
mod exploring;
mod files;
mod motion;
mod panels;
mod questions;
mod scene;
mod support;
