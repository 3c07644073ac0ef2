//! A ball of a dynamic bearing at a motion: where it is, and what races and cage do to it.

use std::f64::consts::TAU;

use gearmesh_dynamics::elements::View;
use gearmesh_dynamics::{BodyMotion, Marker};
use nalgebra::{Matrix3, Vector3};

use super::ball_on_body::{Ball, Carrier};
use super::cage_motion::Seen;
use super::dynamic_bearing::DynamicBearing;
use super::effort::count;
use super::groove_touch::{groove_touch, hertz_load};
use super::surface_contact::{SurfaceForce, surface_force};
use super::uneven_groove::{Patch, uneven_touch};
use crate::ball_row::BallRow;
use crate::faults::{RowFaults, Side};

/// The rings at a motion: body, middle, axes and the last of them.
pub(super) struct Ring<'a> {
    pub side: Side,
    pub carrier: Carrier<'a>,
    pub middle: Vector3<f64>,
    axes: Matrix3<f64>,
    pub axis: Vector3<f64>,
}

impl<'a> Ring<'a> {
    fn new(side: Side, marker: &Marker, motion: &'a BodyMotion, first: usize) -> Self {
        let axes = motion.rotation * marker.orientation().matrix();
        Self {
            side,
            carrier: Carrier::new(motion, first),
            middle: motion.position_m + motion.rotation * marker.position_m,
            axes,
            axis: axes.column(2).into_owned(),
        }
    }
}

impl Ring<'_> {
    /// Angle of a place from the ring's middle, from its x towards y.
    pub fn angle_rad(&self, arm: &Vector3<f64>) -> f64 {
        let along = |axis: usize| arm.dot(&self.axes.column(axis));
        along(1).atan2(along(0))
    }

    /// The ring as a frame in which others are seen.
    pub fn seen(&self) -> Seen {
        let motion = self.carrier.motion;
        let spin = motion.rotation * motion.angular_velocity_rad_per_s;
        let arm = self.middle - motion.position_m;
        Seen {
            middle: self.middle,
            velocity: motion.velocity_m_per_s + spin.cross(&arm),
            axes: self.axes,
            spin_rad_per_s: spin.dot(&self.axis),
        }
    }
}

/// What is wrong with a ball of a row, and where its spall is (world axes).
#[derive(Clone, Copy, Default)]
pub(super) struct Faults<'a> {
    row: Option<&'a RowFaults>,
    ball: usize,
    patch: Option<Vector3<f64>>,
}

impl DynamicBearing {
    pub(super) fn ball(&self, view: &View<'_>, row: &BallRow, ball: usize, number: usize) -> Ball {
        let first = number * self.per_ball();
        let three = |values: &[f64], first: usize| {
            Vector3::new(values[first], values[first + 1], values[first + 2])
        };
        Ball {
            place_m: three(view.unknowns(), first),
            velocity_m_per_s: three(view.unknown_rates(), first),
            spin_rad_per_s: if self.turns() {
                three(view.unknown_rates(), first + 3)
            } else {
                Vector3::zeros()
            },
            radius_m: 0.5 * row.ball_size(ball).0,
        }
    }

    /// Coordinates of a ball's turning.
    pub(super) fn turned(&self, view: &View<'_>, number: usize) -> Vector3<f64> {
        let first = number * self.per_ball() + 3;
        Vector3::from_column_slice(&view.unknowns()[first..first + 3])
    }

