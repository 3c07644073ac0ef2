//! What rolling elements do to the inner ring, and its derivatives.

use nalgebra::{Matrix3, Matrix3x6, Matrix6, Vector3, Vector5, Vector6};

/// Load on the inner ring by its rolling elements: force \[N\] and moment about the ring's middle \[N·m\], in the axes
/// of the outer ring.
///
/// `tangent` holds the derivatives by a displacement of the ring's middle and a rotation about the fixed axes, rows:
/// load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RingLoad {
    /// Force and moment.
    pub load: Vector6<f64>,
    /// Their derivatives; symmetric at rest but for the geometric part of the moments.
    pub tangent: Matrix6<f64>,
}

impl Default for RingLoad {
    fn default() -> Self {
        Self {
            load: Vector6::zeros(),
            tangent: Matrix6::zeros(),
        }
    }
}

impl RingLoad {
    /// The first five of the load: the moment about the ring's own axis is zero.
    #[must_use]
    pub fn five(&self) -> Vector5<f64> {
        self.load.fixed_rows::<5>(0).into_owned()
    }

    /// Takes the moment about the ring's own axis a away, and what a turn about it changes: both are rounding, because
    /// races are surfaces of revolution and friction has no arm about the axis. A shaft that turns freely in its
    /// bearings would otherwise find no rest.
    ///
    /// With a·M = 0 at all times a·δM = −δa·M = −(a × M)·δφ.
    pub(crate) fn turn_freely(&mut self, axis: &Vector3<f64>) {
        let mut moment = self.load.fixed_rows_mut::<3>(3);
        moment -= axis * axis.dot(&moment);
        let moment: Vector3<f64> = moment.into_owned();
        let by_turn = self.tangent.fixed_columns::<3>(3) * axis;
        let mut columns = self.tangent.fixed_columns_mut::<3>(3);
        columns -= by_turn * axis.transpose();
        let mut rows = self.tangent.fixed_rows_mut::<3>(3);
        let about_axis = axis.transpose() * &rows;
        rows -= axis * about_axis;
        let mut block = self.tangent.fixed_view_mut::<3, 3>(3, 3);
        block -= axis * axis.cross(&moment).transpose();
    }

    /// Adds a force f at the place w from the ring's middle, of a point that does not move with the ring, whose change
    /// is δf = `by_point` (δb + B δq) + δφ × f with B δq = −δu + w × δφ; of δb nothing is added here.
    pub(crate) fn add_at_fixed_point(
        &mut self,
        w: &Vector3<f64>,
        f: &Vector3<f64>,
        by_point: &Matrix3<f64>,
    ) {
        let mut force = self.load.fixed_rows_mut::<3>(0);
        force += f;
        let mut moment = self.load.fixed_rows_mut::<3>(3);
        moment += w.cross(f);
        let (_, force_by_ring) = by_ring(w, f, by_point);
        // δ(w × f) = −[f]× (−δu) + [w]× δf
        let mut by_shift = Matrix3x6::zeros();
        by_shift.fixed_columns_mut::<3>(0).fill_with_identity();
        self.add_following(w, f, &force_by_ring, &-by_shift);
    }

    /// Adds what the ring's motion changes of a force f at the place w: its own change, and the moment by how its
    /// point moves.
    pub(crate) fn add_following(
        &mut self,
        w: &Vector3<f64>,
        f: &Vector3<f64>,
        force_by_ring: &Matrix3x6<f64>,
        moves: &Matrix3x6<f64>,
    ) {
        let mut rows = self.tangent.fixed_rows_mut::<3>(0);
        rows += force_by_ring;
        let mut rows = self.tangent.fixed_rows_mut::<3>(3);
        rows += w.cross_matrix() * force_by_ring - f.cross_matrix() * moves;
    }
}

/// How a point at the place w moves against the ring with the ring, B = (−1, \[w\]×), and how a force f there changes:
/// `by_point` B δq + δφ × f.
pub(crate) fn by_ring(
    w: &Vector3<f64>,
    f: &Vector3<f64>,
    by_point: &Matrix3<f64>,
) -> (Matrix3x6<f64>, Matrix3x6<f64>) {
    let mut relative = Matrix3x6::zeros();
    relative.fixed_columns_mut::<3>(0).fill_with_identity();
    relative.neg_mut();
    relative
        .fixed_columns_mut::<3>(3)
        .copy_from(&w.cross_matrix());
    let mut force = by_point * relative;
    let mut turned = force.fixed_columns_mut::<3>(3);
    turned -= f.cross_matrix();
    (relative, force)
}
