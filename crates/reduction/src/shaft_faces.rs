//! A gear that is cut into its shaft: what joins the faces at which the shaft goes on, and how they move the flanks.
//!
//! The mesh goes on into stubs of the shaft and is held at their ends, some way off the teeth, where the shaft's
//! sections are plane. Ψ are the displacements of all nodes under six unit motions of each end about the centre of its
//! face, K the stiffness between the ends, s = Ψᵀn what a load n on the body does to held ends. P holds the nodes of
//! the ends alone, f are all others:
//!
//! ```text
//! Ψ = P − K_ff⁻¹ (K P)_f,      K = Pᵀ K Ψ      (12 × 12; none where the shaft goes on at one face only)
//! ```
//!
//! What lies between a face and its stub's end is the shaft's, and the shaft's beams have it. So its flexibility F as a
//! beam (`stub_flexibility`) is taken out again: the ends move by q + F g under motions q and forces g of the faces,
//!
//! ```text
//! B = (1 − F K)⁻¹,   K_face = K B,   Ψ_face = Ψ B,   C_face = C − sᵀ B F s = C − s_faceᵀ G s_face,   G = F − F K F
//! ```
//!
//! Kept is the front face against the back one: the rest follows. Theory: docs/theory/reduction.md, "Two faces".

use crate::bore_patterns::pushed_back;
use crate::flank_loads::{GridLoad, SparseVector, directions};
use crate::gear_body::GearBody;
use crate::tooth_vectors::on_all_teeth;
use crate::{Progress, ReductionError};
use faer::{Mat, MatRef};
use gearmesh_fe::{Material, rigid_motions, stiffness_product};
use gearmesh_geometry::{CutIntoShaft, GearDefinition};
use gearmesh_model::{GaugeRows, ShaftFaces};
use nalgebra::{DMatrix, Matrix6};
use std::f64::consts::PI;

/// Name of the check: largest force and displacement that a rigid motion leaves, relative.
pub const RIGID_MOTION: &str = "two faces under rigid motion";
/// Motions of a face.
const MOTIONS: usize = 6;

/// The faces of a gear at which its shaft goes on.
pub struct HeldFaces {
    /// Ψ_face over all degrees of freedom: six motions of the back face about its centre, then of the front face; of
    /// the only one where the shaft ends at the other.
    pub motions: Mat<f64>,
    /// K_face; zero of a single face.
    pub stiffness: Mat<f64>,
    /// G.
    pub give: Mat<f64>,
    /// s_face of the flanks, `[tooth][flank][load][component]` × motions; components as in
    /// [`GaugeRows::adjoint`].
    pub flank: Mat<f64>,
    /// s_face of the gauges.
    pub gauges: Mat<f64>,
    /// What a rigid motion leaves: the larger of ‖K X‖/‖K‖, rotations taken times the distance of the faces, and of the
    /// displacements that Ψ X misses, over those of the faces.
    pub rigid_residual: f64,
    front_m: [f64; 3],
}

