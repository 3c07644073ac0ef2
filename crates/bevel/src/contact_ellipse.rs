//! The contact ellipse of two flanks from their relative curvature.

use nalgebra::{Matrix2, Vector3};

use crate::assembly::Placement;
use crate::blank::MemberBlank;
use crate::contact_point::Touch;

/// Relative curvature at a contact and the ellipse on which the flanks are nearer than a marking thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactEllipse {
    /// Least and largest relative curvature \[1/m\]; a negative one means that the flanks cut into each other beside
    /// the point.
    pub curvatures_per_m: [f64; 2],
    /// Unit vectors in those directions, in the fixed frame: the first is the long axis.
    pub axes: [Vector3<f64>; 2],
}

impl ContactEllipse {
    /// At a contact of two surfaces.
    pub fn at(touch: &Touch) -> Self {
        let [p, q] = &touch.points;
        let relative = p.curvature() + q.curvature();
        let [t, u] = p.tangents(&p.dr[0]);
        let cross = t.dot(&(relative * u));
        let matrix = Matrix2::new(t.dot(&(relative * t)), cross, cross, u.dot(&(relative * u)));
        let eigen = matrix.symmetric_eigen();
        let order = if eigen.eigenvalues[0] <= eigen.eigenvalues[1] {
            [0, 1]
        } else {
            [1, 0]
        };
        Self {
            curvatures_per_m: order.map(|i| eigen.eigenvalues[i]),
            axes: order.map(|i| t * eigen.eigenvectors[(0, i)] + u * eigen.eigenvectors[(1, i)]),
        }
    }

    /// The ellipse of a marking thickness on a member's flank: half axes as steps of cone distance L and height h
    /// \[m\]; none where the flanks are nearer than the marking all along.
    pub fn on_flank_m(
        &self,
        marking_m: f64,
        touch: &Touch,
        member: (&Placement, &MemberBlank, usize),
    ) -> Option<[[f64; 2]; 2]> {
        let lengths = self.half_lengths_m(marking_m);
        if !lengths.iter().all(|x| x.is_finite()) {
            return None;
        }
        let (placement, blank, number) = member;
        let axis = placement.axis();
        let arm = touch.points[number].r - placement.apex_m;
        let outwards = (arm - axis * axis.dot(&arm)).normalize();
        // L and h are linear in the place along the axis and the radius.
        Some([0, 1].map(|k| {
            let way = self.axes[k] * lengths[k];
            blank.cone_place(axis.dot(&way), outwards.dot(&way))
        }))
    }

    /// Half lengths, long and short, where the gap reaches a marking thickness: √(2t/κ) \[m\]; infinite where κ ≤ 0.
    pub fn half_lengths_m(&self, marking_m: f64) -> [f64; 2] {
        self.curvatures_per_m.map(|k| {
            if k > 0.0 {
                (2.0 * marking_m / k).sqrt()
            } else {
                f64::INFINITY
            }
        })
    }
}
