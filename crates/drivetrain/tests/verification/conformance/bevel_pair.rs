//! Bevel gears run through the same models, and their contact without load is that of the tooth contact analysis.

use gearmesh_bevel::{
    Assembly, AssemblyError, ContactKind, FlankSide, PairBlank, PairDesign, PairFile, TcaRequest,
    tooth_contact,
};
use gearmesh_drivetrain::flank_contacts::FlankContacts;
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_geometry::Flank;
use gearmesh_geometry::point_contact::{PointContact, contact_modulus_pa};
use nalgebra::{Matrix3, Vector3};

use crate::conformance::energy::{check_energy, check_power};
use crate::conformance::hard_pairs::{HARD, HardPair};
use crate::conformance::two_bodies::{check_reaction, check_tangents, check_turned};
use crate::conformance::{DAMPINGS, friction};
use crate::mesh_common::*;

pub(crate) struct Pair {
    pub blank: PairBlank,
    pub design: PairDesign,
    pub mesh: BevelMesh,
}

pub(crate) fn pair(name: &str) -> Pair {
    let file = format!("{}/../../fe_models/{name}", env!("CARGO_MANIFEST_DIR"));
    pair_of(PairFile::read(file.as_ref()).unwrap())
}

pub(crate) fn pair_of(file: PairFile) -> Pair {
    let design = file.design().unwrap();
    Pair {
        mesh: BevelMesh::new(&file.blank, &design).unwrap(),
        blank: file.blank,
        design,
    }
}

impl Pair {
    /// Gear 2 in gear 1 of an assembly with errors, both turned about their axes.
    pub fn pose(&self, error: &AssemblyError, turns_rad: [f64; 2]) -> Pose {
        let assembly = Assembly::new(&self.blank, error);
        let axes = [0, 1].map(|m: usize| {
            let turn: Matrix3<f64> = about(Vector3::z(), turns_rad[m]);
            assembly.members[m].axes * turn
        });
        let apart = assembly.members[1].apex_m - assembly.members[0].apex_m;
        let back = axes[0].transpose();
        Pose::at_rest(back * apart, back * axes[1])
    }

    pub fn gap_m(&self, pose: &Pose, side: Flank) -> f64 {
        let mut found = FlankContacts::default();
        self.mesh.contacts_at(pose, side, &mut found).unwrap();
        found.lines[0].ideal_gap_m
    }

    /// Turn of gear 2 at which the flanks of a side stand open by so much.
    pub fn turn_2(&self, error: &AssemblyError, turn_1: f64, side: Flank, gap_m: f64) -> f64 {
        let lever = self.mesh.levers_m()[1] * side.mirror();
        let mut turn_2 =
            -turn_1 * self.blank.data.teeth[0] as f64 / self.blank.data.teeth[1] as f64;
        for _ in 0..60 {
            let off = self.gap_m(&self.pose(error, [turn_1, turn_2]), side) - gap_m;
            turn_2 -= off / lever;
            if off.abs() < 1e-15 {
                break;
            }
        }
        turn_2
    }

    fn mesh(&self) -> GearMesh {
        let law = || {
            let stiffness = PowerStiffness::n_per_mm_e(7.2e5, 1.5).unwrap();
            Impact::new(stiffness, 2e3, 2e-6, 1).unwrap()
        };
        let mesh = GearMesh::of_flanks(Box::new(self.mesh.clone()), Flank::Right, law()).unwrap();
        mesh.with_side(Flank::Left, law()).unwrap()
    }
}

/// Offset, axial places, shaft angle.
pub(crate) fn assembly([v, p, g, a]: [f64; 4]) -> AssemblyError {
    AssemblyError {
        offset_m: v,
        pinion_axial_m: p,
        gear_axial_m: g,
        shaft_angle_rad: a,
    }
}

/// Positions a pitch.
const POSITIONS: usize = 12;
pub(crate) const AS_DESIGNED: [f64; 4] = [0.0; 4];
/// Errors that bring the contact to toe, heel and tips.
pub(crate) const MISALIGNED: [[f64; 4]; 4] = [
    [0.15e-3, 0.0, 0.0, 0.0],
    [-0.15e-3, 0.0, 0.0, 1e-3],
    [0.0, 0.1e-3, -0.05e-3, -2e-3],
    [0.05e-3, -0.2e-3, 0.1e-3, 0.0],
];

