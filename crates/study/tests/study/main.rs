//! Study files, and what reads the files of others.

mod families;
mod robustness;
mod studies;
