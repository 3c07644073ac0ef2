//! `[[planetary]]`: a sun and a ring, planets between them, and the carrier that holds them. It follows from it what
//! could be written as bodies, joints, bearings and meshes (`../planetary/`).

use std::path::PathBuf;

use gearmesh_geometry::gear_file::MicrogeometryTable;
use gearmesh_geometry::input::{Beside, Bounded, Count, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::bearing::{BearingModel, HousingTable};
use super::body::{BoreHold, Coupling, Flexibility};
use super::function::FunctionTable;
use super::gear_mesh::{EccentricityTable, TeethTable};
use super::mesh_model::{HertzTable, MeshModel};
use super::planet_pin::PinTable;
use crate::gear_tables::flank_errors::FlankErrorTable;

/// `[[planetary]]` as written in the file. Angles count counter-clockwise about the axis of the set, from x, or from
/// where x is after the turns about x and then y that take z into the axis.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlanetaryTable {
    /// Name. The parts are called after it: `NAME sun`, `NAME ring`, `NAME carrier`, `NAME planet 1`.
    pub name: String,
    /// Middle of the set on its axis: mid-face of the planets, and of sun and ring but for their `z_mm`; [0, 0, 0]
    /// where not given.
    pub position_mm: Option<[f64; 3]>,
    /// Axis of the set; z where not given.
    pub axis: Option<[f64; 3]>,
    /// Distance of the pins from the axis: the centre distance of the sun and a planet, and of a planet and the ring.
    pub centre_distance_mm: Bounded<Positive>,
    /// Torque on the sun at the start, which says what flanks touch there: "positive" (counter-clockwise) or
    /// "negative". Where not given, it follows from the torques, else from the speeds that `sun`, `ring` and `carrier`
    /// state.
    pub sun_torque: Option<SenseWord>,
    /// Torque on the ring at the start, where it does not follow from the sun's: in trains in which more than one
    /// torque comes to the planets, such as Ravigneaux sets.
    pub ring_torque: Option<SenseWord>,
    /// The sun; a set has a sun, a ring or both.
    pub sun: Option<MemberTable>,
    /// The ring.
    pub ring: Option<MemberTable>,
    /// The carrier.
    pub carrier: MemberTable,
    /// Where the middle of the pins lies beside the carrier's axis; on it where not given.
    pub carrier_eccentricity: Option<CarrierEccentricityTable>,
    /// The planets.
    pub planets: PlanetsTable,
    /// Meshes of the sun (gear 1) with each planet (gear 2); needed with a sun.
    pub sun_mesh: Option<SetMeshTable>,
    /// Meshes of each planet (gear 1) with its partner (gear 2); needed with `planets.partner`.
    pub pair_mesh: Option<SetMeshTable>,
    /// Meshes of each planet, or of its partner, (gear 1) with the ring (gear 2); needed with a ring.
    pub ring_mesh: Option<SetMeshTable>,
}

/// The sense of a torque.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SenseWord {
    /// Counter-clockwise.
    Positive,
    /// Clockwise.
    Negative,
}

/// `sun`, `ring` and `carrier`. Keys of the body are those of `[[body]]`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct MemberTable {
    /// A body of the scene, or of another planetary set, that is this member: two sets share it. Gear, mass, support,
    /// speed and load are then stated there.
    pub body: Option<String>,
    /// Sun and ring: gear file (.toml) or reduced gear (.h5), relative to the scene.
    pub gear: Option<PathBuf>,
    /// Sun and ring: its mid-face above that of the planets; 0 where not given.
    pub z_mm: Option<f64>,
    /// Microgeometry of the gear in all its meshes.
    pub microgeometry: Option<MicrogeometryTable>,
    /// Mass; from the gear where not given.
    pub mass_kg: Option<f64>,
    /// Inertia about the centre of mass; from the gear where not given.
    pub inertia_kg_m2: Option<Vec<f64>>,
    /// Centre of mass from the origin.
    pub centre_of_mass_mm: Option<[f64; 3]>,
    /// How the gear deflects.
    pub flexibility: Option<Flexibility>,
    /// Whose forces its meshes feel in it.
    pub coupling: Option<Coupling>,
    /// How its bore is held.
    pub bore: Option<BoreHold>,
    /// With "modal": modes up to this frequency.
    #[serde(rename = "modes_up_to_Hz")]
    pub modes_up_to_hz: Option<f64>,
    /// With "modal": damping ratio of all modes.
    pub modal_damping_ratio: Option<f64>,
    /// How it is held to the ground: "turning" where not given, "bearings" where bearings are.
    pub support: Option<SupportWord>,
    /// With "bearings" and "floating": bearings between the ground and the member.
    #[serde(default)]
    pub bearings: Vec<SetBearingTable>,
    /// With "turning" and "floating": speed about the axis that drives it.
    pub speed_rpm: Option<FunctionTable>,
    /// Torque about the axis that acts on it; not with "held".
    pub torque_Nm: Option<FunctionTable>,
    /// Ring: waves of its pitch circle.
    #[serde(default)]
    pub out_of_round: Vec<OutOfRoundTable>,
}

