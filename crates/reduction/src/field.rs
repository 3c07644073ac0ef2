//! The whole displacement and stress field of a gear under given grid forces: made only when a picture is asked for.
//!
//! Nothing of it is in the reduced model: displacements of all nodes under each unit load would be thousands of times
//! its compliance. The gear is meshed and factorised again and solved for the forces at hand.

use gearmesh_bevel::BevelGear;
use gearmesh_fe::{ElementFormulas, FeError, FeModel, von_mises};
use gearmesh_geometry::{Flank, GearDefinition};
use gearmesh_mesh::BevelMesh;
use gearmesh_model::ReducedGear;
use std::collections::BTreeMap;

use crate::bevel::body::flank_patch;
use crate::bevel::loads::{bevel_grid, bevel_loads};
use crate::bore_patterns::moved_body;
use crate::flank_loads::{GridLoad, SparseVector, flank_grid, flank_loads};
use crate::gear_body::GearBody;
use crate::repeated_mesh::RepeatedMesh;
use crate::tooth_vectors::{on_tooth, summed};
use crate::{Progress, ReductionError, Silent};

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

/// A bore that is not glued to its pin.
#[derive(Debug, Clone, Copy)]
pub struct LooseBore<'a> {
    /// The model with its motions.
    pub model: &'a ReducedGear,
    /// Radial motions that rollers leave it \[m\], in the order of [`gearmesh_model::RadialMotions`]; none: it slides.
    pub radial_m: &'a [f64],
}

/// Displacement at nodes and von Mises stress at element centres.
#[derive(Debug, Clone)]
pub struct Field {
    /// \[x, y, z\] per node \[m\].
    pub displacement_m: Vec<[f64; 3]>,
    /// Per element \[Pa\].
    pub von_mises_pa: Vec<f64>,
}

/// Unit loads of tooth 0 on both sides; empty on a side that no force needs.
pub struct FlankUnits([Vec<GridLoad>; 2]);

impl FlankUnits {
    /// Those of a cylindrical gear.
    ///
    /// # Errors
    /// [`ReductionError::FieldWithCrack`].
    pub fn of_gear(
        gear: &GearDefinition,
        body: &GearBody,
        sides: &[Flank],
    ) -> Result<Self, ReductionError> {
        if gear.crack.is_some() {
            return Err(ReductionError::FieldWithCrack);
        }
        let grid = flank_grid(gear);
        let mut units = Self(Default::default());
        for &side in sides {
            units.0[side as usize] = flank_loads(gear, &body.mesh, &grid, 0, side);
        }
        Ok(units)
    }

    /// Those of a bevel gear.
    ///
    /// # Errors
    /// [`ReductionError::Mesh`] where the tool leaves no surface.
    pub fn of_bevel(
        gear: &BevelGear,
        mesh: &BevelMesh,
        sides: &[Flank],
    ) -> Result<Self, ReductionError> {
        let grid = bevel_grid(gear);
        let mut units = Self(Default::default());
        for &side in sides {
            let patch = flank_patch(gear, side)?;
            units.0[side as usize] = bevel_loads(mesh, &patch, side, &grid);
        }
        Ok(units)
    }

    /// Nodal forces \[N\] on the whole mesh.
    fn on_mesh(&self, mesh: &impl RepeatedMesh, forces: &[GridForce]) -> SparseVector {
        let mut of_tooth: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new();
        for force in forces {
            let unit = &self.0[force.side as usize][force.load];
            let entries = of_tooth.entry(force.tooth).or_default();
            for (part, amount) in [
                (&unit.normal, force.normal_n),
                (&unit.tangential, force.tangential_n),
            ] {
                if amount != 0.0 {
                    entries.extend(part.iter().map(|&(dof, value)| (dof, amount * value)));
                }
            }
        }
        let turned = of_tooth
            .into_iter()
            .flat_map(|(tooth, entries)| on_tooth(mesh, &summed(entries), tooth));
        summed(turned.collect())
    }

    /// Solves K d = f for each set of grid forces and hands the displacements of all degrees of freedom \[m\] to
    /// `each`.
    ///
    /// # Panics
    /// If a force stands on a side whose units were not asked for.
    pub fn solve_each(
        &self,
        body: &GearBody<impl RepeatedMesh>,
        cases: &[Vec<GridForce>],
        each: impl FnMut(usize, &[f64]),
    ) {
        let on_mesh = |case: &Vec<GridForce>| self.on_mesh(&body.mesh, case);
        let rows: Vec<SparseVector> = cases.iter().map(on_mesh).collect();
        body.solve_each(&rows.iter().collect::<Vec<_>>(), &Silent, each);
    }

