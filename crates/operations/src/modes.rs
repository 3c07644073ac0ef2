//! Natural frequencies and shapes of a gear with its bore held, or the ends of its shaft's stubs.

use crate::failure::{Failure, Result};
use crate::gear_file::{GearFile, note_element, note_sound};
use crate::memory;
use crate::mesh_file::{LengthUnit, MeshFields, export_mesh};
use crate::watch::Watch;
use crate::{output_name, overwriting};
use gearmesh_geometry::{GearDefinition, ModeRange};
use gearmesh_model::{Field, RigidBody};
use gearmesh_reduction::{GearBody, GearMode, GearModes, OfflineJob, ReductionError};
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Which modes of which gear.
#[derive(Debug, Clone, clap::Args, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct ModesRequest {
    /// Gear file with material.density_kg_per_m3
    pub gear: PathBuf,
    /// So many modes, the lowest; instead of what the gear file says
    #[arg(long, conflicts_with = "up_to_Hz")]
    pub count: Option<usize>,
    /// All modes up to this frequency; instead of what the gear file says
    #[arg(long = "up-to-Hz")]
    pub up_to_Hz: Option<f64>,
    /// Mesh file for the shapes, one point field a mode (.vtu, .msh, ...)
    #[arg(long)]
    pub shapes: Option<PathBuf>,
    /// Begin even if the memory estimate exceeds what is free
    #[arg(long)]
    #[serde(default)]
    pub even_if_memory_is_short: bool,
}

/// Modes that were found.
#[derive(Debug)]
pub struct FoundModes {
    /// Name of the gear.
    pub gear: String,
    /// Where it is held.
    pub held: String,
    /// Degrees of freedom that are left.
    pub dofs: usize,
    /// The modes.
    pub modes: GearModes,
    /// The body as a rigid one.
    pub rigid: RigidBody,
}

/// Finds the modes of a cylindrical gear, and writes their shapes where asked for.
///
/// # Errors
/// [`Failure`] where the gear has no density or cannot be meshed, the range is wrong, or a file cannot be written.
pub fn modes(a: &ModesRequest, watch: &Watch<'_>) -> Result<FoundModes> {
    let outputs: Vec<PathBuf> = a.shapes.iter().cloned().collect();
    overwriting::refuse(vec![a.gear.clone()], &outputs)?;
    if let Some(path) = &a.shapes {
        output_name::demand_mesh(path)?;
    }
    let read = GearFile::read(&a.gear, watch)?;
    let file = read.file.clone();
    let gear = read.cylindrical()?;
    note_element(&gear, watch);
    note_sound(&gear, "natural modes are", watch);
    let range = range(a, &gear)?;
    let density = gear.material.density_kg_per_m3;
    let density = density.ok_or(ReductionError::NoDensity)?;
    let even_if_short = a.even_if_memory_is_short;
    memory::demand(
        &gear,
        &file,
        (OfflineJob::Modes(range), None),
        even_if_short,
        watch,
    )?;
    let python = watch.python()?;
    let mut shapes = MeshFields::default();
    let (body, rigid, modes) = watch.offline(&gear.name, |told| {
        let body = GearBody::new(&gear, &python, told)?;
        let rigid = body.rigid_mass(density).map_err(ReductionError::from)?;
        let modes = body.natural_modes(&rigid, range, told, |mode, figures, field| {
            if a.shapes.is_some() {
                shapes.point.insert(field_name(mode, figures), shape(field));
            }
        })?;
        Ok::<_, ReductionError>((body, rigid, modes))
    })?;
    if let Some(path) = &a.shapes {
        export_mesh(&gear, &body.mesh, shapes, (path, LengthUnit::M), watch)?;
    }
    Ok(FoundModes {
        held: held_words(&gear),
        gear: gear.name,
        dofs: body.dofs.free_count(),
        modes,
        rigid: rigid.body,
    })
}