impl HeldFaces {
    /// Solves for the motions of the faces; none of a gear with a bore. `loads` are those of tooth 0, flank by flank.
    ///
    /// # Errors
    /// [`ReductionError::Fe`] when an element cannot be used, [`ReductionError::Check`] where the stubs are no beams.
    pub fn new(
        gear: &GearDefinition,
        body: &GearBody,
        (loads, gauges): (&[Vec<GridLoad>], &[SparseVector]),
        progress: &dyn Progress,
    ) -> Result<Option<Self>, ReductionError> {
        let Some(shaft) = gear.blank.cut_into_shaft() else {
            return Ok(None);
        };
        progress.stage("faces of the shaft");
        let nodes = &body.mesh.nodes;
        let half = 0.5 * gear.tooth.face_width_m;
        let centres_m = [-half, half].map(|z| [0.0, 0.0, z]);
        let ends = body.mesh.stub_ends();
        let joined: Vec<usize> = (0..2).filter(|&face| !ends[face].is_empty()).collect();
        let mut motions = Mat::<f64>::zeros(3 * nodes.len(), MOTIONS * joined.len());
        for (place, &face) in joined.iter().enumerate() {
            let rigid = rigid_motions(nodes, centres_m[face]);
            let mut own = motions.as_mut().subcols_mut(MOTIONS * place, MOTIONS);
            if joined.len() == 1 {
                own.copy_from(&rigid);
            } else {
                for &node in &ends[face] {
                    let rows = 3 * node as usize;
                    own.as_mut()
                        .subrows_mut(rows, 3)
                        .copy_from(rigid.as_ref().subrows(rows, 3));
                }
            }
        }
        let stiffness = match joined.len() {
            1 => Mat::zeros(MOTIONS, MOTIONS),
            _ => constrained(body, &mut motions, progress)?,
        };

        let size = motions.ncols();
        let k = DMatrix::from_fn(size, size, |i, j| stiffness[(i, j)]);
        let mut f = DMatrix::zeros(size, size);
        for (place, &face) in joined.iter().enumerate() {
            let own = stub_flexibility(shaft, face, body.model.material());
            let corner = (MOTIONS * place, MOTIONS * place);
            f.view_mut(corner, (MOTIONS, MOTIONS)).copy_from(&own);
        }
        let b = (DMatrix::identity(size, size) - &f * &k).try_inverse();
        let b = b.ok_or(ReductionError::Check {
            check: "the stubs of the shaft, taken as beams",
            found: f64::NAN,
            allowed: 0.0,
        })?;
        let of = |m: DMatrix<f64>| Mat::from_fn(size, size, |i, j| m[(i, j)]);
        let motions = motions * of(b.clone());
        let stiffness = of(&k * b);
        let rigid_residual = match joined.len() {
            1 => 0.0,
            _ => rigid_residual(nodes, (&motions, &stiffness), 2.0 * half),
        };
        let directions = directions(loads.iter().flatten());
        Ok(Some(Self {
            flank: read(motions.as_ref(), &on_all_teeth(&body.mesh, &directions)),
            gauges: read(motions.as_ref(), gauges),
            motions,
            stiffness,
            give: of(&f - &f * k * &f),
            rigid_residual,
            front_m: centres_m[1],
        }))
    }

    /// Six motions of the front face, back face held.
    pub fn front(&self) -> MatRef<'_, f64> {
        self.motions.as_ref().subcols(MOTIONS, MOTIONS)
    }

    /// s_face of vectors over all degrees of freedom.
    pub fn read(&self, vectors: &[SparseVector]) -> Mat<f64> {
        read(self.motions.as_ref(), vectors)
    }

    /// s_aᵀ G s_b, which a product aᵀ K⁻¹ b with held stub ends has too much.
    pub fn excess(&self, a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
        a * &self.give * b.transpose()
    }

    /// What the model keeps of the front face but for its mass; none where the shaft goes on at one face only.
    pub fn front_face(&self) -> Option<ShaftFaces> {
        let first = MOTIONS;
        (self.motions.ncols() > first).then(|| {
            let flat = |m: &Mat<f64>| -> Vec<f64> {
                let row = |i: usize| (first..2 * first).map(move |q| m[(i, q)]);
                (0..m.nrows()).flat_map(row).collect()
            };
            let k = |i: usize, j: usize| self.stiffness[(first + i, first + j)];
            ShaftFaces {
                front_m: self.front_m,
                stiffness: (0..36)
                    .map(|n| 0.5 * (k(n / 6, n % 6) + k(n % 6, n / 6)))
                    .collect(),
                flank: flat(&self.flank),
                gauges: flat(&self.gauges),
                mass: None,
            }
        })
    }

    /// From held stub ends to held faces: C_hub, `[loaded flank][flank of all teeth][load][response]`, and the gauges'
    /// rows.
    pub fn hold(&self, loads: usize, c_hub: &mut [f64], gauges: &mut [GaugeRows]) {
        let normals = Mat::from_fn(self.flank.nrows() / 3, self.flank.ncols(), |i, q| {
            self.flank[(3 * i, q)]
        });
        let flanks = normals.nrows() / loads;
        let of_flank = |flank: usize| normals.as_ref().subrows(flank * loads, loads);
        for (number, block) in c_hub.chunks_exact_mut(loads * loads).enumerate() {
            let excess = self.excess(of_flank(number / flanks), of_flank(number % flanks));
            for (place, entry) in block.iter_mut().enumerate() {
                *entry -= excess[(place / loads, place % loads)];
            }
        }
        let excess = self.excess(self.gauges.as_ref(), self.flank.as_ref());
        for (number, gauge) in gauges.iter_mut().enumerate() {
            for (place, entry) in gauge.adjoint.iter_mut().enumerate() {
                *entry -= excess[(number, place)];
            }
        }
    }
}

