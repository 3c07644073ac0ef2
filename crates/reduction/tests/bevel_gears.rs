//! Reduction of bevel gears.

#![allow(clippy::unwrap_used)]

use gearmesh_bevel::BevelGear;
use gearmesh_geometry::input::InputDocument;
use gearmesh_reduction::Silent;
use gearmesh_reduction::bevel::reduce_bevel;
use std::path::Path;

fn gear(pair: &str, member: &str, bore_mm: f64, more: &str) -> BevelGear {
    let text = format!(
        "name = \"made up\"\n[bevel_gear]\npair = \"{pair}\"\nmember = \"{member}\"\n[blank]\nbore_diameter_mm = {bore_mm}\n[material]\n\
         young_GPa = 206.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\n{more}\n"
    );
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
    BevelGear::from_document(&InputDocument::new("made up", text), &folder).unwrap()
}

#[test]
fn first_look() {
    let gear = gear("bevel_20_20.toml", "gear", 20.0, "[[gauge]]\nname=\"root\"\ntooth=0\nside=\"right\"\nlength_mm=0.2\nwidth_mm=3.0\n");
    let (model, _) = reduce_bevel(&gear, &Silent).unwrap();
    model.validate().unwrap();
    eprintln!("{:?}\n{:?}\n{:?}", model.checks, model.provenance.stage_seconds, model.rigid_body);
    let n = model.grid.len();
    let block = model.c_hub_block(0, model.flanks[0], 0, model.flanks[0]);
    let tooth = model.c_tooth_block(model.flanks[0]);
    for i in 0..9 {
        let k = model.grid.load(i, 7);
        eprintln!("{i} hub {:.4} tooth {:.4} nm/N", 1e9 * block[k * n + k], 1e9 * tooth[k * n + k]);
    }
    let field = model.bevel.as_ref().unwrap().near_field.as_ref().unwrap();
    eprintln!("{:?}", field);
    let g = &model.gauges[0];
    for i in 0..9 {
        let k = model.grid.load(i, 7);
        eprintln!("{i} adj {:.4e} own {:.4e}", g.adjoint[3 * k], g.own_tooth[k]);
    }
}
