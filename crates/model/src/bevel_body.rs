//! What a reduced bevel gear has besides what every reduced gear has: which member of which pair it is, its flank at
//! the stations, and its near field, which changes along the tooth.

use crate::near_field::{ContactCurve, EdgeDistance};
use crate::record::Named;

/// A member of a bevel pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BevelMember {
    /// The member that the pair file names first, with fewer teeth or as many.
    #[default]
    Pinion,
    /// Its mate.
    Gear,
}

impl BevelMember {
    /// Place in lists of both members.
    pub const fn index(self) -> usize {
        match self {
            Self::Pinion => 0,
            Self::Gear => 1,
        }
    }
}

impl Named for BevelMember {
    const NAMES: &'static [(Self, &'static str)] =
        &[(Self::Pinion, "pinion"), (Self::Gear, "gear")];
}

/// Hand of spiral: teeth of a right hand turn counter-clockwise about the axis (apex to heel) from toe to heel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SpiralHand {
    /// Right.
    #[default]
    Right,
    /// Left.
    Left,
}

impl Named for SpiralHand {
    const NAMES: &'static [(Self, &'static str)] = &[(Self::Right, "right"), (Self::Left, "left")];
}

/// Parts of a reduced bevel gear.
///
/// Frame: origin in the pitch apex, z the axis towards the heel, the middle of tooth 0 on +x at the mean point. The
/// grid's `roll_angles_rad` are u, the share of the way up the flank (0 its lower line, 1 the tip, no unit), its `z_m`
/// are (s − ½)·face width, s the share of the way along the face (0 toe, 1 heel). With f flanks, U stations up the
/// flank and V along it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BevelBody {
    /// The pair file, word for word.
    pub pair_text: String,
    /// Member of the pair.
    pub member: BevelMember,
    /// Hand of its spiral.
    pub hand: SpiralHand,
    /// Pitch angle (rad).
    pub pitch_angle_rad: f64,
    /// Cone distances of toe and heel (m).
    pub cones_m: [f64; 2],
    /// Points of tooth 0's flanks at the stations (m), `[flank][u][v][axis]`.
    pub points_m: Vec<f64>,
    /// Unit normals there, into the material, `[flank][u][v][axis]`.
    pub normals: Vec<f64>,
    /// Area of the flank there per unit of s and u (m²), `[flank][u][v]`: |∂r/∂s × ∂r/∂u|.
    pub areas_m2: Vec<f64>,
    /// Calibration of the near field.
    pub near_field: Option<BevelNearField>,
}

/// The near field of a bevel tooth in sections normal to the tooth: as [`crate::NearField`], which see, for each flank
/// and section.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BevelNearField {
    /// Half width a₀ of the Hertz pressure (m).
    pub half_width_m: f64,
    /// Places of the sections along the tooth, (s − ½)·face width, increasing (m).
    pub sections_m: Vec<f64>,
    /// u of the places up the flank where c₀ is given, increasing, the same for all sections.
    pub profile: Vec<f64>,
    /// Length of the profile from the lower line to the tip in each section (m), `[flank][section]`.
    pub profile_length_m: Vec<f64>,
    /// c₀ (m²/N), `[flank][section][place]`.
    pub contact_m2_per_n: Vec<f64>,
    /// W (m²/N), `[flank][section][u station][u station]`.
    pub mesh_m2_per_n: Vec<f64>,
    /// Distance along the normal to the opposite side of the tooth (m), `[flank][section][u station]`.
    pub opposite_distance_m: Vec<f64>,
    /// Element length at the load of the finer of the two meshes from which c₀ was extrapolated (m).
    pub element_m: f64,
    /// Largest relative step from the finer mesh's c₀ to the extrapolated one.
    pub residual: f64,
}

impl BevelNearField {
    /// c₀ over u in a section.
    ///
    /// # Panics
    /// If there is no such flank or section.
    pub fn contact_curve(&self, flank_index: usize, section: usize) -> ContactCurve {
        let places = self.profile.len();
        let at = flank_index * self.sections_m.len() + section;
        ContactCurve::new(
            EdgeDistance::Share {
                length_m: self.profile_length_m[at],
            },
            self.half_width_m,
            &self.profile,
            &self.contact_m2_per_n[at * places..][..places],
        )
    }

    /// W of a section (m²/N), `[u station][u station]`.
    ///
    /// # Panics
    /// If there is no such flank or section.
    pub fn mesh_block(&self, flank_index: usize, section: usize, stations: usize) -> &[f64] {
        let size = stations * stations;
        &self.mesh_m2_per_n[(flank_index * self.sections_m.len() + section) * size..][..size]
    }
}
