//! The knob of the gears' meshes: element and element lengths. Each rung reduces every gear once, kept by digest.

use std::path::Path;

use gearmesh_geometry::{Element, GearDefinition};
use toml::Value;

use super::knobs::{Knob, Rung, rounded};
use crate::model_shelf::ModelShelf;
use crate::study::BaseScene;

/// Element and factor on the element lengths, cheapest first; the middle one is the gear file's own.
const RUNGS: [(Choice, f64); 5] = [
    (Choice::Linear, 1.0),
    (Choice::Own, 1.8),
    (Choice::Own, 1.3),
    (Choice::Own, 1.0),
    (Choice::Quadratic, 1.3),
];

/// Of cross-sections in plane strain, which have one element and no length along the tooth.
const PLANE_RUNGS: [(Choice, f64); 4] = [
    (Choice::Own, 1.8),
    (Choice::Own, 1.3),
    (Choice::Own, 1.0),
    (Choice::Own, 0.7),
];

#[derive(Clone, Copy, PartialEq)]
enum Choice {
    Linear,
    Own,
    Quadratic,
}

/// The knob of all reduced gears of a scene together; none without reduced gears, or where one of them has a mesh that
/// is not made of hexahedra by this program.
pub(super) fn of_gears(base: &BaseScene, folder: &Path, shelf: &ModelShelf) -> Option<Knob> {
    let mut gears: Vec<(String, GearDefinition)> = Vec::new();
    let in_pair = (1..=2).map(|gear| format!("pair.gear_{gear}"));
    let of_bodies = (0..)
        .take_while(|body| base.value(&format!("body.{body}.name")).is_some())
        .map(|body| format!("body.{body}.gear"));
    for key in in_pair.chain(of_bodies) {
        let Some(Value::String(name)) = base.value(&key) else {
            continue;
        };
        let path = folder.join(name);
        if path.extension().is_none_or(|end| end != "h5") {
            continue;
        }
        let model = shelf.model(&path).ok()?.model;
        gears.push((key, model.input.definition_in(path.display()).ok()?.clone()));
    }
    let hexahedra = |gear: &GearDefinition| {
        gear.blank.meshed().is_none() && !matches!(gear.mesh.element, Element::Tet10)
    };
    if gears.is_empty() || !gears.iter().all(|(_, gear)| hexahedra(gear)) {
        return None;
    }
    let rung = |(choice, factor): &(Choice, f64)| {
        let settings = gears.iter().flat_map(|(key, gear)| {
            let mesh = &gear.mesh;
            let element = match choice {
                Choice::Linear => "hex8",
                Choice::Own => mesh.element.name(),
                Choice::Quadratic => "hex20",
            };
            let lengths = [
                ("flank_mm", mesh.flank_m),
                ("fillet_mm", mesh.fillet_m),
                ("body_mm", mesh.body_m),
            ];
            let solid = (!mesh.plane_strain).then_some(("axial_mm", mesh.axial_m));
            let lengths = lengths.into_iter().chain(solid);
            let lengths =
                lengths.map(|(key, own)| (key, Value::Float(rounded(1e3 * own * factor))));
            let element =
                (!mesh.plane_strain).then_some(("element", Value::String(element.to_owned())));
            element
                .into_iter()
                .chain(lengths)
                .map(move |(inner, value)| (format!("{key}:mesh.{inner}"), value))
                .collect::<Vec<_>>()
        });
        let word = match choice {
            Choice::Linear => "hex8",
            Choice::Own => "own element",
            Choice::Quadratic => "hex20",
        };
        let label = match (choice, *factor) {
            (Choice::Own, 1.0) => "as it is".to_owned(),
            _ => format!("{word}, lengths × {factor}"),
        };
        let as_it_is = label == "as it is";
        Rung {
            label,
            // The models that are there serve.
            settings: if as_it_is {
                Vec::new()
            } else {
                settings.collect()
            },
        }
    };
    let rungs = match gears.iter().any(|(_, gear)| gear.mesh.plane_strain) {
        true => &PLANE_RUNGS[..],
        false => &RUNGS[..],
    };
    Some(Knob {
        name: "gears' meshes".to_owned(),
        rungs: rungs.iter().map(rung).collect(),
        further: Vec::new(),
    })
}
