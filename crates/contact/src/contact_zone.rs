//! Where the faces of two gears overlap along their axes, and the slices that are laid over it.
//!
//! s runs along the axes from halfway between the two mid-faces, D is the place of gear 2's mid-face seen from gear
//! 1's. A section at s lies on the gears at z₁ = s + D/2 and z₂ = s − D/2 of their own mid-faces, and the faces overlap
//! in
//!
//! ```text
//! max(−b₁/2 − D/2, −b₂/2 + D/2) < s < min(b₁/2 − D/2, b₂/2 + D/2)
//! ```
//!
//! Exchanging the gears changes the sign of D and nothing else. Over the last micrometre before the ends of both faces
//! meet, the larger one is taken smoothly: |x| = 2x²/ε − |x|³/ε², ε = 1 µm, which is exact at 0 and from ε on, with its
//! slope.

use gearmesh_model::ReducedGear;

use crate::axial_spread::AxialSpread;
use crate::contact_error::ContactError;

/// ε \[m\]: small against any edge of a tooth.
const ROUNDING_M: f64 = 1e-6;

/// The overlap of two faces at an axial displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactZone {
    /// D: gear 2's mid-face from gear 1's along the axes \[m\].
    pub displacement_m: f64,
    /// Middle of the zone from halfway between the mid-faces \[m\].
    pub middle_m: f64,
    /// Its width \[m\]; zero or negative where the gears stand side by side.
    pub width_m: f64,
    /// ∂(middle)/∂D.
    pub middle_by_displacement: f64,
    /// ∂(width)/∂D.
    pub width_by_displacement: f64,
}

impl ContactZone {
    /// The overlap of faces of these widths \[m\].
    #[must_use]
    pub fn new(widths_m: [f64; 2], displacement_m: f64) -> Self {
        let [half_1, half_2] = widths_m.map(|width| 0.5 * width);
        let shift = 0.5 * displacement_m;
        // Ends of gear 1's face and of gear 2's.
        let (low, low_rate) = larger(-half_1 - shift, -half_2 + shift);
        let (minus_high, minus_high_rate) = larger(-half_1 + shift, -half_2 - shift);
        Self {
            displacement_m,
            middle_m: 0.5 * (low - minus_high),
            width_m: -minus_high - low,
            // The first end falls by half of what D grows by, the second rises: x changes by −D and D.
            middle_by_displacement: -0.25 * (low_rate + minus_high_rate),
            width_by_displacement: 0.5 * (low_rate - minus_high_rate),
        }
    }

    /// Two gears of one width that do not stand displaced.
    #[must_use]
    pub fn of_equal_faces(width_m: f64) -> Self {
        Self::new([width_m; 2], 0.0)
    }

    /// Places on gear 1 and gear 2 of a section, from their own mid-faces \[m\].
    #[must_use]
    pub fn heights_m(&self, section_m: f64) -> [f64; 2] {
        let shift = 0.5 * self.displacement_m;
        [section_m + shift, section_m - shift]
    }

    /// Farthest section of the zone from halfway between the mid-faces \[m\].
    #[must_use]
    pub fn reach_m(&self) -> f64 {
        self.middle_m.abs() + 0.5 * self.width_m.max(0.0)
    }

    /// Middle of one of `slices` even slices \[m\].
    #[must_use]
    pub fn slice_centre_m(&self, slice: usize, slices: usize) -> f64 {
        self.middle_m + slice_place(slice, slices) * self.width_m
    }
}

/// Place of a slice's middle in the zone, from −½ to ½.
#[must_use]
pub fn slice_place(slice: usize, slices: usize) -> f64 {
    (slice as f64 + 0.5) / slices as f64 - 0.5
}

/// The larger of two ends, and the derivative of |x| with its rounding, x = a − b.
fn larger(a: f64, b: f64) -> (f64, f64) {
    let x = a - b;
    let size = x.abs();
    let (rounded, slope) = if size < ROUNDING_M {
        let u = size / ROUNDING_M;
        (size * u * (2.0 - u), u * (4.0 - 3.0 * u))
    } else {
        (size, 1.0)
    };
    let sense = if x < 0.0 { -1.0 } else { 1.0 };
    (0.5 * (a + b) + 0.5 * rounded, sense * slope)
}

/// Even slices over the contact zone of two gears. Their compliance is that of the places where they lie at the
/// reference displacement; when the gears move along their axes the slices move with the zone and grow or shrink with
/// it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SliceLayout {
    /// Face widths \[m\].
    pub face_widths_m: [f64; 2],
    /// The zone at the reference displacement.
    pub reference: ContactZone,
    /// Number of slices.
    pub slices: usize,
}

impl SliceLayout {
    /// So many slices over faces of these widths that stand displaced by `displacement_m`.
    #[must_use]
    pub fn new(face_widths_m: [f64; 2], displacement_m: f64, slices: usize) -> Self {
        Self {
            face_widths_m,
            reference: ContactZone::new(face_widths_m, displacement_m),
            slices,
        }
    }

