//! The base circles of two gears that run together, and what follows from them alone.
//!
//! Lengths have the signs of ISO 21771: the base radius of a ring with internal teeth is negative, and with it the sum
//! R of both, the distance a of the axes and the length L of the line of action. Then one set of equations holds for
//! two external gears and for a ring and the gear inside it,
//!
//! ```text
//! R = r₁ + r₂,   cos α = R/a,   L = a sin α,   ρ_i = r_i ξ_i
//! g = L − ρ₁ − ρ₂                     gap of two flanks that cross the line of action at roll angles ξ₁ and ξ₂
//! 1/ρ = cos β_b (1/ρ₁ + 1/ρ₂)         relative curvature across the line of contact; the ring's flank is hollow, ρ negative
//! ```
//!
//! Roll angles are positive. Derivation: docs/theory/involute_flanks.md.

use crate::flank::Flank;
use crate::tooth::ToothGeometry;

/// The base circles of gear 1 and gear 2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseCircles {
    /// r₁ and r₂ \[m\]; negative of a ring.
    pub radii_m: [f64; 2],
}

impl BaseCircles {
    /// Those of two gears.
    #[must_use]
    pub fn new([gear_1, gear_2]: [&ToothGeometry; 2]) -> Self {
        Self {
            radii_m: [gear_1, gear_2].map(|gear| gear.tip_direction() * gear.base_radius_m),
        }
    }

    /// R \[m\].
    #[must_use]
    pub fn sum_m(&self) -> f64 {
        self.radii_m[0] + self.radii_m[1]
    }

    /// Whether one of the gears is a ring around the other.
    #[must_use]
    pub fn has_ring(&self) -> bool {
        self.radii_m[0] * self.radii_m[1] < 0.0
    }

    /// +1 for an external gear, −1 for a ring: the sense in which the roll angle grows towards the tip.
    #[must_use]
    pub fn sense(&self, gear: usize) -> f64 {
        1f64.copysign(self.radii_m[gear])
    }

    /// Side of the flanks of gear 0 or 1 that touch where gear 0 touches with `side_1`: the same of external gears, a
    /// ring and the gear inside touch with opposite ones.
    #[must_use]
    pub fn side_of(&self, gear: usize, side_1: Flank) -> Flank {
        if gear == 1 && self.has_ring() {
            side_1.opposite()
        } else {
            side_1
        }
    }

    /// σ = ±1: hand of a side of the teeth, given on gear 1, in the equations with signs. That of the right flank
    /// is +1, on a ring −1; it is the same of both gears.
    #[must_use]
    pub fn hand(&self, side_1: Flank) -> f64 {
        self.sense(0) * side_1.mirror()
    }

    /// Direction of the normal force on gear 2 in the transverse plane, gear 1 touching with `side_1`: (±sin α, ∓cos
    /// α), x from the axis of gear 1 to that of gear 2. A ring touches on the far side of its mate.
    #[must_use]
    pub fn action(&self, pressure_angle_rad: f64, side_1: Flank) -> [f64; 2] {
        let (sin, cos) = pressure_angle_rad.sin_cos();
        let along = 1f64.copysign(self.sum_m());
        [along * sin, -self.hand(side_1) * along * cos]
    }

    /// a \[m\] with its sign.
    #[must_use]
    pub fn signed_distance_m(&self, distance_m: f64) -> f64 {
        distance_m.copysign(self.sum_m())
    }

    /// Length L \[m\] of the line of action between the base circles and working pressure angle α \[rad\] at a distance
    /// of the axes without its sign; none where it is no number or not above |R|.
    #[must_use]
    pub fn line_of_action(&self, distance_m: f64) -> Option<(f64, f64)> {
        let sum = self.sum_m();
        let is_beyond = distance_m > sum.abs();
        is_beyond.then(|| {
            let length = ((distance_m - sum) * (distance_m + sum)).sqrt();
            (length.copysign(sum), length.atan2(sum.abs()))
        })
    }

    /// g \[m\] in the transverse plane, open positive.
    #[must_use]
    pub fn gap_m(&self, length_m: f64, roll_rad: [f64; 2]) -> f64 {
        let [r1, r2] = self.radii_m;
        length_m - r1 * roll_rad[0] - r2 * roll_rad[1]
    }

    /// Roll angle \[rad\] of the mate's flank that touches the one of `gear`, 0 or 1, at `roll_rad`.
    #[must_use]
    pub fn mate_roll_rad(&self, length_m: f64, (gear, roll_rad): (usize, f64)) -> f64 {
        (length_m - self.radii_m[gear] * roll_rad) / self.radii_m[1 - gear]
    }

    /// ρ \[m\] at these roll angles, and its growth as a share of itself per radian of both, (1 − ρ_i/(ρ₁ + ρ₂))/ξ_i.
    #[must_use]
    pub fn relative_radius(&self, roll_rad: [f64; 2], helix_cos: f64) -> (f64, [f64; 2]) {
        let rho = [0, 1].map(|gear: usize| self.radii_m[gear] * roll_rad[gear]);
        let sum = rho[0] + rho[1];
        (
            rho[0] * rho[1] / (sum * helix_cos),
            [rho[1] / (sum * roll_rad[0]), rho[0] / (sum * roll_rad[1])],
        )
    }

    /// (r₁ − r₂)/R. In the pitch point r₁ ξ₁ − r₂ ξ₂ is so much of L; it lies so much of ½ a beyond halfway between the
    /// axes.
    #[must_use]
    pub fn pitch_place(&self) -> f64 {
        let [r1, r2] = self.radii_m;
        (r1 - r2) / (r1 + r2)
    }
}
