//! `gearmesh modes`: natural frequencies and shapes with the bore held, or the ends of the shaft's stubs.

use crate::arguments::ModesArguments;
use crate::console::StageBar;
use crate::failure::Failure;
use crate::length_unit::LengthUnit;
use crate::offline::MeshFields;
use crate::{console, memory, offline, output_name};
use gearmesh_geometry::{GearDefinition, ModeRange};
use gearmesh_model::{Field, RigidBody};
use gearmesh_reduction::{GearBody, GearMode, GearModes, OfflineJob, ReductionError};
use serde_json::json;

/// Runs the command.
pub fn run(a: &ModesArguments) -> Result<(), Failure> {
    if let Some(path) = &a.shapes {
        output_name::demand_mesh(path)?;
    }
    let gear = offline::gear(&a.gear)?;
    offline::note_element(&gear);
    offline::note_sound(&gear, "natural modes are");
    let range = range(a, &gear)?;
    let density = gear.material.density_kg_per_m3;
    let density = density.ok_or(ReductionError::NoDensity)?;
    memory::demand(
        &gear,
        &a.gear,
        OfflineJob::Modes(range),
        a.even_if_memory_is_short,
    )?;
    let bar = StageBar::new(&gear.name);
    let body = GearBody::new(&gear, &offline::python()?, &bar)?;
    let rigid = body.rigid_mass(density).map_err(ReductionError::from)?;
    let mut shapes = MeshFields::default();
    let modes = body.natural_modes(&rigid, range, &bar, |mode, figures, field| {
        if a.shapes.is_some() {
            shapes.point.insert(field_name(mode, figures), shape(field));
        }
    });
    bar.finish();
    let modes = modes?;
    if let Some(path) = &a.shapes {
        offline::export_mesh(&gear, &body.mesh, shapes, LengthUnit::M, path)?;
    }
    if a.json {
        console::json(&figures(&gear, &modes, &rigid.body));
    } else {
        table(&gear, &body, &modes, &rigid.body);
    }
    Ok(())
}

/// What the command line asks for, or else the gear file.
fn range(a: &ModesArguments, gear: &GearDefinition) -> Result<ModeRange, Failure> {
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
fn effective_shares(mode: &GearMode, rigid: &RigidBody) -> [f64; 6] {
    let mass = rigid.mass_matrix();
    std::array::from_fn(|q| mode.coupling[q].powi(2) / mass[q][q])
}

fn sums(modes: &GearModes, rigid: &RigidBody) -> [f64; 6] {
    let mut sums = [0.0; 6];
    for mode in &modes.modes {
        let shares = effective_shares(mode, rigid);
        sums.iter_mut().zip(shares).for_each(|(s, v)| *s += v);
    }
    sums
}

fn figures(gear: &GearDefinition, modes: &GearModes, rigid: &RigidBody) -> serde_json::Value {
    let list: Vec<_> = modes
        .modes
        .iter()
        .map(|m| {
            json!({
                "frequency_Hz": m.frequency_hz(),
                "nodal_diameters": m.nodal_diameters,
                "nodal_share": m.nodal_share,
                "radial_share": m.direction_shares[0],
                "circumferential_share": m.direction_shares[1],
                "axial_share": m.direction_shares[2],
                "effective_mass_shares": effective_shares(m, rigid),
                "relative_residual": m.relative_residual,
            })
        })
        .collect();
    json!({
        "gear": gear.name,
        "held": held_words(gear),
        "mass_kg": rigid.mass_kg,
        "centre_m": rigid.centre_m,
        "inertia_kg_m2": rigid.inertia_kg_m2,
        "complete_to_Hz": modes.complete_to_hz,
        "solves": modes.solves,
        "effective_mass_sums": sums(modes, rigid),
        "modes": list,
    })
}

fn table(gear: &GearDefinition, body: &GearBody, modes: &GearModes, rigid: &RigidBody) {
    console::data(format!(
        "{}: {} modes up to {:.1} Hz, {}, {} degrees of freedom; mass {:.4} kg, inertia about the axis {:.4e} kg m2",
        gear.name,
        modes.modes.len(),
        modes.complete_to_hz,
        held_words(gear),
        body.dofs.free_count(),
        rigid.mass_kg,
        rigid.inertia_kg_m2[2][2]
    ));
    console::data("                 nodal   kinetic energy %        effective mass or inertia %");
    console::data(
        "mode        Hz   diam.  radial circ. axial      x     y     z  about x     y     z",
    );
    let shares = |s: [f64; 6]| {
        let s = s.map(|v| 100.0 * v);
        format!(
            "{:6.1} {:5.1} {:5.1}  {:7.1} {:5.1} {:5.1}",
            s[0], s[1], s[2], s[3], s[4], s[5]
        )
    };
    for (k, m) in modes.modes.iter().enumerate() {
        let [r, t, z] = m.direction_shares.map(|v| 100.0 * v);
        console::data(format!(
            "{:>4} {:>9.2} {:>7}  {r:>6.1} {t:>5.1} {z:>5.1} {}",
            k + 1,
            m.frequency_hz(),
            m.nodal_diameters,
            shares(effective_shares(m, rigid))
        ));
    }
    console::data(format!("sum {:>39}", shares(sums(modes, rigid))));
}
