//! Where balls and rollers stand, for the next search of their equilibrium.

use nalgebra::Vector3;

use crate::quasi_static::Row;

/// Place of a ball (r, z, 0) or roller (r, z, tilt) at which it bears load \[m, rad\]; none for a loose one, whose place is not determined.
pub(crate) type ElementPlace = Option<Vector3<f64>>;

/// Places of all elements of a bearing, row after row.
///
/// An evaluation that begins near the places of the one before needs fewer iterations; its result is the same within rounding.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementPlaces {
    rows: Vec<Vec<ElementPlace>>,
}

impl ElementPlaces {
    /// Nothing known: every search begins from the ring's place alone.
    #[must_use]
    pub fn unknown(rows: &[Row]) -> Self {
        let rows = rows.iter().map(|row| vec![None; row.elements()]).collect();
        Self { rows }
    }

    /// Forgets all places.
    pub fn forget(&mut self) {
        for row in &mut self.rows {
            row.fill(None);
        }
    }

    /// Takes the places of another one of the same bearing; without new memory.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        for (row, other) in self.rows.iter_mut().zip(&other.rows) {
            row.copy_from_slice(other);
        }
    }

    /// Appends all places as plain numbers, four for each element, the first of them 0 for a loose one.
    pub(crate) fn save(&self, out: &mut Vec<f64>) {
        for place in self.rows.iter().flatten() {
            let known = f64::from(u8::from(place.is_some()));
            let [r, z, tilt] = place.unwrap_or_default().into();
            out.extend([known, r, z, tilt]);
        }
    }

    /// Takes what [`Self::save`] wrote.
    pub(crate) fn restore(&mut self, numbers: &[f64]) {
        let places = self.rows.iter_mut().flatten();
        for (place, numbers) in places.zip(numbers.chunks_exact(4)) {
            *place = (numbers[0] != 0.0).then(|| Vector3::new(numbers[1], numbers[2], numbers[3]));
        }
    }

    pub(crate) fn rows(&mut self) -> impl Iterator<Item = &mut [ElementPlace]> {
        self.rows.iter_mut().map(Vec::as_mut_slice)
    }
}
