//! Microgeometry: material removed from the ideal involute flank, in metres along the flank normal.
//!
//! The laws add up. Formulas and signs: docs/theory/microgeometry.md.
//!
//! | law | type |
//! | --- | --- |
//! | tip relief, root relief, profile crowning | `profile.rs` |
//! | end relief | `lead.rs` |
//! | profile angle, lead crowning, flank angle, twist | numbers of [`Microgeometry`] |
//! | any table over the flank | `topography.rs` |

mod description;
mod lead;
mod profile;
mod topography;

pub use lead::{EndRelief, FaceEnds};
pub use profile::{ProfileCrowning, ProfileRelief, ReliefShape, RootRelief, TipRelief};
pub use topography::{Topography, TopographyError};

use crate::flank::Flank;
use crate::flank_error::{FlankError, FlankPoint, Removed};

/// All modifications of the flanks of one hand of a gear, the same on all teeth.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Microgeometry {
    /// Roll angle at the form circle, where the involute begins \[rad\].
    pub form_roll_rad: f64,
    /// Roll angle at the tip circle \[rad\]: where the profile amounts are stated.
    pub tip_roll_rad: f64,
    /// Face width \[m\]: where the lead amounts are stated.
    pub face_width_m: f64,
    /// Profile crowning, if any.
    pub profile_crowning: Option<ProfileCrowning>,
    /// Tip relief, if any.
    pub tip_relief: Option<TipRelief>,
    /// Root relief, if any.
    pub root_relief: Option<RootRelief>,
    /// Profile slope \[m\] over the whole involute: half of it removed at the tip circle, half added at the form
    /// circle.
    pub profile_angle_m: f64,
    /// Lead crowning \[m\]: a parabola over the face width, zero at mid-face, this amount at both ends.
    pub lead_crowning_m: f64,
    /// Flank line slope \[m\] over the whole face width: removed at +z, added at −z, zero at mid-face.
    pub flank_angle_m: f64,
    /// End relief, if any.
    pub end_relief: Option<EndRelief>,
    /// Twist \[m\]: the profile slope at the face towards +z less that at the one towards −z.
    pub twist_m: f64,
    /// A table over the flank, if any.
    pub topography: Option<Topography>,
}

impl Microgeometry {
    /// Material removed e(ξ, z), positive into the material, and its derivatives, at roll angle `roll_rad` and axial
    /// position `z_m` from mid-face.
    #[must_use]
    pub fn removed(&self, roll_rad: f64, z_m: f64) -> Removed {
        let mut sum = Removed::default();
        if let Some(c) = self.profile_crowning {
            let span = self.tip_roll_rad - c.centre_roll_rad;
            let s = (roll_rad - c.centre_roll_rad) / span;
            sum.depth_m += c.amount_m * s.powi(2);
            sum.slope_m_per_rad += 2.0 * c.amount_m * s / span;
        }
        if let Some(r) = self.tip_relief {
            let span = self.tip_roll_rad - r.start_roll_rad;
            let s = (roll_rad - r.start_roll_rad) / span;
            let (depth, by_s) = r.shape.removed_m(r.amount_m, s);
            sum.depth_m += depth;
            sum.slope_m_per_rad += by_s / span;
        }
        if self.face_width_m > 0.0 {
            let eta = z_m / self.face_width_m;
            sum.depth_m += self.lead_crowning_m * 4.0 * eta * eta + self.flank_angle_m * eta;
            sum.slope_along_axis +=
                (self.lead_crowning_m * 8.0 * eta + self.flank_angle_m) / self.face_width_m;
        }
        self.add_rarer(roll_rad, z_m, &mut sum);
        sum
    }

    /// Material removed \[m\], see [`Microgeometry::removed`].
    #[must_use]
    pub fn removed_m(&self, roll_rad: f64, z_m: f64) -> f64 {
        self.removed(roll_rad, z_m).depth_m
    }

    /// The laws that most gears do without.
    fn add_rarer(&self, roll_rad: f64, z_m: f64, sum: &mut Removed) {
        if let Some(r) = self.root_relief {
            let span = r.start_roll_rad - self.form_roll_rad;
            let s = (r.start_roll_rad - roll_rad) / span;
            // Below the form circle there is no flank.
            let (depth, by_s) = r.shape.removed_m(r.amount_m, s.min(1.0));
            sum.depth_m += depth;
            sum.slope_m_per_rad -= if s < 1.0 { by_s / span } else { 0.0 };
        }
        if self.profile_angle_m != 0.0 || self.twist_m != 0.0 {
            let span = self.tip_roll_rad - self.form_roll_rad;
            let zeta = (roll_rad - self.form_roll_rad) / span - 0.5;
            let eta = z_m / self.face_width_m;
            let slope = self.profile_angle_m + self.twist_m * eta;
            sum.depth_m += slope * zeta;
            sum.slope_m_per_rad += slope / span;
            sum.slope_along_axis += self.twist_m * zeta / self.face_width_m;
        }
        if let Some(r) = self.end_relief {
            let (depth, by_z) = r.removed_m(z_m, self.face_width_m);
            sum.depth_m += depth;
            sum.slope_along_axis += by_z;
        }
        if let Some(table) = &self.topography {
            let [depth, by_roll, by_z] = table.removed(roll_rad, z_m);
            sum.depth_m += depth;
            sum.slope_m_per_rad += by_roll;
            sum.slope_along_axis += by_z;
        }
    }

