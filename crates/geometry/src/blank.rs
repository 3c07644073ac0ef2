//! The body of a gear below the teeth: solid, with a web, or meshed elsewhere.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

use crate::flank::Flank;
use std::f64::consts::TAU;

/// The body below the teeth. Held at the bore, at the end faces of the shaft that it is cut into, or at the outside of
/// a ring.
#[derive(Debug, Clone, PartialEq)]
pub enum Blank {
    /// A disc of full width, perhaps with openings through it.
    Solid {
        /// Bore radius \[m\].
        bore_radius_m: f64,
        /// Openings.
        openings: Option<Openings>,
    },
    /// Hub, web and rim, perhaps with openings through the web.
    Webbed {
        /// Bore radius \[m\].
        bore_radius_m: f64,
        /// Hub, web and rim.
        web: Web,
        /// Faces of hub and web where they are no planes; `web` then describes the web at the rim.
        contour: Option<Contour>,
        /// Openings.
        openings: Option<Openings>,
    },
    /// A disc of full width, cut into its shaft: solid down to the axis.
    CutIntoShaft(CutIntoShaft),
    /// The rim of a ring with internal teeth, of full width.
    Ring(Rim),
    /// The whole gear, teeth included, was meshed elsewhere; web and openings are not known.
    Meshed {
        /// Bore radius \[m\].
        bore_radius_m: f64,
        /// Where the mesh is.
        body: MeshedBody,
    },
}

impl Default for Blank {
    fn default() -> Self {
        Self::solid(0.0)
    }
}

impl Blank {
    /// A solid disc without openings.
    #[must_use]
    pub fn solid(bore_radius_m: f64) -> Self {
        Self::Solid {
            bore_radius_m,
            openings: None,
        }
    }

    /// Bore radius \[m\]; 0 of a gear cut into its shaft and of a ring, which have none.
    #[must_use]
    pub fn bore_radius_m(&self) -> f64 {
        match self {
            Self::CutIntoShaft(_) | Self::Ring(_) => 0.0,
            Self::Solid { bore_radius_m, .. }
            | Self::Webbed { bore_radius_m, .. }
            | Self::Meshed { bore_radius_m, .. } => *bore_radius_m,
        }
    }

    /// Radius at which the mesh ends away from the teeth \[m\]: the bore, the hole that is left open in a gear cut into
    /// its shaft, or the outside of a ring.
    #[must_use]
    pub fn edge_radius_m(&self) -> f64 {
        match self {
            Self::CutIntoShaft(shaft) => shaft.hole_radius_m,
            Self::Ring(rim) => rim.outer_radius_m,
            _ => self.bore_radius_m(),
        }
    }

    /// The rim of a ring with internal teeth.
    #[must_use]
    pub fn rim(&self) -> Option<&Rim> {
        match self {
            Self::Ring(rim) => Some(rim),
            _ => None,
        }
    }

    /// Hub, web and rim; none of a solid disc of full width.
    #[must_use]
    pub fn web(&self) -> Option<Web> {
        match self {
            Self::Webbed { web, .. } => Some(*web),
            _ => None,
        }
    }

    /// Faces of hub and web where they are no planes.
    #[must_use]
    pub fn contour(&self) -> Option<&Contour> {
        match self {
            Self::Webbed { contour, .. } => contour.as_ref(),
            _ => None,
        }
    }

    /// Openings through the web, or through the solid disc.
    #[must_use]
    pub fn openings(&self) -> Option<Openings> {
        match self {
            Self::Solid { openings, .. } | Self::Webbed { openings, .. } => *openings,
            _ => None,
        }
    }

    /// How it is cut into its shaft; none of a gear with a bore.
    #[must_use]
    pub fn cut_into_shaft(&self) -> Option<&CutIntoShaft> {
        match self {
            Self::CutIntoShaft(shaft) => Some(shaft),
            _ => None,
        }
    }

    /// How it is cut into its shaft where that goes on at both faces.
    #[must_use]
    pub fn two_faced_shaft(&self) -> Option<&CutIntoShaft> {
        let shaft = self.cut_into_shaft()?;
        (shaft.end_radii_m.iter().all(|radius| *radius > 0.0)).then_some(shaft)
    }

    /// Where the whole gear was meshed elsewhere.
    #[must_use]
    pub fn meshed(&self) -> Option<&MeshedBody> {
        match self {
            Self::Meshed { body, .. } => Some(body),
            _ => None,
        }
    }
}

/// The rim of a ring with internal teeth.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rim {
    /// Outer radius \[m\].
    pub outer_radius_m: f64,
    /// Back and front of the band of the outside that is held \[m\]; the whole width where there is none.
    pub held_z_m: Option<[f64; 2]>,
    /// Parts of the outside at which it is held; all round where there are none.
    pub lugs: Option<Lugs>,
}

/// Equal parts of a ring's outside, evenly round it, at which the ring is held: lugs, keys, or the ground around bolts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lugs {
    /// Number.
    pub count: usize,
    /// Angle that each covers \[rad\].
    pub width_rad: f64,
    /// Polar angle of the middle of the first one \[rad\]; tooth 0 is centred on zero.
    pub phase_rad: f64,
}

impl Lugs {
    /// Angle from the middle of one to the middle of the next \[rad\].
    #[must_use]
    pub fn repeat_rad(&self) -> f64 {
        TAU / self.count as f64
    }

    /// Angle from the middle of the nearest one \[rad\], at most half of [`Self::repeat_rad`].
    #[must_use]
    pub fn from_middle_rad(&self, polar_rad: f64) -> f64 {
        let (from, repeat) = (polar_rad - self.phase_rad, self.repeat_rad());
        (from - repeat * (from / repeat).round()).abs()
    }
}

