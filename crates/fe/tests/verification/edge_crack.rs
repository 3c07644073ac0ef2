//! A crack by doubled nodes: against a mesh whose nodes are really doubled, and against linear fracture mechanics.

use crate::common;
use crate::whole_compliance;

use common::{nodes_where, steel};
use faer::Mat;
use gearmesh_fe::*;
use std::f64::consts::PI;
use whole_compliance::products;

/// A vector over all degrees of freedom, sparse.
type Load = Vec<(usize, f64)>;

/// A plate of so many square elements across its width, held at x = 0, with an edge crack half-way along.
struct Plate {
    model: FeModel,
    dofs: DofMap,
    doubled: Vec<u32>,
    beyond: Vec<u32>,
}

const WIDTH: f64 = 0.01;
const LENGTH: f64 = 4.0 * WIDTH;
const THICKNESS: f64 = 0.001;

impl Plate {
    /// `across` elements across the width, `deep` of them cracked from y = 0; nothing moves along z in plane strain.
    fn new(element: Element, across: usize, deep: f64, plane_strain: bool) -> Self {
        let size = [LENGTH, WIDTH, THICKNESS];
        let mesh = StructuredMesh::block([4 * across, across, 1], size);
        let middle = |_, ends| chord_middle(ends);
        let model = mesh.into_model(steel(), element, middle).unwrap();
        let held = nodes_where(&model, |x| x[0] < 1e-9);
        let mut fixed: Vec<usize> = held.iter().flat_map(|n| 3 * n..3 * n + 3).collect();
        if plane_strain {
            fixed.extend((0..model.node_count()).map(|n| 3 * n + 2));
            fixed.sort_unstable();
            fixed.dedup();
        }
        let tip = deep * WIDTH;
        let on_crack = |x: [f64; 3]| (x[0] - 0.5 * LENGTH).abs() < 1e-9 && x[1] < tip - 1e-9;
        let right_of = |e: &u32| {
            let corners = model.element_coordinates(*e as usize).unwrap();
            corners.iter().map(|x| x[0]).sum::<f64>() > 0.5 * LENGTH * corners.len() as f64
        };
        let doubled = nodes_where(&model, on_crack);
        Self {
            doubled: doubled.into_iter().map(|n| n as u32).collect(),
            beyond: (0..model.element_count() as u32).filter(right_of).collect(),
            dofs: DofMap::with_fixed_dofs(model.node_count(), &fixed).unwrap(),
            model,
        }
    }

    fn end(&self) -> Vec<usize> {
        nodes_where(&self.model, |x| x[0] > LENGTH - 1e-9)
    }

    /// The same body with nodes of its own on either side of the crack.
    fn really_doubled(&self) -> (FeModel, DofMap) {
        let model = &self.model;
        let twin = |n: u32| self.doubled.iter().position(|&d| d == n);
        let mut nodes = model.nodes().to_vec();
        nodes.extend(self.doubled.iter().map(|&n| model.nodes()[n as usize]));
        let mut connectivity = model.blocks()[0].nodes.clone();
        let per_element = model.element_of(0).node_count();
        for &e in &self.beyond {
            for n in &mut connectivity[per_element * e as usize..per_element * (e as usize + 1)] {
                if let Some(k) = twin(*n) {
                    *n = (model.node_count() + k) as u32;
                }
            }
        }
        let held = |dof: usize| self.dofs.free_of(dof).is_none();
        let mut fixed: Vec<usize> = (0..model.dof_count()).filter(|&d| held(d)).collect();
        for (k, &n) in self.doubled.iter().enumerate() {
            let twins = (0..3).filter(|axis| held(3 * n as usize + axis));
            fixed.extend(twins.map(|axis| model.dof_count() + 3 * k + axis));
        }
        let dofs = DofMap::with_fixed_dofs(nodes.len(), &fixed).unwrap();
        let element = model.element_of(0);
        let split =
            FeModel::from_connectivity(nodes, connectivity, *model.material(), element).unwrap();
        (split, dofs)
    }

