//! Contact of two flanks: conjugate pairs, local synthesis, assembly errors.

use gearmesh_bevel::settings_search::{AskedEaseOff, settings_for, settings_for_ease_off};
use gearmesh_bevel::{
    Assembly, AssemblyError, Flank, FlankSide, Mesh, PairBlank, PairData, Process, Synthesis,
    SynthesisTarget, TcaRequest, ToothContact, ToothForm, basic_settings, crown_settings,
    sensitivity, tooth_contact,
};

use crate::common::{blank, data_13_35, data_20_20, near};

const EDGE: f64 = 0.3e-3;

/// Pairs cut by one crown gear: spiral, zerol and straight, of both hands, shaft angles and flanks.
#[test]
fn conjugate_pairs_have_no_transmission_error() {
    let mut pairs = vec![data_20_20(), data_13_35()];
    for shaft in [60f64, 75.0, 110.0] {
        pairs.push(PairData {
            shaft_angle_rad: shaft.to_radians(),
            ..data_13_35()
        });
    }
    pairs.push(PairData {
        form: ToothForm::Zerol,
        spiral_angle_rad: 0.0,
        ..data_20_20()
    });
    pairs.push(PairData {
        form: ToothForm::Straight,
        spiral_angle_rad: 0.0,
        cutter_radius_m: 0.0,
        teeth: [28, 40],
        ..data_20_20()
    });
    let mut worst = 0.0f64;
    for data in pairs {
        let pair = blank(&data);
        for side in FlankSide::BOTH {
            let pinion = Flank::cut(
                &pair.members[0],
                side,
                &crown_settings(&pair.members[0], &data, side, EDGE),
            )
            .unwrap();
            let gear = Flank::cut(
                &pair.members[1],
                side.mate(),
                &crown_settings(&pair.members[1], &data, side.mate(), EDGE),
            )
            .unwrap();
            let assembly = Assembly::new(&pair, &AssemblyError::default());
            let mesh = Mesh {
                flanks: [&pinion, &gear],
                assembly: &assembly,
            };
            let map = mesh.ease_off_map(9, 7).unwrap();
            let turns: Vec<f64> = map.iter().map(|(_, e)| e.pinion_turn_rad).collect();
            let span = turns.iter().copied().fold(f64::MIN, f64::max)
                - turns.iter().copied().fold(f64::MAX, f64::min);
            // The whole flank is met, over more than a pitch.
            assert!(
                span > std::f64::consts::TAU / data.teeth[0] as f64,
                "{span}"
            );
            for (_, e) in map {
                // A gap g stands for a turn of the gear by g over the normal's arm, which is above half the mean
                // radius times cos α cos β.
                let arm = 0.5 * pair.mean_cone_m * pair.members[1].pitch_angle_rad.sin();
                worst = worst.max(e.gap_m.abs() / arm);
            }
        }
    }
    assert!(worst < 1e-9, "{worst:e} rad");
}

/// A pair by local synthesis, and what was asked.
pub struct Made {
    pub pair: PairBlank,
    pub pinion: Flank,
    pub gear: Flank,
    pub asked: Synthesis,
}

pub fn made(data: &PairData, process: Process, side: FlankSide, mean_point_m: [f64; 2]) -> Made {
    let pair = blank(data);
    let index = |side: FlankSide| usize::from(side == FlankSide::Convex);
    let gear_settings = basic_settings(&pair.members[1], data, EDGE, process).unwrap();
    let gear = Flank::cut(
        &pair.members[1],
        side.mate(),
        &gear_settings[index(side.mate())],
    )
    .unwrap();
    let face = data.face_width_m[0].min(data.face_width_m[1]);
    let pitch = std::f64::consts::TAU / data.teeth[0] as f64;
    let asked = Synthesis {
        mean_point_m,
        path_angle_rad: 100f64.to_radians(),
        ellipse_half_length_m: 0.2 * face,
        marking_m: 6.35e-6,
        // 40 µrad at half a pitch.
        transmission_curvature: -2.0 * 40e-6 / (0.25 * pitch * pitch),
    };
    let target = SynthesisTarget::new(&pair, &gear, &asked).unwrap();
    let start = basic_settings(&pair.members[0], data, EDGE, Process::Generated).unwrap();
    let settings = settings_for(&pair, side, &start[index(side)], &target).unwrap();
    let pinion = Flank::cut(&pair.members[0], side, &settings).unwrap();
    Made {
        pair,
        pinion,
        gear,
        asked,
    }
}

