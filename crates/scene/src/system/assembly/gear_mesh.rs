//! `[[gear_mesh]]` to gear meshes: which gears, whether they fit, where they sit; `mesh_model.rs` makes their teeth.

use std::path::Path;
use std::sync::Arc;

use gearmesh_contact::CondensedFlanks;
use gearmesh_drivetrain::{GearMesh, MeshElement, ModalPart, Pose, ToothPairs, kinematic_mesh};
use gearmesh_dynamics::{Marker, MarkerPair};
use gearmesh_geometry::given;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_geometry::{BaseCircles, Flank, GearPair, InputError, Misalignment};
use gearmesh_model::ReducedGear;
use gearmesh_specification::gear_tables::MM;
use gearmesh_specification::gear_tables::flank_errors::FlankErrorTable;
use gearmesh_specification::system::gear_mesh::{GearMeshTable, TeethTable};
use gearmesh_specification::system::mesh_model::{MeshKind, MeshModel};

use super::bevel_hybrid::BevelModels;
use super::bodies::Bodies;
use super::connections::Connections;
use super::coupled::MeshOfGroup;
use super::gears::Gear;
use super::mesh_model::Involutes;
use super::parts::Parts;
use super::scene_mesh::SceneMesh;
use crate::system::built::{BuiltGauge, BuiltMesh};

/// A mesh of two bodies, ready but for its place in the system.
pub(super) struct PreparedMesh {
    pub key: String,
    /// What plans and results tell, without speeds.
    pub built: BuiltMesh,
    pub model: MeshKind,
    /// Numbers of the bodies of gear 1 and gear 2.
    pub bodies: [usize; 2],
    /// Places of the gears on their bodies, the bodies left open.
    pub seats: [Marker; 2],
    /// None for `kinematic`.
    pub mesh: Option<GearMesh>,
    /// The sides that can touch.
    pub sides: Vec<Flank>,
    /// The side that the scene wants to touch at the start.
    pub touching_at_start: Option<Flank>,
    /// Width of a slice \[m\]; zero for `kinematic`.
    pub slice_width_m: f64,
    /// Reduced bevel gears, which the mesh names itself.
    pub models: Option<BevelModels>,
    /// How pairs of teeth have columns, where they do.
    pub tooth_pairs: Option<ToothPairs>,
}

