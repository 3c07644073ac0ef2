//! Motions of a bore: the displacement of the flanks under each, and the forces that the bore then carries.
//!
//! The bore is held in all other figures. P are radial, tangential and axial displacements of its nodes, K the
//! stiffness of the body, f its free nodes, n a load on a flank:
//!
//! ```text
//! Ψ = P − K_ff⁻¹ (K P)_f,      S = PᵀKΨ = Pᵀ K P − (K P)_fᵀ K_ff⁻¹ (K P)_f,      s = nᵀΨ
//! ```
//!
//! The rigid motions X of the body are among them: S X = 0, and nᵀΨX is what n does on a rigid motion. Theory:
//! docs/theory/bore_patterns.md.

use crate::flank_compliance::checked;
use crate::flank_loads::{GridLoad, SparseVector, dot};
use crate::gear_body::GearBody;
use crate::tooth_submodel::Deformation;
use crate::tooth_vectors::on_tooth;
use crate::{Progress, ReductionError, Silent};
use faer::{Mat, MatRef};
use gearmesh_fe::{rigid_motions, stiffness_product};
use gearmesh_geometry::GearDefinition;
use gearmesh_mesh::GearMesh;
use gearmesh_model::{BoreMotion, BorePatterns};

/// Names of the checks: ‖S − Sᵀ‖/‖S‖; the largest force that a rigid motion leaves, and displacement of a flank that it
/// misses, relative.
pub const SYMMETRY: &str = "symmetry of the motions of the bore";
/// The second one.
pub const RIGID_MOTION: &str = "motions of the bore under rigid motion";
/// Largest of both that round-off explains.
const ALLOWED: f64 = 1e-8;
/// Motions of which a combination moves the nodes by less than this, squared, over the most that one moves them, are
/// not told apart by them.
const DISTINCT: f64 = 1e-4;
/// Motions whose forces are made at a time.
const TOGETHER: usize = 16;

/// The motions that a gear's definition asks for, on the nodes of its mesh.
pub struct AskedMotions {
    patterns: BorePatterns,
    bore: Vec<usize>,
    /// P on the nodes of the bore, Cartesian, three rows a node.
    moved: Mat<f64>,
}

/// The motions, and their checks by name.
pub struct FoundMotions {
    /// As the reduced gear holds them.
    pub patterns: BorePatterns,
    /// Checks.
    pub checks: [(String, f64); 2],
}

