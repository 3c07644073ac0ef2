//! The figures of one torque of a result: the one place where curves become numbers. How they are shown:
//! `figure_table.rs`.
//!
//! Means go over the even grid and whole periods, extremes over all positions: those between the even ones, too
//! (`between_positions.rs`).

use std::path::Path;

use gearmesh_contact::ContactZone;
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, GearPair, InputError, Misalignment};

use super::bevel_result::BevelFigures;
use super::result::SceneResult;
use super::scene_file::Scene;

/// Width over which the faces overlap \[m\].
fn overlap_width_m(gears: [&GearDefinition; 2], scene: &Scene) -> f64 {
    let widths = gears.map(|gear| gear.tooth.face_width_m);
    ContactZone::new(widths, scene.axial_offset_m).width_m
}

/// Figures of one torque.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairFigures {
    /// Torque on gear 2 \[N·m\].
    pub torque_nm: f64,
    /// Transmission error \[m\].
    pub te_mean_m: f64,
    /// Largest less smallest transmission error \[m\].
    pub te_peak_to_peak_m: f64,
    /// The same without load \[m\].
    pub unloaded_peak_to_peak_m: f64,
    /// Mesh stiffness \[N/m\].
    pub secant_mean_n_per_m: f64,
    /// Mesh stiffness \[N/m\].
    pub tangent_mean_n_per_m: f64,
    /// Largest less smallest tangent mesh stiffness \[N/m\].
    pub tangent_peak_to_peak_n_per_m: f64,
    /// Largest Hertz pressure \[Pa\].
    pub pressure_largest_pa: f64,
    /// Largest over mean line load of the most loaded line, worst position.
    pub k_h_beta: f64,
    /// Axial force on gear 1 \[N\].
    pub axial_force_1_mean_n: f64,
    /// Normal force of all pairs of teeth \[N\].
    pub normal_force_mean_n: f64,
    /// Largest relative error of the torque balance.
    pub torque_balance: f64,
    /// Largest relative residual of the contact problem.
    pub residual: f64,
    /// Newton iterations, mean.
    pub iterations_per_position: f64,
    /// Those of bevel pairs alone.
    pub bevel: Option<BevelFigures>,
    /// How far the figures may be off.
    pub errors: FigureErrors,
}

/// Estimated errors of figures, as shares of them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FigureErrors {
    /// Of the peak-to-peak value of the transmission error, by the positions.
    pub te_positions: Option<f64>,
    /// Of the largest pressure, by the positions.
    pub pressure_positions: Option<f64>,
    /// Of K_Hβ, by the positions.
    pub k_h_beta_positions: Option<f64>,
    /// Of K_Hβ, by the slices; none with fewer than three.
    pub slices: Option<f64>,
    /// Of the mean transmission error, by the meshes of both gears: at most what teeth deflect by less or more, for the
    /// contact deforms, too.
    pub mesh_te: Option<f64>,
    /// Of strain, by the mesh: the gauge with the largest estimate.
    pub mesh_strain: Option<f64>,
}

impl SceneResult {
    /// Width over which the faces of the gears overlap \[m\].
    ///
    /// # Errors
    /// [`InputError`] where a gear file or the scene inside the result is not understood.
    pub fn overlap_width_m(&self) -> Result<f64, InputError> {
        if let Some(bevel) = &self.bevel {
            return Ok(bevel.face_widths_m[0].min(bevel.face_widths_m[1]));
        }
        Ok(overlap_width_m(self.definitions()?, &self.scene()?))
    }

    /// The pair on its flanks, its axes parallel; none of bevel pairs.
    ///
    /// # Errors
    /// As of [`Self::overlap_width_m`].
    pub fn gear_pair(&self) -> Result<Option<GearPair>, InputError> {
        if self.bevel.is_some() {
            return Ok(None);
        }
        let scene = self.scene()?;
        let [first, second] = self.definitions()?.map(|gear| gear.profile.clone());
        let parallel = Misalignment::default();
        let pair = GearPair::new(first, second, scene.centre_distance_m, parallel);
        let pair = pair.map_err(|e| scene.document.error("pair", e))?;
        Ok(Some(pair.on_flanks(scene.flank)))
    }

    /// What both gears of a pair of cylindrical gears are.
    ///
    /// # Errors
    /// As of [`Self::overlap_width_m`].
    pub fn definitions(&self) -> Result<[&GearDefinition; 2], InputError> {
        let [first, second] = &self.source.gears;
        Ok([
            first.definition_in("the result")?,
            second.definition_in("the result")?,
        ])
    }

