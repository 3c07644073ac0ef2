//! Validation on gear 2 of pair A (seed 004 in docs/sources.md): what a finer mesh changes in the numbers that people
//! read, and the trend of the seed's table 3.

use crate::computed;
use crate::line_load::line_load_strain;
use gearmesh_contact::LocalContact;
use gearmesh_contact::flank_deflection::{FlankLoad, flank_deflection};
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{Flank, ReducedGear};
use gearmesh_reduction::{ReductionOptions, Silent, reduce};
use std::path::Path;
use std::sync::OnceLock;

fn gear_2(mesh: &str) -> GearDefinition {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fe_models/gear2.toml");
    let text = format!("{}\n[mesh]\n{mesh}", std::fs::read_to_string(path).unwrap());
    GearDefinition::from_document(&InputDocument::new("gear2.toml", text)).unwrap()
}

fn reduced(gear: &GearDefinition, estimate_error: bool) -> ReducedGear {
    let python = PythonEnvironment::find().unwrap();
    reduce(gear, &python, ReductionOptions { estimate_error }, &Silent)
        .unwrap()
        .0
}

fn coarse() -> &'static ReducedGear {
    static MODEL: OnceLock<ReducedGear> = OnceLock::new();
    MODEL.get_or_init(|| {
        let mesh = "flank_mm = 1.0\nfillet_mm = 0.21\nbody_mm = 4.0\naxial_mm = 3.8\n";
        reduced(&gear_2(mesh), true)
    })
}

/// Seed 004, table 3, as a trend: the methods differ by less than 7 % at the root.
#[test]
fn the_methods_differ_little_at_the_root() {
    let gear = coarse();
    let gauge = gear.gauges.iter().find(|g| g.side == Flank::Right).unwrap();
    let highest = gear.grid.roll_angles_rad.len() - 1;
    for station in [highest - 1, highest] {
        let [normal, _, own] = line_load_strain(gear, gauge, station);
        println!("station {station}: {:.2} %", 100.0 * own / normal);
        assert!((own / normal).abs() < 0.07, "{}", own / normal);
    }
}

fn deflection(gear: &ReducedGear, radius_m: f64, at_tooth: usize) -> f64 {
    let load = FlankLoad {
        tooth: 0,
        flank: Flank::Right,
        radius_m,
        line_load_n_per_m: 1e5,
        half_width_m: 1e-4,
    };
    let (global, local) = flank_deflection(gear, &load, at_tooth, LocalContact::WeberBanaschek)
        .unwrap()
        .means_m();
    global + local
}

/// Where deflections are compared: radius \[mm\] of the load on tooth 0, tooth that deflects.
fn places() -> impl Iterator<Item = (f64, usize)> {
    let radii = [73.5, 75.0, 76.5].into_iter();
    radii.flat_map(|radius_mm| [0, 1, 56].map(|tooth| (radius_mm, tooth)))
}

/// Deflections \[m\] at [`places`], then the strain of each gauge under a load over the whole width at three quarters
/// of the flank, on the gauge's tooth.
fn figures(gear: &ReducedGear) -> Vec<f64> {
    let station = 3 * gear.grid.roll_angles_rad.len() / 4;
    let deflections = places().map(|(mm, tooth)| deflection(gear, mm * 1e-3, tooth));
    let strains = gear.gauges.iter();
    let strains = strains.map(|gauge| line_load_strain(gear, gauge, station)[0]);
    deflections.chain(strains).collect()
}

/// Coarse against fine, recorded, element lengths apart by 1.5 (the coarse fillet is the default's): compliance
/// within 2 %, strain at the gauges within 3 %, and the program's own estimate made from the coarse mesh alone is of
/// the size of the true error, not of another.
#[test]
fn a_finer_mesh_changes_little() {
    let coarse = coarse();
    let fine = gear_2("flank_mm = 0.67\nfillet_mm = 0.14\nbody_mm = 2.7\naxial_mm = 2.6\n");
    let fine = computed::numbers("gear_2_on_a_finer_mesh", &fine.source, || {
        figures(&reduced(&fine, false))
    });
    let found = figures(coarse);
    assert_eq!(found.len(), fine.len());
    let changes = found.iter().zip(&fine).map(|(a, b)| a / b - 1.0);
    let changes: Vec<f64> = changes.collect();
    for ((radius_mm, tooth), change) in places().zip(&changes) {
        println!(
            "radius {radius_mm} mm, tooth {tooth}: {:+.2} %",
            100.0 * change
        );
        assert!(
            change.abs() < 0.02,
            "{radius_mm} mm, tooth {tooth}: {change}"
        );
    }
    // Strain errs with the square of the length: of the coarse mesh's error the change is all but 1/1.5².
    let error_over_change = 1.0 / (1.0 - 1.0 / (1.5 * 1.5));
    for (gauge, change) in coarse.gauges.iter().zip(&changes[places().count()..]) {
        let estimate = gauge.error_estimate_relative;
        println!(
            "{}: {:+.2} %, estimate {:.2} %",
            gauge.name,
            100.0 * change,
            100.0 * estimate
        );
        assert!(change.abs() < 0.03, "{}: {change}", gauge.name);
        // It covers the change, and is no more than the largest error allowed with its factor of safety of 2.
        assert!(
            estimate > change.abs() && estimate < 2.0 * 0.03 * error_over_change,
            "{}: {estimate} {change}",
            gauge.name
        );
    }
}
