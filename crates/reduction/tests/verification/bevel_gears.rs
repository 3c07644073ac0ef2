//! Reduction of bevel gears: identities, the ring against one factorisation, mirror images, mass, gauges, the
//! deflection of a tooth against another program's.

use gearmesh_bevel::BevelGear;
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::{BevelMesh, BodyGrid};
use gearmesh_model::{Flank, ReducedGear, read_reduced_gear, write_reduced_gear};
use gearmesh_reduction::bevel::reduce_bevel;
use gearmesh_reduction::{ReductionOptions, Silent};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Coarse: what is tested holds on every mesh.
const COARSE: &str = "[mesh]\nflank_mm = 1.5\nfillet_mm = 0.4\nbody_mm = 6.0\nalong_mm = 3.75\n[reduction]\nprofile_stations = 4\nslices = 2\n";

const GAUGE: &str =
    "[[gauge]]\nname = \"root\"\ntooth = 0\nside = \"right\"\nlength_mm = 0.3\nwidth_mm = 6.0\n";

fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models")
}

fn gear_in(folder: &Path, [pair, member]: [&str; 2], bore_mm: f64, more: &str) -> BevelGear {
    let text = format!(
        "name = \"made up\"\n[bevel_gear]\npair = \"{pair}\"\nmember = \"{member}\"\n[blank]\nbore_diameter_mm = {bore_mm}\n\
         [material]\nyoung_GPa = 206.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\n{more}\n"
    );
    BevelGear::from_document(&InputDocument::new("made up", text), folder).unwrap()
}

fn gear(pair: &str, member: &str, bore_mm: f64, more: &str) -> BevelGear {
    gear_in(&models(), [pair, member], bore_mm, more)
}

fn reduced(gear: &BevelGear) -> ReducedGear {
    let options = ReductionOptions {
        estimate_error: false,
    };
    let (model, _) = reduce_bevel(gear, options, &Silent).unwrap();
    model.validate().unwrap();
    model
}

/// The coarse gear of 20/20 with a gauge, reduced once.
fn coarse() -> &'static ReducedGear {
    static MODEL: OnceLock<ReducedGear> = OnceLock::new();
    let more = format!("{COARSE}{GAUGE}");
    MODEL.get_or_init(|| reduced(&gear("bevel_20_20.toml", "gear", 34.0, &more)))
}

/// Largest difference relative to the largest value.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let worst = a
        .iter()
        .zip(b)
        .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    worst / largest
}

/// All entries: the ring by repetition and one factorisation of everything; the file gives the model back.
#[test]
fn the_ring_is_solved_as_the_whole() {
    let ring = coarse();
    let more = format!("{COARSE}symmetry = \"off\"\n{GAUGE}");
    let whole = reduced(&gear("bevel_20_20.toml", "gear", 34.0, &more));
    let found = [
        difference(&ring.c_hub, &whole.c_hub),
        difference(&ring.c_tooth, &whole.c_tooth),
        difference(&ring.gauges[0].adjoint, &whole.gauges[0].adjoint),
        difference(&ring.gauges[0].own_tooth, &whole.gauges[0].own_tooth),
        whole.checks.symmetry,
        whole.checks.pattern_identity,
        ring.checks.pattern_identity,
    ];
    assert!(found.iter().all(|error| *error < 1e-9), "{found:?}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gear.h5");
    write_reduced_gear(&path, ring).unwrap();
    assert_eq!(read_reduced_gear(&path).unwrap(), *ring);
}

/// Bricks of twenty nodes fulfil the same identities, and those of eight nodes come closer to them on a finer mesh.
#[test]
fn a_finer_mesh_comes_closer_to_quadratic_elements() {
    let own = |element: &str, factor: f64| {
        let tables = format!(
            "[mesh]\nelement = \"{element}\"\nflank_mm = {}\nfillet_mm = {}\nbody_mm = {}\nalong_mm = {}\n[reduction]\nprofile_stations = 4\nslices = 2\nflanks = [\"right\"]\n",
            2.0 * factor,
            0.4 * factor,
            6.0 * factor,
            7.5 * factor
        );
        let model = reduced(&gear("bevel_13_35.toml", "pinion", 12.0, &tables));
        assert!(model.checks.pattern_identity < 1e-9);
        let (n, k) = (model.grid.len(), model.grid.load(2, 2));
        model.c_hub_block(0, Flank::Right, 0, Flank::Right)[k * n + k]
    };
    let best = own("hex20", 1.0);
    let [coarse, fine] =
        [1.0, 0.5].map(|factor| (own("hex8-incompatible", factor) / best - 1.0).abs());
    assert!(fine < 0.5 * coarse && fine < 0.03, "{coarse} {fine}");
}

