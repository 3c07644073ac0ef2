//! The stages of a result: what follows from their teeth, beside torques, forces, speeds and K_Hβ of the run.
//!
//! ```text
//! K_Hβ = max_i q̄_i / (Σ q̄_i / n)
//! ```
//!
//! q̄_i: mean line load of slice i over the rows of the table, n: number of slices.

use std::f64::consts::TAU;

use gearmesh_model::{Column, FileError};

use super::column_statistics::Figures;
use super::job::MeshRecord;
use super::result::SystemResult;
use super::result_kind::ResultKind;
use super::run_record::RunRecord;
use super::summary::without_rounding;
use crate::pair::warnings::{ColumnPressure, yielding, yielding_in_words};
use crate::rating::RatingResult;
use crate::system::names::{body_column, element_column};

/// N/(mm·µm) in SI, N/m².
const N_PER_MM_UM: f64 = 1e9;

/// What is less than this share of the largest force is rounding.
const ROUNDING: f64 = 1e-9;

/// Load of a mesh, mean over some rows, or at an operating point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StageLoad {
    /// Moments of the mesh on the bodies of gear 1 and gear 2 about their z \[N·m\].
    pub moments_nm: [f64; 2],
    /// Tangential, radial and axial force on gear 1 \[N\], signs as in docs/results.md; none of `kinematic` meshes.
    pub forces_n: Option<[f64; 3]>,
    /// K_Hβ; none where no slice carries.
    pub k_h_beta: Option<f64>,
    /// Pairs of teeth that carry; none of `kinematic` meshes.
    pub loaded_pairs: Option<f64>,
}

impl StageLoad {
    /// From the channels of the mesh; `read` has none of those that are not recorded.
    ///
    /// # Errors
    /// Those of `read`.
    pub(super) fn of(
        mesh: &MeshRecord,
        mut read: impl FnMut(&str) -> Result<Option<f64>, FileError>,
    ) -> Result<Option<Self>, FileError> {
        let mut element = |channel: &str| read(&element_column(&mesh.name, channel));
        let [first, second] = ["moment_1_Nm", "moment_2_Nm"].map(&mut element);
        if let (Some(first), Some(second)) = (first?, second?) {
            let forces = ["tangential", "radial", "axial"];
            let [tangential, radial, axial] =
                forces.map(|way| element(&format!("{way}_force_1_N")));
            let forces_n = match (tangential?, radial?, axial?) {
                (Some(t), Some(r), Some(a)) => Some([t, r, a]),
                _ => None,
            };
            let mut slices = Vec::new();
            while let Some(line_load) =
                element(&format!("line_load_slice_{}_N_per_m", slices.len() + 1))?
            {
                slices.push(line_load);
            }
            let sum: f64 = slices.iter().sum();
            let most = slices.iter().copied().fold(0.0, f64::max);
            return Ok(Some(Self {
                moments_nm: [first, second],
                forces_n,
                k_h_beta: (sum > 0.0).then(|| most * slices.len() as f64 / sum),
                loaded_pairs: element("loaded_pairs")?,
            }));
        }
        // A ratio: what it puts on gear 2, and by the numbers of teeth on gear 1.
        let joint = format!("joints/{}/moment_z_Nm", mesh.name.replace('/', "_"));
        Ok(read(&joint)?.map(|second| Self {
            moments_nm: [second / mesh.ratio(), second],
            ..Self::default()
        }))
    }
}

/// One stage.
#[derive(Debug, Clone, PartialEq)]
pub struct StageRow {
    /// The mesh, its gears, its figures without load.
    pub mesh: MeshRecord,
    /// Speeds of the gears about their z \[rad/s\]: means of a run in time, elsewhere those of the start; none where
    /// they are not recorded.
    pub speeds_rad_per_s: [Option<f64>; 2],
    /// Load; none where the mesh is not recorded.
    pub load: Option<StageLoad>,
}

/// All stages of a result.
#[derive(Debug, Clone, PartialEq)]
pub struct StageTable {
    /// What the figures of the run are of: "mean over 0.1 to 0.2 s".
    pub over: String,
    /// In the order of the scene.
    pub rows: Vec<StageRow>,
}

/// A figure of all stages.
#[derive(Debug, Clone, PartialEq)]
pub struct StageLine {
    /// Name for machines, with the unit.
    pub key: &'static str,
    /// Name for people.
    pub label: &'static str,
    /// Unit for people; empty for numbers.
    pub unit: &'static str,
    /// A value each stage, in that unit; none where it does not exist.
    pub values: Vec<Option<f64>>,
}

