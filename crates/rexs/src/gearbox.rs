//! The gearbox of a model: shafts with what stands on them, stages, and how the power flows.

use crate::bearing::Bearing;
use crate::bevel::BevelStage;
use crate::by_number::{ByNumber, Numbered, grouped};
use crate::coupling::Coupling;
use crate::cylindrical::Gear;
use crate::loads::{AddedMass, Load};
use crate::power_flow::{Flow, Link};
use crate::shaft::Shaft;
use crate::source::Part;
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
    /// Where its torque passes.
    pub seat: TorqueSeat,
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

/// A planetary stage of the scene.
#[derive(Debug, Clone)]
pub struct PlanetarySet {
    /// Name in the scene.
    pub name: String,
    /// Places of sun, first planet and ring in [`Train::gears`].
    pub sun: usize,
    /// The first planet, for all.
    pub planet: usize,
    /// The other planets.
    pub others: Vec<usize>,
    /// The ring; on no shaft where it stands.
    pub ring: usize,
    /// Distance of the planets from the axis \[mm\].
    pub distance_mm: f64,
    /// Angles of the planets in the axes of the set \[°\].
    pub angles_deg: Vec<f64>,
    /// Shafts of the carrier, and the place of the set along u \[mm\]; none of a carrier that stands.
    pub carriers: Vec<(i64, f64)>,
    /// Bearings of a planet with their places along the axis from the middle of its face \[mm\].
    pub bearings: Vec<(f64, Bearing)>,
    /// Its link in the flow of power, whose first side is the sun where that turns.
    pub link: usize,
    /// Those of its gears on no shaft of the scene whose own shafts point against its axis.
    pub against_u: Vec<usize>,
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
    pub fn torque_seats(&self) -> impl Iterator<Item = &TorqueSeat> {
        let bevels = self.bevels.iter().map(|b| &b.seat);
        bevels.chain(&self.planetary)
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

    /// The first shaft of the train that shares a relation with a component.
    pub fn shaft_at(&self, part: Part<'_>) -> Option<i64> {
        let mut shafts = part.partners(&["shaft"]).into_iter();
        shafts.find(|&id| self.shaft(id).is_some())
    }

    /// A shaft, to be changed.
    pub fn shaft_mut(&mut self, id: i64) -> Option<&mut Shaft> {
        let place = self.shafts.place(id)?;
        self.shafts.get_mut(place)
    }
}
