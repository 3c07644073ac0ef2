//! Gears that are cut into their shafts: which faces the shaft's beams join.
//!
//! A gear whose shaft goes on at both faces and which sits on a beam shaft has its frame on its back face, and the
//! front face moves against it by modes of the gear's body ([`GearOnFaces`]). On a rigid shaft, or on none, both faces
//! move as one body.

use gearmesh_drivetrain::GearOnFaces;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;
use gearmesh_specification::system::body::Flexibility;
use gearmesh_specification::system::mesh_model::MeshKind;
use gearmesh_specification::system::shaft::ShaftModel;
use nalgebra::DMatrix;
use std::sync::Arc;

use super::bodies::{PlacedBody, mode_count};
use super::gears::{BodyGear, Gear};
use crate::system::scene::SystemScene;

/// A gear whose faces are joined one by one.
#[derive(Debug)]
pub(super) struct OnFaces {
    pub gear: GearOnFaces,
    /// Damping over stiffness of the shaft \[s\], which is that of the core.
    pub damping_s: f64,
}

/// The gear of a body with its faces apart, where it is cut into a beam shaft and a hybrid mesh feels them.
///
/// # Errors
/// [`InputError`] at the body, where the model does not know its faces, and where another mesh would not feel them.
pub(super) fn on_its_shaft(
    gear: Option<BodyGear>,
    scene: &SystemScene,
    body: usize,
) -> Result<Option<BodyGear>, InputError> {
    let table = &scene.tables.body[body];
    let own = gear.as_ref().and_then(BodyGear::cylindrical);
    let Some((own, model)) = own.and_then(|gear| Some((gear, gear.model.as_ref()?))) else {
        return Ok(gear);
    };
    let damping_of = |model: &ShaftModel| match model {
        ShaftModel::Rigid {} => None,
        ShaftModel::Beam { damping_s, .. } => Some(*damping_s),
    };
    let mut seats = scene.tables.shaft.iter().filter(|shaft| {
        let mut seats = shaft.seat.iter();
        seats.any(|seat| seat.body == table.name)
    });
    let damping_s = seats.find_map(|shaft| damping_of(&shaft.model));
    let meshes = || {
        let all = scene.tables.gear_mesh.iter();
        all.filter(|mesh| [&mesh.gear_1, &mesh.gear_2].contains(&&table.name))
    };
    let hybrid = meshes().find(|mesh| mesh.model.kind() == MeshKind::Hybrid);
    let (Some(damping_s), Some(hybrid), Some(_)) =
        (damping_s, hybrid, own.definition.blank.two_faced_shaft())
    else {
        return Ok(gear);
    };
    let keys = TableKeys::new(&scene.document, format!("body.{body}"));
    if let Some(other) = meshes().find(|mesh| mesh.model.kind() != MeshKind::Hybrid) {
        let problem = format!(
            "is cut into its shaft, whose faces move against each other: that is felt by kind = \"hybrid\" alone, which `{}` has and `{}` has not; give both \
             meshes kind = \"hybrid\"",
            hybrid.name, other.name
        );
        return Err(keys.error("gear", problem));
    }
    let natural = match table.flexibility {
        Some(Flexibility::Modal) => mode_count(table, model, &keys)?,
        _ => 0,
    };
    let gear = GearOnFaces::new(model, natural).map_err(|error| keys.error("gear", error))?;
    let model = Arc::clone(&gear.model);
    Ok(Some(BodyGear::Cylindrical(Arc::new(Gear {
        on_faces: Some(OnFaces {
            damping_s: damping_s.map_or(0.0, f64::from),
            gear,
        }),
        ..own.with_model(model)
    }))))
}

/// How an end of a beam moves with the modes of a body: that on the front face of a gear cut into its shaft does.
/// `towards`: along the body's axis, where the beam goes on.
///
/// # Errors
/// What is wrong where the gear's file lets its shaft end at that face.
pub(super) fn moving_end(
    placed: &PlacedBody,
    towards: f64,
) -> Result<Option<DMatrix<f64>>, String> {
    let Some(gear) = placed.cylindrical() else {
        return Ok(None);
    };
    let Some(shaft) = gear.definition.blank.cut_into_shaft() else {
        return Ok(None);
    };
    let (face, name) = match towards > 0.0 {
        true => (1, "front"),
        false => (0, "back"),
    };
    if shaft.end_radii_m[face] == 0.0 {
        return Err(format!(
            "the shaft goes on at the {name} face of `{}`, where {} says that it ends (shaft_diameter_mm.{face} = 0): state its diameter there and reduce the gear \
             again",
            placed.body.name,
            gear.file.display()
        ));
    }
    let faces = gear.on_faces.as_ref().filter(|_| face == 1);
    Ok(faces.map(|faces| faces.gear.front.clone()))
}
