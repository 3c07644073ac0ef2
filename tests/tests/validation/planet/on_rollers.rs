//! Validation: the set of `set.rs` with its planet on rollers that press on the elastic bore where they touch, against
//! the same independent solution (reference/plane_set).

use std::f64::consts::TAU;
use std::path::Path;

use super::set::{AtRest, LOADS, Row, TEETH, at_rest, folder_of_gears, reference};

/// Rollers of thin and thick planet: number, diameter, diameter of their circle \[mm\].
const ROLLERS: [(usize, f64, f64); 2] = [(14, 6.0, 31.0), (12, 4.0, 16.0)];

/// The planet's keys, its bearing's file written: straight steel rollers of 10 mm, play 10 µm, the first at an angle.
///
/// The other program has radial pressures over an arc of 2h = D/R whose sum is the roller's force, Q = k (w −
/// e)^(10/9), w their mean displacement: their resultant is smaller by s = sin(h)/h, and so is w where the bore moves
/// as a whole. Here the force is the resultant. Both are the same problem with the play e/s and with k s^(19/9) in
/// place of k.
fn on_rollers(thin: bool, bore: &str, first_rad: f64, folder: &Path) -> String {
    let (rollers, diameter, circle) = ROLLERS[usize::from(!thin)];
    let half_arc = diameter / (circle + diameter);
    let share = half_arc.sin() / half_arc;
    let (play_um, young_gpa) = (10.0 / share, 206.0 * share.powf(19.0 / 9.0));
    let steel = format!("{{ young_GPa = {young_gpa:?}, poisson = 0.3 }}");
    let file = format!(
        "name = \"rollers\"\nkind = \"cylindrical-roller\"\nrollers = {rollers}\nroller_diameter_mm = {diameter:?}\n\
         roller_length_mm = 10.0\npitch_diameter_mm = {circle:?}\nradial_clearance_um = {play_um:?}\n\
         first_angle_deg = {:?}\nprofile = {{ kind = \"straight\" }}\n\
         element_material = {steel}\nring_material = {steel}\n",
        first_rad.to_degrees()
    );
    std::fs::write(folder.join("rollers.toml"), file).unwrap();
    format!(
        ", bore = \"{bore}\", support = \"floating\", bearings = [{{ model.kind = \"quasi-static\", model.file = \"rollers.toml\" }}]"
    )
}

/// Approach of the sun's base circle by the turns of sun and carrier, up to where it begins \[µm\].
fn turned_um(one: &AtRest) -> f64 {
    let [sun, carrier, _] = one.turns_rad;
    let base_um = 1e3 * TEETH[0] * 20f64.to_radians().cos();
    base_um * (sun - carrier * (1.0 + TEETH[2] / TEETH[0]))
}

/// Transmission error within 0.5 %, what the bending of the bore adds within 3 % of itself, both as asked.
///
/// Of the 16 of the record these: one of each load and number of pairs; all were compared once by hand
/// (docs/theory/bore_patterns.md). With a thin planet under 300 N/mm at 0.83 the second pair at the sun carries, which
/// the record, with teeth where they stand without load, has lost 0.015 of a pitch before.
#[test]
fn a_planet_on_rollers_agrees_with_one_model_of_all_bodies() {
    let folder = folder_of_gears();
    let rows = reference();
    let base_pitch_um = 1e3 * TAU * 20f64.to_radians().cos();
    for (thin, number, position) in [
        (true, 0, 0.33),
        (true, 1, 0.08),
        (false, 0, 0.58),
        (false, 1, 0.83),
    ] {
        let (name, load) = (if thin { "thin" } else { "thick" }, LOADS[number]);
        let of_kind = |kind: &str| {
            let is_so =
                |row: &&Row| row.planet == name && row.bore == kind && row.position == position;
            rows.iter().find(is_so).unwrap()
        };
        // Loads turn the sun on against the carrier.
        let at = |planets: &str, approach_um: f64| {
            let there = position - approach_um / base_pitch_um;
            at_rest(thin, load, planets, &[there], folder.path())[0]
        };
        let glued = at("", 0.0);
        let begin_um = turned_um(&glued) + glued.overlaps_um;
        let [_, carrier, planet] = glued.turns_rad;
        // Rollers stand on the bearing's frame: that of the planet at the start, or of the carrier, which the planet
        // takes along.
        let sun = std::f64::consts::PI;
        let cases = [
            ("bonded", "rigid rollers", sun - glued.planet_rad),
            ("rollers", "rollers", sun + carrier - planet),
        ];
        let both = cases.map(|(bore, kind, first_rad)| {
            let row = of_kind(kind);
            let known_um = row.approach_um[number];
            let keys = on_rollers(thin, bore, first_rad, folder.path());
            let found = at(&keys, known_um);
            assert_eq!(found.pairs, row.pairs, "{name} {kind} {load} {position}");
            let found_um = (begin_um - turned_um(&found)).abs();
            let off = found_um / known_um - 1.0;
            println!(
                "{name} {kind} {load} {position}: {found_um:.4} um, {:+.3} %",
                100.0 * off
            );
            assert!(off.abs() < 0.005, "{name} {kind} {load} {position}: {off}");
            [found_um, known_um]
        });
        let effect = [0, 1].map(|of: usize| both[1][of] - both[0][of]);
        let off = effect[0] / effect[1] - 1.0;
        println!(
            "    bending adds {:.4} um, {:+.3} %",
            effect[0],
            100.0 * off
        );
        assert!(off.abs() < 0.03, "{name} {load} {position}: {effect:?}");
    }
}
