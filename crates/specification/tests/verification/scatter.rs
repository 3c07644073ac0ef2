//! Numbers that are drawn follow their distributions.

use gearmesh_specification::study::{NormalTable, SpacedTable, UniformTable};

/// Quantiles of the standard normal distribution: Abramowitz and Stegun, Handbook of Mathematical Functions,
/// table 26.5.
#[test]
fn quantiles_are_those_of_the_tables() {
    let normal = NormalTable {
        mean: 10.0,
        deviation: 2.0,
    };
    for (probability, z) in [(0.5, 0.0), (0.975, 1.95996), (0.001, -3.09023)] {
        assert!((normal.quantile(probability) - (10.0 + 2.0 * z)).abs() < 2e-5);
    }
    let uniform = UniformTable {
        from: -1.0,
        to: 3.0,
    };
    assert_eq!(uniform.quantile(0.25), 0.0);
    let spaced = SpacedTable {
        from: 0.0,
        to: 0.3,
        count: 4,
    };
    assert_eq!((spaced.values()[0], spaced.values()[3]), (0.0, 0.3));
}
