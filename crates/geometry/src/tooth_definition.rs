//! What the teeth of a gear are, and the tool that cuts them: numbers, not yet a profile.

/// A pinion cutter: a spur or helical gear that shapes a ring. Coefficients in multiples of the module.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PinionCutter {
    /// Number of teeth.
    pub teeth: usize,
    /// Profile shift coefficient x_0.
    pub profile_shift: f64,
    /// Addendum coefficient: its tip radius is its reference radius + m (addendum + x_0).
    pub addendum: f64,
    /// Coefficient of the radius that rounds its tip edges, in the transverse section.
    pub tip_radius: f64,
}

/// What makes the root of a ring's teeth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InternalRoot {
    /// A pinion cutter, whose tip also makes the root circle.
    Cutter(PinionCutter),
    /// A tool with a full root radius, such as a broach, down to the root circle of the dedendum.
    FullRound,
}

/// Whether the teeth stand on the outside of a body or on the inside of a ring, and what cuts them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Gearing {
    /// Outside, cut by a rack.
    #[default]
    External,
    /// Inside: a negative number of teeth in files.
    Internal(InternalRoot),
}

/// Involute teeth, spur or helical. Lengths in metres and without sign, coefficients in multiples of the module.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ToothDefinition {
    /// Number of teeth, without sign.
    pub teeth: usize,
    /// Where the teeth stand, and what cuts them.
    pub gearing: Gearing,
    /// Module \[m\], of helical teeth in the normal section.
    pub module_m: f64,
    /// Pressure angle of the rack \[rad\], of helical teeth in the normal section.
    pub pressure_angle_rad: f64,
    /// Profile shift coefficient x, positive towards the tip: thicker teeth, of a ring as well (ISO 21771).
    pub profile_shift: f64,
    /// Addendum coefficient of the gear's tip, ignored when `tip_diameter_m` is given.
    pub addendum: f64,
    /// Dedendum coefficient: addendum of the cutting rack; without meaning where a pinion cutter makes the root.
    pub dedendum: f64,
    /// Tip radius coefficient of the cutting rack; without meaning for a ring.
    pub rack_tip_radius: f64,
    /// Tip diameter \[m\] where it is not reference diameter + 2 m (addendum + x), of a ring − 2 m (addendum + x).
    pub tip_diameter_m: Option<f64>,
    /// Reduction of the tooth thickness on the reference circle \[m\].
    pub thickness_allowance_m: f64,
    /// Tip chamfer \[m\], taken radially and circumferentially.
    pub tip_chamfer_m: f64,
    /// Face width \[m\].
    pub face_width_m: f64,
    /// Helix angle β on the reference cylinder \[rad\]: positive for a right hand, the section at z is then turned
    /// counter-clockwise by z tan β/r; zero for spur teeth.
    pub helix_angle_rad: f64,
}

impl ToothDefinition {
    /// The number of teeth as files and ISO 21771 write it: negative for a ring.
    #[must_use]
    pub fn signed_teeth(&self) -> i64 {
        let teeth = self.teeth as i64;
        match self.gearing {
            Gearing::External => teeth,
            Gearing::Internal(_) => -teeth,
        }
    }
}
