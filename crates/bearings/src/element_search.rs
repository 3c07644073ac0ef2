//! The search of a ball's or roller's place between its races: Newton's method, whose steps are turned towards the
//! unbalanced force and shortened where they do not lessen it (Levenberg and Marquardt).

use nalgebra::{Const, DimMin, SMatrix, SVector, Vector3};

/// Forces that count as none \[N\].
pub(crate) const NO_FORCE_N: f64 = 1e-9;

/// Iterations before a search is given up.
const MOST_ITERATIONS: usize = 200;

/// Share of all forces down to which a search goes.
const TIGHT: f64 = 1e-13;

/// Share of all forces that may be left where no step lessens it: rounding.
const LOOSE: f64 = 1e-9;

/// Place of a ball (r, z, 0) or roller (r, z, tilt) at which it carries load \[m, rad\]; none for a loose one, whose
/// place is not determined.
pub(crate) type ElementPlace = Option<Vector3<f64>>;

/// What an element feels at a place.
pub(crate) struct Balance<const N: usize> {
    /// Force on the element by its coordinates \[N, N·m\]; zero at equilibrium.
    pub residual: SVector<f64, N>,
    /// −∂residual/∂place.
    pub tangent: SMatrix<f64, N, N>,
    /// Sum of the sizes of all forces \[N\].
    pub scale: f64,
}

/// What is known of an element at a place.
pub(crate) trait Unbalanced<const N: usize> {
    fn balance(&self) -> &Balance<N>;
}

/// How places are measured.
pub(crate) struct ElementSearch<const N: usize> {
    /// What a coordinate is multiplied by to be a length: 1 for lengths, an arm for angles \[m\].
    pub arms: SVector<f64, N>,
    /// Steps are not longer \[m\].
    pub longest_step_m: f64,
    /// Steps this short are rounding \[m\].
    pub rounding_m: f64,
}

/// A search that did not end.
pub(crate) struct GivenUp<const N: usize, S> {
    pub place: SVector<f64, N>,
    pub state: S,
    /// What is unbalanced, moments over their arms \[N\].
    pub left_n: f64,
}

impl<const N: usize> ElementSearch<N>
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    /// From a place to equilibrium.
    pub fn run<S: Unbalanced<N>>(
        &self,
        start: SVector<f64, N>,
        state_at: impl Fn(&SVector<f64, N>) -> S,
    ) -> Result<(SVector<f64, N>, S), GivenUp<N, S>> {
        let squares = self.arms.component_mul(&self.arms);
        let size_of = |state: &S| state.balance().residual.component_div(&self.arms).norm();
        let (mut place, mut state) = (start, state_at(&start));
        let mut size = size_of(&state);
        let mut lift = 0.0_f64;
        for _ in 0..MOST_ITERATIONS {
            if size <= TIGHT * state.balance().scale || state.balance().scale <= NO_FORCE_N {
                return Ok((place, state));
            }
            let mut raised = state.balance().tangent;
            let stiffest = raised.diagonal().component_div(&squares).max().max(1e3);
            for i in 0..N {
                raised[(i, i)] += (lift + 1e-14) * stiffest * squares[i];
            }
            let Some(step) = raised.lu().solve(&state.balance().residual) else {
                lift = (10.0 * lift).max(1e-6);
                continue;
            };
            let moved_m = step.component_mul(&self.arms).norm();
            if moved_m <= self.rounding_m {
                return Ok((place, state));
            }
            let next = place + step * (self.longest_step_m / moved_m).min(1.0);
            let found = state_at(&next);
            let left = size_of(&found);
            if left < size {
                (place, state, size) = (next, found, left);
                lift = if lift < 1e-8 { 0.0 } else { 0.1 * lift };
            } else if size <= LOOSE * state.balance().scale && lift > 1e-3 {
                return Ok((place, state));
            } else {
                lift = (10.0 * lift).max(1e-6);
            }
        }
        if size <= LOOSE * state.balance().scale + NO_FORCE_N {
            return Ok((place, state));
        }
        Err(GivenUp {
            place,
            state,
            left_n: size,
        })
    }
}
