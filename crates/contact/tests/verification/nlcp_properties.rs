//! Properties and special cases of the complementarity problem.
#![allow(clippy::unwrap_used, clippy::needless_range_loop)] // test code in index notation

use crate::nlcp_common;

use gearmesh_contact::nlcp::{
    LocalLaw, NlcpError, Params, Problem, Workspace, solve_load, solve_position,
};
use nlcp_common::Data;
use nlcp_common::random::{KINDS, Kind, Random, case, compliance, weber};

fn gear_like(n: usize, seed: u64) -> (Data, Random) {
    let mut random = Random::new(seed);
    let compliance = compliance(Kind::GearLike, n, &mut random);
    let local = (0..n).map(|_| weber(1e3, &mut random)).collect();
    let separation = (0..n).map(|_| random.between(0.0, 2e-5)).collect();
    (
        Data {
            compliance,
            local,
            separation,
            closing: vec![1.0; n],
            lever: vec![0.07; n],
        },
        random,
    )
}

#[test]
fn one_linear_slice_has_the_closed_form() {
    let data = Data {
        compliance: vec![2e-8],
        local: vec![LocalLaw::none()],
        separation: vec![5e-6],
        closing: vec![1.0],
        lever: vec![0.07],
    };
    let mut work = Workspace::new(1);
    let info = solve_load(&data.problem(), 70.0, &Params::default(), &mut work).unwrap();
    assert!((work.forces()[0] - 1000.0).abs() < 1e-9);
    assert!((info.approach_m - 25e-6).abs() < 1e-18);
    // dT/dx = b w / C
    assert!((info.stiffness / (0.07 / 2e-8) - 1.0).abs() < 1e-14);
}

#[test]
fn load_never_falls_with_the_approach() {
    let mut random = Random::new(11);
    let mut work = Workspace::new(20);
    for _ in 0..300 {
        let mut case = case(20, &mut random);
        case.data.lever = case.data.closing.clone(); // the theorem needs b parallel to w
        let problem = case.data.problem();
        let top = solve_load(&problem, case.load, &Params::default(), &mut work).unwrap();
        let first = problem.first_contact();
        let mut last = 0.0;
        for step in 0..=30 {
            let x = first + (top.approach_m - first) * f64::from(step) / 20.0;
            let load = solve_position(&problem, x, &Params::default(), &mut work)
                .unwrap()
                .load;
            // Up to the accepted residual on an ill-conditioned matrix.
            assert!(
                load >= last - 1e-7 * case.load,
                "{:?}: {load} after {last}",
                case.kind
            );
            last = load;
        }
    }
}

#[test]
fn result_does_not_depend_on_slice_numbering() {
    let (data, mut random) = gear_like(20, 12);
    let n = data.size();
    let mut order: Vec<usize> = (0..n).collect();
    for i in (1..n).rev() {
        order.swap(i, random.below(i + 1));
    }
    let pick = |v: &[f64]| order.iter().map(|&i| v[i]).collect::<Vec<_>>();
    let shuffled = Data {
        compliance: order
            .iter()
            .flat_map(|&i| order.iter().map(move |&j| (i, j)))
            .map(|(i, j)| data.compliance[i * n + j])
            .collect(),
        local: order.iter().map(|&i| data.local[i]).collect(),
        separation: pick(&data.separation),
        closing: pick(&data.closing),
        lever: pick(&data.lever),
    };
    let (mut a, mut b) = (Workspace::new(n), Workspace::new(n));
    let first = solve_load(&data.problem(), 500.0, &Params::default(), &mut a).unwrap();
    let second = solve_load(&shuffled.problem(), 500.0, &Params::default(), &mut b).unwrap();
    assert!((first.approach_m / second.approach_m - 1.0).abs() < 1e-10);
    let largest = a.forces().iter().copied().fold(0.0, f64::max);
    for (k, &i) in order.iter().enumerate() {
        assert!((a.forces()[i] - b.forces()[k]).abs() < 1e-9 * largest);
    }
}

