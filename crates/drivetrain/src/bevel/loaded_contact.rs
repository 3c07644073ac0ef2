//! Loaded tooth contact analysis of a bevel pair: the pair at rest under a torque, position by position over a pitch.
//!
//! The transmission error is counted as in the tooth contact analysis: in radians of the gear, positive where it leads, zero at
//! the position without load where it leads most. Without load it is the largest of −(gap without approach)/lever over all slices.

use std::f64::consts::TAU;

use gearmesh_bevel::{Assembly, AssemblyError, FlankSide, PairBlank};
use gearmesh_contact::slice_contact::SliceContact;
use gearmesh_contact::{ContactPatch, Drive, StaticContact};
use gearmesh_geometry::Flank;
use nalgebra::Matrix3;

use super::loaded_between::between;
use super::sliced_mesh::BevelSlices;
use super::tooth_side::about_z;
use crate::error::DrivetrainError;
use crate::pose::Pose;
use crate::posed_flanks::PosedFlanks;

/// Sections that stand open by more at the start are not looked at first \[m\].
const FIRST_REACH_M: f64 = 60e-6;
/// How often that is doubled at most.
const DOUBLINGS: usize = 5;

/// A patch that carries load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadedPatch {
    /// Teeth of pinion and gear.
    pub teeth: [usize; 2],
    /// Shares of the way along the face, toe to heel, and up the flank, on pinion and gear.
    pub places: [[f64; 2]; 2],
    /// Normal force \[N\].
    pub force_n: f64,
    /// Length along the line \[m\].
    pub length_m: f64,
    /// Half width of the contact \[m\].
    pub half_width_m: f64,
    /// Peak pressure across the line \[Pa\].
    pub pressure_pa: f64,
    /// Whether the tip of either gear holds it.
    pub on_tip: bool,
    /// Sliding speed of both flanks there over the pinion's speed \[m/rad\], gears turning at the teeth's ratio.
    pub sliding_m: f64,
    /// How far from its middle the nearer tip of both gears is \[m\], up the flank.
    pub to_tip_m: f64,
}

/// One position.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedPosition {
    /// Turn of the pinion about its axis \[rad\].
    pub pinion_turn_rad: f64,
    /// Transmission error \[rad of the gear\].
    pub error_rad: f64,
    /// The same without load.
    pub unloaded_rad: f64,
    /// What carries.
    pub patches: Vec<LoadedPatch>,
}

impl LoadedPosition {
    /// Normal force of each pair of teeth \[N\], the most loaded one first.
    #[must_use]
    pub fn pair_forces_n(&self) -> Vec<([usize; 2], f64)> {
        let mut pairs: Vec<([usize; 2], f64)> = Vec::new();
        for patch in &self.patches {
            match pairs.iter_mut().find(|(teeth, _)| *teeth == patch.teeth) {
                Some((_, force)) => *force += patch.force_n,
                None => pairs.push((patch.teeth, patch.force_n)),
            }
        }
        pairs.sort_by(|a, b| b.1.total_cmp(&a.1));
        pairs
    }
}

/// A pair under one torque.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedContact {
    /// Torque on the gear \[N·m\].
    pub torque_nm: f64,
    /// Even positions over one pitch.
    pub positions: Vec<LoadedPosition>,
    /// Positions between them, by the turn: where pairs of teeth take load or give it up, and at the extremes of the
    /// transmission error.
    pub between: Vec<LoadedPosition>,
}

/// Largest less smallest.
fn spread(values: impl Iterator<Item = f64> + Clone) -> f64 {
    values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
}

impl LoadedContact {
    /// Mean transmission error \[rad\].
    #[must_use]
    pub fn mean_rad(&self) -> f64 {
        let sum: f64 = self.positions.iter().map(|p| p.error_rad).sum();
        sum / self.positions.len() as f64
    }

    /// Even positions and those between them.
    pub fn all_positions(&self) -> impl Iterator<Item = &LoadedPosition> + Clone {
        self.positions.iter().chain(&self.between)
    }

    /// Transmission error peak to peak \[rad\], the positions between the even ones included.
    #[must_use]
    pub fn peak_to_peak_rad(&self) -> f64 {
        spread(self.all_positions().map(|p| p.error_rad))
    }

    /// The same without load.
    #[must_use]
    pub fn unloaded_peak_to_peak_rad(&self) -> f64 {
        spread(self.all_positions().map(|p| p.unloaded_rad))
    }

    /// All patches of all positions.
    pub fn patches(&self) -> impl Iterator<Item = &LoadedPatch> {
        self.positions.iter().flat_map(|p| &p.patches)
    }

    /// Largest pressure \[Pa\]: of all patches; of those that no tip holds; of those whose whole width is clear of the tips, where Hertz's pressure has the room
    /// that it asks for.
    #[must_use]
    pub fn pressures_pa(&self) -> [f64; 3] {
        let largest = |counts: fn(&&LoadedPatch) -> bool| {
            let patches = self.patches().filter(counts);
            patches.fold(0.0, |most: f64, patch| most.max(patch.pressure_pa))
        };
        [
            largest(|_| true),
            largest(|patch| !patch.on_tip),
            largest(|patch| !patch.on_tip && patch.to_tip_m >= patch.half_width_m),
        ]
    }

