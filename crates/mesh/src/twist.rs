//! How a helical gear's sections turn along the axis.
//!
//! The teeth turn by γ(z) = z tan β/r. A body of revolution may turn with them: it stays the same body, and no element
//! is sheared more than by the helix itself. Openings must stay straight: there the turn fades out between the root
//! circle and the openings' outer radius, by a polynomial that is flat at both ends; so do lugs, on the outside of a
//! ring.

use gearmesh_geometry::GearDefinition;

/// Turn of the sections of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Twist {
    /// Turn of the teeth per metre of z \[rad/m\], positive for a right hand; zero for a spur gear.
    pub teeth_rad_per_m: f64,
    /// Radii \[m\] at which nothing turns, and all as the teeth; none where all of the body turns.
    pub fade_m: Option<[f64; 2]>,
}

impl Twist {
    /// The twist of a gear.
    pub fn new(gear: &GearDefinition) -> Self {
        let rim = gear.blank.rim().filter(|rim| rim.lugs.is_some());
        let straight_m =
            (gear.blank.openings().map(|o| o.radii_m().1)).or(rim.map(|rim| rim.outer_radius_m));
        Self {
            teeth_rad_per_m: gear.profile.twist_rad_per_m(),
            fade_m: straight_m.map(|straight_m| [straight_m, gear.profile.root_radius_m]),
        }
    }

    /// Turn \[rad\] of a point at a radius and axial position.
    pub fn angle_rad(&self, radius_m: f64, z_m: f64) -> f64 {
        let share = self.fade_m.map_or(1.0, |[inner, outer]| {
            let s = ((radius_m - inner) / (outer - inner)).clamp(0.0, 1.0);
            s * s * (3.0 - 2.0 * s)
        });
        share * self.teeth_rad_per_m * z_m
    }

    /// A point of the section at z = 0 \[x, y\], turned to its place at z.
    pub fn point_m(&self, [x, y]: [f64; 2], z_m: f64) -> [f64; 3] {
        if self.teeth_rad_per_m == 0.0 {
            return [x, y, z_m];
        }
        let (sin, cos) = self.angle_rad(x.hypot(y), z_m).sin_cos();
        [cos * x - sin * y, sin * x + cos * y, z_m]
    }
}

#[cfg(test)]
mod tests {
    use super::Twist;

    #[test]
    fn the_turn_fades_smoothly_and_monotonically() {
        let twist = Twist {
            teeth_rad_per_m: 5.0,
            fade_m: Some([0.04, 0.07]),
        };
        assert_eq!(twist.angle_rad(0.03, 0.01), 0.0);
        assert_eq!(twist.angle_rad(0.08, 0.01), 0.05);
        assert!((twist.angle_rad(0.055, -0.01) + 0.025).abs() < 1e-15);
        let mut last = 0.0;
        for k in 0..=100 {
            let angle = twist.angle_rad(0.04 + 0.0003 * f64::from(k), 0.01);
            assert!(angle >= last && angle - last < 1.6 * 0.05 / 100.0);
            last = angle;
        }
    }
}
