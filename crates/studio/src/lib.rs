#![doc = include_str!("../README.md")]

mod answer;
mod assets;
mod beginning;
mod bevel;
mod choice;
mod columns;
mod form;
mod form_field;
mod form_reach;
mod form_walk;
mod guard;
mod job;
mod latest;
mod modes;
mod opened;
mod pair;
mod planets;
mod problem;
mod routes;
mod seek;
mod server;
mod text_edit;
mod waterfall;

pub use answer::{ContactAnswer, PairAnswer};
pub use assets::{Asset, assets};
pub use opened::Opened;
pub use pair::{Change, PairSession};
pub use problem::Problem;
pub use server::{ServeOptions, serve};