    /// FᵀK⁻¹F of the sound plate and what the crack adds.
    fn update(&self, loads: &[Load]) -> (Mat<f64>, Mat<f64>) {
        let crack =
            DoubledNodes::new(&self.model, &self.dofs, &self.doubled, &self.beyond).unwrap();
        let columns: Vec<&Load> = crack.coupling().iter().chain(loads).collect();
        let all = products(&self.model, &self.dofs, &columns);
        let n = crack.count();
        let factor = crack.factor(all.as_ref().submatrix(0, 0, n, n)).unwrap();
        assert!(factor.asymmetry() < 1e-10);
        let rows = factor.rows(all.as_ref().submatrix(0, n, n, loads.len()));
        let sound = all.as_ref().submatrix(n, n, loads.len(), loads.len());
        (sound.to_owned(), rows.transpose() * &rows)
    }
}

#[test]
fn the_update_is_the_mesh_with_doubled_nodes() {
    for element in [Element::Hex8, Element::Hex8Incompatible, Element::Hex20] {
        let plate = Plate::new(element, 4, 0.5, false);
        let loads: Vec<Load> = (plate.end().iter().take(4))
            .flat_map(|n| (0..3).map(move |axis| vec![(3 * n + axis, 1.0)]))
            .collect();
        let (sound, added) = plate.update(&loads);
        let (split, dofs) = plate.really_doubled();
        let whole = products(&split, &dofs, &loads.iter().collect::<Vec<_>>());
        let off = (&whole - &sound - &added).norm_max() / whole.norm_max();
        let part = added.norm_max() / whole.norm_max();
        // The plate is a tenth as thick as it is wide: its stiffness is worth ten digits.
        assert!(off < 1e-9 && part > 0.01, "{element:?}: {off:e} of {part}");
    }
}

/// Compliance that an edge crack of depth α W adds under a bending moment M: K_I = σ √(πa) F(α), σ = 6M/(bW²), and
/// dC/da = 2 b K_I²/(E′ M²). F to 0.2 % for α up to 0.6: W. F. Brown, J. E. Srawley, ASTM STP 410 (1966); H. Tada, P.
/// C. Paris, G. R. Irwin, The Stress Analysis of Cracks Handbook.
fn bending_compliance(alpha: f64) -> f64 {
    let shape = |a: f64| (1.122 + a * (-1.40 + a * (7.33 + a * (-13.08 + a * 14.0)))).powi(2);
    let n = 2000;
    let sum: f64 = (0..n)
        .map(|k| {
            let a = alpha * (k as f64 + 0.5) / n as f64;
            a * shape(a) * alpha / n as f64
        })
        .sum();
    let plane_strain_young = 210e9 / (1.0 - 0.09);
    72.0 * PI / (plane_strain_young * THICKNESS * WIDTH * WIDTH) * sum
}

/// Unit moment at the end as consistent forces of its linear traction.
fn moment(plate: &Plate) -> Load {
    let end = plate.end();
    let across = |n: usize| plate.model.nodes()[n][1] / WIDTH - 0.5;
    // Any linear traction with the moment one will do, this far from the crack: lumped forces in proportion to the
    // height.
    let edge = |n: usize| {
        if across(n).abs() > 0.5 - 1e-9 {
            0.5
        } else {
            1.0
        }
    };
    let scale: f64 = (end.iter())
        .map(|&n| edge(n) * across(n).powi(2) * WIDTH)
        .sum();
    end.iter()
        .map(|&n| (3 * n, -edge(n) * across(n) / scale))
        .collect()
}

/// The energy of a field with a tip of r^½ is found with an error of first order; extrapolated so, it is the
/// handbook's.
#[test]
fn bending_of_a_cracked_plate_is_the_handbooks() {
    for alpha in [0.25, 0.5] {
        let exact = bending_compliance(alpha);
        let error = |across: usize| {
            let plate = Plate::new(Element::Hex8Incompatible, across, alpha, true);
            plate.update(&[moment(&plate)]).1[(0, 0)] / exact - 1.0
        };
        let errors = [12, 24, 48].map(error);
        let rate = ((errors[0] - errors[1]) / (errors[1] - errors[2])).log2();
        let limit = 2.0 * errors[2] - errors[1];
        println!("alpha {alpha}: errors {errors:?}, rate {rate:.2}, extrapolated {limit:.4}");
        assert!(
            (0.8..1.3).contains(&rate) && limit.abs() < 0.01,
            "alpha {alpha}: errors {errors:?}, rate {rate}, extrapolated {limit}"
        );
    }
}
