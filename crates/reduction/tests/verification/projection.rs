//! Points of a flank on the faces of its elements: how far off, how many steps, and that the loads of the flank grid
//! are means of them.

use crate::small_gears::{MESH, QUADRATIC, SOLID, TETRAHEDRA, body, gear};
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve};
use gearmesh_reduction::GearBody;
use gearmesh_reduction::flank_loads::{SparseVector, flank_grid, flank_loads};
use gearmesh_reduction::projected_flank::ProjectedFlank;
use std::collections::BTreeMap;

const SIDES: [Flank; 2] = [Flank::Right, Flank::Left];

fn flank<'a>(gear: &'a GearDefinition, body: &GearBody, of: (usize, Flank)) -> ProjectedFlank<'a> {
    ProjectedFlank::new(gear, &body.mesh, body.model.nodes(), of)
}

/// Σ w p over points p in the middles of small cells of equal steps of roll angle and height, w the hat there times the
/// flank's area, ξ dξ dz up to a factor; one newton in all.
fn mean_over_hat(
    flank: &ProjectedFlank<'_>,
    stations: [&[f64]; 2],
    number: [usize; 2],
    cells: usize,
) -> SparseVector {
    let values = |axis: usize| -> Vec<(f64, f64)> {
        let (at, k) = (stations[axis], number[axis]);
        let beside = [k.checked_sub(1), Some(k + 1).filter(|&k| k < at.len())];
        let of_side = beside.into_iter().flatten().flat_map(|side| {
            (0..cells).map(move |cell| {
                let hat = (cell as f64 + 0.5) / cells as f64;
                (at[side] + hat * (at[k] - at[side]), hat)
            })
        });
        of_side.collect()
    };
    let (mut sum, mut nodal) = (0.0, BTreeMap::new());
    for (roll, up) in values(0) {
        for (z, along) in values(1) {
            let weight = up * along * roll;
            sum += weight;
            for (dof, value) in flank.point(roll, z).unwrap().normal {
                *nodal.entry(dof).or_insert(0.0) += weight * value;
            }
        }
    }
    nodal
        .into_iter()
        .map(|(dof, value)| (dof, value / sum))
        .collect()
}

fn largest_difference(a: &SparseVector, b: &SparseVector) -> f64 {
    let (mut all, mut most) = (BTreeMap::new(), 0.0_f64);
    for &(dof, value) in a {
        *all.entry(dof).or_insert(0.0) += value;
        most = most.max(value.abs());
    }
    for &(dof, value) in b {
        *all.entry(dof).or_insert(0.0) -= value;
    }
    all.values().fold(0.0_f64, |most, off| most.max(off.abs())) / most
}

/// A load of the grid is the mean of projected points over its hat: two integrations of different kind, the one on the
/// unrolled outline, where natural coordinates go by arc lengths, the other in space by Newton's method. The two
/// natural coordinates of a point differ by up to α²/8 of a face that turns by 2α, of a quadrilateral some 0.5 % with
/// these coarse elements low on the flank (α 0.2); the cells leave as little.
#[test]
fn loads_of_the_grid_are_means_of_points() {
    for (mesh, helix_deg) in [
        (MESH, 0.0),
        (MESH, 24.0),
        (QUADRATIC, -10.0),
        (TETRAHEDRA, 0.0),
    ] {
        let gear = gear(mesh, SOLID, helix_deg);
        let (body, grid) = (body(&gear), flank_grid(&gear));
        let stations = [&grid.roll_angles_rad[..], &grid.z_m[..]];
        for side in SIDES {
            let loads = flank_loads(&gear, &body.mesh, &grid, 0, side);
            let flank = flank(&gear, &body, (0, side));
            let mut most = 0.0_f64;
            for number in [[0, 0], [1, 2], [2, 1], [3, 4]] {
                let mean = mean_over_hat(&flank, stations, number, 24);
                let of_grid = &loads[grid.load(number[0], number[1])].normal;
                most = most.max(largest_difference(of_grid, &mean));
            }
            println!("{side} flank, helix {helix_deg} deg: {most:.1e} of the largest nodal force");
            assert!(most < 0.01, "{most}");
        }
    }
}