impl MemberTable {
    /// How it is held; none where another table says it.
    #[must_use]
    pub fn support(&self) -> Option<SupportWord> {
        let by_bearings = match self.bearings.is_empty() {
            true => SupportWord::Turning,
            false => SupportWord::Bearings,
        };
        self.body
            .is_none()
            .then(|| self.support.unwrap_or(by_bearings))
    }
}

/// `support`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SupportWord {
    /// Fixed to the ground.
    Held,
    /// Turns about its axis.
    Turning,
    /// Turns about its axis and moves across it; it does not tilt and does not move along.
    Floating,
    /// Bearings alone.
    Bearings,
    /// By other tables of the scene, such as a joint to another set.
    Free,
}

impl SupportWord {
    /// Name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Held => "held",
            Self::Turning => "turning",
            Self::Floating => "floating",
            Self::Bearings => "bearings",
            Self::Free => "free",
        }
    }
}

/// A bearing of a member on the ground, or of a planet on its pin.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetBearingTable {
    /// Place along the axis, from the middle of the set; 0 where not given.
    #[serde(default)]
    pub z_mm: f64,
    /// Model, as of `[[bearing]]`.
    pub model: BearingModel,
    /// What lies between the outer ring and the ground, as of `[[bearing]]`; not of planets.
    pub housing: Option<HousingTable>,
}

/// A wave of the ring's pitch circle: the teeth stand `amplitude_um` · cos(lobes · (φ − crest_deg)) farther outside,
/// and the ring is not stretched.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutOfRoundTable {
    /// Waves around.
    pub lobes: Count<2, 20>,
    /// Amplitude of the radius.
    pub amplitude_um: f64,
    /// Angle of a crest from tooth 0; 0 where not given.
    #[serde(default)]
    pub crest_deg: f64,
}

/// `carrier_eccentricity`.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CarrierEccentricityTable {
    /// Distance.
    pub offset_um: f64,
    /// Direction; 0 where not given.
    #[serde(default)]
    pub direction_deg: f64,
}

/// Keys of planets and of their partners: of the body, as of `[[body]]`, and how the pin holds it.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PinnedKeys {
    /// Microgeometry in all meshes.
    pub microgeometry: Option<MicrogeometryTable>,
    /// Mass; from the gear where not given.
    pub mass_kg: Option<f64>,
    /// Inertia about the centre of mass; from the gear where not given.
    pub inertia_kg_m2: Option<Vec<f64>>,
    /// How the gear deflects.
    pub flexibility: Option<Flexibility>,
    /// Whose forces its meshes feel in it.
    pub coupling: Option<Coupling>,
    /// How its bore is held.
    pub bore: Option<BoreHold>,
    /// With "modal": modes up to this frequency.
    #[serde(rename = "modes_up_to_Hz")]
    pub modes_up_to_hz: Option<f64>,
    /// With "modal": damping ratio of all modes.
    pub modal_damping_ratio: Option<f64>,
    /// "turning" on the pin, "floating" on it (turns and moves across the axis), or "bearings"; "turning" where not
    /// given, "bearings" where bearings are.
    pub support: Option<SupportWord>,
    /// With "bearings" and "floating": bearings between carrier and gear.
    #[serde(default)]
    pub bearings: Vec<SetBearingTable>,
    /// The pins as beams; rigid where not given.
    pub pin: Option<PinTable>,
    /// Errors and faults of all.
    #[serde(default)]
    pub errors: Vec<FlankErrorTable>,
    /// Those that differ from the others.
    #[serde(default)]
    pub deviation: Vec<PlanetDeviationTable>,
}

