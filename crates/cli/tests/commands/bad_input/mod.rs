//! Wrong input: what the program says.
//!
//! Exit code 2 means that the input is wrong. The message goes to standard error, standard
//! output stays empty; a message about a TOML file names file, line, key, what was found and what is allowed.

mod files;
mod gear_files;
mod models;
mod pair_scenes;
mod system_scenes;