    /// The slices of two models: as wide as those of the coarser one, or nearly, so that a whole number of them fills
    /// the zone. Models of one width and number of slices, not displaced, keep theirs.
    #[must_use]
    pub fn of_models(models: [&ReducedGear; 2], displacement_m: f64) -> Self {
        let widths = models.map(|model| model.face_width_m);
        let coarser = models
            .map(ReducedGear::slice_width_m)
            .into_iter()
            .fold(0.0, f64::max);
        let zone = ContactZone::new(widths, displacement_m);
        let slices = (zone.width_m / coarser).round().max(1.0) as usize;
        Self::new(widths, displacement_m, slices)
    }

    /// So many slices of two models, or [`Self::of_models`] where no number is given. A model knows the compliance at
    /// its stations along the tooth, two to each of its own slices: slices narrower than the spacing of the coarser
    /// model's would stand on stations that they share.
    ///
    /// # Errors
    /// [`ContactError::Apart`], and [`ContactError::Slices`] for none or more than the models resolve.
    pub fn resolved(
        models: [&ReducedGear; 2],
        displacement_m: f64,
        slices: Option<usize>,
    ) -> Result<Self, ContactError> {
        let own = Self::of_models(models, displacement_m);
        own.check()?;
        let Some(slices) = slices else {
            return Ok(own);
        };
        let spacing = |model: &ReducedGear| 0.5 * model.slice_width_m();
        let coarser = spacing(models[0]).max(spacing(models[1]));
        // Rounding must not take a slice away where whole numbers fit.
        let most = (own.reference.width_m / coarser * (1.0 + 1e-9))
            .floor()
            .max(1.0) as usize;
        if !(1..=most).contains(&slices) {
            return Err(ContactError::Slices {
                found: slices,
                most,
            });
        }
        Ok(Self { slices, ..own })
    }

    /// Width of a slice at the reference \[m\].
    #[must_use]
    pub fn width_m(&self) -> f64 {
        self.reference.width_m / self.slices as f64
    }

    /// Middles of the slices at the reference, from halfway between the mid-faces \[m\].
    #[must_use]
    pub fn centres_m(&self) -> Vec<f64> {
        (0..self.slices)
            .map(|slice| self.reference.slice_centre_m(slice, self.slices))
            .collect()
    }

    /// Where the slices' forces sit on the model of gear 1 or 2.
    #[must_use]
    pub fn spread(&self, gear: usize, model: &ReducedGear) -> AxialSpread {
        let centres = self.centres_m();
        let heights = (centres.iter()).map(|centre| self.reference.heights_m(*centre));
        let on_gear = heights.map(|[on_1, on_2]| if gear == 1 { on_1 } else { on_2 });
        AxialSpread::new(model, on_gear, self.width_m())
    }

    /// Refuses faces that do not overlap.
    ///
    /// # Errors
    /// [`ContactError::Apart`].
    pub fn check(&self) -> Result<(), ContactError> {
        if self.reference.width_m > 0.0 {
            return Ok(());
        }
        Err(ContactError::Apart {
            displacement_mm: self.reference.displacement_m * 1e3,
            widths_mm: self.face_widths_m.map(|width| width * 1e3),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Faces of 20 and 14 mm: inside, over one end, side by side; exact but within a micrometre of the change.
    #[test]
    fn the_zone_is_the_overlap() {
        for (displacement, low, high) in [
            (0.0, -7e-3, 7e-3),
            (1e-3, -6.5e-3, 7.5e-3),
            (5e-3, -4.5e-3, 7.5e-3),
            (-5e-3, -7.5e-3, 4.5e-3),
            (18e-3, 2e-3, 1e-3),
        ] {
            let zone = ContactZone::new([20e-3, 14e-3], displacement);
            let exchanged = ContactZone::new([14e-3, 20e-3], -displacement);
            assert!(
                (zone.middle_m - 0.5 * (low + high)).abs() < 1e-17,
                "{zone:?}"
            );
            assert!((zone.width_m - (high - low)).abs() < 1e-17, "{zone:?}");
            assert!((zone.middle_m - exchanged.middle_m).abs() < 1e-18);
            assert!((zone.width_m - exchanged.width_m).abs() < 1e-18);
        }
    }

    #[test]
    fn rates_are_the_derivatives() {
        for widths in [[20e-3, 14e-3], [14e-3, 20e-3], [20e-3, 20e-3]] {
            for displacement in [0.0, 3e-7, -3e-7, 2e-6, 2e-3, 3e-3, 3.0004e-3, -5e-3] {
                let h = 1e-10;
                let at = |d: f64| ContactZone::new(widths, d);
                let (low, high) = (at(displacement - h), at(displacement + h));
                let zone = at(displacement);
                let middle = (high.middle_m - low.middle_m) / (2.0 * h);
                let width = (high.width_m - low.width_m) / (2.0 * h);
                assert!(
                    (middle - zone.middle_by_displacement).abs() < 1e-3,
                    "{zone:?} {middle}"
                );
                assert!(
                    (width - zone.width_by_displacement).abs() < 1e-3,
                    "{zone:?} {width}"
                );
            }
        }
        let equal = ContactZone::of_equal_faces(20e-3);
        assert_eq!((equal.middle_m, equal.width_m), (0.0, 20e-3));
        assert_eq!(equal.width_by_displacement, 0.0);
    }
}