/// Points of the whole flank, its edges included, are found in few steps; as far off as a face's chord is from an
/// involute of radius of curvature ρ, l²/(8ρ), and beside an edge by no more than a helix is.
#[test]
fn points_lie_as_near_as_chords() {
    for (mesh, helix_deg) in [
        (MESH, 0.0),
        (MESH, 24.0),
        (QUADRATIC, 24.0),
        (TETRAHEDRA, 0.0),
    ] {
        let gear = gear(mesh, SOLID, helix_deg);
        let body = body(&gear);
        let profile = &gear.profile;
        let (curve, grid) = (ProfileCurve::new(profile), flank_grid(&gear));
        let [low, high] = profile.flank_rolls_rad();
        for (tooth, side) in [(0, Flank::Right), (5, Flank::Left)] {
            let flank = flank(&gear, &body, (tooth, side));
            let ends = [curve.flank_start_m(), curve.flank_end_m()];
            let faces = body.mesh.outline_faces(tooth, side, ends);
            let extent = |axis: usize| {
                let ranges = faces.iter().map(|face| face.range_m(axis));
                ranges.map(|r| r[1] - r[0]).fold(0.0, f64::max)
            };
            let (up, along) = (extent(0), extent(1));
            let twist = profile.twist_rad_per_m() * along;
            let helix = profile.tip_radius_m * twist * twist / 8.0;
            for i in 0..=20 {
                let roll = low + (high - low) * f64::from(i) / 20.0;
                // The smallest radius of curvature under a face is that at its lower end.
                let curvature_m = profile.base_radius_m * profile.roll_from_rad(roll, -up).max(low);
                for z in &grid.z_m {
                    let found = flank.project(roll, *z).unwrap();
                    assert!(found.steps <= 5, "{found:?}");
                    let chord = up * up / (8.0 * curvature_m) + helix;
                    assert!(found.distance_m.abs() < 1.01 * chord, "{found:?} {chord}");
                    assert!(found.beside_m < 1.01 * helix + 1e-8, "{found:?} {helix}");
                }
            }
            // Beside the face of the gear, and beyond the tip.
            let half = 0.5 * gear.tooth.face_width_m;
            for (roll, z) in [
                (high, 1.2 * half),
                (1.1 * high, 0.0),
                (0.5 * high, f64::NAN),
            ] {
                let refused = flank.project(roll, z).unwrap_err().to_string();
                assert!(refused.contains("no element face lies under"), "{refused}");
            }
        }
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// A line over a stretch has the force and the moments of the true flank's normals, whatever elements it crosses; one
/// at a single roll angle is the sum of its parts. On spur teeth a force moves along its own line: moments are exact
/// but for the sum that they are compared with. On helical teeth its axial part moves by the distance to the face, at
/// most a chord's, 0.1 mm here.
#[test]
fn lines_keep_force_and_moment() {
    for (helix_deg, moved_m) in [(0.0, 0.0), (24.0, 1e-4)] {
        let gear = gear(MESH, SOLID, helix_deg);
        let body = body(&gear);
        let (side, profile) = (Flank::Right, &gear.profile);
        let flank = flank(&gear, &body, (0, side));
        let [low, high] = profile.flank_rolls_rad();
        let (from, to) = (-4.3e-3, 3.1e-3);
        // A slanted line, as a contact line of helical teeth is.
        let slope = profile.base_helix_angle_rad().tan() / profile.base_radius_m;
        let roll = |z: f64| 0.4 * low + 0.6 * high + slope * z;
        let whole = flank.line([from, to], roll).unwrap().normal;
        let (mut found, mut expected) = ([0.0; 6], [0.0; 6]);
        for &(dof, value) in &whole {
            let mut force = [0.0; 3];
            force[dof % 3] = value;
            let turns = cross(body.model.nodes()[dof / 3], force);
            (0..3).for_each(|k| {
                (found[k], found[3 + k]) = (found[k] + force[k], found[3 + k] + turns[k])
            });
        }
        let parts = 2000;
        for k in 0..parts {
            let z = from + (to - from) * (f64::from(k) + 0.5) / f64::from(parts);
            let (sin, cos) = (profile.twist_rad_per_m() * z).sin_cos();
            let turn = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
            let [x, y] = turn(profile.flank_point_m(side, roll(z)));
            let [n_x, n_y, n_z] = profile.flank_normal(side, roll(z));
            let [n_x, n_y] = turn([n_x, n_y]);
            let (force, turns) = ([n_x, n_y, n_z], cross([x, y, z], [n_x, n_y, n_z]));
            for k in 0..3 {
                expected[k] += force[k] / f64::from(parts);
                expected[3 + k] += turns[k] / f64::from(parts);
            }
        }
        let (_, axial) = profile.base_helix_angle_rad().sin_cos();
        let axial = (1.0 - axial * axial).sqrt();
        for k in 0..6 {
            // A moment is at most that of the tip radius.
            let size = if k < 3 { 1.0 } else { profile.tip_radius_m };
            let moved = if k < 3 { 0.0 } else { axial * moved_m };
            let off = (found[k] - expected[k]).abs();
            assert!(off < 1e-7 * size + moved, "{helix_deg} {k}: {off:e}");
        }
        let cut = 0.4e-3;
        let halves = [[from, cut], [cut, to]].map(|z| (z, flank.line(z, |_| high).unwrap().normal));
        let sum: SparseVector = halves
            .iter()
            .flat_map(|(z, part)| {
                let share = (z[1] - z[0]) / (to - from);
                part.iter().map(move |&(dof, p)| (dof, share * p))
            })
            .collect();
        let whole = flank.line([from, to], |_| high).unwrap().normal;
        assert!(largest_difference(&whole, &sum) < 1e-6);
    }
}
