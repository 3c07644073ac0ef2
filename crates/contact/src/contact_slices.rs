//! The slices of a contact line that touch: all at one roll angle on spur teeth, one after the other on helical ones.
//!
//! A helical contact line slants over the flank, ξ₁(z) = ξ₁(0) + ξ′ z ([`GearPair::roll_slope_1_rad_per_m`]), so that
//! its slices enter and leave the path of contact one by one. A slice that is partly on the path touches over that part
//! only: it has the roll angle of the part's middle and a share of the slice's length, which goes to zero with its
//! force. The transmission error is therefore continuous where a slice enters.

use crate::contact_lines::{ContactLine, ContactLines};
#[cfg(doc)]
use gearmesh_geometry::GearPair;

/// Share of a slice below which it counts as off the path.
///
/// No unit. The local compliance grows with one over the share, so that such a slice carries less than about a thousandth
/// of a whole one.
pub const LEAST_SHARE: f64 = 1e-3;

/// A slice of a contact line that touches or may touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSlice {
    /// Number of the line in the list of lines.
    pub line: usize,
    /// Number of the slice over the face width.
    pub slice: usize,
    /// Share of the slice's width that is on the path, more than zero and up to one.
    pub share: f64,
    /// Axial middle of that part \[m\].
    pub z_m: f64,
    /// The line in the section at `z_m`: its roll angles and its distance from the pitch point there.
    pub section: ContactLine,
}

impl ContactLines {
    /// A contact line in the section at `z_m`. Roll angles beyond the ends of the path are continued.
    pub fn section(&self, line: &ContactLine, z_m: f64) -> ContactLine {
        if !self.pair.is_helical() {
            return *line;
        }
        let roll_1_rad = line.roll_1_rad + z_m * self.pair.roll_slope_1_rad_per_m();
        ContactLine {
            roll_1_rad,
            roll_2_rad: self.pair.roll_2_rad(roll_1_rad),
            path_m: self.pair.path_from_pitch_point_m(roll_1_rad),
            ..*line
        }
    }

    /// Appends the slices of a line that touch. `line` is its number, `centres_m` and `width_m` are those of the slices.
    pub fn push_slices(
        &self,
        (number, line): (usize, &ContactLine),
        centres_m: &[f64],
        width_m: f64,
        slices: &mut Vec<ContactSlice>,
    ) {
        for (slice, &centre) in centres_m.iter().enumerate() {
            let Some((share, z_m)) = self.part_on_path(line, centre, width_m) else {
                continue;
            };
            slices.push(ContactSlice {
                line: number,
                slice,
                share,
                z_m,
                section: self.section(line, z_m),
            });
        }
    }

    /// Share of a slice on the path and the middle of that part; none where it is off the path.
    fn part_on_path(&self, line: &ContactLine, centre_m: f64, width_m: f64) -> Option<(f64, f64)> {
        if !self.pair.is_helical() {
            return Some((1.0, centre_m));
        }
        let slope = self.pair.roll_slope_1_rad_per_m();
        let at = |roll: f64| (roll - line.roll_1_rad) / slope;
        let (a, b) = (at(self.pair.roll_start_1_rad), at(self.pair.roll_end_1_rad));
        let low = (centre_m - 0.5 * width_m).max(a.min(b));
        let high = (centre_m + 0.5 * width_m).min(a.max(b));
        let share = (high - low) / width_m;
        (share > LEAST_SHARE).then_some((share.min(1.0), 0.5 * (low + high)))
    }
}
