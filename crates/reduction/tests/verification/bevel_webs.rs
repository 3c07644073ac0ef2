//! Bevel bodies whose webs have steep walls: meshed freely in the meridian, they fulfil what bodies in rows do.

use gearmesh_bevel::BevelGear;
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::BodyGrid;
use gearmesh_model::{Flank, ReducedGear, ReductionChecks};
use gearmesh_reduction::bevel::loads::{bevel_grid, bevel_loads};
use gearmesh_reduction::bevel::{bevel_body, bevel_body_of, reduce_bevel};
use gearmesh_reduction::field::{GridForce, bevel_fields};
use gearmesh_reduction::flank_loads::SparseVector;
use gearmesh_reduction::{GearBody, ReductionOptions, Silent};
use std::collections::BTreeMap;
use std::path::Path;

/// Coarse: what is tested holds on every mesh.
const COARSE: &str = "[mesh]\nflank_mm = 1.5\nfillet_mm = 0.4\nbody_mm = 6.0\nalong_mm = 3.75\nmin_scaled_jacobian = 0.15\n";
const GAUGE: &str =
    "[[gauge]]\nname = \"root\"\ntooth = 0\nside = \"right\"\nlength_mm = 0.3\nwidth_mm = 6.0\n";

/// A rim and a hub, a thin web with steep walls between them: too much for rows.
const STEEP: &str = "rim_mm = 3.0\nhub_z_mm = [26.0, 42.0]\nweb = [{ diameter_mm = 26.0, z_mm = [26.0, 42.0] }, { diameter_mm = 27.0, z_mm = [31.0, 36.0] }, { diameter_mm = 39.0, z_mm = [31.0, 36.0] }]";
/// The same less steep: rows will do.
const GENTLE: &str = "rim_mm = 5.0\nhub_z_mm = [28.0, 43.0]\nweb = [{ diameter_mm = 23.0, z_mm = [28.0, 43.0] }, { diameter_mm = 31.0, z_mm = [31.5, 40.0] }]";

fn gear_with(blank: &str, more: &str) -> BevelGear {
    let text = format!(
        "name = \"made up\"\n[bevel_gear]\npair = \"bevel_20_20.toml\"\nmember = \"gear\"\n[blank]\nbore_diameter_mm = 20.0\n{blank}\n\
         [material]\nyoung_GPa = 206.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\n{more}\n"
    );
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
    BevelGear::from_document(&InputDocument::new("made up", text), &folder).unwrap()
}

fn gear(more: &str) -> BevelGear {
    gear_with(STEEP, more)
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let pairs = a.iter().zip(b);
    pairs.fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / largest
}

/// By repetition and by one factorisation: deflections of all teeth and whole fields agree.
#[test]
fn the_ring_is_solved_as_the_whole() {
    let force = |tooth, side, load| GridForce {
        tooth,
        side,
        load,
        normal_n: 1000.0,
        tangential_n: -50.0,
    };
    let forces = [vec![force(0, Flank::Right, 7), force(4, Flank::Left, 3)]];
    let found = ["auto", "off"].map(|symmetry| {
        let gear = gear(&format!(
            "{COARSE}[reduction]\nprofile_stations = 3\nslices = 2\nsymmetry = \"{symmetry}\"\n"
        ));
        let body = bevel_body(&gear, &Silent).unwrap();
        assert_eq!(body.mesh.body_grid(), BodyGrid::Free);
        let patch = gear.patch(Flank::Right).unwrap();
        let loads = bevel_loads(&body.mesh, &patch, Flank::Right, &bevel_grid(&gear));
        let normals = [&loads[2].normal, &loads[7].normal];
        let mut fields = bevel_fields(&gear, &body, &forces).unwrap();
        (body.compliance(1, &normals, &Silent), fields.remove(0))
    });
    let [(ring, of_ring), (whole, of_whole)] = &found;
    let apart = [
        difference(ring, whole),
        difference(&of_ring.von_mises_pa, &of_whole.von_mises_pa),
        difference(
            of_ring.displacement_m.as_flattened(),
            of_whole.displacement_m.as_flattened(),
        ),
    ];
    assert!(apart.iter().all(|error| *error < 1e-9), "{apart:?}");
}

