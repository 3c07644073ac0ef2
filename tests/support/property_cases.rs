//! How many cases a property test tries. A test program takes it in with
//! `#[path = "…/tests/support/property_cases.rs"] mod property_cases;`.
//!
//! Ordinarily few, from a fixed seed, so that every run tries the same. `GEARMESH_PROPERTY_CASES=50` tries fifty times
//! as many, from another seed each time. Proptest prints the simplest case that it finds to fail.

use proptest::prelude::ProptestConfig;
use proptest::test_runner::RngSeed;

/// The variable that asks for more cases: by how many times.
const VARIABLE: &str = "GEARMESH_PROPERTY_CASES";

/// Settings of a test that tries `number` cases.
pub fn cases(number: u32) -> ProptestConfig {
    let times = std::env::var(VARIABLE)
        .ok()
        .map(|text| match text.parse::<u32>() {
            Ok(times) if times > 0 => times,
            _ => panic!("{VARIABLE}: found `{text}`, allowed is a whole number from 1 on"),
        });
    ProptestConfig {
        cases: number.saturating_mul(times.unwrap_or(1)),
        rng_seed: times.map_or(RngSeed::Fixed(11), |_| RngSeed::Random),
        max_global_rejects: 1024 * times.unwrap_or(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}
