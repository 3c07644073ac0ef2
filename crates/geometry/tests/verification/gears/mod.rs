//! The gears of pairs A and B (seed 004 in docs/sources.md) against the numbers stated for them, gears that cannot be,
//! and what holds for gears, pairs and gear files of any numbers.

mod cut_into_shaft;
mod microgeometry_tables;
mod random_files;
mod random_flanks;
mod random_pairs;
mod random_teeth;

use gearmesh_geometry::definition::ToothDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{
    Flank, GearDefinition, GearPair, Misalignment, PairError, ProfileCurve, ToothGeometry,
};
use std::path::Path;

fn model(name: &str) -> GearDefinition {
    GearDefinition::read(
        &Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../fe_models")
            .join(name),
    )
    .unwrap()
}

fn edited(find: &str, replace: &str) -> Result<GearDefinition, String> {
    let text = model("gear3.toml").source;
    assert!(
        text.contains(find),
        "the test edits `{find}`, which is not in the file"
    );
    GearDefinition::from_document(&InputDocument::new(
        "gear.toml",
        text.replacen(find, replace, 1),
    ))
    .map_err(|e| e.to_string())
}

#[test]
fn pair_a_has_the_stated_numbers() {
    let g = model("gear1.toml");
    assert!((g.profile.tip_radius_m - 77.558e-3).abs() < 1e-9);
    assert!((g.profile.root_radius_m - 71.708e-3).abs() < 1e-9);
    let pair = GearPair::new(
        g.profile.clone(),
        model("gear2.toml").profile,
        0.150,
        Misalignment::default(),
    )
    .unwrap();
    assert!((pair.working_pressure_angle_rad.to_degrees() - 21.8107).abs() < 5e-5);
    assert!(
        (pair.backlash_m() - 0.120e-3).abs() < 0.5e-6,
        "{}",
        pair.backlash_m()
    );
    assert!(
        (pair.contact_ratio() - 1.639).abs() < 5e-4,
        "{}",
        pair.contact_ratio()
    );
    let (rho_1, rho_2) = pair.curvature_radii_m(pair.roll_1_rad(0.0, 0));
    assert!((rho_1 + rho_2 - 0.150 * pair.working_pressure_angle_rad.sin()).abs() < 1e-15);
    assert!(
        (rho_1 - rho_2).abs() < 1e-15,
        "equal gears touch in the middle at the pitch point"
    );
    assert_eq!(pair.pairs_in_contact(0.0).count(), 1);
    assert!(pair.sliding_velocity_m_per_s(pair.roll_1_rad(1e-3, 0), 1.0) > 0.0);
    assert!(pair.sliding_velocity_m_per_s(pair.roll_1_rad(-1e-3, 0), 1.0) < 0.0);
}

#[test]
fn the_profile_is_continuous_and_smooth_where_it_must_be() {
    let g = model("gear1.toml").profile;
    let fillet_end = g.fillet.point_m(g.fillet_end);
    let flank_start = g.flank_point_m(Flank::Right, g.form_roll_rad);
    assert!((fillet_end[0] - flank_start[0]).hypot(fillet_end[1] - flank_start[1]) < 1e-12);
    let (_, tangent) = g.flank_frame(Flank::Right, g.form_roll_rad);
    let angle = g.fillet.tangent_angle_rad(g.fillet_end);
    assert!((tangent[1].atan2(tangent[0]) - angle).abs() < 1e-12);
    let deepest = g.fillet.point_m(0.0);
    assert!((deepest[0].hypot(deepest[1]) - g.root_radius_m).abs() < 1e-15);
    let curve = ProfileCurve::new(&g);
    let n = 5000;
    let mut last = curve.point_at(0.0);
    for k in 1..=n {
        let p = curve.point_at(curve.length_m() * f64::from(k) / f64::from(n));
        let step = (p[0] - last[0]).hypot(p[1] - last[1]);
        // A chord is shorter than its arc, most across the tip corner; it is never longer beyond the table's
        // interpolation (2e-3).
        let share = step * f64::from(n) / curve.length_m();
        assert!(
            share < 1.0 + 2e-3 && share > if k == 4404 { 0.6 } else { 0.998 },
            "step {k}: {share}"
        );
        last = p;
    }
}

