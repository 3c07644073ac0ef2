//! Why no gear can be cut from a definition, with the numbers that make it impossible.

/// Why no gear can be cut from a definition.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// The two flanks meet below the tip circle.
    #[error(
        "the tooth is pointed: at the tip radius {tip_radius_mm:.4} mm the flanks have crossed (thickness {thickness_mm:.4} mm); lower the addendum or the profile shift, or give a smaller tip diameter"
    )]
    PointedTooth {
        /// Tip radius.
        tip_radius_mm: f64,
        /// Circular tooth thickness there.
        thickness_mm: f64,
    },
    /// The rounding does not fit on the tip of the rack.
    #[error(
        "a rack tip radius of {rack_tip_radius} modules does not fit: the rack tooth's tip is too narrow by {excess_mm:.4} mm; at most {allowed:.4} modules fit"
    )]
    RackTipTooNarrow {
        /// Rounding asked for, in modules.
        rack_tip_radius: f64,
        /// Missing half width.
        excess_mm: f64,
        /// Largest rounding that fits, in modules.
        allowed: f64,
    },
    /// The fillet cuts so much away that no usable involute is left.
    #[error(
        "undercut destroys the tooth: the involute would start at radius {form_radius_mm:.4} mm, not below the tip at {tip_radius_mm:.4} mm; raise the profile shift above {needed_profile_shift:.4} or the number of teeth"
    )]
    Undercut {
        /// Radius at which the involute would start.
        form_radius_mm: f64,
        /// Radius at which it would end.
        tip_radius_mm: f64,
        /// Profile shift without undercut.
        needed_profile_shift: f64,
    },
    /// Tip at or below the root, or root at or below the axis.
    #[error(
        "the radii are impossible: root {root_radius_mm:.4} mm, tip {tip_radius_mm:.4} mm; the root must be above 0 and the tip above the root"
    )]
    ImpossibleRadii {
        /// Root radius.
        root_radius_mm: f64,
        /// Tip radius.
        tip_radius_mm: f64,
    },
    /// A ring's tip circle inside its base circle, where there is no involute.
    #[error(
        "the tip of the ring, at radius {tip_radius_mm:.4} mm, must lie outside its base circle, at {base_radius_mm:.4} mm: no involute goes further; lower the addendum or the profile shift, or give a larger tip diameter"
    )]
    TipInsideBase {
        /// Tip radius.
        tip_radius_mm: f64,
        /// Base radius.
        base_radius_mm: f64,
    },
    /// A ring whose root or form circle is not outside its tip circle.
    #[error(
        "the radii of the ring are impossible: tip {tip_radius_mm:.4} mm, end of the involute {form_radius_mm:.4} mm, root {root_radius_mm:.4} mm; they must grow in this order"
    )]
    ImpossibleRing {
        /// Root radius.
        root_radius_mm: f64,
        /// Radius at which fillet and involute meet.
        form_radius_mm: f64,
        /// Tip radius.
        tip_radius_mm: f64,
    },
    /// No full root radius between the flanks of a ring.
    #[error(
        "no full root radius fits the root circle at {root_radius_mm:.4} mm, where the space is {width_mm:.4} mm wide; lower the dedendum or the profile shift"
    )]
    NoFullRound {
        /// Root radius.
        root_radius_mm: f64,
        /// Width of the space between the involutes there; negative where they have crossed.
        width_mm: f64,
    },
    /// The cutter has nearly as many teeth as its ring.
    #[error(
        "a cutter of {cutter_teeth} teeth is too large for the ring; at most {allowed} teeth are possible"
    )]
    CutterTooLarge {
        /// Its number of teeth.
        cutter_teeth: usize,
        /// Largest number.
        allowed: usize,
    },
    /// The rounding does not fit on the tip of the cutter.
    #[error(
        "a tip radius of {tip_radius} modules does not fit on the cutter's tooth; at most {allowed:.4} modules fit"
    )]
    CutterTipTooNarrow {
        /// Rounding asked for, in modules.
        tip_radius: f64,
        /// Largest rounding that fits, in modules.
        allowed: f64,
    },
    /// No centre distance of cutter and ring.
    #[error(
        "a cutter of {cutter_teeth} teeth cannot cut the ring: the profile shifts of both together must stay below {least_shift_sum:.4}; lower one of them or take a cutter with fewer teeth"
    )]
    NoCutting {
        /// Number of teeth of the cutter.
        cutter_teeth: usize,
        /// Sum of the profile shifts at which the pressure angle of cutting vanishes.
        least_shift_sum: f64,
    },
    /// The rounding of the cutter reaches down to its pitch circle.
    #[error(
        "the rounding of the cutter's tip has its centre at radius {centre_radius_mm:.4} mm, allowed is more than the pitch radius of cutting, {pitch_radius_mm:.4} mm; raise the cutter's addendum or lower its tip radius"
    )]
    CutterTooShort {
        /// Radius of the rounding's centre.
        centre_radius_mm: f64,
        /// Pitch radius of the cutter in cutting.
        pitch_radius_mm: f64,
    },
    /// The cutter's involute ends at its base circle, before the ring's tip.
    #[error(
        "a cutter of {cutter_teeth} teeth makes no involute at the ring's tip: its own ends at its base circle, which reaches the ring's diameter {reached_diameter_mm:.4} mm, and the ring's flank goes to {flank_end_diameter_mm:.4} mm; give a larger tip diameter or a cutter with more teeth"
    )]
    CutterMissesTip {
        /// Number of teeth of the cutter.
        cutter_teeth: usize,
        /// Smallest diameter of the ring that it makes.
        reached_diameter_mm: f64,
        /// Where the ring's flank ends.
        flank_end_diameter_mm: f64,
    },
    /// The cutter's corners cut into the ring's tips.
    #[error(
        "a cutter of {cutter_teeth} teeth cuts {depth_um:.2} um into the tips of the ring on its way out of the space; give a cutter with fewer teeth or a tip diameter of {clear_tip_diameter_mm:.4} mm or more"
    )]
    CutterTrimsTip {
        /// Number of teeth of the cutter.
        cutter_teeth: usize,
        /// Depth along the normal of the ring's flank.
        depth_um: f64,
        /// Tip diameter from which on the ring is clear.
        clear_tip_diameter_mm: f64,
    },
    /// The chamfer takes away the flank or the tip land.
    #[error(
        "a tip chamfer of {chamfer_mm:.4} mm leaves no {lost}; at most {allowed_mm:.4} mm is possible"
    )]
    ChamferTooLarge {
        /// Chamfer asked for.
        chamfer_mm: f64,
        /// What it destroys.
        lost: &'static str,
        /// Largest possible chamfer.
        allowed_mm: f64,
    },
}