/// The design at first touch turns gear 2 as the tooth contact analysis says, in every assembly, edges included.
#[test]
fn bevel_flanks_touch_without_load_where_the_contact_analysis_says() {
    let little = [-5e-6, 5e-6, 5e-6, 2e-5];
    let files = ["bevel_20_20.toml", "bevel_13_35.toml"].map(pair);
    // Flanks close to undercut are less exact as patches.
    let tolerance = |pair: &Pair| match pair.blank.data.teeth[0] {
        11 => 5e-7,
        _ => 1e-8,
    };
    for pair in files.into_iter().chain(HARD.iter().map(HardPair::pair)) {
        let name = pair.blank.data.teeth;
        for errors in [AS_DESIGNED, little] {
            let error = assembly(errors);
            for side in Flank::ALL {
                let hand = pair.blank.members[0].hand;
                let facing = -side.mirror();
                let own = FlankSide::BOTH
                    .into_iter()
                    .find(|s| s.facing(hand) == facing);
                let request = TcaRequest {
                    error,
                    per_pitch: 4 * POSITIONS,
                    ..TcaRequest::default()
                };
                let flanks = pair.design.flanks(own.unwrap());
                let expected = tooth_contact(flanks, &pair.blank, &request).unwrap();
                let pitch = std::f64::consts::TAU / pair.blank.data.teeth[0] as f64;
                let ratio = pair.blank.data.teeth[0] as f64 / pair.blank.data.teeth[1] as f64;
                // There turn 0 has the mean points of both flanks in the plane of the axes.
                let azimuths = [0, 1].map(|m: usize| {
                    let side = own.unwrap();
                    let side = if m == 0 { side } else { side.mate() };
                    pair.design.teeth[m].half_angle_rad(side)
                });
                // Ahead of constant ratio in the driven sense.
                let lead: Vec<f64> = (0..POSITIONS)
                    .map(|i| {
                        let turn_1 = i as f64 * pitch / POSITIONS as f64;
                        let turn_2 =
                            pair.turn_2(&error, turn_1 - azimuths[0], side, 0.0) + azimuths[1];
                        -facing * (turn_2 + ratio * turn_1)
                    })
                    .collect();
                let pitch_2 = std::f64::consts::TAU / pair.blank.data.teeth[1] as f64;
                let wrapped: Vec<f64> = lead
                    .iter()
                    .map(|x| x - pitch_2 * (x / pitch_2).round())
                    .collect();
                let most = wrapped.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                // Its largest is that of all its positions.
                let of_positions: Vec<f64> =
                    expected.error_rad.iter().copied().step_by(4).collect();
                let largest = of_positions
                    .iter()
                    .copied()
                    .fold(f64::NEG_INFINITY, f64::max);
                for (i, (found, expected)) in wrapped.iter().zip(&of_positions).enumerate() {
                    let off = found - most - (expected - largest);
                    assert!(
                        off.abs() < tolerance(&pair),
                        "{name:?} {errors:?} {side:?} {i}: {off:e} rad of {expected:e}"
                    );
                }
            }
        }
    }
}

/// Poses at which a side is pressed together or nearly so, misaligned ones too.
pub(crate) fn poses(pair: &Pair, depth_m: f64) -> Vec<Pose> {
    let mut list = Vec::new();
    let pitch = std::f64::consts::TAU / pair.blank.data.teeth[0] as f64;
    for (number, errors) in [&[AS_DESIGNED][..], &MISALIGNED[..]]
        .concat()
        .into_iter()
        .enumerate()
    {
        for (k, side) in [(0.1, Flank::Left), (0.45, Flank::Right), (0.8, Flank::Left)] {
            let error = assembly(errors);
            let turn_1 = (k + 0.07 * number as f64) * pitch;
            let turn_2 = pair.turn_2(&error, turn_1, side, -depth_m);
            list.push(pair.pose(&error, [turn_1, turn_2]));
        }
    }
    list
}