impl StageTable {
    /// The figures line by line: those of the teeth first, then those of the run.
    #[must_use]
    pub fn lines(&self) -> Vec<StageLine> {
        let line = |key, label, unit, value: &dyn Fn(&StageRow) -> Option<f64>| StageLine {
            key,
            label,
            unit,
            values: self.rows.iter().map(value).collect(),
        };
        let rpm = |row: &StageRow, gear: usize| row.speeds_rad_per_s[gear].map(|w| w * 60.0 / TAU);
        let moment = |row: &StageRow, gear: usize| row.load.map(|l| l.moments_nm[gear]);
        // What gear 1 gives the mesh, and what gear 2 takes from it: the mesh turns gear 2.
        let power = |row: &StageRow, gear: usize| {
            let watts = row.load?.moments_nm[gear] * row.speeds_rad_per_s[gear]?;
            Some(if gear == 0 { -watts } else { watts })
        };
        let force = |row: &StageRow, way: usize| {
            let forces = row.load?.forces_n?;
            let largest = forces.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
            // Spur teeth have no axial force but for rounding.
            let is_rounding = forces[way].abs() < ROUNDING * largest;
            Some(if is_rounding { 0.0 } else { forces[way] })
        };
        let of_teeth = |row: &StageRow| row.mesh.stage;
        let ratio = |row: &StageRow| Some(row.mesh.ratio());
        let all = vec![
            line("ratio", "ratio z2/z1", "", &ratio),
            line("contact_ratio", "eps_alpha", "", &|r| {
                Some(of_teeth(r)?.contact_ratio)
            }),
            line("overlap_ratio", "eps_beta", "", &|r| {
                Some(of_teeth(r)?.overlap_ratio)
            }),
            line(
                "single_stiffness_N_per_mm_um",
                "c' of ISO 6336-1",
                "N/(mm·µm)",
                &|r| Some(of_teeth(r)?.single_stiffness_n_per_m2 / N_PER_MM_UM),
            ),
            line(
                "mesh_stiffness_N_per_mm_um",
                "c_gamma of ISO 6336-1",
                "N/(mm·µm)",
                &|r| Some(of_teeth(r)?.mesh_stiffness_n_per_m2 / N_PER_MM_UM),
            ),
            line("largest_sliding_percent", "largest sliding", "%", &|r| {
                Some(100.0 * of_teeth(r)?.largest_sliding)
            }),
            line("speed_1_rpm", "speed of gear 1", "1/min", &|r| rpm(r, 0)),
            line("speed_2_rpm", "speed of gear 2", "1/min", &|r| rpm(r, 1)),
            line(
                "pitch_line_at_start_m_per_s",
                "pitch line at the start",
                "m/s",
                &|r| Some(of_teeth(r)?.pitch_line_speed_m_per_s),
            ),
            line("moment_1_Nm", "torque on gear 1", "N·m", &|r| moment(r, 0)),
            line("moment_2_Nm", "torque on gear 2", "N·m", &|r| moment(r, 1)),
            line("power_1_W", "power from gear 1", "W", &|r| power(r, 0)),
            line("power_2_W", "power to gear 2", "W", &|r| power(r, 1)),
            line("tangential_force_N", "tangential force", "N", &|r| {
                force(r, 0)
            }),
            line("radial_force_N", "radial force", "N", &|r| force(r, 1)),
            line("axial_force_N", "axial force", "N", &|r| force(r, 2)),
            line("loaded_pairs", "pairs that carry", "", &|r| {
                r.load?.loaded_pairs
            }),
            line("k_h_beta", "K_Hbeta", "", &|r| r.load?.k_h_beta),
        ];
        let is_known = |line: &StageLine| line.values.iter().any(Option::is_some);
        all.into_iter().filter(is_known).collect()
    }
}

/// Power that goes in and does not come out, as a share, from which it is reported.
const LOST: f64 = 0.01;

