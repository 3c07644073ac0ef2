//! What bevel bodies have besides their compliance: fields, natural modes, the estimate of the mesh error.

use gearmesh_bevel::BevelGear;
use gearmesh_fe::{DofMap, FeModel, SparseMatrix, assemble_mass, assemble_stiffness, mass_moments};
use gearmesh_geometry::ModeRange;
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::BevelMesh;
use gearmesh_model::{Flank, ReducedGear, ReductionChecks};
use gearmesh_reduction::bevel::gauge::bevel_gauge_row;
use gearmesh_reduction::bevel::{bevel_body, reduce_bevel};
use gearmesh_reduction::field::{Field, GridForce, bevel_fields};
use gearmesh_reduction::flank_loads::dot;
use gearmesh_reduction::skin::{SkinFace, skin, skin_of, von_mises_on_faces};
use gearmesh_reduction::{GearBody, ReductionOptions, Silent};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};

/// Coarse: what is tested holds on every mesh.
const COARSE: &str = "[mesh]\nflank_mm = 1.5\nfillet_mm = 0.4\nbody_mm = 6.0\nalong_mm = 3.75\n[reduction]\nprofile_stations = 4\nslices = 2\n";
/// Coarser still: for modes of the whole.
const COARSEST: &str = "[mesh]\nflank_mm = 2.5\nfillet_mm = 0.6\nbody_mm = 8.0\nalong_mm = 6.0\n[reduction]\nprofile_stations = 4\nslices = 2\n";
const GAUGE: &str =
    "[[gauge]]\nname = \"root\"\ntooth = 0\nside = \"right\"\nlength_mm = 0.3\nwidth_mm = 6.0\n";

fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models")
}

fn gear_in(folder: &Path, pair: &str, more: &str) -> BevelGear {
    let text = format!(
        "name = \"made up\"\n[bevel_gear]\npair = \"{pair}\"\nmember = \"gear\"\n[blank]\nbore_diameter_mm = 34.0\n\
         [material]\nyoung_GPa = 206.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\n{more}\n"
    );
    BevelGear::from_document(&InputDocument::new("made up", text), folder).unwrap()
}

fn gear(more: &str) -> BevelGear {
    gear_in(&models(), "bevel_20_20.toml", more)
}

fn body(gear: &BevelGear) -> GearBody<BevelMesh> {
    bevel_body(gear, &Silent).unwrap()
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let pairs = a.iter().zip(b);
    pairs.fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / largest
}

/// A pair of teeth that share a load, with friction on one of them.
fn forces() -> Vec<GridForce> {
    let force = |tooth, side, load, normal_n, tangential_n| GridForce {
        tooth,
        side,
        load,
        normal_n,
        tangential_n,
    };
    vec![
        force(0, Flank::Right, 11, 1200.0, 0.0),
        force(0, Flank::Right, 12, 900.0, -70.0),
        force(19, Flank::Right, 7, 500.0, 0.0),
        force(3, Flank::Left, 8, 100.0, 0.0),
    ]
}

fn stress(body: &GearBody<BevelMesh>, faces: &[SkinFace], field: &Field) -> Vec<f64> {
    von_mises_on_faces(&body.model, faces, field.displacement_m.as_flattened()).unwrap()
}