impl PreparedMesh {
    /// Checks a table and makes its models.
    pub(super) fn new<'a>(
        table: &GearMeshTable,
        (document, folder): (&InputDocument, &Path),
        key: String,
        (bodies, condensed): (&'a Bodies, &CondensedFlanks<'a>),
        parts: &mut Parts,
    ) -> Result<Self, InputError> {
        let keys = TableKeys::new(document, key.clone());
        let teeth = teeth(table, &keys)?;
        let numbers = [
            bodies.find_body(&keys, "gear_1", &table.gear_1)?,
            bodies.find_body(&keys, "gear_2", &table.gear_2)?,
        ];
        if numbers[0] == numbers[1] {
            let name = &table.gear_2;
            let problem = format!("found `{name}`, the same as gear_1; a mesh needs two bodies");
            return Err(keys.error("gear_2", problem));
        }
        let scene = SceneMesh {
            table,
            teeth,
            keys,
            model_keys: TableKeys::new(document, format!("{key}.model")),
            teeth_keys: TableKeys::new(document, format!("{key}.teeth")),
            folder,
            flanks: (),
        };
        let prepared = scene.prepared(key, numbers)?;
        match &table.bevel_pair {
            Some(file) => scene
                .with(&*folder.join(file))
                .prepare(prepared, bodies, parts),
            None => of_involutes(scene, prepared, (bodies, condensed), parts),
        }
    }

    /// The reduced bevel gear of a body, where this mesh names one.
    pub(super) fn bevel_model(&self, body: usize) -> Option<&Arc<ReducedGear>> {
        let gear = self.bodies.iter().position(|own| *own == body)?;
        self.models.as_ref().map(|models| &models[gear])
    }

    /// Gear 2 as seen in gear 1 at the start.
    pub(super) fn pose(&self, bodies: &Bodies) -> Pose {
        let [a, b] = self.bodies.map(|number| bodies.list[number].motion());
        let [seat_a, seat_b] = self.seats;
        let pair = MarkerPair {
            a: seat_a,
            b: seat_b,
        };
        Pose::from(&pair.motion(&a, &b))
    }

    /// Adds the mesh to the system, or to the group that it is solved with, and the gauges that read its slice forces.
    pub(super) fn add(
        self,
        gauges: &[BuiltGauge],
        group: Option<&mut Vec<MeshOfGroup>>,
        connections: &mut Connections<'_>,
    ) -> Result<(), InputError> {
        let (bodies, ends) = (connections.bodies, self.bodies.map(Some));
        let name = self.built.name;
        let markers = [0, 1].map(|i| self.seats[i].on(bodies.id(ends[i])));
        let part = bodies.part(&name, self.model.of_parts(), &ends);
        let Some(mesh) = self.mesh else {
            let (teeth, radii_m) = (self.built.teeth, self.built.base_radii_m);
            let teeth = [0, 1].map(|i: usize| (teeth[i] as i64) * radii_m[i].signum() as i64);
            let joint = kinematic_mesh(&name, markers, teeth);
            connections.builder.joint(joint);
            connections.parts.joints.push(part);
            return Ok(());
        };
        let mut element =
            MeshElement::new(&name, markers, mesh).with_line_loads(self.slice_width_m);
        let axes = ends.map(|end| Marker::at(bodies.id(end), [0.0; 3]));
        if markers != axes {
            element = element.with_axes(axes);
        }
        if let Some(pairs) = self.tooth_pairs {
            element = element.with_tooth_pairs(pairs);
        }
        for gear in [1, 2] {
            let is_read = |(mesh, number): &(String, usize)| *mesh == name && *number == gear;
            let on_gear = |gauge: &&BuiltGauge| gauge.meshes.iter().any(is_read);
            let own: Vec<&BuiltGauge> = gauges.iter().filter(on_gear).collect();
            let Some(first) = own.first() else {
                continue;
            };
            // Strain by the modes is counted once, with the gear's first mesh.
            let modal = if first.meshes[0].0 == name {
                ModalPart::Included
            } else {
                ModalPart::ElsewhereIncluded
            };
            let names: Vec<&str> = own.iter().map(|gauge| gauge.name.as_str()).collect();
            element = element
                .with_gauges(gear, &first.model, &names, modal)
                .map_err(|e| connections.scene.document.error(&self.key, e))?;
        }
        match group {
            Some(group) => group.push(MeshOfGroup {
                name,
                element,
                bodies: self.bodies,
                key: self.key,
            }),
            None => {
                connections.builder.element(element);
            }
        }
        connections.parts.elements.push(part);
        Ok(())
    }
}

/// The mesh of two cylindrical gears.
fn of_involutes<'m>(
    scene: SceneMesh<'_, ()>,
    mut prepared: PreparedMesh,
    (bodies, condensed): (&'m Bodies, &CondensedFlanks<'m>),
    parts: &mut Parts,
) -> Result<PreparedMesh, InputError> {
    let table = scene.table;
    scene.keys.refuse(
        &given!(table; bevel_models, bevel_surface),
        "belongs to a `bevel_pair`, which this mesh is not; remove it",
    )?;
    let gear = |i: usize| {
        let placed = &bodies.list[prepared.bodies[i]];
        placed.cylindrical().ok_or_else(|| {
            let name = &placed.body.name;
            let problem = match placed.bevel() {
                Some(_) => format!(
                    "body `{name}` is a bevel gear; name the file of its pair, `bevel_pair = \"...\"`"
                ),
                None => {
                    format!("body `{name}` is no gear; give it `gear = \"...\"` in its [[body]]")
                }
            };
            scene.keys.error(["gear_1", "gear_2"][i], problem)
        })
    };
    let gears = [gear(0)?, gear(1)?];
    let at_start = prepared.pose(bodies);
    let pair = fitting_pair(gears, &at_start, &scene.keys)?;
    prepared.built.teeth = [pair.gear_1.teeth, pair.gear_2.teeth];
    prepared.built.base_radii_m = pair.circles().radii_m;
    let circles = BaseCircles::new(gears.map(|gear| &gear.definition.profile));
    let mut scene = scene.with(Involutes {
        gears,
        pair: &pair,
        condensed,
        displacement_m: at_start.face_displacement_m(circles),
        curve: None,
    });
    scene.flanks.curve = scene.static_curve(prepared.sides[0])?;
    scene.refuse_unfelt_cracks()?;
    let mesh = match &table.model {
        MeshModel::Kinematic {} => {
            scene.microgeometry()?;
            scene.tooth_pairs()?;
            None
        }
        MeshModel::NodeToSurface(model) => {
            let made = scene.node_surfaces(model, &prepared.sides)?;
            prepared.tooth_pairs = made.tooth_pairs;
            Some(made.mesh)
        }
        _ => {
            prepared.tooth_pairs = scene.tooth_pairs()?;
            Some(scene.mesh(&prepared.sides)?)
        }
    };
    if let Some(mesh) = mesh {
        prepared.slice_width_m = mesh.kinematics().layout().width_m();
        let modes = prepared.bodies.map(|number| bodies.list[number].modes);
        prepared.mesh = Some(scene.modal(mesh, modes)?);
    }
    scene.effects(parts);
    prepared.built.stage = Some(scene.stage());
    let jams = pair.radial_room_m().is_some_and(|room_m| room_m < 0.0);
    let assembly = pair.assembly_words().filter(|_| jams);
    (parts.notes).extend(assembly.map(|words| format!("mesh `{}`: {words}", table.name)));
    parts.notes.extend(scene.stiffness_note()?);
    parts.notes.extend(scene.microgeometry_note());
    Ok(prepared)
}