impl StageTable {
    /// What is wrong with the loads: meshes that are open, and power that goes into a mesh and does not come out.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let mut found = Vec::new();
        for row in &self.rows {
            let (name, Some(load)) = (&row.mesh.name, &row.load) else {
                continue;
            };
            if load.loaded_pairs == Some(0.0) {
                found.push(format!(
                    "mesh `{name}` is open, {}: no pair of teeth carries",
                    self.over
                ));
                continue;
            }
            let [Some(first), Some(second)] = row.speeds_rad_per_s else {
                continue;
            };
            // Where the line of centres is carried round, power goes through the carrier, too.
            let [into, out] = [load.moments_nm[0] * first, load.moments_nm[1] * second];
            let is_held = (second + first / row.mesh.ratio()).abs() <= LOST * second.abs();
            let largest = into.abs().max(out.abs());
            if is_held && (into + out).abs() > LOST * largest && largest > 1e-6 {
                found.push(format!(
                    "power does not balance in mesh `{name}`, {}: {:.6} W at gear 1 and {:.6} W at gear 2; friction of teeth takes what is missing, or a \
                     body that gathers speed",
                    self.over, -into, -out
                ));
            }
        }
        found
    }
}

/// Steps that found no equilibrium of forces are repeated shorter; many of them are the sign of a force that jumps.
/// One in a hundred costs little and is usual where bodies strike each other.
fn repeated_steps(record: &RunRecord) -> Option<String> {
    (100.0 * record.unconverged > record.steps).then(|| {
        format!(
            "{} of {} steps did not converge and were repeated shorter; look for forces that jump with position or speed, or allow shorter steps",
            record.unconverged, record.steps
        )
    })
}

impl SystemResult {
    /// What is to be reported of the figures: what cannot be rated or is beyond a limit of bearings, pressures under
    /// which steel yields, meshes that are open, power that does not balance. What was said before the run is among
    /// the notes of the head.
    ///
    /// # Errors
    /// [`FileError`].
    pub fn warnings(&self) -> Result<Vec<String>, FileError> {
        let mut found: Vec<String> = self
            .ratings
            .iter()
            .flat_map(RatingResult::reported)
            .collect();
        let yielding = yielding(self.pressures()?.into_iter());
        found.extend(yielding.as_ref().map(yielding_in_words));
        found.extend(self.record.as_ref().and_then(repeated_steps));
        // Open meshes of natural frequencies are among the notes.
        if self.kind != ResultKind::Eigen {
            found.extend(self.stages()?.iter().flat_map(StageTable::warnings));
        }
        Ok(found)
    }

    /// Columns of pressure and the largest value of each \[Pa\].
    ///
    /// # Errors
    /// [`FileError`].
    pub fn pressures(&self) -> Result<Vec<ColumnPressure>, FileError> {
        let columns = self.rows.columns().iter().enumerate();
        let of_pressure =
            columns.filter(|(_, one)| one.unit == "Pa" && one.name.contains("pressure"));
        let largest = |(i, column): (usize, &Column)| {
            let largest = match self.statistics.get(i) {
                Some(figures) => figures.largest,
                None => Figures::of(&self.rows.read(&column.name)?).largest,
            };
            Ok((column.name.clone(), largest))
        };
        of_pressure.map(largest).collect()
    }

    /// The stages: means over the second half of a run in time, over the equilibria of the largest load factor, over
    /// the window of a sweep in which the meshes carry most, or the last operating point of the largest load factor.
    /// None of a scene without gear meshes.
    ///
    /// # Errors
    /// [`FileError`].
    pub fn stages(&self) -> Result<Option<StageTable>, FileError> {
        if self.head.meshes.is_empty() {
            return Ok(None);
        }
        let (over, span) = self.span()?;
        let mut rows = Vec::new();
        for (i, mesh) in self.head.meshes.iter().enumerate() {
            let load = match span {
                Span::Point(point) => {
                    let mut loads = self.eigen[point].loads.iter();
                    loads.find(|(mesh, _)| *mesh == i).map(|(_, load)| *load)
                }
                _ => StageLoad::of(mesh, |column| self.mean_of(&span, column))?,
            };
            let spin = |body: &String| body_column(body, "angular_velocity_z_rad_per_s");
            let speeds_rad_per_s = if self.kind.is_in_time() {
                let [first, second] = [&mesh.bodies[0], &mesh.bodies[1]].map(spin);
                [self.mean_of(&span, &first)?, self.mean_of(&span, &second)?]
            } else {
                mesh.speeds_rad_per_s.map_or([None; 2], |w| w.map(Some))
            };
            rows.push(StageRow {
                mesh: mesh.clone(),
                speeds_rad_per_s,
                load,
            });
        }
        Ok(Some(StageTable { over, rows }))
    }