impl AskedMotions {
    /// None where the definition does not ask for them.
    ///
    /// # Errors
    /// [`ReductionError::BoreMotions`] when the mesh does not tell them apart.
    pub fn new(gear: &GearDefinition, mesh: &GearMesh) -> Result<Option<Self>, ReductionError> {
        let Some(asked) = gear.reduction.bore else {
            return Ok(None);
        };
        let bore: Vec<usize> = mesh.bore().into_iter().map(|n| n as usize).collect();
        let z = bore.iter().map(|&node| mesh.nodes[node][2]);
        let ends_m = z.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| {
            [low.min(z), high.max(z)]
        });
        let patterns = BorePatterns {
            harmonics: asked.harmonics,
            along: asked.along,
            components: match Deformation::of(gear) {
                Deformation::PlaneStrain => 2,
                Deformation::Spatial => 3,
            },
            radius_m: gear.blank.bore_radius_m(),
            ends_m,
            ..BorePatterns::default()
        };
        let moved = moved(&patterns, &mesh.nodes, &bore);
        if !are_independent(&moved) {
            return Err(ReductionError::BoreMotions {
                nodes: bore.len(),
                harmonics: asked.harmonics,
                along: asked.along,
            });
        }
        Ok(Some(Self {
            patterns,
            bore,
            moved,
        }))
    }

    /// Solves for them. `loads` are those of tooth 0, flank by flank; `gauges` the rows of all gauges.
    ///
    /// # Errors
    /// [`ReductionError::Fe`] when an element cannot be used, [`ReductionError::Check`] when a rigid motion of the bore
    /// is none of the body or reciprocity is violated by more than round-off explains.
    pub fn solve(
        self,
        body: &GearBody,
        (loads, gauges): (&[Vec<GridLoad>], &[SparseVector]),
        progress: &dyn Progress,
    ) -> Result<FoundMotions, ReductionError> {
        progress.stage("motions of the bore");
        let (mut found, nodes) = (self.patterns, &body.mesh.nodes);
        let m = found.count();
        let (mut stiffness, pushed) = forces(body, &self.bore, &self.moved)?;
        let own = body.mesh.teeth() / body.mesh.sectors();
        let normals: Vec<SparseVector> = (0..own)
            .flat_map(|tooth| {
                let normals = loads.iter().flatten().map(|load| &load.normal);
                normals.map(move |normal| on_tooth(&body.mesh, normal, tooth))
            })
            .collect();
        let mut flank = Mat::<f64>::zeros(normals.len(), m);
        let mut strains = Mat::<f64>::zeros(gauges.len(), m);
        body.solve_each(&pushed.iter().collect::<Vec<_>>(), progress, |q, field| {
            for (p, forces) in pushed.iter().enumerate() {
                stiffness[(p, q)] -= dot(forces, field);
            }
            for (i, normal) in normals.iter().enumerate() {
                flank[(i, q)] = dot(normal, field);
            }
            for (i, gauge) in gauges.iter().enumerate() {
                strains[(i, q)] = dot(gauge, field);
            }
        });
        let (symmetry, rigid) = (
            asymmetry(stiffness.as_ref()),
            rigid_residual(&found, nodes, (&stiffness, &flank), &normals),
        );
        for (check, found) in [(SYMMETRY, symmetry), (RIGID_MOTION, rigid)] {
            checked(check, found, ALLOWED)?;
        }
        let flat = |matrix: MatRef<'_, f64>| -> Vec<f64> {
            let row = |i: usize| (0..m).map(move |q| matrix[(i, q)]);
            (0..matrix.nrows()).flat_map(row).collect()
        };
        found.stiffness = flat(stiffness.as_ref());
        for i in 0..m {
            for j in 0..i {
                let mean = 0.5 * (found.stiffness[i * m + j] + found.stiffness[j * m + i]);
                (found.stiffness[i * m + j], found.stiffness[j * m + i]) = (mean, mean);
            }
        }
        found.flank = flat(flank.as_ref());
        found.gauges = flat(strains.as_ref());
        Ok(FoundMotions {
            patterns: found,
            checks: [(SYMMETRY.into(), symmetry), (RIGID_MOTION.into(), rigid)],
        })
    }
}

/// Ψ q \[m\] on all degrees of freedom: the body where its bore has moved so and nothing presses on it.
///
/// # Errors
/// [`ReductionError::Fe`] when an element cannot be used.
///
/// # Panics
/// If there are more or fewer motions than patterns.
pub fn moved_body(
    body: &GearBody,
    patterns: &BorePatterns,
    motions_m: &[f64],
) -> Result<Vec<f64>, ReductionError> {
    let bore: Vec<usize> = body.mesh.bore().into_iter().map(|n| n as usize).collect();
    let motions = Mat::from_fn(motions_m.len(), 1, |i, _| motions_m[i]);
    let moved = moved(patterns, &body.mesh.nodes, &bore) * motions;
    let (_, pushed) = forces(body, &bore, &moved)?;
    let mut all = Vec::new();
    body.solve_each(&pushed.iter().collect::<Vec<_>>(), &Silent, |_, field| {
        all.extend_from_slice(field);
    });
    for (place, &node) in bore.iter().enumerate() {
        for axis in 0..3 {
            all[3 * node + axis] = moved[(3 * place + axis, 0)];
        }
    }
    Ok(all)
}

/// Pᵀ K P, and −K P on the free nodes.
fn forces(
    body: &GearBody,
    bore: &[usize],
    moved: &Mat<f64>,
) -> Result<(Mat<f64>, Vec<SparseVector>), ReductionError> {
    let (nodes, m) = (&body.mesh.nodes, moved.ncols());
    let mut stiffness = Mat::<f64>::zeros(m, m);
    let mut pushed: Vec<SparseVector> = Vec::with_capacity(m);
    for start in (0..m).step_by(TOGETHER) {
        let some = TOGETHER.min(m - start);
        let mut motions = Mat::<f64>::zeros(3 * nodes.len(), some);
        for (place, &node) in bore.iter().enumerate() {
            let of_node = moved.as_ref().submatrix(3 * place, start, 3, some);
            motions.as_mut().subrows_mut(3 * node, 3).copy_from(of_node);
        }
        let forces = stiffness_product(&body.model, motions.as_ref())?;
        let on_bore = Mat::from_fn(3 * bore.len(), some, |i, q| {
            forces[(3 * bore[i / 3] + i % 3, q)]
        });
        let work = moved.transpose() * on_bore;
        stiffness.as_mut().subcols_mut(start, some).copy_from(&work);
        pushed.extend(pushed_back(body, &forces));
    }
    Ok((stiffness, pushed))
}

