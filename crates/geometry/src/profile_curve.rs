//! The outline of half a tooth by arc length: root arc, fillet, flank, chamfer, tip land.

use crate::definition::{Flank, RootPosition};
use crate::involute;
use crate::tooth::ToothGeometry;

/// Samples per piece of the arc-length table. Points are evaluated on the exact curve; only the arc length is
/// interpolated, to about 1e-6 of a piece.
const SAMPLES: usize = 400;

/// Why a position is not on the root fillet.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PositionError {
    /// No point of the fillet has this tangent.
    #[error(
        "found a tangent of {found_deg:.3} deg to the tooth's centre line, allowed is {low_deg:.3} to {high_deg:.3} deg on this fillet"
    )]
    Tangent {
        /// Angle asked for.
        found_deg: f64,
        /// Smallest on the fillet (at the flank).
        low_deg: f64,
        /// Largest on the fillet (at the root circle).
        high_deg: f64,
    },
    /// No point of the profile has this radius.
    #[error("found a radius of {found_mm:.4} mm, allowed is {low_mm:.4} to {high_mm:.4} mm")]
    Radius {
        /// Radius asked for.
        found_mm: f64,
        /// Root radius, of a ring the end of the flank.
        low_mm: f64,
        /// End of the flank, of a ring the root radius.
        high_mm: f64,
    },
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Piece {
    RootArc,
    Fillet,
    Flank,
    Chamfer,
    Tip,
}

#[derive(Debug, Clone, Copy)]
struct Sample {
    arc_length_m: f64,
    piece: Piece,
    parameter: f64,
}

/// The right half of a tooth's outline, from the centre of the tooth space to the centre of the tip land.
#[derive(Debug, Clone)]
pub struct ProfileCurve {
    tooth: ToothGeometry,
    samples: Vec<Sample>,
}

impl ProfileCurve {
    /// Tabulates the arc length of a tooth's outline.
    pub fn new(tooth: &ToothGeometry) -> Self {
        let space = tooth.space_angle_rad();
        let root_end = space + tooth.fillet.root_arc_rad();
        let mut pieces = Vec::new();
        if root_end > space {
            pieces.push((Piece::RootArc, space, root_end));
        }
        pieces.push((Piece::Fillet, 0.0, tooth.fillet_end));
        pieces.push((Piece::Flank, tooth.form_roll_rad, tooth.flank_end_roll_rad));
        if tooth.tip_chamfer_m > 0.0 {
            pieces.push((Piece::Chamfer, 0.0, 1.0));
        }
        pieces.push((Piece::Tip, -tooth.tip_half_angle_rad(), 0.0));

        let mut curve = Self {
            tooth: tooth.clone(),
            samples: Vec::with_capacity(pieces.len() * (SAMPLES + 1)),
        };
        let mut length = 0.0;
        for (piece, from, to) in pieces {
            let mut last = curve.point(piece, from);
            for k in 0..=SAMPLES {
                let parameter = from + (to - from) * k as f64 / SAMPLES as f64;
                let p = curve.point(piece, parameter);
                length += (p[0] - last[0]).hypot(p[1] - last[1]);
                last = p;
                curve.samples.push(Sample {
                    arc_length_m: length,
                    piece,
                    parameter,
                });
            }
        }
        curve
    }

    fn point(&self, piece: Piece, parameter: f64) -> [f64; 2] {
        let t = &self.tooth;
        let on_circle = |r: f64| [r * parameter.cos(), r * parameter.sin()];
        match piece {
            Piece::RootArc => on_circle(t.root_radius_m),
            Piece::Fillet => t.fillet.point_m(parameter),
            Piece::Flank => t.flank_point_m(Flank::Right, parameter),
            Piece::Chamfer => {
                let a = t.flank_point_m(Flank::Right, t.flank_end_roll_rad);
                let angle = -t.tip_half_angle_rad();
                let b = [t.tip_radius_m * angle.cos(), t.tip_radius_m * angle.sin()];
                [
                    a[0] + parameter * (b[0] - a[0]),
                    a[1] + parameter * (b[1] - a[1]),
                ]
            }
            Piece::Tip => on_circle(t.tip_radius_m),
        }
    }

    /// Length of the half outline \[m\].
    pub fn length_m(&self) -> f64 {
        self.samples.last().map_or(0.0, |s| s.arc_length_m)
    }

