//! A force on a ball by a surface of a body, brought to the ball's coordinates and the body's degrees of freedom.
//!
//! With X, V the body's reference point and its velocity, Ω its angular velocity (world axes), r = x − X and the force
//! f and moment m on the ball, the body feels −f and −(r × f + m) about X. For a body that turns by δφ the surface
//! turns with it, and so does the force, so that
//!
//! ```text
//! δf = A (δx − δX) + (A [r]× + B) δφ + G_u (δv − δV + [r]× δΩ) + G_σ (δω − δΩ)
//! A = G_w − G_u [Ω]×,   B = G_u [v − V]× + G_σ [ω]× − [f]×
//! ```
//!
//! with G the derivatives of f in the surface's own frame. The same holds for m.

use gearmesh_dynamics::BodyMotion;
use gearmesh_dynamics::elements::Loads;
use nalgebra::{Matrix3, Vector3};

use super::surface_contact::{Against, ByMotion, SurfaceForce};

/// Motion of a ball, world axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ball {
    pub place_m: Vector3<f64>,
    pub velocity_m_per_s: Vector3<f64>,
    pub spin_rad_per_s: Vector3<f64>,
    pub radius_m: f64,
}

/// Where the coordinates of a ball stand among the local degrees of freedom of an element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BallPlaces {
    pub place: usize,
    /// None where nothing turns the ball.
    pub spin: Option<usize>,
    /// Rotation of the ball by its coordinates of turning, δφ = Tᵀ δψ; asked for balls that have an orientation only.
    pub turning: Matrix3<f64>,
}

/// A body that carries a surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Carrier<'a> {
    pub motion: &'a BodyMotion,
    /// First local degree of freedom of the body.
    pub first: usize,
    /// Ω, world axes.
    spin: Vector3<f64>,
}

impl<'a> Carrier<'a> {
    pub fn new(motion: &'a BodyMotion, first: usize) -> Self {
        Self {
            motion,
            first,
            spin: motion.rotation * motion.angular_velocity_rad_per_s,
        }
    }

    /// Motion of the ball against a frame that moves with the body.
    pub fn against(&self, ball: &Ball) -> Against {
        let r = ball.place_m - self.motion.position_m;
        Against {
            velocity: ball.velocity_m_per_s - self.motion.velocity_m_per_s - self.spin.cross(&r),
            spin: ball.spin_rad_per_s - self.spin,
            ball_radius_m: ball.radius_m,
        }
    }

    /// Adds a force on the ball and the reaction on the body.
    pub fn add(&self, ball: &Ball, places: BallPlaces, found: &SurfaceForce, loads: &mut Loads) {
        let r = ball.place_m - self.motion.position_m;
        let moment = -(r.cross(&found.force) + found.moment);
        loads.add_force(places.place, found.force.as_slice());
        loads.add_force(self.first, (-found.force).as_slice());
        let to_body = self.motion.rotation.transpose();
        loads.add_force(self.first + 3, (to_body * moment).as_slice());
        if let Some(spin) = places.spin {
            loads.add_force(spin, found.moment.as_slice());
        }
        if loads.wants_tangents() {
            self.add_tangents(ball, places, found, (&r, &moment), loads);
        }
    }

