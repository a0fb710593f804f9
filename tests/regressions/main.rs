//! Scenes are tests: each folder is run, its checks must hold, and its trace must have the bits it has always had.

mod allocation;
mod determinism;
mod parity;
mod scenes;
