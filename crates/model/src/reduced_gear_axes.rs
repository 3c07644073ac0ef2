//! Frames, axes and lengths that the arrays of a reduced gear's file have in common.

pub(crate) const GEAR_FRAME: &str = "gear: right-handed, z the axis, zero at mid-face, tooth 0 centred on +x, teeth counter-clockwise";
pub(crate) const FLANK_COMPONENTS: &str =
    "flank: inward normal, profile tangential towards the tip, axial +z";
pub(crate) const LOAD: &str = "load: roll station, axial station";
pub(crate) const MOTION: &str = "motion: x, y, z, rotations about x, y, z";

/// Lengths that the arrays have in common.
#[derive(Clone, Copy)]
pub(crate) struct Sizes {
    pub teeth: usize,
    pub hands: usize,
    /// Up the flank and along it.
    pub stations: usize,
    pub along: usize,
    pub loads: usize,
    pub gauges: usize,
}
