//! A patch: one slice of a contact line, where two flanks touch or may touch. All that a contact problem needs to know
//! of them.
//!
//! Kinematics of flanks make patches, whatever the family of the gears: [`crate::ContactLines`] those of involute teeth
//! at rest, the gear meshes of a multibody system those of a pose. What follows asks no more where they come from.

/// A place on a flank by the coordinates of its grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankPlace {
    /// Along the profile, as the grid counts it; on an involute flank the roll angle \[rad\].
    pub u: f64,
    /// Along the tooth, as the grid counts it; on an involute flank the height above mid-face \[m\].
    pub v: f64,
}

/// An edge of one flank that presses on the other flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatchEdge {
    /// Gear whose edge it is, 0 or 1.
    pub gear: usize,
    /// Turn of the contact's normal from that flank's own normal towards its tip \[rad\].
    pub tilt_rad: f64,
    /// Relative radius of the rounded edge and the other flank \[m\].
    pub radius_m: f64,
}

/// How a patch takes part in the motion and the balance of the two gears.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatchBalance {
    /// How fast the gap closes with the approach of the gears. No unit.
    pub closing: f64,
    /// Load on gear 1 and on gear 2 for each newton of the normal force: torque about their axes \[m\], friction
    /// included.
    pub levers_m: [f64; 2],
    /// Friction over normal force, positive towards the tips of both gears.
    pub friction: f64,
}

impl PatchBalance {
    /// The approach is that along the normals and the load the sum of the normal forces: where the pose of the gears is
    /// given, and their balance is somebody else's affair.
    pub const ALONG_NORMALS: Self = Self {
        closing: 1.0,
        levers_m: [1.0; 2],
        friction: 0.0,
    };
}

/// One slice of a contact line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPatch {
    /// Teeth of gear 1 and gear 2.
    pub teeth: [usize; 2],
    /// Number of its contact line.
    pub line: usize,
    /// Number of the slice along the teeth.
    pub slice: usize,
    /// Places on the flanks of gear 1 and gear 2.
    pub places: [FlankPlace; 2],
    /// Share of the slice that touches, more than zero: one but where the line ends in the slice or the contact zone
    /// has changed its width.
    pub share: f64,
    /// Length of the touching part along the contact line \[m\].
    pub length_m: f64,
    /// Relative radius of curvature across the contact line \[m\]: 1/ρ = 1/ρ₁ + 1/ρ₂ in the plane normal to the line.
    pub radius_m: f64,
    /// ∂(ln ρ)/∂u on gear 1 and gear 2.
    pub radius_growth: [f64; 2],
    /// ∂(ln length)/∂u on gear 1 and gear 2, besides what the share says: where the line's slant against the slices
    /// changes.
    pub length_growth: [f64; 2],
    /// Unit normal: direction of the force on gear 2, in the frame of the kinematics, whose z is gear 1's axis.
    pub normal: [f64; 3],
    /// Gap along the normal \[m\], open positive, where the approach is zero.
    pub gap_m: f64,
    /// Motion and balance.
    pub balance: PatchBalance,
    /// The edge that touches, if it is one.
    pub edge: Option<PatchEdge>,
}

impl ContactPatch {
    /// Turn of the normal from the flank normal of gear 0 or 1 towards the tip \[rad\]: zero but for an edge.
    #[must_use]
    pub fn tilt_rad(&self, gear: usize) -> f64 {
        (self.edge.filter(|edge| edge.gear == gear)).map_or(0.0, |edge| edge.tilt_rad)
    }

    /// Normal and friction force on the tooth of gear 0 or 1 in the frame of its own flank, over the normal force:
    /// components along the inward normal and towards the tip. (1, μ), but for an edge, which feels them turned by its
    /// tilt δ: (cos δ − μ sin δ, sin δ + μ cos δ).
    #[must_use]
    pub fn force_components(&self, gear: usize) -> [f64; 2] {
        let (sin, cos) = self.tilt_rad(gear).sin_cos();
        let friction = self.balance.friction;
        [cos - friction * sin, sin + friction * cos]
    }

    /// Whether another patch stands at the same place of the profiles and presses alike.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        let of = |patch: &Self| {
            let [on_1, on_2] = patch.places;
            (on_1.u, on_2.u, patch.share, patch.length_m, patch.radius_m)
        };
        self.teeth == other.teeth && of(self) == of(other) && self.edge == other.edge
    }
}
