//! Flanks that have been condensed to slices, each once: meshes of equal planets share them in memory.

use std::cell::RefCell;
use std::sync::Arc;

use gearmesh_model::{Flank, ReducedGear, ReducedGearError};

use crate::axial_spread::AxialSpread;
use crate::local_contact::LocalContact;
use crate::slice_compliance::SliceCompliance;

/// What tells one condensed flank from another.
type Key<'a> = (&'a ReducedGear, Flank, LocalContact, AxialSpread);

/// The flanks of models that live so long.
#[derive(Debug, Default)]
pub struct CondensedFlanks<'a>(RefCell<Vec<(Key<'a>, Arc<SliceCompliance>)>>);

impl<'a> CondensedFlanks<'a> {
    /// A flank of a gear on slices; condensed when it is asked for first.
    ///
    /// # Errors
    /// As [`SliceCompliance::on_slices`].
    pub fn on_slices(
        &self,
        gear: &'a ReducedGear,
        flank: Flank,
        local: LocalContact,
        spread: AxialSpread,
    ) -> Result<Arc<SliceCompliance>, ReducedGearError> {
        let mut known = self.0.borrow_mut();
        let found = known.iter().find(|((own, side, law, slices), _)| {
            std::ptr::eq(*own, gear) && (*side, *law) == (flank, local) && *slices == spread
        });
        if let Some((_, found)) = found {
            return Ok(Arc::clone(found));
        }
        let made = SliceCompliance::on_slices(gear, flank, local, &spread)?;
        let made = Arc::new(made);
        known.push(((gear, flank, local, spread), Arc::clone(&made)));
        Ok(made)
    }
}