/// Columns of forces turned round, where the body is free to follow them.
pub(crate) fn pushed_back(body: &GearBody, forces: &Mat<f64>) -> Vec<SparseVector> {
    let free = |&(dof, force): &(usize, f64)| force != 0.0 && body.dofs.free_of(dof).is_some();
    let columns = (0..forces.ncols()).map(|q| {
        let column = (0..forces.nrows()).map(|dof| (dof, -forces[(dof, q)]));
        column.filter(free).collect()
    });
    columns.collect()
}

/// P on the nodes of the bore, Cartesian, three rows a node.
fn moved(patterns: &BorePatterns, nodes: &[[f64; 3]], bore: &[usize]) -> Mat<f64> {
    let mut moved = Mat::<f64>::zeros(3 * bore.len(), patterns.count());
    for (place, &node) in bore.iter().enumerate() {
        let [x, y, z] = nodes[node];
        let polar = y.atan2(x);
        let (sin, cos) = polar.sin_cos();
        let directions = [
            (BoreMotion::Radial, [cos, sin, 0.0]),
            (BoreMotion::Tangential, [-sin, cos, 0.0]),
            (BoreMotion::Axial, [0.0, 0.0, 1.0]),
        ];
        let values = patterns.at(polar, z);
        for (component, direction) in &directions[..patterns.components] {
            for (value, q) in values.iter().zip(patterns.motions_of(*component)) {
                for (axis, part) in direction.iter().enumerate() {
                    moved[(3 * place + axis, q)] = value * part;
                }
            }
        }
    }
    moved
}

/// Whether the nodes of the bore tell the motions apart.
fn are_independent(moved: &Mat<f64>) -> bool {
    let gram = moved.transpose() * moved;
    let sizes = gram.self_adjoint_eigenvalues(faer::Side::Lower);
    sizes.is_ok_and(|sizes| sizes[0] > DISTINCT * sizes[sizes.len() - 1])
}

fn asymmetry(s: MatRef<'_, f64>) -> f64 {
    (s - s.transpose()).norm_max() / s.norm_max()
}

/// The larger of ‖S X‖/‖S‖ and of what s X misses of the flanks' displacements over the largest of those; rotations in
/// radii of the bore.
fn rigid_residual(
    patterns: &BorePatterns,
    nodes: &[[f64; 3]],
    (stiffness, flank): (&Mat<f64>, &Mat<f64>),
    normals: &[SparseVector],
) -> f64 {
    let motions = patterns.rigid();
    // x, y, about z; in space z, about x, about y.
    let columns: &[usize] = &[0, 1, 5, 2, 3, 4][..motions.len()];
    let fields = rigid_motions(nodes, [0.0; 3]);
    let mut worst = 0.0_f64;
    for (motion, &column) in motions.iter().zip(columns) {
        let unit = if column < 3 {
            1.0
        } else {
            1.0 / patterns.radius_m
        };
        let x = Mat::from_fn(motion.len(), 1, |i, _| unit * motion[i]);
        let force = (stiffness * &x).norm_max() / stiffness.norm_max();
        let of_flank = flank * &x;
        let exact = Mat::from_fn(normals.len(), 1, |i, _| {
            let terms = normals[i].iter();
            unit * terms
                .map(|&(dof, value)| value * fields[(dof, column)])
                .sum::<f64>()
        });
        let missed = (of_flank - &exact).norm_max() / exact.norm_max().max(f64::MIN_POSITIVE);
        worst = worst
            .max(force)
            .max(if exact.norm_max() > 1e-9 { missed } else { 0.0 });
    }
    worst
}
