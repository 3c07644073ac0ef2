//! What a gear is: the validated definition, in SI units. The defaults of its parts are empty records to be filled, no
//! gears.

use gearmesh_elements::Element;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::blank::Blank;
pub use crate::flank::Flank;
use crate::microgeometry::GearMicrogeometry;
use crate::tooth::ToothGeometry;
pub use crate::tooth_definition::{Gearing, InternalRoot, PinionCutter, ToothDefinition};

/// Linear elastic, isotropic.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Material {
    /// Young's modulus \[Pa\].
    pub young_pa: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Density \[kg/m³\], where given.
    pub density_kg_per_m3: Option<f64>,
}

/// Which natural modes are computed, from the lowest on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ModeRange {
    /// So many; one more where that would part a pair of equal frequencies.
    Count(usize),
    /// All up to this frequency \[Hz\].
    UpToHz(f64),
}

/// None, for a record that is still to be filled.
impl Default for ModeRange {
    fn default() -> Self {
        Self::Count(0)
    }
}

/// How the bore is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HubSupport {
    /// Fixed.
    #[default]
    Fixed,
    /// Rigid, on a reference point with six degrees of freedom, on the axis at mid-face.
    ReferencePoint,
}

/// Element sizes and the quality that the mesh must reach.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MeshSettings {
    /// Element.
    pub element: Element,
    /// Why tetrahedra were chosen, where the definition leaves the choice.
    pub chosen_because: Option<&'static str>,
    /// Element length along the flank \[m\].
    pub flank_m: f64,
    /// Element length along the root fillet \[m\].
    pub fillet_m: f64,
    /// Largest element length in the body \[m\].
    pub body_m: f64,
    /// Element length along the axis \[m\].
    pub axial_m: f64,
    /// Smallest scaled Jacobian that is accepted.
    pub min_scaled_jacobian: f64,
    /// The cross-section only: one layer that does not move along the axis.
    pub plane_strain: bool,
}

impl MeshSettings {
    /// The element lengths where a gear file gives none, in the unit of module and face width: along flank and fillet,
    /// in the body, along the axis.
    pub fn default_lengths(element: Element, module: f64, face_width: f64) -> [f64; 4] {
        // Of linear bricks the fillets decide the error of root strain: 1 % on 0.08 modules, 0.5 % on 0.05. Quadratic
        // tetrahedra on twice the lengths have about as many nodes as bricks of eight nodes.
        let (coarser, fillet) = match element {
            Element::Tet10 => (2.0, 0.08),
            Element::Hex20 => (1.0, 0.08),
            _ => (1.0, 0.05),
        };
        [
            coarser * 0.3 * module,
            coarser * fillet * module,
            coarser * 1.2 * module,
            coarser * face_width / 10.0,
        ]
    }
}

/// Whether the repetition of the gear is used to solve it. The numbers are the same to rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Symmetry {
    /// One tooth and one sector are factorised, and the ring of sectors by its harmonics.
    #[default]
    Auto,
    /// The whole gear is factorised: for comparison.
    Off,
}

/// What the reduction computes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReductionSettings {
    /// Whether the repetition of the gear is used.
    pub symmetry: Symmetry,
    /// Stations of the flank grid along the profile.
    pub roll_stations: usize,
    /// Slices over the face width.
    pub slices: usize,
    /// Flanks that carry loads.
    pub flanks: Vec<Flank>,
    /// Motions of the bore, where they are asked for.
    pub bore: Option<BoreMotions>,
}

/// Motions that the bore of a body is given, so that it can slide on its pin or be carried by rollers: radial,
/// tangential and axial, harmonics around and polynomials along.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct BoreMotions {
    /// Highest harmonic around.
    pub harmonics: usize,
    /// Polynomials along the bore: 1 constant, 2 linear, too, and so on.
    pub along: usize,
}

/// Where a gauge sits on the root fillet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RootPosition {
    /// Where the profile tangent makes this angle with the tooth's centre line \[rad\].
    TangentAngle(f64),
    /// Where the profile has this radius \[m\].
    Radius(f64),
}

/// The fillet's 30° tangent, where roots are strained most.
impl Default for RootPosition {
    fn default() -> Self {
        Self::TangentAngle(std::f64::consts::FRAC_PI_6)
    }
}

/// A strain gauge on the surface of a tooth root, reading along the profile.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GaugeDefinition {
    /// Name in prints and files.
    pub name: String,
    /// Tooth.
    pub tooth: usize,
    /// Side of the tooth.
    pub side: Flank,
    /// Centre of the gauge on the profile.
    pub position: RootPosition,
    /// Length along the profile \[m\].
    pub length_m: f64,
    /// Axial centre from mid-face \[m\].
    pub z_m: f64,
    /// Width along the axis \[m\].
    pub width_m: f64,
}

/// A crack from the root fillet into one tooth, over the whole face width.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CrackDefinition {
    /// Tooth.
    pub tooth: usize,
    /// Side of the tooth on which it opens.
    pub side: Flank,
    /// Its mouth on the profile.
    pub start: RootPosition,
    /// Depth \[m\].
    pub depth_m: f64,
    /// Angle to the tooth's centre line \[rad\]: 0 runs towards the centre of the gear, π/2 straight across.
    pub angle_rad: f64,
}

/// A gear that has been read, checked and found possible.
#[derive(Debug, Clone, PartialEq)]
pub struct GearDefinition {
    /// Name in prints and files.
    pub name: String,
    /// Teeth.
    pub tooth: ToothDefinition,
    /// Body.
    pub blank: Blank,
    /// Material.
    pub material: Material,
    /// Microgeometry of right and left flanks, as the gear file states it; a scene may state another.
    pub microgeometry: GearMicrogeometry,
    /// Mesh.
    pub mesh: MeshSettings,
    /// Reduction.
    pub reduction: ReductionSettings,
    /// Natural modes, where asked for.
    pub modes: Option<ModeRange>,
    /// How the bore is held.
    pub hub: HubSupport,
    /// Gauges.
    pub gauges: Vec<GaugeDefinition>,
    /// Crack in a tooth's root, where there is one.
    pub crack: Option<CrackDefinition>,
    /// The profile that follows from `tooth`.
    pub profile: ToothGeometry,
    /// The file's text, verbatim.
    pub source: String,
}

impl GearDefinition {
    /// Number of equal sectors that the gear repeats in: gcd of teeth and openings or lugs, or the number of teeth;
    /// one for a gear that was meshed elsewhere.
    pub fn sectors(&self) -> usize {
        let z = self.tooth.teeth;
        // Nothing is known of how a mesh from elsewhere repeats.
        if self.blank.meshed().is_some() {
            return 1;
        }
        let lugs = self.blank.rim().and_then(|rim| rim.lugs);
        let repeats = (self.blank.openings().map(|o| o.count())).or(lugs.map(|lugs| lugs.count));
        repeats.map_or(z, |count| greatest_common_divisor(z, count))
    }
}

/// Greatest common divisor; the other number where one is zero.
pub fn greatest_common_divisor(a: usize, b: usize) -> usize {
    if b == 0 {
        a
    } else {
        greatest_common_divisor(b, a % b)
    }
}
