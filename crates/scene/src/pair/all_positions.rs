//! All positions of a pair under all torques, whatever the family of its flanks, and the curves of a result that they
//! make.

use super::between_positions::{BetweenPositions, Found, find};
use super::contact_places::{ContactPlaces, PatchPlace};
use super::position::{Measures, Position, PositionSolver};
use super::result::{LineForces, PairSolution, PairSource, SceneResult};
use super::run::RunError;
use super::warnings::{ASSUMPTIONS, Warnings};
use gearmesh_contact::{FlanksAtRest, StaticContact};
use gearmesh_model::utc_now;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// What is solved.
pub(super) struct Positions<'a> {
    /// Torques on gear 2 \[N·m\].
    pub torques_nm: &'a [f64],
    /// Driver angles of the even grid \[rad\].
    pub angles_rad: &'a [f64],
    /// Angles between which others are sought, from the first one on: a period.
    pub looked_at: usize,
    /// Whether the pair repeats after them.
    pub repeats: bool,
    /// What the positions are measured by.
    pub measures: Measures<'a>,
}

/// How far it is, and what ends it early.
pub(super) struct Watched<'a> {
    /// Hears of each finished torque: done, total.
    pub progress: &'a (dyn Fn(usize, usize) + Sync),
    pub stop: &'a AtomicBool,
    pub solved: &'a AtomicUsize,
}

/// All positions of one torque: those of the even grid, and those between.
pub(super) struct TorquePositions {
    pub even: Vec<Position>,
    pub between: Found,
}

impl TorquePositions {
    pub fn all(&self) -> impl Iterator<Item = &Position> {
        self.even.iter().chain(&self.between.positions)
    }

    pub fn all_mut(&mut self) -> impl Iterator<Item = &mut Position> {
        self.even.iter_mut().chain(&mut self.between.positions)
    }
}

impl Positions<'_> {
    /// Solves them; torques run in parallel, each warm from angle to angle. `contact`: one for each torque, which
    /// counts the transmission error at `radius_2_m`.
    ///
    /// # Errors
    /// [`RunError`] when a position has no solution; [`RunError::Stopped`].
    pub fn solve<F: FlanksAtRest>(
        &self,
        contact: impl Fn() -> StaticContact<F> + Sync,
        radius_2_m: f64,
        watched: &Watched<'_>,
    ) -> Result<Vec<TorquePositions>, RunError> {
        let done = AtomicUsize::new(0);
        let torque = |&torque_nm: &f64| {
            let mut solver = PositionSolver {
                contact: contact(),
                torque_nm,
                radius_2_m,
                measures: &self.measures,
                stop: watched.stop,
            };
            let even = self.angles_rad.iter().map(|angle| {
                let position = solver.at(*angle)?;
                watched.solved.fetch_add(1, Ordering::Relaxed);
                Ok(position)
            });
            let even = even.collect::<Result<Vec<Position>, RunError>>()?;
            let between = find(&mut solver, &even[..self.looked_at], self.repeats)?;
            let finished = done.fetch_add(1, Ordering::Relaxed) + 1;
            (watched.progress)(finished, self.torques_nm.len());
            Ok(TorquePositions { even, between })
        };
        self.torques_nm.par_iter().map(torque).collect()
    }
}

