//! What holds for the mesh of any gear: spur or helical, undercut or shifted, with a chamfer, solid or drilled.

use crate::helical::{section_area, volume};
use crate::property_cases::cases;
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_mesh::{GearMesh, MeshError};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// Numbers of a gear; lengths in modules, element lengths as those of `Gear::text`.
#[derive(Debug, Clone)]
struct Gear {
    teeth: usize,
    module_mm: f64,
    profile_shift: f64,
    helix_deg: f64,
    chamfer: f64,
    width: f64,
    bore_share: f64,
    holes: Option<(usize, f64)>,
}

fn gears() -> impl Strategy<Value = Gear> {
    let tooth = (
        12usize..36,
        0.5f64..8.0,
        0.0f64..0.5,
        prop_oneof![Just(0.0), -28.0f64..28.0],
    );
    let body = (
        prop_oneof![Just(0.0), 0.04f64..0.12],
        4.0f64..9.0,
        0.2f64..0.5,
        0usize..5,
        0.0f64..360.0,
    );
    (tooth, body).prop_map(|(tooth, body)| Gear {
        teeth: tooth.0,
        module_mm: tooth.1,
        profile_shift: tooth.2,
        helix_deg: tooth.3,
        chamfer: body.0,
        width: body.1,
        bore_share: body.2,
        // Holes below a helix shear the elements above them; spur gears only.
        holes: (tooth.3 == 0.0 && tooth.0 > 25 && body.3 > 1).then_some((body.3, body.4)),
    })
}

impl Gear {
    /// The gear file with all element lengths times `length`.
    fn text(&self, length: f64) -> String {
        let m = self.module_mm;
        let root = m * (self.teeth as f64 - 2.5);
        let hand = if self.helix_deg > 0.0 {
            "right"
        } else {
            "left"
        };
        let helix = match self.helix_deg == 0.0 {
            true => String::new(),
            false => format!(
                "helix_angle_deg = {}\nhand = \"{hand}\"\n",
                self.helix_deg.abs()
            ),
        };
        let holes = self.holes.map_or_else(String::new, |(count, phase_deg)| {
            let (circle, hole) = (0.55 * root, 0.12 * root);
            format!(
                "[blank.holes]\ncount = {count}\npitch_circle_diameter_mm = {circle}\ndiameter_mm = {hole}\n\
                 phase_deg = {phase_deg}\n"
            )
        });
        let bore = if self.holes.is_some() {
            0.2
        } else {
            self.bore_share
        } * root;
        format!(
            "name = \"any\"\n[material]\nyoung_GPa = 210.0\npoisson = 0.3\n[tooth]\nteeth = {}\nmodule_mm = {m}\n\
             profile_shift = {}\ntip_chamfer_mm = {}\nface_width_mm = {}\n{helix}[blank]\nkind = \"solid\"\n\
             bore_diameter_mm = {bore}\n{holes}[mesh]\nmin_scaled_jacobian = 0.05\nflank_mm = {}\nfillet_mm = {}\n\
             body_mm = {}\naxial_mm = {}\n",
            self.teeth,
            self.profile_shift,
            self.chamfer * m,
            self.width * m,
            0.5 * length * m,
            0.22 * length * m,
            1.2 * length * m,
            length * m,
        )
    }

    /// None for gears that cannot be, and for meshes that the quality check refuses.
    fn mesh(&self, length: f64) -> Option<(GearDefinition, GearMesh)> {
        let document = InputDocument::new("any.toml", self.text(length));
        let gear = GearDefinition::from_document(&document).ok()?;
        match GearMesh::new(&gear, &PythonEnvironment::find().unwrap()) {
            Ok(mesh) => Some((gear, mesh)),
            Err(MeshError::Quality { .. } | MeshError::NoCut { .. }) => None,
            Err(e) => panic!("{e}"),
        }
    }
}

