//! What is known of a mesh once its gears have places and speeds.

use super::bodies::Bodies;
use super::gear_mesh::PreparedMesh;
use super::mesh_frequency::{frequency_hz, spin_rad_per_s};
use crate::system::built::BuiltMesh;
use crate::system::stage_summary::StageSummary;

impl PreparedMesh {
    /// The mesh for plans and results; `fastest`: its bodies at the highest speeds of a run in time, `steady`: at those
    /// that motions keep while it is judged.
    pub(super) fn describe(
        &self,
        bodies: &Bodies,
        fastest: Option<&Bodies>,
        steady: Option<&Bodies>,
    ) -> BuiltMesh {
        let at_start_hz = frequency_hz(self, bodies);
        let later_hz = fastest.map_or(0.0, |fastest| frequency_hz(self, fastest));
        let steady_hz = steady.map(|steady| frequency_hz(self, steady));
        let stage = self.built.stage.map(|stage| StageSummary {
            pitch_line_speed_m_per_s: stage.pitch_radius_1_m * spin_rad_per_s(self, bodies).abs(),
            ..stage
        });
        BuiltMesh {
            frequency_hz: at_start_hz,
            highest_hz: later_hz.max(at_start_hz),
            steady_hz: steady_hz.filter(|hz| *hz > 0.0),
            speeds_rad_per_s: self.bodies.map(|body| bodies.list[body].spin()),
            stage,
            ..self.built.clone()
        }
    }
}
