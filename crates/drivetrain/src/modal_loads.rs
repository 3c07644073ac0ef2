//! Forces of a mesh on the vibration modes of its gears, and what they depend on.
//!
//! ```text
//! Q_m = Σ_i F_i ψ_im,   ψ = φ + Σ_a τ_a(v) s_a     ∂F_i = −Σ_j (K_ij ∂gap_j + D_ij ∂(gap rate)_j),   ∂gap_j/∂η_m = ∂(gap rate)_j/∂η̇_m = φ_jm
//!                                                  ∂τ_a = Σ_b τ_a,b ∂v_b,   v_b = k_b·(u̇, ω) + s_b·η̇
//! ```
//!
//! τ is friction on gear 2 over the normal force along one tangent or two, s_a how fast vibration slides the flanks
//! along a tangent: its power on the gears and their modes is F τ·v. On involute flanks there is one tangent, s = −σ
//! φ_t with the shape φ_t along the profile towards the tip, and τ = −μ. Without friction ψ = φ.
//!
//! Left out of the tangent: how φ changes with the place on the flank, of the order of deflection over pitch as all
//! that the mesh leaves out.

use crate::flank_contacts::FlankContacts;
use crate::flank_modes::add_scaled;
use crate::friction::Drag;
use crate::models::teeth_model::TeethLoads;
use crate::pose::Vector6;

/// Modal forces and the parts of the tangents that have to do with modes; gear 1's modes first, then gear 2's.
#[derive(Debug, Clone, Default)]
pub struct ModalLoads {
    counts: [usize; 2],
    /// Q \[√kg·m/s²\].
    pub force: Vec<f64>,
    /// ∂Q/∂(increments of the pose), one a mode; zero unless asked for, as all that follows.
    pub force_by_pose: Vec<Vector6>,
    /// ∂Q/∂(rates of the pose).
    pub force_by_rates: Vec<Vector6>,
    /// ∂load/∂η, one a mode.
    pub load_by_coordinates: Vec<Vector6>,
    /// ∂load/∂η̇.
    pub load_by_rates: Vec<Vector6>,
    /// ∂Q/∂η, `[force][coordinate]`.
    pub by_coordinates: Vec<f64>,
    /// ∂Q/∂η̇.
    pub by_rates: Vec<f64>,
    shape: Vec<f64>,
    sliding: [Vec<f64>; 2],
    along: [Vec<f64>; 2],
}

/// How one contact's force acts and changes: its direction on gear 2, and ∂F by pose and rates.
pub(crate) struct ContactChange {
    pub direction: Vector6,
    pub by_pose: Vector6,
    pub by_rates: Vector6,
    /// Friction and the normal force \[N\] under which it acts.
    pub rubbing: Option<(Drag, f64)>,
}

impl ModalLoads {
    /// Sizes for the modes of gear 1 and gear 2.
    pub(crate) fn new(counts: [usize; 2]) -> Self {
        let m = counts[0] + counts[1];
        Self {
            counts,
            force: vec![0.0; m],
            force_by_pose: vec![Vector6::zeros(); m],
            force_by_rates: vec![Vector6::zeros(); m],
            load_by_coordinates: vec![Vector6::zeros(); m],
            load_by_rates: vec![Vector6::zeros(); m],
            by_coordinates: vec![0.0; m * m],
            by_rates: vec![0.0; m * m],
            shape: vec![0.0; m],
            sliding: [vec![0.0; m], vec![0.0; m]],
            along: [vec![0.0; m], vec![0.0; m]],
        }
    }

    /// Modes of gear 1 and gear 2.
    #[must_use]
    pub fn counts(&self) -> [usize; 2] {
        self.counts
    }

    /// Number of modes of both gears.
    #[must_use]
    pub fn count(&self) -> usize {
        self.counts[0] + self.counts[1]
    }

    pub(crate) fn begin(&mut self, tangents: bool) {
        self.force.fill(0.0);
        if tangents {
            for rows in [
                &mut self.force_by_pose,
                &mut self.force_by_rates,
                &mut self.load_by_coordinates,
                &mut self.load_by_rates,
            ] {
                rows.fill(Vector6::zeros());
            }
            self.by_coordinates.fill(0.0);
            self.by_rates.fill(0.0);
        }
    }