/// Area of the section \[m²\]: teeth by the outline's polygon of `points` a half tooth, bore and holes as circles.
fn exact_area(gear: &GearDefinition, points: u32) -> f64 {
    let curve = ProfileCurve::new(&gear.profile);
    let at = |k: u32| curve.point_at(curve.length_m() * f64::from(k) / f64::from(points));
    let half: f64 = (0..points)
        .map(|k| (at(k), at(k + 1)))
        .map(|(p, q)| 0.5 * (p[0] * q[1] - p[1] * q[0]))
        .sum();
    let openings = gear.blank.openings().map_or(0.0, |o| {
        let (inner, outer) = o.radii_m();
        o.count() as f64 * PI * (0.5 * (outer - inner)).powi(2)
    });
    2.0 * half * gear.tooth.teeth as f64 - PI * gear.blank.edge_radius_m().powi(2) - openings
}

/// Area between a polygon and the chord from its first point to its last \[m²\].
fn segment_m2(points: &[[f64; 2]]) -> f64 {
    let next = points.iter().cycle().skip(1);
    let twice: f64 = points
        .iter()
        .zip(next)
        .map(|(p, q)| p[0] * q[1] - p[1] * q[0])
        .sum();
    0.5 * twice.abs()
}

/// Area between the teeth's outline and the sides of elements along it \[m²\], on whichever side.
fn outline_segments_m2(gear: &GearDefinition, mesh: &GearMesh) -> f64 {
    let curve = ProfileCurve::new(&gear.profile);
    let arcs = &mesh.section.cell.outline_arc_m;
    let half: f64 = arcs
        .windows(2)
        .filter(|ends| ends[1] <= curve.length_m() * (1.0 + 1e-9))
        .map(|ends| {
            let at = |k: u32| curve.point_at(ends[0] + (ends[1] - ends[0]) * f64::from(k) / 16.0);
            segment_m2(&(0..=16).map(at).collect::<Vec<_>>())
        })
        .sum();
    2.0 * half * gear.tooth.teeth as f64
}

/// The same of the bore, by the number of its sides, and of holes, which have eight sides at least.
fn circle_segments_m2(gear: &GearDefinition, mesh: &GearMesh) -> f64 {
    let cut_off = |radius: f64, sides: f64| {
        PI * radius.powi(2) - 0.5 * sides * radius.powi(2) * (TAU / sides).sin()
    };
    let bore = cut_off(gear.blank.edge_radius_m(), mesh.section.bore.len() as f64);
    let holes = gear.blank.openings().map_or(0.0, |o| {
        let (inner, outer) = o.radii_m();
        o.count() as f64 * cut_off(0.5 * (outer - inner), 8.0)
    });
    // The sides of a bore need not be equally long.
    1.5 * bore + holes
}

fn turned([x, y, z]: [f64; 3], angle: f64) -> [f64; 3] {
    let (s, c) = angle.sin_cos();
    [c * x - s * y, s * x + c * y, z]
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])
}

