//! sincro
fn main() {}
