//! What the search of modes asks of a body: products, solves and vectors to begin with.

use faer::{Mat, MatMut, MatRef};

/// A body whose natural modes can be searched: K φ = ω² M φ over some unknowns.
pub trait ModeProblem {
    /// Number of unknowns.
    fn size(&self) -> usize;
    /// M X for a few vectors.
    fn mass_product(&self, x: MatRef<'_, f64>) -> Mat<f64>;
    /// K X for a few vectors.
    fn stiffness_product(&self, x: MatRef<'_, f64>) -> Mat<f64>;
    /// Overwrites B with (K + s M)⁻¹ B, s the shift of the settings.
    fn solve_in_place(&self, b: MatMut<'_, f64>);
    /// The vectors that the search begins with: numbers without pattern, the same in every run.
    fn start(&self, columns: usize) -> Mat<f64> {
        numbers_without_pattern(self.size(), columns)
    }
}

/// Numbers between −1 and 1, the same in every run; a wider matrix begins with the columns of a narrower one.
pub fn numbers_without_pattern(rows: usize, columns: usize) -> Mat<f64> {
    let mut random = fastrand::Rng::with_seed(1);
    let mut numbers = Mat::zeros(rows, columns);
    for column in 0..columns {
        for row in 0..rows {
            numbers[(row, column)] = 2.0 * random.f64() - 1.0;
        }
    }
    numbers
}