/// Both flanks carry loads and both are loaded alike by their own: C_hub is symmetric over all teeth and flanks, and
/// positive.
#[test]
fn betti_holds_between_all_teeth_and_flanks() {
    let model = coarse();
    let n = model.grid.len();
    let largest = model.c_hub.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    for (load, response) in [(0, 0), (0, 1), (3, 17), (19, 2)] {
        for f in [Flank::Right, Flank::Left] {
            for g in [Flank::Right, Flank::Left] {
                let there = model.c_hub_block(load, f, response, g);
                let back = model.c_hub_block(response, g, load, f);
                for l in 0..n {
                    for m in 0..n {
                        let error = (there[l * n + m] - back[m * n + l]).abs();
                        assert!(error < 1e-9 * largest);
                    }
                }
            }
        }
    }
    // The own deflection falls from tip to root and with the distance between teeth.
    let at = |tooth: usize, u: usize| {
        let k = model.grid.load(u, 2);
        model.c_hub_block(0, Flank::Right, tooth, Flank::Right)[k * n + k]
    };
    assert!(at(0, 3) > at(0, 2) && at(0, 2) > at(1, 2) && at(1, 2) > at(2, 2).abs());
}

/// A left-hand gear is the mirror image of a right-hand one: right flanks are its left ones, teeth are counted the
/// other way.
#[test]
fn the_other_hand_is_the_mirror_image() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(models().join("bevel_20_20.toml")).unwrap();
    assert!(text.contains("pinion_hand = \"right\""));
    let mirrored = text.replace("pinion_hand = \"right\"", "pinion_hand = \"left\"");
    std::fs::write(folder.path().join("other.toml"), mirrored).unwrap();
    let one = coarse();
    let other = gear_in(folder.path(), ["other.toml", "gear"], 34.0, COARSE);
    let other = reduced(&other);
    assert_ne!(
        one.bevel.as_ref().unwrap().hand,
        other.bevel.as_ref().unwrap().hand
    );
    for tooth in [0, 1, 2, 19] {
        for (f, g) in [
            (Flank::Right, Flank::Right),
            (Flank::Left, Flank::Left),
            (Flank::Right, Flank::Left),
        ] {
            let a = one.c_hub_block(0, f, tooth, g);
            let b = other.c_hub_block(0, f.opposite(), (20 - tooth) % 20, g.opposite());
            assert!(difference(&a, &b) < 1e-8, "{tooth} {}", difference(&a, &b));
        }
    }
    let [a, b] = [(one, Flank::Right), (&other, Flank::Left)].map(|(m, f)| m.c_tooth_block(f));
    assert!(difference(a, b) < 1e-8);
    let fields = [one, &other].map(|m| m.bevel.as_ref().unwrap().near_field.clone().unwrap());
    let places = fields[0].profile.len() * fields[0].sections_m.len();
    let (a, b) = (&fields[0].contact_m2_per_n, &fields[1].contact_m2_per_n);
    assert!(difference(&a[..places], &b[places..]) < 1e-6);
}

/// Volume of a polygon of the meridian, turned about the axis (Pappus).
fn turned_m3(points: &[[f64; 2]]) -> f64 {
    let mut sum = 0.0;
    for (k, [r, z]) in points.iter().enumerate() {
        let [r2, z2] = points[(k + 1) % points.len()];
        sum += (r + r2) * (r * z2 - r2 * z);
    }
    (TAU / 6.0 * sum).abs()
}

/// A thin web with steep walls between rim and hub: too much for rows, so that the body is meshed freely.
const WEB: &str = "[[blank.web]]\ndiameter_mm = 24.0\nz_mm = [30.9, 42.2]\n[[blank.web]]\ndiameter_mm = 25.0\nz_mm = [34.0, 38.0]\n[[blank.web]]\ndiameter_mm = 34.0\nz_mm = [34.0, 38.0]\n";