fn analysed(made: &Made, error: AssemblyError) -> ToothContact {
    tooth_contact(
        [&made.pinion, &made.gear],
        &made.pair,
        &TcaRequest {
            error,
            ..TcaRequest::default()
        },
    )
    .unwrap()
}

/// What local synthesis was asked against what contact analysis finds: point, path, ellipse and second derivative.
#[test]
fn local_synthesis_reaches_what_is_asked() {
    for (data, process, side, point) in [
        (
            data_20_20(),
            Process::Generated,
            FlankSide::Concave,
            [0.0, 0.0],
        ),
        (
            data_20_20(),
            Process::Generated,
            FlankSide::Convex,
            [0.5e-3, 0.2e-3],
        ),
        (
            data_13_35(),
            Process::Generated,
            FlankSide::Concave,
            [-1e-3, 0.5e-3],
        ),
        (
            data_13_35(),
            Process::Formate,
            FlankSide::Convex,
            [-2e-3, 0.3e-3],
        ),
    ] {
        let made = made(&data, process, side, point);
        let found = analysed(&made, AssemblyError::default());
        let gear = made.gear.point(found.mean.unwrap().at[1]).unwrap();
        let place = made.gear.place(&gear.r);
        near(place[0] - made.pair.mean_cone_m, point[0], 1e-9);
        near(place[1], point[1], 1e-9);
        let ellipse = gearmesh_bevel::ContactEllipse::at(&found.mean.unwrap());
        near(
            ellipse.half_lengths_m(made.asked.marking_m)[0] / made.asked.ellipse_half_length_m,
            1.0,
            1e-6,
        );
        // Path and transmission function by differences round the mean contact.
        let assembly = Assembly::new(&made.pair, &AssemblyError::default());
        let mesh = Mesh {
            flanks: [&made.pinion, &made.gear],
            assembly: &assembly,
        };
        let h = 2e-3;
        let at = found.mean.unwrap().pinion_turn_rad;
        let (up, down) = (
            mesh.touch(at + h, &found.mean.unwrap()).unwrap(),
            mesh.touch(at - h, &found.mean.unwrap()).unwrap(),
        );
        let leads = [&down, &found.mean.unwrap(), &up].map(|t| mesh.lead_rad(t));
        near((leads[2] - leads[0]) / (2.0 * h), 0.0, 1e-7);
        let curvature = (leads[0] - 2.0 * leads[1] + leads[2]) / (h * h);
        near(curvature / made.asked.transmission_curvature, 1.0, 1e-2);
        let [along, profile] = made.gear.directions(&gear);
        let step = made.gear.point(up.at[1]).unwrap().r - made.gear.point(down.at[1]).unwrap().r;
        // The path has no direction, so that angles are compared modulo 180 degrees.
        let angle = step.dot(&profile).atan2(step.dot(&along)).to_degrees();
        near((angle - 100.0 + 270.0).rem_euclid(180.0) - 90.0, 0.0, 0.1);
        assert!(found.contact_ratio > 0.5, "{}", found.contact_ratio);
    }
}

/// Assembly errors move the contact continuously and by the stated sensitivity. On the drive side (pinion concave,
/// gear convex) a pinion moved away from the apex
/// brings it towards the toe and the tip of the gear (docs/theory/bevel_gears.md); a gear moved away does the opposite.
#[test]
fn assembly_errors_move_the_contact_in_the_known_directions() {
    for data in [data_20_20(), data_13_35()] {
        let made = made(&data, Process::Generated, FlankSide::Concave, [0.0, 0.0]);
        let flanks = [&made.pinion, &made.gear];
        let none = AssemblyError::default();
        let mean = analysed(&made, none).mean.unwrap();
        let slope = sensitivity(flanks, &made.pair, (&none, &mean)).unwrap();
        assert!(
            slope.pinion_axial[0] < 0.0 && slope.pinion_axial[1] > 0.0,
            "{slope:?}"
        );
        assert!(
            slope.gear_axial[0] > 0.0 && slope.gear_axial[1] < 0.0,
            "{slope:?}"
        );
        assert!(slope.shaft_angle[0] < 0.0, "{slope:?}");
        // An offset moves it the other way on the other hand; the mirror image has the opposite sign.
        let mirrored = made_mirrored(&data);
        let other = sensitivity(
            [&mirrored.pinion, &mirrored.gear],
            &mirrored.pair,
            (&none, &analysed(&mirrored, none).mean.unwrap()),
        )
        .unwrap();
        for i in 0..2 {
            near(other.offset[i] / slope.offset[i], -1.0, 1e-4);
            near(other.pinion_axial[i] / slope.pinion_axial[i], 1.0, 1e-4);
        }
        for (size, tolerance) in [(0.1e-6, 0.05), (1e-6, 0.5)] {
            let error = AssemblyError {
                pinion_axial_m: size,
                gear_axial_m: -0.5 * size,
                offset_m: 0.5 * size,
                shaft_angle_rad: 0.0,
            };
            let found = analysed(&made, error);
            let place = made
                .gear
                .place(&made.gear.point(found.mean.unwrap().at[1]).unwrap().r);
            let linear = |i: usize| {
                size * (slope.pinion_axial[i] - 0.5 * slope.gear_axial[i] + 0.5 * slope.offset[i])
            };
            let moved = [place[0] - made.pair.mean_cone_m, place[1]];
            let miss = (moved[0] - linear(0)).hypot(moved[1] - linear(1));
            assert!(
                miss < tolerance * linear(0).hypot(linear(1)),
                "{moved:?} {} {}",
                linear(0),
                linear(1)
            );
        }
    }
}

