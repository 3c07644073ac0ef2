//! How much an import looks at: components, attributes, references of relations, and places of shafts and gears in
//! their lists. Counted on the importing thread, so that the work is known whatever the machine does beside.

use std::cell::Cell;

thread_local! {
    static VISITS: Cell<u64> = const { Cell::new(0) };
}

/// Counts so many looks.
pub(crate) fn visited(count: usize) {
    VISITS.set(VISITS.get() + count as u64);
}

/// Counts what an iteration yields.
pub(crate) fn each<I: Iterator>(items: I) -> impl Iterator<Item = I::Item> {
    items.inspect(|_| visited(1))
}

/// Looks since the thread began.
pub(crate) fn visits() -> u64 {
    VISITS.get()
}
