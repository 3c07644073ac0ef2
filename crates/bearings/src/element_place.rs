//! Where balls and rollers stand, for the next search of their equilibrium.

use nalgebra::Vector3;

use crate::element_search::ElementPlace;
use crate::row::Row;

/// Places of all elements of a bearing, row after row.
///
/// An evaluation that begins near the places of the one before needs fewer iterations; its result is the same within
/// rounding.
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

    /// Takes the places of another list of the same bearing; without new memory.
    pub(crate) fn take_from(&mut self, other: &Self) {
        for (own, other) in self.rows.iter_mut().zip(&other.rows) {
            own.copy_from_slice(other);
        }
    }

    /// Appends what is known: of each element 1 and its place, or 0 and zeros.
    pub(crate) fn save(&self, out: &mut Vec<f64>) {
        for place in self.rows.iter().flatten() {
            let known = f64::from(u8::from(place.is_some()));
            let place = place.unwrap_or_default();
            out.extend([known, place[0], place[1], place[2]]);
        }
    }

    /// Takes what [`Self::save`] wrote; of shorter lists the rest is unknown.
    pub(crate) fn restore(&mut self, numbers: &[f64]) {
        self.forget();
        let places = self.rows.iter_mut().flatten();
        for (place, saved) in places.zip(numbers.chunks_exact(4)) {
            *place = (saved[0] > 0.0).then(|| Vector3::new(saved[1], saved[2], saved[3]));
        }
    }

    pub(crate) fn rows(&mut self) -> impl Iterator<Item = &mut [ElementPlace]> {
        self.rows.iter_mut().map(Vec::as_mut_slice)
    }
}
