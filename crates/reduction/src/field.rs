//! The whole displacement and stress field of a gear under given grid forces: made only when a picture is asked for.

use crate::flank_loads::{SparseVector, flank_grid, flank_loads};
use crate::gear_body::GearBody;
use crate::{ReductionError, Silent};
use gearmesh_fe::{ElementFormulas, von_mises};
use gearmesh_geometry::{Flank, GearDefinition};

/// A force on one grid load: tooth, side, load number, normal and tangential (towards the tip) part \[N\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridForce {
    /// Tooth.
    pub tooth: usize,
    /// Side.
    pub side: Flank,
    /// Load number on the flank grid.
    pub load: usize,
    /// Along the inward normal.
    pub normal_n: f64,
    /// Along the profile towards the tip.
    pub tangential_n: f64,
}

/// Displacement at nodes and von Mises stress at element centres.
#[derive(Debug, Clone)]
pub struct Field {
    /// \[x, y, z\] per node \[m\].
    pub displacement_m: Vec<[f64; 3]>,
    /// Per element \[Pa\].
    pub von_mises_pa: Vec<f64>,
}

/// Solves K d = f for each set of grid forces.
///
/// # Errors
/// [`ReductionError::Fe`] when an element's strain cannot be taken, [`ReductionError::FieldWithCrack`].
pub fn fields(
    gear: &GearDefinition,
    body: &GearBody,
    cases: &[Vec<GridForce>],
) -> Result<Vec<Field>, ReductionError> {
    if gear.crack.is_some() {
        return Err(ReductionError::FieldWithCrack);
    }
    let grid = flank_grid(gear);
    let mut rows: Vec<SparseVector> = Vec::with_capacity(cases.len());
    for case in cases {
        let mut total: std::collections::BTreeMap<usize, f64> = Default::default();
        let mut teeth: Vec<(usize, Flank)> = case.iter().map(|f| (f.tooth, f.side)).collect();
        teeth.sort_unstable();
        teeth.dedup();
        for (tooth, side) in teeth {
            let loads = flank_loads(gear, &body.mesh, &grid, tooth, side);
            for force in case.iter().filter(|f| (f.tooth, f.side) == (tooth, side)) {
                let load = &loads[force.load];
                for (part, amount) in [
                    (&load.normal, force.normal_n),
                    (&load.tangential, force.tangential_n),
                ] {
                    for &(dof, value) in part {
                        *total.entry(dof).or_default() += amount * value;
                    }
                }
            }
        }
        rows.push(total.into_iter().collect());
    }
    let mut displacements = Vec::with_capacity(cases.len());
    body.solve_each(&rows.iter().collect::<Vec<_>>(), &Silent, |_, u| {
        displacements.push(u.to_vec())
    });
    displacements
        .into_iter()
        .map(|u| {
            let von_mises_pa = (0..body.mesh.elements.len())
                .map(|e| {
                    let strain = body
                        .model
                        .strain(e, body.model.element_of(e).centre(), &u)?;
                    Ok(von_mises(&body.model.material().stress(&strain)))
                })
                .collect::<Result<Vec<f64>, gearmesh_fe::FeError>>()?;
            Ok(Field {
                displacement_m: u.chunks_exact(3).map(|d| [d[0], d[1], d[2]]).collect(),
                von_mises_pa,
            })
        })
        .collect()
}
