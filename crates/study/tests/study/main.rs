//! Study files, and what reads the files of others.

mod robustness;
mod studies;