/// A gear that is one with its shaft.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CutIntoShaft {
    /// Radius of the hole that the mesh leaves open along the axis, free of loads and not held \[m\].
    pub hole_radius_m: f64,
    /// Radius of the shaft at the back and the front face, which it joins; 0 where it does not go on \[m\].
    pub end_radii_m: [f64; 2],
}

impl CutIntoShaft {
    /// The hole over the root radius: it takes 0.06 % of the root disc's area, and 4e-7 of its polar moment.
    pub const HOLE: f64 = 1.0 / 40.0;
    /// Length of the stubs of shaft that are meshed beyond the faces, over the shaft's diameter. Stress without
    /// resultant dies away along a round bar by exp(−2.7 z/R) where it is the same all round (R. W. Little and S. B.
    /// Childs, Q. Appl. Math. 25 (1967) 261-274), and by exp(−2.09 z/R) where it has two lobes
    /// (docs/theory/reduction.md): a quarter of the diameter leaves 0.26 to 0.35 of it at the stub's rigid end.
    pub const STUB: f64 = 0.25;

    /// Lengths of the stubs on the back and the front face \[m\]; 0 where the shaft does not go on.
    #[must_use]
    pub fn stub_lengths_m(&self) -> [f64; 2] {
        self.end_radii_m.map(|radius| 2.0 * Self::STUB * radius)
    }
}

/// Axial contour of hub and web.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contour {
    /// Back and front of the hub \[m\].
    pub hub_z_m: [f64; 2],
    /// Points from the hub to the rim, straight between them; at least two. Two at one radius are a step.
    pub web: Vec<ContourPoint>,
}

/// Back and front of the web at one radius.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContourPoint {
    /// Radius \[m\].
    pub radius_m: f64,
    /// Back and front \[m\].
    pub z_m: [f64; 2],
    /// Fillet radius of the corners of back and front there \[m\]; zero for sharp ones.
    pub fillet_radius_m: f64,
}

/// A gear that was meshed elsewhere.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct MeshedBody {
    /// The mesh file, any format that meshio reads.
    pub file: PathBuf,
    /// Unit of its coordinates.
    pub length_unit: LengthUnit,
    /// Name of the set of nodes or elements on the bore.
    pub bore_set: String,
    /// Names of the sets on the flanks, `{tooth}` and `{side}` standing for the tooth's number and `right` or `left`.
    pub flank_sets: String,
}

impl MeshedBody {
    /// Name of the set on a flank.
    pub fn flank_set(&self, tooth: usize, side: Flank) -> String {
        self.flank_sets
            .replace("{tooth}", &tooth.to_string())
            .replace("{side}", side.name())
    }
}

/// Unit of the coordinates in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema, Default)]
pub enum LengthUnit {
    /// Metres.
    #[serde(rename = "m")]
    Metre,
    /// Millimetres.
    #[default]
    #[serde(rename = "mm")]
    Millimetre,
}

impl LengthUnit {
    /// Name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Millimetre => "mm",
        }
    }
}

/// Hub and web of a thin-rimmed blank.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Web {
    /// Outer radius of the hub \[m\].
    pub hub_radius_m: f64,
    /// Inner radius of the rim \[m\].
    pub rim_inner_radius_m: f64,
    /// Web thickness \[m\].
    pub thickness_m: f64,
    /// Axial position of the web's mid-plane from mid-face \[m\].
    pub offset_m: f64,
}

/// Openings through the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Openings {
    /// Annular sectors.
    Slots(Slots),
    /// Round holes.
    Holes(Holes),
}

impl Openings {
    /// Number of equal openings round the axis.
    pub fn count(&self) -> usize {
        match self {
            Self::Slots(s) => s.count,
            Self::Holes(h) => h.count,
        }
    }

    /// Polar angle of the first opening's centre from tooth 0 \[rad\].
    pub fn phase_rad(&self) -> f64 {
        match self {
            Self::Slots(s) => s.phase_rad,
            Self::Holes(h) => h.phase_rad,
        }
    }

    /// Half of the angle that one opening covers \[rad\].
    pub fn half_width_rad(&self) -> f64 {
        match self {
            Self::Slots(s) => 0.5 * s.width_rad,
            Self::Holes(h) => (h.radius_m / h.pitch_radius_m).asin(),
        }
    }

    /// Innermost and outermost radius \[m\].
    pub fn radii_m(&self) -> (f64, f64) {
        match self {
            Self::Slots(s) => (s.inner_radius_m, s.outer_radius_m),
            Self::Holes(h) => (h.pitch_radius_m - h.radius_m, h.pitch_radius_m + h.radius_m),
        }
    }
}

/// Annular slots with radial flanks and rounded corners.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Slots {
    /// Number of slots.
    pub count: usize,
    /// Inner radius \[m\].
    pub inner_radius_m: f64,
    /// Outer radius \[m\].
    pub outer_radius_m: f64,
    /// Angle covered by one slot \[rad\].
    pub width_rad: f64,
    /// Polar angle of the first slot's centre from tooth 0 \[rad\].
    pub phase_rad: f64,
    /// Radius of the four corners \[m\].
    pub corner_radius_m: f64,
}

/// Round holes on a pitch circle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Holes {
    /// Number of holes.
    pub count: usize,
    /// Radius of the pitch circle \[m\].
    pub pitch_radius_m: f64,
    /// Radius of a hole \[m\].
    pub radius_m: f64,
    /// Polar angle of the first hole's centre from tooth 0 \[rad\].
    pub phase_rad: f64,
}
