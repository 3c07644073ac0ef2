//! Samples fill the ranges, and further ones leave the first as they were.

use gearmesh_specification::study::{Design, probabilities, seeded};

#[test]
fn a_hypercube_has_one_sample_in_each_share() {
    let drawn = probabilities(Design::LatinHypercube, 50, seeded(3, "relief"));
    let mut shares: Vec<usize> = drawn.iter().map(|p| (p * 50.0) as usize).collect();
    assert!(shares.windows(2).any(|w| w[0] > w[1]));
    shares.sort_unstable();
    assert_eq!(shares, (0..50).collect::<Vec<_>>());
    assert_eq!(
        drawn,
        probabilities(Design::LatinHypercube, 50, seeded(3, "relief"))
    );
    assert_ne!(
        drawn,
        probabilities(Design::LatinHypercube, 50, seeded(4, "relief"))
    );
}

#[test]
fn more_random_samples_leave_the_first_as_they_were() {
    let few = probabilities(Design::Random, 5, seeded(1, "x"));
    let many = probabilities(Design::Random, 9, seeded(1, "x"));
    assert_eq!(few[..], many[..5]);
}
