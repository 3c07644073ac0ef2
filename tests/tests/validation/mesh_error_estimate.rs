//! Validation of the mesh errors that `reduce` states: on the default mesh they cover the difference from quadratic
//! elements.

use crate::computed;
use crate::line_load::line_load_strain;
use gearmesh_contact::LocalContact;
use gearmesh_contact::flank_deflection::{FlankLoad, flank_deflection};
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{Flank, GaugeRows, ReducedGear, ReductionChecks};
use gearmesh_reduction::{ReductionOptions, Silent, reduce};
use std::ops::Range;

const GAUGES: &str = "[[gauge]]\nname = \"tension\"\ntooth = 0\nside = \"right\"\ntangent_deg = 30.0\nlength_mm = 0.5\nwidth_mm = 2.0\n\
     [[gauge]]\nname = \"compression\"\ntooth = 0\nside = \"left\"\ntangent_deg = 30.0\nlength_mm = 0.5\nwidth_mm = 2.0\n";

/// The gear's file.
fn text(gear: &str, mesh: &str, element: &str) -> String {
    format!(
        "name = \"estimated\"\n{gear}[material]\nyoung_GPa = 206.0\npoisson = 0.3\n[reduction]\nflanks = [\"right\"]\nslices = 1\n{GAUGES}\
         [mesh]\n{mesh}{element}"
    )
}

fn reduced(text: &str, estimate_error: bool) -> ReducedGear {
    let gear = GearDefinition::from_document(&InputDocument::new("gear.toml", text)).unwrap();
    let python = PythonEnvironment::find().unwrap();
    reduce(&gear, &python, ReductionOptions { estimate_error }, &Silent)
        .unwrap()
        .0
}

fn stated(gear: &ReducedGear, name: &str) -> f64 {
    let found = gear.checks.further.iter().find(|(known, _)| known == name);
    found.unwrap().1
}

/// Deflection in the middle of a tooth's flank, tooth 0 loaded.
fn deflection(gear: &ReducedGear, at_tooth: usize) -> f64 {
    let middle = gear.grid.roll_angles_rad[gear.grid.roll_angles_rad.len() / 2];
    let load = FlankLoad {
        tooth: 0,
        flank: Flank::Right,
        radius_m: gear.base_radius_m * 1f64.hypot(middle),
        line_load_n_per_m: 1e5,
        half_width_m: 0.05e-3,
    };
    let (global, local) = flank_deflection(gear, &load, at_tooth, LocalContact::Calibrated)
        .unwrap()
        .means_m();
    global + local
}

/// Teeth whose deflections are compared.
const TEETH: usize = 6;

/// Deflections of [`TEETH`] teeth, the loaded one first; strains of each gauge, all roll stations of its own tooth.
fn figures(gear: &ReducedGear) -> Vec<f64> {
    let n = gear.teeth;
    let teeth: [usize; TEETH] = [0, 1, n - 1, 2, n - 2, n / 2];
    let mut figures: Vec<f64> = teeth.map(|tooth| deflection(gear, tooth)).to_vec();
    for gauge in &gear.gauges {
        let stations = 0..gear.grid.roll_angles_rad.len();
        figures.extend(stations.map(|s| line_load_strain(gear, gauge, s)[0]));
    }
    figures
}

/// Root of the sum of squares of what is off, over that of the figures, as the estimates have it.
fn relative_error(found: &[f64], expected: &[f64]) -> f64 {
    let off = found.iter().zip(expected).map(|(f, e)| (f - e).powi(2));
    let all = expected.iter().map(|e| e * e);
    (off.sum::<f64>() / all.sum::<f64>()).sqrt()
}

/// As [`relative_error`] of a gauge, over the loads that make it read at least half of its largest reading.
fn error_of_gauge(found: &[f64], expected: &[f64]) -> f64 {
    let largest = expected.iter().fold(0.0f64, |most, e| most.max(e.abs()));
    let both = found.iter().zip(expected);
    let large = both.filter(|(_, e)| e.abs() >= 0.5 * largest);
    let (found, expected): (Vec<f64>, Vec<f64>) = large.unzip();
    relative_error(&found, &expected)
}

/// 1.4 to 2 times the default lengths: quadratic elements are still the better ones, in a third of the memory.
const LONGER: &str = "flank_mm = 1.4\nfillet_mm = 0.34\nbody_mm = 5.0\naxial_mm = 2.4\n";

fn check(name: &str, gear: &str, mesh: &str) {
    check_against(name, gear, mesh, mesh);
}

