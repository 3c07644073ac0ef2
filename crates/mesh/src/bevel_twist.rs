//! How the azimuth θ of a column goes on from the ring of a bevel gear into a freely meshed body: ∫ r³ |∇θ|² dA over
//! the meridian is the least.
//!
//! r ∇θ is the shear of the elements by the twist of the teeth, 2πr dA the volume behind dA: shear has its least mean
//! square. The equation is that of Saint-Venant's torsion of a shaft of changing diameter (S. P. Timoshenko, J. N.
//! Goodier, *Theory of Elasticity*, section on that case).

use crate::bevel_grid::corners_of;

/// Residual over the first one at which azimuths are good.
const SOLVED: f64 = 1e-13;

/// Quads with the matrices of ∫ r³ ∇a·∇b dA, bilinear, by four points each.
pub(crate) struct Torsion {
    quads: Vec<([usize; 4], [[f64; 4]; 4])>,
}

impl Torsion {
    /// Of the quads of a meridian, order `p`, with the places of their nodes.
    pub(crate) fn new(quads: &[[[usize; 3]; 3]], p: usize, nodes: &[[f64; 2]]) -> Self {
        let quads = quads.iter().map(|quad| {
            let corners = corners_of(quad, p);
            let at = corners.map(|n| nodes[n]);
            let mut matrix = [[0.0; 4]; 4];
            let g = 1.0 / 3f64.sqrt();
            for [x, y] in [[-g, -g], [g, -g], [g, g], [-g, g]] {
                let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
                let slopes =
                    signs.map(|[a, b]| [0.25 * a * (1.0 + b * y), 0.25 * b * (1.0 + a * x)]);
                let mut jacobian = [[0.0; 2]; 2];
                let mut radius = 0.0;
                for k in 0..4 {
                    radius += 0.25 * (1.0 + signs[k][0] * x) * (1.0 + signs[k][1] * y) * at[k][1];
                    for (i, row) in jacobian.iter_mut().enumerate() {
                        for (j, entry) in row.iter_mut().enumerate() {
                            *entry += slopes[k][i] * at[k][j];
                        }
                    }
                }
                let [[a, b], [c, d]] = jacobian;
                let det = (a * d - b * c).abs().max(f64::MIN_POSITIVE);
                let grad = slopes.map(|[s, t]| [(d * s - b * t) / det, (a * t - c * s) / det]);
                for (row, ga) in matrix.iter_mut().zip(&grad) {
                    for (entry, gb) in row.iter_mut().zip(&grad) {
                        *entry += radius.powi(3) * det * (ga[0] * gb[0] + ga[1] * gb[1]);
                    }
                }
            }
            (corners, matrix)
        });
        Self {
            quads: quads.collect(),
        }
    }

    fn product(&self, x: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; x.len()];
        for (nodes, matrix) in &self.quads {
            for (row, line) in nodes.iter().zip(matrix) {
                sum[*row] += (line.iter().zip(nodes))
                    .map(|(entry, n)| entry * x[*n])
                    .sum::<f64>();
            }
        }
        sum
    }

    /// The values at all corners from those given at some of them, by conjugate gradients; zero elsewhere.
    pub(crate) fn solve(&self, between: &[u8], given: &[(usize, f64)]) -> Vec<f64> {
        let count = between.len();
        let mean = given.iter().map(|(_, value)| value).sum::<f64>() / given.len() as f64;
        let mut is_free: Vec<bool> = between.iter().map(|k| *k == 0).collect();
        let mut x: Vec<f64> = is_free
            .iter()
            .map(|is| if *is { mean } else { 0.0 })
            .collect();
        for &(n, value) in given {
            (is_free[n], x[n]) = (false, value);
        }
        let mut diagonal = vec![0.0; count];
        for (nodes, matrix) in &self.quads {
            for (k, n) in nodes.iter().enumerate() {
                diagonal[*n] += matrix[k][k];
            }
        }
        let masked = |mut v: Vec<f64>| {
            v.iter_mut().zip(&is_free).for_each(|(v, is)| {
                if !is {
                    *v = 0.0;
                }
            });
            v
        };
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut residual = masked(self.product(&x).into_iter().map(|v| -v).collect());
        let scaled = |r: &[f64]| -> Vec<f64> {
            let pairs = r.iter().zip(&diagonal);
            pairs
                .map(|(r, d)| if *d > 0.0 { r / d } else { 0.0 })
                .collect()
        };
        let mut z = scaled(&residual);
        let mut direction = z.clone();
        let mut rho = dot(&residual, &z);
        let first = rho;
        for _ in 0..4 * count {
            if rho <= SOLVED * SOLVED * first {
                break;
            }
            let image = masked(self.product(&direction));
            let step = rho / dot(&direction, &image);
            for n in 0..count {
                x[n] += step * direction[n];
                residual[n] -= step * image[n];
            }
            z = scaled(&residual);
            let next = dot(&residual, &z);
            for (d, z) in direction.iter_mut().zip(&z) {
                *d = z + next / rho * *d;
            }
            rho = next;
        }
        x
    }
}