    fn add_tangents(
        &self,
        ball: &Ball,
        places: BallPlaces,
        found: &SurfaceForce,
        (r, moment): (&Vector3<f64>, &Vector3<f64>),
        loads: &mut Loads,
    ) {
        let rotation = &self.motion.rotation;
        let to_body = rotation.transpose();
        let (lever, turn) = (r.cross_matrix(), found.force.cross_matrix());
        let mut force = self.follow(ball, &lever, &found.force_by, &found.force);
        let mut own = self.follow(ball, &lever, &found.moment_by, &found.moment);
        if let (Some([force_by, own_by]), Some(spin)) = (&found.by_turn, places.spin) {
            // The ball turns against the surface, and the surface against the ball.
            force.by_turn -= force_by;
            own.by_turn -= own_by;
            let (f, m) = (force_by * places.turning, own_by * places.turning);
            loads.add_block_by_position(places.place, spin, &f);
            loads.add_block_by_position(self.first, spin, &(-f));
            let moment_by = to_body * (-lever * f - m);
            loads.add_block_by_position(self.first + 3, spin, &moment_by);
            loads.add_block_by_position(spin, spin, &m);
        }
        let (x, v) = (places.place, self.first);
        // The ball's own rows, then its spin's, then the body's: force −f, moment −(r × f + m) in body axes.
        let rows = |of: &Follow, of_own: &Follow, by: Column| -> Matrix3<f64> {
            let direct = match by {
                Column::Ball => turn,
                Column::Body => -turn,
                Column::Turn | Column::Rate => Matrix3::zeros(),
            };
            let mut block = direct - lever * of.get(by) - of_own.get(by);
            if matches!(by, Column::Turn) {
                block += moment.cross_matrix();
            }
            to_body * block
        };
        for (by, column) in [(Column::Ball, x), (Column::Body, v), (Column::Turn, v + 3)] {
            // Turns are in body axes.
            let right = |block: Matrix3<f64>| match by {
                Column::Turn => block * rotation,
                _ => block,
            };
            let block = right(force.get(by));
            loads.add_block_by_position(x, column, &block);
            loads.add_block_by_position(v, column, &(-block));
            loads.add_block_by_position(v + 3, column, &right(rows(&force, &own, by)));
            if let Some(spin) = places.spin {
                loads.add_block_by_position(spin, column, &right(own.get(by)));
            }
        }
        let mut by_velocity = |column: usize, f: &Matrix3<f64>, m: &Matrix3<f64>| {
            loads.add_block_by_velocity(x, column, f);
            loads.add_block_by_velocity(v, column, &(-f));
            loads.add_block_by_velocity(v + 3, column, &(to_body * (-lever * f - m)));
            if let Some(spin) = places.spin {
                loads.add_block_by_velocity(spin, column, m);
            }
        };
        let (f, m) = (&found.force_by, &found.moment_by);
        by_velocity(x, &f.velocity, &m.velocity);
        by_velocity(v, &-f.velocity, &-m.velocity);
        by_velocity(
            v + 3,
            &(force.get(Column::Rate) * rotation),
            &(own.get(Column::Rate) * rotation),
        );
        if let Some(spin) = places.spin {
            by_velocity(spin, &f.spin, &m.spin);
        }
    }

    /// How a vector g of the surface's frame follows the ball, the body's shift, its turning and its angular velocity.
    fn follow(
        &self,
        ball: &Ball,
        lever: &Matrix3<f64>,
        by: &ByMotion,
        value: &Vector3<f64>,
    ) -> Follow {
        let drift = ball.velocity_m_per_s - self.motion.velocity_m_per_s;
        let by_ball = by.place - by.velocity * self.spin.cross_matrix();
        let carried = by.velocity * drift.cross_matrix()
            + by.spin * ball.spin_rad_per_s.cross_matrix()
            - value.cross_matrix();
        Follow {
            by_ball,
            by_turn: by_ball * lever + carried,
            by_rate: by.velocity * lever - by.spin,
        }
    }
}

#[derive(Debug, Clone, Copy)]
enum Column {
    Ball,
    Body,
    Turn,
    Rate,
}

struct Follow {
    by_ball: Matrix3<f64>,
    by_turn: Matrix3<f64>,
    by_rate: Matrix3<f64>,
}

impl Follow {
    fn get(&self, column: Column) -> Matrix3<f64> {
        match column {
            Column::Ball => self.by_ball,
            Column::Body => -self.by_ball,
            Column::Turn => self.by_turn,
            Column::Rate => self.by_rate,
        }
    }
}
