//! Bevel flanks as triangles and quadrilaterals: the force does not depend on how fine they are, and the suite of all
//! families holds.

use gearmesh_drivetrain::flank_contacts::FlankContacts;
use gearmesh_drivetrain::*;
use gearmesh_geometry::Flank;

use crate::conformance::bevel_pair::{AS_DESIGNED, Pair, assembly, pair, poses};
use crate::conformance::energy::{check_energy, check_power};
use crate::conformance::two_bodies::{check_reaction, check_tangents, check_turned};
use crate::conformance::{DAMPINGS, friction};

const KINDS: [FacetKind; 2] = [FacetKind::Triangles, FacetKind::Quadrilaterals];

/// Edges up the flank and four times as long along the face.
fn facets(pair: &Pair, kind: FacetKind, up_m: f64) -> BevelMesh {
    let size = FacetSize {
        kind,
        along_m: 4.0 * up_m,
        up_m,
    };
    pair.mesh.clone().with_facets(size).unwrap()
}

fn approach_m(mesh: &BevelMesh, pose: &Pose) -> f64 {
    let mut found = FlankContacts::default();
    mesh.contacts_at(pose, Flank::Right, &mut found).unwrap();
    -found.contacts[0].gap_m
}

/// Approaches of facets with halved edges, over that of the smooth flanks, less 1: the worst of four places inside the
/// flanks.
fn off_smooth<const N: usize>(pair: &Pair, meshes: &[BevelMesh; N], depth_m: f64) -> [f64; N] {
    let pitch = std::f64::consts::TAU / 20.0;
    let error = assembly(AS_DESIGNED);
    let mut off = [0.0f64; N];
    for share in [-0.15, -0.05, 0.02, 0.1] {
        let turn_1 = share * pitch - pair.mesh.azimuths_rad(Flank::Right)[0];
        let turn_2 = pair.turn_2(&error, turn_1, Flank::Right, -depth_m);
        let pose = pair.pose(&error, [turn_1, turn_2]);
        let smooth = approach_m(&pair.mesh, &pose);
        for (off, mesh) in off.iter_mut().zip(meshes) {
            let own = approach_m(mesh, &pose) / smooth - 1.0;
            *off = if own.abs() > off.abs() { own } else { *off };
        }
    }
    off
}

/// The approach settles with the square of the edges, to that of a paraboloid as far as the flanks are one: the rest
/// grows with the depth.
#[test]
fn the_approach_of_facets_does_not_depend_on_their_number() {
    let pair = pair("bevel_20_20.toml");
    for kind in KINDS {
        let meshes = [200e-6, 100e-6, 50e-6].map(|up_m| facets(&pair, kind, up_m));
        let [coarse, middle, fine] = off_smooth(&pair, &meshes, 15e-6);
        let changes = [(middle - coarse).abs(), (fine - middle).abs()];
        assert!(
            changes[0] < 1e-3 && changes[1] < changes[0] / 3.0,
            "{kind:?} {changes:?}"
        );
        let [shallow] = off_smooth(&pair, &[meshes[2].clone()], 5e-6);
        assert!(
            fine.abs() < 4e-3 && shallow.abs() < 0.5 * fine.abs(),
            "{kind:?} {fine:e} {shallow:e}"
        );
    }
}

#[test]
fn bevel_facets_conform() {
    let pair = pair("bevel_20_20.toml");
    let poses: Vec<Pose> = poses(&pair, 12e-6).into_iter().step_by(2).collect();
    for kind in KINDS {
        let law = |damping| {
            let stiffness = PowerStiffness::n_per_mm_e(7.2e5, 1.5).unwrap();
            Impact::new(stiffness, damping, 2e-6, 1).unwrap()
        };
        let mesh = |damping| {
            let flanks = Box::new(facets(&pair, kind, 250e-6));
            let mesh = GearMesh::of_flanks(flanks, Flank::Right, law(damping)).unwrap();
            mesh.with_side(Flank::Left, law(damping)).unwrap()
        };
        let what = format!("facets {kind:?}");
        check_energy(&what, &mut mesh(0.0), &poses);
        let mut mesh = mesh(2e3).with_friction(friction());
        check_tangents((&what, 2e-2), &mut mesh, &poses);
        if kind == FacetKind::Triangles {
            check_power(("impact", DAMPINGS[0]), &mut mesh, &poses);
            check_reaction(&what, &mut mesh, &poses);
            check_turned(&what, &mut mesh, &poses);
        }
    }
}

#[test]
fn facets_that_do_not_divide_a_flank_are_refused() {
    let pair = pair("bevel_20_20.toml");
    for (along_m, up_m, what) in [
        (4e-3, 1e-4, "along the face"),
        (4e-4, 2e-3, "up the flank"),
        (-1e-4, 1e-4, "along the face"),
        (4e-4, f64::NAN, "up the flank"),
        (1e-6, 1e-6, "along the face"),
    ] {
        let size = FacetSize {
            kind: FacetKind::Triangles,
            along_m,
            up_m,
        };
        let complaint = pair.mesh.clone().with_facets(size).unwrap_err().to_string();
        assert!(
            complaint.contains(what) && complaint.contains("at most an eighth"),
            "{complaint}"
        );
    }
}