#[test]
fn tangents_are_the_finite_differences() {
    let (data, mut random) = gear_like(15, 13);
    let params = Params {
        tolerance: 1e-13,
        ..Params::default()
    };
    let mut work = Workspace::new(15);
    let info = solve_load(&data.problem(), 800.0, &params, &mut work).unwrap();
    let (x, rates) = (info.approach_m, work.force_rates().to_vec());
    let mut at = |data: &Data, x: f64| {
        let info = solve_position(&data.problem(), x, &params, &mut work).unwrap();
        (info.load, work.forces().to_vec())
    };
    let h = 1e-5 * x;
    let ((low, low_force), (high, high_force)) = (at(&data, x - h), at(&data, x + h));
    // Central difference of step 1e-5: truncation 1e-9, rounding 1e-10.
    assert!(((high - low) / (2.0 * h) / info.stiffness - 1.0).abs() < 1e-7);
    let largest = rates.iter().copied().fold(0.0, f64::max);
    for i in 0..15 {
        assert!(((high_force[i] - low_force[i]) / (2.0 * h) - rates[i]).abs() < 1e-7 * largest);
    }
    // The same for a change of the separations.
    let direction: Vec<f64> = (0..15).map(|_| random.between(-1.0, 1.0)).collect();
    let moved = |sign: f64| {
        let separation = data
            .separation
            .iter()
            .zip(&direction)
            .map(|(e, d)| e + sign * h * d)
            .collect();
        Data {
            separation,
            ..data.clone()
        }
    };
    let ((_, low_force), (_, high_force)) = (at(&moved(-1.0), x), at(&moved(1.0), x));
    at(&data, x);
    let mut change = vec![0.0; 15];
    work.apply_tangent(&direction, &mut change);
    for i in 0..15 {
        assert!(((high_force[i] - low_force[i]) / (2.0 * h) - change[i]).abs() < 1e-7 * largest);
    }
}

#[test]
fn warm_start_gives_the_cold_answer() {
    let (mut data, _) = gear_like(15, 14);
    let (mut warm, mut cold) = (Workspace::new(15), Workspace::new(15));
    for step in 0..100 {
        for (i, e) in data.separation.iter_mut().enumerate() {
            *e += 3e-7 * (0.1 * f64::from(step) + i as f64).sin();
        }
        cold.reset();
        let a = solve_load(&data.problem(), 300.0, &Params::default(), &mut warm).unwrap();
        let b = solve_load(&data.problem(), 300.0, &Params::default(), &mut cold).unwrap();
        assert!((a.approach_m - b.approach_m).abs() <= 1e-9 * b.approach_m);
        assert_eq!(warm.active(), cold.active());
    }
}

#[test]
fn zero_load_touches_the_nearest_slice() {
    let (mut data, _) = gear_like(10, 15);
    data.separation[7] = -3e-6;
    let mut work = Workspace::new(10);
    let info = solve_load(&data.problem(), 0.0, &Params::default(), &mut work).unwrap();
    assert_eq!(
        (info.approach_m, info.load, info.active, info.stiffness),
        (-3e-6, 0.0, 0, 0.0)
    );
    assert!(work.forces().iter().all(|&f| f == 0.0));
    assert!(work.gaps().iter().all(|&g| g >= 0.0) && work.gaps()[7] == 0.0);
    // It is the limit of small loads.
    let small = solve_load(&data.problem(), 1e-9, &Params::default(), &mut work).unwrap();
    assert!((small.approach_m - info.approach_m).abs() < 1e-14 && small.floor_hits == 1);
}

#[test]
fn separated_bodies_carry_nothing() {
    let (data, _) = gear_like(10, 16);
    let mut work = Workspace::new(10);
    let info = solve_position(&data.problem(), -1e-6, &Params::default(), &mut work).unwrap();
    assert_eq!((info.load, info.active, info.factorisations), (0.0, 0, 0));
    for (gap, e) in work.gaps().iter().zip(&data.separation) {
        assert!((gap - (e + 1e-6)).abs() < 1e-20);
    }
}

#[test]
fn identical_slices_share_the_load_equally() {
    let mut random = Random::new(17);
    let n = 12;
    let law = weber(100.0, &mut random);
    let compliance = (0..n * n)
        .map(|k| if k % (n + 1) == 0 { 2e-8 } else { 5e-9 })
        .collect();
    let data = Data {
        compliance,
        local: vec![law; n],
        separation: vec![1e-5; n],
        closing: vec![1.0; n],
        lever: vec![0.1; n],
    };
    let mut work = Workspace::new(n);
    solve_load(&data.problem(), 120.0, &Params::default(), &mut work).unwrap();
    assert!(work.forces().iter().all(|f| (f - 100.0).abs() < 1e-8));
}

