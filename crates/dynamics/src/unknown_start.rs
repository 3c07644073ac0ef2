//! Where coordinates of elements begin: as the element says, then on their equations without mass.
//!
//! ```text
//! 0 = Q(u)  by u,      u̇ = Q  by u̇          by Newton's method, element by element, at the given motion of the bodies
//! ```

use nalgebra::{DMatrix, DVector};

use crate::elements::View;
use crate::error::DynamicsError;
use crate::state::State;
use crate::system::{Slot, System, view};
use crate::unknown::{Unknown, UnknownKind};

/// Iterations after which a start is given up.
const MOST_ITERATIONS: usize = 50;

/// Correction over the scale at which it is found.
const FOUND: f64 = 1e-13;

impl System {
    /// Moves the start to a state whose places fit the joints, such as an equilibrium of a simpler twin; coordinates of
    /// elements begin where the elements say that they do there.
    pub fn start_at(&mut self, state: State) {
        self.start = state;
        self.start_unknowns();
    }

    /// Lets elements state where their coordinates start.
    pub(crate) fn start_unknowns(&mut self) {
        let mut state = self.start.clone();
        self.refresh(&state);
        let first = self.layout.first_unknown();
        let view = view(&self.motions, &self.layout, &self.start, 1.0);
        for slot in &self.slots {
            let own = slot.own(&view, &self.start);
            let range = slot.unknowns.clone();
            slot.element.start_unknowns(
                &own,
                &mut state.unknowns[range.clone()],
                &mut state.velocity[first + range.start..first + range.end],
            );
        }
        self.start = state;
    }
}

/// Solves the equations without mass at a motion: for the coordinate where nothing else is in it, for the rate where
/// that is.
pub(crate) fn settle_unknowns(system: &mut System, state: &mut State) -> Result<(), DynamicsError> {
    if system.layout.massless().next().is_none() {
        return Ok(());
    }
    system.refresh(state);
    let System {
        slots,
        motions,
        layout,
        ..
    } = system;
    for slot in slots {
        let unknowns = &layout.unknowns()[slot.unknowns.clone()];
        let massless: Vec<usize> = (0..unknowns.len())
            .filter(|&i| unknowns[i].mass() == 0.0)
            .collect();
        if massless.is_empty() {
            continue;
        }
        let first_dof = layout.first_unknown() + slot.unknowns.start;
        let mut left = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let own = slot.own(&view(motions, layout, state, 1.0), state);
            let step = correction(slot, &own, unknowns, &massless, state.time_s)?;
            left = 0.0;
            for (&i, change) in massless.iter().zip(step.iter()) {
                let rate = unknowns[i].kind == UnknownKind::Rate;
                if rate {
                    state.velocity[first_dof + i] += change;
                } else {
                    state.unknowns[slot.unknowns.start + i] += change;
                    left = f64::max(left, change.abs() / unknowns[i].scale);
                }
                if !change.is_finite() {
                    left = f64::NAN;
                }
            }
            if left.is_nan() || left <= FOUND {
                break;
            }
        }
        // What still changes by rounding is found, too.
        if left.is_nan() || left > 1e3 * FOUND {
            return Err(DynamicsError::UnknownStart {
                element: slot.element.name().to_owned(),
                time_s: state.time_s,
                left,
                iterations: MOST_ITERATIONS,
            });
        }
    }
    Ok(())
}

/// Newton's correction of the coordinates without mass of one element: of the rate where a rate is given, else of the
/// coordinate.
fn correction(
    slot: &mut Slot,
    view: &View<'_>,
    unknowns: &[Unknown],
    massless: &[usize],
    time_s: f64,
) -> Result<DVector<f64>, DynamicsError> {
    slot.loads.begin(true);
    let evaluated = slot.element.evaluate(view, &mut slot.loads);
    evaluated.map_err(|source| slot.failure(time_s, source))?;
    let first = slot.loads.first_unknown();
    let is_rate = |i: usize| unknowns[i].kind == UnknownKind::Rate;
    let matrix = DMatrix::from_fn(massless.len(), massless.len(), |row, column| {
        let (i, j) = (massless[row], massless[column]);
        let own = f64::from(u8::from(i == j && is_rate(i)));
        let tangents = if is_rate(j) {
            &slot.loads.by_velocity
        } else {
            &slot.loads.by_position
        };
        own - tangents.get(first + i, first + j)
    });
    let right = DVector::from_iterator(
        massless.len(),
        massless.iter().map(|&i| {
            let rate = if is_rate(i) {
                view.unknown_rates()[i]
            } else {
                0.0
            };
            slot.loads.force[first + i] - rate
        }),
    );
    matrix.lu().solve(&right).ok_or(DynamicsError::singular("the inner stiffness of an element (a coordinate in equilibrium whose Q does not change with it)", time_s))
}
