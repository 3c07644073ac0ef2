#![doc = include_str!("../README.md")]
//!
//! # Where things are
//!
//! From a gear definition to hexahedra of eight or twenty nodes: one tooth cell and one body sector of the
//! cross-section are meshed in quads by gmsh, copied round the axis and layered along it. Or to tetrahedra of ten
//! nodes: the teeth by splitting such layers, the body as a free mesh of its revolved contour.
//!
//! | step | type | file |
//! | --- | --- | --- |
//! | the Python that has gmsh | [`python::PythonEnvironment`] | `python.rs` |
//! | quads in outlines whose nodes are given | [`plane_mesher`] | `plane_mesher.rs`, `plane_mesher.py` |
//! | spacing along an edge | [`grading`] | `grading.rs` |
//! | one tooth: blocks that follow its outline, their quads | [`tooth_blocks::ToothBlocks`], [`tooth_cell::ToothCell`] | `tooth_lines.rs`, `tooth_blocks.rs`, `tooth_cell.rs` |
//! | the cut of the tooth-only submodel | [`CutLine`] | `cut_line.rs` |
//! | hub, web and rim of one sector, with openings | [`body`] | `body_circles.rs`, `opening_outline.rs`, `body.rs` |
//! | rings of it thinner than elements | | `thin_ring.rs` |
//! | a crack along sides of its quads | [`crack_line::CrackLine`] | `crack_line.rs` |
//! | all teeth and sectors in the plane | [`section::Section`] | `section.rs` |
//! | middles of sides, on the true curve | [`mid_sides`] | `mid_sides.rs` |
//! | layers along the axis | [`layers`] | `layers.rs` |
//! | their heights below the rim | [`heights`] | `heights.rs` |
//! | element lists, faces on the outline | [`ElementList`], [`OutlineFace`] | `elements.rs`, `face.rs` |
//! | bricks split into tetrahedra, teeth of them | [`tet_split`], `tet_mesh.rs` | `tet_split.rs`, `tet_mesh.rs` |
//! | a body of tetrahedra, with fillets | [`solid_problem`], [`solid_mesher`] | `solid_problem.rs`, `solid_mesher.rs`, `solid_mesher.py` |
//! | its copies joined to the teeth | [`solid_body`] | `solid_body.rs` |
//! | nodes, elements and sets | [`GearMesh`] | `gear_mesh.rs`, `gear_mesh_sets.rs` |
//! | bevel gears: sections along the tooth, their numbers | [`bevel_level::Levels`] | `bevel_level.rs`, `bevel_grid.rs` |
//! | the body below: quads of the meridian, turned about the axis | [`bevel_meridian`] | `bevel_meridian.rs`, `bevel_twist.rs` |
//! | nodes, elements and sets | [`BevelMesh`] | `bevel_mesh.rs` |
//! | its tooth in the section normal to it | [`BevelSection`] | `bevel_section.rs` |
//! | scaled Jacobian | [`quality`] | `quality.rs` |
//! | how large the mesh will be, before it is made | [`MeshSize`] | `mesh_size.rs` |
//! | fine section of one tooth under a narrow load | [`contact_section::ContactSection`] | `contact_section.rs` |
//!
//! Every node of the tooth outline lies on the exact profile, and its place along the outline is kept: loads and
//! gauges find their faces by arc length and z, never by projection on a facet.

mod bevel_grid;
pub mod bevel_level;
pub mod bevel_meridian;
pub mod bevel_mesh;
pub mod bevel_section;
mod bevel_twist;
pub mod body;
mod body_circles;
pub mod contact_section;
pub mod crack_line;
pub mod cut_line;
pub mod elements;
pub mod face;
pub mod gear_mesh;
mod gear_mesh_sets;
pub mod grading;
pub mod heights;
pub mod layers;
pub mod mesh_size;
mod meshed_spans;
pub mod mid_sides;
mod opening_outline;
mod plane;
pub mod plane_mesher;
pub mod python;
pub mod quality;
pub mod ring_radius;
pub mod section;
pub mod solid_body;
pub mod solid_mesher;
pub mod solid_problem;
mod tet_mesh;
pub mod tet_split;
mod thin_ring;
pub mod tooth_blocks;
pub mod tooth_cell;
mod tooth_lines;
pub mod twist;

pub use bevel_meridian::BodyGrid;
pub use bevel_mesh::BevelMesh;
pub use bevel_section::BevelSection;
pub use cut_line::CutLine;
pub use elements::ElementList;
pub use face::{FaceShape, OutlineFace};
pub use gear_mesh::GearMesh;
pub use mesh_size::MeshSize;

use gearmesh_geometry::{GearDefinition, MeshSettings};

