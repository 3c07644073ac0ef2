//! A mesh model: every pair of teeth is a linear spring that pushes only, shared by its slices.

use gearmesh_drivetrain::{DrivetrainError, FlankContacts, TeethLoads, TeethModel};

pub struct SpringTeeth {
    /// Of a pair over its whole width.
    pub stiffness_n_per_m: f64,
    pub slices: usize,
}

impl TeethModel for SpringTeeth {
    fn evaluate(
        &mut self,
        flanks: &FlankContacts,
        _tangents: bool,
        loads: &mut TeethLoads,
    ) -> Result<(), DrivetrainError> {
        let n = flanks.contacts.len();
        for (i, contact) in flanks.contacts.iter().enumerate() {
            let depth = -contact.gap_m;
            if depth <= 0.0 {
                continue;
            }
            // Share of the slice that lies on the path of contact: 1 on spur teeth.
            let share = flanks.section(contact).share;
            let k = self.stiffness_n_per_m / self.slices as f64 * share;
            let stored = 0.5 * k * depth * depth;
            loads.normal_n[i] = k * depth;
            loads.stiffness_n_per_m[i * n + i] = k;
            loads.stored_j += stored;
            // F²/(2k) at constant force: what a slice that grows wider does to the motion.
            loads.energy_by_share[contact.section] -= stored / share;
        }
        Ok(())
    }
}