    /// What the stages' figures are of, in words and as a part of the result.
    pub(super) fn span(&self) -> Result<(String, Span), FileError> {
        match self.kind {
            ResultKind::Eigen => {
                let factor = |i: &usize| self.eigen[*i].point.load_factor;
                let points = 0..self.eigen.len();
                let last = points.max_by(|a, b| factor(a).total_cmp(&factor(b)));
                Ok(
                    last.map_or(("at no point".to_owned(), Span::Rows(Vec::new())), |last| {
                        let over =
                            format!("at the operating point of load factor {}", factor(&last));
                        (over, Span::Point(last))
                    }),
                )
            }
            ResultKind::SpeedSweep => Ok(self.span_of_windows()),
            ResultKind::Transient => {
                let times = self.rows.read("time_s")?;
                let half = times.len() / 2;
                let [from, to] = [times.get(half), times.last()]
                    .map(|t| without_rounding(t.copied().unwrap_or(0.0)));
                let over = format!("mean over the second half of the run, {from} to {to} s");
                Ok((over, Span::Rows((half..times.len()).collect())))
            }
            ResultKind::Static => {
                let factors = self.rows.read("load_factor")?;
                let most = factors.iter().copied().fold(f64::MIN, f64::max);
                let is_most = |i: &usize| factors[*i].to_bits() == most.to_bits();
                let rows: Vec<usize> = (0..factors.len()).filter(is_most).collect();
                let over = match rows.len() {
                    1 => format!("in the equilibrium of load factor {most}"),
                    n => format!("mean over the {n} equilibria of load factor {most}"),
                };
                Ok((over, Span::Rows(rows)))
            }
        }
    }

    /// The window in which the moments of all meshes are largest.
    fn span_of_windows(&self) -> (String, Span) {
        let none = || ("in no window".to_owned(), Span::Rows(Vec::new()));
        let Some(sweep) = &self.sweep else {
            return none();
        };
        let names: Vec<String> = (self.head.meshes.iter())
            .map(|mesh| element_column(&mesh.name, "moment_1_Nm"))
            .collect();
        let load = |window: &usize| -> f64 {
            let columns = sweep.columns.iter().zip(&sweep.figures[*window]);
            let moments = columns.filter(|(column, _)| names.contains(&column.name));
            moments.map(|(_, figures)| figures.mean.abs()).sum()
        };
        let windows = 0..sweep.windows.len().min(sweep.figures.len());
        let most = windows.max_by(|a, b| load(a).total_cmp(&load(b)));
        most.map_or_else(none, |window| {
            let rpm = without_rounding(sweep.windows[window].speed_rad_per_s * 60.0 / TAU);
            let over = format!("mean over the window of {rpm} 1/min, where the meshes carry most");
            (over, Span::Window(window))
        })
    }

    /// Mean of a column over what the stages' figures are of; none where it is not recorded.
    fn mean_of(&self, span: &Span, name: &str) -> Result<Option<f64>, FileError> {
        match span {
            Span::Point(_) => Ok(None),
            Span::Window(window) => Ok(self.sweep.as_ref().and_then(|sweep| {
                let place = sweep.columns.iter().position(|c| c.name == name)?;
                Some(sweep.figures[*window][place].mean)
            })),
            Span::Rows(rows) => {
                let is_recorded = self.rows.columns().iter().any(|c| c.name == name);
                if !is_recorded || rows.is_empty() {
                    return Ok(None);
                }
                let values = self.rows.read(name)?;
                let values: Vec<f64> = rows.iter().map(|&row| values[row]).collect();
                Ok(Some(Figures::of(&values).mean))
            }
        }
    }
}

/// Part of a result.
pub(super) enum Span {
    /// Some rows.
    Rows(Vec<usize>),
    /// Window of a sweep.
    Window(usize),
    /// Operating point of natural frequencies.
    Point(usize),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_one_repeated_step_in_a_hundred_is_reported() {
        let record = |unconverged| RunRecord {
            steps: 1000.0,
            unconverged,
            ..RunRecord::default()
        };
        assert_eq!(repeated_steps(&record(10.0)), None);
        let warning = repeated_steps(&record(42.0));
        assert!(warning.is_some_and(|text| text.starts_with("42 of 1000 steps")));
    }
}
