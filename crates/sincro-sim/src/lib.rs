//! Scene files and the run.
