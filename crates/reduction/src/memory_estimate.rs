//! How much memory an offline job will take, before gmsh and the factorisations take it.
//!
//! Sizes of the mesh are those of [`MeshSize`]. What becomes of them was fitted to measured peaks
//! (docs/theory/reduction.md): it tells gigabytes from tens of them, no more. Two times compete, the factorisation of
//! the largest part and the checks with the mass at the end:
//!
//! ```text
//! L     = 8 (14 d^(4/3) + own f²)              d degrees of freedom of a sector's body, f of the foot of a tooth
//! begin = a n + 8 own f² + 1.3 L               n nodes of the gear, `own` teeth a sector
//! end   = b n + L + 16 (N/2 + 1) c² + C_hub    c degrees of freedom of a cut, N sectors
//! ```
//!
//! A body that does not repeat has a dense block q² of the circle on which its ring of teeth stands in place of feet,
//! and the ring's harmonics in place of those of cuts, where the circle is not too large for that. It takes 1.2 times
//! what is so estimated.
//! The coarser meshes of the error estimate are solved before, one after the other, and take less.
//!
//! The condensed feet are dense blocks in the sector's matrix and stay so in its factor.
//! d^(4/3) is how the factor of a solid grows under nested dissection: A. George, *Nested dissection of a regular
//! finite element mesh*, SIAM J. Numer. Anal. 10 (1973) 345-363, in three dimensions.

use gearmesh_geometry::{Element, GearDefinition, MeshSettings, ModeRange, Symmetry};
use gearmesh_mesh::MeshSize;

use crate::mode_count::modes_up_to;
use crate::sector_condensation::MOST_ON_CIRCLE;
use crate::time_estimate::Work;

/// Bytes a node before and after the checks: mesh, model and graph; stiffness of the parts, mass, full fields.
const BYTES_A_NODE: [f64; 2] = [600.0, 2400.0];
/// Bytes a node of a mesh alone, with what writes it.
const BYTES_A_MESH_NODE: f64 = 1500.0;
/// Nonzeros of the factor of a meshed solid over its degrees of freedom to the power of 4/3.
const FILL: f64 = 14.0;
/// Memory of a factorisation over that of its factor.
const FACTORISATION: f64 = 1.3;
/// Copies of C_hub while it is put together and stored.
const C_HUB_COPIES: f64 = 4.0;
/// Vectors held for each mode that is wanted, as long as the unknowns.
const VECTORS_A_MODE: f64 = 4.0;
/// Memory of a body of a single sector over that of its parts.
const SINGLE_SECTOR: f64 = 1.2;
const REAL: f64 = 8.0;

/// What is to be done with a gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OfflineJob {
    /// Its mesh.
    Mesh,
    /// Its reduction, with the natural modes that the definition asks for.
    Reduction,
    /// Natural modes in a range. How many there are up to a frequency is estimated ([`modes_up_to`]).
    Modes(ModeRange),
}

/// What a job will take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MemoryEstimate {
    /// The mesh.
    pub size: MeshSize,
    /// Largest memory in use \[byte\].
    pub bytes: f64,
    /// The part of it that the natural modes take \[byte\].
    pub modes_bytes: f64,
    /// What of it costs time.
    pub(crate) work: Work,
    /// Natural modes that are wanted; up to a frequency, an estimate of how many there are.
    pub modes: f64,
    /// The key of `[mesh]` whose length is the smallest share of its default, and that share.
    pub shortest: (&'static str, f64),
}

impl MemoryEstimate {
    /// Time of a reduction on this machine \[s\]: within a third or so of what gears with a web or a rim take.
    #[must_use]
    pub fn reduction_seconds(&self, estimate_error: bool) -> f64 {
        self.work.seconds(estimate_error)
    }

