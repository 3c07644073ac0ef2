//! The hybrid mesh against the static contact that computes the same teeth from a driver angle, and gear errors in it.

use crate::mesh_common;

use std::sync::Arc;

use gearmesh_contact::Drive;
use gearmesh_contact::{ContactLines, StaticContact};
use gearmesh_drivetrain::errors::broken_tooth::BrokenTooth;
use gearmesh_drivetrain::errors::pitch::PitchErrors;
use gearmesh_drivetrain::errors::spall::{Spall, SpallPatch};
use gearmesh_drivetrain::errors::tip_chip::{FaceEnd, TipChip};
use gearmesh_drivetrain::flank_contacts::FlankErrors;
use gearmesh_drivetrain::*;
use gearmesh_geometry::{Flank, GearPair, Microgeometry, involute};
use mesh_common::*;

fn right_only(pair: &GearPair, errors: [FlankErrors; 2]) -> GearMesh {
    let kinematics = kinematics_with(pair, errors, PathEnds::LineOfAction);
    GearMesh::new(kinematics, Flank::Right, reduced_teeth(pair, Flank::Right)).unwrap()
}

/// Same transmission error as the static scene. That one takes compliance at the roll angle that gear 2 has without
/// load, and has no force from the walking of the contacts, so that the two differ by deflection over pitch: the
/// relative difference falls with the load, and at one hundredth of it (0.2 µm) the transmission errors agree to 1e-12
/// m.
#[test]
fn transmission_error_is_that_of_the_static_scene() {
    for pair in spur_families() {
        check_transmission_error(&pair);
    }
}

fn check_transmission_error(pair: &GearPair) {
    let models = [&pair.gear_1, &pair.gear_2].map(made_up_gear);
    let lines = ContactLines {
        pair: pair.clone(),
        microgeometry_1: Microgeometry::default(),
        microgeometry_2: Microgeometry::default(),
        extension: None,
        zone: gearmesh_contact::ContactZone::of_equal_faces(WIDTH),
    };
    let mut contact =
        StaticContact::new(lines, &models[0], &models[1], pair_common::FRICTIONLESS).unwrap();
    let mut mesh = right_only(pair, [Vec::new(), Vec::new()]);
    let mut differ = |torque: f64| {
        let mut worst: f64 = 0.0;
        for k in 0..25 {
            let theta = 0.013 * f64::from(k);
            let expected = contact.solve(theta, Drive::Torque(torque)).unwrap();
            let found = equilibrium(&mut mesh, pair, theta, torque);
            worst = worst.max((found - expected.transmission_error_m).abs());
        }
        worst
    };
    let [full, tenth, hundredth] = [200.0, 20.0, 2.0].map(&mut differ);
    assert!(full < 2e-8, "{full:e} {tenth:e} {hundredth:e}");
    assert!(
        tenth < full / 50.0 && hundredth < tenth / 50.0,
        "{full:e} {tenth:e} {hundredth:e}"
    );
    assert!(hundredth < 1e-12, "{hundredth:e}");
}

/// One spring on the pair's own curve is at rest where the pair is, but for the harmonics that are left out; spur and
/// helical, and from gear 2's torque alone, as what the walking of the contact adds is a load on gear 1.
#[test]
fn a_spring_on_the_own_curve_has_the_pairs_transmission_error() {
    for pair in pairs() {
        let (curve, te_m) = own_curve(&pair, 200.0, 24);
        assert!(curve.remainder_m() < 0.6e-6, "{:e}", curve.remainder_m());
        let spring = own_spring(&pair, Flank::Right);
        let kinematics = kinematics_with(&pair, [Vec::new(), Vec::new()], PathEnds::LineOfAction);
        let mut mesh = GearMesh::new(kinematics, Flank::Right, spring).unwrap();
        for (k, expected) in te_m.iter().enumerate() {
            let theta = pair.pitch_1_rad() * (k as f64 / te_m.len() as f64);
            let found = equilibrium(&mut mesh, &pair, theta, 200.0);
            let off = (found - expected).abs();
            assert!(off < curve.remainder_m() + 1e-12, "{k} {off:e}");
        }
    }
}

