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

    pub(crate) fn rows(&mut self) -> impl Iterator<Item = &mut [ElementPlace]> {
        self.rows.iter_mut().map(Vec::as_mut_slice)
    }
}
