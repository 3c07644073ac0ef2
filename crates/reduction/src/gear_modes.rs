//! Natural modes of a gear held at its bore: the search by harmonics or in the whole gear, and what each mode is like.
//!
//! A gear that repeats is searched harmonic by harmonic, on the nodes of one sector (`harmonic_problem.rs`). Wanted by
//! number, it takes two passes: the lowest of each harmonic give a frequency below which as many modes lie, and then
//! each harmonic that might have more below it is searched up to it.

use crate::cyclic_body::CyclicBody;
use crate::gear_body::{GearBody, Solver};
use crate::harmonic_problem::{HarmonicProblem, SectorMass};
use crate::mode_figures::{GearMode, ModeFigures};
use crate::repeated_mesh::RepeatedMesh;
use crate::rigid_mass::RigidMass;
use crate::{Progress, ReductionError};
use gearmesh_fe::{
    FeError, ModeProblem, ModeSettings, NaturalModes, WantedModes, assemble_mass, search_modes,
};
use gearmesh_geometry::ModeRange;
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Frequencies squared closer than this, relative, belong together: a count does not part them.
const SAME: f64 = 1e-6;

/// Vectors that are carried on together in one harmonic: pairs of pairs.
const BLOCK: usize = 4;

/// Natural modes, lowest first.
#[derive(Debug, Clone)]
pub struct GearModes {
    /// The modes.
    pub modes: Vec<GearMode>,
    /// All modes up to this frequency \[Hz\] are there.
    pub complete_to_hz: f64,
    /// Vectors that K was solved for.
    pub solves: usize,
}

/// A mode as it was found.
struct Found {
    omega_squared: f64,
    residual: f64,
    harmonic: usize,
    /// In the unknowns of its problem, modal mass 1 there.
    shape: Vec<f64>,
}

/// The modes found in one problem.
fn found(modes: &NaturalModes, harmonic: usize) -> Vec<Found> {
    (0..modes.omega_squared.len())
        .map(|mode| Found {
            omega_squared: modes.omega_squared[mode],
            residual: modes.relative_residuals[mode],
            harmonic,
            shape: modes.shapes.col(mode).iter().copied().collect(),
        })
        .collect()
}

fn up_to(hz: f64) -> WantedModes {
    WantedModes::UpTo((TAU * hz).powi(2))
}

/// Sorted, and cut behind the wanted ones.
fn wanted(mut all: Vec<Found>, range: ModeRange) -> Vec<Found> {
    all.sort_by(|a, b| a.omega_squared.total_cmp(&b.omega_squared));
    if let ModeRange::Count(count) = range {
        let mut end = count.min(all.len());
        while end < all.len() && all[end].omega_squared < all[end - 1].omega_squared * (1.0 + SAME)
        {
            end += 1;
        }
        all.truncate(end);
    }
    all
}

impl<M: RepeatedMesh> GearBody<M> {
    /// Finds the natural modes in a range and hands each with its full field (Cartesian
    /// displacements of all nodes, modal mass 1) to `each`.
    ///
    /// Where the gear repeats, a pair of equal frequencies is two shapes turned against each other by a quarter period;
    /// how they lie against the teeth is arbitrary.
    ///
    /// # Errors
    /// [`ReductionError::ModesInPlaneStrain`]; [`ReductionError::NoModes`] where there are none in the range;
    /// [`ReductionError::Fe`] when the search does not converge.
    pub fn natural_modes(
        &self,
        rigid: &RigidMass,
        range: ModeRange,
        progress: &dyn Progress,
        mut each: impl FnMut(usize, &GearMode, &[f64]),
    ) -> Result<GearModes, ReductionError> {
        if self.is_plane() {
            return Err(ReductionError::ModesInPlaneStrain);
        }
        progress.stage("natural modes");
        let density = rigid.density_kg_per_m3;
        let figures = ModeFigures::new(&self.mesh, &self.model, &rigid.momenta)?;
        let mut modes = Vec::new();
        let mut finish = |found: &Found, field: &[f64]| {
            let mode = figures.of(found.omega_squared, found.residual, field);
            each(modes.len(), &mode, field);
            modes.push(mode);
        };
        let solves = match &self.solver {
            Solver::Whole(whole) => {
                let m = assemble_mass(&self.model, &self.dofs, density)?;
                let settings = ModeSettings {
                    wanted: match range {
                        // One more, to see whether the last one is the first of a pair.
                        ModeRange::Count(count) => {
                            WantedModes::Lowest((count + 1).min(self.dofs.free_count()))
                        }
                        ModeRange::UpToHz(hz) => up_to(hz),
                    },
                    ..ModeSettings::new(1)
                };
                let result = whole.natural_modes(&m, &settings)?;
                for mode in wanted(found(&result, 0), range) {
                    finish(&mode, &self.dofs.expand(&mode.shape));
                }
                result.solves
            }
            Solver::Cyclic(body) => {
                let fixed: Vec<bool> = (0..self.model.node_count())
                    .map(|node| self.dofs.free_of(3 * node).is_none())
                    .collect();
                let mass = SectorMass::new(body, &self.mesh, &self.model, &fixed, density)?;
                let (all, solves) = by_harmonics(&mass, range, progress)?;
                for mode in wanted(all, range) {
                    let problem = mass.harmonic(mode.harmonic);
                    finish(&mode, &full_field(body, self, &problem, &mode.shape));
                }
                solves
            }
        };
        let Some(last) = modes.last() else {
            let up_to_hz = match range {
                ModeRange::UpToHz(hz) => hz,
                ModeRange::Count(_) => 0.0,
            };
            return Err(ReductionError::NoModes { up_to_hz });
        };
        Ok(GearModes {
            complete_to_hz: match range {
                ModeRange::UpToHz(hz) => hz,
                ModeRange::Count(_) => last.frequency_hz(),
            },
            modes,
            solves,
        })
    }
}