/// The curves of a result, at least so many contact lines wide, and its warnings.
pub(super) fn curves(
    torques_nm: &[f64],
    found: Vec<TorquePositions>,
    (least_slots, slices): (usize, usize),
) -> SceneResult {
    let warnings = strained_assumptions(torques_nm, &found);
    let first = || found.iter().take(1).flat_map(|found| &found.even);
    let pairs = pairs_of_angles(&found);
    let slots = pairs.iter().map(Vec::len).fold(least_slots, usize::max);
    let flatten = |part: fn(&Position) -> f64| -> Vec<f64> {
        let even = found.iter().flat_map(|found| &found.even);
        even.map(part).collect()
    };
    let on_lines = |part: fn(&Position) -> &Vec<f64>| {
        let block = slots * slices;
        let mut all = vec![0.0; found.len() * pairs.len() * block];
        let positions = found.iter().flat_map(|found| found.even.iter().zip(&pairs));
        for ((p, pairs), block) in positions.zip(all.chunks_exact_mut(block)) {
            for (pair, own) in p.pairs.iter().zip(part(p).chunks_exact(slices)) {
                let slot = pairs.iter().position(|known| known == pair);
                let slot = slot.map_or(0, |slot| slot * slices);
                block[slot..slot + slices].copy_from_slice(own);
            }
        }
        all
    };
    let of_torques = |part: fn(&Position) -> f64| -> Vec<f64> {
        let largest = |found: &TorquePositions| found.all().map(part).fold(0.0, f64::max);
        found.iter().map(largest).collect()
    };
    let iterations = |found: &TorquePositions| {
        let even = found.even.iter();
        even.map(|position| position.iterations as u32).sum()
    };
    SceneResult {
        source: PairSource {
            version: env!("CARGO_PKG_VERSION").into(),
            created_utc: utc_now(),
            ..PairSource::default()
        },
        torque_nm: torques_nm.to_vec(),
        angle_rad: first().map(|p| p.angle_rad).collect(),
        te_m: flatten(|p| p.te_m),
        unloaded_m: first().map(|p| p.unloaded_m).collect(),
        torque_1_nm: flatten(|p| p.torque_1_nm),
        axial_force_1_n: flatten(|p| p.axial_1_n),
        secant_n_per_m: flatten(|p| p.secant_n_per_m),
        tangent_n_per_m: flatten(|p| p.tangent_n_per_m),
        lines: LineForces {
            slots,
            slices,
            pair_count: pairs.iter().map(|pairs| pairs.len() as u32).collect(),
            pair: (pairs.iter())
                .flat_map(|pairs| (0..slots).map(|k| pairs.get(k).map_or(0.0, |pair| *pair as f64)))
                .collect(),
            force_n: on_lines(|p| &p.force_n),
            pressure_pa: on_lines(|p| &p.pressure_pa),
            places: stored_places(&found, &pairs, (slots, slices)),
            k_h_beta: of_torques(|p| p.k_h_beta),
        },
        solution: PairSolution {
            iterations: found.iter().map(iterations).collect(),
            residual: of_torques(|p| p.residual),
            torque_balance: of_torques(|p| p.torque_balance),
            seconds: [0.0; 2],
        },
        between: BetweenPositions::new(
            found.into_iter().map(|found| found.between).collect(),
            slices,
        ),
        warnings: warnings.sentences(),
        ..SceneResult::default()
    }
}

/// Where the model's assumptions are strained most.
fn strained_assumptions(torques_nm: &[f64], found: &[TorquePositions]) -> Warnings {
    let mut warnings = Warnings::default();
    for (torque, found) in torques_nm.iter().zip(found) {
        for position in found.all() {
            for (assumption, value) in ASSUMPTIONS.into_iter().zip(position.strained) {
                warnings.note(assumption, value, *torque);
            }
        }
    }
    warnings
}

/// Pairs of teeth at each even angle: under another torque other lines may be near.
fn pairs_of_angles(found: &[TorquePositions]) -> Vec<Vec<i64>> {
    let angles = found.first().map_or(0, |found| found.even.len());
    let of_angle = |angle: usize| {
        let mut all: Vec<i64> = Vec::new();
        for pair in found.iter().flat_map(|found| &found.even[angle].pairs) {
            if !all.contains(pair) {
                all.push(*pair);
            }
        }
        all
    };
    (0..angles).map(of_angle).collect()
}

/// Places of families that store them with each position: a slice touches in one place, under whichever torque.
fn stored_places(
    found: &[TorquePositions],
    pairs: &[Vec<i64>],
    (slots, slices): (usize, usize),
) -> Option<ContactPlaces> {
    let mut all: Option<ContactPlaces> = None;
    for (angle, pairs) in pairs.iter().enumerate() {
        let mut block = vec![PatchPlace::default(); slots * slices];
        for p in found.iter().map(|found| &found.even[angle]) {
            for (pair, own) in p.pairs.iter().zip(p.places.chunks_exact(slices)) {
                let slot = pairs.iter().position(|known| known == pair)?;
                let touching = |place: &PatchPlace| *place != PatchPlace::default();
                for (to, place) in block[slot * slices..].iter_mut().zip(own) {
                    if touching(place) {
                        *to = *place;
                    }
                }
            }
        }
        if found
            .iter()
            .any(|found| !found.even[angle].places.is_empty())
        {
            let size = block.len();
            all.get_or_insert_default().push(block.into_iter(), size);
        }
    }
    all
}
