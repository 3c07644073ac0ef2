//! The tooth-only submodel (cut and opposite side held) under a Hertz pressure over parts of its width: a mesh of
//! quadratic hexahedra, graded to the contact in all directions. What is not tooth-only, C_g, is smooth and added.

use gearmesh_fe::{
    DofMap, Element, Factor, FeModel, Material, QuadraticMesh, assemble_stiffness, chord_middle,
};
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve, involute};
use gearmesh_mesh::GearMesh;
use gearmesh_mesh::contact_section::{ContactGrading, ContactSection};

/// Slices whose loads are solved; coarser ones are sums of these.
pub const PARTS: usize = 10;

/// Where the load stands.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    pub radius_m: f64,
    pub half_width_m: f64,
}

/// Deflection of the contact line per newton, `[loaded part][part]` \[m/N\], means over a tenth of the width each.
pub struct GradedTooth {
    pub compliance: Vec<f64>,
}

impl GradedTooth {
    /// Mean deflection of each of `slices` slices \[m/N\] under a newton spread evenly over slice `loaded`. `slices`
    /// divides [`PARTS`].
    pub fn deflections(&self, slices: usize, loaded: usize) -> Vec<f64> {
        let parts = PARTS / slices;
        let mean = |i: usize| -> f64 {
            (0..parts * parts)
                .map(|k| (loaded * parts + k / parts, i * parts + k % parts))
                .map(|(l, m)| self.compliance[l * PARTS + m])
                .sum()
        };
        (0..slices)
            .map(|i| mean(i) / (parts * parts) as f64)
            .collect()
    }

    /// The value that this mesh and one of `ratio` times its element lengths lead to with an error of `order`.
    pub fn extrapolated(&self, coarse: &Self, ratio: f64, order: f64) -> Self {
        let gain = 1.0 / (ratio.powf(order) - 1.0);
        let pairs = self.compliance.iter().zip(&coarse.compliance);
        Self {
            compliance: pairs.map(|(f, c)| f + gain * (f - c)).collect(),
        }
    }

    /// Solves the tooth of a gear's section mesh, element lengths times `factor`.
    pub fn new(gear: &GearDefinition, mesh: &GearMesh, contact: Contact, factor: f64) -> Self {
        let profile = &gear.profile;
        let curve = ProfileCurve::new(profile);
        let roll = involute::roll_angle_rad(contact.radius_m, profile.base_radius_m);
        let a = contact.half_width_m;
        let section = ContactSection::new(
            profile,
            &curve,
            &mesh.section.cell.cut_line(),
            curve.arc_length_at_roll_m(roll),
            ContactGrading {
                smallest_m: factor * a / 3.0,
                plateau_m: 1.2 * a,
                growth: factor * 0.25,
                largest_m: factor * 0.4e-3,
            },
        );
        let width_m = gear.tooth.face_width_m;
        let planes = planes(width_m, factor);
        let (count, rows) = (section.nodes.len(), section.outline.len());
        let columns = count / rows;
        let quads = section.quads.len();
        let nodes: Vec<[f64; 3]> = (planes.iter())
            .flat_map(|&z| section.nodes.iter().map(move |p| [p[0], p[1], z]))
            .collect();
        let hexes: Vec<[u32; 8]> = (0..planes.len() - 1)
            .flat_map(|layer| {
                section.quads.iter().map(move |q| {
                    std::array::from_fn(|i| (q[i % 4] + count * (layer + i / 4)) as u32)
                })
            })
            .collect();
        let mut in_section = vec![false; count];
        for &n in &section.held {
            in_section[n] = true;
        }
        let is_held = |node: usize| in_section[node % count];
        let mut held: Vec<usize> = (0..nodes.len()).filter(|&n| is_held(n)).collect();
        let mut next = nodes.len();
        let quadratic = QuadraticMesh::new(nodes, &hexes, |edge, ends| {
            let [(low, plane), (high, other)] =
                edge.map(|n| (n as usize % count, n as usize / count));
            if is_held(low) && is_held(high) {
                held.push(next);
            }
            next += 1;
            let (row, column) = (low / columns, low % columns);
            if plane == other && high == low + columns && (column == 0 || column == columns - 1) {
                let arcs = &section.outline_arc_m;
                let p = curve.point_at(0.5 * (arcs[row] + arcs[row + 1]));
                let y = if column == 0 { p[1] } else { -p[1] };
                return [p[0], y, ends[0][2]];
            }
            chord_middle(ends)
        });
        let material = Material::new(gear.material.young_pa, gear.material.poisson).unwrap();
        let faces = quadratic.elements.clone();
        let model = FeModel::new(
            quadratic.nodes,
            quadratic.elements,
            material,
            Element::Hex20,
        )
        .unwrap();
        let dofs = DofMap::with_fixed_nodes(model.node_count(), &held).unwrap();
        let stiffness = assemble_stiffness(&model, &dofs).unwrap();
        let factorised = Factor::of_model(&model, &dofs, &stiffness).unwrap();

        let (normal, _) = profile.flank_frame(Flank::Right, roll);
        let outline_hex = |row: usize, layer: usize| &faces[layer * quads + row * (columns - 1)];
        let across = hertz_shares(&section, a);
        let centre = section.centre;
        let layers_of = |part: usize| {
            let edge = |k: usize| width_m * (k as f64 / PARTS as f64 - 0.5);
            let inside = |l: &usize| {
                planes[*l] > edge(part) - 1e-9 && planes[*l + 1] < edge(part + 1) + 1e-9
            };
            (0..planes.len() - 1)
                .filter(inside)
                .map(|l| (l, (planes[l + 1] - planes[l]) * PARTS as f64 / width_m))
                .collect::<Vec<_>>()
        };
        let mut compliance = Vec::with_capacity(PARTS * PARTS);
        for loaded in 0..PARTS {
            let mut u = vec![0.0; dofs.free_count()];
            for (layer, share) in layers_of(loaded) {
                for (row, shares) in &across {
                    let hex = outline_hex(*row, layer);
                    for (local, weight) in FACE.iter().zip(shares) {
                        for (axis, component) in normal.iter().enumerate() {
                            if let Some(free) = dofs.free_of(3 * hex[*local] as usize + axis) {
                                u[free] += share * weight * component;
                            }
                        }
                    }
                }
            }
            factorised.solve_slice_in_place(&mut u);
            let full = dofs.expand(&u);
            let along = |node: u32| {
                let dof = 3 * node as usize;
                normal[0] * full[dof] + normal[1] * full[dof + 1]
            };
            // Simpson's rule is exact on the edges of quadratic elements.
            compliance.extend((0..PARTS).map(|part| {
                (layers_of(part).into_iter())
                    .map(|(layer, share)| {
                        let hex = outline_hex(centre, layer);
                        let [low, high, middle] = [hex[0], hex[4], hex[16]].map(along);
                        share * (low + 4.0 * middle + high) / 6.0
                    })
                    .sum::<f64>()
            }));
        }
        Self { compliance }
    }
}