/// Mates of unequal width with other slices each: both computations agree as on equal ones, the narrower gear makes the
/// pair softer, and one that is moved up or down along the axis by as much is softer alike, for these bodies are their
/// own mirror images.
#[test]
fn mates_of_unequal_width_agree_with_the_static_scene() {
    let pair = spur_pair();
    let made = |gear, width, slices| pair_common::made_up_gear(gear, width, slices);
    let wide = made(&pair.gear_1, 20e-3, 5);
    let narrow = made(&pair.gear_2, 14e-3, 4);
    let contact = |model_2: &gearmesh_model::ReducedGear, displacement_m: f64| {
        let widths = [wide.face_width_m, model_2.face_width_m];
        let lines = ContactLines {
            pair: pair.clone(),
            microgeometry_1: Microgeometry::default(),
            microgeometry_2: Microgeometry::default(),
            extension: None,
            zone: gearmesh_contact::ContactZone::new(widths, displacement_m),
        };
        StaticContact::new(lines, &wide, model_2, pair_common::FRICTIONLESS).unwrap()
    };
    let te = |contact: &mut StaticContact, theta: f64, torque: f64| {
        let state = contact.solve(theta, Drive::Torque(torque)).unwrap();
        state.transmission_error_m
    };
    let models = [&wide, &narrow];
    let local = gearmesh_contact::LocalContact::WeberBanaschek;
    let teeth = ReducedTeeth::new(&pair, Flank::Right, models, local, 4000.0).unwrap();
    let gears = [pair.gear_1.clone(), pair.gear_2.clone()];
    let (none, a) = ([Vec::new(), Vec::new()], pair.centre_distance_m);
    let ends = PathEnds::LineOfAction;
    let kinematics = MeshKinematics::new(gears, none, a, *teeth.layout(), ends).unwrap();
    let mut mesh = GearMesh::new(kinematics, Flank::Right, teeth).unwrap();
    let mut unequal = contact(&narrow, 0.0);
    let mut equal = contact(&made(&pair.gear_2, 20e-3, 5), 0.0);
    let [mut up, mut down] = [6e-3, -6e-3].map(|shift| contact(&narrow, shift));
    for k in 0..12 {
        let theta = 0.027 * f64::from(k);
        let off = equilibrium(&mut mesh, &pair, theta, 2.0) - te(&mut unequal, theta, 2.0);
        assert!(off.abs() < 1e-12, "{theta}: {off:e}");
        let [full, part] = [&mut equal, &mut unequal].map(|contact| te(contact, theta, 200.0));
        let [over, under] = [&mut up, &mut down].map(|contact| te(contact, theta, 200.0));
        assert!(
            over < part && part < full && full < 0.0,
            "{full:e} {part:e} {over:e}"
        );
        assert!(
            (over - under).abs() < 1e-9 * over.abs(),
            "{over:e} {under:e}"
        );
    }
}

/// A flank that stands back by f carries when its neighbours have given way by f: the unloaded transmission error shows
/// the errors.
#[test]
fn pitch_errors_are_the_unloaded_transmission_error() {
    let pair = spur_pair();
    let mut removed = vec![0.0; 30];
    removed[3] = 8e-6;
    removed[4] = -5e-6;
    let errors = PitchErrors::new(Flank::Right, removed, 30).unwrap();
    let mut mesh = right_only(&pair, [vec![Arc::new(errors)], Vec::new()]);
    let mut ideal = right_only(&pair, [Vec::new(), Vec::new()]);
    // Tooth 4 leads by 5 µm wherever it is in mesh; tooth 3 alone in mesh lets gear 2 fall back by 8 µm.
    let at_pitch_point = |tooth: f64| tooth * pair.pitch_1_rad();
    for (tooth, expected) in [(4.0, 5e-6), (3.0, -8e-6), (9.0, 0.0)] {
        let theta = at_pitch_point(tooth);
        let offset =
            equilibrium(&mut mesh, &pair, theta, 0.5) - equilibrium(&mut ideal, &pair, theta, 0.5);
        // The other pair is 13 µm further back, or not in mesh at the pitch point.
        assert!(
            (offset - expected).abs() < 1e-9,
            "tooth {tooth}: {offset:e}"
        );
    }
}

