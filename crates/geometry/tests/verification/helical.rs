//! Helical teeth: closed formulas, the fillet against its enveloping rack, contact of two helicoids, refusals.

use gearmesh_geometry::definition::ToothDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{
    Flank, GearDefinition, GearPair, Misalignment, PairError, ToothGeometry, involute,
};
use std::f64::consts::{PI, TAU};

const FACE_WIDTH_M: f64 = 30e-3;

fn tooth(teeth: usize, helix_deg: f64, profile_shift: f64) -> ToothDefinition {
    ToothDefinition {
        teeth,
        gearing: Default::default(),
        module_m: 3e-3,
        pressure_angle_rad: 20f64.to_radians(),
        profile_shift,
        addendum: 1.0,
        dedendum: 1.25,
        rack_tip_radius: 0.30,
        tip_diameter_m: None,
        thickness_allowance_m: 0.05e-3,
        tip_chamfer_m: 0.0,
        face_width_m: FACE_WIDTH_M,
        helix_angle_rad: helix_deg.to_radians(),
    }
}

fn pair(helix_1_deg: f64, helix_2_deg: f64) -> Result<GearPair, PairError> {
    let gears = [tooth(24, helix_1_deg, 0.2), tooth(37, helix_2_deg, -0.05)];
    let [g1, g2] = gears.map(|g| ToothGeometry::new(&g).unwrap());
    let centre = g1.reference_radius_m + g2.reference_radius_m + 0.45e-3;
    GearPair::new(g1, g2, centre, Misalignment::default())
}

fn turned(p: [f64; 2], angle: f64) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    [c * p[0] - s * p[1], s * p[0] + c * p[1]]
}

#[test]
fn transverse_sizes_follow_from_normal_ones() {
    for helix_deg in [8.0f64, -20.0, 30.0, -44.0] {
        let d = tooth(31, helix_deg, 0.1);
        let g = ToothGeometry::new(&d).unwrap();
        let beta = helix_deg.to_radians();
        let alpha_t = (d.pressure_angle_rad.tan() / beta.cos()).atan();
        assert!((g.reference_radius_m - 0.5 * 31.0 * 3e-3 / beta.cos()).abs() < 1e-16);
        assert!((g.base_radius_m - g.reference_radius_m * alpha_t.cos()).abs() < 1e-16);
        assert!((g.tip_radius_m - g.root_radius_m - 2.25 * 3e-3).abs() < 1e-16);
        let base_helix = g.base_helix_angle_rad();
        // Another relation than the one the code uses.
        assert!((base_helix.sin() - beta.sin() * d.pressure_angle_rad.cos()).abs() < 1e-15);
        assert!((g.twist_rad_per_m() - base_helix.tan() / g.base_radius_m).abs() < 1e-12);
        assert_eq!(g.hand(), if helix_deg > 0.0 { "right" } else { "left" });
        // Thickness on the reference circle: s_t = s_n/cos β less the allowance.
        let alpha_roll = alpha_t.tan();
        let thickness = 2.0 * g.reference_radius_m * g.half_angle_rad(alpha_roll);
        let normal = 3e-3 * (0.5 * PI + 0.2 * d.pressure_angle_rad.tan());
        assert!((thickness + 0.05e-3 - normal / beta.cos()).abs() < 1e-15);
        // Virtual teeth: reference radius of the normal section's osculating circle r/cos²β_b over half a module.
        let virtual_radius = g.reference_radius_m / base_helix.cos().powi(2);
        assert!((g.virtual_teeth() - virtual_radius / 1.5e-3).abs() < 1e-10);
    }
}

#[test]
fn a_vanishing_helix_is_a_spur_gear() {
    let (spur, almost) = (tooth(31, 0.0, 0.1), tooth(31, 1e-7, 0.1));
    let (spur, almost) = (
        ToothGeometry::new(&spur).unwrap(),
        ToothGeometry::new(&almost).unwrap(),
    );
    assert_eq!(spur.twist_rad_per_m(), 0.0);
    assert_eq!(spur.hand(), "none");
    for k in 0..=20 {
        let share = f64::from(k) / 20.0;
        let p = spur.fillet.point_m(share * spur.fillet_end);
        let q = almost.fillet.point_m(share * almost.fillet_end);
        assert!((p[0] - q[0]).hypot(p[1] - q[1]) < 1e-16);
        let roll = spur.form_roll_rad + share * (spur.tip_roll_rad - spur.form_roll_rad);
        let p = spur.flank_point_m(Flank::Left, roll);
        let q = almost.flank_point_m(Flank::Left, roll);
        assert!((p[0] - q[0]).hypot(p[1] - q[1]) < 1e-16);
    }
}