#[test]
fn loads_over_nine_decades() {
    let (data, _) = gear_like(15, 18);
    let mut work = Workspace::new(15);
    let mut last = 0.0;
    for decade in -3..=6 {
        let load = 10f64.powi(decade);
        let info = solve_load(&data.problem(), load, &Params::default(), &mut work).unwrap();
        assert!(data.residual(work.forces(), info.approach_m, Some(load)) <= 1e-10);
        assert!(info.approach_m > last);
        assert_eq!(
            info.cap_hits > 0,
            work.forces()
                .iter()
                .zip(&data.local)
                .any(|(f, l)| *f > l.cap_n())
        );
        last = info.approach_m;
    }
    let info = solve_load(&data.problem(), 1e7, &Params::default(), &mut work).unwrap();
    assert!(info.cap_hits > 0);
}

#[test]
fn hundred_and_fifty_slices() {
    let mut random = Random::new(19);
    let mut work = Workspace::new(150);
    for kind in KINDS {
        let compliance = compliance(kind, 150, &mut random);
        let local = (0..150).map(|_| weber(1e3, &mut random)).collect();
        let separation = (0..150).map(|_| random.between(0.0, 5e-5)).collect();
        let lever: Vec<f64> = (0..150).map(|_| 0.07 * random.between(0.9, 1.1)).collect();
        let data = Data {
            compliance,
            local,
            separation,
            closing: vec![1.0; 150],
            lever,
        };
        let info = solve_load(&data.problem(), 1e4, &Params::default(), &mut work).unwrap();
        assert!(
            data.residual(work.forces(), info.approach_m, Some(1e4)) <= 1e-10,
            "{kind:?}"
        );
        assert!(info.active > 5 && info.active < 150, "{kind:?}: {info:?}");
    }
}

#[test]
fn exactly_singular_compliance_is_solved() {
    // Two slices at one place: only the sum of their forces is determined, by the nearer one if they differ.
    let mut data = Data {
        compliance: vec![1e-8; 4],
        local: vec![LocalLaw::none(); 2],
        separation: vec![0.0; 2],
        closing: vec![1.0; 2],
        lever: vec![0.1; 2],
    };
    let mut work = Workspace::new(2);
    for second in [0.0, 1e-7, 1e-4] {
        data.separation[1] = second;
        for warm in [false, true] {
            if !warm {
                work.reset();
            }
            let info = solve_load(&data.problem(), 10.0, &Params::default(), &mut work).unwrap();
            assert!(data.residual(work.forces(), info.approach_m, Some(10.0)) <= 1e-10);
            assert!((info.approach_m - 1e-6).abs() < 1e-15, "{info:?}");
            let info =
                solve_position(&data.problem(), 1e-6, &Params::default(), &mut work).unwrap();
            assert!((info.load - 10.0).abs() < 1e-8, "{info:?}");
        }
    }
}

#[test]
fn local_law_may_soften_if_the_sum_stays_positive() {
    // A correction of the near field: negative slope of its own, covered by the diagonal.
    let law = LocalLaw::logarithmic(-4e-9, 3e-10, 1e-3, f64::INFINITY).unwrap();
    assert!(!law.is_monotone() && law.slope(1e3) < 0.0);
    let (data, _) = gear_like(15, 20);
    // Smallest eigenvalue 1.5e-8 m/N.
    let compliance = (0..15 * 15)
        .map(|k| if k % 16 == 0 { 2e-8 } else { 5e-9 })
        .collect();
    let data = Data {
        compliance,
        local: vec![law; 15],
        ..data
    };
    let mut work = Workspace::new(15);
    let info = solve_load(&data.problem(), 500.0, &Params::default(), &mut work).unwrap();
    assert!(data.residual(work.forces(), info.approach_m, Some(500.0)) <= 1e-10);
}

#[test]
fn friction_moves_the_approach_the_right_way() {
    let (mut data, _) = gear_like(15, 21);
    let mut work = Workspace::new(15);
    let plain = solve_load(&data.problem(), 500.0, &Params::default(), &mut work).unwrap();
    data.lever = (0..15)
        .map(|i| 0.07 * if i < 8 { 0.95 } else { 0.9 })
        .collect();
    let rough = solve_load(&data.problem(), 500.0, &Params::default(), &mut work).unwrap();
    assert!(data.residual(work.forces(), rough.approach_m, Some(500.0)) <= 1e-10);
    // Shorter arms need larger forces.
    assert!(rough.approach_m > plain.approach_m);
}

