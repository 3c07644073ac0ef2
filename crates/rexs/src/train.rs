//! The gearbox of a model: shafts with what stands on them, stages, and how the power flows.

use crate::bearing::Bearing;
use crate::bearings_and_couplings::bearings_and_couplings;
use crate::bevel::{self, BevelStage};
use crate::by_number::{ByNumber, Numbered, grouped};
use crate::coupling::{self, Coupling};
use crate::error::RexsError;
use crate::gear::{self, Gear};
use crate::ledger::About;
use crate::loads::{self, AddedMass, Load};
use crate::loose_gears::{self, Seat};
use crate::microgeometry;
use crate::model::Component;
use crate::placement::frame;
use crate::planetary;
use crate::planetary_set::{self, PlanetarySet};
use crate::power_flow::{Flow, Link};
use crate::shaft::Shaft;
use crate::shaft_sections;
use crate::source::Source;
use crate::structure::{Stage, Structure};
use crate::supports::{hold, leave_out_bare};
use crate::text::{Names, file_stem};
use crate::train_finish::{finish_gears, finish_shafts, point_shafts_one_way};
use crate::train_places::{place_shafts, settle_middles};
use crate::train_power::power;
use crate::units::MM;
use std::collections::{BTreeMap, HashMap};

/// A gear on its shaft.
#[derive(Debug, Clone)]
pub struct SeatedGear {
    /// The gear.
    pub gear: Gear,
    /// Shaft: component.
    pub shaft: i64,
    /// Middle of the face along u \[mm\].
    pub mid_mm: f64,
}

impl Numbered for SeatedGear {
    fn id(&self) -> i64 {
        self.gear.id
    }
}

impl Numbered for Shaft {
    fn id(&self) -> i64 {
        self.id
    }
}

/// A cylindrical stage.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// The stage: component.
    pub stage: i64,
    /// Name in the scene.
    pub name: String,
    /// Places of the two gears in [`Train::gears`].
    pub gears: [usize; 2],
    /// Its link in the flow of power.
    pub link: usize,
}

/// A bevel gear, which passes its torque on.
#[derive(Debug, Clone)]
pub struct BevelSeat {
    /// The gear: component.
    pub gear: i64,
    /// Shaft: component.
    pub shaft: i64,
    /// Place along u \[mm\].
    pub u_mm: f64,
    /// Its link, and which side of it.
    pub link: (usize, usize),
    /// Name.
    pub name: String,
    /// What the stage says; none where it says too little.
    pub stage: Option<BevelStage>,
}

/// Where a torque passes from a shaft to a link that the scene has no mesh of.
#[derive(Debug, Clone)]
pub struct TorqueSeat {
    /// Shaft: component.
    pub shaft: i64,
    /// Place along u \[mm\].
    pub u_mm: f64,
    /// Its link, and which side of it.
    pub link: (usize, usize),
    /// Name.
    pub name: String,
}

/// A gearbox in one load case.
#[derive(Debug, Default)]
pub struct Train {
    /// Shafts.
    pub shafts: ByNumber<Shaft>,
    /// Gears.
    pub gears: ByNumber<SeatedGear>,
    /// Stages.
    pub meshes: Vec<Mesh>,
    /// Bevel gears.
    pub bevels: Vec<BevelSeat>,
    /// Planetary stages of the scene.
    pub sets: Vec<PlanetarySet>,
    /// Members of planetary stages that the scene does not have.
    pub planetary: Vec<TorqueSeat>,
    /// Bearings between shafts of planets and their pins, by either of these.
    pub of_planets: BTreeMap<i64, Vec<Bearing>>,
    /// Bearings.
    pub bearings: Vec<Bearing>,
    /// Couplings.
    pub couplings: Vec<Coupling>,
    /// Loads.
    pub loads: Vec<Load>,
    /// Additional masses.
    pub masses: Vec<AddedMass>,
    /// Links of the flow of power: meshes, couplings, bevel stages.
    pub links: Vec<Link>,
    /// Speeds and torques about z.
    pub flow: Flow,
}