/// The fillet is the envelope of the rack's rounding, an ellipse in the transverse section: in the rack's own frame a
/// fillet point stays outside the ellipse while the gear rolls and touches it once.
#[test]
fn the_fillet_is_the_envelope_of_an_elliptic_rounding() {
    for (teeth, helix_deg, shift) in [
        (31, 25.0f64, 0.1),
        (31, -40.0, 0.0),
        (60, 15.0, 0.5),
        (31, 0.0, 0.1),
    ] {
        let d = tooth(teeth, helix_deg, shift);
        let g = ToothGeometry::new(&d).unwrap();
        let cos = helix_deg.to_radians().cos();
        let (r, rho) = (g.reference_radius_m, 0.30 * 3e-3);
        let depth = (1.25 - shift) * 3e-3 - rho;
        // Distance of the rounding's centre from the rack tooth's centre line, from the flank's own line: at the height
        // h above the rack tooth's tip line (normal section) the half width is E_n + ρ cos α_n where it ends.
        let (sin_n, cos_n) = d.pressure_angle_rad.sin_cos();
        let half_pitch = 0.25 * PI * 3e-3;
        let at_end = half_pitch - (1.25 * 3e-3 - rho + rho * sin_n) * d.pressure_angle_rad.tan();
        let offset = (at_end - rho * cos_n) / cos + 0.5 * 0.05e-3;
        let space = -PI / teeth as f64;
        for k in 1..20 {
            let q = g.fillet.point_m(g.fillet_end * f64::from(k) / 20.0);
            let inside = |pitch_angle: f64| {
                let [radial, tangential] = turned(q, -pitch_angle);
                let along = tangential + r * (pitch_angle - space) - offset;
                (along * cos / rho).powi(2) + ((r - radial - depth) / rho).powi(2) - 1.0
            };
            let (mut low, mut high) = (space - 0.35, space + 0.35);
            let mut least = f64::INFINITY;
            // Successive refinement of a scan: no derivative of the curve is used.
            for _ in 0..12 {
                let step = (high - low) / 200.0;
                let best = (0..=200)
                    .map(|i| low + step * f64::from(i))
                    .min_by(|a, b| inside(*a).total_cmp(&inside(*b)))
                    .unwrap();
                least = inside(best);
                (low, high) = (best - step, best + step);
            }
            assert!(least.abs() < 1e-10, "{helix_deg} deg, point {k}: {least}");
        }
        // Common tangent with the involute.
        let end = g.fillet.point_m(g.fillet_end);
        let start = g.flank_point_m(Flank::Right, g.form_roll_rad);
        assert!((end[0] - start[0]).hypot(end[1] - start[1]) < 1e-12);
        let (_, t) = g.flank_frame(Flank::Right, g.form_roll_rad);
        let angle = g.fillet.tangent_angle_rad(g.fillet_end);
        assert!((t[1].atan2(t[0]) - angle).abs() < 1e-12);
    }
}

#[test]
fn the_normal_stands_on_the_helicoid() {
    for helix_deg in [18.0, -33.0] {
        let g = ToothGeometry::new(&tooth(31, helix_deg, 0.1)).unwrap();
        for side in [Flank::Right, Flank::Left] {
            let point = |roll: f64, z: f64| {
                let [x, y] = turned(g.flank_point_m(side, roll), z * g.twist_rad_per_m());
                [x, y, z]
            };
            for roll in [0.3, 0.4, 0.5] {
                let n = g.flank_normal(side, roll);
                assert!((n.iter().map(|v| v * v).sum::<f64>() - 1.0).abs() < 1e-15);
                let h = 1e-5;
                for (a, b) in [
                    (point(roll + h, 0.0), point(roll - h, 0.0)),
                    (point(roll, h), point(roll, -h)),
                ] {
                    let step: [f64; 3] = std::array::from_fn(|i| a[i] - b[i]);
                    let length = step.iter().map(|v| v * v).sum::<f64>().sqrt();
                    let along: f64 = step.iter().zip(n).map(|(s, n)| s * n).sum();
                    assert!(along.abs() < 1e-9 * length, "{}", along / length);
                }
            }
        }
    }
}