    /// Bound of the material added anywhere on the flank \[m\], zero or positive: what negative amounts and the slopes
    /// add, each where it adds most.
    #[must_use]
    pub fn most_added_m(&self) -> f64 {
        let added = |amount_m: f64| (-amount_m).max(0.0);
        // The far end of the flank: at the base circle, of a ring, whose tip has the smallest roll angle, at the form
        // circle.
        let far_roll = if self.form_roll_rad > self.tip_roll_rad {
            self.form_roll_rad
        } else {
            0.0
        };
        let profile = self.profile_crowning.map_or(0.0, |c| {
            let far = (far_roll - c.centre_roll_rad) / (self.tip_roll_rad - c.centre_roll_rad);
            added(c.amount_m) * far.powi(2).max(1.0)
        });
        let reliefs = self.tip_relief.map_or(0.0, |r| added(r.amount_m))
            + self.root_relief.map_or(0.0, |r| added(r.amount_m))
            + self.end_relief.map_or(0.0, |r| added(r.amount_m));
        let lead = added(self.lead_crowning_m) + 0.5 * self.flank_angle_m.abs();
        let slope = self.profile_angle_m.abs() + 0.5 * self.twist_m.abs();
        let slopes = if slope > 0.0 {
            let span = self.tip_roll_rad - self.form_roll_rad;
            slope * ((self.form_roll_rad - far_roll) / span + 0.5)
        } else {
            0.0
        };
        let table = (self.topography.as_ref()).map_or(0.0, |table| added(table.extremes_m()[1]));
        profile + reliefs + lead + slopes + table
    }

    /// Whether nothing is removed anywhere.
    #[must_use]
    pub fn is_none(&self) -> bool {
        let reliefs = [
            self.tip_relief.map(|r| r.amount_m),
            self.root_relief.map(|r| r.amount_m),
            self.end_relief.map(|r| r.amount_m),
            self.profile_crowning.map(|c| c.amount_m),
        ];
        let mut amounts = (reliefs.into_iter().flatten()).chain([
            self.profile_angle_m,
            self.lead_crowning_m,
            self.flank_angle_m,
            self.twist_m,
        ]);
        let table = self.topography.as_ref();
        amounts.all(|amount| amount == 0.0)
            && table.is_none_or(|table| table.extremes_m() == [0.0; 2])
    }
}

impl FlankError for Microgeometry {
    fn removed(&self, at: FlankPoint) -> Removed {
        Self::removed(self, at.roll_rad, at.z_m)
    }

    fn most_added_m(&self) -> f64 {
        Self::most_added_m(self)
    }
}

/// The microgeometry of a gear: of its right and its left flanks.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GearMicrogeometry {
    /// Of the right flanks.
    pub right: Microgeometry,
    /// Of the left flanks.
    pub left: Microgeometry,
}

impl GearMicrogeometry {
    /// The microgeometry of the flanks of one side.
    #[must_use]
    pub fn of(&self, side: Flank) -> &Microgeometry {
        match side {
            Flank::Right => &self.right,
            Flank::Left => &self.left,
        }
    }

    /// Whether nothing is removed anywhere.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.right.is_none() && self.left.is_none()
    }
}

impl FlankError for GearMicrogeometry {
    fn removed(&self, at: FlankPoint) -> Removed {
        self.of(at.side).removed(at.roll_rad, at.z_m)
    }

