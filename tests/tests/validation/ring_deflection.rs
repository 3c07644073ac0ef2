//! Validation: deflection of a ring's tooth, of the teeth beside it, and root strain, against an independent
//! plane-strain solution of the whole ring (reference/plane_ring), for a thin and a thick rim.

use gearmesh_contact::flank_deflection::{FlankLoad, flank_deflection};
use gearmesh_contact::{LocalContact, ProfileHats};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, involute};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{Flank, ReducedGear};
use gearmesh_reduction::{ReductionOptions, Silent, reduce};
use std::path::Path;
use std::sync::OnceLock;

/// Six lugs of the thin ring, the first around tooth 0.
const LUGS: &str = "[blank.lugs]\ncount = 6\nwidth_deg = 10.0\n";

/// Outer diameter and radius of the load \[mm\]; deflection of the own tooth, of those after and before it \[µm\];
/// strain \[µm/m\].
fn reference() -> Vec<[f64; 6]> {
    rows("plane_ring")
}

fn rows<const N: usize>(folder: &str) -> Vec<[f64; N]> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../reference");
    let path = root.join(folder).join("data.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let row = |line: &str| {
        let numbers: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    };
    text.lines().skip(1).map(row).collect()
}

/// The ring of the reference, in plane strain; `after_blank`: further keys of the blank, and `[mesh]`.
fn definition(outer_mm: f64, after_blank: &str) -> GearDefinition {
    let text = format!(
        "name = \"ring\"\n[tooth]\nteeth = -60\nmodule_mm = 3.0\naddendum = 0.8\nface_width_mm = 10.0\n\
         [tooth.cutter]\nteeth = 24\n[blank]\nkind = \"ring\"\nouter_diameter_mm = {outer_mm}\n\
         {after_blank}[material]\nyoung_GPa = 206.0\npoisson = 0.3\n\
         [reduction]\nflanks = [\"right\"]\n\
         [[gauge]]\nname = \"root\"\ntooth = 0\nside = \"right\"\ntangent_deg = 45.0\nlength_mm = 0.4\nwidth_mm = 10.0\n"
    );
    GearDefinition::from_document(&InputDocument::new("ring.toml", text)).unwrap()
}

fn reduced(outer_mm: f64, mesh: &str, estimate_error: bool) -> ReducedGear {
    let mesh = format!("[mesh]\nplane_strain = true\n{mesh}");
    reduced_as(definition(outer_mm, &mesh), estimate_error)
}

fn reduced_as(gear: GearDefinition, estimate_error: bool) -> ReducedGear {
    let options = ReductionOptions { estimate_error };
    reduce(&gear, &PythonEnvironment::find().unwrap(), options, &Silent)
        .unwrap()
        .0
}

/// Strain of the gauge under a line load over the whole width at a roll angle: each slice's force on its own load
/// station and, by a quarter each, on those at its ends.
fn root_strain(gear: &ReducedGear, roll_rad: f64, line_load_n_per_m: f64) -> f64 {
    let place = ProfileHats::of_involute(&gear.grid.roll_angles_rad).place(roll_rad);
    let force = line_load_n_per_m * gear.face_width_m / gear.grid.slices as f64;
    let mut strain = 0.0;
    for (station, along) in place.shares() {
        for slice in 0..gear.grid.slices {
            for (axial, across) in [(0, 0.25), (1, 0.5), (2, 0.25)] {
                let load = gear.grid.load(station, 2 * slice + axial);
                strain += force * along * across * gear.gauges[0].adjoint[3 * load];
            }
        }
    }
    strain
}

/// Loads farther out are within a fillet's radius of the gauge. It feels how the hat functions of nine roll stations
/// spread them: 0.7 to 1 % of its strain, and 0.6 % of the mesh are 1.4 %.
const LOWEST_MM: f64 = 91.0;

/// Errors over rims and radii.
#[derive(Default)]
struct Found {
    /// Largest of the own tooth.
    own: f64,
    /// Largest of the teeth beside it, over the largest deflection of those.
    beside: f64,
    /// Of the root strain under each of the outer loads, with its sign.
    strains: Vec<f64>,
    /// The error of each that the reduction states.
    stated: Vec<f64>,
    /// Largest of the root strain under the loads nearest to the root.
    strain_of_lowest: f64,
}

/// Outer diameters of the reference's rims \[mm\], the thin one first.
fn rims_mm() -> [f64; 2] {
    let rows = reference();
    [rows[0][0], rows[rows.len() - 1][0]]
}

fn found(mesh: &str, estimate_error: bool) -> Found {
    found_on(&rims_mm(), mesh, estimate_error)
}

fn found_on(rims_mm: &[f64], mesh: &str, estimate_error: bool) -> Found {
    let mut found = Found::default();
    let rows = reference();
    for &outer_mm in rims_mm {
        let gear = reduced(outer_mm, mesh, estimate_error);
        let of_rim: Vec<&[f64; 6]> = rows.iter().filter(|r| r[0] == outer_mm).collect();
        let most_beside = of_rim.iter().fold(0.0f64, |most, r| most.max(r[3].abs()));
        for &&[_, radius_mm, own_um, after_um, before_um, strain] in &of_rim {
            let load = FlankLoad {
                tooth: 0,
                flank: Flank::Right,
                radius_m: radius_mm * 1e-3,
                line_load_n_per_m: 1e5,
                half_width_m: 0.06e-3,
            };
            let at = |tooth: usize| {
                let local = LocalContact::Calibrated;
                let (global, own) = flank_deflection(&gear, &load, tooth, local)
                    .unwrap()
                    .means_m();
                1e6 * (global + own)
            };
            let own = at(0) / own_um - 1.0;
            let beside = [(1, after_um), (59, before_um)].map(|(k, um)| (at(k) - um) / most_beside);
            let roll = involute::roll_angle_rad(radius_mm * 1e-3, gear.base_radius_m);
            let strain = 1e6 * root_strain(&gear, roll, 1e5) / strain - 1.0;
            let stated = gear.gauges[0].error_estimate_relative;
            println!(
                "outside {outer_mm:.1}, radius {radius_mm}: own {:+.3} %, beside {:+.3} {:+.3} %, strain {:+.3} % of stated {:.2} %",
                100.0 * own,
                100.0 * beside[0],
                100.0 * beside[1],
                100.0 * strain,
                100.0 * stated
            );
            found.own = found.own.max(own.abs());
            found.beside = found.beside.max(beside[0].abs()).max(beside[1].abs());
            if radius_mm > LOWEST_MM {
                found.strain_of_lowest = found.strain_of_lowest.max(strain.abs());
                continue;
            }
            found.strains.push(strain);
            found.stated.push(stated);
        }
    }
    found
}

