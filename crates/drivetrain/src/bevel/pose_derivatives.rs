//! How a contact of two patches changes with the pose: places, gradient of the gap, directions of sliding.
//!
//! E(q; pose) = 0 are the equations of nearest_points.rs. A step (δu, ϑ) of gear 2 moves its points by δu + ϑ × (r₂ −
//! u) and turns its tangents and normals by ϑ ×; the contact follows by dq = −E_q⁻¹ E_pose. With the arm a = r₂ − u,
//!
//! ```text
//! gradient of the gap G = (N, a × N),   dG = (dN, da × N + a × dN),   da = ϑ × a + t₂ dq₂
//! friction            k = (τ, a × τ)    for two unit tangents τ across N
//! ```
//!
//! dN is that of the face's normal with its own dq, and of t₁ × t₂ where edges cross. All exact.

use nalgebra::{Matrix3x6, Matrix4x6, Matrix6, Vector3};

use super::nearest_points::{Kind, Nearest, equations, kind};
use crate::flank_kinematics::Tangent;
use crate::pose::{Vector6, stacked};

/// A vector and its derivatives by the increments of the pose.
#[derive(Debug, Clone, Copy)]
struct Moving {
    value: Vector3<f64>,
    by_pose: Matrix3x6<f64>,
}

impl Moving {
    /// Its cross product with another.
    fn cross(&self, other: &Self) -> Self {
        let mut by_pose = self.value.cross_matrix() * other.by_pose;
        by_pose -= other.value.cross_matrix() * self.by_pose;
        Self {
            value: self.value.cross(&other.value),
            by_pose,
        }
    }

    /// Without its part along a unit vector, scaled to length 1.
    fn across(&self, normal: &Self) -> Self {
        let along = normal.value.dot(&self.value);
        let value = self.value - along * normal.value;
        let along_by_pose =
            normal.value.transpose() * self.by_pose + self.value.transpose() * normal.by_pose;
        let by_pose = self.by_pose - normal.value * along_by_pose - along * normal.by_pose;
        Self { value, by_pose }.unit()
    }

    fn unit(&self) -> Self {
        let length = self.value.norm();
        let value = self.value / length;
        let by_pose = (self.by_pose - value * (value.transpose() * self.by_pose)) / length;
        Self { value, by_pose }
    }

    /// (v, a × v) and its derivatives.
    fn load(&self, arm: &Self) -> (Vector6, Matrix6<f64>) {
        let moment = arm.cross(self);
        let mut by_pose = Matrix6::zeros();
        by_pose.fixed_rows_mut::<3>(0).copy_from(&self.by_pose);
        by_pose.fixed_rows_mut::<3>(3).copy_from(&moment.by_pose);
        (stacked(self.value, moment.value), by_pose)
    }
}

/// A contact with what moves it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PoseDerivatives {
    found: Nearest,
    /// Of gear 2's point from its origin \[m\].
    arm: Vector3<f64>,
    /// ∂(s, v of gear 1, s, v of gear 2)/∂pose.
    pub places: Matrix4x6<f64>,
}

/// Load of a unit normal force on gear 2: the gradient of the gap.
pub(crate) fn gradient(found: &Nearest, displacement_m: &Vector3<f64>) -> Vector6 {
    let arm = found.points[1].r - displacement_m;
    stacked(found.normal, arm.cross(&found.normal))
}

impl PoseDerivatives {
    /// At a contact; gear 2's origin seen in gear 1.
    pub(crate) fn new(found: &Nearest, displacement_m: &Vector3<f64>) -> Self {
        let arm = found.points[1].r - displacement_m;
        Self {
            found: *found,
            arm,
            places: places(found, &arm),
        }
    }

    /// At a contact next to this one: places move with the pose as here.
    pub(crate) fn next_to(&self, found: &Nearest, displacement_m: &Vector3<f64>) -> Self {
        Self {
            found: *found,
            arm: found.points[1].r - displacement_m,
            places: self.places,
        }
    }

    /// The contact.
    pub(crate) fn found(&self) -> &Nearest {
        &self.found
    }

    /// A vector of a member with these derivatives by s and v, and how it moves.
    fn moving(&self, member: usize, value: Vector3<f64>, by: [Vector3<f64>; 2]) -> Moving {
        let mut by_pose = Matrix3x6::zeros();
        if member == 1 {
            let turns = -value.cross_matrix();
            by_pose.fixed_columns_mut::<3>(3).copy_from(&turns);
        }
        for (l, d) in by.iter().enumerate() {
            by_pose += d * self.places.row(2 * member + l);
        }
        Moving { value, by_pose }
    }

    fn arm(&self) -> Moving {
        self.moving(1, self.arm, self.found.points[1].dr)
    }

