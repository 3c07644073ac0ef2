//! One member of a bevel pair as a body: its teeth, the blank below them, material, mesh and what is computed of it.

use gearmesh_geometry::{Flank, HubSupport, Material, MeshSettings, ModeRange, ReductionSettings};

use crate::blank::MemberBlank;
use crate::flank_patch::FlankPatch;
use crate::hand::FlankSide;
use crate::pair_file::PairFile;
use crate::tooth::Tooth;

/// A bevel gear to be meshed and reduced. SI units; the member's frame: origin in the pitch apex, z towards the heel.
#[derive(Debug, Clone)]
pub struct BevelGear {
    /// Name in prints and files.
    pub name: String,
    /// The pair.
    pub pair: PairFile,
    /// Its file, word for word.
    pub pair_text: String,
    /// 0 pinion, 1 gear.
    pub member: usize,
    /// The member's tooth.
    pub tooth: Tooth,
    /// The mate's blank.
    pub mate: MemberBlank,
    /// The body below the teeth.
    pub body: BevelBlank,
    /// Material.
    pub material: Material,
    /// Element and element lengths; `axial_m` runs along the pitch cone.
    pub mesh: MeshSettings,
    /// What the reduction computes.
    pub reduction: ReductionSettings,
    /// How the bore is held.
    pub hub: HubSupport,
    /// Natural modes to be found; none where not asked for.
    pub modes: Option<ModeRange>,
    /// Strain gauges.
    pub gauges: Vec<BevelGauge>,
    /// The gear file, word for word.
    pub source: String,
}

/// The body below the teeth by its meridian: two lines from the rim to the bore, one on the toe's side and one on the
/// heel's.
#[derive(Debug, Clone, PartialEq)]
pub struct BevelBlank {
    /// Bore \[m\].
    pub bore_radius_m: f64,
    /// How far the cones of toe and heel go on below the teeth's roots \[m\].
    pub rim_m: f64,
    /// From the rim to the bore: radius, z on the toe's and on the heel's side \[m\]. The last one is the bore.
    pub contour: Vec<BevelContourPoint>,
}

/// A place of both lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BevelContourPoint {
    /// Radius \[m\].
    pub radius_m: f64,
    /// z on the toe's side and on the heel's side, from the pitch apex \[m\].
    pub z_m: [f64; 2],
}

/// A strain gauge in a tooth root.
#[derive(Debug, Clone, PartialEq)]
pub struct BevelGauge {
    /// Name.
    pub name: String,
    /// Tooth.
    pub tooth: usize,
    /// Side of the tooth.
    pub side: Flank,
    /// Angle between the fillet's tangent and the tooth's centre line in the section normal to the tooth \[rad\].
    pub tangent_rad: f64,
    /// Length along the profile \[m\].
    pub length_m: f64,
    /// Middle along the pitch cone, from mid-face towards the heel \[m\].
    pub along_m: f64,
    /// Width along the tooth \[m\].
    pub width_m: f64,
}

impl BevelGear {
    /// The member's blank.
    pub fn blank(&self) -> &MemberBlank {
        &self.tooth.blank
    }

    /// Which side of the tooth faces clockwise (right) or counter-clockwise (left).
    pub fn flank_side(&self, flank: Flank) -> FlankSide {
        let facing = match flank {
            Flank::Right => -1.0,
            Flank::Left => 1.0,
        };
        let concave = FlankSide::Concave.facing(self.blank().hand) == facing;
        if concave {
            FlankSide::Concave
        } else {
            FlankSide::Convex
        }
    }

    /// The flank as a patch.
    ///
    /// # Errors
    /// As [`FlankPatch::of_tooth`].
    pub fn patch(&self, flank: Flank) -> Result<FlankPatch, crate::BevelError> {
        FlankPatch::of_tooth(&self.tooth, &self.mate, self.flank_side(flank))
    }

    /// Transverse module in the middle of the face \[m\]: what element lengths are in proportion to.
    pub fn mean_module_m(&self) -> f64 {
        let blank = self.blank();
        2.0 * blank.mean_cone_m * blank.pitch_angle_rad.sin() / blank.teeth as f64
    }
}