/// The field of the ring by repetition is that of one factorisation of all of it; gauges read of it what their rows in
/// the reduced model say; close to a gauge the stress of the surface is E times the strain that it reads.
#[test]
fn fields_are_those_of_the_whole_and_gauges_read_them() {
    let tables = format!("{COARSE}symmetry = \"SYMMETRY\"\n{GAUGE}");
    let [(_, ring, of_ring), (gear, whole, of_whole)] = ["auto", "off"].map(|symmetry| {
        let gear = gear(&tables.replace("SYMMETRY", symmetry));
        let body = body(&gear);
        let field = bevel_fields(&gear, &body, &[forces()]).unwrap().remove(0);
        (gear, body, field)
    });
    let faces = skin(&ring.model);
    let flat = |field: &Field| field.displacement_m.as_flattened().to_vec();
    let found = [
        difference(&flat(&of_ring), &flat(&of_whole)),
        difference(&of_ring.von_mises_pa, &of_whole.von_mises_pa),
        difference(
            &stress(&ring, &faces, &of_ring),
            &stress(&whole, &faces, &of_whole),
        ),
    ];
    assert!(found.iter().all(|error| *error < 1e-9), "{found:?}");

    let options = ReductionOptions {
        estimate_error: false,
    };
    let (model, _) = reduce_bevel(&gear, options, &Silent).unwrap();
    let count = model.grid.len();
    let stated: f64 = (forces().iter())
        .map(|f| {
            let flank = model.flank_index(f.side).unwrap();
            let at = 3 * ((f.tooth * 2 + flank) * count + f.load);
            let rows = &model.gauges[0].adjoint[at..at + 2];
            f.normal_n * rows[0] + f.tangential_n * rows[1]
        })
        .sum();
    let row = bevel_gauge_row(&gear, &whole.mesh, &whole.model, &gear.gauges[0], 0).unwrap();
    let read = dot(&row, &flat(&of_whole));
    assert!((read / stated - 1.0).abs() < 1e-9, "{read} {stated}");

    // Faces under the gauge: all their nodes have a tenth of the largest weight; those beside it have a fiftieth.
    let largest = row.iter().fold(0.0, |most: f64, (_, w)| most.max(w.abs()));
    let has_part = |(_, weight): &&(usize, f64)| weight.abs() > 0.1 * largest;
    let weighed: HashSet<u32> = { row.iter().filter(has_part) }
        .map(|(dof, _)| (dof / 3) as u32)
        .collect();
    let under = |face: &&SkinFace| face.corners.iter().all(|n| weighed.contains(n));
    let own: Vec<SkinFace> = faces.iter().filter(under).cloned().collect();
    assert!(own.len() > 1);
    let stresses = stress(&whole, &own, &of_whole);
    let mean = stresses.iter().sum::<f64>() / stresses.len() as f64;
    // Along the fillet in plane strain: von Mises stress √(1 − ν + ν²)/(1 − ν²) E ε = 0.98 E ε.
    let expected = 206e9 * stated;
    assert!((mean / expected - 1.0).abs() < 0.2, "{mean:e} {expected:e}");
}

/// The surface is closed, and the flux of x/3 through it is the volume. So is that of teeth cut out of it.
#[test]
fn the_surface_is_closed_and_faces_outwards() {
    let gear = gear(COARSE);
    let body = body(&gear);
    let exact = mass_moments(&body.model, 1.0).unwrap()[0];
    demand_closed(&body, &skin(&body.model), exact);
    let teeth = [19, 0, 1].map(|tooth| body.mesh.cell_elements(tooth));
    let exact = |elements: &[u32]| -> f64 {
        let volume = |e: &u32| body.model.element_volume(*e as usize).unwrap();
        elements.iter().map(volume).sum()
    };
    let teeth = teeth.concat();
    demand_closed(&body, &skin_of(&body.model, &teeth), exact(&teeth));
}

fn demand_closed(body: &GearBody<BevelMesh>, faces: &[SkinFace], exact: f64) {
    let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
    let mut volume = 0.0;
    for face in faces {
        let count = face.corners.len();
        let at = |k: usize| body.mesh.nodes[face.corners[k % count] as usize];
        for k in 0..count {
            let (a, b) = (face.corners[k], face.corners[(k + 1) % count]);
            *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
        // A quad with straight sides, bilinear in between, has the mean flux of its two pairs of triangles.
        let first_corners = if count == 4 { 0..2 } else { 0..1 };
        let share = 1.0 / first_corners.len() as f64;
        for first in first_corners {
            for k in first + 1..first + count - 1 {
                let [a, b, c] = [at(first), at(k), at(k + 1)];
                volume += share
                    * (a[0] * (b[1] * c[2] - b[2] * c[1])
                        + a[1] * (b[2] * c[0] - b[0] * c[2])
                        + a[2] * (b[0] * c[1] - b[1] * c[0]))
                    / 6.0;
            }
        }
    }
    assert!(edges.values().all(|sum| *sum == 0));
    assert!((volume / exact - 1.0).abs() < 1e-9, "{volume} {exact}");
}

/// The field of a left-hand gear is the mirror image of that of a right-hand one.
#[test]
fn the_field_of_the_other_hand_is_the_mirror_image() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(models().join("bevel_20_20.toml")).unwrap();
    assert!(text.contains("pinion_hand = \"right\""));
    let mirrored = text.replace("pinion_hand = \"right\"", "pinion_hand = \"left\"");
    std::fs::write(folder.path().join("other.toml"), mirrored).unwrap();
    let one = gear(COARSE);
    let other = gear_in(folder.path(), "other.toml", COARSE);
    let images: Vec<GridForce> = (forces().into_iter())
        .map(|f| GridForce {
            tooth: (20 - f.tooth) % 20,
            side: f.side.opposite(),
            ..f
        })
        .collect();
    let middles = |gear: &BevelGear, forces: Vec<GridForce>, mirror: f64| {
        let body = body(gear);
        let field = bevel_fields(gear, &body, &[forces]).unwrap().remove(0);
        let faces = skin(&body.model);
        let place = |face: &SkinFace| {
            let mut middle = [0.0; 3];
            for node in &face.corners {
                for (sum, x) in middle.iter_mut().zip(body.mesh.nodes[*node as usize]) {
                    *sum += x / face.corners.len() as f64;
                }
            }
            middle[1] *= mirror;
            // To tenths of a micrometre.
            middle.map(|x| (x * 1e7).round() as i64)
        };
        let stresses = stress(&body, &faces, &field);
        let places = faces.iter().map(place);
        places.zip(stresses).collect::<BTreeMap<[i64; 3], f64>>()
    };
    let a = middles(&one, forces(), 1.0);
    let b = middles(&other, images, -1.0);
    assert_eq!(a.len(), b.len());
    let largest = a.values().fold(0.0_f64, |m, v| m.max(*v));
    let mut found = 0;
    for (place, stress) in &a {
        // Rounding of places may part a few.
        if let Some(image) = b.get(place) {
            assert!((stress - image).abs() < 1e-6 * largest, "{stress} {image}");
            found += 1;
        }
    }
    assert!(found as f64 > 0.99 * a.len() as f64, "{found} {}", a.len());
}

