//! Natural modes of a multibody scene as pictures that move: bodies about where they stand, as the mode moves them.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::path::Path;

use gearmesh_report::moving::GearSurface;
use gearmesh_scene::system::{BodyAtStart, MovingGear, PartShape};
use gearmesh_scene::system_run::{EigenResult, SystemResult, is_overdamped, shares_in_words};
use nalgebra::{Matrix3, Rotation3, Vector3};
use serde_json::{Value, json};

use crate::failure::{Failure, Result};
use crate::moving_parts::{PartsInMotion, place};
use crate::moving_system::{drawn, surfaces};
use crate::system_moments::{WantedMoments, machine_of};

/// Pictures of a period.
const FRAMES: usize = 36;
/// Largest motion that is drawn, as a share of the machine's size.
const LARGEST: f64 = 0.06;
/// Bodies named with a mode.
const MOST_SHARES: usize = 3;

/// The machine of a result of natural frequencies, and its modes.
#[derive(Debug)]
pub struct MovingModes {
    title: String,
    /// Bodies in the order of the shapes.
    bodies: Vec<String>,
    points: Vec<EigenResult>,
    /// Of each point and mode, what kind it is in words.
    kinds: Vec<Vec<String>>,
    gears: Vec<MovingGear>,
    starts: Vec<BodyAtStart>,
    surfaces: Vec<GearSurface>,
    parts: PartsInMotion,
    /// Radius of what each body carries \[m\], in the order of the machine's bodies.
    radii_m: Vec<f64>,
    /// Diagonal of the machine \[m\].
    size_m: f64,
}

impl MovingModes {
    /// Opens the result.
    ///
    /// # Errors
    /// [`Failure`] for files that are not as they were in the run, and for a result without modes.
    pub fn new(file: &Path, result: SystemResult) -> Result<Self> {
        let wanted = WantedMoments {
            result: file,
            from_s: None,
            to_s: None,
            scene_folder: None,
        };
        if result.eigen.is_empty() {
            let problem = format!("{}: has no natural modes", file.display());
            return Err(Failure::input(problem));
        }
        let machine = machine_of(&wanted, &result)?;
        let surfaces = surfaces(&machine.gears)?;
        let parts = PartsInMotion::at_start(&machine.parts);
        let radius = |body: &BodyAtStart| {
            let gears = machine.gears.iter().zip(&surfaces);
            let of_gears = gears.filter(|(gear, _)| gear.body == body.name);
            let points = of_gears.flat_map(|(_, surface)| &surface.points_m);
            let solids = machine.parts.parts.iter();
            let own = solids.filter(|part| part.body.as_ref() == Some(&body.name));
            let of_parts = own.map(|part| match part.shape {
                PartShape::Tube { radii_m, .. } => radii_m[1],
                PartShape::Box(edges_m) => 0.5 * Vector3::from(edges_m).norm(),
            });
            let of_points = points.map(|p| p[0].hypot(p[1]));
            of_points.chain(of_parts).fold(0.0, f64::max)
        };
        let radii_m: Vec<f64> = machine.parts.bodies.iter().map(radius).collect();
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for (body, radius) in machine.parts.bodies.iter().zip(&radii_m) {
            for k in 0..3 {
                low[k] = low[k].min(body.position_m[k] - radius);
                high[k] = high[k].max(body.position_m[k] + radius);
            }
        }
        let size_m = (Vector3::from(high) - Vector3::from(low)).norm();
        let sets = &result.head.sets;
        let kinds = result.eigen.iter();
        let kinds = kinds.map(|found| found.kinds_in_words(&result.bodies, sets));
        Ok(Self {
            title: result.head.title.clone(),
            kinds: kinds.collect(),
            bodies: result.bodies,
            points: result.eigen,
            gears: machine.gears,
            starts: machine.parts.bodies,
            surfaces,
            parts,
            radii_m,
            size_m,
        })
    }

