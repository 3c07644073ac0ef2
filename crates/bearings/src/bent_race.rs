//! Outer races that bend under their rollers: those of a bore in an elastic body.
//!
//! At each roller the race moves away from the axis by w(z) = Σ_d b_d P_d(z), P_d functions along it; the roller
//! presses it with G_d = Σ Q P_d over its laminae. With the roller's own place x in equilibrium, R(x, ring, b) = 0, T =
//! −∂R/∂x, and a_d = ∂R/∂b_d = Σ Q′ P_d ∂(approach)/∂x
//!
//! ```text
//! ∂G_d/∂b_e = −Σ Q′ P_d P_e + a_dᵀ T⁻¹ a_e        ∂(load on the ring)/∂b_d = ∂(load)/∂x T⁻¹ a_d = (∂G_d/∂ring)ᵀ
//! ```
//!
//! Forces and loads come from one potential V of ring and race, the sum of all contacts' energies less what the
//! rollers' own centrifugal force and gyroscopic moment have done on them.

use nalgebra::{Matrix3, Matrix6x3, Vector3, Vector6};

use crate::roller_row::RollerRow;

/// Most functions along a race.
pub const MOST_FUNCTIONS: usize = 9;

/// Outer races of all rollers: how they are moved, and what that makes.
#[derive(Debug, Clone, PartialEq)]
pub struct BentRace {
    along: usize,
    /// P at the laminae, row after row, `[lamina][function]`.
    shapes: Vec<Vec<f64>>,
    /// w at the laminae of a roller \[m\].
    lamina_moved_m: Vec<f64>,
    /// b \[m\], `[roller][function]`, rollers row after row.
    pub moved_m: Vec<f64>,
    /// G \[N\], `[roller][function]`.
    pub force_n: Vec<f64>,
    /// −∂G/∂b \[N/m\], `[roller][function][function]`.
    pub stiffness: Vec<f64>,
    /// ∂(load on the inner ring)/∂b, `[roller][function]`.
    pub ring_by_moved: Vec<Vector6<f64>>,
    /// V \[J\].
    pub stored_j: f64,
}

/// Outer races that bend, the number of the row and that of its first roller; none where they are round.
pub(crate) type BentRow<'a> = Option<(&'a mut BentRace, (usize, usize))>;

/// One roller's part.
pub(crate) struct BentAtRoller<'a> {
    along: usize,
    shapes: &'a [f64],
    force_n: &'a mut [f64],
    stiffness: &'a mut [f64],
    ring_by_moved: &'a mut [Vector6<f64>],
    pub stored_j: &'a mut f64,
    /// a of each function.
    by_moved: [Vector3<f64>; MOST_FUNCTIONS],
}

/// What a lamina at the outer race adds.
pub(crate) struct LaminaOnRace {
    pub number: usize,
    pub load_n: f64,
    pub slope: f64,
    /// ∂(approach)/∂(place of the roller).
    pub by_place: Vector3<f64>,
}

impl BentRace {
    /// Races at rest of rows of cylindrical rollers; `functions`: P along the race by the place in the bearing's frame.
    pub(crate) fn new(rows: &[RollerRow], functions: impl Fn(f64) -> Vec<f64>) -> Self {
        let at = |row: &RollerRow, k: usize| {
            functions(row.middle_z_m + row.axis.1 * row.laminae[k].place_m)
        };
        let of_row = |row: &RollerRow| (0..row.laminae.len()).flat_map(|k| at(row, k)).collect();
        let along = rows.first().map_or(0, |row| at(row, 0).len());
        let laminae = rows.iter().map(|row| row.laminae.len()).max();
        let count = along * rows.iter().map(|row| row.rollers).sum::<usize>();
        Self {
            along,
            shapes: rows.iter().map(of_row).collect(),
            lamina_moved_m: vec![0.0; laminae.unwrap_or_default()],
            moved_m: vec![0.0; count],
            force_n: vec![0.0; count],
            stiffness: vec![0.0; count * along],
            ring_by_moved: vec![Vector6::zeros(); count],
            stored_j: 0.0,
        }
    }

    /// Number of functions along the race.
    #[must_use]
    pub fn along(&self) -> usize {
        self.along
    }

    pub(crate) fn begin(&mut self) {
        self.force_n.fill(0.0);
        self.stiffness.fill(0.0);
        self.ring_by_moved.fill(Vector6::zeros());
        self.stored_j = 0.0;
    }

    /// w at the laminae of a roller, counted over all rows, and its part.
    pub(crate) fn of_roller(&mut self, row: usize, roller: usize) -> (&[f64], BentAtRoller<'_>) {
        let n = self.along;
        let own = roller * n..(roller + 1) * n;
        let shapes = &self.shapes[row][..];
        let moved_m = &self.moved_m[own.clone()];
        let laminae = &mut self.lamina_moved_m[..shapes.len() / n];
        for (at, shape) in laminae.iter_mut().zip(shapes.chunks_exact(n)) {
            *at = shape.iter().zip(moved_m).map(|(p, b)| p * b).sum();
        }
        let part = BentAtRoller {
            along: n,
            shapes,
            force_n: &mut self.force_n[own.clone()],
            stiffness: &mut self.stiffness[n * own.start..n * own.end],
            ring_by_moved: &mut self.ring_by_moved[own],
            stored_j: &mut self.stored_j,
            by_moved: [Vector3::zeros(); MOST_FUNCTIONS],
        };
        (laminae, part)
    }
}

impl BentAtRoller<'_> {
    /// Adds a lamina that presses the race.
    pub(crate) fn add_lamina(&mut self, lamina: &LaminaOnRace) {
        let shapes = &self.shapes[lamina.number * self.along..][..self.along];
        for (d, shape) in shapes.iter().enumerate() {
            self.force_n[d] += lamina.load_n * shape;
            self.by_moved[d] += lamina.by_place * (lamina.slope * shape);
            for (e, other) in shapes.iter().enumerate() {
                self.stiffness[d * self.along + e] += lamina.slope * shape * other;
            }
        }
    }

    /// Lets the roller follow, whose T is given; `ring_by_place`: how force and moment on the ring change with its
    /// place.
    pub(crate) fn follow(&mut self, tangent: &Matrix3<f64>, ring_by_place: &Matrix6x3<f64>) {
        let Some(inverse) = tangent.try_inverse() else {
            return;
        };
        for e in 0..self.along {
            let follows = inverse * self.by_moved[e];
            self.ring_by_moved[e] = ring_by_place * follows;
            for d in 0..self.along {
                self.stiffness[d * self.along + e] -= self.by_moved[d].dot(&follows);
            }
        }
    }
}