    /// What is wrong with a ball, and δφ by the coordinates of its turning.
    pub(super) fn faults<'a>(
        &self,
        view: &View<'_>,
        row: &'a BallRow,
        ball: usize,
        number: usize,
    ) -> (Faults<'a>, Matrix3<f64>) {
        let mut faults = Faults {
            row: row.faults.as_deref(),
            ball,
            patch: None,
        };
        let mut own = self.orientations.iter().filter(|o| o.ball == number);
        let Some(orientation) = own.next() else {
            return (faults, Matrix3::identity());
        };
        let (direction, turning) = orientation.at(&self.turned(view, number));
        faults.patch = Some(direction);
        (faults, turning)
    }

    pub(super) fn rings<'a>(&self, view: &'a View<'_>, first: [usize; 2]) -> [Ring<'a>; 2] {
        let motions = [self.pair.a.body, self.pair.b.body].map(|body| view.body(body));
        [
            Ring::new(Side::Outer, &self.pair.a, motions[0], first[0]),
            Ring::new(Side::Inner, &self.pair.b, motions[1], first[1]),
        ]
    }

    /// Sets the force of a race on a ball; none where they do not touch, and `found` is as it was.
    pub(super) fn at_race(
        &self,
        (row, place): (&BallRow, usize),
        faults: &Faults<'_>,
        ring: &Ring<'_>,
        ball: &Ball,
        tangents: bool,
        found: &mut SurfaceForce,
    ) -> Option<()> {
        if let Some(effort) = &self.effort {
            count(&effort.races);
        }
        let mut groove = row.groove(ring.side);
        let w = ball.place_m - ring.middle;
        let own;
        let touch = match (self.meshes.get(place), faults.row) {
            (Some(meshes), _) => {
                let mesh = &meshes[usize::from(ring.side == Side::Inner)];
                mesh.touch(&w, &ring.axes, ball.radius_m)?
            }
            (None, None) => groove_touch(groove, &w, &ring.axis)?,
            (None, Some(of_row)) => {
                own = of_row.groove_for(faults.ball, groove);
                groove = &own;
                let (race, patch) = (of_row.race(ring.side), self.patch(of_row, faults, ring));
                match (race, patch) {
                    (None, None) => groove_touch(groove, &w, &ring.axis)?,
                    _ => uneven_touch(groove, race, patch, &w, &ring.axes)?,
                }
            }
        };
        if touch.approach_m <= 0.0 {
            return None;
        }
        // A groove is the half of its torus that faces the ball: it does not reach over it.
        let across = touch.normal.dot(&w) - touch.normal.dot(&ring.axis) * w.dot(&ring.axis);
        if (across > 0.0) == (ring.side == Side::Inner) {
            return None;
        }
        let law = self.effects.traction.as_ref().map(|traction| {
            let effort = self.effort.as_deref();
            move |load: f64, slip: f64| {
                if let Some(effort) = effort {
                    count(&effort.tractions);
                }
                traction.slip(&groove.contact, load, slip)
            }
        });
        if let Some(effort) = &self.effort {
            count(&effort.contacts);
        }
        surface_force(
            &touch,
            |rate| match &self.effects.contact {
                None => {
                    let elastic = hertz_load(groove, touch.approach_m);
                    self.effects.rebound.damped(&elastic, rate)
                }
                Some(stated) => stated.damped(touch.approach_m, rate),
            },
            &ring.carrier.against(ball),
            law,
            tangents,
            found,
        );
        Some(())
    }

    /// The spall of a ball against a race.
    fn patch<'a>(
        &self,
        of_row: &'a RowFaults,
        faults: &Faults<'_>,
        ring: &Ring<'_>,
    ) -> Option<Patch<'a>> {
        let direction = faults.patch?;
        let mut spalled = of_row.spalled().iter().filter(|s| s.ball == faults.ball);
        let shape = spalled.next()?.against(ring.side);
        Some(Patch { shape, direction })
    }

    /// Sets the force of a cage on the ball in its pocket; none where it feels nothing.
    pub(super) fn in_pocket(
        &self,
        (row, place, ball_of_row): (&BallRow, usize, usize),
        cage: &Carrier<'_>,
        ball: &Ball,
        tangents: bool,
        found: &mut SurfaceForce,
    ) -> Option<()> {
        let (_, pockets) = &self.effects.cages[place];
        if let Some(effort) = &self.effort {
            count(&effort.pockets);
        }
        let angle = row.first_angle_rad + TAU * ball_of_row as f64 / row.balls as f64;
        let touch = pockets.touch(
            &ball.place_m,
            cage.motion,
            row.pitch_radius_m,
            angle.sin_cos(),
        );
        let elastic = pockets.load(touch.approach_m);
        if elastic.load_n == 0.0 && elastic.slope_n_per_m == 0.0 {
            return None;
        }
        let law = pockets.traction.as_ref().map(|traction| {
            move |load: f64, slip: f64| traction.slip(&row.inner.contact, load, slip)
        });
        surface_force(
            &touch,
            |rate| pockets.rebound.damped(&elastic, rate),
            &cage.against(ball),
            law,
            tangents,
            found,
        );
        Some(())
    }
}