/// Lost material softens the mesh where it is and nowhere else.
#[test]
fn faults_act_where_they_are() {
    let pair = spur_pair();
    let gear = &pair.gear_1;
    let middle_radius =
        involute::radius_m(pair.working_pressure_angle_rad.tan(), gear.base_radius_m);
    let broken: Arc<dyn FlankError> =
        Arc::new(BrokenTooth::new(gear, 5, middle_radius - 2e-3).unwrap());
    let chip: Arc<dyn FlankError> =
        Arc::new(TipChip::new((gear, WIDTH), 5, FaceEnd::Positive, [6e-3, 9e-3]).unwrap());
    let patch = SpallPatch {
        tooth: 5,
        side: Flank::Right,
        radii_m: [middle_radius - 0.5e-3, middle_radius + 0.5e-3],
        z_m: [-5e-3, 5e-3],
        depth_m: 50e-6,
        edge_rad: 2e-3,
    };
    let spall: Arc<dyn FlankError> = Arc::new(Spall::new(gear, patch).unwrap());
    let mut whole = right_only(&pair, [Vec::new(), Vec::new()]);
    let te = -10e-6;
    let here = 5.0 * pair.pitch_1_rad() + 0.02;
    let away = 12.0 * pair.pitch_1_rad();
    for (what, fault, slices_lost) in [
        ("broken", broken, 5),
        ("chip", chip, 1),
        ("spall", spall, 3),
    ] {
        let mut mesh = right_only(&pair, [vec![fault], Vec::new()]);
        let force = |mesh: &mut GearMesh, theta: f64| torque_2(mesh, &pair, theta, te).0;
        let [with, without] = [&mut mesh, &mut whole].map(|mesh| force(mesh, away));
        // The solver starts from its last solution.
        assert!((with / without - 1.0).abs() < 1e-9, "{what}");
        // In the middle of the path for spall and break, towards the tip for the chip.
        let at = if what == "spall" {
            5.0 * pair.pitch_1_rad()
        } else {
            here + 0.03
        };
        let (with, without) = (force(&mut mesh, at), force(&mut whole, at));
        assert!(with < without, "{what} {with} {without}");
        let (found, forces) = mesh.side(Flank::Right).unwrap();
        let line = found.lines.iter().find(|l| l.teeth[0] == 5).unwrap();
        let touching = (0..found.contacts.len())
            .filter(|&i| found.lines[found.contacts[i].line].teeth[0] == 5 && forces[i] > 0.0)
            .count();
        assert_eq!(touching, SLICES - slices_lost, "{what} {line:?}");
    }
}

/// A crack softens its tooth, the deeper the more, and no other.
#[test]
fn cracks_soften_their_tooth() {
    let pair = spur_pair();
    let gears = [beam_tooth(1, &pair.gear_1), beam_tooth(2, &pair.gear_2)];
    let t = &pair.gear_1;
    let stiffness = |depth_m: f64| {
        let crack = RootCrack {
            side: Flank::Right,
            start_radius_m: t.root_radius_m + 0.4e-3,
            depth_m,
            angle_rad: 1.0,
        };
        let teeth = BeamTeeth::new(gears, SLICES, [&[(7, crack)], &[]])?;
        let roll = [0.5, 0.45];
        Ok::<_, DrivetrainError>([7, 8].map(|k| teeth.pair_stiffness_n_per_m([k, 0], roll)))
    };
    let [small, deeper] = [0.3e-3, 1.2e-3].map(|d| stiffness(d).unwrap());
    assert_eq!(small[1], deeper[1]);
    assert!(
        deeper[0] < small[0] && small[0] < small[1],
        "{small:?} {deeper:?}"
    );
    assert!(stiffness(10e-3).is_err());
    assert!(stiffness(-1.0).is_err());
}

/// The analytic tooth: parts positive, softer towards the tip, and the sizes that the literature gives (foundation and
/// bending of the same order).
#[test]
fn analytic_teeth_soften_towards_the_tip() {
    let pair = spur_pair();
    let tooth = beam_tooth(1, &pair.gear_1);
    let mut last = 0.0;
    for k in 0..=10 {
        let (low, high) = (pair.gear_1.form_roll_rad, pair.gear_1.flank_end_roll_rad);
        let parts = tooth.parts(low + (high - low) * f64::from(k) / 10.0, None);
        assert!(
            parts.bending > 0.0
                && parts.shear > 0.0
                && parts.compression > 0.0
                && parts.foundation > 0.0
        );
        assert!(parts.total() > last, "{k}: {parts:?}");
        last = parts.total();
        let table = tooth
            .table(None)
            .at(low + (high - low) * f64::from(k) / 10.0)
            .0;
        assert!((table / parts.total() - 1.0).abs() < 1e-9);
    }
    // A thin ring below the teeth, far from any published fit.
    let roll = pair.gear_1.flank_end_roll_rad;
    let thin = BeamTooth {
        bore_radius_m: 0.9 * pair.gear_1.root_radius_m,
        ..tooth
    };
    assert!(thin.parts(roll, None).total() < tooth.parts(roll, None).total());
}