proptest! {
    #![proptest_config(cases(4))]

    /// No element is folded; the volume is that of the section but for the chords of the helix; the section differs
    /// from the drawing by no more than the chords of its curves, and those shrink with the second power of the element
    /// length.
    #[test]
    fn the_volume_converges_to_that_of_the_drawing(gear in gears()) {
        let (coarse, fine) = (gear.mesh(1.0), gear.mesh(0.5));
        prop_assume!(coarse.is_some() && fine.is_some());
        let mut cut_off = Vec::new();
        for (definition, mesh) in [coarse.unwrap(), fine.unwrap()] {
            let width = definition.tooth.face_width_m;
            let area = section_area(&mesh);
            let planes = &mesh.layers.planes_m;
            let chords: f64 = planes.windows(2)
                .map(|z| {
                    let turn = definition.profile.twist_rad_per_m() * (z[1] - z[0]);
                    (z[1] - z[0]) * (1.0 - (1.0 - turn.cos()) / 3.0)
                })
                .sum();
            prop_assert!((planes[planes.len() - 1] - planes[0] - width).abs() < 1e-12 * width);
            prop_assert!((volume(&mesh) / (area * chords) - 1.0).abs() < 1e-11);
            let outline = outline_segments_m2(&definition, &mesh);
            let circles = circle_segments_m2(&definition, &mesh);
            let exact = exact_area(&definition, 8000);
            let off = (area - exact).abs();
            // The drawing's own polygon is as fine as to be off by a millionth.
            prop_assert!(off < outline + circles + 1e-6 * exact, "{off:e} m2, chords {outline:e} and {circles:e} m2");
            cut_off.push(outline);
        }
        // Numbers of elements are whole, so that lengths are not exactly halved everywhere.
        let ratio = cut_off[0] / cut_off[1];
        prop_assert!((2.2..7.0).contains(&ratio), "second order is 4: {ratio}, {cut_off:?}");
    }

    /// Teeth and sectors repeat; flanks lie on the exact profile; bore and sets are where they belong.
    #[test]
    fn teeth_and_sectors_repeat_and_flanks_are_exact(gear in gears()) {
        let meshed = gear.mesh(1.0);
        prop_assume!(meshed.is_some());
        let (definition, mesh) = meshed.unwrap();
        let size = definition.profile.tip_radius_m;
        let at = |n: u32| mesh.nodes[n as usize];
        let pitch = TAU / definition.tooth.teeth as f64;
        let images = |first: &[u32], other: &[u32], angle: f64| {
            first.len() == other.len()
                && first.iter().zip(other).all(|(&a, &b)| distance(turned(at(a), angle), at(b)) < 1e-11 * size)
        };
        let first = mesh.cell_nodes(0);
        for tooth in 1..mesh.teeth() {
            prop_assert!(images(&first, &mesh.cell_nodes(tooth), tooth as f64 * pitch), "tooth {tooth}");
        }
        prop_assert_eq!(mesh.sectors(), definition.sectors());
        let sector = TAU / mesh.sectors() as f64;
        for s in 1..mesh.sectors() {
            let angle = s as f64 * sector;
            prop_assert!(images(&mesh.body_nodes(0), &mesh.body_nodes(s), angle), "sector {s}");
            prop_assert!(images(&mesh.cut_nodes(0), &mesh.cut_nodes(s), angle), "cut {s}");
        }
        // Each element belongs to one tooth or one sector.
        let mut owners = vec![0u32; mesh.elements.len()];
        let of_teeth = (0..mesh.teeth()).flat_map(|tooth| mesh.cell_elements(tooth));
        let of_sectors = (0..mesh.sectors()).flat_map(|s| mesh.body_elements(s));
        of_teeth.chain(of_sectors).for_each(|e| owners[e as usize] += 1);
        prop_assert!(owners.iter().all(|&n| n == 1));
        for n in mesh.bore() {
            let [x, y, _] = at(n);
            prop_assert!((x.hypot(y) - definition.blank.edge_radius_m()).abs() < 1e-11 * size);
        }
        // Right flanks by their own formula, left ones by the mirrored one.
        let g = &definition.profile;
        let sets = mesh.node_sets(&definition);
        let planes = mesh.layers.planes_m.len();
        for tooth in [0, mesh.teeth() - 1] {
            for side in [Flank::Right, Flank::Left] {
                let flank = &sets[&format!("tooth{tooth}_{}_flank", side.name())];
                prop_assert!(flank.len() >= 3 * planes);
                for &n in flank {
                    let z = at(n)[2];
                    let [x, y, _] = turned(at(n), -(tooth as f64) * pitch - g.twist_rad_per_m() * z);
                    let roll = gearmesh_geometry::involute::roll_angle_rad(x.hypot(y), g.base_radius_m);
                    let [px, py] = g.flank_point_m(side, roll);
                    prop_assert!((px - x).hypot(py - y) < 1e-10 * size, "tooth {tooth}, {side:?}");
                    let low = g.form_roll_rad - 1e-6;
                    prop_assert!((low..g.flank_end_roll_rad + 1e-6).contains(&roll));
                }
            }
        }
    }
}
