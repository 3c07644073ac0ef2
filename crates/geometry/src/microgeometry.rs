//! Microgeometry: material removed from the ideal involute flank, in metres along the flank normal.

/// Shape of a tip relief between its start and the tip circle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ReliefShape {
    /// Grows with the roll length from the start.
    #[default]
    Linear,
    /// Grows with the square of the roll length from the start.
    Parabolic,
}

/// Profile crowning: a parabola in roll length, zero at `centre_roll_rad`, `amount_m` at the tip circle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ProfileCrowning {
    /// Material removed at the tip circle \[m\].
    pub amount_m: f64,
    /// Roll angle at the diameter where nothing is removed \[rad\].
    pub centre_roll_rad: f64,
}

/// Tip relief: zero up to `start_roll_rad`, `amount_m` at the tip circle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TipRelief {
    /// Material removed at the tip circle \[m\].
    pub amount_m: f64,
    /// Roll angle at which the relief starts \[rad\].
    pub start_roll_rad: f64,
    /// Linear or parabolic in roll length.
    pub shape: ReliefShape,
}

/// All modifications of the flanks of a gear. The same on both flanks.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Microgeometry {
    /// Roll angle at the tip circle \[rad\]: where the profile amounts are stated.
    pub tip_roll_rad: f64,
    /// Face width \[m\]: where the lead amounts are stated.
    pub face_width_m: f64,
    /// Profile crowning, if any.
    pub profile_crowning: Option<ProfileCrowning>,
    /// Tip relief, if any.
    pub tip_relief: Option<TipRelief>,
    /// Lead crowning \[m\]: a parabola over the face width, zero at mid-face, this amount at both ends.
    pub lead_crowning_m: f64,
    /// Flank line slope \[m\] over the whole face width: removed at +z, added at −z, zero at mid-face.
    pub flank_angle_m: f64,
}

impl Microgeometry {
    /// Material removed e(ξ, z) \[m\], positive into the material, at roll angle `roll_rad` and axial position
    /// `z_m` from mid-face.
    pub fn removed_m(&self, roll_rad: f64, z_m: f64) -> f64 {
        let profile = self.profile_crowning.map_or(0.0, |c| {
            let span = self.tip_roll_rad - c.centre_roll_rad;
            c.amount_m * ((roll_rad - c.centre_roll_rad) / span).powi(2)
        });
        let relief = self.tip_relief.map_or(0.0, |r| {
            let s =
                ((roll_rad - r.start_roll_rad) / (self.tip_roll_rad - r.start_roll_rad)).max(0.0);
            match r.shape {
                ReliefShape::Linear => r.amount_m * s,
                ReliefShape::Parabolic => r.amount_m * s * s,
            }
        });
        let lead = if self.face_width_m > 0.0 {
            let eta = z_m / self.face_width_m;
            self.lead_crowning_m * 4.0 * eta * eta + self.flank_angle_m * eta
        } else {
            0.0
        };
        profile + relief + lead
    }

    /// Bound of the material added anywhere on the flank \[m\], zero or positive: what negative amounts and the flank
    /// angle add, each where it adds most.
    pub fn most_added_m(&self) -> f64 {
        let added = |amount_m: f64| (-amount_m).max(0.0);
        let profile = self.profile_crowning.map_or(0.0, |c| {
            let at_base = c.centre_roll_rad / (self.tip_roll_rad - c.centre_roll_rad);
            added(c.amount_m) * at_base.powi(2).max(1.0)
        });
        let relief = self.tip_relief.map_or(0.0, |r| added(r.amount_m));
        let lead = added(self.lead_crowning_m) + 0.5 * self.flank_angle_m.abs();
        profile + relief + lead
    }

    /// ∂e/∂z, the slope of [`Microgeometry::removed_m`] along the axis. No unit.
    pub fn removed_slope_along_axis(&self, z_m: f64) -> f64 {
        if self.face_width_m > 0.0 {
            let eta = z_m / self.face_width_m;
            (self.lead_crowning_m * 8.0 * eta + self.flank_angle_m) / self.face_width_m
        } else {
            0.0
        }
    }

    /// ∂e/∂ξ \[m/rad\], the slope of [`Microgeometry::removed_m`] along the profile.
    pub fn removed_slope_m_per_rad(&self, roll_rad: f64) -> f64 {
        let profile = self.profile_crowning.map_or(0.0, |c| {
            let span = self.tip_roll_rad - c.centre_roll_rad;
            2.0 * c.amount_m * (roll_rad - c.centre_roll_rad) / (span * span)
        });
        let relief = self.tip_relief.map_or(0.0, |r| {
            let span = self.tip_roll_rad - r.start_roll_rad;
            let s = (roll_rad - r.start_roll_rad) / span;
            match r.shape {
                _ if s <= 0.0 => 0.0,
                ReliefShape::Linear => r.amount_m / span,
                ReliefShape::Parabolic => 2.0 * r.amount_m * s / span,
            }
        });
        profile + relief
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
        for (gear, roll) in [(&flank, 0.33), (&relief, 0.3), (&relief, 0.47)] {
            let change = gear.removed_m(roll + 1e-6, 0.002) - gear.removed_m(roll - 1e-6, 0.002);
            let slope = gear.removed_slope_m_per_rad(roll);
            assert!((change / 2e-6 - slope).abs() < 1e-12, "{slope}");
        }
    }
}