#[test]
fn a_pinion_with_few_teeth_is_undercut_and_a_hopeless_one_refused() {
    let pinion = |teeth: usize, shift: f64| {
        let text = model("gear1.toml").source;
        let text = text
            .replacen("teeth = 57", &format!("teeth = {teeth}"), 1)
            .replacen(
                "profile_shift = 0.33",
                &format!("profile_shift = {shift}"),
                1,
            )
            .replacen("bore_diameter_mm = 50.0", "bore_diameter_mm = 4.0", 1)
            .replacen("profile_crowning_um = 10.0", "", 1)
            .replacen("profile_crowning_diameter_mm = 150.0", "", 1);
        GearDefinition::from_document(&InputDocument::new("p.toml", text))
    };
    let free = pinion(20, 0.0).unwrap().profile;
    assert!(!free.undercut);
    let cut = pinion(12, 0.0).unwrap().profile;
    assert!(cut.undercut);
    let at = cut.fillet.point_m(cut.fillet_end);
    let flank = cut.flank_point_m(Flank::Right, cut.form_roll_rad);
    assert!(
        (at[0] - flank[0]).hypot(at[1] - flank[1]) < 1e-9,
        "the curves cross"
    );
    // No undercut needs x ≥ h − ρ(1 − sin α) − z sin²α/2: just above and below that limit.
    let limit =
        1.25 - 0.38 * (1.0 - 20f64.to_radians().sin()) - 6.0 * 20f64.to_radians().sin().powi(2);
    assert!(!pinion(12, limit + 1e-6).unwrap().profile.undercut);
    assert!(pinion(12, limit - 1e-3).unwrap().profile.undercut);
    let text = pinion(6, -0.9).unwrap_err().to_string();
    assert!(
        text.contains("undercut destroys the tooth") || text.contains("radii"),
        "{text}"
    );
    assert!(pinion(12, 1.2).unwrap_err().to_string().contains("pointed"));
}

#[test]
fn impossible_gears_are_refused_with_line_key_found_and_allowed() {
    for (find, replace, expected) in [
        (
            "web_thickness_mm = 5.0",
            "web_thickness_mm = -5.0",
            "gear.toml:19: blank.web_thickness_mm: found -5, allowed is at least 0.0026, a thousandth of a module",
        ),
        (
            "web_thickness_mm = 5.0",
            "web_thickness_m = 0.005",
            "did you mean `web_thickness_mm`? The unit is part of the key",
        ),
        ("module_mm = 2.6", "modul = 2.6", "unknown field `modul`"),
        (
            "rim_inner_diameter_mm = 136.7",
            "rim_inner_diameter_mm = 144.0",
            "blank.rim_inner_diameter_mm: found 144",
        ),
        (
            "bore_diameter_mm = 50.0",
            "bore_diameter_mm = 144.0",
            "blank.bore_diameter_mm: found 144",
        ),
        (
            "width_deg = 80.0",
            "width_deg = 120.0",
            "openings of 120.000 deg meet",
        ),
        (
            "outer_radius_mm = 60.0",
            "outer_radius_mm = 68.3",
            "they reach from radius",
        ),
        (
            "count = 3",
            "count = 0",
            "blank.slots.count: found 0, allowed is 1 to 200",
        ),
        (
            "rack_tip_radius = 0.38",
            "rack_tip_radius = 0.6",
            "does not fit",
        ),
        (
            "tangent_deg = 30.0",
            "tangent_deg = 5.0",
            "gauge.0.tangent_deg: found a tangent of 5.000",
        ),
        (
            "kind = \"thin-rim\"",
            "kind = \"solid\"",
            "blank: `hub_diameter_mm` belongs to kind \"thin-rim\", not to \"solid\"",
        ),
        (
            "poisson = 0.3",
            "poisson = 0.5",
            "material.poisson: found 0.5",
        ),
    ] {
        let text = edited(find, replace).unwrap_err();
        assert!(text.contains(expected), "{replace}: {text}");
    }
}

