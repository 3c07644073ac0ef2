//! Where the slices of a static pair touch: what line load and pressure are drawn and exported over.

use super::run::LoadedScene;

/// Places of all slices, `[angle][line slot][slice]`; zeros where a slice does not touch.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ContactPlaces {
    /// Roll angle on gear 1 \[rad\]: diameter 2 r_b1 √(1 + ξ²).
    pub roll_1_rad: Vec<f64>,
    /// Axial place \[m\], from mid-face of gear 1.
    pub z_m: Vec<f64>,
    /// Touching width \[m\]: line load = force over it.
    pub width_m: Vec<f64>,
}

impl ContactPlaces {
    /// The places at driver angles.
    pub(super) fn new(loaded: &LoadedScene, angles_rad: &[f64], slots: usize) -> Self {
        let (slices, slice_width_m) = (loaded.layout.slices, loaded.layout.width_m());
        let empty = vec![0.0; angles_rad.len() * slots * slices];
        let mut places = Self {
            roll_1_rad: empty.clone(),
            z_m: empty.clone(),
            width_m: empty,
        };
        for (angle, &angle_rad) in angles_rad.iter().enumerate() {
            for patch in loaded.patches_at(angle_rad) {
                let at = (angle * slots + patch.line) * slices + patch.slice;
                places.roll_1_rad[at] = patch.places[0].u;
                places.z_m[at] = patch.places[0].v;
                places.width_m[at] = slice_width_m * patch.share;
            }
        }
        places
    }
}