/// In every section the two flanks meet in one point with opposite normals: the roll angles along a contact line.
#[test]
fn helicoids_of_opposite_hand_touch_along_the_contact_line() {
    for (helix_deg, side) in [
        (22.0, Flank::Right),
        (-22.0, Flank::Right),
        (22.0, Flank::Left),
        (-22.0, Flank::Left),
    ] {
        let pair = pair(helix_deg, -helix_deg).unwrap().on_flanks(side);
        let mirror = side.mirror();
        let (g1, g2) = (&pair.gear_1, &pair.gear_2);
        let working = pair.working_pressure_angle_rad.tan();
        for (theta, p) in [(0.0, 0i64), (0.11, 1), (-0.07, -1)] {
            let [tooth_1, tooth_2] = pair.teeth_of(p);
            for z in [-10e-3, 0.0, 7e-3] {
                let roll_1 = pair.roll_1_rad(theta, p) + z * pair.roll_slope_1_rad_per_m();
                let roll_2 = pair.roll_2_rad(roll_1);
                // Gear 1 turns against the mirror's sense (clockwise for right flanks), gear 2 with it; both stand so
                // that tooth 0 touches at the pitch point when θ = 0.
                let theta_2 = theta * g1.base_radius_m / g2.base_radius_m;
                let place = |g: &ToothGeometry, start: f64, tooth: usize, turn: f64| {
                    start
                        + mirror * (g.half_angle_rad(working) + turn)
                        + TAU * tooth as f64 / g.teeth as f64
                        + z * g.twist_rad_per_m()
                };
                let angle_1 = place(g1, 0.0, tooth_1, -theta);
                let angle_2 = place(g2, PI, tooth_2, theta_2);
                let a = turned(g1.flank_point_m(side, roll_1), angle_1);
                let b = turned(g2.flank_point_m(side, roll_2), angle_2);
                let distance = (a[0] - b[0] - pair.centre_distance_m).hypot(a[1] - b[1]);
                assert!(distance < 1e-15, "{helix_deg} {side:?} z {z}: {distance}");
                let n1 = g1.flank_normal(side, roll_1);
                let n2 = g2.flank_normal(side, roll_2);
                let (t1, t2) = (
                    turned([n1[0], n1[1]], angle_1),
                    turned([n2[0], n2[1]], angle_2),
                );
                assert!((t1[0] + t2[0]).hypot(t1[1] + t2[1]) < 1e-14);
                assert!((n1[2] + n2[2]).abs() < 1e-15);
            }
        }
    }
}

/// Gear 2 tilted as a rigid body about the pitch point at mid-face, displacement along its own flank's normal.
#[test]
fn misalignment_opens_the_flanks_as_a_rigid_tilt_does() {
    for (helix_deg, side) in [
        (0.0, Flank::Right),
        (22.0, Flank::Right),
        (-22.0, Flank::Right),
        (22.0, Flank::Left),
    ] {
        for (inclination_rad, deviation_rad) in [(1.0, 0.0), (0.0, 1.0)] {
            let mut pair = pair(helix_deg, -helix_deg).unwrap().on_flanks(side);
            pair.misalignment = Misalignment {
                inclination_rad,
                deviation_rad,
            };
            let mirror = side.mirror();
            let alpha_w = pair.working_pressure_angle_rad;
            // Gear 2 stands at +x of gear 1, which pushes it along (sin α_w, ∓cos α_w).
            let push = [alpha_w.sin(), -mirror * alpha_w.cos()];
            // ω × e_z is the axis' displacement per metre: +x for the inclination, ∓y for the deviation.
            let omega = [mirror * deviation_rad, inclination_rad];
            let g2 = &pair.gear_2;
            for (z, path) in [(8e-3, 0.0), (0.0, 4e-3), (-5e-3, -3e-3)] {
                let roll_1 = alpha_w.tan() + path / pair.gear_1.base_radius_m;
                let n = g2.flank_normal(side, pair.roll_2_rad(roll_1));
                let cos = n[0].hypot(n[1]);
                let normal = [cos * push[0], cos * push[1], n[2]];
                let arm = [path * push[0], path * push[1], z];
                let moved = [
                    omega[1] * arm[2],
                    -omega[0] * arm[2],
                    omega[0] * arm[1] - omega[1] * arm[0],
                ];
                let opened: f64 = moved.iter().zip(normal).map(|(a, b)| a * b).sum();
                let found = pair.base_helix_angle_rad().cos() * pair.misalignment_gap_m(z, path);
                assert!(
                    (found - opened).abs() < 1e-15,
                    "{helix_deg} {side:?}: {found} {opened}"
                );
            }
        }
    }
}

