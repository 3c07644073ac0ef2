//! The nonlinear complementarity problem of sliced contact.
//!
//! Bodies that are cut into slices touch where the gap of a slice closes. With slice forces `F` \[N\], gaps `g`
//! \[m\] and the approach `x` \[m\] of the two bodies:
//!
//! ```text
//! g_i = Σ_j C_ij F_j + δ_i(F_i) + e_i − x w_i ≥ 0,     F_i ≥ 0,     g_i F_i = 0
//! Σ_i b_i F_i = T                                        (only when the load is given)
//! ```
//!
//! | symbol | meaning | unit |
//! | --- | --- | --- |
//! | `C` | compliance of everything linear, symmetric positive semi-definite | m/N |
//! | `δ_i` | local deflection, [`LocalLaw`] | m |
//! | `e_i` | unloaded separation at `x = 0` | m |
//! | `w_i` | how fast the gap closes with `x`, positive, normally 1 | - |
//! | `b_i` | lever arm of the slice's force in the load balance, positive; `b ≠ w` with friction | m |
//! | `T` | load | N·m |
//!
//! Nothing here knows what the slices belong to.
//!
//! # Which call
//! - the approach is a state of the simulation: [`solve_position`];
//! - the load is prescribed (quasi-static run): [`solve_load`].
//!
//! Both work in a [`Workspace`] that is allocated once, start from its last active set and forces, never allocate,
//! and return an [`Info`]; forces, gaps and tangent are then read from the workspace.
//!
//! # Method
//! 1. The problem is shifted to `y = x − x₀`, `x₀ = min e_i/w_i`, so that `y > 0` is elastic deflection and no digits
//!    are lost to a large common separation.
//! 2. Primal-dual active set (a semismooth Newton method; Hintermüller, Ito, Kunisch, SIAM J. Optim. 13 (2002)
//!    865-888): Newton correction on the active block `C_AA + diag δ'`, bordered by the balance row; forces that
//!    turn negative leave the set, slices that penetrate enter it. Each correction is also one step of iterative
//!    refinement, so that an ill-conditioned `C` still ends at a rounding-level residual.
//! 3. If the set cycles: a descent that cannot. The problem is the optimality condition of a convex function,
//!    minimised face by face (Lawson and Hanson, Solving Least Squares Problems (1974), chapter 23), on the plane
//!    `Σ b_i F_i = T` if the load is given.
//! 4. If that fails under a given load, which takes `b` not parallel to `w` and a nearly singular `C`: a bracket on
//!    `y`.
//!
//! # What is unique
//! With `C + diag δ'` positive definite the answer at given `x` is unique. Under a given load it is unique if `b` is
//! parallel to `w`, and for weak friction on well-conditioned compliances; where `dT/dx` in [`Info`] comes out
//! negative, other equilibria exist. On a singular `C` the gaps and the load at given `x` are unique, the split of the
//! forces is not.
//!
//! # Residual
//! Row by row, against the sum of the magnitudes of the row's own terms,
//! ```text
//! s_i = Σ_j |C_ij| F_j + |δ_i| + |e_i − x₀ w_i| + |y| w_i
//! r   = max( |g_i|/s_i where F_i > 0,  max(0, −g_i)/s_i where F_i = 0,  |Σ b_i F_i − T|/T )
//! ```
//! which has no unit, does not change with units or slice numbering, and bounds the relative change of the data that
//! would make the answer exact. A solve succeeds at `r ≤` [`Params::tolerance`]; `F ≥ 0` and
//! `F_i = 0` off the active set hold exactly.

mod active_set;
mod bracket;
mod descent;
mod edge_contact;
mod effort;
mod error;
pub(crate) mod ldl;
mod line_contact;
mod local_law;
mod local_law_error;
mod params;
mod problem;
mod solver;
mod state;
mod workspace;

pub use edge_contact::{EdgeContact, WEDGE_WIDTH};
pub use error::NlcpError;
pub use line_contact::{ContactBody, LineContact};
pub use local_law::{FLOOR_FRACTION, HALF_WIDTH_LIMIT, LEAST_SLOPE, LocalLaw};
pub use local_law_error::LocalLawError;
pub use params::Params;
pub use problem::Problem;
pub use solver::{Info, solve_load, solve_position};
pub use workspace::Workspace;