fn product(matrix: &SparseMatrix, x: &[f64]) -> Vec<f64> {
    product_of(matrix, x, |value| value)
}

/// Product with a function of the entries.
fn product_of(matrix: &SparseMatrix, x: &[f64], of: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut sum = vec![0.0; x.len()];
    for (column, x) in x.iter().enumerate() {
        let rows = matrix.row_idx_of_col(column);
        for (row, value) in rows.zip(matrix.val_of_col(column)) {
            sum[row] += of(*value) * x;
        }
    }
    sum
}

/// Natural modes of the ring by harmonics against one eigenvalue problem of all of it; shapes have modal mass 1 and are
/// orthogonal in M and K of the whole; the model file's rows are products of loads, gauges and rigid motions with them.
#[test]
fn modes_are_those_of_the_whole() {
    let tables = format!("{COARSEST}symmetry = \"SYMMETRY\"\n[modes]\ncount = 6\n{GAUGE}");
    let found = ["auto", "off"].map(|symmetry| {
        let gear = gear(&tables.replace("SYMMETRY", symmetry));
        let body = body(&gear);
        let rigid = body.rigid_mass(7850.0).unwrap();
        let mut fields = Vec::new();
        let modes = body
            .natural_modes(&rigid, ModeRange::Count(6), &Silent, |_, _, field| {
                fields.push(field.to_vec());
            })
            .unwrap();
        (gear, body, modes, fields)
    });
    let [(gear, ring, own, fields), (_, _, whole, _)] = &found;
    assert_eq!(own.modes.len(), whole.modes.len());
    for (a, b) in own.modes.iter().zip(&whole.modes) {
        let hz = (a.frequency_hz(), b.frequency_hz());
        assert!((hz.0 / hz.1 - 1.0).abs() < 1e-9, "{hz:?}");
        assert_eq!(a.nodal_diameters, b.nodal_diameters, "{hz:?}");
    }
    let m = assemble_mass(&ring.model, &ring.dofs, 7850.0).unwrap();
    let k = assemble_stiffness(&ring.model, &ring.dofs).unwrap();
    let free = |field: &[f64]| -> Vec<f64> {
        (0..ring.dofs.free_count())
            .map(|f| field[ring.dofs.full_of(f)])
            .collect()
    };
    let shapes: Vec<Vec<f64>> = fields.iter().map(|f| free(f)).collect();
    let inner = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for (i, a) in shapes.iter().enumerate() {
        let (ma, ka) = (product(&m, a), product(&k, a));
        let square = own.modes[i].omega_squared;
        for (j, b) in shapes.iter().enumerate() {
            let unit = if i == j { 1.0 } else { 0.0 };
            let (mass, stiffness) = (inner(b, &ma), inner(b, &ka) / square);
            assert!((mass - unit).abs() < 1e-9, "{i} {j} {mass}");
            assert!((stiffness - unit).abs() < 1e-9, "{i} {j} {stiffness}");
        }
    }
    let options = ReductionOptions {
        estimate_error: false,
    };
    let (model, _) = reduce_bevel(gear, options, &Silent).unwrap();
    model.validate().unwrap();
    rows_are_products(&model, ring, fields);
}

