//! Steps that both algorithms share: evaluation of gaps and residual, factor, correction, start values.

use super::ldl::Shifted;
use super::{NlcpError, Problem, Workspace};

/// Gaps and load at the present forces.
#[derive(Debug, Clone, Copy)]
pub(super) struct Evaluation {
    /// Largest relative gap residual (module documentation of `nlcp`).
    pub(super) gap_residual: f64,
    /// `Σ b_i F_i` \[N·m\].
    pub(super) load: f64,
}

impl Evaluation {
    /// The relative error of the load; zero when the approach is given.
    pub(super) fn balance(&self, load: Option<f64>) -> f64 {
        load.map_or(0.0, |wanted| (self.load - wanted).abs() / wanted)
    }

    /// The residual of the whole problem; `load` is `None` when the approach is given.
    pub(super) fn residual(&self, load: Option<f64>) -> f64 {
        let balance = self.balance(load);
        // f64::max would lose a NaN.
        if balance > self.gap_residual || balance.is_nan() {
            balance
        } else {
            self.gap_residual
        }
    }
}

/// C F into the gaps and |C| F into the scales, by the columns of the loaded slices; C is symmetric, its rows are
/// contiguous.
struct Deflect<'a> {
    compliance: &'a [f64],
    force: &'a [f64],
    gap: &'a mut [f64],
    scale: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Deflect<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (gap, scale, n) = (self.gap, self.scale, self.force.len());
        gap.fill(0.0);
        scale.fill(0.0);
        for (column, &force) in self.compliance.chunks_exact(n.max(1)).zip(self.force) {
            if force != 0.0 {
                for ((gap, scale), c) in gap.iter_mut().zip(&mut *scale).zip(column) {
                    let term = c * force;
                    *gap += term;
                    *scale += term.abs();
                }
            }
        }
    }
}

impl Workspace {
    /// Takes the size and the shifted separations of `problem`.
    pub(super) fn load_problem(&mut self, problem: &Problem) -> Result<(), NlcpError> {
        let size = problem.size();
        if size > self.capacity {
            return Err(NlcpError::TooLarge {
                size,
                capacity: self.capacity,
            });
        }
        if size != self.size {
            self.reset();
            self.size = size;
        }
        self.first_contact = problem.first_contact();
        for i in 0..size {
            // Rounding may leave a tiny negative number for the first slice to touch.
            self.shifted[i] =
                (problem.separation[i] - self.first_contact * problem.closing[i]).max(0.0);
        }
        Ok(())
    }

    /// Sets all forces to zero and every slice open.
    pub(super) fn clear(&mut self) {
        let n = self.size;
        self.force[..n].fill(0.0);
        self.active[..n].fill(false);
        self.list.clear();
    }

    /// Lists the active slices.
    pub(super) fn collect(&mut self) {
        self.list.clear();
        self.list.extend((0..self.size).filter(|&i| self.active[i]));
    }

    /// Gaps, slopes, row scales and residual at the present forces and deflection.
    pub(super) fn evaluate(&mut self, problem: &Problem) -> Evaluation {
        let n = self.size;
        let (gap, scale) = (&mut self.gap[..n], &mut self.scale[..n]);
        let (force, slope, shifted) = (&self.force[..n], &mut self.slope[..n], &self.shifted[..n]);
        self.arch.dispatch(Deflect {
            compliance: problem.compliance,
            force,
            gap,
            scale,
        });
        let mut load = 0.0;
        for (force, lever) in force.iter().zip(problem.lever) {
            if *force != 0.0 {
                load += lever * force;
            }
        }
        let mut gap_residual: f64 = 0.0;
        for i in 0..n {
            let (local, local_slope) = problem.local[i].evaluate(force[i]);
            let closed = self.deflection * problem.closing[i];
            slope[i] = local_slope;
            gap[i] += local + (shifted[i] - closed);
            scale[i] += local.abs() + shifted[i] + closed.abs();
            let violation = if force[i] > 0.0 {
                gap[i].abs()
            } else {
                -gap[i]
            };
            if violation > gap_residual * scale[i] {
                gap_residual = violation / scale[i];
            } else if violation.is_nan() {
                gap_residual = f64::NAN;
            }
        }
        Evaluation { gap_residual, load }
    }

