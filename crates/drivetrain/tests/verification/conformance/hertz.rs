//! Slices of crossed cylinders against Hertz's point contact, from kinematics to approach; and the same flanks at rest
//! and in motion.

use std::f64::consts::PI;
use std::sync::Arc;

use gearmesh_contact::slice_contact::SliceContact;
use gearmesh_contact::{
    AxialSpread, Drive, LocalContact, SliceCompliance, SliceLayout, StaticContact,
};
use gearmesh_drivetrain::*;
use gearmesh_geometry::Flank;
use gearmesh_model::ReducedGear;
use nalgebra::{DMatrix, Matrix3, Vector3};

use crate::conformance::crossed_cylinders::{DISTANCE, crossed, cylinders, reduced_slices};
use crate::conformance::crowned_cylinders::CrownedCylinders;
use crate::mesh_common::*;

/// The side of crossed cylinders that both gears press together by turning counter-clockwise.
const SIDE: Flank = Flank::Left;

/// Lever of the normal force on gear 2 \[m\]; with it as radius the transmission error is that along the normal.
const LEVER: f64 = 0.5 * DISTANCE;

/// Complete elliptic integrals K and E of the modulus e by the arithmetic-geometric mean.
fn elliptic(e: f64) -> [f64; 2] {
    let (mut a, mut b, mut sum, mut power) = (1.0, (1.0 - e * e).sqrt(), 0.5 * e * e, 1.0);
    while (a - b).abs() > 1e-15 {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        sum += power * c * c;
        power *= 2.0;
    }
    let k = 0.5 * PI / a;
    [k, k * (1.0 - sum)]
}

/// Contact ellipse and approach of a force on surfaces of least and largest relative curvature (K. L. Johnson, Contact
/// Mechanics, section 4.2).
struct Hertz {
    /// Half axes of the ellipse \[m\].
    short_m: f64,
    long_m: f64,
    approach_m: f64,
}

impl Hertz {
    /// `compliance`: (1 − ν²)/E of both bodies together \[1/Pa\].
    fn new([least, largest]: [f64; 2], compliance: f64, force_n: f64) -> Self {
        // Largest over least curvature grows with the ellipse's eccentricity.
        let (mut low, mut high) = (1e-6, 1.0 - 1e-12);
        for _ in 0..200 {
            let e: f64 = 0.5 * (low + high);
            let [k, of_e] = elliptic(e);
            let ratio = (of_e / (1.0 - e * e) - k) / (k - of_e);
            if ratio < largest / least {
                low = e;
            } else {
                high = e;
            }
        }
        let e = low;
        let [k, of_e] = elliptic(e);
        let cube = 1.5 * compliance * force_n * (k - of_e) / (PI * e * e * 0.5 * least);
        let long_m = cube.cbrt();
        Self {
            short_m: long_m * (1.0 - e * e).sqrt(),
            long_m,
            approach_m: 1.5 * compliance * force_n * k / (PI * long_m),
        }
    }
}

/// A half space under strips of width w side by side, each with Hertz's pressure of half width a across and an even
/// load along: at a strip's middle a line load q of its own and of others gives
///
/// ```text
/// δ = 2κ q [ln(2w/a) + ½] + Σ κ q_j ln[(2d_j + 1)/(2d_j − 1)],     κ = (1 − ν²)/(πE),   d: strips apart
/// ```
///
/// The matrix holds κ `OWN` of the first term, so that it is positive definite, and the logarithm of the local law the
/// rest.
fn half_space(slices: usize, width_m: f64) -> ReducedGear {
    const OWN: f64 = 1.5;
    let mut body = pair_common::made_up_gear(&spur_pair().gear_1, slices as f64 * width_m, slices);
    let nu = body.poisson;
    let kappa = (1.0 - nu * nu) / (PI * body.young_pa);
    let wanted = DMatrix::from_fn(slices, slices, |i, j| {
        let apart = 2.0 * i.abs_diff(j) as f64;
        let share = if i == j {
            OWN
        } else {
            ((apart + 1.0) / (apart - 1.0)).ln()
        };
        kappa / width_m * share
    });
    // On the stations along the length whatever combines to that; alike at both stations along the profile.
    let spread = AxialSpread::own(&body);
    let axial = body.grid.z_m.len();
    let mut shares = DMatrix::<f64>::zeros(axial, slices);
    for slice in 0..slices {
        let own = spread.shares(slice).iter();
        own.for_each(|&(station, share)| shares[(station, slice)] += share);
    }
    let back = (shares.transpose() * &shares).try_inverse().unwrap() * shares.transpose();
    let on_stations = back.transpose() * wanted * back;
    (body.teeth, body.sectors) = (1, 1);
    body.grid.roll_angles_rad = vec![0.5, 1.5];
    let loads = body.grid.len();
    let pairs = (0..loads * loads).map(|i| (i / loads % axial, i % axial));
    body.c_hub = pairs.map(|at| on_stations[at]).collect();
    body.c_tooth = vec![0.0; loads * loads];
    let depth_m = width_m * (0.5 + nu / (2.0 * (1.0 - nu)) - 0.5 * OWN).exp();
    body.opposite_distance_m = vec![depth_m; 2];
    body
}