/// Rows of the first mode, alone at its frequency or not: sums of squares over pairs of equal frequency do not depend
/// on how the pair lies.
fn rows_are_products(model: &ReducedGear, ring: &GearBody<BevelMesh>, fields: &[Vec<f64>]) {
    let basis = model.modes.as_ref().unwrap();
    assert_eq!(basis.count(), fields.len());
    let gear = gear(&format!("{COARSEST}{GAUGE}"));
    let row = bevel_gauge_row(&gear, &ring.mesh, &ring.model, &gear.gauges[0], 0).unwrap();
    let momenta = ring.rigid_mass(7850.0).unwrap().momenta;
    let (mut strain, mut rigid) = ([0.0; 2], [0.0; 2]);
    for (mode, field) in fields.iter().enumerate() {
        strain[0] += dot(&row, field).powi(2);
        strain[1] += basis.gauges[mode].powi(2);
        // About the axis: the torsion.
        let turned: f64 = (0..field.len())
            .map(|dof| momenta[(dof, 5)] * field[dof])
            .sum();
        rigid[0] += turned.powi(2);
        rigid[1] += basis.coupling[6 * mode + 5].powi(2);
    }
    assert!((strain[0] / strain[1] - 1.0).abs() < 1e-6, "{strain:?}");
    assert!(
        (rigid[0] / rigid[1] - 1.0).abs() < 1e-6 && rigid[0] > 0.0,
        "{rigid:?}"
    );
}

/// Rigid motions of the free body cost no energy, so that a body on a reference point moves as one: K R = 0 over all
/// degrees of freedom.
#[test]
fn rigid_motions_cost_nothing() {
    let gear = gear(COARSE);
    let body = body(&gear);
    let rigid = body.rigid_mass(7850.0).unwrap();
    let model: &FeModel = &body.model;
    let free = DofMap::all_free(model.node_count()).unwrap();
    let k = assemble_stiffness(model, &free).unwrap();
    for q in 0..6 {
        let motion: Vec<f64> = (0..model.dof_count())
            .map(|d| rigid.motions[(d, q)])
            .collect();
        let force = product(&k, &motion);
        let sizes: Vec<f64> = motion.iter().map(|x| x.abs()).collect();
        let terms = product_of(&k, &sizes, f64::abs);
        let scale = terms.iter().fold(0.0_f64, |m, f| m.max(*f));
        let largest = force.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        assert!(largest < 1e-9 * scale, "{q}: {largest} {scale}");
    }
}

/// The estimate against bricks of twenty nodes of the same lengths: it is not below the error, nor of another order.
#[test]
fn the_estimate_is_above_the_error() {
    let lengths = |factor: f64, element: &str| {
        format!(
            "[mesh]\nelement = \"{element}\"\nflank_mm = {}\nfillet_mm = {}\nbody_mm = {}\nalong_mm = {}\n[reduction]\nprofile_stations = 4\nslices = 2\nflanks = [\"right\"]\n{GAUGE}",
            2.0 * factor,
            0.4 * factor,
            6.0 * factor,
            4.5 * factor
        )
    };
    let reduced = |more: &str, estimate_error: bool| {
        let options = ReductionOptions { estimate_error };
        reduce_bevel(&gear(more), options, &Silent).unwrap().0
    };
    let own = reduced(&lengths(1.0, "hex8-incompatible"), true);
    let best = reduced(&lengths(1.0, "hex20"), false);
    let n = own.grid.len();
    let along = own.grid.z_m.len();
    let line = |model: &ReducedGear, tooth: usize| -> f64 {
        let c = model.c_hub_block(0, Flank::Right, tooth, Flank::Right);
        let w = model.c_tooth_block(Flank::Right);
        let share =
            |j: usize| if j == 0 || j + 1 == along { 0.5 } else { 1.0 } / (along - 1) as f64;
        let mut sum = 0.0;
        for j in 0..along {
            for l in 0..along {
                let at = model.grid.load(2, j) * n + model.grid.load(2, l);
                let near = if tooth == 0 { w[at] } else { 0.0 };
                sum += share(j) * share(l) * (c[at] - near);
            }
        }
        sum
    };
    // Over several teeth: root of the sum of squares, over that of the deflections, as the estimate has it.
    let error = |teeth: &[usize]| {
        let norm = |values: &dyn Fn(usize) -> f64| {
            let squares = teeth.iter().map(|&tooth| values(tooth).powi(2));
            squares.sum::<f64>().sqrt()
        };
        norm(&|tooth| line(&own, tooth) - line(&best, tooth)) / norm(&|tooth| line(&best, tooth))
    };
    let stated = |name: &str| own.checks.further(name).unwrap();
    let loaded = [error(&[0]), stated(ReductionChecks::LOADED_TOOTH_ERROR)];
    let other = [
        error(&[1, 19, 2, 18, 10]),
        stated(ReductionChecks::OTHER_TEETH_ERROR),
    ];
    let reading = |model: &ReducedGear| -> f64 {
        let load = |j| 3 * model.grid.load(3, j);
        (0..along).map(|j| model.gauges[0].adjoint[load(j)]).sum()
    };
    let gauge = [
        (reading(&own) / reading(&best) - 1.0).abs(),
        own.gauges[0].error_estimate_relative,
    ];
    for [found, estimated] in [loaded, other, gauge] {
        assert!(
            found < estimated && estimated < 0.3,
            "{loaded:?} {other:?} {gauge:?}"
        );
    }
}
