//! How the planets of a set share its load, over the rows that the stages' figures are of.
//!
//! ```text
//! s_n = N M_n/Σ_k M_k           share of planet n: moment of its mesh on sun or ring over the mean of all N
//! K_γ = max_n max_rows s_n      mesh load factor (ISO 6336-1: uneven load of several paths)
//! e   = φ_c − (φ_r − i φ_s)/(1 − i)   transmission error of the carrier, after Willis; i: ratio, carrier held
//! ```
//!
//! [`SystemResult::planet_shares`] has the shares row by row, over the turn of the carrier.
//!
//! The moments on sun and ring about their axes are those of the meshes alone: friction included, inertia left out.

use gearmesh_model::FileError;

use super::column_statistics::Figures;
use super::result::SystemResult;
use super::result_kind::ResultKind;
use super::stages::Span;
use crate::system::names::{body_column, element_column};
use crate::system::planetary::PlanetarySet;

const AXES: [&str; 3] = ["x", "y", "z"];

/// Moments of the meshes on sun and ring.
const SUN_CHANNEL: &str = "moment_1_Nm";
const RING_CHANNEL: &str = "moment_2_Nm";

/// The meshes of one central member.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshShares {
    /// Share of each planet, mean over the rows; 1 where all carry the same.
    pub mean: Vec<f64>,
    /// The largest share of each planet.
    pub largest: Vec<f64>,
    /// Normal force of each planet's mesh, mean over the rows \[N\]; that of both flanks together.
    pub normal_force_n: Vec<f64>,
}

impl MeshShares {
    /// K_γ.
    #[must_use]
    pub fn mesh_load_factor(&self) -> f64 {
        self.largest.iter().copied().fold(0.0, f64::max)
    }
}

/// Figures of a set.
#[derive(Debug, Clone, PartialEq)]
pub struct SetFigures {
    /// The set.
    pub set: PlanetarySet,
    /// What the figures are of.
    pub over: String,
    /// Sun meshes; none where they are not recorded or do not carry.
    pub sun: Option<MeshShares>,
    /// Meshes of planets and partners, by the moments on planets; none of planets without.
    pub pair: Option<MeshShares>,
    /// Ring meshes.
    pub ring: Option<MeshShares>,
    /// Largest distance of the sun from the middle of its orbit \[m\], of a sun that is recorded.
    pub sun_orbit_m: Option<f64>,
    /// Radial force of the pin on each planet, largest of the rows \[N\]: of its bearings together, or of its joint.
    pub pin_force_n: Option<Vec<f64>>,
    /// The same of the partners.
    pub partner_pin_force_n: Option<Vec<f64>>,
    /// Peak-to-peak transmission error of the carrier \[rad\].
    pub transmission_error_rad: Option<f64>,
}

impl SetFigures {
    /// Names of its single figures.
    pub const NAMES: [&str; 4] = [
        "sun_mesh_load_factor",
        "ring_mesh_load_factor",
        "sun_orbit_m",
        "transmission_error_rad",
    ];

    /// Its single figures: name, unit, value; those that the result has.
    pub fn figures(&self) -> impl Iterator<Item = (&'static str, &'static str, f64)> {
        let factor =
            |shares: &Option<MeshShares>| shares.as_ref().map(MeshShares::mesh_load_factor);
        let values = [
            (factor(&self.sun), "1"),
            (factor(&self.ring), "1"),
            (self.sun_orbit_m, "m"),
            (self.transmission_error_rad, "rad"),
        ];
        let named = Self::NAMES.into_iter().zip(values);
        named.filter_map(|(name, (value, unit))| Some((name, unit, value?)))
    }
}

/// Shares of the planets of a set, row by row: `[planet][row]`; 1 where all carry the same, NaN where none carries.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanetShares {
    /// The set.
    pub set: PlanetarySet,
    /// How far the carrier has turned \[rad\]; none where it is not recorded.
    pub carrier_rad: Option<Vec<f64>>,
    /// Of the sun meshes; none where they are not recorded.
    pub sun: Option<Vec<Vec<f64>>>,
    /// Of the ring meshes.
    pub ring: Option<Vec<Vec<f64>>>,
}

