//! What a mode shape is like: nodal diameters, direction of its motion, and how rigid motions of the hub stir it.

use crate::repeated_mesh::RepeatedMesh;
use faer::Mat;
use gearmesh_fe::{CylindricalFrames, FeError, FeModel};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// One natural mode with the bore held.
#[derive(Debug, Clone, PartialEq)]
pub struct GearMode {
    /// ω² \[rad²/s²\].
    pub omega_squared: f64,
    /// ‖Kφ − ω²Mφ‖ / (ω² ‖Mφ‖).
    pub relative_residual: f64,
    /// Nodal diameters: the harmonic round the teeth that has most of their motion.
    pub nodal_diameters: usize,
    /// Its share in the motion of the teeth; 1 for a blank that repeats with every tooth.
    pub nodal_share: f64,
    /// Shares of the kinetic energy in radial, circumferential and axial motion (each element's mass spread evenly over
    /// its nodes).
    pub direction_shares: [f64; 3],
    /// ΦᵀMR \[kg^½, kg^½ m\]: x, y, z, rotations about x, y, z through the origin.
    pub coupling: [f64; 6],
}

impl GearMode {
    /// Natural frequency \[Hz\].
    pub fn frequency_hz(&self) -> f64 {
        self.omega_squared.max(0.0).sqrt() / TAU
    }
}

/// What the figures of all modes need of the mesh.
pub(crate) struct ModeFigures<'a> {
    frames: CylindricalFrames,
    nodal_volumes: Vec<f64>,
    /// Nodes of each tooth cell in the same order, image by image.
    teeth: Vec<Vec<u32>>,
    /// M R.
    momenta: &'a Mat<f64>,
}

impl<'a> ModeFigures<'a> {
    /// For a mesh and the momenta M R of its rigid motions.
    ///
    /// # Errors
    /// [`FeError`]; not for a model that was accepted.
    pub fn new(
        mesh: &impl RepeatedMesh,
        model: &FeModel,
        momenta: &'a Mat<f64>,
    ) -> Result<Self, FeError> {
        let mut nodal_volumes = vec![0.0; model.node_count()];
        for element in 0..model.element_count() {
            let nodes = model.element_nodes(element);
            let share = model.element_volume(element)? / nodes.len() as f64;
            for &node in nodes {
                nodal_volumes[node as usize] += share;
            }
        }
        Ok(Self {
            frames: CylindricalFrames::new(mesh.nodes().iter().copied()),
            nodal_volumes,
            teeth: (0..mesh.teeth())
                .map(|tooth| mesh.cell_nodes(tooth))
                .collect(),
            momenta,
        })
    }

    /// The figures of a shape, a full Cartesian field.
    pub fn of(&self, omega_squared: f64, relative_residual: f64, field: &[f64]) -> GearMode {
        let (nodal_diameters, nodal_share) = self.nodal_diameters(field);
        let mut shares = [0.0; 3];
        for (node, volume) in self.nodal_volumes.iter().enumerate() {
            let part = self.cylindrical(field, node);
            for (share, value) in shares.iter_mut().zip(part) {
                *share += volume * value * value;
            }
        }
        let total: f64 = shares.iter().sum();
        GearMode {
            omega_squared,
            relative_residual,
            nodal_diameters,
            nodal_share,
            direction_shares: shares.map(|share| share / total),
            coupling: std::array::from_fn(|motion| {
                let momentum = self.momenta.col(motion).iter();
                field.iter().zip(momentum).map(|(u, p)| u * p).sum()
            }),
        }
    }

    fn cylindrical(&self, field: &[f64], node: usize) -> [f64; 3] {
        let u = [field[3 * node], field[3 * node + 1], field[3 * node + 2]];
        self.frames.to_cylindrical(node, u)
    }

    /// The harmonic with most of the motion Σ |û|² of the teeth, and its share: û(n) = Σ_t u(t) e^{-int 2π/z} for each
    /// node of the tooth cell and direction.
    fn nodal_diameters(&self, field: &[f64]) -> (usize, f64) {
        let teeth = self.teeth.len();
        let harmonics = teeth / 2 + 1;
        let turns: Vec<[f64; 2]> = (0..teeth)
            .map(|k| (TAU * k as f64 / teeth as f64).sin_cos())
            .map(|(sin, cos)| [cos, sin])
            .collect();
        let nothing = || vec![0.0; harmonics];
        let energies = (0..self.teeth[0].len())
            .into_par_iter()
            .fold(nothing, |mut sums, i| {
                let motion: Vec<[f64; 3]> = self
                    .teeth
                    .iter()
                    .map(|nodes| self.cylindrical(field, nodes[i] as usize))
                    .collect();
                let volume = self.nodal_volumes[self.teeth[0][i] as usize];
                for (n, sum) in sums.iter_mut().enumerate() {
                    let mut parts = [[0.0; 3]; 2];
                    for (t, u) in motion.iter().enumerate() {
                        let turn = turns[n * t % teeth];
                        for (part, factor) in parts.iter_mut().zip(turn) {
                            for axis in 0..3 {
                                part[axis] += factor * u[axis];
                            }
                        }
                    }
                    // Harmonics n and z − n of a real field are alike and count together.
                    let alone = n == 0 || 2 * n == teeth;
                    let weight = if alone { volume } else { 2.0 * volume };
                    *sum += weight * parts.as_flattened().iter().map(|v| v * v).sum::<f64>();
                }
                sums
            })
            .reduce(nothing, |a, b| {
                a.iter().zip(&b).map(|(x, y)| x + y).collect()
            });
        let total: f64 = energies.iter().sum();
        let best = (0..harmonics).fold(0, |best, n| {
            if energies[n] > energies[best] {
                n
            } else {
                best
            }
        });
        (best, energies[best] / total)
    }
}
