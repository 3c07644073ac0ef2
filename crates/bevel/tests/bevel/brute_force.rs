//! Contact analysis against a second method that knows no contacts: distances between dense points of both flanks.

use gearmesh_bevel::{
    Assembly, AssemblyError, BevelError, ContactKind, Flank, FlankSide, Located, PairBlank,
    PairData, Process, TcaRequest, ToothContact, tooth_contact,
};
use nalgebra::{Matrix2, Vector2};

use crate::common::{data_13_35, data_20_20};
use crate::contacts::made;

/// Points of a member along the face and in each half of the flank.
const DENSE: [usize; 2] = [81, 20];
/// Points that are roughly nearer than this are looked at closely \[m\].
const ROUGH: f64 = 8e-6;

/// Points of the part of a flank above its fillet, ends included.
fn cloud(flank: &Flank) -> Vec<Located> {
    let blank = &flank.blank;
    let mut points = Vec::new();
    for i in 0..DENSE[0] {
        let cone = blank.inner_cone_m() + blank.face_width_m * i as f64 / (DENSE[0] - 1) as f64;
        let bottom = flank.bottom(cone).unwrap();
        let low = flank.place(&bottom.point.r)[1].max(-blank.dedendum_m(cone));
        for half in [low, blank.addendum_m(cone)] {
            let mut from = flank.locate(cone, 0.0).unwrap();
            for k in 0..DENSE[1] {
                let height = half * k as f64 / (DENSE[1] - 1) as f64;
                from = flank.locate_from(cone, height, &from).unwrap();
                points.push(from);
            }
        }
    }
    points
}

/// The least gap of two flanks at turns: of all points of each, the distance of the foot on the other flank along its
/// normal. Points whose foot lies beyond the other flank's ends do not count.
fn least_gap_m(
    flanks: [&Flank; 2],
    clouds: &[Vec<Located>; 2],
    assembly: &Assembly,
    turns: [f64; 2],
) -> f64 {
    let placed = [0, 1].map(|m: usize| {
        let place = |p: &Located| assembly.members[m].placed(&p.point, turns[m]);
        clouds[m].iter().map(place).collect::<Vec<_>>()
    });
    let mut least = f64::INFINITY;
    for m in 0..2 {
        let other = 1 - m;
        for point in &placed[m] {
            let distance = |k: &usize| (placed[other][*k].r - point.r).norm_squared();
            let nearest = (0..placed[other].len())
                .min_by(|a, b| distance(a).total_cmp(&distance(b)))
                .unwrap();
            let there = &placed[other][nearest];
            if (there.r - point.r).dot(&there.n) > ROUGH || there.n.dot(&point.n) > 0.0 {
                continue;
            }
            // The foot: the way to it has no part along the flank.
            let mut at = clouds[other][nearest].at;
            let mut foot = *there;
            for _ in 0..6 {
                let own = flanks[other].point(at).unwrap();
                foot = assembly.members[other].placed(&own, turns[other]);
                let d = point.r - foot.r;
                let metric = Matrix2::from_fn(|i, k| foot.dr[i].dot(&foot.dr[k]));
                let step = metric
                    .lu()
                    .solve(&Vector2::from_fn(|i, _| foot.dr[i].dot(&d)))
                    .unwrap();
                at = [at[0] + step.x, at[1] + step.y];
            }
            if flanks[other].holds(&flanks[other].point(at).unwrap()) {
                least = least.min((foot.r - point.r).dot(&foot.n));
            }
        }
    }
    least
}

fn is_at_edge(kind: ContactKind) -> bool {
    kind != ContactKind::Flanks
}

/// At the turns that contact analysis states the flanks touch: no point is deeper than the points are coarse, none gap
/// wider.
fn touches(
    flanks: [&Flank; 2],
    blank: &PairBlank,
    error: AssemblyError,
    found: &ToothContact,
) -> [f64; 2] {
    let assembly = Assembly::new(blank, &error);
    let clouds = flanks.map(cloud);
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    let leading: Vec<_> = found.path.iter().filter(|p| p.leading).collect();
    for p in leading.iter().step_by((leading.len() / 4).max(1)) {
        let gap = least_gap_m(
            flanks,
            &clouds,
            &assembly,
            [p.touch.pinion_turn_rad, p.touch.gear_turn_rad],
        );
        range = [range[0].min(gap), range[1].max(gap)];
    }
    range
}

fn analysed(
    flanks: [&Flank; 2],
    blank: &PairBlank,
    error: AssemblyError,
    per_pitch: usize,
) -> Result<ToothContact, BevelError> {
    tooth_contact(
        flanks,
        blank,
        &TcaRequest {
            error,
            per_pitch,
            ..TcaRequest::default()
        },
    )
}

/// Pairs as designed and in assemblies far off: mate at the wrong cone distance, heavy misalignment, shaft angle 60
/// degrees, ratio 1:6 with 8 teeth. Flanks touch where the analysis says, edges and corners included.
#[test]
fn dense_points_touch_where_contact_analysis_says() {
    let right = AssemblyError::default();
    let wrong_cone = AssemblyError {
        gear_axial_m: 0.4e-3,
        pinion_axial_m: -0.3e-3,
        ..right
    };
    let heavy = AssemblyError {
        offset_m: 0.25e-3,
        pinion_axial_m: 0.2e-3,
        gear_axial_m: 0.1e-3,
        shaft_angle_rad: 5e-3,
    };
    let shaft_60 = PairData {
        shaft_angle_rad: 60f64.to_radians(),
        ..data_13_35()
    };
    let eight = PairData {
        teeth: [8, 48],
        outer_module_m: 4e-3,
        face_width_m: [24e-3; 2],
        cutter_radius_m: 76.2e-3,
        // With 20 degrees the pinion is undercut.
        pressure_angle_rad: 22.5f64.to_radians(),
        ..data_20_20()
    };
    let mut edges = 0;
    for (name, data, error) in [
        ("20/20", data_20_20(), right),
        ("13/35 wrong cone", data_13_35(), wrong_cone),
        ("13/35 heavy", data_13_35(), heavy),
        ("20/20 heavy", data_20_20(), heavy),
        ("60 deg", shaft_60.clone(), right),
        ("60 deg heavy", shaft_60, heavy),
        ("8/48", eight.clone(), right),
        ("8/48 wrong cone", eight, wrong_cone),
    ] {
        let made = made(&data, Process::Generated, FlankSide::Concave, [0.0, 0.0]);
        let flanks = [&made.pinion, &made.gear];
        let fine = analysed(flanks, &made.pair, error, 48).unwrap();
        let [deepest, widest] = touches(flanks, &made.pair, error, &fine);
        assert!(deepest > -0.01e-6, "{name}: {deepest:e} m");
        // The gap half a distance of the points beside a contact.
        assert!(widest < 1e-6, "{name}: {widest:e} m");
        edges += fine
            .path
            .iter()
            .filter(|p| p.leading && is_at_edge(p.kind))
            .count();
        // Coarse steps lose nothing: the same contacts at the same turns.
        let coarse = analysed(flanks, &made.pair, error, 8).unwrap();
        for (i, value) in coarse.error_rad.iter().enumerate() {
            let shift = fine.error_rad[6 * i] - value;
            let other = fine.error_rad[0] - coarse.error_rad[0];
            assert!((shift - other).abs() < 1e-9, "{name} {i}: {shift:e}");
        }
    }
    assert!(edges > 40, "{edges}");
}