impl SystemResult {
    /// How the planets of all sets share the load in rows of a result.
    ///
    /// # Errors
    /// [`FileError`].
    pub fn planet_shares(&self, rows: &[usize]) -> Result<Vec<PlanetShares>, FileError> {
        let columns = Columns { result: self, rows };
        let of_set = |set: &PlanetarySet| {
            Ok(PlanetShares {
                set: set.clone(),
                carrier_rad: columns.read(&body_column(&set.members.carrier, "turn_rad"))?,
                sun: columns.share_curves(&set.sun_meshes, SUN_CHANNEL)?,
                ring: columns.share_curves(&set.ring_meshes, RING_CHANNEL)?,
            })
        };
        self.head.sets.iter().map(of_set).collect()
    }

    /// Figures of all planetary sets, of runs in time with rows and of equilibria.
    ///
    /// # Errors
    /// [`FileError`].
    pub fn sets(&self) -> Result<Vec<SetFigures>, FileError> {
        if !matches!(self.kind, ResultKind::Transient | ResultKind::Static) {
            return Ok(Vec::new());
        }
        let (over, span) = self.span()?;
        let Span::Rows(rows) = span else {
            return Ok(Vec::new());
        };
        let over = over.replacen("mean over", "over", 1);
        let columns = Columns {
            result: self,
            rows: &rows,
        };
        let of_set = |set: &PlanetarySet| {
            Ok(SetFigures {
                sun: columns.shares(&set.sun_meshes, SUN_CHANNEL)?,
                pair: columns.shares(&set.partners.meshes, SUN_CHANNEL)?,
                ring: columns.shares(&set.ring_meshes, RING_CHANNEL)?,
                sun_orbit_m: columns.orbit_m(set)?,
                pin_force_n: columns.pin_forces_n(set, &set.planets)?,
                partner_pin_force_n: columns.pin_forces_n(set, &set.partners.bodies)?,
                transmission_error_rad: columns.transmission_error_rad(set)?,
                over: over.clone(),
                set: set.clone(),
            })
        };
        self.head.sets.iter().map(of_set).collect()
    }
}

/// The columns of a result in some of its rows.
struct Columns<'a> {
    result: &'a SystemResult,
    rows: &'a [usize],
}

