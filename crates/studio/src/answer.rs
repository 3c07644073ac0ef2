//! A result as the page draws it. Figures are those of `gearmesh run --json`; curves have the units of axes.

use gearmesh_report::moving::{pair_turns, touching_points_m};
use gearmesh_report::run_figures::pair_figures;
use gearmesh_scene::{LoadedScene, SceneResult};
use gearmesh_signal::OrderSpectrum;
use serde::Serialize;
use serde_json::Value;

use crate::problem::Problem;

const MM: f64 = 1e3;
const MICRO: f64 = 1e6;

/// Multiples of the mesh order that the spectrum shows.
const MESH_ORDERS: f64 = 12.0;

/// The answer to a change. T torques, A angles, L lines of contact at once, S slices.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(non_snake_case)]
pub struct PairAnswer {
    /// As `gearmesh run --json` prints them.
    pub figures: Value,
    /// Torques on gear 2, T.
    pub torques_Nm: Vec<f64>,
    /// Driver angles, A.
    pub angle_deg: Vec<f64>,
    /// Pitch of gear 1.
    pub pitch_deg: f64,
    /// Transmission error, `[T][A]`.
    pub te_um: Vec<f64>,
    /// Without load, A.
    pub unloaded_um: Vec<f64>,
    /// Width of the faces' overlap, over which stiffness is related.
    pub zone_width_mm: f64,
    /// Tangent mesh stiffness over the width, `[T][A]`.
    pub tangent_N_per_mm_um: Vec<f64>,
    /// Secant mesh stiffness over the width, `[T][A]`.
    pub secant_N_per_mm_um: Vec<f64>,
    /// Orders of the driver, N.
    pub orders: Vec<f64>,
    /// Amplitudes of the transmission error, `[T][N]`.
    pub amplitudes_um: Vec<f64>,
    /// Where and how hard the flanks touch.
    #[serde(flatten)]
    pub contact: ContactAnswer,
    /// Angles about z of both gears under the first torque, `[A][2]`.
    pub turns_rad: Vec<f64>,
    /// Centre distance.
    pub centre_distance_mm: f64,
    /// Mid-face of gear 2 from that of gear 1.
    pub axial_offset_mm: f64,
    /// Root strain of the gauges.
    pub strain: Vec<GaugeCurve>,
    /// Digests of the models: others have other shapes.
    pub models: [String; 2],
    /// Contact ratio in the transverse plane.
    pub contact_ratio: f64,
    /// Seconds of the solution and of the strain.
    pub seconds: [f64; 2],
}

/// Lines of contact, position by position.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(non_snake_case)]
pub struct ContactAnswer {
    /// L.
    pub slots: usize,
    /// S.
    pub slices: usize,
    /// Number of the pair of teeth on each line, `[A][L]`.
    pub pair: Vec<f64>,
    /// Lines, A.
    pub pair_count: Vec<u32>,
    /// Slice forces, `[T][A][L][S]`.
    pub force_N: Vec<f64>,
    /// Hertz pressures, `[T][A][L][S]`.
    pub pressure_MPa: Vec<f64>,
    /// Diameter on gear 1 where a slice touches, `[A][L][S]`; zero where none does.
    pub diameter_mm: Vec<f64>,
    /// Its axial place from mid-face of gear 1, `[A][L][S]`.
    pub z_mm: Vec<f64>,
    /// Its width, `[A][L][S]`.
    pub width_mm: Vec<f64>,
    /// Its place in the axes of gear 1, `[A][L][S][2]`.
    pub point_mm: Vec<f64>,
}

/// Strain of a gauge, `[T][A]`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GaugeCurve {
    gear: usize,
    name: String,
    method_1_ustrain: Vec<f64>,
    method_2_ustrain: Vec<f64>,
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| factor * value).collect()
}