/// Mass against the body of revolution below the roots in closed form plus the teeth by sums over the exact surfaces.
#[test]
fn mass_is_that_of_the_surfaces() {
    for (more, grid) in [("", BodyGrid::Rows), (WEB, BodyGrid::Free)] {
        let gear = gear("bevel_20_20.toml", "gear", 20.0, more);
        let mesh = BevelMesh::new(&gear).unwrap();
        assert_eq!(mesh.body_grid(), grid);
        has_the_mass_of_its_surfaces(&gear, &mesh);
    }
}

fn has_the_mass_of_its_surfaces(gear: &BevelGear, mesh: &BevelMesh) {
    let model = gearmesh_reduction::bevel::bevel_model(gear, mesh).unwrap();
    let mass = gearmesh_fe::mass_moments(&model, 7850.0).unwrap()[0];
    let (blank, tooth) = (gear.blank(), &gear.tooth);
    let ends = [blank.inner_cone_m(), blank.outer_cone_m];
    let root = |cone: f64| {
        let heights = tooth.flanks.iter().map(|flank| {
            let end = flank.root(cone).unwrap();
            flank.place(&end.point.r)[1]
        });
        0.5 * heights.sum::<f64>()
    };
    // Anticlockwise round the meridian below the roots.
    let at = |cone: f64, height: f64| {
        let [z, r] = blank.meridian_m(cone, height);
        [r, z]
    };
    let rim = |cone: f64| at(cone, -blank.dedendum_m(cone) - gear.body.rim_m);
    let mut polygon = vec![at(ends[0], root(ends[0])), rim(ends[0])];
    polygon.extend(gear.body.contour.iter().map(|p| [p.radius_m, p.z_m[0]]));
    polygon.extend(
        gear.body
            .contour
            .iter()
            .rev()
            .map(|p| [p.radius_m, p.z_m[1]]),
    );
    polygon.extend([rim(ends[1]), at(ends[1], root(ends[1]))]);
    let below = turned_m3(&polygon);

    // Teeth: the angle that they cover over the section, summed along the face by the middles of 24 parts.
    let parts = 24;
    let mut teeth = 0.0;
    for i in 0..parts {
        let share = (f64::from(i) + 0.5) / f64::from(parts);
        let cone = ends[0] + share * (ends[1] - ends[0]);
        let mut section = 0.0;
        for flank in &tooth.flanks {
            let facing = flank.side.facing(blank.hand);
            let half = tooth.half_angle_rad(flank.side);
            let shares: Vec<f64> = (0..=60).rev().map(|k| f64::from(k) / 60.0).collect();
            let mut line: Vec<[f64; 2]> = Vec::new();
            let mut add = |r: nalgebra::Vector3<f64>| {
                let height = flank.place(&r)[1];
                line.push([height, facing * (half + r.y.atan2(r.x))]);
            };
            for found in flank.fillet_line(cone, &shares).unwrap().iter().rev() {
                add(found.point.r);
            }
            let bottom = flank.bottom(cone).unwrap();
            let (low, high) = (flank.place(&bottom.point.r)[1], blank.addendum_m(cone));
            for k in 1..=60 {
                let height = low + (high - low) * f64::from(k) / 60.0;
                add(flank.locate_from(cone, height, &bottom).unwrap().point.r);
            }
            for pair in line.windows(2) {
                let radius = blank.meridian_m(cone, 0.5 * (pair[0][0] + pair[1][0]))[1];
                section += radius * (pair[1][0] - pair[0][0]) * 0.5 * (pair[0][1] + pair[1][1]);
            }
        }
        teeth += section * blank.face_width_m / f64::from(parts);
    }
    let exact = 7850.0 * (below + blank.teeth as f64 * teeth);
    let error = mass / exact - 1.0;
    assert!(error.abs() < 1e-3, "{mass} {exact}");
}

