//! Tip edge on flank, rigid: against brute force in a fixed frame, virtual work, and the ends of the path.

use crate::pair_common;

use gearmesh_contact::{ContactLine, ContactLines, TipContact, TipGear};
use gearmesh_geometry::microgeometry::{ReliefShape, TipRelief};
use gearmesh_geometry::{GearPair, Microgeometry, Misalignment};
use pair_common::{extended, pair, ring_pair, tooth};
use proptest::prelude::*;

/// A point of a right flank in a frame with gear 1's axis at the origin and gear 2's on +x, from the tooth's own
/// geometry and the definition of the angles only.
fn placed(pair: &GearPair, gear: usize, turned_rad: f64, roll_rad: f64) -> [f64; 2] {
    let tooth = [&pair.gear_1, &pair.gear_2][gear - 1];
    let side = pair.flank_of(gear - 1);
    // A ring turns as the gear inside it, and touches it on the side away from the ring's axis.
    let sense = if gear == 1 { -1.0 } else { side.mirror() };
    let working = pair.working_pressure_angle_rad.tan();
    let point = tooth.flank_point_m(side, roll_rad);
    let pitch_point = tooth.flank_point_m(side, working);
    let is_behind = pair.gear_2.internal || (gear == 2 && !pair.gear_1.internal);
    let towards = if is_behind { std::f64::consts::PI } else { 0.0 };
    let angle = towards - pitch_point[1].atan2(pitch_point[0]) + sense * turned_rad;
    let (s, c) = angle.sin_cos();
    let centre = if gear == 1 {
        0.0
    } else {
        pair.centre_distance_m
    };
    [
        centre + c * point[0] - s * point[1],
        s * point[0] + c * point[1],
    ]
}