impl Columns<'_> {
    /// A column; none that is not recorded.
    fn read(&self, name: &str) -> Result<Option<Vec<f64>>, FileError> {
        let rows = &self.result.rows;
        if self.rows.is_empty() || !rows.columns().iter().any(|c| c.name == name) {
            return Ok(None);
        }
        let all = rows.read(name)?;
        Ok(Some(self.rows.iter().map(|&row| all[row]).collect()))
    }

    fn read_all(
        &self,
        names: impl Iterator<Item = String>,
    ) -> Result<Option<Vec<Vec<f64>>>, FileError> {
        names.map(|name| self.read(&name)).collect()
    }

    /// A channel of the meshes of all planets.
    fn of_meshes(
        &self,
        meshes: &[String],
        channel: &str,
    ) -> Result<Option<Vec<Vec<f64>>>, FileError> {
        let names = meshes.iter().map(|mesh| element_column(mesh, channel));
        self.read_all(names)
    }

    /// The share of each planet in each row; NaN where none carries.
    fn share_curves(
        &self,
        meshes: &[String],
        channel: &str,
    ) -> Result<Option<Vec<Vec<f64>>>, FileError> {
        let Some(mut moments) = self.of_meshes(meshes, channel)? else {
            return Ok(None);
        };
        let count = moments.len() as f64;
        for row in 0..self.rows.len() {
            let sum: f64 = moments.iter().map(|m| m[row]).sum();
            let share = |moment: f64| {
                if sum == 0.0 {
                    f64::NAN
                } else {
                    count * moment / sum
                }
            };
            moments.iter_mut().for_each(|m| m[row] = share(m[row]));
        }
        Ok((!moments.is_empty()).then_some(moments))
    }

    fn shares(&self, meshes: &[String], channel: &str) -> Result<Option<MeshShares>, FileError> {
        let Some(shares) = self.share_curves(meshes, channel)? else {
            return Ok(None);
        };
        if shares.iter().flatten().any(|share| share.is_nan()) {
            return Ok(None);
        }
        let figures: Vec<Figures> = shares.iter().map(|own| Figures::of(own)).collect();
        let mut normal_force_n = vec![0.0; meshes.len()];
        for flank in ["normal_force_right_N", "normal_force_left_N"] {
            let forces = self.of_meshes(meshes, flank)?.unwrap_or_default();
            let sums = normal_force_n.iter_mut().zip(&forces);
            sums.for_each(|(sum, force)| *sum += Figures::of(force).mean);
        }
        Ok(Some(MeshShares {
            mean: figures.iter().map(|f| f.mean).collect(),
            largest: figures.iter().map(|f| f.largest).collect(),
            normal_force_n,
        }))
    }

    fn orbit_m(&self, set: &PlanetarySet) -> Result<Option<f64>, FileError> {
        let Some(sun) = &set.members.sun else {
            return Ok(None);
        };
        let places = self.read_all(
            AXES.iter()
                .map(|axis| body_column(sun, &format!("{axis}_m"))),
        )?;
        Ok(places.map(|places| {
            let middle: Vec<f64> = places.iter().map(|own| Figures::of(own).mean).collect();
            let distance = |row: usize| set.across([0, 1, 2].map(|i| places[i][row] - middle[i]));
            (0..self.rows.len()).map(distance).fold(0.0, f64::max)
        }))
    }

    fn pin_forces_n(
        &self,
        set: &PlanetarySet,
        planets: &[String],
    ) -> Result<Option<Vec<f64>>, FileError> {
        let mut forces = Vec::new();
        for planet in planets {
            let of =
                |columns: &dyn Fn(&str) -> String| self.read_all(AXES.map(columns).into_iter());
            let mut parts = of(&|axis| format!("joints/{planet} pin/force_world_{axis}_N"))?;
            let mut number = 1;
            while let Some(more) = of(&|axis| {
                let bearing = format!("{planet} bearing {number}");
                element_column(&bearing, &format!("force_world_{axis}_N"))
            })? {
                match &mut parts {
                    None => parts = Some(more),
                    Some(sum) => {
                        let pairs = sum.iter_mut().flatten().zip(more.iter().flatten());
                        pairs.for_each(|(sum, own)| *sum += own);
                    }
                }
                number += 1;
            }
            let Some(parts) = parts else { return Ok(None) };
            let radial = |row: usize| set.across([0, 1, 2].map(|i| parts[i][row]));
            forces.push((0..self.rows.len()).map(radial).fold(0.0, f64::max));
        }
        Ok(Some(forces).filter(|forces| !forces.is_empty()))
    }

    fn transmission_error_rad(&self, set: &PlanetarySet) -> Result<Option<f64>, FileError> {
        let Some(ratio) = set.teeth.carrier_held_ratio() else {
            return Ok(None);
        };
        let members = [
            set.members.sun.as_ref(),
            set.members.ring.as_ref(),
            Some(&set.members.carrier),
        ];
        let names = members
            .into_iter()
            .flatten()
            .map(|body| body_column(body, "turn_rad"));
        let Some(turns) = self.read_all(names)? else {
            return Ok(None);
        };
        // φ_r − φ_c = i (φ_s − φ_c), i the ratio with the carrier held.
        let carrier =
            |row: usize| turns[2][row] - (turns[1][row] - ratio * turns[0][row]) / (1.0 - ratio);
        let errors: Vec<f64> = (0..self.rows.len()).map(carrier).collect();
        Ok((errors.len() > 1).then(|| Figures::of(&errors).peak_to_peak()))
    }
}
