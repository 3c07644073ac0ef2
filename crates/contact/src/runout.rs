//! Gears that stand beside, or tilted to, the axes about which they turn: runout and wobble of a pair in static
//! positions.
//!
//! Gear k's axis stands at e_k from the axis of its body and turns with it, so that the gears have the distance and
//! direction d = (a, 0) + e₂ − e₁ = a′ (cos β, sin β), seen along gear 1's z with the driver turning clockwise (the
//! mirror image on left flanks). With cos α′ = |R|/a′, R = r_b1 + r_b2 and the signs s_k of rings
//! ([`gearmesh_geometry::BaseCircles`]), and tooth 0 of each gear at the place that conventions.md gives it,
//!
//! ```text
//! ξ₁ = tan α + s₁ (θ₁ + β) + α′ − α     as of a pair at a′ whose driver stands at θ₁ + β − s₁ (inv α′ − inv α)
//! g  = R (inv α′ − inv α − s₁ β) + TE       ideal flanks; to first order w·(e₂ − e₁) + TE
//! ```
//!
//! with w the direction of the force on gear 2 at α′, turned by β. Torques are those about the bodies'
//! axes in their senses of turning: the lever arms grow by s₁ s₂ e₂ × w on gear 2 and by −e₁ × w on gear 1, which are
//! the derivatives of g by the angles. Tilted axes misalign the pair by an amount that turns with them. Gear 2's angle
//! is that of rigid ideal flanks, TE = −opening, about which the gap is linear in TE; what deflection turns e₂ further
//! is some 10⁻⁴ of it.

use crate::contact_lines::ContactLines;
use crate::tip_contact::PathExtension;
use gearmesh_geometry::{Flank, GearPair, Misalignment};

/// Place of a gear on its body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GearSeat {
    /// Distance of the gear's axis from the body's \[m\].
    pub offset_m: f64,
    /// Direction of that offset from the middle of tooth 0, counter-clockwise \[rad\].
    pub direction_rad: f64,
    /// Tilt of the gear's axis \[rad\].
    pub tilt_rad: f64,
    /// Direction of the axis of that tilt from the middle of tooth 0 \[rad\].
    pub tilt_direction_rad: f64,
}

/// Both gears on their bodies, which turn about axes at the pair's centre distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Runout {
    seats: [GearSeat; 2],
    centre_distance_m: f64,
    misalignment: Misalignment,
}

/// Where the gears stand at a driver angle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Placement {
    /// a′ \[m\]; none where the gears stand as the pair has them.
    pair: Option<(f64, Misalignment)>,
    /// What the driver angle of the pair at a′ is ahead of the body's \[rad\].
    pub ahead_rad: f64,
    /// Gap of ideal flanks at zero transmission error in the transverse plane \[m\].
    pub opening_m: f64,
    /// What the lever arms of the transverse force about the bodies' axes have more than the base radii \[m\].
    pub arms_m: [f64; 2],
}

impl Runout {
    /// Gears of a pair on their seats.
    #[must_use]
    pub fn new(pair: &GearPair, seats: [GearSeat; 2]) -> Self {
        Self {
            seats,
            centre_distance_m: pair.centre_distance_m,
            misalignment: pair.misalignment,
        }
    }

    /// The gears' places at a driver angle. Of `pair` only what does not change with the distance is read.
    #[must_use]
    pub fn at(&self, pair: &GearPair, driver_angle_rad: f64) -> Placement {
        let [base_1, base_2] = [pair.gear_1.base_radius_m, pair.gear_2.base_radius_m];
        let ideal_rad = driver_angle_rad * base_1 / base_2;
        // The runout itself turns gear 2 on or back.
        let first = self.at_angles(pair, [driver_angle_rad, ideal_rad]);
        let turned_rad = ideal_rad - first.opening_m / base_2;
        self.at_angles(pair, [driver_angle_rad, turned_rad])
    }

    /// The gears' places at angles of both.
    fn at_angles(&self, pair: &GearPair, angles_rad: [f64; 2]) -> Placement {
        let circles = pair.circles();
        let (sum, sense) = (circles.sum_m(), circles.sense(0));
        let nominal = (sum.abs() / self.centre_distance_m).acos();
        // +1 on right flanks, −1 on left ones, which are seen in the mirror.
        let hand = pair.flank.mirror();
        let middles = pair.tooth_middles_rad((self.centre_distance_m, angles_rad));
        let offset = |k: usize| {
            let seat = &self.seats[k];
            let (sin, cos) = (middles[k] + seat.direction_rad).sin_cos();
            [seat.offset_m * cos, hand * seat.offset_m * sin]
        };
        // How the axis leans, per metre of z.
        let slope = |k: usize| {
            let seat = &self.seats[k];
            let (sin, cos) = (middles[k] + seat.tilt_direction_rad).sin_cos();
            [seat.tilt_rad * sin, -hand * seat.tilt_rad * cos]
        };
        let (e, s) = ([offset(0), offset(1)], [slope(0), slope(1)]);
        let d = [
            self.centre_distance_m + e[1][0] - e[0][0],
            e[1][1] - e[0][1],
        ];
        let (distance, turned) = (d[0].hypot(d[1]), d[1].atan2(d[0]));
        let alpha = (sum.abs() / distance).acos();
        let involute = (alpha.tan() - alpha) - (nominal.tan() - nominal);
        // Along the line of centres and across it.
        let (sin, cos) = turned.sin_cos();
        let [along, across] = circles.action(alpha, Flank::Right);
        let (w_x, w_y) = (cos * along - sin * across, sin * along + cos * across);
        let moment = |e: [f64; 2]| e[0] * w_y - e[1] * w_x;
        // Right flanks open where gear 2's axis moves so across the line of centres.
        let opens = across.signum();
        let lean = [s[1][0] - s[0][0], s[1][1] - s[0][1]];
        let misalignment = Misalignment {
            inclination_rad: self.misalignment.inclination_rad + lean[0] * cos + lean[1] * sin,
            deviation_rad: self.misalignment.deviation_rad
                + opens * (lean[1] * cos - lean[0] * sin),
        };
        Placement {
            pair: Some((distance, misalignment)),
            ahead_rad: turned - sense * involute,
            opening_m: sum * (involute - sense * turned),
            arms_m: [-moment(e[0]), sense * circles.sense(1) * moment(e[1])],
        }
    }
}

impl ContactLines {
    /// Puts the gears into their places.
    pub fn place(&mut self, placement: &Placement) {
        let Some((centre_distance_m, misalignment)) = placement.pair else {
            return;
        };
        self.pair.move_to(centre_distance_m, misalignment);
        if let Some(extension) = &mut self.extension {
            *extension = PathExtension::new(&self.pair, extension.edge_radius_m);
        }
    }
}