impl Train {
    /// A shaft.
    pub fn shaft(&self, id: i64) -> Option<&Shaft> {
        self.shafts.place(id).map(|place| &self.shafts[place])
    }

    /// A gear.
    pub fn gear(&self, id: i64) -> Option<&SeatedGear> {
        self.gears.place(id).map(|place| &self.gears[place])
    }

    /// Members of bevel and planetary stages, which pass torques on without a mesh of the scene.
    pub fn torque_seats(&self) -> impl Iterator<Item = TorqueSeat> + '_ {
        let bevels = self.bevels.iter().map(|b| TorqueSeat {
            shaft: b.shaft,
            u_mm: b.u_mm,
            link: b.link,
            name: b.name.clone(),
        });
        bevels.chain(self.planetary.iter().cloned())
    }

    /// Places of the gears of each shaft.
    pub fn gears_of(&self) -> HashMap<i64, Vec<usize>> {
        let all = self.gears.iter().enumerate();
        grouped(all.map(|(i, seated)| (seated.shaft, i)))
    }

    /// Places of the bearings at each shaft; once of one with the same shaft on both sides.
    pub fn bearings_of(&self) -> HashMap<i64, Vec<usize>> {
        let all = self.bearings.iter().enumerate();
        grouped(all.flat_map(|(i, bearing)| {
            let [a, b] = bearing.sides;
            let second = (b != a).then_some((b, i));
            [(a, i)].into_iter().chain(second)
        }))
    }

    /// Each gear of each mesh: its place and that of the mesh.
    pub fn meshes_of_gears(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let all = self.meshes.iter().enumerate();
        all.flat_map(|(i, mesh)| mesh.gears.map(|gear| (gear, i)))
    }

    /// A shaft, to be changed.
    pub fn shaft_mut(&mut self, id: i64) -> Option<&mut Shaft> {
        let place = self.shafts.place(id)?;
        self.shafts.get_mut(place)
    }
}

/// Reads the gearbox.
///
/// # Errors
/// Those of [`Source`], and what a gearbox cannot do without.
pub fn read(source: &Source<'_>, structure: &Structure, stem: &str) -> Result<Train, RexsError> {
    let mut names = Names::default();
    let mut files = Names::default();
    let mut train = Train::default();
    for component in source.model.of_kind(&["shaft"]) {
        // Planets of the scene have no shafts.
        let role = structure.planetary_role(component.id);
        if role.is_some_and(|r| r != "planet_carrier_shaft") {
            continue;
        }
        let place = frame(source, component)?;
        let name = names.unique(&component.name, component.id);
        train.shafts.push(shaft_sections::read(
            source, structure, component, name, place,
        )?);
    }
    seat_gears(source, structure, &mut train, &mut names, &mut files, stem)?;
    join_stages(source, structure, &mut train, &mut names)?;
    place_shafts(source, structure, &mut train)?;
    settle_middles(source, &mut train)?;
    bearings_and_couplings(source, structure, &mut train, &mut names, &mut files)?;
    on_shafts(source, structure, &mut train, &mut names)?;
    leave_out_bare(source, &mut train);
    point_shafts_one_way(&mut train);
    planetary::join(source, structure, &mut train);
    hold(source, &mut train);
    finish_shafts(source, &mut train);
    finish_gears(source, &mut train);
    microgeometry::of_train(source, structure, &mut train)?;
    planetary_set::tell_unlike_planets(source, &train);
    train.flow = power(source, &train);
    Ok(train)
}

