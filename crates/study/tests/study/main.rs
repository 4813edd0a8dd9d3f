//! Study files, and what reads the files of others.

mod families;
mod pool;
mod robustness;
mod studies;