fn made_mirrored(data: &PairData) -> Made {
    made(
        &PairData {
            pinion_hand: data.pinion_hand.mate(),
            ..data.clone()
        },
        Process::Generated,
        FlankSide::Concave,
        [0.0, 0.0],
    )
}

/// Hands and units: the mirror image has the same transmission error, a pair ten times as large, too.
#[test]
fn mirror_images_and_larger_pairs_mesh_alike() {
    let data = data_13_35();
    let first = analysed(
        &made(&data, Process::Generated, FlankSide::Concave, [0.0, 0.0]),
        AssemblyError::default(),
    );
    let second = analysed(&made_mirrored(&data), AssemblyError::default());
    near(second.peak_to_peak_rad, first.peak_to_peak_rad, 1e-11);
    near(second.contact_ratio, first.contact_ratio, 1e-8);
    assert!(first.edge_share < 0.2 && first.contact_ratio > 1.0);
}

/// Contacts at every place of a path: both points in one place, normals opposite, nothing of the mate's neighbourhood
/// inside the tooth.
#[test]
fn flanks_touch_and_do_not_cut_into_each_other() {
    for error in [
        AssemblyError::default(),
        AssemblyError {
            offset_m: 30e-6,
            pinion_axial_m: -40e-6,
            gear_axial_m: 20e-6,
            shaft_angle_rad: 2e-4,
        },
    ] {
        let made = made(
            &data_13_35(),
            Process::Generated,
            FlankSide::Concave,
            [0.0, 0.0],
        );
        let assembly = Assembly::new(&made.pair, &error);
        let mesh = Mesh {
            flanks: [&made.pinion, &made.gear],
            assembly: &assembly,
        };
        let found = analysed(&made, error);
        let mut edges = 0;
        for p in &found.path {
            let [a, b] = &p.touch.points;
            near((a.r - b.r).norm(), 0.0, 1e-11);
            if let Some(ellipse) = &p.ellipse {
                near((a.n + b.n).norm(), 0.0, 1e-9);
                near(ellipse.half_lengths_m(6.35e-6)[0].log10(), -2.3, 0.3);
            } else {
                edges += 1;
            }
        }
        assert!(edges > 5, "{edges}");
        // Ease-off in this assembly: nowhere deeper than where it touches first, by the gear's turn.
        let deepest = found
            .ease_off
            .iter()
            .map(|(_, e)| e.unwrap().gap_m)
            .fold(f64::INFINITY, f64::min);
        let touch = mesh
            .ease_off(
                found.mean.unwrap().at[0],
                &found.ease_off[found.ease_off.len() / 2].1.unwrap(),
            )
            .unwrap();
        assert!(
            deepest > touch.gap_m - 0.2e-6,
            "{deepest:e} {:e}",
            touch.gap_m
        );
    }
}