/// `planets`.
pub type PlanetsTable = Beside<PinnedKeys, PlanetKeys>;

/// Keys of planets alone.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlanetKeys {
    /// Gear file (.toml) or reduced gear (.h5), relative to the scene.
    pub gear: PathBuf,
    /// Number of planets at equal angles, the first one on x; or `angles_deg`.
    pub count: Option<Count<1, 24>>,
    /// Angles of the planets, counter-clockwise from x.
    pub angles_deg: Option<Vec<f64>>,
    /// A second gear on each planet, fixed to the first, which meshes with the ring: stepped planets.
    pub second: Option<SecondGearTable>,
    /// A second planet beside each, which meshes with it and, in its place, with the ring: meshed planets.
    pub partner: Option<PartnerTable>,
}

/// `planets.second`: the gear of stepped planets that meshes with the ring.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SecondGearTable {
    /// Gear file (.toml) or reduced gear (.h5), relative to the scene.
    pub gear: PathBuf,
    /// Its mid-face, from the middle of the set; that of the ring, too, but for its own `z_mm`.
    pub z_mm: f64,
    /// Mass; from the gear where not given.
    pub mass_kg: Option<f64>,
    /// Inertia about the centre of mass; from the gear where not given.
    pub inertia_kg_m2: Option<Vec<f64>>,
    /// How the gear deflects.
    pub flexibility: Option<Flexibility>,
    /// Whose forces its meshes feel in it.
    pub coupling: Option<Coupling>,
    /// How its bore is held.
    pub bore: Option<BoreHold>,
}

/// `planets.partner`: the second planets of meshed planets (sun, planet, partner, ring); deviations of pins are counted
/// as those of the planets.
pub type PartnerTable = Beside<PinnedKeys, PartnerKeys>;

/// Keys of partners alone.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartnerKeys {
    /// Gear file (.toml) or reduced gear (.h5), relative to the scene; or `planets_of`.
    pub gear: Option<PathBuf>,
    /// Another planetary set, which stands before this one and has a ring: its planets are the partners, and its ring
    /// is that of this set, too. Both make a Ravigneaux set. Where these planets stand is stated there.
    pub planets_of: Option<String>,
    /// Distance of the partners' pins from the axis; not with `planets_of`.
    pub centre_distance_mm: Option<Bounded<Positive>>,
    /// Centre distance of planet and partner.
    pub pair_distance_mm: Bounded<Positive>,
    /// On which side of its planet a partner is: "ahead" (counter-clockwise about the set's axis) or "behind"; "ahead"
    /// where not given.
    #[serde(default)]
    pub side: PartnerSide,
}

/// `side` of a partner.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PartnerSide {
    /// Counter-clockwise of its planet.
    #[default]
    Ahead,
    /// Clockwise of it.
    Behind,
}

/// How one planet differs.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlanetDeviationTable {
    /// The planet, from 1.
    pub planet: Count<1, 24>,
    /// The pin is farther outside by this.
    #[serde(default)]
    pub radial_um: f64,
    /// The pin is farther on, counter-clockwise, by this.
    #[serde(default)]
    pub tangential_um: f64,
    /// Tilt of the pin in the plane of the axes: its +z end leans outwards.
    #[serde(default)]
    pub tilt_radial_mrad: f64,
    /// Tilt of the pin across that plane: its +z end leans counter-clockwise.
    #[serde(default)]
    pub tilt_tangential_mrad: f64,
    /// Material removed from both flanks of all teeth along the normal: a thinner tooth.
    #[serde(default)]
    pub removed_um: f64,
    /// Place of the gear on the planet: runout and wobble.
    pub eccentricity: Option<EccentricityTable>,
}

/// `sun_mesh`, `ring_mesh` and `pair_mesh`: what all meshes of a kind have. Errors and eccentricities are those of the
/// sun (`errors_1`, `eccentricity_1`) or of the ring (`errors_2`, `eccentricity_2`); those of planets stand in
/// `planets`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetMeshTable {
    /// Model of the teeth, as of `[[gear_mesh]]`.
    pub model: MeshModel,
    /// What touches and how. Not with kind `kinematic`.
    pub teeth: Option<TeethTable>,
    /// Columns of each pair of teeth.
    pub tooth_pairs: Option<HertzTable>,
    /// Whether the microgeometry of the gears acts.
    pub microgeometry: Option<bool>,
}
