//! The `ambray` program.
fn main() {}