/// Beyond the ends of the flanks' path tips touch; a pair shifted far meets at its heel or toe.
#[test]
fn edges_touch_at_tip_toe_and_heel() {
    use gearmesh_bevel::{ContactKind, EdgeKind};
    let made = made(
        &data_13_35(),
        Process::Generated,
        FlankSide::Concave,
        [0.0, 0.0],
    );
    let kinds = |found: &ToothContact| -> Vec<EdgeKind> {
        let mut list = Vec::new();
        for p in &found.path {
            if let (ContactKind::Edge { edge, .. }, true) = (p.kind, p.leading)
                && !list.contains(&edge)
            {
                list.push(edge);
            }
        }
        list
    };
    assert_eq!(
        kinds(&analysed(&made, AssemblyError::default())),
        [EdgeKind::Tip]
    );
    // The mean contact near an end of the face: part of the path lies beyond it.
    for (along, edge) in [(13.9e-3, EdgeKind::Heel), (-13.9e-3, EdgeKind::Toe)] {
        let made = self::made(
            &data_13_35(),
            Process::Generated,
            FlankSide::Concave,
            [along, 0.0],
        );
        let found = analysed(&made, AssemblyError::default());
        assert!(
            kinds(&found).contains(&edge),
            "{:?} {}",
            kinds(&found),
            found.edge_share
        );
    }
}

/// Settings fitted to an ease-off leave little of it, and the map of the fitted pair is that.
#[test]
fn settings_fitted_to_an_ease_off() {
    for side in FlankSide::BOTH {
        let data = data_13_35();
        let pair = blank(&data);
        let index = |side: FlankSide| usize::from(side == FlankSide::Convex);
        let gear = Flank::cut(
            &pair.members[1],
            side.mate(),
            &basic_settings(&pair.members[1], &data, EDGE, Process::Generated).unwrap()
                [index(side.mate())],
        )
        .unwrap();
        let start =
            basic_settings(&pair.members[0], &data, EDGE, Process::Generated).unwrap()[index(side)];
        let asked = AskedEaseOff {
            lengthwise_m: 30e-6,
            profile_m: 10e-6,
            bias_m: 5e-6,
        };
        let (settings, rms) = settings_for_ease_off(&pair, &gear, &start, &asked).unwrap();
        assert!(rms < 3e-6, "{rms:e}");
        let pinion = Flank::cut(&pair.members[0], side, &settings).unwrap();
        let assembly = Assembly::new(&pair, &AssemblyError::default());
        let map = Mesh {
            flanks: [&pinion, &gear],
            assembly: &assembly,
        }
        .ease_off_map(7, 5)
        .unwrap();
        let squares: f64 = map
            .iter()
            .map(|(p, e)| (e.gap_m - asked.at(&pair, *p)).powi(2))
            .sum();
        near((squares / map.len() as f64).sqrt(), rms, 1e-12);
        // Without a search the flanks stand much farther off.
        let basic = Flank::cut(&pair.members[0], side, &start).unwrap();
        let map = Mesh {
            flanks: [&basic, &gear],
            assembly: &assembly,
        }
        .ease_off_map(7, 5)
        .unwrap();
        let squares: f64 = map
            .iter()
            .map(|(p, e)| (e.gap_m - asked.at(&pair, *p)).powi(2))
            .sum();
        assert!((squares / map.len() as f64).sqrt() > 5.0 * rms);
        tooth_contact([&pinion, &gear], &pair, &TcaRequest::default()).unwrap();
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let made = made(
        &data_20_20(),
        Process::Generated,
        FlankSide::Concave,
        [0.0, 0.0],
    );
    let short = Synthesis {
        ellipse_half_length_m: 0.1e-3,
        ..made.asked
    };
    let error = SynthesisTarget::new(&made.pair, &made.gear, &short)
        .unwrap_err()
        .to_string();
    assert!(error.contains("ask for a longer ellipse"), "{error}");
    // Axes 5 mm beside each other: edges only, and no contact at constant ratio.
    let far = AssemblyError {
        offset_m: 5e-3,
        ..AssemblyError::default()
    };
    let found = analysed(&made, far);
    assert!(found.mean.is_none() && found.edge_share > 0.99);
    // Conjugate flanks have no contact point.
    let data = data_20_20();
    let side = FlankSide::Concave;
    let pinion = Flank::cut(
        &made.pair.members[0],
        side,
        &crown_settings(&made.pair.members[0], &data, side, EDGE),
    )
    .unwrap();
    let gear = Flank::cut(
        &made.pair.members[1],
        side.mate(),
        &crown_settings(&made.pair.members[1], &data, side.mate(), EDGE),
    )
    .unwrap();
    let error = tooth_contact([&pinion, &gear], &made.pair, &TcaRequest::default())
        .unwrap_err()
        .to_string();
    assert!(error.contains("line"), "{error}");
}