/// Where gear 2 stands when gear 1 has turned and it has turned back as much: the cylinders face each other at zero,
/// just touching.
/// Pose of a driver angle.
type PoseAt = fn(f64) -> Pose;

fn at_zero(_driver_angle_rad: f64) -> Pose {
    Pose::at_rest(Vector3::new(DISTANCE, 0.0, 0.0), Matrix3::identity())
}

fn at_rest(
    flanks: CrownedCylinders,
    slices: SliceContact,
) -> StaticContact<PosedFlanks<CrownedCylinders, PoseAt>> {
    let pose_at: PoseAt = at_zero;
    StaticContact::of_flanks(PosedFlanks::new(flanks, SIDE, LEVER, pose_at), slices)
}

/// Approach and largest line load of slices over Hertz's, less one; and the ellipse's long axis over its short one.
fn sliced_against_hertz(radii_m: [f64; 2], force_n: f64) -> ([f64; 2], f64) {
    const CROWN: f64 = 10.0;
    let probe = half_space(1, 1e-3);
    let compliance = 2.0 * (1.0 - probe.poisson * probe.poisson) / probe.young_pa;
    let [least, largest] = crossed(radii_m, CROWN, SliceLayout::new([1e-3; 2], 0.0, 1)).curvatures;
    let hertz = Hertz::new([least, largest], compliance, force_n);
    let aspect = hertz.long_m / hertz.short_m;
    // Strips as wide as the contact or wider, for which the logarithm is that of a line load; an odd number, a little
    // beyond its ends.
    let slices = 2 * (0.5 * (1.1 * aspect - 1.0)) as usize + 1;
    let layout = SliceLayout::new([2.2 * hertz.long_m; 2], 0.0, slices);
    let body = half_space(slices, layout.width_m());
    let local = LocalContact::WeberBanaschek;
    let spread = AxialSpread::own(&body);
    let flank = || SliceCompliance::on_slices(&body, Flank::Right, local, &spread).unwrap();
    let contact = SliceContact::new(layout, [flank(), flank()].map(Arc::new), local, 1);
    let mut contact = at_rest(crossed(radii_m, CROWN, layout), contact);
    let state = contact.solve(0.0, Drive::Torque(force_n * LEVER)).unwrap();
    let approach_m = state.unloaded_m - state.transmission_error_m;
    let line_load = contact.forces_n()[slices / 2] / layout.width_m();
    let of_hertz = 1.5 * force_n / (2.0 * hertz.long_m);
    let off = [
        approach_m / hertz.approach_m - 1.0,
        line_load / of_hertz - 1.0,
    ];
    (off, aspect)
}

/// Slices say nothing of how the load falls within a strip's length, nor of pressure across other strips: of the order
/// of the square of the contact's width over its length. The approach is 2.9 % too small where the ellipse is 2.8 times
/// as long as wide, 0.9 % at 5.5, below 0.1 % from 11 on.
#[test]
fn slices_of_crossed_cylinders_converge_to_hertz_with_the_slenderness() {
    for (ratio, force_n) in [(3.0, 100.0), (10.0, 1000.0), (40.0, 50.0), (200.0, 100.0)] {
        let ([approach, line_load], aspect) = sliced_against_hertz([20e-3 * ratio, 20e-3], force_n);
        let slender = aspect.powi(-2);
        assert!(approach.abs() < 0.5 * slender, "{aspect}: {approach}");
        assert!(line_load.abs() < slender, "{aspect}: {line_load}");
    }
}

/// The load that turns gear 2 in motion, at the pose where it comes to rest under a torque, is that torque; the
/// difference is of the order of the deflection over the length on which compliance and levers change.
#[test]
fn crossed_cylinders_rest_where_they_balance_in_motion() {
    let mut contact = at_rest(cylinders(), reduced_slices());
    let mut mesh = GearMesh::of_flanks(
        Box::new(cylinders()),
        SIDE,
        ReducedTeeth::of_flanks(reduced_slices(), 2000.0).unwrap(),
    )
    .unwrap();
    let mut off = |torque_nm: f64| {
        let state = contact.solve(0.0, Drive::Torque(torque_nm)).unwrap();
        assert!((state.torque_2_nm / torque_nm - 1.0).abs() < 1e-9);
        // The lever on both gears is half their distance.
        assert!((state.torque_1_nm / torque_nm - 1.0).abs() < 1e-6);
        let turn = about(-state.transmission_error_m / LEVER * Vector3::z(), 1.0);
        let pose = Pose::at_rest(at_zero(0.0).displacement_m, turn);
        let load = mesh.evaluate(&pose, false).unwrap().load;
        (load[5].abs() / torque_nm - 1.0).abs()
    };
    let [full, hundredth] = [20.0, 0.2].map(&mut off);
    assert!(full < 5e-3, "{full:e}");
    assert!(hundredth < 0.1 * full, "{full:e} {hundredth:e}");
}

/// docs/extending.md shows the family of these tests as it is.
#[test]
fn the_page_on_extending_shows_this_family() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/extending.md");
    let page = std::fs::read_to_string(root).unwrap();
    assert!(page.contains(include_str!("crowned_cylinders.rs")));
}