    /// Title, surfaces, solids, and of each operating point its modes in words.
    #[must_use]
    pub fn description(&self) -> Value {
        let point = |(found, kinds): (&EigenResult, &Vec<String>)| {
            let mode = |k: usize| {
                let mode = &found.modes[k];
                let moves = shares_in_words(&self.bodies, &found.participation[k], MOST_SHARES);
                let vibrates = !is_overdamped(mode);
                json!({
                    "frequency_Hz": vibrates.then(|| mode.frequency_hz()),
                    "damping_ratio": vibrates.then(|| mode.damping_ratio()),
                    "decay_s": (!vibrates).then(|| -1.0 / mode.growth_per_s),
                    "moves": format!("{}{moves}", kinds[k]),
                })
            };
            json!({
                "load_factor": found.point.load_factor,
                "speed_rpm": found.point.speed_rad_per_s.map(|speed| speed * 60.0 / TAU),
                "modes": (0..found.modes.len()).map(mode).collect::<Vec<_>>(),
            })
        };
        json!({
            "title": self.title,
            "bodies": drawn(&self.gears, &self.surfaces),
            "parts": self.parts.solids(),
            "elements": self.parts.elements(),
            "points": self.points.iter().zip(&self.kinds).map(point).collect::<Vec<_>>(),
        })
    }

    /// The pictures of a period of a mode. Displacements are enlarged or reduced until the largest is a share of the
    /// machine's size.
    ///
    /// # Errors
    /// [`Failure::input`] for a point or mode that is not there.
    pub fn frames(&self, point: usize, mode: usize) -> Result<Value> {
        let found = self.points.get(point);
        let shape = found
            .and_then(|found| found.modes.get(mode))
            .map(|mode| &mode.shape)
            .ok_or_else(|| {
                Failure::input(format!("the result has no mode {mode} at point {point}"))
            })?;
        let starts = &self.starts;
        // Of each body six numbers, then those of its own modes.
        let mut first_of = BTreeMap::new();
        let mut first = 0;
        for name in &self.bodies {
            first_of.insert(name, first);
            let own = starts.iter().find(|body| body.name == *name);
            first += 6 + own.map_or(0, |body| body.modes);
        }
        let of_body = |body: &BodyAtStart| -> [[f64; 2]; 6] {
            let first = first_of.get(&body.name);
            let of = |k: usize| first.and_then(|first| shape.get(first + k)).copied();
            std::array::from_fn(|k| of(k).unwrap_or([0.0; 2]))
        };
        let motions: Vec<[[f64; 2]; 6]> = starts.iter().map(of_body).collect();
        let amount = |of: &[[f64; 2]]| of.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
        let amounts = motions.iter().zip(&self.radii_m);
        let largest = amounts
            .map(|(motion, radius)| amount(&motion[..3]).max(radius * amount(&motion[3..])))
            .fold(0.0, f64::max);
        let scale = match largest > 0.0 {
            true => LARGEST * self.size_m / largest,
            false => 0.0,
        };
        let frames = (0..FRAMES).map(|k| {
            let (sine, cosine) = (TAU * k as f64 / FRAMES as f64).sin_cos();
            let placed = |name: &str| {
                let at = starts.iter().position(|body| body.name == name);
                let Some(at) = at else {
                    return place(
                        &[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
                        &[0.0; 3],
                    );
                };
                let now =
                    motions[at].map(|[real, imaginary]| scale * (real * cosine - imaginary * sine));
                let turn = Rotation3::from_scaled_axis(Vector3::new(now[3], now[4], now[5]));
                let own = Matrix3::from_fn(|i, j| starts[at].rotation[i][j]);
                let turned = turn.matrix() * own;
                let rotation = std::array::from_fn(|i| std::array::from_fn(|j| turned[(i, j)]));
                let origin = std::array::from_fn(|k| starts[at].position_m[k] + now[k]);
                place(&rotation, &origin)
            };
            let gears = self.gears.iter().map(|gear| placed(&gear.body));
            let carriers = self.parts.carriers().iter().map(|body| placed(body));
            json!({
                "places": gears.collect::<Vec<_>>(),
                "forces": [],
                "carriers": carriers.collect::<Vec<_>>(),
                "angles_rad": self.parts.angles_rad(0),
                "element_loads_N": self.parts.loads_n(0),
            })
        });
        Ok(json!({"frames": frames.collect::<Vec<_>>()}))
    }
}