    /// Estimates a job; none for a gear that was meshed elsewhere.
    pub fn new(gear: &GearDefinition, job: OfflineJob) -> Option<Self> {
        let size = MeshSize::estimate(gear)?;
        let modes = match job {
            OfflineJob::Mesh => None,
            OfflineJob::Reduction => gear.modes,
            OfflineJob::Modes(range) => Some(range),
        };
        let modes = match modes {
            Some(ModeRange::Count(count)) => count as f64,
            Some(ModeRange::UpToHz(frequency_hz)) => modes_up_to(gear, frequency_hz).unwrap_or(0.0),
            None => 0.0,
        };
        let modes_bytes = modes_bytes(gear, &size, modes);
        let bytes = match job {
            OfflineJob::Mesh => BYTES_A_MESH_NODE * size.nodes,
            OfflineJob::Modes(_) | OfflineJob::Reduction => reduction_bytes(gear, &size),
        };
        Some(Self {
            size,
            bytes: bytes + modes_bytes,
            work: Work::new(gear, &size, largest_factor(gear, &size)),
            modes_bytes,
            modes,
            shortest: shortest(gear),
        })
    }
}

/// Whether one factorisation of everything is made.
fn is_whole(gear: &GearDefinition) -> bool {
    gear.reduction.symmetry == Symmetry::Off || gear.mesh.plane_strain
}

/// Numbers in the factor of a meshed solid.
fn solid_factor(nodes: f64) -> f64 {
    FILL * (3.0 * nodes).powf(4.0 / 3.0)
}

/// Whether the teeth are condensed to a circle below them, as a ring.
fn is_on_circle(gear: &GearDefinition, size: &MeshSize) -> bool {
    gear.sectors() == 1 && 3.0 * size.circle_nodes <= MOST_ON_CIRCLE as f64
}

/// Numbers in the largest factor: that of everything, or of a sector with the dense blocks of feet or circle.
fn largest_factor(gear: &GearDefinition, size: &MeshSize) -> f64 {
    if gear.mesh.plane_strain {
        // A cross-section's factor grows with its nodes times their logarithm only, and is small.
        return FILL * 3.0 * size.nodes;
    }
    if is_whole(gear) {
        return solid_factor(size.nodes);
    }
    if is_on_circle(gear, size) {
        return solid_factor(size.body_nodes) + (3.0 * size.circle_nodes).powi(2);
    }
    let own = gear.tooth.teeth as f64 / gear.sectors() as f64;
    let nodes = size.body_nodes + own * (size.foot_nodes - size.side_nodes);
    solid_factor(nodes) + own * (3.0 * size.foot_nodes).powi(2)
}

fn reduction_bytes(gear: &GearDefinition, size: &MeshSize) -> f64 {
    let (teeth, sectors) = (gear.tooth.teeth as f64, gear.sectors() as f64);
    let own = teeth / sectors;
    let grid = gear.reduction.roll_stations * (2 * gear.reduction.slices + 1);
    let loads = (grid * gear.reduction.flanks.len()) as f64;
    // Without repetition C_hub is solved and kept by patterns, of tooth 0 alone in full.
    let in_full = if own < teeth { own } else { 1.0 };
    let c_hub = C_HUB_COPIES * REAL * in_full * loads * teeth * loads;
    let [early, late] = BYTES_A_NODE.map(|bytes| bytes * size.nodes);
    let factor = REAL * largest_factor(gear, size);
    if is_whole(gear) {
        return (early + FACTORISATION * factor).max(late + factor + c_hub);
    }
    let foot = 3.0 * size.foot_nodes;
    let tooth = REAL * solid_factor(size.tooth_nodes) + 3.0 * REAL * foot.powi(2);
    if is_on_circle(gear, size) {
        let circle = 3.0 * size.circle_nodes;
        let side = 3.0 * size.side_nodes;
        let of_ring = side * (side + circle / teeth);
        let ring = 2.0 * REAL * (0.5 * teeth + 1.0) * of_ring;
        let dense = REAL * circle.powi(2);
        // Matrix and permuted copy have rows beside the values of their lower triangles.
        let at_the_body = early + tooth + ring + 2.0 * dense + FACTORISATION * factor;
        // No tooth passes more shapes on than a part has displacements on the circle.
        return SINGLE_SECTOR * at_the_body.max(late + tooth + ring + factor + dense + c_hub);
    }
    let feet = REAL * own * foot.powi(2);
    let cut = 3.0 * size.cut_nodes;
    let harmonics = 2.0 * REAL * (0.5 * sectors + 1.0) * cut.powi(2);
    let at_the_sector = early + tooth + feet + FACTORISATION * factor;
    let most = at_the_sector.max(late + tooth + factor + harmonics + c_hub);
    if own < teeth {
        most
    } else {
        SINGLE_SECTOR * most
    }
}

