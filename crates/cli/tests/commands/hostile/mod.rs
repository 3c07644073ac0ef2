//! Every command among hostile files: modules of Python in the working folder, outputs that are links, names that steer
//! a terminal. One table has all commands; one that is not in it fails a test.

mod bench;
mod commands;
mod kills;
mod links;
mod names;