    /// Exact point \[x, y\] \[m\] of the outline at an arc length from the centre of the tooth space.
    pub fn point_at(&self, arc_length_m: f64) -> [f64; 2] {
        let k = self
            .samples
            .partition_point(|s| s.arc_length_m < arc_length_m)
            .clamp(1, self.samples.len() - 1);
        let (a, b) = (self.samples[k - 1], self.samples[k]);
        if a.piece != b.piece || b.arc_length_m <= a.arc_length_m {
            return self.point(b.piece, b.parameter);
        }
        let w =
            ((arc_length_m - a.arc_length_m) / (b.arc_length_m - a.arc_length_m)).clamp(0.0, 1.0);
        self.point(b.piece, a.parameter + w * (b.parameter - a.parameter))
    }

    /// Angle of the outline's tangent to the tooth's centre line \[rad\] at an arc length: π/2 on the root circle,
    /// small on the flank.
    pub fn tangent_angle_at_rad(&self, arc_length_m: f64) -> f64 {
        // Central differences on the exact curve, to 1e-8 of a radian.
        let step = 1e-5 * self.tooth.root_radius_m;
        let (a, b) = (
            self.point_at(arc_length_m - step),
            self.point_at(arc_length_m + step),
        );
        (b[1] - a[1]).atan2(self.tooth.tip_direction() * (b[0] - a[0]))
    }

    /// Arc length \[m\] at which the root fillet begins; zero where there is no arc of the root circle.
    pub fn root_arc_end_m(&self) -> f64 {
        self.first_of(Piece::Fillet)
    }

    /// Arc length \[m\] at which the involute flank begins.
    pub fn flank_start_m(&self) -> f64 {
        self.first_of(Piece::Flank)
    }

    /// Arc length \[m\] at which the usable flank ends.
    pub fn flank_end_m(&self) -> f64 {
        self.samples
            .iter()
            .rev()
            .find(|s| s.piece == Piece::Flank)
            .map_or(0.0, |s| s.arc_length_m)
    }

    /// Arc length \[m\] at which the tip land begins.
    pub fn tip_start_m(&self) -> f64 {
        self.first_of(Piece::Tip)
    }

    fn first_of(&self, piece: Piece) -> f64 {
        self.samples
            .iter()
            .find(|s| s.piece == piece)
            .map_or(0.0, |s| s.arc_length_m)
    }

    /// Arc length \[m\] of a flank point by its roll angle (clamped to the flank).
    pub fn arc_length_at_roll_m(&self, roll_rad: f64) -> f64 {
        // On an involute s = r_b ξ²/2, exactly.
        let t = &self.tooth;
        let [low, high] = t.flank_rolls_rad();
        let roll = roll_rad.clamp(low, high);
        self.flank_start_m()
            + 0.5 * t.base_radius_m * (roll * roll - t.form_roll_rad * t.form_roll_rad).abs()
    }

    /// Arc length \[m\] of a position on the root fillet.
    ///
    /// # Errors
    /// [`PositionError`] when no point of the fillet (or profile) has this tangent angle (radius).
    pub fn arc_length_at(&self, position: RootPosition) -> Result<f64, PositionError> {
        let t = &self.tooth;
        match position {
            RootPosition::TangentAngle(angle) => {
                let end = t.fillet_end;
                let parameter =
                    t.fillet
                        .parameter_at_tangent(angle, end)
                        .ok_or(PositionError::Tangent {
                            found_deg: angle.to_degrees(),
                            low_deg: t.fillet.tangent_angle_rad(end).to_degrees(),
                            high_deg: t.fillet.tangent_angle_rad(0.0).to_degrees(),
                        })?;
                Ok(self.interpolate(
                    |s| (s.piece == Piece::Fillet).then(|| s.parameter / end),
                    parameter / end,
                ))
            }
            RootPosition::Radius(radius) => {
                let end = involute::radius_m(t.flank_end_roll_rad, t.base_radius_m);
                let (low, high) = (end.min(t.root_radius_m), end.max(t.root_radius_m));
                if !(radius > low && radius < high) {
                    return Err(PositionError::Radius {
                        found_mm: radius * 1e3,
                        low_mm: low * 1e3,
                        high_mm: high * 1e3,
                    });
                }
                // Grows from root to tip.
                let height_of = |s: &Sample| {
                    matches!(s.piece, Piece::Fillet | Piece::Flank).then(|| {
                        let p = self.point(s.piece, s.parameter);
                        t.tip_direction() * p[0].hypot(p[1])
                    })
                };
                Ok(self.interpolate(height_of, t.tip_direction() * radius))
            }
        }
    }

