//! Which of many loads strains the root of a tooth most: by a row of made-up gauges along the fillet, where its tangent
//! stands at 30° to the tooth's centre line, as rating takes the critical section. The rows' readings under all unit
//! loads are found at once, so that a run of thousands of rows costs little more than one field.
//!
//! Of a body whose openings make teeth differ the readings are those of tooth 0, and of a bore that is not held those
//! of a held one. What is found picks the moment that is drawn; what is drawn is solved for all loads of that moment.

use super::{Pressed, StressedBody, StressedGear};
use crate::failure::Result;
use gearmesh_bevel::BevelGauge;
use gearmesh_geometry::{Flank, GaugeDefinition, RootPosition};
use gearmesh_recovery::PlacedForce;
use gearmesh_reduction::bevel::gauge::bevel_gauge_row;
use gearmesh_reduction::flank_loads::SparseVector;
use gearmesh_reduction::gauge_row::gauge_row;
use gearmesh_reduction::{Progress, ReductionError};

/// Gauges along the face.
const GAUGES: usize = 15;

/// Tangent at the critical section \[rad\].
const TANGENT_RAD: f64 = std::f64::consts::PI / 6.0;

/// Length of a gauge along the profile, as a share of the tooth's height.
const LENGTH: f64 = 0.05;

/// Root strain by unit loads.
pub struct RootSearch<'a> {
    gear: &'a StressedGear,
    /// `[side][gauge on tooth 0][tooth][component][load]` \[1/N\]; empty on a side that nothing loads, or whose fillet
    /// has no such tangent.
    readings: [Vec<Vec<f64>>; 2],
}

impl<'a> RootSearch<'a> {
    /// Solves for the sides that carry loads.
    pub fn new(gear: &'a StressedGear, sides: &[Flank], progress: &dyn Progress) -> Result<Self> {
        let mut readings = [Vec::new(), Vec::new()];
        for &side in sides {
            readings[side as usize] = match gear.critical_rows(side) {
                Ok(rows) => gear.readings(side, &rows, progress),
                Err(ReductionError::NoGaugePlace { .. } | ReductionError::EmptyGauge { .. }) => {
                    Vec::new()
                }
                Err(error) => return Err(error.into()),
            };
        }
        Ok(Self { gear, readings })
    }

    /// The largest strain of a root on the side that is pressed; of a fillet without the tangent the largest force on
    /// one tooth.
    fn largest(&self, forces: &[PlacedForce]) -> Result<f64> {
        let (teeth, loads) = (self.gear.teeth(), self.gear.grid.len());
        let on_grid = self.gear.grid_forces(forces)?;
        let mut largest = 0.0_f64;
        let mut pressed: Vec<(usize, Flank)> = forces.iter().map(|f| (f.tooth, f.side)).collect();
        pressed.sort_unstable_by_key(|(tooth, side)| (*tooth, *side as usize));
        pressed.dedup();
        for (tooth, side) in pressed {
            let own = on_grid.iter().filter(|f| f.side == side);
            let gauges = &self.readings[side as usize];
            if gauges.is_empty() {
                let on_tooth = own.clone().filter(|f| f.tooth == tooth);
                largest = largest.max(on_tooth.map(|f| f.normal_n).sum());
            }
            for gauge in gauges {
                let reading = |force: &gearmesh_reduction::field::GridForce| {
                    let from = (force.tooth + teeth - tooth) % teeth;
                    let of_tooth = &gauge[from * 2 * loads..][..2 * loads];
                    force.normal_n * of_tooth[force.load]
                        + force.tangential_n * of_tooth[loads + force.load]
                };
                largest = largest.max(own.clone().map(reading).sum());
            }
        }
        Ok(largest)
    }

    /// Of many sets of forces the one with the largest; none where there are no forces at all.
    pub fn largest_of(&self, all: &[Pressed]) -> Result<Option<usize>> {
        let mut best = None;
        let mut most = 0.0;
        for (number, pressed) in all.iter().enumerate() {
            let strain = self.largest(&pressed.forces)?;
            if strain > most {
                (best, most) = (Some(number), strain);
            }
        }
        Ok(best)
    }
}

impl StressedGear {
    /// Rows of the made-up gauges on one side of tooth 0.
    fn critical_rows(&self, side: Flank) -> Result<Vec<SparseVector>, ReductionError> {
        let name = "critical section";
        let width_m = self.face_width_m / GAUGES as f64;
        let middles = (0..GAUGES).map(|k| (k as f64 + 0.5) * width_m - 0.5 * self.face_width_m);
        middles
            .map(|along_m| match &self.body {
                StressedBody::Cylindrical(gear, body) => {
                    let gauge = GaugeDefinition {
                        name: name.to_owned(),
                        tooth: 0,
                        side,
                        position: RootPosition::TangentAngle(TANGENT_RAD),
                        length_m: LENGTH * (gear.profile.tip_radius_m - gear.profile.root_radius_m),
                        z_m: along_m,
                        width_m,
                    };
                    gauge_row(gear, &body.mesh, &body.model, &gauge, 0)
                }
                StressedBody::Bevel(gear, body) => {
                    let blank = gear.blank();
                    let gauge = BevelGauge {
                        name: name.to_owned(),
                        tooth: 0,
                        side,
                        tangent_rad: TANGENT_RAD,
                        length_m: LENGTH * (blank.outer_addendum_m + blank.outer_dedendum_m),
                        along_m,
                        width_m,
                    };
                    bevel_gauge_row(gear, &body.mesh, &body.model, &gauge, 0)
                }
            })
            .collect()
    }

    fn readings(
        &self,
        side: Flank,
        rows: &[SparseVector],
        progress: &dyn Progress,
    ) -> Vec<Vec<f64>> {
        match &self.body {
            StressedBody::Cylindrical(_, body) => self.units.readings(body, side, rows, progress),
            StressedBody::Bevel(_, body) => self.units.readings(body, side, rows, progress),
        }
    }
}