#[test]
fn contact_ratios_follow_the_closed_formulas() {
    let pair = pair(20.0, -20.0).unwrap();
    let beta = 20f64.to_radians();
    let overlap = FACE_WIDTH_M * beta.sin() / (PI * 3e-3);
    assert!((pair.overlap_ratio(FACE_WIDTH_M) - overlap).abs() < 1e-13);
    let alpha_t = (20f64.to_radians().tan() / beta.cos()).atan();
    let (z1, z2, shifts) = (24.0, 37.0, 0.15);
    let m_t = 3e-3 / beta.cos();
    let base = |z: f64| 0.5 * m_t * z * alpha_t.cos();
    let a = 0.5 * m_t * (z1 + z2) + 0.45e-3;
    let alpha_w = ((base(z1) + base(z2)) / a).acos();
    assert!((pair.working_pressure_angle_rad - alpha_w).abs() < 1e-14);
    let tip = |z: f64, x: f64| 0.5 * m_t * z + 3e-3 * (1.0 + x);
    let length = |z: f64, x: f64| (tip(z, x).powi(2) - base(z).powi(2)).sqrt();
    let transverse =
        (length(z1, 0.2) + length(z2, -0.05) - a * alpha_w.sin()) / (PI * m_t * alpha_t.cos());
    assert!((pair.contact_ratio() - transverse).abs() < 1e-12);
    assert!((pair.total_contact_ratio(FACE_WIDTH_M) - transverse - overlap).abs() < 1e-12);
    // Backlash: what the centre distance adds to the thickness allowances, by the involute of the working angle.
    let inv = involute::involute_function;
    let free = 2.0 * a / (z1 + z2)
        * ((z1 + z2) * (inv(alpha_w) - inv(alpha_t)) - 2.0 * shifts * 20f64.to_radians().tan());
    let allowances = 2.0 * 0.05e-3 * alpha_t.cos() / alpha_w.cos();
    assert!((pair.backlash_m() - free - allowances).abs() < 1e-12);
}

#[test]
fn helices_that_do_not_fit_are_refused_with_reasons() {
    for (helix_1, helix_2) in [(20.0, 20.0), (20.0, 0.0), (0.0, -20.0), (20.0, -20.1)] {
        let error = pair(helix_1, helix_2).unwrap_err();
        let text = error.to_string();
        assert!(
            matches!(error, PairError::Helix { .. } | PairError::BasePitch { .. }),
            "{text}"
        );
        assert!(
            text.contains("helix angle") || text.contains("opposite hand"),
            "{text}"
        );
    }
    let same_hand = pair(20.0, 20.0).unwrap_err().to_string();
    assert!(same_hand.contains("(right) and"), "{same_hand}");
}

#[test]
fn a_gear_file_states_angle_and_hand_together() {
    let file = include_str!("../../../../fe_models/gear2.toml");
    let with = |lines: &str| {
        let text = file.replacen("[tooth]\n", &format!("[tooth]\n{lines}\n"), 1);
        GearDefinition::from_document(&InputDocument::new("g.toml", text))
            .map_err(|e| e.to_string())
    };
    let right = with("helix_angle_deg = 15.0\nhand = \"right\"").unwrap();
    let left = with("helix_angle_deg = 15.0\nhand = \"left\"").unwrap();
    assert!(right.profile.twist_rad_per_m() > 0.0);
    assert_eq!(
        right.profile.twist_rad_per_m(),
        -left.profile.twist_rad_per_m()
    );
    for (lines, needed) in [
        ("helix_angle_deg = 15.0", "needs hand"),
        ("hand = \"left\"", "is not used"),
        ("helix_angle_deg = 0\nhand = \"left\"", "is not used"),
        (
            "helix_angle_deg = -15\nhand = \"left\"",
            "0 up to, not including, 45",
        ),
        (
            "helix_angle_deg = 45\nhand = \"left\"",
            "0 up to, not including, 45",
        ),
        ("helix_angle_deg = 15\nhand = \"up\"", "hand"),
    ] {
        let text = with(lines).unwrap_err();
        assert!(text.contains(needed), "{lines}: {text}");
    }
    let internal = file.replacen("teeth = 57", "teeth = -57", 1);
    let text = GearDefinition::from_document(&InputDocument::new("g.toml", internal))
        .unwrap_err()
        .to_string();
    assert!(text.contains("internal teeth"), "{text}");
}