    /// Arc length \[m\] of the point of the outline, below the tip land, that has the same radius as `point_m`, and the
    /// distance \[m\] of the two along their circle, positive towards the tooth's centre line. On the root arc, where
    /// all points have one radius, the point at the same angle and the radial distance, positive from the root circle
    /// towards the tip. The inverse of [`ProfileCurve::point_at`] on the outline itself.
    pub fn place_of(&self, point_m: [f64; 2]) -> (f64, f64) {
        let t = &self.tooth;
        let (radius, angle) = (point_m[0].hypot(point_m[1]), point_m[1].atan2(point_m[0]));
        let arc_end = self.first_of(Piece::Fillet);
        let space = t.space_angle_rad();
        let from_space = (angle - space) * t.root_radius_m;
        let above_root = t.tip_direction() * (radius - t.root_radius_m);
        if from_space < arc_end && above_root < 1e-3 * t.root_radius_m {
            return (from_space.max(0.0), above_root);
        }
        let radius_at = |s: f64| {
            let p = self.point_at(s);
            p[0].hypot(p[1])
        };
        // From the fillet's start to the tip corner the radius goes one way. Halving goes on to the last bit.
        let (mut low, mut high) = (arc_end, self.tip_start_m());
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if t.is_towards_tip(radius, radius_at(middle)) {
                low = middle;
            } else {
                high = middle;
            }
        }
        let p = self.point_at(high);
        (high, (angle - p[1].atan2(p[0])) * radius)
    }

    /// Arc length at which a quantity that grows along the samples for which it exists reaches `value`.
    fn interpolate(&self, quantity: impl Fn(&Sample) -> Option<f64>, value: f64) -> f64 {
        let mut last: Option<(f64, f64)> = None;
        for s in &self.samples {
            let Some(q) = quantity(s) else { continue };
            if q >= value {
                return match last {
                    Some((q0, s0)) if q > q0 => {
                        s0 + (s.arc_length_m - s0) * (value - q0) / (q - q0)
                    }
                    _ => s.arc_length_m,
                };
            }
            last = Some((q, s.arc_length_m));
        }
        last.map_or(0.0, |(_, s)| s)
    }

    /// Distance \[m\] along the inward normal from the right flank at `roll_rad` to the opposite side of the tooth.
    ///
    /// Low on the flank the normal leaves the tooth through its foot instead: then the distance to the root circle,
    /// t = ±(r_b ξ − √(r_f² − r_b²)), − inside a ring (the normal is a tangent of the base circle), or to the point of
    /// tangency where the root lies inside the base circle.
    pub fn opposite_distance_m(&self, roll_rad: f64) -> f64 {
        let p = self.tooth.flank_point_m(Flank::Right, roll_rad);
        let (n, _) = self.tooth.flank_frame(Flank::Right, roll_rad);
        let mirrored = |s: &Sample| {
            let q = self.point(s.piece, s.parameter);
            [q[0], -q[1]]
        };
        let t = &self.tooth;
        let below_base =
            (t.root_radius_m * t.root_radius_m - t.base_radius_m * t.base_radius_m).max(0.0);
        let best = t.tip_direction() * (t.base_radius_m * roll_rad - below_base.sqrt());
        let opposite: Vec<[f64; 2]> = self.samples.iter().map(mirrored).collect();
        best.min(distance_to_line_m(p, n, &opposite))
    }
}

/// Distance \[m\] from a point along a unit vector to the nearest crossing of a line through points; infinite where it
/// crosses none.
pub fn distance_to_line_m(p: [f64; 2], n: [f64; 2], line: &[[f64; 2]]) -> f64 {
    let mut best = f64::INFINITY;
    for pair in line.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let e = [b[0] - a[0], b[1] - a[1]];
        let det = n[1] * e[0] - n[0] * e[1];
        if det.abs() < 1e-300 {
            continue;
        }
        let d = [a[0] - p[0], a[1] - p[1]];
        let along = (d[1] * e[0] - d[0] * e[1]) / det;
        let within = (n[0] * d[1] - n[1] * d[0]) / det;
        if along > 0.0 && (-1e-9..=1.0 + 1e-9).contains(&within) {
            best = best.min(along);
        }
    }
    best
}
