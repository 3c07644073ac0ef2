//! The cyclic solution against one factorisation of the whole gear: compliance, gauge rows, fields, effort.

use crate::small_gears::{
    self, COARSE, CONTOUR, FILLETED, MESH, QUADRATIC, SLOTS, SOLID, TETRAHEDRA, THIN_RIM, body,
    difference, reduced, without_symmetry,
};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearDefinition, Symmetry};
use gearmesh_model::ReducedGear;
use gearmesh_reduction::field::{GridForce, fields};
use gearmesh_reduction::flank_loads::{flank_grid, flank_loads};
use gearmesh_reduction::tooth_vectors::on_tooth;

/// Agreement demanded of the two ways: rounding alone.
const AGREEMENT: f64 = 1e-9;

/// A gear with a gauge on the first sector and one elsewhere.
fn gear(mesh: &str, blank: &str) -> GearDefinition {
    small_gears::with_gauges(mesh, blank, 0.0, &[(0, "right"), (7, "left")])
}

/// Reduces a gear both ways and compares everything; `factorisations` of the cyclic way are tooth, sector, harmonics.
fn both_ways_agree(
    (mesh, blank): (&str, &str),
    sectors: usize,
    factorisations: usize,
    estimate_error: bool,
) {
    let gear = gear(mesh, blank);
    let (cyclic, body) = reduced(&gear, estimate_error);
    let (whole, whole_body) = reduced(&without_symmetry(&gear), estimate_error);
    assert_eq!(gear.sectors(), sectors);
    let effort = |model: &ReducedGear, name: &str| {
        let counts = &model.provenance.effort;
        counts.iter().find(|(n, _)| n == name).unwrap().1 as usize
    };
    assert_eq!(effort(&cyclic, "factorisations"), factorisations);
    assert_eq!(effort(&whole, "factorisations"), 1);
    // One per load of a sector's teeth, two sums of patterns, two of rows, and the gauges; the same with and without
    // symmetry.
    let loads = 18 / sectors * 2 * whole.grid.len();
    for model in [&cyclic, &whole] {
        assert_eq!(effort(model, "right-hand sides"), loads + 2 + 2 + 2);
    }
    assert_eq!(body.mesh.nodes, whole_body.mesh.nodes);

    let c_hub = difference(&whole.c_hub, &cyclic.c_hub);
    assert!(c_hub < AGREEMENT, "C_hub {c_hub:.1e}");
    assert_eq!(whole.c_tooth, cyclic.c_tooth);
    for (a, b) in whole.gauges.iter().zip(&cyclic.gauges) {
        let adjoint = difference(&a.adjoint, &b.adjoint);
        assert!(adjoint < AGREEMENT, "{}: {adjoint:.1e}", a.name);
        let own = difference(&a.own_tooth, &b.own_tooth);
        assert!(own < AGREEMENT, "{}: own tooth {own:.1e}", a.name);
        let errors = (a.error_estimate_relative, b.error_estimate_relative);
        assert!((errors.0 - errors.1).abs() <= 1e-6 * errors.0, "{errors:?}");
    }
    for ((name, a), (_, b)) in whole.checks.further.iter().zip(&cyclic.checks.further) {
        let same = (a - b).abs() < 1e-6 * a.abs();
        assert!(same || a.max(*b) < AGREEMENT, "{name}: {a} {b}");
    }

    // Fields of loads on teeth of different sectors at once, normal and tangential.
    let force = |tooth, side, load, normal_n, tangential_n| GridForce {
        tooth,
        side,
        load,
        normal_n,
        tangential_n,
    };
    let cases = [
        vec![
            force(17, Flank::Right, 3, 100.0, 20.0),
            force(0, Flank::Right, 9, 250.0, -10.0),
            force(9, Flank::Left, 0, 70.0, 0.0),
        ],
        vec![force(5, Flank::Left, 12, 1.0, 0.0)],
    ];
    let there = fields(&gear, &body, &cases).unwrap();
    let here = fields(&gear, &whole_body, &cases).unwrap();
    for (a, b) in here.iter().zip(&there) {
        let (a_u, b_u) = (
            a.displacement_m.as_flattened(),
            b.displacement_m.as_flattened(),
        );
        let displacement = difference(a_u, b_u);
        assert!(displacement < AGREEMENT, "displacement {displacement:.1e}");
        let stress = difference(&a.von_mises_pa, &b.von_mises_pa);
        assert!(stress < 1e-8, "stress {stress:.1e}");
    }
}

#[test]
fn thin_rim_one_tooth_a_sector() {
    both_ways_agree((COARSE, THIN_RIM), 18, 2 + 10, false);
}

#[test]
fn a_contour_moves_the_layers() {
    both_ways_agree((COARSE, CONTOUR), 18, 2 + 10, false);
}