fn seat_gears(
    source: &Source<'_>,
    structure: &Structure,
    train: &mut Train,
    names: &mut Names,
    files: &mut Names,
    stem: &str,
) -> Result<(), RexsError> {
    for component in source.model.of_kind(&["worm_gear", "worm_wheel"]) {
        source.leave_out(
            component,
            About::Nothing,
            format!("{}s have no model", component.kind.replace('_', " ")),
        );
    }
    let shift_index = coupling::shift_index(source)?;
    for component in source.model.of_kind(&["cylindrical_gear", "ring_gear"]) {
        let name = names.unique(&component.name, component.id);
        let file = files.unique(&format!("{stem}_{}", file_stem(&name)), component.id);
        let file = format!("{}.toml", file_stem(&file));
        let gear = match gear::read(source, structure, component, name, file) {
            // Sets go without planets where files say little of their rings.
            Err(error @ RexsError::Missing { .. }) if component.kind == "ring_gear" => {
                source.leave_out(component, About::Lost, error.to_string());
                continue;
            }
            read => read?,
        };
        // Rings are seated with their planetary stage.
        let seat = (!gear.internal)
            .then(|| loose_gears::seat(source, structure, train, component, shift_index))
            .flatten();
        let start = source.number(component, "u_coordinate_on_shaft", MM)?;
        let shaft = match seat {
            Some(Seat::Fixed(id)) => id,
            Some(Seat::Loose(id)) => {
                let carrier = train.shaft(id);
                let hub = carrier.map(|s| s.hub(component.id, &gear.name));
                hub.into_iter().for_each(|hub| train.shafts.push(hub));
                component.id
            }
            None => -1,
        };
        let mid_mm = start.map_or(f64::NAN, |u| u + 0.5 * gear.face_width_mm);
        // A gear that sits on nothing is a file all the same.
        train.gears.push(SeatedGear {
            gear,
            shaft,
            mid_mm,
        });
    }
    Ok(())
}

fn join_stages(
    source: &Source<'_>,
    structure: &Structure,
    train: &mut Train,
    names: &mut Names,
) -> Result<(), RexsError> {
    let mut pairs: HashMap<[usize; 2], usize> = HashMap::new();
    for &Stage { id, gears } in structure.stages() {
        let (Some(stage), Some(g1), Some(g2)) = (
            source.model.component(id),
            source.model.component(gears[0]),
            source.model.component(gears[1]),
        ) else {
            continue;
        };
        match stage.kind.as_str() {
            "cylindrical_stage" => {
                let mates = (stage, [g1, g2]);
                join_cylindrical(source, structure, (train, &mut pairs), names, mates)?;
            }
            "bevel_stage" => bevel_stage(source, structure, train, stage, [g1, g2])?,
            _ => source.leave_out(
                stage,
                About::Lost,
                format!(
                    "{}s have no model in scenes: speeds and torques do not pass",
                    stage.kind.replace('_', " ")
                ),
            ),
        }
    }
    Ok(())
}

/// Joins two gears of the scene, once.
fn join_cylindrical(
    source: &Source<'_>,
    structure: &Structure,
    (train, pairs): (&mut Train, &mut HashMap<[usize; 2], usize>),
    names: &mut Names,
    (stage, gears): (&Component, [&Component; 2]),
) -> Result<(), RexsError> {
    let place = |gear: &Component| {
        let place = train.gears.place(gear.id);
        place.filter(|&place| train.gears[place].shaft >= 0)
    };
    let [Some(a), Some(b)] = gears.map(place) else {
        // Stages of planets are reported with the planetary stage.
        let planetary = structure.partners(stage.id, &["planetary_stage"]);
        if planetary.is_empty() {
            let [g1, g2] = gears.map(Component::words);
            let what = format!("between {g1} and {g2}, of which the scene does not have both");
            source.leave_out(stage, About::Lost, what);
        }
        return Ok(());
    };
    if let Some(&first) = pairs.get(&[a.min(b), a.max(b)]) {
        let name = &train.meshes[first].name;
        let what = format!("its gears are in mesh already in {name}");
        source.leave_out(stage, About::Nothing, what);
        return Ok(());
    }
    let [first, second] = [&train.gears[a], &train.gears[b]];
    demand_mates(stage, [&first.gear, &second.gear])?;
    train.links.push(Link {
        shafts: [first.shaft, second.shaft],
        ratio: -f64::from(first.gear.teeth) / f64::from(second.gear.teeth),
    });
    let name = match stage.name.is_empty() {
        true => "stage",
        false => &stage.name,
    };
    pairs.insert([a.min(b), a.max(b)], train.meshes.len());
    train.meshes.push(Mesh {
        stage: stage.id,
        name: names.unique(name, stage.id),
        gears: [a, b],
        link: train.links.len() - 1,
    });
    Ok(())
}

