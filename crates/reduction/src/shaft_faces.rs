//! A gear that is cut into a shaft which goes on at both faces: what joins its two faces, and how they move the flanks.
//!
//! Each face within the shaft's outline moves rigidly. With P the displacements of the nodes on a face under six unit
//! motions of it, all other nodes held, and K the stiffness of everything, the constraint modes of both faces and their
//! forces are
//!
//! ```text
//! Ψ = P − K_ff⁻¹ (K P)_f,      K_bb = Pᵀ K Ψ      (12 × 12),
//! ```
//!
//! f the nodes that are free while both faces are held. K_bb lets the body move rigidly without force, Ψ moves all
//! nodes with it. Kept is the front face against the back one: the rest follows. Theory: docs/theory/reduction.md, "Two
//! faces".

use crate::flank_loads::SparseVector;
use crate::gear_body::GearBody;
use crate::{Progress, ReductionError};
use faer::Mat;
use gearmesh_fe::{rigid_motions, stiffness_product};
use gearmesh_geometry::GearDefinition;
use gearmesh_model::ShaftFaces;

/// Name of the check: largest force and displacement that a rigid motion leaves, relative.
pub const RIGID_MOTION: &str = "two faces under rigid motion";

/// Constraint modes of both faces.
pub struct ConstraintModes {
    /// Ψ over all degrees of freedom: six motions of the back face about its centre, then of the front face.
    pub motions: Mat<f64>,
    /// K_bb.
    pub stiffness: Mat<f64>,
    /// Centres of the faces (m).
    pub centres_m: [[f64; 3]; 2],
    /// What a rigid motion leaves: the larger of ‖K_bb X‖/‖K_bb‖, rotations taken times the distance of the faces, and
    /// of the displacements that Ψ X misses, over those of the faces.
    pub rigid_residual: f64,
}

impl ConstraintModes {
    /// Solves for the constraint modes; none of a gear with a bore, or whose shaft goes on at one face only.
    ///
    /// # Errors
    /// [`ReductionError::Fe`] when an element cannot be used.
    pub fn new(
        gear: &GearDefinition,
        body: &GearBody,
        progress: &dyn Progress,
    ) -> Result<Option<Self>, ReductionError> {
        let Some(shaft) = gear.blank.two_faced_shaft() else {
            return Ok(None);
        };
        progress.stage("faces of the shaft");
        let nodes = &body.mesh.nodes;
        let half = 0.5 * gear.tooth.face_width_m;
        let centres_m = [-half, half].map(|z| [0.0, 0.0, z]);
        let faces = body.mesh.shaft_faces(shaft);
        let mut held = Mat::<f64>::zeros(3 * nodes.len(), 12);
        for (face, of_face) in faces.iter().enumerate() {
            let motions = rigid_motions(nodes, centres_m[face]);
            for &node in of_face {
                for dof in 3 * node as usize..3 * node as usize + 3 {
                    for q in 0..6 {
                        held[(dof, 6 * face + q)] = motions[(dof, q)];
                    }
                }
            }
        }
        let forces = stiffness_product(&body.model, held.as_ref())?;
        let loads: Vec<SparseVector> = (0..12)
            .map(|q| {
                let column = (0..forces.nrows()).map(|dof| (dof, -forces[(dof, q)]));
                let free =
                    |&(dof, force): &(usize, f64)| force != 0.0 && body.dofs.free_of(dof).is_some();
                column.filter(free).collect()
            })
            .collect();
        let mut motions = held.clone();
        body.solve_each(&loads.iter().collect::<Vec<_>>(), progress, |q, field| {
            for (dof, value) in field.iter().enumerate() {
                motions[(dof, q)] += value;
            }
        });
        let stiffness = held.transpose() * stiffness_product(&body.model, motions.as_ref())?;
        let rigid_residual = rigid_residual(nodes, (&motions, &stiffness), 2.0 * half);
        Ok(Some(Self {
            motions,
            stiffness,
            centres_m,
            rigid_residual,
        }))
    }

    /// Six motions of the front face, back face held.
    pub fn front(&self) -> faer::MatRef<'_, f64> {
        self.motions.as_ref().subcols(6, 6)
    }

    /// What the model keeps of them but for the mass; `rows` of the flanks on all teeth, `gauges` on the whole mesh.
    pub fn faces(&self, rows: &[SparseVector], gauges: &[SparseVector]) -> ShaftFaces {
        let front = self.front();
        let read = |rows: &[SparseVector]| -> Vec<f64> {
            let each = rows.iter().flat_map(|row| {
                (0..6).map(move |q| {
                    let terms = row.iter().map(|&(dof, value)| value * front[(dof, q)]);
                    terms.sum::<f64>()
                })
            });
            each.collect()
        };
        let k = |i: usize, j: usize| self.stiffness[(6 + i, 6 + j)];
        ShaftFaces {
            front_m: self.centres_m[1],
            stiffness: (0..36)
                .map(|n| 0.5 * (k(n / 6, n % 6) + k(n % 6, n / 6)))
                .collect(),
            flank: read(rows),
            gauges: read(gauges),
            mass: None,
        }
    }
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