/// Local nodes of the face on the loaded outline: corners, then the middles of the edges between them.
const FACE: [usize; 8] = [0, 1, 5, 4, 8, 17, 12, 16];

/// Planes along the axis, dense at the ends of the parts and at the faces.
fn planes(width_m: f64, factor: f64) -> Vec<f64> {
    let part = width_m / PARTS as f64;
    let mut inside = vec![0.0];
    let (mut at, mut step) = (0.0, 0.15e-3 * factor);
    while at + 1.3 * step < 0.5 * part {
        at += step;
        inside.push(at);
        step *= 2.0_f64.powf(factor);
    }
    inside.push(0.5 * part);
    let mirrored: Vec<f64> = inside[1..inside.len() - 1]
        .iter()
        .rev()
        .map(|z| part - z)
        .collect();
    inside.extend(mirrored);
    let mut planes: Vec<f64> = (0..PARTS)
        .flat_map(|k| inside.iter().map(move |z| (k, z)))
        .map(|(k, z)| k as f64 * part + z - 0.5 * width_m)
        .collect();
    planes.push(0.5 * width_m);
    planes
}

/// Consistent nodal shares of a unit force, pressed on by a Hertz pressure across and evenly along a layer, on each row
/// of faces that it touches.
fn hertz_shares(section: &ContactSection, half_width_m: f64) -> Vec<(usize, [f64; 8])> {
    let edges = Element::Hex20.cell().edges();
    assert_eq!([edges[0], edges[4]], [[0, 1], [4, 5]]);
    assert_eq!([edges[8], edges[9]], [[0, 4], [1, 5]]);
    let arcs = &section.outline_arc_m;
    let mut rows: Vec<(usize, [f64; 8])> = Vec::new();
    let strips = 4000;
    for k in 0..strips {
        // t = sin θ: the pressure's ends do no harm. p dt = cos²θ dθ.
        let angle = std::f64::consts::PI * ((k as f64 + 0.5) / strips as f64 - 0.5);
        let s = arcs[section.centre] + half_width_m * angle.sin();
        let row = arcs.partition_point(|a| *a <= s) - 1;
        let weight = angle.cos().powi(2) * 2.0 / strips as f64;
        let xi = 2.0 * (s - arcs[row]) / (arcs[row + 1] - arcs[row]) - 1.0;
        if rows.last().is_none_or(|last| last.0 != row) {
            rows.push((row, [0.0; 8]));
        }
        let last = rows.len() - 1;
        // Two points are enough along the axis.
        for eta in [-(1.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt()] {
            for (sum, value) in rows[last].1.iter_mut().zip(face_shapes(xi, eta)) {
                *sum += 0.5 * weight * value;
            }
        }
    }
    rows
}

/// Shape functions of the face with eight nodes, ξ along the profile, η along the axis.
fn face_shapes(xi: f64, eta: f64) -> [f64; 8] {
    let corner =
        |a: f64, b: f64| 0.25 * (1.0 + a * xi) * (1.0 + b * eta) * (a * xi + b * eta - 1.0);
    [
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
        0.5 * (1.0 - xi * xi) * (1.0 - eta),
        0.5 * (1.0 + xi) * (1.0 - eta * eta),
        0.5 * (1.0 - xi * xi) * (1.0 + eta),
        0.5 * (1.0 - xi) * (1.0 - eta * eta),
    ]
}
