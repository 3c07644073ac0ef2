//! What a cylindrical gear is: teeth, rack, blank, flanks.

use crate::material::Material;

/// A cylindrical gear.
#[derive(Debug, Clone)]
pub struct Gear {
    /// Component.
    pub id: i64,
    /// Name in the scene.
    pub name: String,
    /// File.
    pub file: String,
    /// Teeth; of a ring without sign.
    pub teeth: u32,
    /// Whether it is a ring with internal teeth. Its diameters have no sign, its profile shift is positive towards the
    /// tip.
    pub internal: bool,
    /// Normal module \[mm\].
    pub module_mm: f64,
    /// Normal pressure angle \[°\].
    pub pressure_angle_deg: f64,
    /// Helix angle at the reference circle \[°\], positive for a right hand.
    pub helix_deg: f64,
    /// Profile shift coefficient.
    pub profile_shift: f64,
    /// Face width \[mm\].
    pub face_width_mm: f64,
    /// Tip diameter \[mm\], where stated and sound, or from the stage.
    pub tip_diameter_mm: Option<f64>,
    /// Addendum of the basic rack in modules.
    pub addendum: f64,
    /// Dedendum in modules.
    pub dedendum: f64,
    /// Tip radius of the rack in modules.
    pub rack_tip_radius: f64,
    /// Reduction of the transverse tooth thickness \[mm\].
    pub thickness_allowance_mm: f64,
    /// Tip chamfer \[mm\].
    pub tip_chamfer_mm: f64,
    /// Bore \[mm\], 0 of a gear that is cut into its shaft; none until the shaft is known. Outer diameter of a ring.
    pub bore_mm: Option<f64>,
    /// Diameters of the shaft at the back and the front face of a gear that is cut into it, 0 where it does not go on
    /// \[mm\].
    pub shaft_mm: Option<[f64; 2]>,
    /// Material.
    pub material: Material,
    /// Modifications of left and right flanks, read once it is known which way the shaft points.
    pub microgeometry: Microgeometry,
}

impl Gear {
    /// −1 of a ring: the sign of its diameters and teeth after ISO 21771.
    pub fn sign(&self) -> f64 {
        if self.internal { -1.0 } else { 1.0 }
    }

    /// Transverse reference diameter \[mm\].
    pub fn reference_diameter_mm(&self) -> f64 {
        self.module_mm * f64::from(self.teeth) / self.helix_deg.to_radians().cos()
    }

    /// Root diameter \[mm\].
    pub fn root_diameter_mm(&self) -> f64 {
        self.reference_diameter_mm()
            - self.sign() * 2.0 * self.module_mm * (self.dedendum - self.profile_shift)
    }

    /// Base diameter \[mm\].
    pub fn base_diameter_mm(&self) -> f64 {
        let cos = self.helix_deg.to_radians().cos();
        let transverse = (self.pressure_angle_deg.to_radians().tan() / cos).atan();
        self.reference_diameter_mm() * transverse.cos()
    }

    /// Tip diameter \[mm\].
    pub fn tip_mm(&self) -> f64 {
        let rack = self.reference_diameter_mm()
            + self.sign() * 2.0 * self.module_mm * (self.addendum + self.profile_shift);
        self.tip_diameter_mm.unwrap_or(rack)
    }
}

/// Keys of `[microgeometry]` and their values, of left and right flanks.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Microgeometry {
    /// Left flanks.
    pub left: Vec<(String, String)>,
    /// Right flanks.
    pub right: Vec<(String, String)>,
}

impl Microgeometry {
    /// Nothing is modified.
    pub fn is_empty(&self) -> bool {
        self.left.is_empty() && self.right.is_empty()
    }
}