    /// The scene inside the result.
    ///
    /// # Errors
    /// [`InputError`] for a scene that this version does not understand.
    pub fn scene(&self) -> Result<Scene, InputError> {
        let document = InputDocument::new("scene in result", &self.source.scene_toml);
        Scene::from_document(document, Path::new("."))
    }

    /// The figures of a torque.
    #[must_use]
    pub fn figures(&self, torque: usize) -> PairFigures {
        let mean = |values: &[f64]| mean(self.averaged(values, torque));
        let between = self.between.of(torque);
        let swing = |values: &[f64], between: &[f64]| {
            swing(self.curve(values, torque).iter().chain(between))
        };
        let block = self.lines.slots * self.lines.slices;
        let (first, last) = (torque * self.angles(), (torque + 1) * self.angles());
        let even = &self.lines.pressure_pa[first * block..last * block];
        let block = self.between.slots * self.lines.slices;
        let added = &self.between.pressure_pa[between.start * block..between.end * block];
        let normal = self.normal_force_n(torque);
        let averaged = self.averaged(&self.te_m, torque).len();
        PairFigures {
            torque_nm: self.torque_nm[torque],
            te_mean_m: mean(&self.te_m),
            te_peak_to_peak_m: swing(&self.te_m, &self.between.te_m[between.clone()]),
            unloaded_peak_to_peak_m: self::swing(
                self.unloaded_m.iter().chain(&self.between.unloaded_m),
            ),
            secant_mean_n_per_m: mean(&self.secant_n_per_m),
            tangent_mean_n_per_m: mean(&self.tangent_n_per_m),
            tangent_peak_to_peak_n_per_m: swing(
                &self.tangent_n_per_m,
                &self.between.tangent_n_per_m[between],
            ),
            pressure_largest_pa: even.iter().chain(added).copied().fold(0.0, f64::max),
            k_h_beta: self.lines.k_h_beta[torque],
            axial_force_1_mean_n: mean(&self.axial_force_1_n),
            normal_force_mean_n: self::mean(&normal[..averaged]),
            torque_balance: self.solution.torque_balance[torque],
            residual: self.solution.residual[torque],
            iterations_per_position: f64::from(self.solution.iterations[torque])
                / self.angles() as f64,
            bevel: BevelFigures::of(self, torque),
            errors: self.errors(torque),
        }
    }

    /// Largest and smallest strain of a gauge by a method (1 or 2) under a torque.
    #[must_use]
    pub fn strain_ends(&self, series: usize, method: usize, torque: usize) -> [f64; 2] {
        let it = &self.strain[series];
        let even = if method == 1 {
            &it.method_1
        } else {
            &it.method_2
        };
        let added = &it.between[method - 1];
        let periods = added.len() / self.between.angle_rad.len().max(1);
        let own = self.between.of(torque);
        let own = own.start * periods..own.end * periods;
        let added = added.get(own).unwrap_or_default();
        ends(self.curve(even, torque).iter().chain(added))
    }

    /// What means go over, in words.
    #[must_use]
    pub fn means_over(&self) -> String {
        let coverage = &self.contact_coverage;
        let (over, run) = (coverage.averaged_pitches(), coverage.run_pitches);
        if !coverage.is_whole() {
            return format!(
                "means over all {run} pitches, less than a period of {}",
                coverage.period_pitches
            );
        }
        format!(
            "means over {over} of {run} pitches: {} times the period of {}",
            over / coverage.period_pitches,
            coverage.period_pitches
        )
    }

    /// How far the figures of all torques may be off, in one line; the largest error of all torques each.
    #[must_use]
    pub fn errors_in_words(&self) -> String {
        let largest = |of: fn(&FigureErrors) -> Option<f64>| {
            let errors = (0..self.torque_nm.len()).filter_map(|k| of(&self.errors(k)));
            errors.reduce(f64::max)
        };
        let percent = |error: f64| format!("{:.2} %", 100.0 * error);
        let positions = match [
            largest(|e| e.te_positions),
            largest(|e| e.pressure_positions),
            largest(|e| e.k_h_beta_positions),
        ] {
            [Some(te), Some(pressure), Some(factor)] => format!(
                "positions {} of the peak-to-peak TE, {} of the pressure, {} of K_Hbeta ({} of them at events and peaks)",
                percent(te),
                percent(pressure),
                percent(factor),
                self.between.angle_rad.len()
            ),
            _ => "positions not estimated".to_owned(),
        };
        let slices = largest(|e| e.slices).map_or("slices not estimated".to_owned(), |error| {
            format!("slices {} of K_Hbeta", percent(error))
        });
        let mesh = [
            (largest(|e| e.mesh_te), "mean TE"),
            (largest(|e| e.mesh_strain), "strain"),
        ];
        let mesh: Vec<String> = (mesh.into_iter())
            .filter_map(|(error, of)| Some(format!("{} of the {of}", percent(error?))))
            .collect();
        let mesh = match mesh.is_empty() {
            true => "mesh not estimated".to_owned(),
            false => format!("mesh {}", mesh.join(", ")),
        };
        format!("{positions}; {slices}; {mesh}")
    }