    /// The normal and a tangent of the face.
    fn normal_and_tangent(&self) -> [Moving; 2] {
        let points = &self.found.points;
        let [p, q] = points;
        let tangent_of = |m: usize, k: usize| {
            let by = [points[m].ddr[k], points[m].ddr[k + 1]];
            self.moving(m, points[m].dr[k], by)
        };
        match kind(&self.found.held) {
            Kind::Face(1) => [self.moving(1, q.n, q.dn), tangent_of(1, 0)],
            Kind::Face(_) => [self.moving(0, -p.n, p.dn.map(|d| -d)), tangent_of(0, 0)],
            Kind::Edges([i, j]) => {
                let mut normal = tangent_of(0, i).cross(&tangent_of(1, j)).unit();
                if normal.value.dot(&self.found.normal) < 0.0 {
                    normal.value.neg_mut();
                    normal.by_pose.neg_mut();
                }
                [normal, tangent_of(1, j)]
            }
        }
    }

    /// ∂(gradient of the gap)/∂pose.
    fn gap_curvature(&self) -> Matrix6<f64> {
        let [normal, _] = self.normal_and_tangent();
        normal.load(&self.arm()).1
    }

    /// The two tangents as the flanks of gear 1 and gear 2 see them: up the profile, and along the tooth at right
    /// angles to it, as the loads of reduced gears.
    fn tangents_on_flanks(&self) -> [[[f64; 2]; 2]; 2] {
        let [normal, tangent] = self.normal_and_tangent().map(|moving| moving.value);
        let first = (tangent - normal * normal.dot(&tangent)).normalize();
        let tangents = [first, normal.cross(&first)];
        [0, 1].map(|gear: usize| {
            let [along, up] = self.found.points[gear].dr;
            let up = up.normalize();
            let along = (along - up * up.dot(&along)).normalize();
            tangents.map(|tangent| [tangent.dot(&up), tangent.dot(&along)])
        })
    }

    /// Loads on gear 2 of unit friction forces along two tangents at right angles, and their derivatives by the pose.
    fn sliding(&self) -> [(Vector6, Matrix6<f64>); 2] {
        let [normal, tangent] = self.normal_and_tangent();
        let first = tangent.across(&normal);
        let second = normal.cross(&first);
        let arm = self.arm();
        [first.load(&arm), second.load(&arm)]
    }
}

/// The contacts of one side that were found last, in the order of its patches: what a mesh is asked of them beyond
/// their gaps. Zero for patches that were not found.
#[derive(Debug, Clone, Default)]
pub(crate) struct MovingContacts(pub Vec<PoseDerivatives>);

impl MovingContacts {
    pub(crate) fn with_capacity(contacts: usize) -> Self {
        Self(Vec::with_capacity(contacts))
    }

    /// As [`crate::FlankKinematics::gap_curvature`].
    pub(crate) fn gap_curvature(&self, contact: usize) -> Matrix6<f64> {
        let motion = self.0.get(contact);
        motion.map_or_else(Matrix6::zeros, PoseDerivatives::gap_curvature)
    }

    /// As [`crate::FlankKinematics::tangents_on_flanks`].
    pub(crate) fn tangents_on_flanks(&self, contact: usize) -> Option<[[[f64; 2]; 2]; 2]> {
        self.0.get(contact).map(PoseDerivatives::tangents_on_flanks)
    }

    /// As [`crate::FlankKinematics::sliding`].
    pub(crate) fn sliding(&self, contact: usize, derivatives: bool) -> [Option<Tangent>; 2] {
        let motion = self.0.get(contact);
        motion.map_or([None; 2], |motion| {
            motion.sliding().map(|(direction, change)| {
                let change = derivatives.then_some(change);
                Some(Tangent { direction, change })
            })
        })
    }
}

/// −E_q⁻¹ E_pose; zero where the contact is not held to a point.
fn places(found: &Nearest, arm: &Vector3<f64>) -> Matrix4x6<f64> {
    let [p, q] = &found.points;
    let d = q.r - p.r;
    let (_, slopes) = equations(&found.held, &found.at, &found.points);
    let mut by_pose = Matrix4x6::zeros();
    // d·t of member m along k.
    let along = |m: usize, k: usize, row: usize, to: &mut Matrix4x6<f64>| {
        let t = found.points[m].dr[k];
        let mut turn = arm.cross(&t);
        if m == 1 {
            turn += t.cross(&d);
        }
        to.set_row(row, &stacked(t, turn).transpose());
    };
    match kind(&found.held) {
        Kind::Face(face) => {
            let other = 1 - face;
            for k in 0..2 {
                along(face, k, k, &mut by_pose);
                if found.held[other][k].is_none() {
                    let (t, n) = (&found.points[other].dr[k], &found.points[face].n);
                    let turn = if face == 1 { n.cross(t) } else { t.cross(n) };
                    by_pose.set_row(2 + k, &stacked(Vector3::zeros(), turn).transpose());
                }
            }
        }
        Kind::Edges(free) => (0..2).for_each(|m| along(m, free[m], m, &mut by_pose)),
    }
    slopes.lu().solve(&-by_pose).unwrap_or_default()
}
