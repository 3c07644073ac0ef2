//! A solve must not allocate: counted by the global allocator of this test program.
#![allow(clippy::unwrap_used, clippy::needless_range_loop)] // test code in index notation

#[path = "../../../tests/support/counting_allocator.rs"]
mod counting_allocator;
mod nlcp_common;
mod pair_common;

use counting_allocator::allocations;
use gearmesh_contact::Drive;
use gearmesh_contact::nlcp::{Params, Problem, Workspace, solve_load, solve_position};
use nlcp_common::random::{Random, case};

#[test]
fn solves_do_not_allocate() {
    let mut random = Random::new(31);
    let mut work = Workspace::new(20);
    let params = Params::default();
    let mut change = [0.0; 20];
    for _ in 0..2000 {
        let case = case(20, &mut random);
        let data = &case.data;
        let n = data.size();
        let before = allocations();
        let problem = Problem::new(
            &data.compliance,
            &data.local,
            &data.separation,
            &data.closing,
            &data.lever,
        )
        .unwrap();
        let info = solve_load(&problem, case.load, &params, &mut work).unwrap();
        work.apply_tangent(&data.separation, &mut change[..n]);
        solve_position(&problem, info.approach_m, &params, &mut work).unwrap();
        solve_position(&problem, problem.first_contact() - 1e-6, &params, &mut work).unwrap();
        work.reset();
        solve_position(&problem, info.approach_m, &params, &mut work).unwrap();
        // A single correction allowed: the descent must do the work.
        let hasty = Params {
            max_corrections: 1,
            ..params
        };
        work.reset();
        solve_load(&problem, case.load, &hasty, &mut work).unwrap();
        assert_eq!(allocations() - before, 0);
    }
}

/// Slices that enter and leave the path one by one, from position to position and cold.
#[test]
fn helical_positions_do_not_allocate() {
    let lines = pair_common::helical(20.0, gearmesh_geometry::Flank::Right);
    let mut contact = pair_common::contact(&lines, pair_common::FRICTIONLESS, 12);
    let before = allocations();
    for k in 0..300 {
        if k % 50 == 0 {
            contact.reset();
        }
        contact
            .solve(1e-3 * f64::from(k), Drive::Torque(300.0))
            .unwrap();
    }
    assert_eq!(allocations() - before, 0);
}

#[test]
fn positions_with_tip_edges_do_not_allocate() {
    let gears = [
        pair_common::tooth(40, 0.0, 0.0),
        pair_common::tooth(50, 0.0, 0.0),
    ];
    let lines = pair_common::extended(pair_common::pair(&gears[0], &gears[1]), 100e-6);
    let mut contact = pair_common::contact(&lines, pair_common::FRICTIONLESS, 3);
    let before = allocations();
    for k in 0..300 {
        contact
            .solve(1e-3 * f64::from(k), Drive::Torque(300.0))
            .unwrap();
    }
    assert_eq!(allocations() - before, 0);
}