#[test]
fn solid_blank() {
    both_ways_agree((COARSE, SOLID), 18, 2 + 10, false);
}

#[test]
fn slots_with_several_teeth_a_sector() {
    // The estimate takes a mesh with elements longer by a half.
    let mesh = "flank_mm = 1.6\nfillet_mm = 0.8\nbody_mm = 4.0\naxial_mm = 6.0\n";
    both_ways_agree((mesh, &format!("{THIN_RIM}{SLOTS}")), 3, 2 + 2, true);
}

/// With six teeth a sector: in `helical.rs`.
#[test]
fn quadratic_elements() {
    both_ways_agree((QUADRATIC, THIN_RIM), 18, 2 + 10, false);
}

#[test]
fn tetrahedra_below_one_tooth() {
    both_ways_agree((TETRAHEDRA, SOLID), 18, 2 + 10, false);
}

#[test]
#[ignore = "a whole gear of tetrahedra, seconds"]
fn tetrahedra_with_fillets_and_openings() {
    // A turn has at least twelve elements: wide fillets, few elements.
    let wide = |text: &str, radius: &str| {
        text.replace(
            &format!("fillet_radius_mm = {radius} }}"),
            "fillet_radius_mm = 2.5 }",
        )
    };
    let filleted = wide(&wide(FILLETED, "1.5"), "2.0");
    assert_eq!(filleted.matches("fillet_radius_mm = 2.5").count(), 2);
    let blank = format!(
        "{filleted}holes = {{ count = 9, pitch_circle_diameter_mm = 29.0, diameter_mm = 2.4, phase_deg = 11.0 }}\n"
    );
    both_ways_agree((TETRAHEDRA, &blank), 9, 2 + 5, false);
}

#[test]
fn drilled_with_two_teeth_a_sector_and_a_turned_pattern() {
    let holes = "holes = { count = 9, pitch_circle_diameter_mm = 29.0, diameter_mm = 3.5, phase_deg = 11.0 }\n";
    both_ways_agree((COARSE, &format!("{THIN_RIM}{holes}")), 9, 2 + 5, false);
}

#[test]
fn two_sectors_share_both_their_cuts() {
    let holes = "holes = { count = 4, pitch_circle_diameter_mm = 29.0, diameter_mm = 4.0, phase_deg = 30.0 }\n";
    both_ways_agree((COARSE, &format!("{THIN_RIM}{holes}")), 2, 2 + 2, false);
}

#[test]
fn no_repetition_leaves_one_sector_without_cuts() {
    let holes = "holes = { count = 5, pitch_circle_diameter_mm = 29.0, diameter_mm = 4.0, phase_deg = 7.0 }\n";
    // Tooth, body, and ten harmonics of the ring of eighteen teeth.
    both_ways_agree((COARSE, &format!("{THIN_RIM}{holes}")), 1, 12, false);
}

#[test]
fn symmetry_is_used_unless_it_is_switched_off() {
    let small = gear(MESH, THIN_RIM).source;
    let text = |line: &str| small.replace("slices = 2", line);
    let read = |line| GearDefinition::from_document(&InputDocument::new("small.toml", text(line)));
    let symmetry = |line| read(line).unwrap().reduction.symmetry;
    assert_eq!(symmetry("slices = 2"), Symmetry::Auto);
    assert_eq!(symmetry("symmetry = \"auto\""), Symmetry::Auto);
    assert_eq!(symmetry("symmetry = \"off\""), Symmetry::Off);
    let refused = read("symmetry = \"on\"").unwrap_err().to_string();
    assert!(
        refused.contains("auto") && refused.contains("off"),
        "{refused}"
    );
}

/// Loads of tooth 0 turned to another tooth are the loads integrated there.
#[test]
fn turned_loads_are_those_of_the_other_tooth() {
    for mesh in [MESH, QUADRATIC] {
        turned_loads(&gear(mesh, THIN_RIM));
    }
}

fn turned_loads(gear: &GearDefinition) {
    let body = body(gear);
    let grid = flank_grid(gear);
    for side in [Flank::Right, Flank::Left] {
        let here = flank_loads(gear, &body.mesh, &grid, 0, side);
        let there = flank_loads(gear, &body.mesh, &grid, 11, side);
        for (a, b) in here.iter().zip(&there) {
            for (from, to) in [
                (&a.normal, &b.normal),
                (&a.tangential, &b.tangential),
                (&a.axial, &b.axial),
            ] {
                let turned = on_tooth(&body.mesh, from, 11);
                let dofs = |v: &[(usize, f64)]| v.iter().map(|e| e.0).collect::<Vec<_>>();
                assert_eq!(dofs(&turned), dofs(to));
                assert!(
                    turned
                        .iter()
                        .zip(to)
                        .all(|(a, b)| (a.1 - b.1).abs() < 1e-13)
                );
            }
        }
    }
}
