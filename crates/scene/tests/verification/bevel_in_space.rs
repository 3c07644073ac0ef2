//! A bevel pair as pictures have it: the flanks touch where the places of contact are, and no tooth runs into another.

use std::f64::consts::TAU;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use gearmesh_bevel::PairFile;
use gearmesh_drivetrain::{BevelMesh, BevelSlices};
use gearmesh_geometry::Flank;
use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::pair::{BevelInSpace, BevelScene, BevelStand};
use gearmesh_scene::{ModelShelf, SceneResult};
use nalgebra::{Matrix3, Rotation3, Vector3};

fn loaded(name: &str, more: &str) -> SceneResult {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
    let text = std::fs::read_to_string(folder.join(name)).unwrap();
    // Without backlash the flanks behind would touch, too.
    let text = text.replace("[bevel]", "[bevel]\nbacklash_mm = 0.1");
    let load = "[load]\ntorques_Nm = [20.0, 100.0]\npositions_per_pitch = 4\nslices = 15\n";
    let document = InputDocument::new(name, format!("{text}\n{load}{more}"));
    let pair = BevelScene::from_document(document).unwrap();
    let pair = pair.load(&ModelShelf::default()).unwrap();
    pair.run(&|_, _| (), &AtomicBool::new(false)).unwrap()
}

fn turned(angle_rad: f64, point: Vector3<f64>) -> Vector3<f64> {
    Rotation3::from_axis_angle(&Vector3::z_axis(), angle_rad) * point
}

fn axes(stand: &BevelStand) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| stand.axes[i][j])
}

/// The normal of a flank of the gear's tooth 0 at a place.
fn flank_normal(flanks: &BevelMesh, side: Flank, [s, v]: [f64; 2]) -> Vector3<f64> {
    let at = |s: f64, v: f64| flanks.flank_point_m(side, 1, [s, v]);
    let along = at(s + 1e-4, v) - at(s - 1e-4, v);
    let up = at(s, v + 1e-4) - at(s, v - 1e-4);
    along.cross(&up).normalize()
}

/// As designed and off its place: places on the pinion, turned as it is, are those on the gear; the gear has turned in
/// the ratio of the teeth. No point of the pinion's teeth lies in a tooth of the gear, and many lie between them.
#[test]
fn a_bevel_pair_in_space_meshes() {
    let off = "[tca]\noffset_um = 50.0\ngear_axial_um = 100.0\n";
    for (name, more) in [
        ("bevel_13_35.toml", ""),
        ("bevel_13_35.toml", off),
        ("bevel_20_20.toml", "[tca]\npinion_flank = \"convex\"\n"),
    ] {
        let result = loaded(name, more);
        let scene = BevelScene::of_result(&result).unwrap().unwrap();
        let pair = BevelInSpace::new(&scene, &result).unwrap().unwrap();
        let document = InputDocument::new(name, result.source.scene_toml.clone());
        let file = PairFile::from_document(&document).unwrap();
        let slices = BevelSlices::new(&file.blank, &file.design().unwrap(), 15).unwrap();
        let (flanks, bevel) = (slices.pair(), result.bevel.unwrap());
        let stands = [0, 1].map(|member| pair.stand(member));
        let [pinion, gear] = stands.each_ref().map(axes);
        let [apex_1, apex_2] = stands.map(|stand| Vector3::from(stand.apex_m));
        // From the pinion's axes to the gear's.
        let seen = |turns: [f64; 2], point: Vector3<f64>| {
            let world = pinion * turned(turns[0], point) + apex_1;
            turned(-turns[1], gear.transpose() * (world - apex_2))
        };
        let points = pair.touching_points_m();
        let ratio = bevel.teeth[0] as f64 / bevel.teeth[1] as f64;
        let (mut touching, mut between) = (0, 0);
        for angle in 0..result.angles() {
            let turns = pair.turns_rad(angle).unwrap();
            let azimuths = flanks.azimuths_rad(bevel.side);
            let designed = -ratio * (turns[0] + azimuths[0]) - azimuths[1];
            assert!((turns[1] - designed).abs() < 5e-3, "{name} {more} {angle}");
            for at in result.even_position(0, angle).unwrap().pressing() {
                let place = [at.along_m(1) / bevel.face_widths_m[1] + 0.5, at.up(1)];
                let [_, tooth] = bevel.teeth_of(at.pair);
                let turn = TAU * tooth as f64 / bevel.teeth[1] as f64;
                let on_2 = turned(turn, flanks.flank_point_m(bevel.side, 1, place));
                let block = result.lines.slots * result.lines.slices;
                let on_1 = (0..block).map(|k| Vector3::from(points[angle * block + k]));
                let normal = flank_normal(flanks, bevel.side, place);
                let normal = turned(turn, normal);
                let apart = on_1.map(|on_1| seen(turns, on_1) - on_2);
                let nearest = apart.min_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap();
                assert!(
                    nearest.norm() < 5e-5 && nearest.dot(&normal).abs() < 5e-6,
                    "{name} {more} {angle}: {nearest} {}",
                    nearest.dot(&normal)
                );
                touching += 1;
            }
            let drawn = pair.teeth(0);
            let blank = &file.blank.members[1];
            let pitch = TAU / blank.teeth as f64;
            let corners = flanks.flank_corners_m()[1];
            for tooth in 0..drawn.teeth {
                let turn = TAU * tooth as f64 / drawn.teeth as f64;
                for point in drawn.sections_m.iter().flatten() {
                    let p = seen(turns, turned(turn, Vector3::from(*point)));
                    let [cone, height] = blank.cone_place(p.z, p.x.hypot(p.y));
                    let s = (cone - blank.inner_cone_m()) / blank.face_width_m;
                    let line =
                        |a: usize, b: usize| corners[a][1] + s * (corners[b][1] - corners[a][1]);
                    let (low, high) = (line(0, 3), line(1, 2));
                    let v = (height - low) / (high - low);
                    if !(0.0..=1.0).contains(&s) || !(0.0..=1.0).contains(&v) {
                        continue;
                    }
                    between += 1;
                    let [right, left] = Flank::ALL.map(|side| {
                        let wall = flanks.flank_point_m(side, 1, [s, v]);
                        wall.y.atan2(wall.x)
                    });
                    let behind = (p.y.atan2(p.x) - left).rem_euclid(pitch);
                    let space = pitch - (left - right);
                    let depth_m = (behind - space).min(pitch - behind) * p.x.hypot(p.y);
                    assert!(depth_m < 2e-5, "{name} {more} {angle}: {depth_m}");
                }
            }
        }
        assert!(touching >= 8 && between > 200, "{touching} {between}");
    }
}

/// A result that speaks of other teeth than its scene, or lacks its places, is not drawn.
#[test]
fn a_damaged_bevel_result_is_not_drawn() {
    let result = loaded("bevel_20_20.toml", "");
    let scene = BevelScene::of_result(&result).unwrap().unwrap();
    let damaged = |change: fn(&mut SceneResult)| {
        let mut other = result.clone();
        change(&mut other);
        let pair = BevelInSpace::new(&scene, &other).unwrap();
        pair.is_none_or(|pair| pair.turns_rad(0).is_none())
    };
    assert!(damaged(|r| r.bevel.as_mut().unwrap().teeth = [20, 21]));
    assert!(damaged(|r| r.lines.places = None));
    assert!(damaged(|r| r.lines.places.as_mut().unwrap().z_2_m.clear()));
    assert!(damaged(|r| r.lines.force_n.fill(0.0)));
    assert!(!damaged(|_| ()));
}
