//! Which tooth pairs touch at a driver angle, where, and how far their slices stand apart unloaded.

use gearmesh_geometry::{GearPair, Microgeometry};

/// Coulomb friction between the flanks, regularised at the pitch point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Coefficient μ.
    pub coefficient: f64,
    /// Half width of the path around the pitch point over which the friction force reverses \[m\].
    pub reversal_m: f64,
}

impl Friction {
    /// Friction force over normal force, signed: positive towards the tips of *both* gears (after the pitch point).
    ///
    /// Sliding changes its sign at the pitch point; within ±`reversal_m` of it the coefficient runs linearly.
    pub fn ratio(&self, path_from_pitch_point_m: f64) -> f64 {
        self.coefficient * (path_from_pitch_point_m / self.reversal_m).clamp(-1.0, 1.0)
    }
}

/// One line of contact: a tooth pair at a driver angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactLine {
    /// Pair number p: gear 1 tooth p with gear 2 tooth −p.
    pub pair: i64,
    /// Tooth of gear 1.
    pub tooth_1: usize,
    /// Tooth of gear 2.
    pub tooth_2: usize,
    /// Roll angle on gear 1 \[rad\].
    pub roll_1_rad: f64,
    /// Roll angle on gear 2 \[rad\].
    pub roll_2_rad: f64,
    /// Distance from the pitch point along the path of contact, positive after it \[m\].
    pub path_m: f64,
}

/// Rigid kinematics of a pair with its microgeometry: contact lines and unloaded gaps.
#[derive(Debug, Clone)]
pub struct ContactLines {
    /// The pair.
    pub pair: GearPair,
    /// Microgeometry of gear 1.
    pub microgeometry_1: Microgeometry,
    /// Microgeometry of gear 2.
    pub microgeometry_2: Microgeometry,
}

impl ContactLines {
    /// Fills `lines` with the pairs on the path of contact at a driver angle.
    pub fn at(&self, driver_angle_rad: f64, lines: &mut Vec<ContactLine>) {
        lines.clear();
        let wrap = |tooth: i64, teeth: usize| tooth.rem_euclid(teeth as i64) as usize;
        lines.extend(self.pair.pairs_in_contact(driver_angle_rad).map(|pair| {
            let roll_1_rad = self.pair.roll_1_rad(driver_angle_rad, pair);
            ContactLine {
                pair,
                tooth_1: wrap(pair, self.pair.gear_1.teeth),
                tooth_2: wrap(-pair, self.pair.gear_2.teeth),
                roll_1_rad,
                roll_2_rad: self.pair.roll_2_rad(roll_1_rad),
                path_m: self.pair.path_from_pitch_point_m(roll_1_rad),
            }
        }));
    }

    /// Largest number of pairs in contact at once.
    pub fn most_pairs(&self) -> usize {
        self.pair.contact_ratio().floor() as usize + 1
    }

    /// Unloaded separation \[m\] of a slice at zero transmission error: material removed from both flanks and
    /// misalignment, open positive.
    pub fn separation_m(&self, line: &ContactLine, z_m: f64) -> f64 {
        self.microgeometry_1.removed_m(line.roll_1_rad, z_m)
            + self.microgeometry_2.removed_m(line.roll_2_rad, z_m)
            + self.pair.misalignment_gap_m(z_m)
    }

    /// Relative radius of curvature ρ₁ρ₂/(ρ₁ + ρ₂) \[m\].
    pub fn relative_radius_m(&self, line: &ContactLine) -> f64 {
        let (a, b) = self.pair.curvature_radii_m(line.roll_1_rad);
        a * b / (a + b)
    }
}
