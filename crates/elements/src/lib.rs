#![doc = include_str!("../README.md")]
//! # Where things are
//!
//! Kinds of finite elements, for all who name, mesh, compute or store them: [`CellKind`] by the nodes, [`Element`] by
//! the formulation. Numbering of nodes and edges stands here and nowhere else; formulas are in `gearmesh-fe`.

mod cell_kind;
mod element;

pub use cell_kind::{CellKind, HEX_EDGES, TET_EDGES, TET_NODES, WEDGE_EDGES};
pub use element::Element;
