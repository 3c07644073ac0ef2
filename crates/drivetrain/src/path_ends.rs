//! Where contact ends: tip edges that go on touching, or slices that leave the rigid path with a shrinking width.

use gearmesh_contact::slice_part::{LEAST_SHARE, SlicePart};
use gearmesh_contact::tip_contact::LARGEST_GAP_OVER_BASE_PITCH;
use gearmesh_geometry::{BaseCircles, ToothGeometry};
use std::f64::consts::TAU;

use crate::flank_contacts::Section;

/// What happens where the rigid path of contact ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PathEnds {
    /// Pairs touch on the rigid path only. A loaded spur pair ends abruptly, its force jumps to zero and its elastic
    /// energy is lost; the slices of a helical pair leave one after the other with a width that shrinks to nothing, and
    /// no energy is lost.
    LineOfAction,
    /// Beyond the end the tip edge goes on touching with a gap that grows as ½ δ² ρ_tip L/ρ_mate · cos β_b, δ the roll
    /// angle beyond: the exact gap of an edge to second order. Force and energy are then continuous.
    #[default]
    Extended,
}

/// How far beyond the end of its flank each gear's tip edge is followed \[rad\], and its gap over δ² \[m/rad²\]; zero
/// on the rigid path.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct TipEdges {
    pub reach_rad: [f64; 2],
    pub gap_m_per_rad2: [f64; 2],
}

impl TipEdges {
    /// The edges of two gears whose line of action is `length_m` long; `helix_cos`: cos β_b.
    pub(crate) fn new(
        gears: &[ToothGeometry; 2],
        (circles, length_m): (&BaseCircles, f64),
        helix_cos: f64,
    ) -> Self {
        let mut edges = Self::default();
        for (i, gear) in gears.iter().enumerate() {
            let tip = circles.radii_m[i] * gear.flank_end_roll_rad;
            let mate = length_m - tip;
            let pitch = TAU / gear.teeth as f64;
            edges.gap_m_per_rad2[i] = 0.5 * tip * length_m / mate * helix_cos;
            let largest = LARGEST_GAP_OVER_BASE_PITCH * pitch * gear.base_radius_m;
            edges.reach_rad[i] = (largest / edges.gap_m_per_rad2[i]).sqrt().min(0.5 * pitch);
        }
        edges
    }
}

/// Takes the section in the middle of a whole slice of helical teeth to the middle of the part that is on the rigid
/// path; false where none of it is. `flanks`: of both gears how the roll angle changes along the axis \[rad/m\], where
/// the flank ends \[rad\] and the sense of the roll angle there; `width_m`: of a slice at the reference displacement.
///
/// A flank ends at x = (ξ_end − ξ)/ξ′; the part's share of the width and the roll angles in its middle go with the pose
/// as the slice's edges and these places do.
pub(crate) fn part_on_path(
    section: &mut Section,
    flanks: [(f64, f64, f64); 2],
    width_m: f64,
) -> bool {
    let half = 0.5 * width_m;
    let (share, by_pose) = (section.share, section.share_gradient);
    let mut part = SlicePart {
        low: (-half * share, -half * by_pose),
        high: (half * share, half * by_pose),
    };
    for (gear, (slope, end, sense)) in flanks.into_iter().enumerate() {
        let at = (end - section.roll_rad[gear]) / slope;
        let place = (at, -section.roll_gradient[gear] / slope);
        part.end_at(place, sense * slope > 0.0);
    }
    (section.share, section.share_gradient) = part.share(width_m);
    let (middle, by_pose) = part.middle();
    for (gear, (slope, ..)) in flanks.into_iter().enumerate() {
        section.roll_rad[gear] += slope * middle;
        section.roll_gradient[gear] += slope * by_pose;
    }
    section.share > LEAST_SHARE
}