/// Least distance of the tip edge to the mating flank \[m\] and its roll angle, by sampling in ever smaller windows.
fn brute_force(pair: &GearPair, tip_gear: TipGear, turned_rad: [f64; 2]) -> (f64, f64) {
    let (tip, mate) = tip_gear.indices();
    let gears = [&pair.gear_1, &pair.gear_2];
    let edge = placed(
        pair,
        tip + 1,
        turned_rad[tip],
        gears[tip].flank_end_roll_rad,
    );
    let distance = |roll: f64| {
        let p = placed(pair, mate + 1, turned_rad[mate], roll);
        (p[0] - edge[0]).hypot(p[1] - edge[1])
    };
    let ends = [gears[mate].form_roll_rad, gears[mate].flank_end_roll_rad];
    let (mut low, mut high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    if pair.has_ring() {
        // The foot may stand beyond either end of the flank, whose involute goes on.
        (low, high) = (0.5 * low, high + 0.5 * low);
    }
    let mut best = (f64::INFINITY, 0.0);
    for _ in 0..12 {
        let step = (high - low) / 400.0;
        for k in 0..=400 {
            let roll = low + step * f64::from(k);
            if distance(roll) < best.0 {
                best = (distance(roll), roll);
            }
        }
        (low, high) = (best.1 - 2.0 * step, best.1 + 2.0 * step);
    }
    best
}

/// The tip edge with gears turned by θ₁, θ₂ from pair 0 at the pitch point.
fn tip_at(pair: &GearPair, tip_gear: TipGear, turned_rad: [f64; 2]) -> TipContact {
    let working = pair.working_pressure_angle_rad.tan();
    // Gear 1's flank meets the line of action nearer to its tip as it turns on, gear 2's farther from it.
    let [sense_1, sense_2] = [pair.gear_1.tip_direction(), pair.gear_2.tip_direction()];
    let rolls = [
        working + sense_1 * turned_rad[0],
        working - sense_2 * turned_rad[1],
    ];
    let (tip, mate) = tip_gear.indices();
    TipContact::new(pair, tip_gear, rolls[tip], rolls[mate])
}

fn some_pair() -> impl Strategy<Value = GearPair> {
    let gear = (25usize..90, -0.1..0.4f64, 0.0..0.4e-3f64);
    let external =
        (gear.clone(), gear).prop_map(|(a, b)| pair(&tooth(a.0, a.1, a.2), &tooth(b.0, b.1, b.2)));
    prop_oneof![
        external,
        any::<bool>().prop_map(|drives| ring_pair(0.0, drives))
    ]
}

fn either() -> impl Strategy<Value = TipGear> {
    prop_oneof![Just(TipGear::One), Just(TipGear::Two)]
}

/// Angles of both gears where a tip stands `beyond` pitches outside the path and gear 2 lags by `lag_m`.
fn angles(pair: &GearPair, tip_gear: TipGear, beyond: f64, lag_m: f64) -> [f64; 2] {
    let working = pair.working_pressure_angle_rad.tan();
    let sense = pair.gear_1.tip_direction();
    let roll = match tip_gear {
        TipGear::One => pair.roll_end_1_rad + sense * beyond * pair.pitch_1_rad(),
        TipGear::Two => pair.roll_start_1_rad - sense * beyond * pair.pitch_1_rad(),
    };
    let theta_1 = sense * (roll - working);
    let base_2 = pair.gear_2.base_radius_m;
    [
        theta_1,
        (pair.gear_1.base_radius_m * theta_1 - lag_m) / base_2,
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn gap_and_foot_are_those_of_brute_force(
        pair in some_pair(), tip_gear in either(), beyond in 0.02..0.3f64, lag in 0.0..1.0f64,
    ) {
        let open = tip_at(&pair, tip_gear, angles(&pair, tip_gear, beyond, 0.0)).gap_m;
        prop_assert!(open > 0.0, "rigid gears stand apart beyond the path: {open}");
        // Gear 2 lags until the gap is closed in part.
        let turned = angles(&pair, tip_gear, beyond, lag * open);
        let contact = tip_at(&pair, tip_gear, turned);
        let (distance, roll) = brute_force(&pair, tip_gear, turned);
        prop_assert!((contact.gap_m - distance).abs() < 1e-12, "{} {distance}", contact.gap_m);
        // The distance is flat at its minimum: the place is known to the root of the rounding.
        prop_assert!((contact.foot_roll_rad - roll).abs() < 1e-5, "{} {roll}", contact.foot_roll_rad);
    }

    /// Power in equals power out: the gap moves by the lever arms.
    #[test]
    fn the_gap_moves_by_the_lever_arms(
        pair in some_pair(), tip_gear in either(), beyond in 0.0..0.3f64, lag in 0.0..50e-6f64,
    ) {
        let turned = angles(&pair, tip_gear, beyond, lag);
        let contact = tip_at(&pair, tip_gear, turned);
        let (tip, mate) = tip_gear.indices();
        let bases = [pair.gear_1.base_radius_m, pair.gear_2.base_radius_m];
        let mut arms = [0.0; 2];
        arms[tip] = contact.tip_arm_m;
        arms[mate] = bases[mate];
        for gear in 0..2 {
            let moved = |by: f64| {
                let mut turned = turned;
                turned[gear] += by;
                tip_at(&pair, tip_gear, turned).gap_m
            };
            let step = 1e-5;
            let slope = (moved(step) - moved(-step)) / (2.0 * step);
            // Gear 1 closes the gap as it turns, gear 2 opens it.
            let expected = [-arms[0], arms[1]][gear];
            prop_assert!((slope / expected - 1.0).abs() < 1e-7, "{slope} {expected}");
        }
        // Both arms are the components of one radius.
        let gears = [&pair.gear_1, &pair.gear_2];
        let radius = gears[tip].base_radius_m * gears[tip].flank_end_roll_rad.hypot(1.0);
        let rebuilt = contact.tip_arm_m.hypot(contact.tip_friction_arm_m);
        prop_assert!((rebuilt / radius - 1.0).abs() < 1e-12);
    }

    /// The power that friction takes is force times the speed at which the edge slides over the flank.
    #[test]
    fn friction_arms_give_the_sliding_speed(
        pair in some_pair(), tip_gear in either(), beyond in 0.02..0.3f64,
    ) {
        let lines = extended(pair, 1e-4);
        let pair = &lines.pair;
        // Along the closed gap: gear 2 lags so that the edge touches.
        let touching = |beyond: f64| {
            let open = |lag: f64| tip_at(pair, tip_gear, angles(pair, tip_gear, beyond, lag)).gap_m;
            let mut lag = 0.0;
            for _ in 0..6 {
                let closing = match tip_gear {
                    TipGear::One => 1.0,
                    TipGear::Two => tip_at(pair, tip_gear, angles(pair, tip_gear, beyond, lag)).tip_arm_m
                        / pair.gear_2.base_radius_m,
                };
                lag += open(lag) / closing;
            }
            angles(pair, tip_gear, beyond, lag)
        };
        let here = touching(beyond);
        let contact = tip_at(pair, tip_gear, here);
        prop_assert!(contact.gap_m.abs() < 1e-15);
        let step = 1e-6;
        let (before, after) = (touching(beyond - step), touching(beyond + step));
        let turned = [after[0] - before[0], after[1] - before[1]];
        let foot = |angles| tip_at(pair, tip_gear, angles).foot_roll_rad;
        let (tip, mate) = tip_gear.indices();
        let mate_gear = [&pair.gear_1, &pair.gear_2][mate];
        let mate_base = mate_gear.base_radius_m;
        // The edge runs over the flank by ds = ρ dξ, towards the mate's tip where positive.
        let towards_tip = mate_gear.tip_direction() * (foot(after) - foot(before));
        let path = mate_base * contact.foot_roll_rad * towards_tip;
        let mut arms = [0.0; 2];
        arms[tip] = contact.tip_friction_arm_m;
        arms[mate] = mate_base * contact.foot_roll_rad;
        // Unit friction towards both tips: gear 1 is driven against it, gear 2 gains from it.
        let work = arms[0] * turned[0] - arms[1] * turned[1];
        prop_assert!((work / path - 1.0).abs() < 1e-6, "{work} {path}");
    }
}

fn line_at(lines: &ContactLines, roll_1_rad: f64) -> ContactLine {
    let working = lines.pair.working_pressure_angle_rad.tan();
    let mut all = Vec::new();
    lines.at(roll_1_rad - working, &mut all);
    *all.iter().find(|line| line.pair == 0).unwrap()
}

/// Everything that enters the contact problem arrives at its value on the path at least proportionally to the step; the
/// gap with its square.
#[test]
fn beyond_its_ends_the_path_continues() {
    let mut lines = extended(pair(&tooth(31, 0.2, 0.2e-3), &tooth(47, 0.1, 0.0)), 50e-6);
    lines.pair.misalignment = Misalignment {
        inclination_rad: 1e-4,
        deviation_rad: -2e-4,
    };
    for (gear, microgeometry) in [
        (&lines.pair.gear_1, &mut lines.microgeometry_1),
        (&lines.pair.gear_2, &mut lines.microgeometry_2),
    ] {
        *microgeometry = Microgeometry {
            tip_roll_rad: gear.tip_roll_rad,
            face_width_m: 20e-3,
            tip_relief: Some(TipRelief {
                amount_m: 20e-6,
                start_roll_rad: 0.8 * gear.tip_roll_rad,
                shape: ReliefShape::Parabolic,
            }),
            lead_crowning_m: 5e-6,
            ..Microgeometry::default()
        };
    }
    for (end, outwards) in [
        (lines.pair.roll_end_1_rad, 1.0),
        (lines.pair.roll_start_1_rad, -1.0),
    ] {
        let on = line_at(&lines, end - outwards * 1e-12);
        assert!(on.tip.is_none());
        let mut changes = Vec::new();
        for step in [1e-3, 1e-4, 1e-5] {
            let off = line_at(&lines, end + outwards * step);
            let tip = off.tip.unwrap();
            let arms = |line| lines.lever_arms_m(line, 0.1);
            let radius = |line: &ContactLine| {
                let pair = &lines.pair;
                pair.relative_radius_m(line.roll_1_rad, line.roll_2_rad)
            };
            let to_tip = |gear: usize| off.tilt_rad(gear).sin() + 0.1 * off.tilt_rad(gear).cos();
            changes.push([
                tip.gap_m / step,
                tip.tilt_rad,
                arms(&off)[0] - arms(&on)[0],
                arms(&off)[1] - arms(&on)[1],
                lines.closing(&off) - lines.closing(&on) + step,
                lines.separation_m(&off, 4e-3) - lines.separation_m(&on, 4e-3),
                radius(&off) - radius(&on),
                lines.edge(&off).unwrap().tilt_rad,
                off.roll_1_rad - on.roll_1_rad + step,
                off.roll_2_rad - on.roll_2_rad + step,
                off.path_m - on.path_m,
                to_tip(0) + to_tip(1) - 0.2 + step,
            ]);
        }
        for pair in changes.windows(2) {
            for (coarse, fine) in pair[0].iter().zip(&pair[1]) {
                assert!(fine.abs() <= 0.125 * coarse.abs(), "{changes:?}");
            }
        }
    }
}

/// No pair is lost or counted twice: each pair number appears once, in the order of the teeth, and the extended path
/// holds all pairs of the path.
#[test]
fn a_pair_is_on_the_path_or_at_one_tip() {
    let lines = extended(pair(&tooth(31, 0.2, 0.2e-3), &tooth(47, 0.1, 0.0)), 50e-6);
    let seed = ContactLines {
        extension: None,
        ..lines.clone()
    };
    let (mut all, mut on_path) = (Vec::new(), Vec::new());
    let (mut most, mut tips) = (0, 0);
    for k in 0..1000 {
        let angle = 2.0 * lines.pair.pitch_1_rad() * f64::from(k) / 1000.0;
        lines.at(angle, &mut all);
        seed.at(angle, &mut on_path);
        assert!(all.windows(2).all(|w| w[1].pair == w[0].pair + 1));
        let without: Vec<_> = all.iter().filter(|l| l.tip.is_none()).copied().collect();
        assert_eq!(without, on_path);
        for line in all.iter().filter(|l| l.tip.is_some()) {
            tips += 1;
            let tip = line.tip.unwrap();
            assert!(tip.gap_m > 0.0);
            assert_eq!(tip.tip_gear == TipGear::One, line.path_m > 0.0);
        }
        most = most.max(all.len());
    }
    assert_eq!(most, lines.most_pairs());
    assert!(tips > 100);
}