    /// Factors `C + diag δ'` of the listed slices.
    pub(super) fn factor_active(&mut self, problem: &Problem) -> Result<Shifted, NlcpError> {
        let n = self.size;
        let (list, slope) = (&self.list[..], &self.slope[..n]);
        let fill_row = |i: usize, row: &mut [f64]| {
            let entries = &problem.compliance[list[i] * n..][..n];
            for (value, &slice) in row.iter_mut().zip(&list[i..]) {
                *value = entries[slice];
            }
            row[0] += slope[list[i]];
        };
        self.factored.clear();
        let shifted = self.factor.factor(list.len(), fill_row).map_err(|bad| {
            NlcpError::NotPositiveDefinite {
                slice: list[bad.index],
                pivot: bad.pivot,
                diagonal: bad.diagonal,
            }
        })?;
        self.factored.extend_from_slice(&self.list);
        Ok(shifted)
    }

    /// Newton correction of the listed forces at fixed approach, `−(C + diag δ')⁻¹ g`, into `correction`.
    pub(super) fn correct_forces(&mut self) {
        for (value, &slice) in self.correction.iter_mut().zip(&self.list) {
            *value = -self.gap[slice];
        }
        self.factor.solve(&mut self.correction);
    }

    /// `(C + diag δ')⁻¹ w` of the listed slices into `per_approach`; returns `dT/dx = bᵀ(C + diag δ')⁻¹ w` \[N\].
    pub(super) fn differentiate(&mut self, problem: &Problem) -> f64 {
        for (value, &slice) in self.per_approach.iter_mut().zip(&self.list) {
            *value = problem.closing[slice];
        }
        self.factor.solve(&mut self.per_approach);
        self.weigh(problem, &self.per_approach)
    }

    /// Borders the correction: adds `Δy (C + diag δ')⁻¹ w` such that the corrected forces carry `missing` \[N·m\] more,
    /// and adds `Δy` to the deflection. False, and nothing changed, if the slices listed cannot balance a load.
    pub(super) fn balance_correction(&mut self, problem: &Problem, missing: f64) -> bool {
        let stiffness = self.differentiate(problem);
        if !(stiffness.is_finite() && stiffness != 0.0) {
            return false;
        }
        let approach = (missing - self.weigh(problem, &self.correction)) / stiffness;
        self.deflection += approach;
        for (value, rate) in self
            .correction
            .iter_mut()
            .zip(&self.per_approach)
            .take(self.list.len())
        {
            *value += approach * rate;
        }
        true
    }

    /// `Σ b_i v_i` over the listed slices.
    pub(super) fn weigh(&self, problem: &Problem, values: &[f64]) -> f64 {
        self.list
            .iter()
            .zip(values)
            .map(|(&slice, value)| problem.lever[slice] * value)
            .sum()
    }

    /// Start values without a last solution: every slice an independent spring `1/(C_ii + δ'_i)` (Winkler bedding).
    ///
    /// At given `y` the forces are `max(0, y w_i − e_i)·k_i`. For a given load `y` follows from the balance, a convex,
    /// piecewise linear equation whose Newton iteration from the right ends after finitely many steps.
    pub(super) fn start_from_springs(&mut self, problem: &Problem, load: Option<f64>) {
        let n = self.size;
        let lever_sum: f64 = problem.lever.iter().sum();
        let mean_closing = problem.closing.iter().sum::<f64>() / n as f64;
        for i in 0..n {
            let own = problem.compliance[i * n + i];
            let force = match load {
                Some(load) => load / lever_sum,
                None => {
                    let depth = self.deflection * mean_closing;
                    depth / (own + problem.local[i].slope(0.0)).max(f64::MIN_POSITIVE)
                }
            };
            let compliance = own + problem.local[i].slope(force).max(0.0);
            self.slope[i] = if compliance > 0.0 {
                1.0 / compliance
            } else {
                0.0
            };
        }
        if let Some(load) = load {
            self.deflection = self.spring_deflection(problem, load);
        }
        for i in 0..n {
            let depth = self.deflection * problem.closing[i] - self.shifted[i];
            self.active[i] = depth > 0.0;
            self.force[i] = if depth > 0.0 {
                depth * self.slope[i]
            } else {
                0.0
            };
        }
    }

    /// The deflection at which springs of stiffness `slope` carry `load`.
    fn spring_deflection(&self, problem: &Problem, load: f64) -> f64 {
        let n = self.size;
        let mut y = f64::INFINITY;
        for _ in 0..=n {
            let (mut stiffness, mut offset) = (0.0, 0.0);
            for i in 0..n {
                if y * problem.closing[i] > self.shifted[i] {
                    let weight = problem.lever[i] * self.slope[i];
                    stiffness += weight * problem.closing[i];
                    offset += weight * self.shifted[i];
                }
            }
            let next = (load + offset) / stiffness;
            if !next.is_finite() {
                return 0.0;
            }
            if next >= y {
                break;
            }
            y = next;
        }
        y
    }
}
