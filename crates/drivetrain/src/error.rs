//! What can go wrong in setting up or evaluating a gear mesh.

use gearmesh_contact::ContactError;
use gearmesh_geometry::Flank;

/// Error of this crate.
#[derive(Debug, thiserror::Error)]
pub enum DrivetrainError {
    /// Rollers beside the axis of the bore that they press on.
    #[error(
        "its axis is not that of the gear, from which it is {:.6} mm away: rollers on an elastic bore run around the gear's own axis, z of both alike; remove at_mm and axis, or move it along the axis only", 1e3 * beside_m
    )]
    RollersBeside {
        /// Distance of the bearing's middle from the gear's axis \[m\].
        beside_m: f64,
    },
    /// Rollers that stick out of the bore.
    #[error("its rollers stick out of the bore by {:.4} mm; place it inside the bore, or take shorter rollers", 1e3 * out_m)]
    RollersOutside {
        /// By how much \[m\].
        out_m: f64,
    },
    /// Rollers that go round on a larger circle than the bore.
    #[error(
        "its outer race, pitch and roller diameters together, is {:.4} mm wide, the bore in which it stands {:.4} mm: rollers press on the bore itself, or on an outer ring in it; take \
         the bearing that fits", 1e3 * race_m, 1e3 * bore_m
    )]
    RollersTooLarge {
        /// Diameter of the outer race \[m\].
        race_m: f64,
        /// Diameter of the bore \[m\].
        bore_m: f64,
    },
    /// Rollers and bore that do not settle.
    #[error(
        "bearing `{bearing}`: rollers and elastic bore do not settle, {missed_n:.3e} N are left of {most_n:.3e} N after {iterations} iterations"
    )]
    RollersUnsettled {
        /// The bearing.
        bearing: String,
        /// What is left \[N\].
        missed_n: f64,
        /// The largest force of a roller \[N\].
        most_n: f64,
        /// Iterations.
        iterations: usize,
    },
    /// A bearing.
    #[error(transparent)]
    Bearing(#[from] gearmesh_bearings::BearingError),
    /// A number is out of its range.
    #[error("{owner}: {what} is {found}; it must be {allowed}")]
    Value {
        /// Model, fault or effect.
        owner: &'static str,
        /// Name of the number with its unit.
        what: &'static str,
        /// What was given.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A tooth that does not exist.
    #[error("{owner}: there is no tooth {found}; the gear has teeth 0 to {last}")]
    Tooth {
        /// Fault.
        owner: &'static str,
        /// What was given.
        found: usize,
        /// Last tooth.
        last: usize,
    },
    /// A list of the wrong length.
    #[error("{owner}: {what} has {found} entries, {expected} are needed")]
    Length {
        /// Fault or model.
        owner: &'static str,
        /// Name of the list.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length needed.
        expected: usize,
    },
    /// Helices that do not fit.
    #[error(
        "the base helix angles are {helix_1_deg:.4} and {helix_2_deg:.4} deg: gears on parallel axes need equal angles of opposite hand"
    )]
    Helix {
        /// Base helix angle of gear 1, positive for a right hand.
        helix_1_deg: f64,
        /// Base helix angle of gear 2.
        helix_2_deg: f64,
    },
    /// Gears that have moved along their axes beyond what their slices stand for.
    #[error(
        "the gears have moved by {moved_mm:.4} mm along their axes from where the slices of the hybrid mesh were laid, more than a slice's width of {allowed_mm:.4} mm: start them where they run, or hold them along the axis"
    )]
    AxialMotion {
        /// Motion of gear 2 against gear 1.
        moved_mm: f64,
        /// Largest motion.
        allowed_mm: f64,
    },
    /// A body that is no sum of rings.
    #[error(
        "mass and inertia in closed form are for hub and web with plane faces: take those of a contour or an imported mesh from the reduced gear's model file, or state them"
    )]
    BodyWithoutClosedForm,
    /// A model without mass.
    #[error(
        "the model of gear `{gear}` has no mass and inertia: give a density in its [material] table and reduce it again, or state the body's mass"
    )]
    NoRigidBody {
        /// Name of the gear.
        gear: String,
    },
    /// A gear cut into its shaft whose faces are wanted one by one.
    #[error(
        "the model of gear `{gear}` does not know the faces of its shaft one by one: it was reduced with one face (shaft_diameter_mm has a 0), or by an older \
         version; state the shaft's diameter at both faces and reduce the gear again"
    )]
    NoShaftFaces {
        /// Name of the gear.
        gear: String,
    },
    /// A crack beside the faces of a shaft.
    #[error(
        "gear `{gear}` has a crack and is cut into its shaft: on beams its faces move against each other, which the rows of the crack do not know; take a gear \
         without [crack], or one with a bore"
    )]
    CrackOnFaces {
        /// Name of the gear.
        gear: String,
    },
    /// A matrix of the faces that no body has.
    #[error(
        "stiffness or mass of the faces of gear `{gear}` is not positive: reduce the gear again"
    )]
    FaceMatrix {
        /// Name of the gear.
        gear: String,
    },
    /// A spring for the whole mesh between flanks of which each pair has its own gap.
    #[error(
        "the iso6336 mesh is one spring at the pitch point, which these flanks do not have: take another mesh model"
    )]
    NoCommonGap,
    /// A mesh whose contacts cannot be solved with those of others.
    #[error(
        "mesh `{mesh}` cannot be solved with other meshes of its gears: that takes kind = \"hybrid\" and gears without vibration modes"
    )]
    NotCoupled {
        /// Name of the mesh.
        mesh: String,
    },
    /// Beams for the teeth of a ring.
    #[error(
        "gear {gear} is a ring with internal teeth, which the analytic mesh has no beams for: take impact, or hybrid with reduced gears"
    )]
    RingBeams {
        /// Gear 1 or 2.
        gear: usize,
    },
    /// Errors of single teeth with a model that has no single teeth.
    #[error(
        "flank errors are given, but the iso6336 mesh is one spring that knows no single tooth: take another mesh model, or leave them out"
    )]
    UnusedFlankErrors,
    /// The axes stand too far from parallel.
    #[error(
        "the gear axes stand {found_mrad:.2} mrad from parallel; the slices allow up to {allowed_mrad} mrad, and both z axes must point the same way"
    )]
    Misalignment {
        /// Angle between the axes.
        found_mrad: f64,
        /// Largest angle allowed.
        allowed_mrad: f64,
    },
    /// Flanks of the mesh are pressed into each other deeper than teeth can deflect.
    #[error(
        "the {} flanks stand {depth_mm:.3} mm in each other, allowed are {allowed_mm:.3} mm, a tenth of the base pitch: the teeth would pass \
         through each other; check loads, mesh stiffness and the angles at the start, or take a shorter step", flank.name()
    )]
    TeethPressed {
        /// Side of the teeth.
        flank: Flank,
        /// How deep.
        depth_mm: f64,
        /// What is allowed.
        allowed_mm: f64,
    },
    /// Teeth overlap on the side that the mesh leaves out.
    #[error(
        "the {behind} flanks, which the mesh leaves out, stand {depth_mm:.3} mm in each other, allowed are {allowed_mm:.3} mm, a fiftieth of \
         the base pitch: the teeth would pass through each other. The {only} flanks carry loads that turn both gears {}; give the loads \
         that sign, or write flanks = \"{behind}\" or \"both\"",
        turning(behind.opposite()), behind = behind.name(), only = behind.opposite().name()
    )]
    TeethBehind {
        /// The side that is left out.
        behind: Flank,
        /// How deep.
        depth_mm: f64,
        /// What is allowed.
        allowed_mm: f64,
    },
    /// The base circles overlap.
    #[error(
        "the centre distance is {found_mm:.4} mm, not above the sum of the base radii {smallest_mm:.4} mm: no line of action; hold the gears apart"
    )]
    CentreDistance {
        /// Centre distance.
        found_mm: f64,
        /// Sum of the base radii.
        smallest_mm: f64,
    },
    /// A flank of a bevel gear that does not reach over its blank.
    #[error(transparent)]
    Bevel(#[from] gearmesh_bevel::BevelError),
    /// Conjugate flanks of a bevel pair.
    #[error(
        "the {} flanks of the bevel pair touch along a line, not in a point that a force could act in: crown them (settings by local synthesis or \
         to an ease-off)", flank.name()
    )]
    LineContact {
        /// Side of the teeth.
        flank: Flank,
    },
    /// A flank of a bevel pair that turns back close below where the mate reaches.
    #[error(
        "on the {} side a flank of the bevel pair turns back close below its lower line, as near undercut, so that its curvature is not known well enough for contact \
         in motion: give the pinion more teeth or a larger pressure angle, or analyse the pair at rest with `gearmesh tca`", flank.name()
    )]
    FlankTurnsBack {
        /// Side of the teeth.
        flank: Flank,
    },
    /// A bevel pair whose line of contact cannot be followed over the flank.
    #[error(
        "the line of contact on {} flanks is not smooth over the flank, so that it cannot be cut into slices; take kind = \"impact\", or another ease-off",
        flank.name()
    )]
    BevelLine {
        /// The side.
        flank: Flank,
    },
    /// A reduced gear that is not the member of the bevel pair.
    #[error(
        "the model \"{model}\" is not that of gear {gear} of the bevel pair: {problem}; reduce that member with this pair file"
    )]
    OtherBevel {
        /// Gear 1 or 2.
        gear: usize,
        /// Name of the model.
        model: String,
        /// How they differ.
        problem: String,
    },
    /// Bevel gears too far from where they belong.
    #[error(
        "the axes of the bevel gears stand at {shaft_deg:.4} degrees, the pair is made for {designed_deg:.4} (2.8 degrees off are allowed); their \
         pitch apexes stand {apart_mm:.4} mm apart, allowed are {allowed_mm:.4} mm"
    )]
    BevelAxes {
        /// Angle between the axes, from apex to heel.
        shaft_deg: f64,
        /// Shaft angle of the pair.
        designed_deg: f64,
        /// Distance of the apexes.
        apart_mm: f64,
        /// What is allowed.
        allowed_mm: f64,
    },
    /// The two models do not fit each other or the pair, or their contact has no state.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// A model file lacks what is asked of it.
    #[error(transparent)]
    Model(#[from] gearmesh_model::ReducedGearError),
    /// Modes with a mesh model whose compliance does not come from the gear bodies.
    #[error(
        "gear {gear} is modal, but its mesh model is not `hybrid`: only there can the modes' share be taken from the compliance, others would count it twice; take `hybrid`, or a rigid gear body"
    )]
    ModesWithoutReducedTeeth {
        /// Gear 1 or 2.
        gear: usize,
    },
    /// A side added after the modes.
    #[error("add the modes of the gear bodies after all sides of the teeth")]
    SideAfterModes,
    /// Modes above those that a model holds.
    #[error(
        "gear `{gear}`: modes up to {asked_hz:.1} Hz are asked for, its model holds all up to {complete_to_hz:.1} Hz only; reduce it with a larger [modes] up_to_Hz"
    )]
    ModesBeyond {
        /// Name of the gear.
        gear: String,
        /// What was asked for.
        asked_hz: f64,
        /// What there is.
        complete_to_hz: f64,
    },
    /// A gauge that a model does not have.
    #[error("gear `{gear}` has no gauge `{name}`; it has {known}")]
    Gauge {
        /// Name of the gear.
        gear: String,
        /// What was asked for.
        name: String,
        /// Names of those there are.
        known: String,
    },
}

