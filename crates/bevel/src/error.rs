//! What can go wrong.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;

/// A bevel gear that cannot be made or meshed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BevelError {
    /// A value of the blank that is not allowed.
    #[error("{key}: {problem}")]
    Blank {
        /// Key of the pair file.
        key: &'static str,
        /// What was found and what is allowed.
        problem: String,
    },
    /// The tool leaves no surface at a place of the flank.
    #[error(
        "the tool leaves no surface on the {flank} flank at cone distance {cone_mm:.3} mm, {height_mm:+.3} mm from the pitch cone: \
         the settings do not fit the blank, or the flank is undercut there"
    )]
    NoFlankPoint {
        /// Member and side.
        flank: String,
        /// Place along the pitch cone.
        cone_mm: f64,
        /// Height above the pitch cone.
        height_mm: f64,
    },
    /// The envelope is singular: undercut.
    #[error(
        "the {flank} flank is undercut at cone distance {cone_mm:.3} mm, {height_mm:+.3} mm from the pitch cone (the envelope of the tool turns back \
         there): take more teeth, a larger pressure angle or less dedendum"
    )]
    Undercut {
        /// Member and side.
        flank: String,
        /// Place along the pitch cone.
        cone_mm: f64,
        /// Height above the pitch cone.
        height_mm: f64,
    },
    /// Teeth end in a point.
    #[error(
        "the {member}'s teeth are pointed: at cone distance {cone_mm:.3} mm their top is {thickness_mm:.4} mm thick, allowed is {least_mm:.4} mm and more"
    )]
    Pointed {
        /// Member.
        member: &'static str,
        /// Place along the pitch cone.
        cone_mm: f64,
        /// Top land.
        thickness_mm: f64,
        /// Least top land.
        least_mm: f64,
    },
    /// The blade does not fit into the slot.
    #[error(
        "the {member}'s blade does not fit: at cone distance {cone_mm:.3} mm the slot's bottom is {slot_mm:.4} mm wide, the blade's point {blade_mm:.4} mm"
    )]
    BladeTooWide {
        /// Member.
        member: &'static str,
        /// Place along the pitch cone.
        cone_mm: f64,
        /// Width of the slot normal to the tooth.
        slot_mm: f64,
        /// Width of the blade.
        blade_mm: f64,
    },
    /// The edges of both blades do not lie beside one another in the slot.
    #[error(
        "the {member}'s edge radius does not fit: at cone distance {cone_mm:.3} mm the slot's bottom is {slot_mm:.4} mm wide, the edges of both blades take \
         {edges_mm:.4} mm; allowed are edge radii up to {share:.3} of these"
    )]
    EdgeTooLarge {
        /// Member.
        member: &'static str,
        /// Place along the pitch cone.
        cone_mm: f64,
        /// Width of the slot normal to the tooth.
        slot_mm: f64,
        /// What both edges take.
        edges_mm: f64,
        /// Edge radii that fit, over those asked for.
        share: f64,
    },
    /// Both flanks in one operation leave no slot, or no tooth.
    #[error(
        "the {member}'s settings leave teeth of {thickness_mm:.4} mm on the mean circle, whose pitch is {pitch_mm:.4} mm: the point radius of the concave \
         flank (outside blade) must exceed that of the convex one (inside blade) by the point width; where the flanks are cut one after the other, \
         state thickness = \"blank\""
    )]
    NoSlot {
        /// Member.
        member: &'static str,
        /// Thickness along the circle.
        thickness_mm: f64,
        /// Pitch along the circle.
        pitch_mm: f64,
    },
    /// No point width leaves a thickness.
    #[error(
        "no point width of one cutter leaves the {member}'s teeth {thickness_mm:.4} mm thick on the mean circle; change thickness_shift or backlash_mm"
    )]
    NoPointWidth {
        /// Member.
        member: &'static str,
        /// Thickness along the circle.
        thickness_mm: f64,
    },
    /// Flanks that nowhere touch inside their limits.
    #[error("the pinion's {pinion} and the gear's {gear} flank do not meet: {problem}")]
    DoNotMeet {
        /// Side of the pinion.
        pinion: &'static str,
        /// Side of the gear.
        gear: &'static str,
        /// What was found, and what to look at.
        problem: String,
    },
    /// Teeth that overlap in an assembly.
    #[error(
        "teeth jam: while the pinion's {pinion} flanks touch in this assembly, the other ones overlap by {depth_mm:.4} mm, allowed are \
         {allowed_mm:.4} mm; make the errors of assembly smaller, or give the pair backlash_mm"
    )]
    Jam {
        /// Side of the pinion that touches.
        pinion: &'static str,
        /// Along the normal of the flanks that overlap.
        depth_mm: f64,
        /// Most.
        allowed_mm: f64,
    },
    /// No blade angle gives the pressure angle.
    #[error(
        "no blade angle between 0 and 45 degrees gives the {flank} flank the pressure angle {pressure_deg:.3} degrees: the dedendum angle is too large"
    )]
    NoBladeAngle {
        /// Member and side.
        flank: String,
        /// What is asked.
        pressure_deg: f64,
    },
    /// A point of the pinion never meets the gear's surface.
    #[error(
        "the pinion's flank at cone distance {cone_mm:.3} mm, {height_mm:+.3} mm from the pitch cone, never meets the gear's: the flanks do not fit"
    )]
    NoMate {
        /// Place along the pitch cone.
        cone_mm: f64,
        /// Height above the pitch cone.
        height_mm: f64,
    },
    /// No contact of the flanks was found.
    #[error("the flanks do not touch in this assembly: {hint}")]
    NoContact {
        /// What to do.
        hint: &'static str,
    },
    /// Local synthesis asks for what cannot be.
    #[error("local synthesis: {problem}")]
    Synthesis {
        /// Why, and what to change.
        problem: String,
    },
}

impl BevelError {
    /// The complaint as one of the pair file that asks for what cannot be: with its name, and the line of the member's
    /// table where it lies with one member.
    #[must_use]
    pub fn in_file(&self, document: &InputDocument) -> InputError {
        let of_flank = |flank: &str| match flank.starts_with("pinion") {
            true => "pinion",
            false => "gear",
        };
        let key = match self {
            Self::Blank { key, problem } => return document.error(key, problem),
            Self::NoFlankPoint { flank, .. }
            | Self::Undercut { flank, .. }
            | Self::NoBladeAngle { flank, .. } => of_flank(flank),
            Self::Pointed { member, .. }
            | Self::BladeTooWide { member, .. }
            | Self::EdgeTooLarge { member, .. }
            | Self::NoSlot { member, .. }
            | Self::NoPointWidth { member, .. } => member,
            // It makes the pinion for a gear that is given.
            Self::Synthesis { .. } => "pinion",
            Self::NoContact { .. } | Self::Jam { .. } if document.has("tca") => "tca",
            Self::NoMate { .. }
            | Self::NoContact { .. }
            | Self::DoNotMeet { .. }
            | Self::Jam { .. } => "",
        };
        document.error(key, self)
    }
}