/// As [`check`], with element lengths of their own for the quadratic elements. What these come to is recorded.
fn check_against(name: &str, gear: &str, mesh: &str, of_quadratic: &str) {
    let default = reduced(&text(gear, mesh, ""), true);
    let found = figures(&default);
    let quadratic = text(gear, of_quadratic, "element = \"hex20\"\n");
    let record = format!("mesh_error_estimate_{}", name.replace(' ', "_"));
    let expected = computed::numbers(&record, &quadratic, || figures(&reduced(&quadratic, false)));
    assert_eq!(found.len(), expected.len());
    let error = |of: Range<usize>| relative_error(&found[of.clone()], &expected[of]);
    let stations = default.grid.roll_angles_rad.len();
    let of_gauge = |(k, gauge): (usize, &GaugeRows)| {
        let own = TEETH + k * stations..TEETH + (k + 1) * stations;
        [
            gauge.error_estimate_relative,
            error_of_gauge(&found[own.clone()], &expected[own]),
        ]
    };
    let mut rows: Vec<[f64; 2]> = default.gauges.iter().enumerate().map(of_gauge).collect();
    for (stated_as, teeth) in [
        (ReductionChecks::LOADED_TOOTH_ERROR, 0..1),
        (ReductionChecks::OTHER_TEETH_ERROR, 1..TEETH),
    ] {
        rows.push([stated(&default, stated_as), error(teeth)]);
    }
    let both = |deflections: &[f64]| [deflections[0] + deflections[1]];
    rows.push([
        stated(&default, ReductionChecks::BOTH_TEETH_ERROR),
        relative_error(&both(&found), &both(&expected)),
    ]);
    for [stated, found] in &rows {
        println!(
            "{name}: stated {:.2} %, found {:.2} %",
            100.0 * stated,
            100.0 * found
        );
    }
    for [stated, found] in rows {
        // Not below the true one, and no empty caution: without a factor of safety of 3 at most three times it.
        assert!(
            stated >= found && stated < 0.1 && stated < 9.0 * found,
            "{name}: {stated} {found}"
        );
    }
}

const PLANE: &str = "[tooth]\nteeth = 50\nmodule_mm = 3.0\nface_width_mm = 10.0\n[blank]\nkind = \"solid\"\nbore_diameter_mm = 60.0\n";

#[test]
fn stated_errors_cover_the_true_ones_in_plane_strain() {
    check("plane strain", PLANE, "plane_strain = true\n");
}

/// Strain of gauges on meshes whose lengths fall by 1.5: changes from each to the next fall as with second order, for
/// which the estimate takes them. Its factor of safety, 2, covers orders from 1.2 on, (1.5² − 1)/2 = 1.5^1.2 − 1; 1.7
/// is the least found, 1.6 the least allowed.
#[test]
fn gauges_converge_with_second_order() {
    const FACTOR: f64 = 1.5;
    let meshes = [1.5, 1.0, 0.67, 0.44].map(|factor: f64| {
        let [flank, fillet, body] = [0.9, 0.15, 3.6].map(|length| factor * length);
        let lengths = format!(
            "plane_strain = true\nflank_mm = {flank}\nfillet_mm = {fillet}\nbody_mm = {body}\n"
        );
        figures(&reduced(&text(PLANE, &lengths, ""), false))
    });
    let stations = (meshes[0].len() - TEETH) / 2;
    for (k, side) in ["tension", "compression"].iter().enumerate() {
        let of = |mesh: usize| &meshes[mesh][TEETH + k * stations..][..stations];
        let changes = [0, 1, 2].map(|mesh| relative_error(of(mesh), of(mesh + 1)));
        let to_last = [0, 1, 2].map(|mesh| relative_error(of(mesh), of(3)));
        println!("{side}: {changes:.4?}, to the last {to_last:.4?}");
        for pair in changes.windows(2) {
            let order = (pair[0] / pair[1]).ln() / FACTOR.ln();
            assert!(order > 1.6, "{side}: {order} {changes:?}");
        }
    }
}

#[test]
#[ignore = "half a minute: a web with sharp edges in quadratic elements"]
fn stated_errors_cover_the_true_ones_on_a_thin_rim() {
    let gear = "[tooth]\nteeth = 24\nmodule_mm = 3.0\nface_width_mm = 12.0\n[blank]\nkind = \"thin-rim\"\nbore_diameter_mm = 20.0\n\
                hub_diameter_mm = 32.0\nrim_inner_diameter_mm = 54.0\nweb_thickness_mm = 3.0\n";
    check_against("thin rim", gear, "", LONGER);
}

/// Tooth 0 stands over the middle of a slot, where it deflects most.
#[test]
#[ignore = "minutes: a sector of eight teeth in quadratic elements; run with --ignored"]
fn stated_errors_cover_the_true_ones_over_three_slots() {
    let gear = "[tooth]\nteeth = 24\nmodule_mm = 3.0\nface_width_mm = 12.0\n[blank]\nkind = \"thin-rim\"\nbore_diameter_mm = 20.0\n\
                hub_diameter_mm = 30.0\nrim_inner_diameter_mm = 56.0\nweb_thickness_mm = 4.0\n[blank.slots]\ncount = 3\n\
                inner_radius_mm = 18.5\nouter_radius_mm = 24.5\nwidth_deg = 70.0\nphase_deg = 0.0\ncorner_radius_mm = 2.0\n";
    check_against("three slots", gear, "", LONGER);
}
