//! How far the teeth of each mesh went past each other in a run in time: what of its periods the run has seen.
//!
//! ```text
//! ν_i = |∫ (ω_i − ω_c) dt| / 2π,      f = z₁ |∫ (ω₁ − ω_c) dt| / 2πT over the second half of the run
//! ```
//!
//! ω_i: turn of gear i about its own axis; ω_c: turn of the line of centres about it (zero where the axes stand, that
//! of the carrier in an epicyclic gear); T: length of that half, over which spectra go. What repeats with a gear's
//! revolution — the strain at one of its teeth, its openings, errors and run-out — is whole once ν_i ≥ 1
//! (docs/theory/periods.md).

use std::f64::consts::TAU;

use gearmesh_model::FileError;
use nalgebra::Vector3;

use super::job::MeshRecord;
use super::result::SystemResult;
use super::result_kind::ResultKind;
use crate::system::line_of_centres_rad_per_s;
use crate::system::names::{body_column, element_column};

/// Share of a revolution by which rows and start-up may miss a whole one.
const ROUNDING: f64 = 1e-6;

/// One mesh over a run in time.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshPassing {
    /// The mesh and its gears.
    pub mesh: MeshRecord,
    /// Revolutions of gear 1 and gear 2 against the line of centres.
    pub revolutions: [f64; 2],
    /// Mean mesh frequency over the second half of the run \[Hz\].
    pub frequency_hz: f64,
}

impl MeshPassing {
    /// Mesh pitches that the run saw.
    #[must_use]
    pub fn pitches(&self) -> f64 {
        self.mesh.teeth[0] as f64 * self.revolutions[0]
    }

    /// Whether a gear (1 or 2) went round at least once.
    #[must_use]
    pub fn is_whole(&self, gear: usize) -> bool {
        self.revolutions[gear - 1] >= 1.0 - ROUNDING
    }

    /// Whether a column is the strain at a tooth that need not have passed the mesh.
    #[must_use]
    pub fn leaves_incomplete(&self, column: &str) -> bool {
        (1..=2).any(|gear| {
            let strain = element_column(&self.mesh.name, &format!("strain_gear{gear}_"));
            !self.is_whole(gear) && column.starts_with(&strain)
        })
    }

    /// What the run saw, and what of it is not whole; for people.
    #[must_use]
    pub fn in_words(&self) -> String {
        let MeshRecord { name, bodies, .. } = &self.mesh;
        let mut text = format!(
            "mesh `{name}`: {:.3} Hz over the second half; in all {:.2} pitches, {:.3} revolutions of `{}`, {:.3} of `{}`",
            self.frequency_hz,
            self.pitches(),
            self.revolutions[0],
            bodies[0],
            self.revolutions[1],
            bodies[1],
        );
        let short: Vec<String> = (1..=2)
            .filter(|gear| !self.is_whole(*gear))
            .map(|gear| format!("`{}`", bodies[gear - 1]))
            .collect();
        if !short.is_empty() {
            let gears = short.join(" and ");
            text += &format!(
                "; less than a revolution of {gears}: strain at its teeth is incomplete, and so is what its openings, errors and \
                 run-out do to the rest"
            );
        }
        text
    }
}

impl SystemResult {
    /// The meshes of a transient run whose two gears are recorded.
    ///
    /// # Errors
    /// [`FileError`].
    pub fn mesh_passings(&self) -> Result<Vec<MeshPassing>, FileError> {
        let mut found = Vec::new();
        for mesh in &self.head.meshes {
            if self.kind == ResultKind::Transient
                && mesh.bodies.iter().all(|body| self.records(body))
            {
                found.push(self.passing(mesh)?);
            }
        }
        Ok(found)
    }

    /// Gears with gauges that go round less than once in some window of a speed sweep, in words; axes are taken to
    /// stand.
    #[must_use]
    pub fn incomplete_windows(&self) -> Vec<String> {
        let Some(sweep) = &self.sweep else {
            return Vec::new();
        };
        let mut lines = Vec::new();
        for mesh in &self.head.meshes {
            for (gear, body) in (1..).zip(&mesh.bodies) {
                let strain = element_column(&mesh.name, &format!("strain_gear{gear}_"));
                let spin = body_column(body, "angular_velocity_z_rad_per_s");
                let spin = sweep.columns.iter().position(|column| column.name == spin);
                let gauged = sweep
                    .columns
                    .iter()
                    .any(|column| column.name.starts_with(&strain));
                let Some(spin) = spin.filter(|_| gauged) else {
                    continue;
                };
                let windows = sweep.windows.iter().zip(&sweep.figures);
                let stretches = windows
                    .map(|(window, figures)| (figures[spin].mean, window.to_s - window.from_s));
                if let Some((short, least)) = short_of_a_revolution(stretches) {
                    lines.push(format!(
                        "mesh `{}`: strain at teeth of `{body}` is incomplete in {short} of {} windows, which hold less than a revolution of it \
                         ({least:.3} at the lowest speed); a longer `run.measure_s` covers it",
                        mesh.name,
                        sweep.windows.len()
                    ));
                }
            }
        }
        lines
    }

