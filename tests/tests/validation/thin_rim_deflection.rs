//! What a thin rim adds to the deflection: the gear less the same gear with a solid blank, on the loaded tooth, the
//! next two on either side and the opposite one. Converged on the default mesh.
//!
//! Of two meshes the finer one's figures are recorded. `pairs_a_and_b` reduces these gears each time.

use crate::computed;
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{Flank, ReducedGear};
use gearmesh_reduction::{ReductionOptions, Silent, reduce};
use std::path::Path;
use std::sync::OnceLock;

/// Element lengths of the coarser mesh over the finer one's.
const REFINEMENT: f64 = 1.5;

/// A gear with few loads, all default element lengths times `factor`; without gauges.
fn gear(text: &str, factor: f64) -> GearDefinition {
    let parse = |text: String| {
        GearDefinition::from_document(&InputDocument::new("gear.toml", text)).unwrap()
    };
    let text = text.split("[[gauge]]").next().unwrap().replace(
        "flanks = [\"right\"]",
        "flanks = [\"right\"]\nslices = 2\nroll_stations = 3",
    );
    let defaults = parse(text.clone()).mesh;
    let keys = [
        ("flank", defaults.flank_m),
        ("fillet", defaults.fillet_m),
        ("body", defaults.body_m),
        ("axial", defaults.axial_m),
    ];
    let lengths: String = (keys.iter())
        .map(|(key, m)| format!("{key}_mm = {}\n", 1e3 * factor * m))
        .collect();
    parse(format!("{text}\n[mesh]\n{lengths}"))
}

fn reduced(gear: &GearDefinition) -> ReducedGear {
    let python = PythonEnvironment::find().unwrap();
    let options = ReductionOptions {
        estimate_error: false,
    };
    reduce(gear, &python, options, &Silent).unwrap().0
}

/// [`deflections`] under loads on `teeth`, recorded.
fn recorded(name: &str, gear: &GearDefinition, teeth: &[usize]) -> Vec<[f64; 6]> {
    let from = format!("loads on {teeth:?} of {}", gear.source);
    let numbers = computed::numbers(&format!("thin_rim_{name}"), &from, || {
        let model = reduced(gear);
        let all = teeth.iter().flat_map(|&tooth| deflections(&model, tooth));
        all.collect()
    });
    let rows = numbers.chunks(6).map(|row| row.try_into().unwrap());
    rows.collect()
}

/// Teeth from the loaded one at which the deflection is read.
fn steps(teeth: usize) -> [usize; 6] {
    [0, 1, teeth - 1, 2, teeth - 2, teeth / 2]
}

/// Deflection \[m/N\] in the middle of the flank at [`steps`] from `tooth`, uniform load there; C_g on the loaded
/// tooth.
fn deflections(gear: &ReducedGear, tooth: usize) -> [f64; 6] {
    let grid = &gear.grid;
    let (station, n) = (grid.roll_angles_rad.len() / 2, grid.z_m.len());
    let share = |j: usize| if j == 0 || j == n - 1 { 0.5 } else { 1.0 } / (n - 1) as f64;
    steps(gear.teeth).map(|step| {
        let other = (tooth + step) % gear.teeth;
        let block = gear.c_g_block(tooth, Flank::Right, other, Flank::Right);
        (0..n * n)
            .map(|k| {
                let (i, j) = (k / n, k % n);
                share(i)
                    * share(j)
                    * block[grid.load(station, i) * grid.len() + grid.load(station, j)]
            })
            .sum()
    })
}

/// The same gear with a solid blank, under a name of its own and without gauges.
fn solid(text: &str) -> String {
    let (head, rest) = text.split_once("[blank]").unwrap();
    let tooth = head.split_once("[tooth]").unwrap().1;
    let end = rest.split("[[gauge]]").next().unwrap();
    let material = end.split_once("[material]").unwrap().1;
    let bore = rest
        .lines()
        .find(|l| l.starts_with("bore_diameter_mm"))
        .unwrap();
    format!(
        "name = \"solid\"\n[tooth]{tooth}[blank]\nkind = \"solid\"\n{bore}\n\n[material]{material}"
    )
}

/// What the solid gear deflects on the coarser and the finer mesh. Gears 2 and 3 differ in their webs alone: reduced
/// once for both.
fn solid_on_both_meshes(text: &str) -> [[f64; 6]; 2] {
    static COARSE: OnceLock<(String, [f64; 6])> = OnceLock::new();
    let text = solid(text);
    let (reduced_text, coarse) = COARSE.get_or_init(|| {
        let model = reduced(&gear(&text, REFINEMENT));
        (text.clone(), deflections(&model, 0))
    });
    assert_eq!(*reduced_text, text);
    [*coarse, recorded("solid", &gear(&text, 1.0), &[0])[0]]
}

/// Prints what is still missing after the finer of two meshes by an error of first order, relative; the largest.
fn missing(name: &str, coarse: [f64; 6], fine: [f64; 6]) -> f64 {
    let shares: Vec<f64> = (coarse.iter().zip(&fine))
        .map(|(c, f)| (f - c).abs() / (REFINEMENT - 1.0) / f)
        .collect();
    let text: Vec<String> = (fine.iter().zip(&shares))
        .map(|(f, s)| format!("{:.4} ({:.2} %)", 1e9 * f, 100.0 * s))
        .collect();
    println!("{name}: {} nm/N", text.join(", "));
    shares.into_iter().fold(0.0, f64::max)
}

fn less(a: [f64; 6], b: [f64; 6]) -> [f64; 6] {
    std::array::from_fn(|k| a[k] - b[k])
}

fn thin_less_solid_is_converged(name: &str, teeth: &[usize]) {
    let text = shipped(&format!("{name}.toml"));
    let solid = solid_on_both_meshes(&text);
    let coarse = reduced(&gear(&text, REFINEMENT));
    let fine = recorded(name, &gear(&text, 1.0), teeth);
    for (&tooth, fine) in teeth.iter().zip(fine) {
        let coarse = less(deflections(&coarse, tooth), solid[0]);
        let worst = missing(&format!("tooth {tooth}"), coarse, less(fine, solid[1]));
        assert!(worst < 0.01, "tooth {tooth}: {worst}");
    }
}

fn shipped(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fe_models");
    std::fs::read_to_string(folder.join(name)).unwrap()
}

#[test]
#[ignore = "gear 2 and its solid blank: some seconds, without the records half a minute; run with --ignored"]
fn gear_2_is_converged_to_one_per_cent() {
    thin_less_solid_is_converged("gear2", &[0]);
}

/// Tooth 0 stands over a spoke, teeth 9 and 10 on either side of the middle of a slot.
#[test]
#[ignore = "gear 3 and its solid blank: half a minute, without the records a minute; run with --ignored"]
fn gear_3_is_converged_to_one_per_cent_over_a_spoke_and_over_a_slot() {
    thin_less_solid_is_converged("gear3", &[0, 9, 10]);
}