/// Why no mesh could be made.
#[derive(Debug, thiserror::Error)]
pub enum MeshError {
    /// No Python with gmsh.
    #[error(transparent)]
    Python(#[from] python::PythonError),
    /// gmsh failed or left triangles.
    #[error(transparent)]
    Plane(plane_mesher::PlaneMeshError),
    /// The gear has a mesh already.
    #[error(
        "blank.kind = \"mesh\": {file} is the mesh of this gear, no other is made; `gearmesh reduce` checks and reduces it, fields and \
         error estimates are not offered for it"
    )]
    MeshedElsewhere {
        /// Its file.
        file: String,
    },
    /// The tool leaves no surface where a bevel tooth should be.
    #[error(transparent)]
    Bevel(#[from] gearmesh_bevel::BevelError),
    /// The lines of a bevel body cross.
    #[error(
        "blank: the body's lines on the toe's and on the heel's side cross at diameter {diameter_mm:.3} mm, z {z_mm:.3} mm; \
         change hub_z_mm, the points of the web or rim_mm so that they do not"
    )]
    CrossedLines {
        /// Where.
        diameter_mm: f64,
        /// Where.
        z_mm: f64,
    },
    /// The free mesh of the body failed.
    #[error(transparent)]
    Solid(solid_mesher::SolidMeshError),
    /// gmsh finds no mesh, or takes too long.
    #[error(
        "mesh.body_mm or [blank]: {cause}; make the thinnest wall or the smallest opening of the body larger, or choose another body_mm{hexahedra}"
    )]
    NoMesh {
        /// What it says.
        cause: python::PythonError,
        /// What else helps; empty where nothing does.
        hexahedra: &'static str,
    },
    /// A body of too many tetrahedra.
    #[error(
        "{key}: a sector of the body would have about {estimated:.1e} tetrahedra, allowed are {allowed:.0e}; elements are {length_mm:.4} mm long \
         where it is thinnest: {advice}"
    )]
    TooManyTetrahedra {
        /// What makes them so many.
        key: &'static str,
        /// Estimate for a sector.
        estimated: f64,
        /// Allowed.
        allowed: f64,
        /// Shortest element length.
        length_mm: f64,
        /// What to do.
        advice: &'static str,
    },
    /// Openings leave no place for the cut between two sectors.
    #[error(
        "blank.slots or blank.holes: no tooth space lies clear of the openings: a sector's edge at a tooth space must keep {needed_deg:.3} deg from each opening, the best keeps {best_deg:.3} deg; narrow the openings or turn them"
    )]
    NoCut {
        /// Clearance needed.
        needed_deg: f64,
        /// Best clearance found.
        best_deg: f64,
    },
    /// Openings lie across a circle that must be a line of the mesh.
    #[error(
        "blank.slots or blank.holes: they reach from radius {inner_mm:.3} to {outer_mm:.3} mm, across a circle at which the body's shape \
         changes (rim, hub, or a point of the contour); keep them on one side of it"
    )]
    OpeningsAcross {
        /// Innermost radius.
        inner_mm: f64,
        /// Outermost radius.
        outer_mm: f64,
    },
    /// The crack leaves the tooth.
    #[error(
        "crack: its tip at x {x_mm:.3} mm, y {y_mm:.3} mm of the tooth's section leaves the tooth and the ring below it, or comes too close to \
         their edge ({off_mm:.3} mm from the nearest node inside); make crack.depth_mm smaller or turn the crack"
    )]
    CrackTip {
        /// Tip.
        x_mm: f64,
        /// Tip.
        y_mm: f64,
        /// Distance to the nearest node.
        off_mm: f64,
    },
    /// Quality below what the definition demands.
    #[error(
        "the mesh is too poor: smallest scaled Jacobian {found:.3} at x {x_mm:.2} mm, y {y_mm:.2} mm, z {z_mm:.2} mm, demanded {demanded:.3}; choose smaller or more even element sizes in [mesh]{lengths}, or lower min_scaled_jacobian"
    )]
    Quality {
        /// Smallest scaled Jacobian.
        found: f64,
        /// The lengths that make it, by their keys, in brackets; empty where they are not known.
        lengths: String,
        /// Demanded.
        demanded: f64,
        /// Where.
        x_mm: f64,
        /// Where.
        y_mm: f64,
        /// Where.
        z_mm: f64,
    },
}

/// A script that found no mesh is the input's fault, one that fails is not.
fn is_no_mesh(cause: &python::PythonError) -> bool {
    matches!(
        cause,
        python::PythonError::TooLong { .. }
            | python::PythonError::Failed {
                code: Some(python::NO_MESH),
                ..
            }
    )
}

impl From<plane_mesher::PlaneMeshError> for MeshError {
    fn from(error: plane_mesher::PlaneMeshError) -> Self {
        match error {
            plane_mesher::PlaneMeshError::Python(cause) if is_no_mesh(&cause) => Self::NoMesh {
                cause,
                hexahedra: "",
            },
            other => Self::Plane(other),
        }
    }
}

impl From<solid_mesher::SolidMeshError> for MeshError {
    fn from(error: solid_mesher::SolidMeshError) -> Self {
        match error {
            solid_mesher::SolidMeshError::Python(cause) if is_no_mesh(&cause) => Self::NoMesh {
                cause,
                hexahedra: "; element = \"hex8-incompatible\" takes layers instead of a free mesh",
            },
            other => Self::Solid(other),
        }
    }
}

impl MeshError {
    /// Names the element lengths of the part with the worst element, with the default ones.
    fn with_lengths(mut self, gear: &GearDefinition) -> Self {
        if let Self::Quality {
            x_mm,
            y_mm,
            lengths,
            ..
        } = &mut self
        {
            let module_mm = gear.tooth.module_m * 1e3;
            let width_mm = gear.tooth.face_width_m * 1e3;
            let defaults = MeshSettings::default_lengths(gear.mesh.element, module_mm, width_mm);
            let found = [gear.mesh.flank_m, gear.mesh.fillet_m, gear.mesh.body_m];
            let told = |k: usize| {
                let key = ["flank_mm", "fillet_mm", "body_mm"][k];
                format!("{key} {:.3}, {:.3} by default", found[k] * 1e3, defaults[k])
            };
            let ring_mm = 1e3 * ring_radius::ring_radius_m(gear);
            let in_teeth = gear.profile.is_towards_tip(x_mm.hypot(*y_mm), ring_mm);
            *lengths = match in_teeth {
                true => format!(" (there: {}; {})", told(0), told(1)),
                false => format!(" (there: {})", told(2)),
            };
        }
        self
    }
}