/// What touches and how, as far as the model knows it.
fn teeth(table: &GearMeshTable, keys: &TableKeys<'_>) -> Result<TeethTable, InputError> {
    let (kind, teeth) = (table.model.kind(), table.teeth.clone());
    let states = |list: fn(&TeethTable) -> &Vec<FlankErrorTable>| {
        let list = teeth.as_ref().map(list);
        kind == MeshKind::Iso6336 && list.is_some_and(|list| !list.is_empty())
    };
    let no_flanks = kind == MeshKind::Kinematic && teeth.is_some();
    for (key, is_unused, knows) in [
        ("teeth", no_flanks, "no flanks"),
        ("teeth.errors_1", states(|t| &t.errors_1), "no single teeth"),
        ("teeth.errors_2", states(|t| &t.errors_2), "no single teeth"),
    ] {
        let kind = kind.name();
        let problem = format!("is not used by kind = \"{kind}\", which knows {knows}; remove it");
        keys.refuse(&[(key, is_unused)], problem)?;
    }
    let teeth = teeth.unwrap_or_default();
    if let Some(side) = teeth.touching_at_start
        && !teeth.flanks.flanks().contains(&side)
    {
        let problem = format!(
            "is not used: teeth.flanks leaves the {} flanks out; remove one of the two",
            side.name()
        );
        return Err(keys.error("teeth.touching_at_start", problem));
    }
    Ok(teeth)
}

/// The pair at the centre distance of the start.
pub(super) fn fitting_pair(
    gears: [&Arc<Gear>; 2],
    pose: &Pose,
    keys: &TableKeys<'_>,
) -> Result<GearPair, InputError> {
    let [first, second] = gears.map(|gear| &gear.definition);
    let (one, two) = (&first.tooth, &second.tooth);
    let modules = [one.module_m, two.module_m].map(|m| m / MM);
    let angles = [one.pressure_angle_rad, two.pressure_angle_rad].map(f64::to_degrees);
    for (what, [one, two], unit) in [("module", modules, "mm"), ("pressure angle", angles, "deg")] {
        if (one - two).abs() > 1e-6 * one {
            let problem = format!("the gears do not fit: {what} {one} and {two} {unit}");
            return Err(keys.error("gear_2", problem));
        }
    }
    let tilt = 1e3 * pose.misalignment_rad();
    if tilt.is_nan() || tilt > 10.0 {
        let problem = format!(
            "the gear axes stand {tilt:.2} mrad from parallel; allowed are 10 mrad, both z axes pointing the same way"
        );
        return Err(keys.error("gear_2", problem));
    }
    let widths = 0.5 * (first.tooth.face_width_m + second.tooth.face_width_m);
    let circles = BaseCircles::new([&first.profile, &second.profile]);
    let offset = pose.face_displacement_m(circles).abs();
    if offset >= widths {
        let problem = format!(
            "the gears stand side by side: {:.3} mm apart along the axis, their faces overlap below {:.3} mm",
            offset / MM,
            widths / MM
        );
        return Err(keys.error("gear_2", problem));
    }
    let distance = pose.displacement_m[0].hypot(pose.displacement_m[1]);
    let [one, two] = [first, second].map(|gear| gear.profile.clone());
    GearPair::new(one, two, distance, Misalignment::default()).map_err(|e| {
        let distance = distance / MM;
        let problem = format!("at the centre distance of {distance:.4} mm at the start: {e}");
        keys.error("gear_2", problem)
    })
}