/// Lets the nodes between the ends follow; the stiffness between the ends.
fn constrained(
    body: &GearBody,
    motions: &mut Mat<f64>,
    progress: &dyn Progress,
) -> Result<Mat<f64>, ReductionError> {
    let held = motions.clone();
    let forces = stiffness_product(&body.model, held.as_ref())?;
    let loads = pushed_back(body, &forces);
    body.solve_each(&loads.iter().collect::<Vec<_>>(), progress, |q, field| {
        for (dof, value) in field.iter().enumerate() {
            motions[(dof, q)] += value;
        }
    });
    Ok(held.transpose() * stiffness_product(&body.model, motions.as_ref())?)
}

fn read(motions: MatRef<'_, f64>, vectors: &[SparseVector]) -> Mat<f64> {
    Mat::from_fn(vectors.len(), motions.ncols(), |i, q| {
        let terms = vectors[i]
            .iter()
            .map(|&(dof, value)| value * motions[(dof, q)]);
        terms.sum()
    })
}

/// Flexibility of the stub on a face (0 back, 1 front) as a beam with shear (S. P. Timoshenko; shear coefficient of a
/// tube by G. R. Cowper, J. Appl. Mech. 33 (1966) 335-340), as the shaft's beams have it but for the hole that the mesh
/// leaves open: its free end on the face's centre, clamped at the other.
fn stub_flexibility(shaft: &CutIntoShaft, face: usize, material: &Material) -> Matrix6<f64> {
    let (radius, length) = (shaft.end_radii_m[face], shaft.stub_lengths_m()[face]);
    let hole = shaft.hole_radius_m;
    let (young, poisson) = (material.young_pa(), material.poisson());
    let shear = young / (2.0 * (1.0 + poisson));
    let area = PI * (radius * radius - hole * hole);
    let second = 0.25 * PI * (radius.powi(4) - hole.powi(4));
    let ratio = (hole / radius).powi(2);
    let sum = (1.0 + ratio).powi(2);
    let kappa = 6.0 * (1.0 + poisson) * sum
        / ((7.0 + 6.0 * poisson) * sum + (20.0 + 12.0 * poisson) * ratio);
    let across = length.powi(3) / (3.0 * young * second) + length / (kappa * shear * area);
    let turn = length / (young * second);
    // From the face to the clamp z falls on the back, and rises on the front.
    let mixed = [-0.5, 0.5][face] * length * turn;
    let mut h = Matrix6::zeros();
    (h[(0, 0)], h[(1, 1)], h[(2, 2)]) = (across, across, length / (young * area));
    (h[(3, 3)], h[(4, 4)], h[(5, 5)]) = (turn, turn, length / (2.0 * shear * second));
    (h[(0, 4)], h[(4, 0)]) = (-mixed, -mixed);
    (h[(1, 3)], h[(3, 1)]) = (mixed, mixed);
    h
}

fn rigid_residual(
    nodes: &[[f64; 3]],
    (motions, stiffness): (&Mat<f64>, &Mat<f64>),
    apart_m: f64,
) -> f64 {
    // Rotations in the motion of a point as far away as the other face.
    let unit = |q: usize| if q % 6 < 3 { 1.0 } else { 1.0 / apart_m };
    let mut rigid = Mat::<f64>::zeros(12, 6);
    for q in 0..6 {
        (rigid[(q, q)], rigid[(6 + q, q)]) = (1.0, 1.0);
    }
    // Turned about the back face's centre, that of the front face moves by θ × (0, 0, b).
    (rigid[(6, 4)], rigid[(7, 3)]) = (apart_m, -apart_m);
    let left = stiffness * &rigid;
    let (mut force, mut largest) = (0.0_f64, 0.0_f64);
    for i in 0..12 {
        for j in 0..12 {
            largest = largest.max((unit(i) * unit(j) * stiffness[(i, j)]).abs());
        }
        for j in 0..6 {
            force = force.max((unit(i) * unit(j) * left[(i, j)]).abs());
        }
    }
    let exact = rigid_motions(nodes, [0.0, 0.0, -0.5 * apart_m]);
    let found = motions * &rigid;
    let mut missed = 0.0_f64;
    for q in 0..6 {
        for dof in 0..exact.nrows() {
            missed = missed.max(unit(q) * (found[(dof, q)] - exact[(dof, q)]).abs());
        }
    }
    (force / largest).max(missed)
}