fn modes_bytes(gear: &GearDefinition, size: &MeshSize, count: f64) -> f64 {
    let unknowns = if is_whole(gear) {
        3.0 * size.nodes
    } else {
        // Real and imaginary part of one sector's displacements.
        let own = (gear.tooth.teeth / gear.sectors()) as f64;
        6.0 * (size.body_nodes + own * (size.tooth_nodes - size.side_nodes))
    };
    VECTORS_A_MODE * REAL * unknowns * count
}

fn shortest(gear: &GearDefinition) -> (&'static str, f64) {
    let mesh = &gear.mesh;
    let defaults =
        MeshSettings::default_lengths(mesh.element, gear.tooth.module_m, gear.tooth.face_width_m);
    let shares = [
        ("flank_mm", mesh.flank_m / defaults[0]),
        ("fillet_mm", mesh.fillet_m / defaults[1]),
        ("body_mm", mesh.body_m / defaults[2]),
        // A cross-section has one layer.
        (
            "axial_mm",
            if mesh.plane_strain {
                f64::INFINITY
            } else {
                mesh.axial_m / defaults[3]
            },
        ),
    ];
    let quadratic = mesh.element == Element::Hex20;
    let least = shares
        .into_iter()
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap_or(shares[2]);
    // Quadratic elements have four times the nodes on the same lengths.
    if quadratic && least.1 >= 1.0 {
        ("element", 1.0)
    } else {
        least
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::print_stdout)]
mod tests {
    use super::*;
    use gearmesh_geometry::input::InputDocument;

    const DRILLED: &str = include_str!("../../../fe_models/wheel_47_drilled.toml");

    fn gear(text: &str) -> GearDefinition {
        GearDefinition::from_document(&InputDocument::new("g.toml", text)).unwrap()
    }

    fn gigabytes(gear: &GearDefinition) -> f64 {
        1e-9 * MemoryEstimate::new(gear, OfflineJob::Reduction)
            .unwrap()
            .bytes
    }

    /// Peaks of the resident memory of `gearmesh reduce` on a machine of two cores: within a third.
    #[test]
    fn estimates_are_within_a_third_of_measured_peaks() {
        let (before, after) = DRILLED.split_once("[mesh]").unwrap();
        let after = after.split_once("[reduction]").unwrap().1;
        let by_default = format!("{before}[reduction]{after}");
        let holes_64 = "name = \"wheel 64\"\n[tooth]\nteeth = 64\nmodule_mm = 2.5\nface_width_mm = 20.0\n[blank]\nkind = \"thin-rim\"\n\
            bore_diameter_mm = 40.0\nhub_diameter_mm = 60.0\nrim_inner_diameter_mm = 136.0\nweb_thickness_mm = 8.0\n\
            [blank.holes]\ncount = 5\npitch_circle_diameter_mm = 98.0\ndiameter_mm = 22.0\nphase_deg = 0.0\n\
            [material]\nyoung_GPa = 206.0\npoisson = 0.3\n";
        for (text, peak) in [
            (DRILLED, 1.70),
            (&by_default, 6.88),
            (holes_64, 6.36),
            (include_str!("../../../fe_models/pinion_25_m2.toml"), 0.91),
            (include_str!("../../../fe_models/gearbox_17.toml"), 0.60),
        ] {
            let gear = gear(text);
            let estimated = gigabytes(&gear);
            println!("{}: {estimated:.2} GB, measured {peak} GB", gear.name);
            assert!(
                (estimated / peak - 1.0).abs() < 1.0 / 3.0,
                "{}: {estimated:.2} GB, measured {peak} GB",
                gear.name
            );
        }
    }
}
