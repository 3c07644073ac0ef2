#![doc = include_str!("../README.md")]
//! # Where things are
//!
//! Linear elasticity on hexahedra, tetrahedra and wedges: elements, assembly, constraints, ordering, factorisation.
//!
//! Arrays go in (node coordinates, elements), arrays come out (stiffness, displacements, strain operators).
//! The crate knows solids, not what they are used for. SI units throughout: m, N, Pa.
//!
//! # The chain
//!
//! ```text
//! nodes, elements, Material          -> FeModel            checked once: indices, Jacobians; one kind or several blocks
//! (QuadraticMesh puts nodes on the edges of linear elements)
//! fixed DOFs, RigidGroups            -> DofMap             constraints u = T q, full <-> free numbering
//! FeModel + DofMap                   -> NodeGraph          which nodes share an element
//!                                    -> assemble_stiffness sparse K over the free DOFs
//!                                    -> assemble_mass      consistent M, same pattern
//! K or M                             -> compressed_columns a view by sprs: products, slices, Matrix Market files
//! NodeGraph                          -> DofOrdering        METIS nested dissection
//! K + DofOrdering                    -> SymbolicFactor     pattern of L, once per mesh and constraints
//!                                    -> Factor             values of L, then any number of solves
//! K + M + Factor                     -> natural_modes      lowest frequencies and shapes
//! products and solves of one's own   -> search_modes       the same
//! K + kept nodes                     -> StaticCondensation a part replaced by its stiffness at some nodes
//! stiffness of a sector at its cuts  -> CyclicInterface    a ring of equal sectors, by harmonics
//! nodes on a crack + solves of the sound body -> DoubledNodes   the cracked body, without a new factor
//! ```
//! Condensation and ring work in cylindrical components ([`CylindricalFrames`]), in which turned parts are equal.
//!
//! ```
//! use gearmesh_fe::{assemble_stiffness, DofMap, Factor, FeModel, Element, Material, StructuredMesh};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mesh = StructuredMesh::block([4, 2, 2], [0.04, 0.02, 0.02]);
//! let steel = Material::new(210e9, 0.3)?;
//! let held = mesh.nodes_where(|x| x[0] == 0.0);
//! let model = FeModel::new(mesh.nodes, mesh.hexes, steel, Element::Hex8Incompatible)?;
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
//! | [`Element::Hex8Incompatible`] | the default; anything that bends | element stiffness about twice as dear, K and solves the same | strains jump a little more between elements; distorted elements lose part of the gain in bending |
//! | [`Element::Hex8`] | comparison with codes that use the plain trilinear brick | cheapest | shear locking: a slab one element thick is far too stiff in bending |
//! | [`Element::Hex20`] | curved bodies, stress, a few elements across a thickness | four times the nodes of the same elements as hex8; a fuller K at equal nodes | needs mid-edge nodes on the true surface to keep its order |
//! | [`Element::Tet10`] | bodies that no hexahedra fill: fillets, drafts, anything meshed freely | about 1.4 nodes an element; more of them than hex20 at equal error | as hex20 |
//! | [`Element::Wedge6`], [`Element::Wedge15`] | gaps in meshes of hex8 or hex20 | as those | Wedge6 locks as hex8 does |
//!
//! All pass the patch test on distorted meshes, curved ones too, and have exactly six zero-energy modes. The linear
//! elements converge with order 1 in the energy norm and order 2 in displacement, the quadratic ones with 2 and 3.
//!
//! # Which solve
//!
//! One [`Factor`] per mesh and set of constraints; many right-hand sides at once
//! ([`Factor::solve_in_place`]) are several times cheaper each than one at a time. The result of a solve does
//! not depend on the number of threads it runs on.
//! When the same pattern comes back with other values (another element or material) keep the [`SymbolicFactor`].
//!
//! # Which support
//!
//! | support | how | K |
//! | --- | --- | --- |
//! | nodes or single displacements held | [`DofMap::with_fixed_nodes`], [`DofMap::with_fixed_dofs`] | smaller by what is held |
//! | nodes rigid on a reference point, some of its six degrees of freedom held | [`DofMap::with_rigid_groups`] | a border of up to six full columns a group |
//! | nothing held | [`DofMap::all_free`] | singular: products only, or [`natural_modes`] with a shift |
//!
//! # Limits
//!
//! Small displacements, linear isotropic material, one material per model, zero-displacement
//! constraints and rigid groups only; one density. Elements with a Jacobian that is not positive at the integration
//! points, the nodes or the centre are refused, so collapsed hexahedra are not accepted: use wedges. Linear tetrahedra
//! are not on offer: they are far too stiff in bending. Nearly incompressible material locks in
//! [`Element::Hex8`] and has not been studied with the incompatible modes.

mod assembly;
mod compressed_columns;
mod constraints;
mod cyclic;
mod cylindrical;
mod doubled_nodes;
mod element;
mod element_matrix;
mod error;
mod factor;
mod factor_time;
mod graph;
mod half_solve;
mod hex20;
mod hex8;
mod hex8_incompatible;
mod isoparametric;
mod lanczos_basis;
mod mass;
mod material;
mod mode_problem;
mod model;
mod modes;
mod ordering;
mod parts;
mod quadratic_mesh;
mod quadrature;
mod reference_points;
mod rigid_group;
mod ring;
mod ring_condensation;
mod ring_transform;
mod shape_table;
mod static_condensation;
mod stiffness_block;
mod structured;
mod symmetric_product;
mod tet10;
mod wedge15;
mod wedge6;

pub use assembly::{assemble_stiffness, assemble_stiffness_with_graph};
pub use compressed_columns::{SparseMatrix, StiffnessMatrix, compressed_columns};
pub use constraints::DofMap;
pub use cyclic::CyclicInterface;
pub use cylindrical::CylindricalFrames;
pub use doubled_nodes::{DoubledNodes, JumpFactor};
pub use element::ElementFormulas;
pub use element_matrix::ElementMatrix;
pub use error::{ElementError, FeError};
pub use factor::{Factor, FactorInfo, SymbolicFactor};
pub use gearmesh_elements::Element;
pub use graph::NodeGraph;
pub use hex8::CORNERS;
pub use mass::{assemble_mass, mass_moments, mass_product, stiffness_product};
pub use material::{LameParameters, Material, von_mises};
pub use mode_problem::{ModeProblem, numbers_without_pattern};
pub use model::{ElementBlock, FeModel};
pub use modes::{
    ModeSettings, NaturalModes, WantedModes, natural_modes, search_modes, shifted_stiffness,
};
pub use ordering::DofOrdering;
pub use parts::{PARTS, split_alike};
pub use quadratic_mesh::{QuadraticMesh, arc_middle, chord_middle};
pub use quadrature::WeightedPoint;
pub use rigid_group::{RigidGroup, rigid_motions};
pub use ring::{PartLoads, Ring};
pub use ring_condensation::RingCondensation;
pub use static_condensation::{CondensedLoads, StaticCondensation};
pub use stiffness_block::StrainOperator;
pub use structured::StructuredMesh;
pub use symmetric_product::SymmetricRows;