/// Modes of all harmonics in a range (more where it is a number), and how many vectors were solved for.
fn by_harmonics(
    mass: &SectorMass<'_>,
    range: ModeRange,
    progress: &dyn Progress,
) -> Result<(Vec<Found>, usize), FeError> {
    let harmonics = mass.harmonics();
    let (done, solves) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let passes = match range {
        ModeRange::Count(_) => 2,
        ModeRange::UpToHz(_) => 1,
    };
    let finished = |modes: Vec<Found>| {
        let count = done.fetch_add(1, Ordering::Relaxed) + 1;
        progress.advance(count, passes * harmonics);
        modes
    };
    let search = |k: usize, wanted: WantedModes| {
        let settings = ModeSettings {
            wanted,
            block: BLOCK,
            ..ModeSettings::new(1)
        };
        let modes = search_modes(&mass.harmonic(k), &settings)?;
        solves.fetch_add(modes.solves, Ordering::Relaxed);
        Ok::<_, FeError>(found(&modes, k))
    };
    let all: Vec<Vec<Found>> = match range {
        ModeRange::UpToHz(hz) => (0..harmonics)
            .into_par_iter()
            .map(|k| search(k, up_to(hz)).map(finished))
            .collect::<Result<_, _>>()?,
        ModeRange::Count(count) => {
            let members = |k: usize| mass.harmonic(k).multiplicity();
            let round: usize = (0..harmonics).map(members).sum();
            let lowest: Vec<Vec<Found>> = (0..harmonics)
                .into_par_iter()
                .map(|k| {
                    let some = members(k) * count.div_ceil(round);
                    let some = WantedModes::Lowest(some.min(mass.harmonic(k).size()));
                    search(k, some).map(finished)
                })
                .collect::<Result<_, _>>()?;
            let squares = lowest.iter().flatten().map(|mode| mode.omega_squared);
            let mut squares: Vec<f64> = squares.collect();
            squares.sort_by(f64::total_cmp);
            // As many modes as wanted lie below this.
            let bound = squares[count.min(squares.len()) - 1] * (1.0 + SAME);
            lowest
                .into_par_iter()
                .enumerate()
                .map(|(k, modes)| {
                    let beyond = modes.last().is_some_and(|m| m.omega_squared > bound);
                    let modes = if beyond {
                        Ok(modes)
                    } else {
                        search(k, WantedModes::UpTo(bound))
                    };
                    modes.map(finished)
                })
                .collect::<Result<_, _>>()?
        }
    };
    Ok((all.into_iter().flatten().collect(), solves.into_inner()))
}

/// The field of a harmonic's shape in the whole gear.
fn full_field(
    body: &CyclicBody,
    gear: &GearBody<impl RepeatedMesh>,
    problem: &HarmonicProblem<'_>,
    shape: &[f64],
) -> Vec<f64> {
    let mut field = vec![0.0; 3 * gear.mesh.nodes().len()];
    let scale = problem.scale();
    let mut put = |nodes: &[u32], values: &[f64]| {
        for (&node, part) in nodes.iter().zip(values.chunks_exact(3)) {
            let node = node as usize;
            let part = [scale * part[0], scale * part[1], scale * part[2]];
            field[3 * node..3 * node + 3].copy_from_slice(&body.frames.to_cartesian(node, part));
        }
    };
    for sector in 0..body.sector.sectors {
        let (of_sector, of_teeth) = problem.in_sector(shape, sector);
        put(body.sector.nodes(sector), &of_sector);
        for (a, values) in of_teeth.iter().enumerate() {
            put(body.tooth.nodes(body.sector.tooth(sector, a)), values);
        }
    }
    field
}
