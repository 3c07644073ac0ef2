//! A gear as a rigid body that hangs on the reference point of its hub, and what its flanks do under rigid motions.

/// Mass and inertia of the meshed body, in the frame of the gear.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RigidBody {
    /// The reference point (m): rigid motions and `inertia_kg_m2` are about it.
    pub reference_m: [f64; 3],
    /// Mass (kg).
    pub mass_kg: f64,
    /// Centre of mass (m).
    pub centre_m: [f64; 3],
    /// Inertia tensor about the reference point, ∫ ρ (|r|² 1 − r rᵀ) dV with r from the reference point (kg m²).
    pub inertia_kg_m2: [[f64; 3]; 3],
}

impl RigidBody {
    /// RᵀMR (6 × 6) over x, y, z, rotations about x, y, z of the reference point, with the static moments S = m ×
    /// (centre − reference):
    ///
    /// ```text
    /// [ m 1      −[S]× ]      kinetic energy ½ ṙᵀ (RᵀMR) ṙ,   ṙ = (velocity of the point, angular velocity)
    /// [ [S]×      J    ]
    /// ```
    pub fn mass_matrix(&self) -> [[f64; 6]; 6] {
        let m = self.mass_kg;
        let [x, y, z] = std::array::from_fn(|k| m * (self.centre_m[k] - self.reference_m[k]));
        let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
        std::array::from_fn(|i| {
            std::array::from_fn(|j| match (i < 3, j < 3) {
                (true, true) => f64::from(u8::from(i == j)) * m,
                (true, false) => -cross[i][j - 3],
                (false, true) => cross[i - 3][j],
                (false, false) => self.inertia_kg_m2[i - 3][j - 3],
            })
        })
    }

    /// The body whose RᵀMR is given; of entries that occur twice the mean is taken.
    pub fn from_mass_matrix(matrix: &[[f64; 6]; 6], reference_m: [f64; 3]) -> Self {
        let mass_kg = (matrix[0][0] + matrix[1][1] + matrix[2][2]) / 3.0;
        let mean = |i: usize, j: usize| 0.5 * (matrix[i][j] + matrix[j][i]);
        // S_x from (5, 1) = +S_x and (4, 2) = −S_x, and so on round.
        let moments = [
            0.5 * (mean(5, 1) - mean(4, 2)),
            0.5 * (mean(3, 2) - mean(5, 0)),
            0.5 * (mean(4, 0) - mean(3, 1)),
        ];
        Self {
            reference_m,
            mass_kg,
            centre_m: std::array::from_fn(|k| reference_m[k] + moments[k] / mass_kg),
            inertia_kg_m2: std::array::from_fn(|i| std::array::from_fn(|j| mean(i + 3, j + 3))),
        }
    }
}

/// What the flanks do when the reference point of the hub moves and the body with it.
///
/// The compliance at a held reference point is that of the held bore: a rigid bore whose six motions are zero is a
/// held bore. A body that sits on a shaft needs these rows beside it, nothing else.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReferencePoint {
    /// Where it is, in the frame of the gear (m).
    pub place_m: [f64; 3],
    /// NᵀR, `[tooth][flank][load][component][motion]`: displacement at a grid load along inward normal, profile
    /// tangential towards the tip, axial +z, per unit motion of the reference point (m/m, and m/rad for rotations). Its
    /// transpose is the force and moment on the point per unit load.
    pub flank: Vec<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mass_matrix_comes_back() {
        let body = RigidBody {
            reference_m: [0.1, -0.2, 0.05],
            mass_kg: 3.0,
            centre_m: [0.3, 0.4, -0.7],
            inertia_kg_m2: [[2.0, 0.1, -0.2], [0.1, 3.0, 0.3], [-0.2, 0.3, 4.0]],
        };
        let matrix = body.mass_matrix();
        let transposed: [[f64; 6]; 6] =
            std::array::from_fn(|i| std::array::from_fn(|j| matrix[j][i]));
        assert_eq!(matrix, transposed);
        let back = RigidBody::from_mass_matrix(&matrix, body.reference_m);
        assert!((back.mass_kg - 3.0).abs() < 1e-15);
        for k in 0..3 {
            assert!((back.centre_m[k] - body.centre_m[k]).abs() < 1e-15);
        }
        assert_eq!(back.inertia_kg_m2, body.inertia_kg_m2);
    }

    /// A point mass that turns about the reference point: its energy is that of ω × r.
    #[test]
    fn a_point_mass_has_the_energy_of_its_velocity() {
        let [x, y, z] = [0.3, -0.4, 1.2];
        let square = x * x + y * y + z * z;
        let r = [x, y, z];
        let body = RigidBody {
            reference_m: [0.0; 3],
            mass_kg: 2.0,
            centre_m: r,
            inertia_kg_m2: std::array::from_fn(|i| {
                std::array::from_fn(|j| 2.0 * (f64::from(u8::from(i == j)) * square - r[i] * r[j]))
            }),
        };
        let motion = [0.1, 0.2, -0.3, 1.0, 0.5, -2.0];
        let [v, w] = [[motion[0], motion[1], motion[2]], [1.0, 0.5, -2.0]];
        let velocity = [
            v[0] + w[1] * z - w[2] * y,
            v[1] + w[2] * x - w[0] * z,
            v[2] + w[0] * y - w[1] * x,
        ];
        let exact: f64 = velocity.iter().map(|c| c * c).sum();
        let matrix = body.mass_matrix();
        let twice: f64 = (0..36)
            .map(|k| motion[k / 6] * matrix[k / 6][k % 6] * motion[k % 6])
            .sum();
        assert!((0.5 * twice - exact).abs() < 1e-14 * exact);
    }
}