#[test]
fn wrong_data_is_named() {
    let one = [LocalLaw::none(); 2];
    let ok = [1.0, 1.0];
    let c = [1.0, 0.2, 0.2, 1.0];
    assert!(matches!(
        Problem::new(&c[..3], &one, &ok, &ok, &ok),
        Err(NlcpError::Shape {
            found: 3,
            expected: 4,
            ..
        })
    ));
    assert!(matches!(
        Problem::new(&c, &one, &[0.0, f64::NAN], &ok, &ok),
        Err(NlcpError::NotFinite { slice: 1, .. })
    ));
    assert!(matches!(
        Problem::new(&c, &one, &ok, &[1.0, 0.0], &ok),
        Err(NlcpError::NotPositive { slice: 1, .. })
    ));
    assert!(matches!(
        Problem::new(&c, &one, &ok, &ok, &[-1.0, 1.0]),
        Err(NlcpError::NotPositive { slice: 0, .. })
    ));
    for bad in [
        [1.0, 0.2, 0.3, 1.0],
        [1.0, 2.0, 2.0, 1.0],
        [1.0, f64::NAN, f64::NAN, 1.0],
    ] {
        assert!(matches!(
            Problem::new(&bad, &one, &ok, &ok, &ok),
            Err(NlcpError::NotSemiDefinite {
                row: 1,
                column: 0,
                ..
            })
        ));
    }
    let problem = Problem::new(&c, &one, &ok, &ok, &ok).unwrap();
    let params = Params::default();
    let mut work = Workspace::new(2);
    assert_eq!(
        solve_load(&problem, -1.0, &params, &mut work),
        Err(NlcpError::Load { found: -1.0 })
    );
    assert!(matches!(
        solve_position(&problem, f64::NAN, &params, &mut work),
        Err(NlcpError::Approach { .. })
    ));
    let lax = Params {
        tolerance: 0.0,
        ..params
    };
    assert_eq!(
        solve_load(&problem, 1.0, &lax, &mut work),
        Err(NlcpError::Tolerance { found: 0.0 })
    );
    let error = solve_load(&problem, 1.0, &params, &mut Workspace::new(1)).unwrap_err();
    assert_eq!(
        error,
        NlcpError::TooLarge {
            size: 2,
            capacity: 1
        }
    );
    // No compliance at all: any force closes nothing.
    let rigid = Problem::new(&[0.0; 4], &one, &ok, &ok, &ok).unwrap();
    assert!(matches!(
        solve_load(&rigid, 1.0, &params, &mut work),
        Err(NlcpError::NotPositiveDefinite { .. })
    ));
    // Indefinite though every 2 by 2 minor is fine.
    let c = [1.0, 0.9, -0.9, 0.9, 1.0, 0.9, -0.9, 0.9, 1.0];
    let (three, laws) = ([1.0; 3], [LocalLaw::none(); 3]);
    let indefinite = Problem::new(&c, &laws, &three, &three, &three).unwrap();
    let error = solve_load(&indefinite, 1.0, &params, &mut Workspace::new(3)).unwrap_err();
    assert!(
        matches!(error, NlcpError::NotPositiveDefinite { .. }),
        "{error}"
    );
    assert!(error.to_string().contains("positive definite"));
}

#[test]
fn unreachable_tolerance_ends_with_numbers() {
    let (mut data, mut random) = gear_like(15, 22);
    data.compliance = compliance(Kind::Condition1e12, 15, &mut random);
    let params = Params {
        tolerance: 1e-30,
        ..Params::default()
    };
    let error = solve_load(&data.problem(), 500.0, &params, &mut Workspace::new(15)).unwrap_err();
    match error {
        NlcpError::NoConvergence {
            iterations,
            residual,
            size: 15,
            ..
        } => {
            assert!(iterations > 0 && residual > 1e-30 && residual < 1e-10);
        }
        other => panic!("{other}"),
    }
}

#[test]
fn empty_problem_is_legal_without_load() {
    let problem = Problem::new(&[], &[], &[], &[], &[]).unwrap();
    let mut work = Workspace::new(0);
    assert_eq!(
        solve_position(&problem, 0.0, &Params::default(), &mut work)
            .unwrap()
            .load,
        0.0
    );
    assert_eq!(
        solve_load(&problem, 1.0, &Params::default(), &mut work),
        Err(NlcpError::NoSlices { load: 1.0 })
    );
}