    fn errors(&self, torque: usize) -> FigureErrors {
        let gauges = self
            .strain
            .iter()
            .filter_map(|series| series.error_estimate());
        FigureErrors {
            te_positions: self.between.te_error.get(torque).copied(),
            pressure_positions: self.between.pressure_error.get(torque).copied(),
            k_h_beta_positions: self.between.k_h_beta_error.get(torque).copied(),
            slices: self.slice_error(torque),
            mesh_te: (self.te_mesh_error > 0.0).then_some(self.te_mesh_error),
            mesh_strain: gauges.reduce(f64::max),
        }
    }

    /// What lies between the slices of the most loaded line: how far a parabola through the mean line loads of three
    /// neighbours rises above the largest mean, over it. At the position at which that line is loaded least evenly.
    fn slice_error(&self, torque: usize) -> Option<f64> {
        if self.lines.slices < 3 {
            return None;
        }
        let mut worst = (0.0, 0.0);
        for angle in 0..self.angles() {
            let lines = (0..self.lines.slots).map(|slot| self.forces(torque, angle, slot));
            let sum = |forces: &[f64]| forces.iter().sum::<f64>();
            let Some(line) = lines.max_by(|a, b| sum(a).total_cmp(&sum(b))) else {
                continue;
            };
            // Slices that are partly on the path have a part of the load only.
            if line.contains(&0.0) {
                continue;
            }
            let unevenness = line.iter().copied().fold(0.0, f64::max) / sum(line);
            if unevenness > worst.0 {
                worst = (unevenness, rise_above_means(line));
            }
        }
        (worst.0 > 0.0).then_some(worst.1)
    }
}

/// How far the parabolas through three neighbouring means rise above the largest mean, over it: in a cell of unit width
/// about its middle p(x) = b − k/24 + s x + k x²/2, k = a − 2b + c, s = (c − a)/2.
fn rise_above_means(means: &[f64]) -> f64 {
    let last = means.len() - 1;
    let top = (0..=last).fold(0, |top, k| if means[k] > means[top] { k } else { top });
    let middle = top.clamp(1, last - 1);
    let [a, b, c] = [means[middle - 1], means[middle], means[middle + 1]];
    let (bend, slope) = (a - 2.0 * b + c, 0.5 * (c - a));
    let parabola = |x: f64| b - bend / 24.0 + slope * x + 0.5 * bend * x * x;
    let own = top as f64 - middle as f64;
    let (from, to) = (own - 0.5, own + 0.5);
    let vertex = if bend < 0.0 { -slope / bend } else { from };
    let highest = [from, to, vertex.clamp(from, to)].map(parabola);
    highest.into_iter().fold(0.0, f64::max) / means[top] - 1.0
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn ends<'a>(values: impl Iterator<Item = &'a f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], x| {
        [least.min(*x), most.max(*x)]
    })
}

fn swing<'a>(values: impl Iterator<Item = &'a f64>) -> f64 {
    let [least, most] = ends(values);
    most - least
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Means of a parabola over cells: the parabola itself is found.
    #[test]
    fn a_parabola_between_the_slices_is_found() {
        let load = |x: f64| 5.0 + 0.8 * x - 0.3 * x * x;
        let integral = |x: f64| 5.0 * x + 0.4 * x * x - 0.1 * x * x * x;
        let mean = |k: f64| integral(k + 0.5) - integral(k - 0.5);
        // Its top, at 4/3, lies in the second cell; without that cell at the end of the last one.
        let inside = rise_above_means(&[mean(0.0), mean(1.0), mean(2.0)]);
        assert!((inside - (load(4.0 / 3.0) / mean(1.0) - 1.0)).abs() < 1e-12);
        let at_end = rise_above_means(&[mean(-2.0), mean(-1.0), mean(0.0)]);
        assert!((at_end - (load(0.5) / mean(0.0) - 1.0)).abs() < 1e-12);
        assert!(rise_above_means(&[2.0; 4]).abs() < 1e-15);
    }
}