    /// Share of the load that the most loaded pair of teeth carries, least and largest over the positions.
    #[must_use]
    pub fn load_shares(&self) -> [f64; 2] {
        let shares = self.positions.iter().map(|p| {
            let pairs = p.pair_forces_n();
            let all: f64 = pairs.iter().map(|(_, force)| force).sum();
            pairs.first().map_or(1.0, |(_, first)| first / all)
        });
        let least = shares.clone().fold(f64::INFINITY, f64::min);
        [least, shares.fold(0.0, f64::max)]
    }

    /// Pairs of teeth that carry, in the mean.
    #[must_use]
    pub fn mean_pairs(&self) -> f64 {
        let pairs = self.positions.iter().map(|p| p.pair_forces_n().len());
        pairs.sum::<usize>() as f64 / self.positions.len() as f64
    }

    /// Part of the normal forces' sum that tips carry.
    #[must_use]
    pub fn tip_share(&self) -> f64 {
        let sum = |on_tip: bool| -> f64 {
            let patches = self.patches().filter(|patch| !on_tip || patch.on_tip);
            patches.map(|patch| patch.force_n).sum()
        };
        // A sum of nothing is -0.0.
        (sum(true) + 0.0) / sum(false)
    }

    /// Share of the power that reaches the gear's shaft over the positions, with a coefficient of friction μ of the
    /// teeth: at each position 1/(1 + μ Σ F v/(T z₁/z₂)), F the normal forces and v their sliding for each radian of
    /// the pinion. Friction moves no load here.
    #[must_use]
    pub fn efficiency(&self, friction: f64, ratio: f64) -> f64 {
        let output = self.torque_nm * ratio;
        let of = |p: &LoadedPosition| {
            let lost: f64 = p.patches.iter().map(|at| at.force_n * at.sliding_m).sum();
            1.0 / (1.0 + friction * lost / output)
        };
        self.positions.iter().map(of).sum::<f64>() / self.positions.len() as f64
    }

    /// Where the pattern begins and ends on the gear's flank: along the face and up the flank, as shares, of all patches that press with at least a
    /// hundredth of the largest pressure, whole slices counted.
    #[must_use]
    pub fn pattern(&self, slices: usize) -> [[f64; 2]; 2] {
        let least_pa = 0.01 * self.pressures_pa()[0];
        let (mut along, mut up) = ([f64::INFINITY, 0.0], [f64::INFINITY, 0.0]);
        for patch in self.patches().filter(|p| p.pressure_pa >= least_pa) {
            let [s, v] = patch.places[1];
            let half = 0.5 / slices as f64;
            along = [
                along[0].min((s - half).max(0.0)),
                along[1].max((s + half).min(1.0)),
            ];
            up = [up[0].min(v), up[1].max(v)];
        }
        [along, up]
    }
}

/// A bevel pair that is to be loaded.
pub struct LoadedPair<'a> {
    /// Blank of both members.
    pub blank: &'a PairBlank,
    /// Their flanks in slices.
    pub flanks: &'a BevelSlices,
    /// Flank of the pinion that drives.
    pub pinion_flank: FlankSide,
    /// How the members stand off their design.
    pub error: AssemblyError,
    /// Positions over a pitch.
    pub positions: usize,
}