/// The largest of some errors by its amount.
fn largest(errors: &[f64]) -> f64 {
    errors.iter().fold(0.0, |most: f64, e| most.max(e.abs()))
}

/// The default mesh, which two tests look at, with its stated errors.
fn on_default_mesh() -> &'static Found {
    static FOUND: OnceLock<Found> = OnceLock::new();
    FOUND.get_or_init(|| found("", true))
}

/// The own tooth as that of the external gear of `plane_strain_deflection`: 1 % on the default mesh, whose elements
/// along the flank are 0.9 mm long, 0.7 % from 0.8 mm on. The root strain of linear elements is within the error that
/// the reduction states. Teeth beside are not bounded here: they deflect by 1 to 10 % of the loaded one.
#[test]
fn a_ring_deflects_as_an_independent_program_says() {
    let default = on_default_mesh();
    assert!(default.own < 0.01, "{}", default.own);
    // Two rims, two loads each.
    assert_eq!(default.strains.len(), 4);
    for (strain, stated) in default.strains.iter().zip(&default.stated) {
        assert!(strain.abs() < *stated, "{strain} {stated}");
    }
    let finer = found("flank_mm = 0.6\n", false);
    assert!(finer.own < 0.007, "{}", finer.own);
    for found in [default, &finer] {
        assert!(found.strain_of_lowest < 0.02, "{}", found.strain_of_lowest);
    }
}

/// Elements that are shorter in the fillets alone: from the default length to its half the root strain changes four
/// times as much as from there to a quarter (second order; three times is allowed, 3.3 to 3.5 found), whatever the
/// length along the flank. What is left, 0.15 %, is not of the fillets. Without it the half length is within what it
/// states. Elements below the fillet grow from those along it; where they did not, the error grew from 0.6 to 8 %.
/// The thin rim is looked at, which bends most.
#[test]
fn shorter_elements_in_the_fillets_are_enough_for_the_root_strain_of_a_ring() {
    let default = on_default_mesh();
    let thin = &rims_mm()[..1];
    let shorter = found_on(thin, "fillet_mm = 0.075\n", true);
    let shortest = found_on(thin, "fillet_mm = 0.0375\n", false);
    assert_eq!(shortest.strains.len(), 2);
    for k in 0..shortest.strains.len() {
        let [first, second, third] = [default, &shorter, &shortest].map(|found| found.strains[k]);
        let (change, next) = (second - first, third - second);
        assert!(change > 3.0 * next && next > 0.0, "{change} {next}");
        assert!(third.abs() < 0.002, "{third}");
        assert!(next < shorter.stated[k], "{next} {}", shorter.stated[k]);
    }
}

/// Quadratic elements: 0.1 %, and 0.05 % that the record's own mesh leaves; root strain 1 %.
#[test]
fn quadratic_elements_of_a_ring_agree() {
    let found = found("element = \"hex20\"\n", false);
    let (own, beside, strain) = (found.own, found.beside, largest(&found.strains));
    assert!(own < 0.0015 && beside < 0.0015, "{own} {beside}");
    assert!(strain < 0.01, "{strain}");
}

/// A ring on lugs, loaded over one and half way between two: the rim bends between them. 1 % of the loaded tooth's
/// deflection with linear elements (0.4 % found); 0.5 % with quadratic ones that are short at the edges of the lugs,
/// where stresses are singular.
#[test]
fn a_ring_on_lugs_deflects_as_an_independent_program_says() {
    for (mesh, bound) in [
        ("fillet_mm = 0.12\n", 0.01),
        ("element = \"hex20\"\nbody_mm = 0.7\n", 0.005),
    ] {
        let mesh = format!("{LUGS}[mesh]\nplane_strain = true\n{mesh}");
        let gear = reduced_as(definition(196.5, &mesh), false);
        for [tooth, own_um, after_um, before_um] in rows("plane_lugs") {
            let tooth = tooth as usize;
            let load = FlankLoad {
                tooth,
                flank: Flank::Right,
                radius_m: 90e-3,
                line_load_n_per_m: 1e5,
                half_width_m: 0.06e-3,
            };
            let beside = [(0, own_um), (1, after_um), (gear.teeth - 1, before_um)];
            for (away, um) in beside {
                let at = (tooth + away) % gear.teeth;
                let (global, own) = flank_deflection(&gear, &load, at, LocalContact::Calibrated)
                    .unwrap()
                    .means_m();
                let off = (1e6 * (global + own) - um) / own_um;
                println!(
                    "load on {tooth}, tooth {at}: {um:.4} um, {:+.3} %",
                    100.0 * off
                );
                assert!(off.abs() < bound, "{tooth} {at}: {off}");
            }
        }
    }
}