/// Identities of the reduced model; the mesh error is estimated on meshes of the same kind.
#[test]
fn identities_hold() {
    let gear = gear(&format!(
        "{COARSE}[hub]\nsupport = \"reference-point\"\n[reduction]\nprofile_stations = 3\nslices = 2\n{GAUGE}"
    ));
    let options = ReductionOptions {
        estimate_error: true,
    };
    let (model, body) = reduce_bevel(&gear, options, &Silent).unwrap();
    assert_eq!(body.mesh.body_grid(), BodyGrid::Free);
    model.validate().unwrap();
    let rigid = model.checks.further("gauges under rigid motions").unwrap();
    let found = [
        model.checks.symmetry,
        model.checks.pattern_identity,
        rigid,
        betti(&model),
    ];
    assert!(found.iter().all(|error| *error < 1e-9), "{found:?}");
    // That of other teeth is over several, of which the neighbours, which move most, are exact to a tenth of the loaded
    // one.
    for (name, least) in [
        (ReductionChecks::LOADED_TOOTH_ERROR, 1e-3),
        (ReductionChecks::OTHER_TEETH_ERROR, 1e-4),
    ] {
        let estimated = model.checks.further(name).unwrap();
        assert!(estimated > least && estimated < 0.6, "{name}: {estimated}");
    }
}

/// Largest difference between what a load does at another place of another tooth and flank, and the other way round,
/// relative to the largest compliance.
fn betti(model: &ReducedGear) -> f64 {
    let n = model.grid.len();
    let mut largest = 0.0_f64;
    for (load, response) in [(0, 0), (0, 1), (3, 17), (19, 2)] {
        for f in Flank::ALL {
            for g in Flank::ALL {
                let there = model.c_hub_block(load, f, response, g);
                let back = model.c_hub_block(response, g, load, f);
                for l in 0..n {
                    for m in 0..n {
                        largest = largest.max((there[l * n + m] - back[m * n + l]).abs());
                    }
                }
            }
        }
    }
    largest / model.c_hub.iter().fold(0.0_f64, |m, v| m.max(v.abs()))
}

/// Deflection under a load over the whole width in the middle of the flank, at the loaded tooth, the next one and the
/// one opposite \[m/N\].
fn deflections(grid: BodyGrid, along_mm: f64) -> Vec<f64> {
    let lengths = format!(
        "[mesh]\nflank_mm = 2.0\nfillet_mm = 0.5\nbody_mm = {}\nalong_mm = {along_mm}\n[reduction]\nprofile_stations = 3\nslices = 2\nflanks = [\"right\"]\n",
        4.0 / 3.0 * along_mm
    );
    let gear = gear_with(GENTLE, &lengths);
    let body: GearBody<_> = bevel_body_of(&gear, grid, &Silent).unwrap();
    let patch = gear.patch(Flank::Right).unwrap();
    let flank = bevel_grid(&gear);
    let loads = bevel_loads(&body.mesh, &patch, Flank::Right, &flank);
    let along = flank.z_m.len();
    let mut line: BTreeMap<usize, f64> = BTreeMap::new();
    for j in 0..along {
        let share = if j == 0 || j + 1 == along { 0.5 } else { 1.0 } / (along - 1) as f64;
        for (dof, value) in &loads[flank.load(1, j)].normal {
            *line.entry(*dof).or_default() += share * value;
        }
    }
    let line: SparseVector = line.into_iter().collect();
    let all = body.compliance(1, &[&line], &Silent);
    [0, 1, 10].map(|tooth: usize| all[tooth]).to_vec()
}

/// Both ways of meshing the body come to the same: with equal teeth, what differs comes of the body alone, and falls as
/// elements get shorter along the teeth and in the body.
#[test]
fn both_ways_of_meshing_come_to_the_same() {
    // Four and eight elements along the teeth: an even number in both.
    let found = [3.75, 1.875].map(|along_mm| {
        let [free, rows] = [BodyGrid::Free, BodyGrid::Rows].map(|grid| deflections(grid, along_mm));
        difference(&free, &rows)
    });
    assert!(found[0] < 8e-3 && found[1] < 0.5 * found[0], "{found:?}");
}
