//! `[[gear_mesh]]` to gear meshes: which gears, whether they fit, where they sit; `mesh_model.rs` makes their teeth.

use gearmesh_geometry::given;
use std::path::Path;
use std::sync::Arc;

use gearmesh_contact::CondensedFlanks;
use gearmesh_drivetrain::errors::eccentricity::Eccentricity;
use gearmesh_drivetrain::{GearMesh, MeshElement, ModalPart, Pose, ToothPairs, kinematic_mesh};
use gearmesh_dynamics::{GROUND, Marker, MarkerPair, SystemBuilder};
use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_geometry::{BaseCircles, Flank, GearPair, InputError, Misalignment};
use gearmesh_model::ReducedGear;

use super::bevel_hybrid::BevelModels;
use super::bevel_mesh::SceneBevel;
use super::bodies::Bodies;
use super::coupled::MeshOfGroup;
use super::gears::Gear;
use super::mesh_model::SceneMesh;
use super::parts::Parts;
use crate::system::built::BuiltGauge;
use crate::system::stage_summary::StageSummary;
use crate::system::tables::gear_mesh::{EccentricityTable, GearMeshTable, TeethTable};
use crate::system::tables::mesh_model::{MeshKind, MeshModel};
use crate::system::tables::{MM, UM};

/// Where a mesh goes.
pub(super) enum MeshPlace<'a> {
    /// Into the system.
    Own(&'a mut SystemBuilder),
    /// To those that it is solved with.
    Group(&'a mut Vec<MeshOfGroup>),
}

/// A mesh of two bodies, ready but for its place in the system.
pub(super) struct PreparedMesh {
    pub name: String,
    pub key: String,
    pub model: MeshKind,
    /// Numbers of the bodies of gear 1 and gear 2.
    pub bodies: [usize; 2],
    pub teeth: [usize; 2],
    pub base_radii_m: [f64; 2],
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
    /// As in [`crate::system::BuiltMesh`].
    pub flank_corners_m: Vec<f64>,
    /// The stage, its speed left open; none of bevel pairs.
    pub stage: Option<StageSummary>,
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
        let keys = TableKeys::new(document, &key);
        let [model_key, teeth_key] = ["model", "teeth"].map(|part| format!("{key}.{part}"));
        let model_keys = TableKeys::new(document, &model_key);
        let teeth_keys = TableKeys::new(document, &teeth_key);
        let kind = table.model.kind();
        let teeth = teeth(table, &keys)?;
        let numbers = [
            bodies.find_body(&keys, "gear_1", &table.gear_1)?,
            bodies.find_body(&keys, "gear_2", &table.gear_2)?,
        ];
        if numbers[0] == numbers[1] {
            return Err(keys.error(
                "gear_2",
                format!(
                    "found `{}`, the same as gear_1; a mesh needs two bodies",
                    table.gear_2
                ),
            ));
        }
        if let Some(file) = &table.bevel_pair {
            let scene = SceneBevel {
                table,
                teeth,
                keys,
                model_keys,
                teeth_keys,
                file: &folder.join(file),
                folder,
            };
            return scene.prepare((&key, numbers), bodies, parts);
        }
        keys.refuse(
            &given!(table; bevel_models, bevel_surface),
            "belongs to a `bevel_pair`, which this mesh is not; remove it",
        )?;
        let gear = |i: usize| {
            let placed = &bodies.list[numbers[i]];
            placed.cylindrical().ok_or_else(|| {
                let key = ["gear_1", "gear_2"][i];
                let name = &placed.body.name;
                let problem = match placed.bevel() {
                    Some(_) => format!(
                        "body `{name}` is a bevel gear; name the file of its pair, `bevel_pair = \"...\"`"
                    ),
                    None => format!(
                        "body `{name}` is no gear; give it `gear = \"...\"` in its [[body]]"
                    ),
                };
                keys.error(key, problem)
            })
        };
        let gears = [gear(0)?, gear(1)?];
        let seats = [
            seat(&teeth.eccentricity_1, &teeth_keys, "eccentricity_1")?,
            seat(&teeth.eccentricity_2, &teeth_keys, "eccentricity_2")?,
        ];
        let at_start = pose(bodies, numbers, &seats);
        let pair = fitting_pair(gears, &at_start, &keys)?;
        let mut prepared = Self {
            name: table.name.clone(),
            model: kind,
            bodies: numbers,
            teeth: [pair.gear_1.teeth, pair.gear_2.teeth],
            base_radii_m: pair.circles().radii_m,
            seats,
            mesh: None,
            sides: teeth.flanks.flanks().to_vec(),
            touching_at_start: teeth.touching_at_start,
            slice_width_m: 0.0,
            models: None,
            tooth_pairs: None,
            flank_corners_m: Vec::new(),
            stage: None,
            key: key.clone(),
        };
        let mut scene = SceneMesh {
            table,
            teeth,
            keys,
            model_keys,
            teeth_keys,
            folder,
            gears,
            pair: &pair,
            condensed,
            displacement_m: at_start
                .face_displacement_m(BaseCircles::new(gears.map(|gear| &gear.definition.profile))),
            curve: None,
        };
        scene.curve = scene.static_curve(prepared.sides[0])?;
        scene.refuse_unfelt_cracks()?;
        if kind == MeshKind::Kinematic {
            scene.microgeometry()?;
            scene.tooth_pairs()?;
        } else {
            let mesh = match &table.model {
                MeshModel::NodeToSurface(model) => {
                    let made = scene.node_surfaces(model, &prepared.sides)?;
                    prepared.tooth_pairs = made.tooth_pairs;
                    made.mesh
                }
                _ => {
                    prepared.tooth_pairs = scene.tooth_pairs()?;
                    scene.mesh(&prepared.sides)?
                }
            };
            prepared.slice_width_m = mesh.kinematics().layout().width_m();
            let modes = numbers.map(|number| bodies.list[number].modes);
            prepared.mesh = Some(scene.modal(mesh, modes)?);
        }
        scene.effects(parts);
        prepared.stage = Some(scene.stage());
        let jams = pair.radial_room_m().is_some_and(|room_m| room_m < 0.0);
        let assembly = pair.assembly_words().filter(|_| jams);
        (parts.notes).extend(assembly.map(|words| format!("mesh `{}`: {words}", table.name)));
        parts.notes.extend(scene.stiffness_note()?);
        parts.notes.extend(scene.microgeometry_note());
        Ok(prepared)
    }

    /// u: teeth of gear 2 over those of gear 1, negative with a ring.
    pub(super) fn ratio(&self) -> f64 {
        let [z1, z2] = self.teeth.map(|teeth| teeth as f64);
        let [r1, r2] = self.base_radii_m;
        (z2 / z1).copysign(r1 * r2)
    }

    /// The reduced bevel gear of a body, where this mesh names one.
    pub(super) fn bevel_model(&self, body: usize) -> Option<&Arc<ReducedGear>> {
        let gear = self.bodies.iter().position(|own| *own == body)?;
        self.models.as_ref().map(|models| &models[gear])
    }

    /// Gear 2 as seen in gear 1 at the start.
    pub(super) fn pose(&self, bodies: &Bodies) -> Pose {
        pose(bodies, self.bodies, &self.seats)
    }

    /// Adds the mesh to the system or to its group, with the gauges that read its slice forces.
    pub(super) fn add(
        self,
        bodies: &Bodies,
        (gauges, keys): (&[BuiltGauge], &TableKeys<'_>),
        place: MeshPlace<'_>,
        parts: &mut Parts,
    ) -> Result<(), InputError> {
        let ends = self.bodies.map(Some);
        match self.mesh {
            Some(mesh) => {
                let markers = [0, 1].map(|i| self.seats[i].on(bodies.id(ends[i])));
                let mut element =
                    MeshElement::new(&self.name, markers, mesh).with_line_loads(self.slice_width_m);
                let axes = [0, 1].map(|i| Marker::at(bodies.id(ends[i]), [0.0; 3]));
                if markers != axes {
                    element = element.with_axes(axes);
                }
                if let Some(pairs) = self.tooth_pairs {
                    element = element.with_tooth_pairs(pairs);
                }
                for gear in [1, 2] {
                    let on_gear = |gauge: &&BuiltGauge| {
                        gauge
                            .meshes
                            .iter()
                            .any(|(mesh, number)| *mesh == self.name && *number == gear)
                    };
                    let own: Vec<&BuiltGauge> = gauges.iter().filter(on_gear).collect();
                    let Some(first) = own.first() else {
                        continue;
                    };
                    // Strain by the modes is counted once, with the gear's first mesh.
                    let modal = if first.meshes[0].0 == self.name {
                        ModalPart::Included
                    } else {
                        ModalPart::ElsewhereIncluded
                    };
                    let names: Vec<&str> = own.iter().map(|gauge| gauge.name.as_str()).collect();
                    element = element
                        .with_gauges(gear, &first.model, &names, modal)
                        .map_err(|e| keys.error("", e))?;
                }
                match place {
                    MeshPlace::Own(builder) => {
                        builder.element(element);
                    }
                    MeshPlace::Group(group) => group.push(MeshOfGroup {
                        name: self.name.clone(),
                        element,
                        bodies: self.bodies,
                        key: self.key,
                    }),
                }
                let kind = match self.model {
                    MeshKind::Kinematic => "kinematic mesh",
                    MeshKind::Impact => "impact mesh",
                    MeshKind::Iso6336 => "iso6336 mesh",
                    MeshKind::Analytic => "analytic mesh",
                    MeshKind::NodeToSurface => "node-to-surface mesh",
                    MeshKind::Hybrid => "hybrid mesh",
                };
                parts.element(&self.name, kind, bodies, ends);
            }
            None => {
                let markers = [0, 1].map(|i| self.seats[i].on(bodies.id(ends[i])));
                let teeth = [0, 1]
                    .map(|i: usize| (self.teeth[i] as i64) * self.base_radii_m[i].signum() as i64);
                if let MeshPlace::Own(builder) = place {
                    builder.joint(kinematic_mesh(&self.name, markers, teeth));
                }
                parts.joint(&self.name, "kinematic mesh", bodies, ends);
            }
        }
        Ok(())
    }
}

pub(super) fn pose(bodies: &Bodies, numbers: [usize; 2], seats: &[Marker; 2]) -> Pose {
    let [a, b] = numbers.map(|number| bodies.list[number].motion());
    let pair = MarkerPair {
        a: seats[0],
        b: seats[1],
    };
    Pose::from(&pair.motion(&a, &b))
}

/// What touches and how, as far as the model knows it.
fn teeth(table: &GearMeshTable, keys: &TableKeys<'_>) -> Result<TeethTable, InputError> {
    let (kind, teeth) = (table.model.kind(), table.teeth.clone());
    let knows = match kind {
        MeshKind::Kinematic if teeth.is_some() => ("teeth", "no flanks"),
        MeshKind::Iso6336 if teeth.as_ref().is_some_and(|t| !t.errors_1.is_empty()) => {
            ("teeth.errors_1", "no single teeth")
        }
        MeshKind::Iso6336 if teeth.as_ref().is_some_and(|t| !t.errors_2.is_empty()) => {
            ("teeth.errors_2", "no single teeth")
        }
        _ => {
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
            return Ok(teeth);
        }
    };
    let problem = format!(
        "is not used by kind = \"{}\", which knows {}; remove it",
        kind.name(),
        knows.1
    );
    Err(keys.error(knows.0, problem))
}

/// Place of a gear on its body.
pub(super) fn seat(
    table: &Option<EccentricityTable>,
    keys: &TableKeys<'_>,
    key: &str,
) -> Result<Marker, InputError> {
    let table = table.unwrap_or_default();
    let eccentricity = Eccentricity {
        offset_m: UM * table.offset_um,
        direction_rad: table.direction_deg.to_radians(),
        tilt_rad: 1e-3 * table.tilt_mrad,
        tilt_direction_rad: table.tilt_direction_deg.to_radians(),
    };
    eccentricity
        .marker(GROUND, 0.0, 0.0)
        .map_err(|e| keys.error(key, e))
}

/// The pair at the centre distance of the start.
pub(super) fn fitting_pair(
    gears: [&Arc<Gear>; 2],
    pose: &Pose,
    keys: &TableKeys<'_>,
) -> Result<GearPair, InputError> {
    let [first, second] = gears.map(|gear| &gear.definition);
    for (what, values) in [
        (
            "module",
            [first.tooth.module_m, second.tooth.module_m].map(|m| m / MM),
        ),
        (
            "pressure angle",
            [
                first.tooth.pressure_angle_rad,
                second.tooth.pressure_angle_rad,
            ]
            .map(f64::to_degrees),
        ),
    ] {
        if (values[0] - values[1]).abs() > 1e-6 * values[0] {
            let unit = if what == "module" { "mm" } else { "deg" };
            return Err(keys.error(
                "gear_2",
                format!(
                    "the gears do not fit: {what} {} and {} {unit}",
                    values[0], values[1]
                ),
            ));
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
    GearPair::new(
        first.profile.clone(),
        second.profile.clone(),
        distance,
        Misalignment::default(),
    )
    .map_err(|e| {
        keys.error(
            "gear_2",
            format!(
                "at the centre distance of {:.4} mm at the start: {e}",
                distance / MM
            ),
        )
    })
}
