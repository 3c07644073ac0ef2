//! Frames in space, and sums and products of vectors.

/// Origin and axes in the coordinates of the gear unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Origin \[mm\].
    pub origin_mm: [f64; 3],
    /// Unit vectors u, v and w.
    pub axes: [[f64; 3]; 3],
}

impl Frame {
    /// The gear unit's own frame.
    pub const WORLD: Self = Self {
        origin_mm: [0.0; 3],
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    };

    /// A direction given in this frame.
    pub fn direction(&self, local: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|k| local[k] * self.axes[k][i]).sum())
    }

    /// A point given in this frame.
    pub fn point(&self, local: [f64; 3]) -> [f64; 3] {
        add(self.origin_mm, self.direction(local), 1.0)
    }

    /// Coordinate of a point along u.
    pub fn u_of(&self, point: [f64; 3]) -> f64 {
        dot(add(point, self.origin_mm, -1.0), self.axes[0])
    }

    /// Distance of a point from the u axis \[mm\].
    pub fn from_axis_mm(&self, point: [f64; 3]) -> f64 {
        let between = add(point, self.origin_mm, -1.0);
        let along = dot(between, self.axes[0]);
        (dot(between, between) - along * along).max(0.0).sqrt()
    }
}

/// a + s b.
pub fn add(a: [f64; 3], b: [f64; 3], s: f64) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + s * b[i])
}

/// Scalar product.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// Vector product.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// A vector of length one; none for the zero vector.
pub fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(a, a).sqrt();
    (length > 1e-9).then(|| a.map(|x| x / length))
}
