//! The memory of the solver: allocated once, read after each solve, start of the next one.

use super::ldl::Ldl;

/// All arrays that a solve needs, for up to a fixed number of slices.
///
/// After a successful solve it holds the forces, gaps, the active set and the tangent; they are the warm start of
/// the next solve of the same size. After an error they are undefined and the next solve starts cold.
#[derive(Debug, Clone)]
pub struct Workspace {
    /// What the processor has for the loops; results do not depend on it.
    pub(super) arch: pulp::Arch,
    pub(super) capacity: usize,
    pub(super) size: usize,
    /// Whether forces, active set and deflection are those of a solved problem.
    pub(super) warm: bool,
    pub(super) force: Vec<f64>,
    pub(super) gap: Vec<f64>,
    /// Row scale `s_i` of the residual.
    pub(super) scale: Vec<f64>,
    /// `δ'_i` at the present force.
    pub(super) slope: Vec<f64>,
    /// `e_i − x₀ w_i ≥ 0`.
    pub(super) shifted: Vec<f64>,
    pub(super) active: Vec<bool>,
    /// Indices of the active slices, ascending.
    pub(super) list: Vec<usize>,
    pub(super) factor: Ldl,
    /// The slices that it was made of, ascending; none once it is of no use any more.
    pub(super) factored: Vec<usize>,
    /// Active block of the correction at fixed approach.
    pub(super) correction: Vec<f64>,
    /// Active block of `(C + diag δ')⁻¹ w`.
    pub(super) per_approach: Vec<f64>,
    pub(super) force_rate: Vec<f64>,
    /// `y = x − x₀`.
    pub(super) deflection: f64,
    pub(super) first_contact: f64,
}

impl Workspace {
    /// Memory for problems of up to `capacity` slices.
    pub fn new(capacity: usize) -> Self {
        let zeros = || vec![0.0; capacity];
        Workspace {
            arch: pulp::Arch::new(),
            capacity,
            size: 0,
            warm: false,
            force: zeros(),
            gap: zeros(),
            scale: zeros(),
            slope: zeros(),
            shifted: zeros(),
            active: vec![false; capacity],
            list: Vec::with_capacity(capacity),
            factor: Ldl::new(capacity),
            factored: Vec::with_capacity(capacity),
            correction: zeros(),
            per_approach: zeros(),
            force_rate: zeros(),
            deflection: 0.0,
            first_contact: 0.0,
        }
    }

    /// Largest number of slices.
    pub fn capacity(&self) -> usize {
        self.capacity
    }

    /// Forgets the last solution: the next solve starts cold.
    pub fn reset(&mut self) {
        self.warm = false;
        self.factored.clear();
    }

    /// Lets the next position solve, which must be of as many slices, start from these forces \[N\]; slices without
    /// force start open.
    ///
    /// # Panics
    /// If there are more forces than the capacity.
    pub fn start_from(&mut self, forces_n: &[f64]) {
        self.size = forces_n.len();
        self.factored.clear();
        for ((own, active), force) in self.force.iter_mut().zip(&mut self.active).zip(forces_n) {
            *own = force.max(0.0);
            *active = *force > 0.0;
        }
        self.warm = true;
        assert!(self.size <= self.capacity, "more forces than the capacity");
    }

    /// Slice forces `F` \[N\], zero or positive, of the last solve.
    pub fn forces(&self) -> &[f64] {
        &self.force[..self.size]
    }

    /// Gaps `g` \[m\], open positive, of the last solve; rounding level where the force is positive.
    pub fn gaps(&self) -> &[f64] {
        &self.gap[..self.size]
    }

    /// Indices of the slices in contact, ascending.
    pub fn active(&self) -> &[usize] {
        &self.list
    }

    /// Tangent `dF/dx` \[N/m\] of the last solve, `(C + diag δ')⁻¹ w` on the active set, zero elsewhere.
    pub fn force_rates(&self) -> &[f64] {
        &self.force_rate[..self.size]
    }

    /// Change of the forces \[N\] with the separations at fixed approach, `dF = −(C + diag δ')⁻¹ de` on the active
    /// set, zero elsewhere.
    ///
    /// `separation_change` is `de` \[m\], one entry a slice; `force_change` receives `dF`. The factor of the last solve
    /// is used, so that this costs O(n²). With `de` per second it gives the force per second.
    ///
    /// # Panics
    /// If an argument's length is not the number of slices of the last problem.
    pub fn apply_tangent(&mut self, separation_change: &[f64], force_change: &mut [f64]) {
        assert_eq!(
            separation_change.len(),
            self.size,
            "one separation change a slice"
        );
        assert_eq!(force_change.len(), self.size, "one force change a slice");
        for (value, &slice) in self.correction.iter_mut().zip(&self.list) {
            *value = -separation_change[slice];
        }
        self.factor.solve(&mut self.correction);
        force_change.fill(0.0);
        for (value, &slice) in self.correction.iter().zip(&self.list) {
            force_change[slice] = *value;
        }
    }

    /// −∂F/∂e of all slices \[N/m\], `[force][separation]`: (C + diag δ')⁻¹ on the active set, zero elsewhere, by the
    /// factor of the last solve. `inverse`: memory.
    pub(crate) fn stiffness(&self, inverse: &mut Vec<f64>, stiffness: &mut Vec<f64>) {
        let (n, m) = (self.size, self.list.len());
        stiffness.clear();
        stiffness.resize(n * n, 0.0);
        if m == 0 {
            // The factor is that of what touched last.
            return;
        }
        inverse.clear();
        inverse.resize((m + 1) * m, 0.0);
        let (inverse, row) = inverse.split_at_mut(m * m);
        self.factor.invert(inverse, row);
        for (&slice, row) in self.list.iter().zip(inverse.chunks_exact(m.max(1))) {
            let own = &mut stiffness[slice * n..][..n];
            for (&other, value) in self.list.iter().zip(row) {
                own[other] = *value;
            }
        }
    }
}
