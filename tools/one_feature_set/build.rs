//! Cargo takes the features of build-dependencies into account where there is a build script. Nothing is to be done.

fn main() {}
