//! Linear elasticity on eight-node hexahedra: elements, assembly, constraints, ordering, factorisation.
//!
//! Arrays go in (node coordinates, hexahedra), arrays come out (stiffness, displacements, strain operators).
//! The crate knows solids, not what they are used for. SI units throughout: m, N, Pa.
//!
//! # The chain
//!
//! ```text
//! nodes, hexes, Material, HexElement -> FeModel            checked once: indices, Jacobians
//! fixed degrees of freedom           -> DofMap             full <-> free numbering
//! FeModel + DofMap                   -> NodeGraph          which nodes share an element
//!                                    -> assemble_stiffness sparse K over the free DOFs
//! NodeGraph                          -> DofOrdering        METIS nested dissection
//! K + DofOrdering                    -> SymbolicFactor     pattern of L, once per mesh and constraints
//!                                    -> Factor             values of L, then any number of solves
//! ```
//!
//! ```
//! use gearmesh_fe::{assemble_stiffness, DofMap, Factor, FeModel, HexElement, Material, StructuredMesh};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mesh = StructuredMesh::block([4, 2, 2], [0.04, 0.02, 0.02]);
//! let steel = Material::new(210e9, 0.3)?;
//! let held = mesh.nodes_where(|x| x[0] == 0.0);
//! let model = FeModel::new(mesh.nodes, mesh.hexes, steel, HexElement::Hex8Incompatible)?;
//! let dofs = DofMap::with_fixed_nodes(model.node_count(), &held)?;
//! let k = assemble_stiffness(&model, &dofs)?;
//! let factor = Factor::of_model(&model, &dofs, &k)?;
//! let mut u = vec![0.0; dofs.free_count()];
//! *u.last_mut().ok_or("no free DOF")? = 1.0; // 1 N along z on the last node
//! factor.solve_slice_in_place(&mut u);
//! let displacement = dofs.expand(&u); // three entries per node, zero where held
//! assert_eq!(displacement.len(), 3 * model.node_count());
//! # Ok(())
//! # }
//! ```
//!
//! # Which element
//!
//! | element | use it for | cost | weakness |
//! | --- | --- | --- | --- |
//! | [`HexElement::Hex8Incompatible`] | the default; anything that bends | element stiffness about twice as dear, K and solves the same | strains jump a little more between elements; distorted elements lose part of the gain in bending |
//! | [`HexElement::Hex8`] | comparison with codes that use the plain trilinear brick | cheapest | shear locking: a slab one element thick is far too stiff in bending |
//!
//! Both pass the patch test on distorted meshes, have exactly six zero-energy modes and converge with
//! order 1 in the energy norm and order 2 in displacement.
//!
//! # Which solve
//!
//! One [`Factor`] per mesh and set of constraints; many right-hand sides at once
//! ([`Factor::solve_in_place`]) are several times cheaper each than one at a time. The result of a solve does
//! not depend on the number of threads it runs on.
//! When the same pattern comes back with other values (another element or material) keep the [`SymbolicFactor`].
//!
//! # Limits
//!
//! Small displacements, linear isotropic material, one material per model, hexahedra only, zero-displacement
//! constraints only. Elements with a Jacobian that is not positive at the Gauss points, the corners or the centre
//! are refused, so collapsed hexahedra (wedges) are not accepted. Nearly incompressible material locks in
//! [`HexElement::Hex8`] and has not been studied with the incompatible modes.

mod assembly;
mod constraints;
mod cyclic;
mod cylindrical;
mod element;
mod error;
mod factor;
mod graph;
mod hex8;
mod hex8_incompatible;
mod material;
mod model;
mod ordering;
mod static_condensation;
mod stiffness_block;
mod structured;

pub use assembly::{StiffnessMatrix, assemble_stiffness, assemble_stiffness_with_graph};
pub use constraints::DofMap;
pub use cyclic::CyclicInterface;
pub use cylindrical::CylindricalFrames;
pub use element::{ElementStiffness, HexCoordinates, HexElement, StrainOperator, element_volume};
pub use error::{ElementError, FeError};
pub use factor::{Factor, FactorInfo, SymbolicFactor};
pub use graph::NodeGraph;
pub use hex8::{
    CORNERS, GAUSS_POINTS, PointGradients, point_gradients, position_at, shape_functions,
};
pub use material::{LameParameters, Material, von_mises};
pub use model::FeModel;
pub use ordering::DofOrdering;
pub use static_condensation::{CondensedLoads, StaticCondensation};
pub use structured::StructuredMesh;
