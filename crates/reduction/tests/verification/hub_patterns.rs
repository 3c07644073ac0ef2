//! C_hub of a body that does not repeat, solved by patterns, against C_hub in full.

use crate::small_gears::{COARSE, THIN_RIM, difference, gear, reduced};
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::ReducedGear;
use gearmesh_reduction::Silent;
use gearmesh_reduction::flank_loads::{SparseVector, flank_grid, flank_loads};
use gearmesh_reduction::hub_patterns::by_patterns;

/// Five holes and 18 teeth. Every block of every tooth is what it was, to what is said to be left out, and that is
/// less than 1e-8.
#[test]
fn patterns_keep_every_block() {
    let holes = "holes = { count = 5, pitch_circle_diameter_mm = 29.0, diameter_mm = 4.0, phase_deg = 7.0 }\n";
    let coarse = gear(COARSE, &format!("{THIN_RIM}{holes}"), 0.0).source;
    let text = coarse.replace(
        "roll_stations = 4\nslices = 2",
        "roll_stations = 7\nslices = 3",
    );
    assert_ne!(coarse, text);
    let gear = GearDefinition::from_document(&InputDocument::new("small.toml", text)).unwrap();
    let (model, body) = reduced(&gear, false);
    assert_eq!(model.sectors, 1);
    let grid = flank_grid(&gear);
    let loads: Vec<SparseVector> = (gear.reduction.flanks.iter())
        .flat_map(|&side| flank_loads(&gear, &body.mesh, &grid, 0, side))
        .map(|load| load.normal)
        .collect();
    let vectors: Vec<&SparseVector> = loads.iter().collect();
    let found = by_patterns(&body, &vectors, &Silent).unwrap();
    let (patterns, left_out) = (found.patterns, found.left_out);
    assert_eq!(model.hub_patterns, None);
    // On every tooth the shapes of load that reach the circle below, at most as many as there are loads.
    assert!(found.solved.is_multiple_of(18) && found.solved <= 18 * loads.len());
    println!(
        "{} patterns of {} loads leave out {left_out:e}",
        patterns.count,
        loads.len()
    );
    assert!(
        patterns.count < loads.len() && left_out < 1e-8,
        "{} {left_out:e}",
        patterns.count
    );
    let kept = ReducedGear {
        c_hub: Vec::new(),
        hub_patterns: Some(patterns),
        ..model.clone()
    };
    kept.validate().unwrap();
    let off = difference(&model.c_hub, &kept.c_hub_in_full());
    // C_hub itself is symmetric to rounding only.
    assert!(off < left_out + 1e-10, "{off:e} {left_out:e}");
}