fn demand_mates(stage: &Component, [a, b]: [&Gear; 2]) -> Result<(), RexsError> {
    let angles = [a, b].map(|gear| gear.pressure_angle_deg);
    let helices = "helix angles (which must be opposite)";
    for (what, [x, y], off, most) in [
        (
            "modules",
            [a, b].map(|gear| gear.module_mm),
            a.module_mm - b.module_mm,
            a.module_mm,
        ),
        (
            helices,
            [a, b].map(|gear| gear.helix_deg),
            a.helix_deg + b.helix_deg,
            1.0,
        ),
        ("pressure angles", angles, angles[0] - angles[1], 1.0),
    ] {
        if off.abs() > 1e-6 * most {
            let names = format!("{what} of {} and {}", a.name, b.name);
            return Err(stage.lacks(format!("{names} do not go together: {x} and {y}")));
        }
    }
    Ok(())
}

fn bevel_stage(
    source: &Source<'_>,
    structure: &Structure,
    train: &mut Train,
    stage: &Component,
    gears: [&Component; 2],
) -> Result<(), RexsError> {
    let teeth = [
        bevel::teeth(source, gears[0])?,
        bevel::teeth(source, gears[1])?,
    ];
    let mut seats = Vec::new();
    let mut sense = 1.0;
    for gear in gears {
        let shafts = structure.partners(gear.id, &["shaft"]);
        let Some(&shaft) = shafts.iter().find(|&&id| train.shaft(id).is_some()) else {
            continue;
        };
        // The apex at +u turns the cone round.
        // Version 1.0 has a whole number for it.
        let orientation = source.text(gear, "bevel_cone_orientation");
        if matches!(
            orientation.as_deref(),
            Some("positive" | "1" | "+1" | "1.0")
        ) {
            sense = -sense;
        }
        let start = source
            .number(gear, "u_coordinate_on_shaft", MM)?
            .unwrap_or(0.0);
        let width = source.number(gear, "face_width", MM)?.unwrap_or(0.0);
        seats.push((gear.id, shaft, start + 0.5 * width, gear.name.clone()));
    }
    let [(_, a, ..), (_, b, ..)] = seats.as_slice() else {
        source.leave_out(
            stage,
            About::Lost,
            "its gears sit on no shafts of the scene",
        );
        return Ok(());
    };
    // Equal speeds of the pitch cones in their common line, seen from apex to heel.
    train.links.push(Link {
        shafts: [*a, *b],
        ratio: -sense * teeth[0] as f64 / teeth[1] as f64,
    });
    let link = train.links.len() - 1;
    let found = bevel::read(source, stage, gears)?;
    for (side, (gear, shaft, u_mm, name)) in seats.into_iter().enumerate() {
        train.bevels.push(BevelSeat {
            gear,
            shaft,
            u_mm,
            link: (link, side),
            name,
            stage: found.clone(),
        });
    }
    Ok(())
}

fn on_shafts(
    source: &Source<'_>,
    structure: &Structure,
    train: &mut Train,
    names: &mut Names,
) -> Result<(), RexsError> {
    for component in source.model.of_kind(&["external_load", "additional_mass"]) {
        let shafts = structure.partners(component.id, &["shaft"]);
        let Some(&shaft) = shafts.iter().find(|&&id| train.shaft(id).is_some()) else {
            source.leave_out(component, About::Lost, "on no shaft of the scene");
            continue;
        };
        if component.kind == "external_load" {
            let name = names.unique(&component.name, component.id);
            train
                .loads
                .push(loads::read(source, component, name, shaft)?);
        } else if let Some(mass) = loads::added_mass(source, component, shaft)? {
            train.masses.push(mass);
        }
    }
    Ok(())
}