impl LoadedPair<'_> {
    /// Side of the teeth that touches.
    #[must_use]
    pub fn side(&self) -> Flank {
        // Right flanks face clockwise.
        match self.pinion_flank.facing(self.blank.members[0].hand) < 0.0 {
            true => Flank::Right,
            false => Flank::Left,
        }
    }

    /// Where gear 2 stands when both gears have turned by these angles.
    fn pose(&self, turns_rad: [f64; 2]) -> Pose {
        let assembly = Assembly::new(self.blank, &self.error);
        let axes = [0, 1]
            .map(|m: usize| -> Matrix3<f64> { assembly.members[m].axes * about_z(turns_rad[m]) });
        let apart = assembly.members[1].apex_m - assembly.members[0].apex_m;
        let back = axes[0].transpose();
        Pose::at_rest(back * apart, back * axes[1])
    }

    /// Loads the pair by torques on the gear \[N·m\]; `contact`: what deflects on [`Self::side`], with all its memory.
    ///
    /// # Errors
    /// [`DrivetrainError::Contact`] where no contact is found or the solver does not converge.
    pub fn loaded(
        &self,
        contact: &SliceContact,
        torques_nm: &[f64],
    ) -> Result<Vec<LoadedContact>, DrivetrainError> {
        let teeth = self.flanks.pair().teeth();
        let (side, ratio) = (self.side(), teeth[0] as f64 / teeth[1] as f64);
        let lever_m = self.flanks.pair().levers_m()[1];
        let pitch = TAU / teeth[0] as f64;
        let azimuths = self.flanks.pair().azimuths_rad(side);
        // The mean points of both flanks in the plane of the axes at turn 0, and in contact where the assembly is as designed.
        let pose_at = |turn: f64| self.pose([turn - azimuths[0], -ratio * turn - azimuths[1]]);
        let mut found: Vec<LoadedContact> = torques_nm
            .iter()
            .map(|torque| LoadedContact {
                torque_nm: *torque,
                positions: Vec::with_capacity(self.positions),
                between: Vec::new(),
            })
            .collect();
        for (result, torque) in found.iter_mut().zip(torques_nm) {
            let mut reach_m = FIRST_REACH_M;
            let mut at = |turn: f64| {
                let (mut position, mut approach_m) = (None, 0.0);
                for _ in 0..=DOUBLINGS {
                    let flanks = self.flanks.clone().reaching(reach_m);
                    let posed = PosedFlanks::new(flanks, side, lever_m, pose_at);
                    let mut at_rest = StaticContact::of_flanks(posed, contact.clone());
                    let state = at_rest.solve(turn, Drive::Torque(*torque))?;
                    let loaded = LoadedPosition {
                        pinion_turn_rad: turn,
                        error_rad: state.transmission_error_m / lever_m,
                        unloaded_rad: state.unloaded_m / lever_m,
                        patches: self.patches(&at_rest, turn),
                    };
                    // Whatever closes by this approach was looked at: gaps count from the pose, not from the first touch.
                    approach_m = -state.transmission_error_m;
                    if approach_m < 0.8 * reach_m {
                        position = Some(loaded);
                        break;
                    }
                    reach_m *= 2.0;
                }
                position.ok_or(DrivetrainError::Value {
                    owner: "bevel pair under load",
                    what: "the approach of the flanks in mm",
                    found: 1e3 * approach_m,
                    allowed: "less than 1.5: state smaller torques or errors of assembly",
                })
            };
            let turn = |k: usize| -side.mirror() * (k as f64 / self.positions as f64) * pitch;
            // The end of the pitch is its beginning again, one tooth on.
            let whole: Result<Vec<_>, _> = (0..=self.positions).map(|k| at(turn(k))).collect();
            let whole = whole?;
            result.positions.extend_from_slice(&whole[..self.positions]);
            result.between = between(whole, at)?;
        }
        // Zero where the gear leads most without load.
        let unloaded = found
            .iter()
            .flat_map(LoadedContact::all_positions)
            .map(|p| p.unloaded_rad);
        let most = unloaded.fold(f64::NEG_INFINITY, f64::max);
        for contact in &mut found {
            for position in contact.positions.iter_mut().chain(&mut contact.between) {
                position.error_rad -= most;
                position.unloaded_rad -= most;
            }
        }
        Ok(found)
    }

    fn patches<F: gearmesh_contact::FlanksAtRest>(
        &self,
        at_rest: &StaticContact<F>,
        turn_rad: f64,
    ) -> Vec<LoadedPatch> {
        let (pair, side) = (self.flanks.pair(), self.side());
        let widths_m = pair.face_widths_m();
        let to_tip_m = |gear: usize, [s, v]: [f64; 2]| {
            let [here, tip] = [v, 1.0].map(|v| pair.flank_point_m(side, gear, [s, v]));
            (tip - here).norm()
        };
        let assembly = Assembly::new(self.blank, &self.error);
        let [pinion, gear] = &assembly.members;
        let azimuth = pair.azimuths_rad(side)[0];
        let step = TAU / self.blank.data.teeth[0] as f64;
        let sliding_m = |tooth: usize, at: [f64; 2]| {
            let turned = about_z(turn_rad - azimuth + tooth as f64 * step);
            let r = pinion.axes * (turned * pair.flank_point_m(side, 0, at)) + pinion.apex_m;
            let v = pinion.axis().cross(&(r - pinion.apex_m))
                + gear.axis().cross(&(r - gear.apex_m)) * assembly.ratio;
            v.norm()
        };
        let loaded = |(number, patch): (usize, &ContactPatch)| {
            let force_n = at_rest.force_n(patch);
            let (half_width_m, pressure_pa) = at_rest.hertz(number, force_n);
            let places = [0, 1].map(|gear: usize| {
                let at = patch.places[gear];
                [at.v / widths_m[gear] + 0.5, at.u]
            });
            (force_n > 0.0).then(|| LoadedPatch {
                teeth: patch.teeth,
                places,
                sliding_m: sliding_m(patch.teeth[0], places[0]),
                to_tip_m: f64::min(to_tip_m(0, places[0]), to_tip_m(1, places[1])),
                force_n,
                length_m: patch.length_m,
                half_width_m,
                pressure_pa,
                on_tip: patch.places.iter().any(|at| at.u >= 1.0),
            })
        };
        let patches = at_rest.patches().iter().enumerate();
        patches.filter_map(loaded).collect()
    }
}
