//! Whether the steps of a run follow its meshes, at speeds that nobody could know before.
//!
//! What the scene states is checked before the run (system/assembly/mesh_frequency.rs); a gear that runs up under its
//! loads, or an adaptive step that grows, is seen here.

use std::f64::consts::TAU;

use gearmesh_dynamics::{BodyId, State, System};
use nalgebra::Vector3;

use super::error::SystemRunError;
use super::job::MeshRecord;
use crate::system::line_of_centres_rad_per_s;

/// Steps that a mesh period has at least during a run: somewhat fewer than before it, so that a speed which only swings
/// about the stated one ends no run.
const STEPS_A_PERIOD: f64 = 8.0;

struct Mesh {
    name: String,
    gears: [BodyId; 2],
    teeth: usize,
}

/// The meshes of a run that are force elements; a ratio has no teeth to be followed.
pub(super) struct MeshPace {
    meshes: Vec<Mesh>,
}

impl MeshPace {
    pub(super) fn new(system: &System, records: &[MeshRecord]) -> Self {
        let body = |name: &str| {
            let mut bodies = system.body_ids().zip(system.bodies());
            bodies.find(|(_, body)| body.name == name).map(|(id, _)| id)
        };
        let meshes = records.iter().filter_map(|record| {
            system.elements().find(|name| *name == record.name)?;
            Some(Mesh {
                name: record.name.clone(),
                gears: [body(&record.bodies[0])?, body(&record.bodies[1])?],
                teeth: record.teeth[0],
            })
        });
        Self {
            meshes: meshes.collect(),
        }
    }

    /// Refuses an accepted step that is too long for a mesh. Allocates nothing unless it does.
    pub(super) fn follow(
        &self,
        system: &System,
        state: &State,
        step_s: f64,
    ) -> Result<(), SystemRunError> {
        for mesh in &self.meshes {
            let [first, second] = mesh.gears.map(|gear| system.body_motion(state, gear));
            let carrier = line_of_centres_rad_per_s(
                &(second.position_m - first.position_m),
                &(second.velocity_m_per_s - first.velocity_m_per_s),
                &(first.orientation * Vector3::z()),
            );
            let turning = first.angular_velocity_rad_per_s.z - carrier;
            let frequency_hz = mesh.teeth as f64 * turning.abs() / TAU;
            if step_s * frequency_hz * STEPS_A_PERIOD > 1.0 {
                return Err(SystemRunError::StepPassesTeeth {
                    mesh: mesh.name.clone(),
                    time_s: state.time_s,
                    frequency_hz,
                    step_s,
                });
            }
        }
        Ok(())
    }
}
