//! The window, worked as a person would: by what it shows, its mouse and its keys.

mod exploring;
mod files;
mod panels;
mod scene;
mod support;