#[test]
fn bevel_flanks_conform() {
    let pair = pair("bevel_20_20.toml");
    let poses = poses(&pair, 12e-6);
    let mut undamped = GearMesh::of_flanks(
        Box::new(pair.mesh.clone()),
        Flank::Right,
        Impact::new(
            PowerStiffness::n_per_mm_e(7.2e5, 1.5).unwrap(),
            0.0,
            1e-6,
            1,
        )
        .unwrap(),
    )
    .unwrap();
    let right: Vec<Pose> = poses
        .iter()
        .copied()
        .filter(|pose| pair.gap_m(pose, Flank::Right) < 0.0)
        .collect();
    assert!(right.len() >= 4);
    check_energy("bevel", &mut undamped, &right);
    for (rubs, tolerance) in [(false, 2e-3), (true, 5e-3)] {
        let mut mesh = pair.mesh();
        if rubs {
            mesh = mesh.with_friction(friction());
        }
        let what = format!("bevel, friction {rubs}");
        check_power(("impact", DAMPINGS[0]), &mut mesh, &poses);
        check_reaction(&what, &mut mesh, &poses);
        check_tangents((&what, tolerance), &mut mesh, &poses);
        check_turned(&what, &mut mesh, &poses);
    }
}

/// Gaps have their gradients and second derivatives, wherever flanks, edges or corners touch.
#[test]
fn derivatives_of_bevel_gaps_agree_with_differences() {
    let pair = pair("bevel_20_20.toml");
    let mut mesh = pair.mesh.clone();
    for (number, pose) in poses(&pair, 5e-6).iter().enumerate() {
        for side in Flank::ALL {
            mesh.locate(pose).unwrap();
            let mut here = FlankContacts::default();
            mesh.contacts(pose, side, &mut here);
            let (h, mut there) = (1e-7, [FlankContacts::default(), FlankContacts::default()]);
            for direction in 0..6 {
                let mut step = Vector6::zeros();
                step[direction] = h;
                for (sign, found) in [1.0, -1.0].into_iter().zip(&mut there) {
                    mesh.contacts_at(&moved(pose, &(sign * step)), side, found)
                        .unwrap();
                }
                for (i, contact) in here.contacts.iter().enumerate() {
                    let of = |found: &FlankContacts| {
                        let teeth = here.lines[contact.line].teeth;
                        let line = found.lines.iter().find(|line| line.teeth == teeth);
                        line.map(|line| found.contacts[line.contacts.0])
                    };
                    let [Some(a), Some(b)] = [0, 1].map(|k: usize| of(&there[k])) else {
                        continue;
                    };
                    let slope = (a.gap_m - b.gap_m) / (2.0 * h);
                    let off = slope - contact.gradient[direction];
                    assert!(
                        off.abs() < 2e-7,
                        "{number} {side:?} {i} by {direction}: {off:e}"
                    );
                    let change = (a.gradient - b.gradient) / (2.0 * h);
                    let curvature = mesh.gap_curvature(&here, i, side);
                    let off = (change - curvature.column(direction)).norm() / curvature.norm();
                    assert!(
                        off < 1e-4,
                        "{number} {side:?} {i} by {direction}: {off:e} of {:e}",
                        curvature.norm()
                    );
                }
            }
        }
    }
}

/// Points of flanks that are computed at a pose, both sides of the teeth together.
#[test]
fn a_pose_of_a_bevel_pair_takes_few_points() {
    for (name, most) in [
        ("bevel_20_20.toml", 90.0),
        ("bevel_13_35.toml", 130.0),
        ("bevel_31_36.toml", 130.0),
    ] {
        let pair = pair(name);
        let pitch = std::f64::consts::TAU / pair.blank.data.teeth[0] as f64;
        let ratio = pair.blank.data.teeth[0] as f64 / pair.blank.data.teeth[1] as f64;
        let error = assembly([10e-6, -20e-6, 30e-6, 1e-4]);
        let back = pair.turn_2(&error, 0.0, Flank::Right, -20e-6);
        let (poses, before) = (200, pair.mesh.computed_points());
        for i in 0..poses {
            let turn = 2.0 * pitch * f64::from(i) / f64::from(poses);
            let pose = pair.pose(&error, [turn, back - ratio * turn]);
            for side in Flank::ALL {
                let mut found = FlankContacts::default();
                pair.mesh.contacts_at(&pose, side, &mut found).unwrap();
            }
        }
        let mean = (pair.mesh.computed_points() - before) as f64 / f64::from(poses);
        assert!(mean < most, "{name}: {mean} points a pose");
    }
}