/// What is asked for, or else the gear file says.
fn range(a: &ModesRequest, gear: &GearDefinition) -> Result<ModeRange> {
    match (a.count, a.up_to_Hz) {
        (Some(0), _) => Err(Failure::input("--count: found 0, allowed is 1 or more")),
        (Some(count), _) => Ok(ModeRange::Count(count)),
        (None, Some(hz)) if hz > 0.0 && hz.is_finite() => Ok(ModeRange::UpToHz(hz)),
        (None, Some(hz)) => Err(Failure::input(format!(
            "--up-to-Hz: found {hz}, allowed is more than 0"
        ))),
        (None, None) => gear.modes.ok_or_else(|| {
            Failure::input("say which modes: --count, --up-to-Hz, or [modes] in the gear file")
        }),
    }
}

/// Numbered so that an alphabetical list is in the order of frequency.
fn field_name(mode: usize, figures: &GearMode) -> String {
    format!(
        "mode_{:03}_{:.1}_Hz_nodal_diameters_{}",
        mode + 1,
        figures.frequency_hz(),
        figures.nodal_diameters
    )
}

/// Displacement scaled to a largest one of 1: what a picture needs.
fn shape(field: &[f64]) -> Field {
    let length = |u: &[f64]| u.iter().map(|v| v * v).sum::<f64>().sqrt();
    let largest = field.chunks_exact(3).map(length).fold(0.0, f64::max);
    Field {
        components: 3,
        values: field.iter().map(|v| v / largest).collect(),
        unit: "1".into(),
    }
}

/// Where the gear is held: the bore, or of a gear cut into its shaft the ends of the stubs that are meshed with it.
fn held_words(gear: &GearDefinition) -> String {
    let Some(shaft) = gear.blank.cut_into_shaft() else {
        return "bore held".to_owned();
    };
    let [back, front] = shaft.stub_lengths_m().map(|length_m| 1e3 * length_m);
    let ends = match (back > 0.0, front > 0.0) {
        (true, true) => format!(
            "both ends of the shaft held, {back:.3} mm behind the back face and {front:.3} mm before the front face"
        ),
        (true, false) => format!(
            "the shaft's end at the back held, {back:.3} mm behind the face; the front face is free"
        ),
        (false, _) => format!(
            "the shaft's end at the front held, {front:.3} mm before the face; the back face is free"
        ),
    };
    format!(
        "{ends} (a reduced gear's modes for scenes are those with the faces held, without the stubs' mass)"
    )
}

/// Share of the body's mass or inertia that a mode carries along under each rigid motion.
#[must_use]
pub fn effective_shares(mode: &GearMode, rigid: &RigidBody) -> [f64; 6] {
    let mass = rigid.mass_matrix();
    std::array::from_fn(|q| mode.coupling[q].powi(2) / mass[q][q])
}

impl FoundModes {
    /// The shares of all modes together.
    #[must_use]
    pub fn share_sums(&self) -> [f64; 6] {
        let mut sums = [0.0; 6];
        for mode in &self.modes.modes {
            let shares = effective_shares(mode, &self.rigid);
            sums.iter_mut().zip(shares).for_each(|(s, v)| *s += v);
        }
        sums
    }

    /// For other programs.
    #[must_use]
    pub fn figures(&self) -> Value {
        let list = self.modes.modes.iter().map(|m| {
            json!({
                "frequency_Hz": m.frequency_hz(),
                "nodal_diameters": m.nodal_diameters,
                "nodal_share": m.nodal_share,
                "radial_share": m.direction_shares[0],
                "circumferential_share": m.direction_shares[1],
                "axial_share": m.direction_shares[2],
                "effective_mass_shares": effective_shares(m, &self.rigid),
                "relative_residual": m.relative_residual,
            })
        });
        json!({
            "gear": self.gear,
            "held": self.held,
            "mass_kg": self.rigid.mass_kg,
            "centre_m": self.rigid.centre_m,
            "inertia_kg_m2": self.rigid.inertia_kg_m2,
            "complete_to_Hz": self.modes.complete_to_hz,
            "solves": self.modes.solves,
            "effective_mass_sums": self.share_sums(),
            "modes": list.collect::<Vec<_>>(),
        })
    }
}