    fn records(&self, body: &str) -> bool {
        let name = body_column(body, "turn_rad");
        self.rows.columns().iter().any(|column| column.name == name)
    }

    fn passing(&self, mesh: &MeshRecord) -> Result<MeshPassing, FileError> {
        let read = |body: &str, channel: &str| self.rows.read(&body_column(body, channel));
        let three = |body: &str, channels: [&str; 3]| -> Result<[Vec<f64>; 3], FileError> {
            let [x, y, z] = channels.map(|channel| read(body, channel));
            Ok([x?, y?, z?])
        };
        let [first, second] = [&*mesh.bodies[0], &*mesh.bodies[1]];
        let places = ["x_m", "y_m", "z_m"];
        let rates = [
            "velocity_x_m_per_s",
            "velocity_y_m_per_s",
            "velocity_z_m_per_s",
        ];
        let places = [three(first, places)?, three(second, places)?];
        let rates = [three(first, rates)?, three(second, rates)?];
        let cardan = three(first, ["cardan_x_rad", "cardan_y_rad", "cardan_z_rad"])?;
        let between = |of: &[[Vec<f64>; 3]; 2], row: usize| {
            Vector3::from_fn(|axis, _| of[1][axis][row] - of[0][axis][row])
        };
        let carrier = |row: usize| {
            // Third column of R = Rx Ry Rz: gear 1's axis.
            let ((sin_x, cos_x), (sin_y, cos_y)) =
                (cardan[0][row].sin_cos(), cardan[1][row].sin_cos());
            let axis = Vector3::new(sin_y, -sin_x * cos_y, cos_x * cos_y);
            line_of_centres_rad_per_s(&between(&places, row), &between(&rates, row), &axis)
        };
        let times = self.rows.read("time_s")?;
        let carried = |rows: std::ops::Range<usize>| -> f64 {
            let steps = rows
                .skip(1)
                .map(|row| 0.5 * (times[row] - times[row - 1]) * (carrier(row - 1) + carrier(row)));
            steps.sum()
        };
        let turns = [read(first, "turn_rad")?, read(second, "turn_rad")?];
        let revolutions = |gear: usize, rows: std::ops::Range<usize>| {
            let turned = turns[gear][rows.end - 1] - turns[gear][rows.start];
            (turned - carried(rows)).abs() / TAU
        };
        let rows = times.len();
        if rows < 2 {
            return Ok(MeshPassing {
                mesh: mesh.clone(),
                revolutions: [0.0; 2],
                frequency_hz: 0.0,
            });
        }
        let half = (rows - 1) / 2;
        let passed = mesh.teeth[0] as f64 * revolutions(0, half..rows);
        Ok(MeshPassing {
            mesh: mesh.clone(),
            revolutions: [revolutions(0, 0..rows), revolutions(1, 0..rows)],
            frequency_hz: passed / (times[rows - 1] - times[half]),
        })
    }
}

/// How many stretches of (turning \[rad/s\], time \[s\]) hold less than a revolution, and the fewest revolutions; none
/// where all hold one.
fn short_of_a_revolution(stretches: impl Iterator<Item = (f64, f64)>) -> Option<(usize, f64)> {
    let turns = stretches.map(|(rad_per_s, seconds)| rad_per_s.abs() * seconds / TAU);
    let short = turns.filter(|turns| *turns < 1.0 - ROUNDING);
    let (count, least) = short.fold((0, f64::INFINITY), |(count, least), turns| {
        (count + 1, least.min(turns))
    });
    (count > 0).then_some((count, least))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn windows_of_less_than_a_revolution_are_counted() {
        let ten_hz = TAU * 10.0;
        let windows = [
            (-0.5 * ten_hz, 0.1),
            (ten_hz, 0.1),
            (-2.0 * ten_hz, 0.1),
            (0.25 * ten_hz, 0.1),
        ];
        let (count, least) = short_of_a_revolution(windows.into_iter()).unwrap();
        assert!(
            count == 2 && (least - 0.25).abs() < 1e-12,
            "{count} {least}"
        );
        assert_eq!(short_of_a_revolution([(ten_hz, 0.1)].into_iter()), None);
    }
}
