//! Pockets of a cage: what a ball feels there, continuous in its displacement.
//!
//! With d the displacement of the ball from the pocket's middle (across the pocket's axis, or in all directions where
//! the pocket is a sphere) and z = |d|,
//!
//! ```text
//! P = K_c z                         z ≤ C_p      film
//! P = K_c C_p + K_n (z − C_p)^1.5   z > C_p      film and solid contact
//! ```

use gearmesh_dynamics::BodyMotion;
use nalgebra::{Matrix3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::rebound::Rebound;
use super::surface_contact::{ElasticLoad, Touch};
use super::traction::Traction;
use crate::error::BearingError;

/// Shape of a pocket.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PocketShape {
    /// A bore along the radius: the ball may move along it.
    #[default]
    Cylindrical,
    /// A sphere, which holds the ball every way: the balls guide the cage.
    Spherical,
}

/// The pockets of one row.
#[derive(Debug, Clone)]
pub struct Pockets {
    /// Shape.
    pub shape: PocketShape,
    /// C_p \[m\]: play to each side.
    pub clearance_m: f64,
    /// K_c \[N/m\]; 0 without film.
    pub film_stiffness_n_per_m: f64,
    /// K_n \[N/m^1.5\].
    pub contact_stiffness_n_per_m15: f64,
    /// Damping.
    pub rebound: Rebound,
    /// Friction of the balls in the pockets, if any: a Coulomb law or a table.
    pub traction: Option<Traction>,
}

impl Pockets {
    /// The pockets, if their numbers make sense.
    ///
    /// # Errors
    /// [`BearingError::Parameter`] where a number is negative, or friction goes by a fluid, which needs a Hertz
    /// contact.
    pub fn validated(self) -> Result<Self, BearingError> {
        let (film, solid) = (
            self.film_stiffness_n_per_m,
            self.contact_stiffness_n_per_m15,
        );
        BearingError::not_negative("the pocket clearance in m", self.clearance_m)?;
        BearingError::not_negative("the stiffness of the pocket's film in N/m", film)?;
        BearingError::not_negative("the stiffness of the pocket in N/m^1.5", solid)?;
        if matches!(self.traction, Some(Traction::Fluid(_))) {
            return Err(BearingError::NotCarried(
                "friction in pockets goes by a coefficient or a table: a fluid's law needs the ellipse of a Hertz contact",
            ));
        }
        Ok(self)
    }

    /// The touch of a ball in the pocket at the angle θ of the cage; the approach is z, above 0 everywhere.
    pub(crate) fn touch(
        &self,
        ball: &Vector3<f64>,
        cage: &BodyMotion,
        radius_m: f64,
        (sine, cosine): (f64, f64),
    ) -> Touch {
        let axes = &cage.rotation;
        let along = axes * Vector3::new(cosine, sine, 0.0);
        let mut d = ball - cage.position_m - along * radius_m;
        let mut free = Matrix3::identity();
        if self.shape == PocketShape::Cylindrical {
            d -= along * d.dot(&along);
            free -= along * along.transpose();
        }
        // A picometre keeps the direction smooth in the middle.
        let z = (d.norm_squared() + 1e-24).sqrt();
        let normal = d / z;
        Touch {
            approach_m: z,
            normal,
            turning: (free - normal * normal.transpose()) / z,
            by_turn: None,
        }
    }

    /// The load at a displacement z.
    pub(crate) fn load(&self, z_m: f64) -> ElasticLoad {
        let (film, play) = (self.film_stiffness_n_per_m, self.clearance_m);
        let beyond = z_m - play;
        if beyond <= 0.0 {
            return ElasticLoad {
                load_n: film * z_m,
                slope_n_per_m: film,
                stored_j: 0.5 * film * z_m * z_m,
            };
        }
        let slope = self.contact_stiffness_n_per_m15 * beyond.sqrt();
        ElasticLoad {
            load_n: film * play + slope * beyond,
            slope_n_per_m: 1.5 * slope,
            stored_j: film * play * (0.5 * play + beyond) + 0.4 * slope * beyond * beyond,
        }
    }
}
