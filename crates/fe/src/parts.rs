//! The parts that dense algebra is split into: always as many, so that results do not depend on the number of threads.

use faer::Par;

/// Parts of a large product, solve or factorisation. faer splits sums by the number of parts that it is told, and so
/// rounds them otherwise for each number; threads take one part after the other. More threads than this do not make a
/// factorisation faster.
pub const PARTS: usize = 8;

/// Lets all dense algebra of this process be split into [`PARTS`]. Called once by whoever promises results that are
/// the same to the last bit for any number of threads: the program and the Python module.
pub fn split_alike() {
    faer::set_global_parallelism(Par::rayon(PARTS));
}
