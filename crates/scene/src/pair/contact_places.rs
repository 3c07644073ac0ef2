//! Where the slices of a static pair touch: what line load and pressure are drawn and exported over.

use super::run::LoadedScene;

/// Where a patch touches, in the order of [`ContactPlaces::columns`].
pub(super) type PatchPlace = [f64; COLUMNS];

/// Numbers of a place.
const COLUMNS: usize = 7;

/// Places of all slices, `[position][line slot][slice]`; zeros where a slice does not touch.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ContactPlaces {
    /// Roll angle on gear 1 \[rad\]: diameter 2 r_b1 √(1 + ξ²). Of bevel gears the share of the way up the flank.
    pub roll_1_rad: Vec<f64>,
    /// Axial place \[m\], from mid-face of gear 1.
    pub z_m: Vec<f64>,
    /// Touching width \[m\]: line load = force over it. Of bevel gears along the line of contact.
    pub width_m: Vec<f64>,
    /// Bevel gears, else empty: share of the way up the flank of gear 2.
    pub roll_2_rad: Vec<f64>,
    /// Bevel gears, else empty: axial place from mid-face of gear 2 \[m\].
    pub z_2_m: Vec<f64>,
    /// Bevel gears, else empty: sliding speed of the flanks over the pinion's speed \[m/rad\].
    pub sliding_m: Vec<f64>,
    /// Bevel gears, else empty: how far from its middle the nearer tip of both gears is \[m\], up the flank.
    pub to_tip_m: Vec<f64>,
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
            ..Self::default()
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

    /// All numbers of the places, those of gear 1 first.
    fn columns(&mut self) -> [&mut Vec<f64>; COLUMNS] {
        [
            &mut self.roll_1_rad,
            &mut self.z_m,
            &mut self.width_m,
            &mut self.roll_2_rad,
            &mut self.z_2_m,
            &mut self.sliding_m,
            &mut self.to_tip_m,
        ]
    }

    /// Adds the places of a position, `[line][slice]`, up to `size` of them.
    pub(super) fn push(&mut self, of: impl Iterator<Item = PatchPlace>, size: usize) {
        let all = of.chain(std::iter::repeat([0.0; COLUMNS])).take(size);
        for place in all {
            self.columns()
                .into_iter()
                .zip(place)
                .for_each(|(c, x)| c.push(x));
        }
    }
}
