//! How often each effect was asked: what is not named must cost nothing.

use std::sync::atomic::{AtomicU64, Ordering};

/// Counts of evaluations; shared with the element, which adds to them.
#[derive(Debug, Default)]
pub struct BearingEffort {
    /// Places of a ball against a race that were looked at.
    pub races: AtomicU64,
    /// Contacts of a ball and a race that bore a load.
    pub contacts: AtomicU64,
    /// Evaluations of the traction law.
    pub tractions: AtomicU64,
    /// Places of a ball in a pocket that were looked at.
    pub pockets: AtomicU64,
}

impl BearingEffort {
    /// The counts: races, contacts, tractions, pockets.
    #[must_use]
    pub fn counts(&self) -> [u64; 4] {
        [&self.races, &self.contacts, &self.tractions, &self.pockets]
            .map(|count| count.load(Ordering::Relaxed))
    }
}

/// One more.
pub(crate) fn count(counter: &AtomicU64) {
    counter.fetch_add(1, Ordering::Relaxed);
}