/// A pair whose law follows Hertz, undamped.
fn hertz_mesh(pair: &Pair) -> GearMesh {
    let law = |side: Flank| {
        let k = pair.mesh.hertz_stiffness(side, steel_pa());
        let stiffness = PowerStiffness::n_per_m_e(k, 1.5).unwrap();
        Impact::new(stiffness, 0.0, 1e-6, 1).unwrap()
    };
    let kinematics = pair.mesh.clone().with_hertz();
    let mesh = GearMesh::of_flanks(Box::new(kinematics), Flank::Right, law(Flank::Right)).unwrap();
    mesh.with_side(Flank::Left, law(Flank::Left)).unwrap()
}

pub(crate) fn steel_pa() -> f64 {
    contact_modulus_pa((206e9, 0.3), (206e9, 0.3))
}

/// K of contacts after Hertz is that of the curvatures which the exact surfaces have in the tooth contact analysis: F =
/// K δ^1.5 there, and it differs along the path.
#[test]
fn bevel_contacts_have_the_stiffness_of_their_curvatures() {
    let pair = pair("bevel_13_35.toml");
    let mut mesh = hertz_mesh(&pair);
    let side = Flank::Left;
    let hand = pair.blank.members[0].hand;
    let own = FlankSide::BOTH
        .into_iter()
        .find(|own| own.facing(hand) == -side.mirror())
        .unwrap();
    let flanks = pair.design.flanks(own);
    let path = tooth_contact(flanks, &pair.blank, &TcaRequest::default())
        .unwrap()
        .path;
    let own = [own, own.mate()];
    let azimuths = [0, 1].map(|m: usize| pair.design.teeth[m].half_angle_rad(own[m]));
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    for point in path.iter().filter(|p| p.kind == ContactKind::Flanks) {
        let turns = [point.touch.pinion_turn_rad, point.touch.gear_turn_rad];
        let turns = [0, 1].map(|m: usize| turns[m] - azimuths[m]);
        // Deeper by a nanometre, for the curvatures are those of the contact without load.
        let depth = 1e-9;
        let lever = pair.mesh.levers_m()[1] * side.mirror();
        let pose = pair.pose(&assembly(AS_DESIGNED), [turns[0], turns[1] - depth / lever]);
        mesh.evaluate(&pose, false).unwrap();
        let (found, forces) = mesh.side(side).unwrap();
        let touching = found
            .lines
            .iter()
            .position(|line| line.teeth == [0, 0])
            .unwrap();
        let (gap, force) = (found.contacts[touching].gap_m, forces[touching]);
        let [small, large] = point.ellipse.unwrap().curvatures_per_m;
        let expected = PointContact::new(small + large, large - small, steel_pa());
        let k = force / (-gap).powf(1.5);
        let off = k / expected.stiffness_n_per_m15 - 1.0;
        assert!(
            off.abs() < 1e-4,
            "{off:e} of {:e}",
            expected.stiffness_n_per_m15
        );
        (least, most) = (least.min(k), most.max(k));
    }
    assert!(
        most > 1.02 * least && most < 5.0 * least,
        "{least:e} {most:e}"
    );
}

/// A contact whose stiffness changes on its way keeps the energy, and its forces are those of it.
#[test]
fn bevel_contacts_after_hertz_keep_their_energy() {
    let pair = pair("bevel_20_20.toml");
    let poses = poses(&pair, 12e-6);
    let mut mesh = hertz_mesh(&pair);
    check_energy("bevel, hertz", &mut mesh, &poses);
    check_reaction("bevel, hertz", &mut mesh, &poses);
    // What the tangent leaves out, the change of K, is 1 % where an error of assembly makes the contact run fastest.
    check_tangents(("bevel, hertz", 2e-2), &mut mesh, &poses);
}
