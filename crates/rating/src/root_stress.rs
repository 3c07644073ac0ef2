//! Stress at a root gauge from its strain.

use gearmesh_geometry::Material;

/// What the surface does across the profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceState {
    /// Free to contract: σ = E ε. Near the end faces.
    Uniaxial,
    /// Held by its neighbours along the axis: σ = E ε/(1 − ν²). In the middle of a wide tooth.
    PlaneStrain,
}

/// Stress along the profile \[Pa\] from the strain along the profile (a gauge's history), on a surface without load.
pub fn root_stress_pa(strain: &[f64], material: Material, state: SurfaceState) -> Vec<f64> {
    let modulus_pa = match state {
        SurfaceState::Uniaxial => material.young_pa,
        SurfaceState::PlaneStrain => {
            material.young_pa / (1.0 - material.poisson * material.poisson)
        }
    };
    strain.iter().map(|e| modulus_pa * e).collect()
}