/// A gauge reads strain: nothing of a rigid motion, and tension on the loaded side for loads high on its own flank.
/// Method 2 and method 1 agree where the near field of the load is gone: on other teeth exactly, near the tip of the
/// own one within a part of the reading.
#[test]
fn gauges_read_tension_on_the_loaded_side() {
    let more = format!(
        "[hub]\nsupport = \"reference-point\"\n[reduction]\nprofile_stations = 5\nslices = 2\n{GAUGE}{}",
        GAUGE.replace("right", "left").replace("root", "back")
    );
    let model = reduced(&gear("bevel_20_20.toml", "gear", 20.0, &more));
    let rigid = model.checks.further("gauges under rigid motions").unwrap();
    assert!(rigid < 1e-9, "{rigid}");
    let n = model.grid.len();
    let [root, back] = [&model.gauges[0], &model.gauges[1]];
    // Right flank loaded: tension on the right, pressure on the left.
    for u in 2..5 {
        let load = 3 * model.grid.load(u, 2);
        assert!(root.adjoint[load] > 0.0 && back.adjoint[load] < 0.0);
    }
    let high = model.grid.load(4, 2);
    let (second, less) = (root.adjoint[3 * high], root.own_tooth[high]);
    assert!(less.abs() < 0.1 * second, "{second} {less}");
    // Loads on tooth 1 hardly strain the root of tooth 0.
    let next = root.adjoint[3 * (2 * n + high)];
    assert!(next.abs() < 0.2 * second);
    plane_sections_stand_for_the_tooth(&model);
}

/// W of the section in the middle against the three-dimensional submodel of the tooth under a load along all of it,
/// read in the middle: the tooth is some three times as long as thick, its ends are free and it tapers, so that a plane
/// problem in the section normal to it is near the truth but not the truth.
fn plane_sections_stand_for_the_tooth(model: &ReducedGear) {
    let field = model.bevel.as_ref().unwrap().near_field.as_ref().unwrap();
    let (stations, along) = (model.grid.roll_angles_rad.len(), model.grid.z_m.len());
    for (f, &flank) in model.flanks.iter().enumerate() {
        let w = field.mesh_block(f, 1, stations);
        for i in 0..stations {
            let points: Vec<[f64; 3]> = (0..along)
                .map(|j| model.bevel_point(flank, model.grid.load(i, j)).unwrap()[0])
                .collect();
            let piece = |p: &[[f64; 3]]| {
                let d = [0, 1, 2].map(|k| p[1][k] - p[0][k]);
                d.iter().map(|x| x * x).sum::<f64>().sqrt()
            };
            let length: f64 = points.windows(2).map(piece).sum();
            let middle = model.grid.load(i, along / 2);
            let deflection: f64 = (0..along)
                .map(|j| {
                    let share =
                        if j == 0 || j + 1 == along { 0.5 } else { 1.0 } / (along - 1) as f64;
                    share
                        * model.c_tooth_block(flank)
                            [middle * model.grid.len() + model.grid.load(i, j)]
                })
                .sum();
            let plane = w[i * stations + i] / length;
            let ratio = plane / deflection;
            assert!((ratio - 1.0).abs() < 0.15, "{flank} {i}: {ratio}");
        }
    }
}

/// Deflection of a tooth under patch loads against scikit-fem's tetrahedra over the same surface
/// (tools/reference/bevel_tooth.py).
#[test]
fn tooth_deflection_is_that_of_another_program() {
    // On the default lengths it is up to 2.2 % stiffer than the reference.
    let more = "[mesh]\nflank_mm = 0.55\nfillet_mm = 0.14\nbody_mm = 2.2\nalong_mm = 0.9\n[reduction]\nprofile_stations = 5\nslices = 2\n";
    let model = reduced(&gear("bevel_20_20.toml", "gear", 34.0, more));
    let n = model.grid.len();
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reference/bevel_tooth/compliance.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let mut worst: f64 = 0.0;
    let mut rows = 0;
    for line in text.lines().filter(|line| !line.starts_with('#')).skip(1) {
        let fields: Vec<f64> = line
            .split(',')
            .map(|field| field.parse().unwrap())
            .collect();
        let [flank, i, j, k, l] = [0, 1, 2, 3, 4].map(|c| fields[c] as usize);
        let side = [Flank::Right, Flank::Left][flank];
        let (load, response) = (model.grid.load(i, j), model.grid.load(k, l));
        let found = model.c_hub_block(0, side, 0, side)[load * n + response];
        let own = model.c_hub_block(0, side, 0, side)[load * n + load];
        // Of a deflection elsewhere the difference counts in shares of that under the load.
        let error = (found - fields[5]) / own;
        assert!(
            error.abs() < 0.02,
            "{line}: {found:e}, {:.2} %",
            100.0 * error
        );
        worst = worst.max(error.abs());
        rows += 1;
    }
    assert!(rows > 4 && worst < 0.02, "{rows} {worst}");
}