    /// Displacement of all degrees of freedom of a cylindrical gear \[m\], on a bore that is held or not.
    ///
    /// # Errors
    /// [`ReductionError::Bore`] for a model without motions of its bore, [`ReductionError::Fe`] when an element cannot
    /// be used.
    ///
    /// # Panics
    /// As [`Self::solve_each`].
    pub fn displacement_m(
        &self,
        body: &GearBody,
        forces: &[GridForce],
        bore: Option<LooseBore<'_>>,
    ) -> Result<Vec<f64>, ReductionError> {
        let mut displacement_m = Vec::new();
        self.solve_each(body, &[forces.to_vec()], |_, u| {
            displacement_m.extend_from_slice(u);
        });
        let Some(LooseBore { model, radial_m }) = bore else {
            return Ok(displacement_m);
        };
        let on_flank = |f: &GridForce| (f.tooth, f.side, f.load, f.normal_n);
        let on_flanks: Vec<_> = forces.iter().map(on_flank).collect();
        let motions_m = model.bore_motions_m(&on_flanks, radial_m)?;
        if let Some(patterns) = &model.bore {
            let moved = moved_body(body, patterns, &motions_m)?;
            for (sum, moved) in displacement_m.iter_mut().zip(&moved) {
                *sum += moved;
            }
        }
        Ok(displacement_m)
    }

    /// What rows g of nodal weights read under each unit load of one side, on every tooth: gᵀK⁻¹p,
    /// `[row][tooth][component][load]`, components normal and tangential. No field is made for it.
    pub fn readings(
        &self,
        body: &GearBody<impl RepeatedMesh>,
        side: Flank,
        rows: &[SparseVector],
        progress: &dyn Progress,
    ) -> Vec<Vec<f64>> {
        let loads = &self.0[side as usize];
        let normal = loads.iter().map(|load| &load.normal);
        let vectors: Vec<&SparseVector> = normal
            .chain(loads.iter().map(|load| &load.tangential))
            .collect();
        let rows: Vec<&SparseVector> = rows.iter().collect();
        body.readings(&rows, &vectors, progress)
    }

    /// The fields of some sets of grid forces.
    ///
    /// # Errors
    /// [`ReductionError::Fe`] when an element's strain cannot be taken.
    ///
    /// # Panics
    /// As [`Self::solve_each`].
    pub fn fields(
        &self,
        body: &GearBody<impl RepeatedMesh>,
        cases: &[Vec<GridForce>],
    ) -> Result<Vec<Field>, ReductionError> {
        let mut displacements = Vec::with_capacity(cases.len());
        self.solve_each(body, cases, |_, u| displacements.push(u.to_vec()));
        displacements
            .into_iter()
            .map(|u| Field::new(&body.model, &u))
            .collect()
    }
}

impl Field {
    /// That of displacements of all degrees of freedom \[m\].
    ///
    /// # Errors
    /// [`ReductionError::Fe`] when an element's strain cannot be taken.
    pub fn new(model: &FeModel, u: &[f64]) -> Result<Self, ReductionError> {
        let at_centre = |e: usize| {
            let strain = model.strain(e, model.element_of(e).centre(), u)?;
            Ok(von_mises(&model.material().stress(&strain)))
        };
        let von_mises_pa = (0..model.element_count())
            .map(at_centre)
            .collect::<Result<_, FeError>>()?;
        Ok(Self {
            displacement_m: u.chunks_exact(3).map(|d| [d[0], d[1], d[2]]).collect(),
            von_mises_pa,
        })
    }
}

/// The fields of a cylindrical gear under some sets of grid forces.
///
/// # Errors
/// [`ReductionError::Fe`] when an element's strain cannot be taken, [`ReductionError::FieldWithCrack`].
pub fn fields(
    gear: &GearDefinition,
    body: &GearBody,
    cases: &[Vec<GridForce>],
) -> Result<Vec<Field>, ReductionError> {
    FlankUnits::of_gear(gear, body, &sides(cases))?.fields(body, cases)
}

/// The same of a bevel gear.
///
/// # Errors
/// [`ReductionError::Fe`] when an element's strain cannot be taken, [`ReductionError::Mesh`] where the tool leaves no
/// surface.
pub fn bevel_fields(
    gear: &BevelGear,
    body: &GearBody<BevelMesh>,
    cases: &[Vec<GridForce>],
) -> Result<Vec<Field>, ReductionError> {
    FlankUnits::of_bevel(gear, &body.mesh, &sides(cases))?.fields(body, cases)
}

/// The sides that forces stand on.
fn sides(cases: &[Vec<GridForce>]) -> Vec<Flank> {
    let stands = |side: &Flank| cases.iter().flatten().any(|f| f.side == *side);
    Flank::ALL.into_iter().filter(stands).collect()
}