impl PairAnswer {
    /// The answer of a run.
    ///
    /// # Errors
    /// [`Problem::Work`] for curves that have no spectrum.
    pub fn new(loaded: &LoadedScene, result: &SceneResult) -> Result<Self, Problem> {
        let pair = &loaded.lines.pair;
        let width_mm = MM * loaded.layout.reference.width_m;
        let turns = (0..result.angles()).flat_map(|angle| pair_turns(pair, result, (0, angle)));
        let (orders, amplitudes_um) = spectrum(result, pair.gear_1.teeth)?;
        Ok(Self {
            figures: pair_figures(result),
            torques_Nm: result.torque_nm.clone(),
            angle_deg: result
                .angle_rad
                .iter()
                .map(|angle| angle.to_degrees())
                .collect(),
            pitch_deg: pair.pitch_1_rad().to_degrees(),
            te_um: scaled(&result.te_m, MICRO),
            unloaded_um: scaled(&result.unloaded_m, MICRO),
            zone_width_mm: width_mm,
            tangent_N_per_mm_um: scaled(&result.tangent_n_per_m, 1e-6 / width_mm),
            secant_N_per_mm_um: scaled(&result.secant_n_per_m, 1e-6 / width_mm),
            orders,
            amplitudes_um,
            contact: ContactAnswer::new(loaded, result),
            turns_rad: turns.collect(),
            centre_distance_mm: MM * pair.centre_distance_m,
            axial_offset_mm: MM * loaded.scene.axial_offset_m,
            strain: result.strain.iter().map(gauge).collect(),
            models: loaded.model_digests.clone(),
            contact_ratio: pair.contact_ratio(),
            seconds: result.solution.seconds,
        })
    }
}

impl ContactAnswer {
    fn new(loaded: &LoadedScene, result: &SceneResult) -> Self {
        let pair = &loaded.lines.pair;
        let places = result.lines.places.clone().unwrap_or_default();
        let base_mm = MM * pair.gear_1.base_radius_m;
        let diameters = places.roll_1_rad.iter().zip(&places.width_m);
        let diameter = |(roll, width): (&f64, &f64)| match *width > 0.0 {
            true => 2.0 * base_mm * (1.0 + roll * roll).sqrt(),
            false => 0.0,
        };
        let points = touching_points_m(pair, result);
        Self {
            slots: result.lines.slots,
            slices: result.lines.slices,
            pair: result.lines.pair.clone(),
            pair_count: result.lines.pair_count.clone(),
            force_N: result.lines.force_n.clone(),
            pressure_MPa: scaled(&result.lines.pressure_pa, 1e-6),
            diameter_mm: diameters.map(diameter).collect(),
            z_mm: scaled(&places.z_m, MM),
            width_mm: scaled(&places.width_m, MM),
            point_mm: points.iter().flatten().map(|x| MM * x).collect(),
        }
    }
}

fn gauge(series: &gearmesh_scene::StrainSeries) -> GaugeCurve {
    GaugeCurve {
        gear: series.gear,
        name: series.name.clone(),
        method_1_ustrain: scaled(&series.method_1, MICRO),
        method_2_ustrain: scaled(&series.method_2, MICRO),
    }
}

/// Orders of the driver and amplitudes over whole periods, mean left out.
fn spectrum(result: &SceneResult, teeth: usize) -> Result<(Vec<f64>, Vec<f64>), Problem> {
    let pitches = result.contact_coverage.averaged_pitches();
    let (mut orders, mut amplitudes) = (Vec::new(), Vec::new());
    for torque in 0..result.torque_nm.len() {
        // A pitch is what a revolution is elsewhere.
        let curve = result.averaged(&result.te_m, torque);
        let found = OrderSpectrum::from_samples(curve, pitches);
        let found = found.map_err(|error| Problem::Work(error.to_string()))?;
        let of_mesh = found
            .orders()
            .into_iter()
            .skip(1)
            .take_while(|k| *k <= MESH_ORDERS);
        orders = of_mesh.map(|k| k * teeth as f64).collect();
        let own = found.amplitudes().into_iter().skip(1).take(orders.len());
        amplitudes.extend(own.map(|amplitude| MICRO * amplitude));
    }
    Ok((orders, amplitudes))
}