impl DrivetrainError {
    /// Refuses a number that is not as allowed.
    pub(crate) fn require(
        owner: &'static str,
        (what, found): (&'static str, f64),
        is_allowed: bool,
        allowed: &'static str,
    ) -> Result<f64, Self> {
        if is_allowed {
            return Ok(found);
        }
        Err(Self::Value {
            owner,
            what,
            found,
            allowed,
        })
    }

    /// Refuses edges \[m\] of a flank's parts, along the face and up the flank, of which one is not positive or leaves
    /// fewer parts than `least`, or with which there are not few enough of them.
    pub(crate) fn check_edges(
        owner: &'static str,
        [along, up]: [f64; 2],
        (counts, least, few): ([f64; 2], f64, bool),
        allowed: &'static str,
    ) -> Result<(), Self> {
        let along = ("longest edge along the face in m", along);
        let up = ("longest edge up the flank in m", up);
        Self::require(owner, along, along.1 > 0.0 && counts[0] >= least, allowed)?;
        Self::require(owner, up, up.1 > 0.0 && counts[1] >= least, allowed)?;
        Self::require(owner, along, few, allowed)?;
        Ok(())
    }

    /// Refuses a list of another length.
    pub(crate) fn check_length(
        owner: &'static str,
        what: &'static str,
        found: usize,
        expected: usize,
    ) -> Result<(), Self> {
        if found == expected {
            return Ok(());
        }
        Err(Self::Length {
            owner,
            what,
            found,
            expected,
        })
    }

    /// Refuses a model file with fewer modes than are asked for.
    pub(crate) fn check_modes(owner: &'static str, found: usize, asked: usize) -> Result<(), Self> {
        let what = "the list of modes in the model file";
        Self::check_length(owner, what, found.min(asked), asked)
    }
}

/// A number that must be positive and finite.
pub(crate) fn positive(
    owner: &'static str,
    what: &'static str,
    found: f64,
) -> Result<f64, DrivetrainError> {
    let is_allowed = found > 0.0 && found.is_finite();
    DrivetrainError::require(owner, (what, found), is_allowed, "positive and finite")
}

/// A number that must be zero or positive, and finite.
pub(crate) fn not_negative(
    owner: &'static str,
    what: &'static str,
    found: f64,
) -> Result<f64, DrivetrainError> {
    let (is_allowed, allowed) = (
        found >= 0.0 && found.is_finite(),
        "zero or positive, and finite",
    );
    DrivetrainError::require(owner, (what, found), is_allowed, allowed)
}

/// Which way loads have to turn both gears for flanks of one side to be pressed together.
fn turning(side: Flank) -> &'static str {
    match side {
        Flank::Right => "clockwise (torques negative about z)",
        Flank::Left => "counter-clockwise (torques positive about z)",
    }
}
