//! The columns of a study of a gear pair: one number for each torque. Units of all columns at rest.

use gearmesh_contact::mesh_stiffness::mesh_harmonics;
use gearmesh_specification::names::unknown;

use crate::pair::bevel_result::BevelRest;
use crate::pair::figure_table::{FIGURES, RestFigure};
use crate::pair::{LoadedScene, PairFigures, SceneResult, StrainSeries};

/// Harmonics of the mesh frequency that are listed.
const HARMONICS: usize = 10;

/// A column: one number for each torque of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct RestColumn {
    /// Name with unit.
    pub name: String,
    /// The number at each torque, in the unit of the name.
    pub values: Vec<f64>,
}

/// Unit of a column by the end of its name.
#[must_use]
pub fn unit_of(name: &str) -> &'static str {
    let units = [
        ("_N_per_mm_um", "N/(mm µm)"),
        ("_N_per_um", "N/µm"),
        ("_mm_per_mm", "mm/mm"),
        ("_mm_per_mrad", "mm/mrad"),
        ("_Nm_per_rad", "N·m/rad"),
        ("_um", "µm"),
        ("_MPa", "MPa"),
        ("_ustrain", "µε"),
        ("_urad", "µrad"),
        ("_mrad", "mrad"),
        ("_Mrev", "10⁶ revolutions"),
        ("_mm", "mm"),
        ("_Nm", "N·m"),
        ("_N", "N"),
    ];
    let found = units.into_iter().find(|(end, _)| name.ends_with(end));
    found.map_or("1", |(_, unit)| unit)
}

/// What decides the columns of a pair.
pub struct PairColumns {
    /// What it is as a bevel pair, if it is one.
    pub bevel: Option<BevelRest>,
    /// Positions of a pitch.
    pub points_per_pitch: usize,
    /// Gauges that are read: gear (1 or 2) and name.
    pub gauges: Vec<(usize, String)>,
}

impl PairColumns {
    /// Those of a scene.
    #[must_use]
    pub fn of_scene(loaded: &LoadedScene) -> Self {
        let name = |&(gear, index): &(usize, usize)| {
            (gear, loaded.models[gear - 1].gauges[index].name.clone())
        };
        Self {
            bevel: None,
            points_per_pitch: loaded.scene.points_per_pitch,
            gauges: loaded.gauges.iter().map(name).collect(),
        }
    }

    /// Those of a result.
    #[must_use]
    pub fn of_result(result: &SceneResult) -> Self {
        let name = |series: &StrainSeries| (series.gear, series.name.clone());
        Self {
            bevel: result.bevel,
            points_per_pitch: result.points_per_pitch(),
            gauges: result.strain.iter().map(name).collect(),
        }
    }

    fn figures(&self) -> impl Iterator<Item = &'static RestFigure> {
        let bevel = self.bevel;
        FIGURES
            .iter()
            .filter(move |figure| figure.is_studied(bevel.as_ref()))
    }

    fn harmonics(&self) -> usize {
        // A pitch that is sampled n times has (n − 1)/2 harmonics.
        HARMONICS.min((self.points_per_pitch - 1) / 2)
    }

    /// Names of all columns, in the order of `columns`.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = self.figures().map(RestFigure::name_in_studies).collect();
        names.extend((1..=self.harmonics()).map(|k| format!("te_harmonic_{k}_um")));
        for (gear, gauge) in &self.gauges {
            for method in [1, 2] {
                let of = format!("strain_gear{gear}_{gauge}_method{method}");
                names.extend(["range", "largest"].map(|what| format!("{of}_{what}_ustrain")));
            }
        }
        names
    }
}

/// The place of a column among the names.
///
/// # Errors
/// What to say of a name that is not among them, with the nearest.
pub fn place(name: &str, names: &[String]) -> Result<usize, String> {
    let found = names.iter().position(|known| known == name);
    found.ok_or_else(|| unknown("column", name, names))
}

/// All columns of a result.
#[must_use]
pub fn columns(result: &SceneResult) -> Vec<RestColumn> {
    let of = PairColumns::of_result(result);
    let torques = 0..result.torque_nm.len();
    let over = result.overlap_width_m().ok();
    let of_each = |of: &dyn Fn(usize) -> f64| torques.clone().map(of).collect::<Vec<f64>>();
    let figures: Vec<PairFigures> = torques.clone().map(|k| result.figures(k)).collect();
    let mut values: Vec<Vec<f64>> = (of.figures())
        .map(|figure| figures.iter().map(|f| figure.studied(f, over)).collect())
        .collect();
    let harmonics = of.harmonics();
    let pitches = result.contact_coverage.averaged_pitches();
    let spectra: Vec<Vec<(f64, f64)>> = (torques.clone())
        .map(|k| mesh_harmonics(result.averaged(&result.te_m, k), pitches, harmonics).1)
        .collect();
    for harmonic in 0..harmonics {
        values.push(of_each(&|k| {
            1e6 * spectra[k].get(harmonic).map_or(0.0, |line| line.0)
        }));
    }
    for series in 0..result.strain.len() {
        for method in [1, 2] {
            let ends = |k: usize| result.strain_ends(series, method, k);
            values.push(of_each(&|k| 1e6 * (ends(k)[1] - ends(k)[0])));
            values.push(of_each(&|k| 1e6 * ends(k)[1]));
        }
    }
    let column = |(name, values)| RestColumn { name, values };
    of.names().into_iter().zip(values).map(column).collect()
}