#[test]
fn slots_that_do_not_divide_the_teeth_leave_one_sector() {
    assert_eq!(model("gear2.toml").sectors(), 57);
    assert_eq!(model("gear3.toml").sectors(), 3);
    assert_eq!(edited("count = 3", "count = 4").unwrap().sectors(), 1);
    assert!(
        edited("count = 3", "count = 5")
            .unwrap_err()
            .contains("meet")
    );
    assert_eq!(edited("count = 3", "count = 2").unwrap().sectors(), 1);
}

#[test]
fn pairs_that_cannot_run_say_why() {
    let (g1, g2) = (model("gear1.toml").profile, model("gear2.toml").profile);
    let pair =
        |a: f64| GearPair::new(g1.clone(), g2.clone(), a, Misalignment::default()).unwrap_err();
    assert!(matches!(pair(0.130), PairError::CentreDistance { .. }));
    assert!(matches!(
        pair(0.1490),
        PairError::TipClearance { .. } | PairError::NoBacklash { .. }
    ));
    assert!(matches!(pair(0.1549), PairError::ContactRatio { .. }));
}

/// Found by a random pair: the tips reach the mates' flanks above the form circle and clear the root circle, but cut
/// into the fillet in between.
#[test]
fn a_tip_that_cuts_into_the_fillet_is_refused() {
    let gear = |teeth, profile_shift| {
        ToothGeometry::new(&ToothDefinition {
            teeth,
            gearing: Default::default(),
            module_m: 0.2e-3,
            pressure_angle_rad: 0.26128296931528644,
            profile_shift,
            addendum: 1.0191438449287265,
            dedendum: 1.2455618511827362,
            rack_tip_radius: 0.1922968072440458,
            tip_diameter_m: None,
            thickness_allowance_m: 17e-6,
            tip_chamfer_m: 0.0,
            face_width_m: 2e-3,
            helix_angle_rad: 0.0,
        })
        .unwrap()
    };
    let pair = |a| {
        GearPair::new(
            gear(105, 0.618),
            gear(130, 0.556),
            a,
            Misalignment::default(),
        )
    };
    let references = 0.1e-3 * 235.0;
    let verdicts: Vec<_> = (0..40)
        .map(|k| pair(references + 0.2e-3 * (0.9 + 0.01 * f64::from(k))))
        .collect();
    // Closer, the tip meets the root circle; further away it runs clear.
    let refused = |v: &Result<GearPair, PairError>| matches!(v, Err(PairError::TipInFillet { .. }));
    assert!(verdicts.iter().any(refused), "{verdicts:?}");
    assert!(matches!(
        verdicts[0],
        Err(PairError::NoBacklash { .. } | PairError::TipClearance { .. })
    ));
    assert!(verdicts[39].is_ok(), "{:?}", verdicts[39]);
}

/// Pairs that ship with the program run clear.
#[test]
fn shipped_pairs_run_clear() {
    for (one, two, a) in [
        ("gear1.toml", "gear2.toml", 150e-3),
        ("gear1.toml", "gear3.toml", 150e-3),
        ("helical1.toml", "helical2.toml", f64::NAN),
        ("pinion_17.toml", "wheel_25_m10.toml", f64::NAN),
    ] {
        let (g1, g2) = (model(one).profile, model(two).profile);
        let a = if a.is_nan() {
            g1.reference_radius_m + g2.reference_radius_m + 0.3e-3
        } else {
            a
        };
        let pair = GearPair::new(g1, g2, a, Misalignment::default());
        assert!(
            !matches!(pair, Err(PairError::TipInFillet { .. })),
            "{one}, {two}: {pair:?}"
        );
    }
}

#[test]
fn the_distance_to_the_opposite_side_is_finite_and_continuous_along_the_flank() {
    let g = model("gear1.toml").profile;
    let curve = ProfileCurve::new(&g);
    let n = 400;
    let mut last: Option<f64> = None;
    for k in 0..=n {
        let roll =
            g.form_roll_rad + (g.tip_roll_rad - g.form_roll_rad) * f64::from(k) / f64::from(n);
        let h = curve.opposite_distance_m(roll);
        assert!(h > 1e-4 && h < 0.01, "{h}");
        // The chordal thickness at the reference circle bounds it in the middle of the flank.
        if let Some(last) = last {
            assert!(
                (h - last).abs() < 0.3e-3,
                "a jump from {last} to {h} at {roll}"
            );
        }
        last = Some(h);
    }
}