    /// Adds the force of a contact: normal, and friction on gear 2 along the tangents.
    pub(crate) fn add_force(
        &mut self,
        contact: usize,
        (normal_n, friction_n): (f64, [f64; 2]),
        found: &FlankContacts,
    ) {
        let (first, second) = self.force.split_at_mut(self.counts[0]);
        for (half, rows) in [first, second].into_iter().zip(&found.modal) {
            if rows.count() > 0 {
                add_scaled(half, normal_n, rows.shape(contact));
                for (tangent, force_n) in friction_n.into_iter().enumerate() {
                    add_scaled(half, force_n, rows.sliding(contact, tangent));
                }
            }
        }
    }

    /// Adds the tangents of a contact.
    pub(crate) fn add_tangents(
        &mut self,
        contact: usize,
        change: &ContactChange,
        loads: &TeethLoads,
        found: &FlankContacts,
    ) {
        let matrices = [&loads.stiffness_n_per_m, &loads.damping_n_s_per_m];
        for (along, matrix) in self.along.iter_mut().zip(matrices) {
            along.fill(0.0);
            let (first, second) = along.split_at_mut(self.counts[0]);
            for (half, rows) in [first, second].into_iter().zip(&found.modal) {
                let (start, entries) = loads.row(matrix, contact);
                for (other, entry) in (start..).zip(entries) {
                    if rows.count() > 0 && *entry != 0.0 {
                        add_scaled(half, -entry, rows.shape(other));
                    }
                }
            }
        }
        let (first, second) = self.shape.split_at_mut(self.counts[0]);
        for (half, rows) in [first, second].into_iter().zip(&found.modal) {
            if rows.count() > 0 {
                half.copy_from_slice(rows.shape(contact));
            }
        }
        if let Some(rubbing) = &change.rubbing {
            self.add_rubbing(contact, rubbing, found);
        }
        let m = self.count();
        for (mode, &phi) in self.shape.iter().enumerate() {
            self.force_by_pose[mode] += phi * change.by_pose;
            self.force_by_rates[mode] += phi * change.by_rates;
            self.load_by_coordinates[mode] += self.along[0][mode] * change.direction;
            self.load_by_rates[mode] += self.along[1][mode] * change.direction;
            add_scaled(
                &mut self.by_coordinates[mode * m..][..m],
                phi,
                &self.along[0],
            );
            add_scaled(&mut self.by_rates[mode * m..][..m], phi, &self.along[1]);
        }
    }

    /// Makes ψ of the contact's φ, and adds what the forces change as friction does with the sliding speed.
    fn add_rubbing(
        &mut self,
        contact: usize,
        (drag, force_n): &(Drag, f64),
        found: &FlankContacts,
    ) {
        for (tangent, sliding) in self.sliding.iter_mut().enumerate().take(drag.tangents) {
            let (first, second) = sliding.split_at_mut(self.counts[0]);
            for (half, rows) in [first, second].into_iter().zip(&found.modal) {
                if rows.count() > 0 {
                    half.fill(0.0);
                    add_scaled(half, 1.0, rows.sliding(contact, tangent));
                }
            }
            add_scaled(&mut self.shape, drag.shares[tangent], sliding);
        }
        let m = self.count();
        for a in 0..drag.tangents {
            for b in 0..drag.tangents {
                let by_speed = force_n * drag.share_by_speed[a][b];
                for mode in 0..m {
                    let on_mode = by_speed * self.sliding[a][mode];
                    self.force_by_pose[mode] += on_mode * drag.speeds_by_pose[b];
                    self.force_by_rates[mode] += on_mode * drag.directions[b];
                    self.load_by_rates[mode] +=
                        by_speed * self.sliding[b][mode] * drag.directions[a];
                    let row = &mut self.by_rates[mode * m..][..m];
                    add_scaled(row, on_mode, &self.sliding[b]);
                }
            }
        }
    }
}
