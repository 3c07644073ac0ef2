//! Meshes of the shipped bevel pairs.

#![allow(clippy::unwrap_used)]

use gearmesh_bevel::BevelGear;
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::BevelMesh;
use std::path::Path;

fn gear(pair: &str, member: &str, bore_mm: f64, more: &str) -> BevelGear {
    let text = format!(
        "name = \"made up\"\n[bevel_gear]\npair = \"{pair}\"\nmember = \"{member}\"\n[blank]\nbore_diameter_mm = {bore_mm}\n{more}\n[material]\n\
         young_GPa = 206.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\n"
    );
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
    BevelGear::from_document(&InputDocument::new("made up", text), &folder).unwrap()
}

#[test]
fn shipped_pairs_are_meshed() {
    for (pair, member, bore) in [
        ("bevel_20_20.toml", "gear", 20.0),
        ("bevel_20_20.toml", "pinion", 20.0),
        ("bevel_13_35.toml", "pinion", 8.0),
        ("bevel_13_35.toml", "gear", 30.0),
        ("bevel_31_36.toml", "pinion", 30.0),
        ("bevel_31_36.toml", "gear", 30.0),
    ] {
        let gear = gear(pair, member, bore, "");
        let mesh = BevelMesh::of_any_quality(&gear).unwrap();
        let [x, y, z] = mesh.quality.worst_m.map(|v| 1e3 * v);
        eprintln!(
            "{pair} {member}: {} nodes {} elements, jacobian {:.3} mean {:.3} at {x:.3} {y:.3} {z:.3} r {:.3}",
            mesh.nodes.len(), mesh.elements.len(), mesh.quality.smallest, mesh.quality.mean, x.hypot(y)
        );
    }
}