    fn most_added_m(&self) -> f64 {
        self.right.most_added_m().max(self.left.most_added_m())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts_stand_where_they_are_stated() {
        let flank = Microgeometry {
            tip_roll_rad: 0.5,
            face_width_m: 0.02,
            profile_crowning: Some(ProfileCrowning {
                amount_m: 10e-6,
                centre_roll_rad: 0.4,
            }),
            ..Default::default()
        };
        assert!(flank.removed_m(0.4, 0.003).abs() < 1e-18);
        assert!((flank.removed_m(0.5, 0.0) - 10e-6).abs() < 1e-18);
        assert!((flank.removed_m(0.3, 0.0) - 10e-6).abs() < 1e-18);

        let relief = Microgeometry {
            tip_roll_rad: 0.5,
            face_width_m: 0.02,
            tip_relief: Some(TipRelief {
                amount_m: 20e-6,
                start_roll_rad: 0.4,
                shape: ReliefShape::Parabolic,
            }),
            lead_crowning_m: 4e-6,
            flank_angle_m: 6e-6,
            ..Default::default()
        };
        assert!((relief.removed_m(0.45, 0.0) - 5e-6).abs() < 1e-18);
        assert!(
            (relief.removed_m(0.1, 0.01) - 7e-6).abs() < 1e-18,
            "lead crowning plus half the slope"
        );
        assert!((relief.removed_m(0.1, -0.01) - 1e-6).abs() < 1e-18);
        assert_eq!(flank.most_added_m(), 0.0);
        assert!((relief.most_added_m() - 3e-6).abs() < 1e-18);
    }

    #[test]
    fn root_relief_end_relief_and_slopes_stand_where_they_are_stated() {
        let flank = Microgeometry {
            form_roll_rad: 0.1,
            tip_roll_rad: 0.5,
            face_width_m: 0.02,
            root_relief: Some(RootRelief {
                amount_m: 8e-6,
                start_roll_rad: 0.2,
                shape: ReliefShape::Linear,
            }),
            profile_angle_m: 6e-6,
            end_relief: Some(EndRelief {
                amount_m: 10e-6,
                length_m: 0.004,
                shape: ReliefShape::Parabolic,
                ends: FaceEnds::Positive,
            }),
            twist_m: 4e-6,
            ..Default::default()
        };
        // (roll, z, removed): at the form circle half the profile slope is added.
        for (roll, z, expected) in [
            (0.1, 0.0, 8e-6 - 3e-6),
            (0.15, 0.0, 4e-6 - 2.25e-6),
            (0.3, 0.0, 0.0),
            (0.5, 0.0, 3e-6),
            (0.5, 0.01, 3e-6 + 10e-6 + 1e-6),
            (0.5, 0.008, 3e-6 + 2.5e-6 + 0.8e-6),
            (0.5, -0.01, 3e-6 - 1e-6),
            (0.1, -0.01, 8e-6 - 3e-6 + 1e-6),
        ] {
            let found = flank.removed_m(roll, z);
            assert!((found - expected).abs() < 1e-17, "{roll} {z} {found:e}");
        }
    }

    /// The arc is a circle: its points have one distance R from a centre above the start, and it ends at the amount.
    #[test]
    fn an_arc_is_a_circle_that_touches_the_flank() {
        for amount in [25e-6, -25e-6, 1.5e-3] {
            let (length, s) = (2e-3, 0.7);
            let arc = ReliefShape::Arc { length_m: length };
            let radius = (length * length + amount * amount) / (2.0 * f64::abs(amount));
            assert!((arc.removed_m(amount, 1.0).0 / amount - 1.0).abs() < 1e-14);
            let depth = arc.removed_m(amount, s).0.abs();
            let to_centre = (s * length).hypot(radius - depth);
            assert!((to_centre / radius - 1.0).abs() < 1e-14, "{to_centre}");
            assert_eq!(arc.removed_m(amount, 0.0), (0.0, 0.0));
        }
        // A shallow arc is a parabola up to (C/L)².
        let (arc, amount) = (ReliefShape::Arc { length_m: 5e-3 }, 20e-6);
        let parabola = ReliefShape::Parabolic.removed_m(amount, 0.5).0;
        assert!((arc.removed_m(amount, 0.5).0 / parabola - 1.0).abs() < 2e-5);
    }

    /// A bilinear function is met exactly, at and between the points; beyond the borders the table is held.
    #[test]
    fn a_topography_is_bilinear_and_held_beyond_its_borders() {
        let exact = |roll: f64, z: f64| 1e-6 + 3e-5 * roll - 2e-4 * z + 1e-2 * roll * z;
        let (rolls, heights) = (vec![0.1, 0.2, 0.5], vec![-0.01, 0.002, 0.01]);
        let values = (rolls.iter())
            .flat_map(|roll| heights.iter().map(|z| exact(*roll, *z)))
            .collect();
        let table = Topography::new(rolls, heights, values).unwrap_or_else(|e| panic!("{e}"));
        for (roll, z) in [(0.1, -0.01), (0.13, 0.001), (0.41, 0.0099), (0.5, 0.01)] {
            let [depth, ..] = table.removed(roll, z);
            assert!((depth - exact(roll, z)).abs() < 1e-19, "{roll} {z}");
        }
        let [_, by_roll, by_z] = table.removed(0.3, 0.004);
        assert!((by_roll - (3e-5 + 1e-2 * 0.004)).abs() < 1e-16);
        assert!((by_z - (-2e-4 + 1e-2 * 0.3)).abs() < 1e-15);
        assert_eq!(table.removed(0.7, -1.0), [exact(0.5, -0.01), 0.0, 0.0]);
        assert!(Topography::new(vec![0.1, 0.1], vec![0.0], vec![0.0; 2]).is_err());
        assert!(Topography::new(vec![0.1], vec![0.0], vec![0.0; 2]).is_err());
    }
}
