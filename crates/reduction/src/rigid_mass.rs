//! Rigid motions of a gear and the mass they move.

use crate::gear_body::GearBody;
use crate::repeated_mesh::RepeatedMesh;
use faer::{Mat, MatRef};
use gearmesh_fe::{FeError, mass_moments, mass_product, rigid_motions};
use gearmesh_model::RigidBody;

/// The reference point of every hub: on the axis at mid-face.
pub const REFERENCE_M: [f64; 3] = [0.0; 3];

/// Six unit motions about the reference point, and what they are worth for a density.
pub struct RigidMass {
    /// Density \[kg/m³\].
    pub density_kg_per_m3: f64,
    /// R over all degrees of freedom, bore and stubs of a shaft included: x, y, z, rotations about x, y, z.
    pub motions: Mat<f64>,
    /// M R of the gear.
    pub momenta: Mat<f64>,
    /// RᵀMR of the gear as mass, centre and inertia.
    pub body: RigidBody,
}

impl<M: RepeatedMesh> GearBody<M> {
    /// M X of the gear over all degrees of freedom; stubs of its shaft are not counted.
    ///
    /// # Errors
    /// As [`mass_product`].
    pub fn mass_product(
        &self,
        density_kg_per_m3: f64,
        x: MatRef<'_, f64>,
    ) -> Result<Mat<f64>, FeError> {
        let mut product = mass_product(&self.model, density_kg_per_m3, x)?;
        if let Some(stubs) = &self.stubs {
            let own = Mat::from_fn(3 * stubs.nodes.len(), x.ncols(), |i, j| {
                x[(3 * stubs.nodes[i / 3] as usize + i % 3, j)]
            });
            let of_stubs = mass_product(&stubs.model, density_kg_per_m3, own.as_ref())?;
            for (place, &node) in stubs.nodes.iter().enumerate() {
                let mut rows = product.as_mut().subrows_mut(3 * node as usize, 3);
                rows -= of_stubs.as_ref().subrows(3 * place, 3);
            }
        }
        Ok(product)
    }

    /// The gear as a rigid body, nothing else.
    ///
    /// # Errors
    /// [`FeError::DensityOutOfRange`].
    pub fn rigid_body(&self, density_kg_per_m3: f64) -> Result<RigidBody, FeError> {
        let mut moments = mass_moments(&self.model, density_kg_per_m3)?;
        if let Some(stubs) = &self.stubs {
            let of_stubs = mass_moments(&stubs.model, density_kg_per_m3)?;
            for (moment, of_stubs) in moments.iter_mut().zip(of_stubs) {
                *moment -= of_stubs;
            }
        }
        let [mass_kg, x, y, z, xx, yy, zz, xy, yz, zx] = moments;
        Ok(RigidBody {
            reference_m: REFERENCE_M,
            mass_kg,
            centre_m: [x / mass_kg, y / mass_kg, z / mass_kg],
            inertia_kg_m2: [
                [yy + zz, -xy, -zx],
                [-xy, zz + xx, -yz],
                [-zx, -yz, xx + yy],
            ],
        })
    }

    /// Rigid motions of the gear with what they move.
    ///
    /// # Errors
    /// [`FeError::DensityOutOfRange`].
    pub fn rigid_mass(&self, density_kg_per_m3: f64) -> Result<RigidMass, FeError> {
        let motions = rigid_motions(self.mesh.nodes(), REFERENCE_M);
        let momenta = self.mass_product(density_kg_per_m3, motions.as_ref())?;
        let mass = motions.transpose() * &momenta;
        let mass = std::array::from_fn(|i| std::array::from_fn(|j| mass[(i, j)]));
        Ok(RigidMass {
            density_kg_per_m3,
            body: RigidBody::from_mass_matrix(&mass, REFERENCE_M),
            motions,
            momenta,
        })
    }
}
