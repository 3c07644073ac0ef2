//! Where contact ends: tip edges that go on touching, or slices that leave the rigid path with a shrinking width.

use gearmesh_contact::tip_contact::LARGEST_GAP_OVER_BASE_PITCH;
use gearmesh_geometry::ToothGeometry;
use std::f64::consts::TAU;

use crate::flank_contacts::Section;

/// What happens where the rigid path of contact ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PathEnds {
    /// Pairs touch on the rigid path only. A loaded spur pair ends abruptly, its force jumps to zero and its elastic energy is lost; the
    /// slices of a helical pair leave one after the other with a width that shrinks to nothing, and no energy is lost.
    LineOfAction,
    /// Beyond the end the tip edge goes on touching with a gap that grows as ½ δ² ρ_tip L/ρ_mate · cos β_b, δ the roll angle beyond: the
    /// exact gap of an edge to second order. Force and energy are then continuous.
    #[default]
    Extended,
}

/// How far beyond the end of its flank each gear's tip edge is followed \[rad\], and its gap over δ² \[m/rad²\]; zero on the rigid path.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct TipEdges {
    pub reach_rad: [f64; 2],
    pub gap_m_per_rad2: [f64; 2],
}

impl TipEdges {
    /// The edges of two gears whose line of action is `length_m` long; `helix_cos`: cos β_b.
    pub(crate) fn new(gears: &[ToothGeometry; 2], length_m: f64, helix_cos: f64) -> Self {
        let mut edges = Self::default();
        for (i, gear) in gears.iter().enumerate() {
            let tip = gear.base_radius_m * gear.flank_end_roll_rad;
            let mate = length_m - tip;
            let pitch = TAU / gear.teeth as f64;
            edges.gap_m_per_rad2[i] = 0.5 * tip * length_m / mate * helix_cos;
            let largest = LARGEST_GAP_OVER_BASE_PITCH * pitch * gear.base_radius_m;
            edges.reach_rad[i] = (largest / edges.gap_m_per_rad2[i]).sqrt().min(0.5 * pitch);
        }
        edges
    }
}

/// Share of a slice below which it counts as off the path. No unit. Its force falls with the share, so that this is the jump that is left,
/// a hundred-thousandth of a slice's force; far below, the floor of the local law's logarithm would reach its cap.
pub(crate) const LEAST_SHARE: f64 = 1e-5;

/// What the part of a slice on the path depends on besides its section.
pub(crate) struct SlicePart {
    /// dξ/dz of both gears \[rad/m\].
    pub slopes: [f64; 2],
    /// Where their flanks end \[rad\].
    pub ends: [f64; 2],
    /// Width of a slice at the reference displacement \[m\].
    pub width_m: f64,
}

/// Takes the section in the middle of a whole slice of helical teeth to the middle of the part that is on the rigid path; false where none of
/// it is.
///
/// The part lies between the slice's edges and the places x = (ξ_end − ξ)/ξ′ where a flank ends; its share of the width and the roll angles
/// in its middle go with the pose as these do.
pub(crate) fn part_on_path(section: &mut Section, part: &SlicePart) -> bool {
    let half = 0.5 * part.width_m;
    let (share, by_pose) = (section.share, section.share_gradient);
    let mut low = (-half * share, -half * by_pose);
    let mut high = (half * share, half * by_pose);
    for (gear, slope) in part.slopes.into_iter().enumerate() {
        let at = (part.ends[gear] - section.roll_rad[gear]) / slope;
        let by_pose = -section.roll_gradient[gear] / slope;
        if slope > 0.0 && at < high.0 {
            high = (at, by_pose);
        } else if slope < 0.0 && at > low.0 {
            low = (at, by_pose);
        }
    }
    section.share = (high.0 - low.0) / part.width_m;
    section.share_gradient = (high.1 - low.1) / part.width_m;
    let (middle, by_pose) = (0.5 * (low.0 + high.0), 0.5 * (low.1 + high.1));
    for (gear, slope) in part.slopes.into_iter().enumerate() {
        section.roll_rad[gear] += slope * middle;
        section.roll_gradient[gear] += slope * by_pose;
    }
    section.share > LEAST_SHARE
}
