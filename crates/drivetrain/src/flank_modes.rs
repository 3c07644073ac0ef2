//! Vibration modes of a gear body at its flanks: how they move the gaps.
//!
//! ```text
//! g = g_rigid + φ₁(ξ₁)·η₁ + φ₂(ξ₂)·η₂ + C_r F + δ(F),      C_r = C − Σ φ φᵀ/ω²         force on η: φ F
//! ```
//!
//! φ is NᵀΦ of the reduced gear along the flank's inward normal, combined to slices with the same shares as the compliance, so that
//! at rest, η = Ω⁻²φF, the gaps are those without modes to rounding. A pressing force moves the flank inwards: positive φη opens the gap.
//! Friction pushes on the modes by φ_t, along the profile towards the tip. Theory: docs/theory/gear_meshes.md.

use gearmesh_contact::{AxialSpread, ProfileHats};
use gearmesh_geometry::Flank;
use gearmesh_model::ReducedGear;

use crate::error::DrivetrainError;
use crate::flank_contacts::{FlankContacts, ModalRows};
use crate::pose::Vector6;

/// Modal coordinates and rates of gear 1 and gear 2; empty ones stand for bodies that do not vibrate.
#[derive(Debug, Clone, Copy, Default)]
pub struct ModalMotion<'a> {
    /// η \[√kg·m\].
    pub coordinates: [&'a [f64]; 2],
    /// η̇.
    pub rates: [&'a [f64]; 2],
}

/// NᵀΦ of one gear's flanks of one side, condensed to slices.
#[derive(Debug, Clone)]
pub struct FlankModes {
    omega_squared: Vec<f64>,
    hats: ProfileHats,
    stations: usize,
    slices: usize,
    /// Along the inward normal, `[tooth][station][slice][mode]`.
    rows: Vec<f64>,
    /// Along the profile towards the tip.
    tangential_rows: Vec<f64>,
}

impl FlankModes {
    /// The lowest `modes` modes of a model at its flanks of one side; `spread`: where the slices' forces sit on the gear.
    ///
    /// # Errors
    /// [`DrivetrainError::Model`] if the model has no modes or no loads on that side, [`DrivetrainError::Length`] if it has fewer modes.
    pub fn new(
        gear: &ReducedGear,
        side: Flank,
        modes: usize,
        spread: &AxialSpread,
    ) -> Result<Self, DrivetrainError> {
        gear.flank_index(side)?;
        let basis = gear.modal_basis()?;
        if modes > basis.count() {
            return Err(DrivetrainError::Length {
                owner: "modal gear body",
                what: "the list of modes in the model file",
                found: basis.count(),
                expected: modes,
            });
        }
        let grid = &gear.grid;
        let (stations, slices) = (grid.roll_angles_rad.len(), spread.slices());
        let mut rows = vec![0.0; gear.teeth * stations * slices * modes];
        let mut tangential_rows = rows.clone();
        for mode in 0..modes {
            for tooth in 0..gear.teeth {
                let shape = gear.mode_at_flank(mode, tooth, side)?;
                for station in 0..stations {
                    for slice in 0..slices {
                        let row = ((tooth * stations + station) * slices + slice) * modes + mode;
                        let along = |component: usize| -> f64 {
                            (spread.shares(slice).iter())
                                .map(|&(axial, share)| {
                                    share * shape[3 * grid.load(station, axial) + component]
                                })
                                .sum()
                        };
                        rows[row] = along(0);
                        tangential_rows[row] = along(1);
                    }
                }
            }
        }
        Ok(Self {
            omega_squared: basis.omega_squared[..modes].to_vec(),
            hats: ProfileHats::of_involute(&grid.roll_angles_rad),
            stations,
            slices,
            rows,
            tangential_rows,
        })
    }

    /// The part of `rows` for a slice at a roll station of a tooth.
    fn row<'a>(&self, rows: &'a [f64], [tooth, station, slice]: [usize; 3]) -> &'a [f64] {
        let row = (tooth * self.stations + station) * self.slices + slice;
        &rows[row * self.count()..][..self.count()]
    }

    /// Number of modes.
    #[must_use]
    pub fn count(&self) -> usize {
        self.omega_squared.len()
    }

    /// Memory for the rows of so many contacts.
    pub(crate) fn rows_with_capacity(&self, contacts: usize) -> ModalRows {
        ModalRows {
            omega_squared: self.omega_squared.clone(),
            shapes: Vec::with_capacity(contacts * self.count()),
            slopes: Vec::with_capacity(contacts * self.count()),
            tangential: Vec::with_capacity(contacts * self.count()),
        }
    }

    /// Writes shapes and slopes of all contacts on gear 0 or 1 and lets the modal coordinates move gaps, gap rates and gradients;
    /// `pose_rates`: (u̇, ω).
    pub(crate) fn bend(
        &self,
        gear: usize,
        motion: &ModalMotion<'_>,
        pose_rates: &Vector6,
        found: &mut FlankContacts,
    ) {
        let modes = self.count();
        let (coordinates, rates) = (motion.coordinates[gear], motion.rates[gear]);
        let rows = &mut found.modal[gear];
        rows.shapes.clear();
        rows.shapes.resize(found.contacts.len() * modes, 0.0);
        rows.slopes.clear();
        rows.slopes.resize(found.contacts.len() * modes, 0.0);
        for section in &found.sections {
            let roll = section.touching_roll_rad[gear];
            let place = self.hats.place(roll);
            let walks = section.walks(gear);
            let along = &section.roll_gradient[gear];
            let roll_rate = along.dot(pose_rates);
            let (start, count) = section.contacts;
            for number in start..start + count {
                let contact = &mut found.contacts[number];
                let (tooth, slice) = (found.lines[contact.line].teeth[gear], contact.slice);
                let row = |station: usize| self.row(&self.rows, [tooth, station, slice]);
                let shape = &mut rows.shapes[number * modes..][..modes];
                for (station, share) in place.shares() {
                    add_scaled(shape, share, row(station));
                }
                let slope = &mut rows.slopes[number * modes..][..modes];
                for (station, share) in place.rates().filter(|_| walks) {
                    add_scaled(slope, share, row(station));
                }
                contact.gap_m += dot(shape, coordinates);
                let bent = dot(slope, coordinates);
                contact.gradient += bent * along;
                contact.gap_rate_m_per_s += dot(shape, rates) + bent * roll_rate;
            }
        }
    }

    /// Writes φ_t of all contacts on gear 0 or 1, for friction.
    pub(crate) fn lay_along_profile(&self, gear: usize, found: &mut FlankContacts) {
        let modes = self.count();
        let tangential = &mut found.modal[gear].tangential;
        tangential.clear();
        tangential.resize(found.contacts.len() * modes, 0.0);
        for section in &found.sections {
            let place = self.hats.place(section.touching_roll_rad[gear]);
            let (start, count) = section.contacts;
            for number in start..start + count {
                let contact = &found.contacts[number];
                let (tooth, slice) = (found.lines[contact.line].teeth[gear], contact.slice);
                let sum = &mut tangential[number * modes..][..modes];
                for (station, share) in place.shares() {
                    let row = self.row(&self.tangential_rows, [tooth, station, slice]);
                    add_scaled(sum, share, row);
                }
            }
        }
    }
}

/// a·b over the shorter of the two.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// sum += factor · values.
pub(crate) fn add_scaled(sum: &mut [f64], factor: f64, values: &[f64]) {
    for (place, value) in sum.iter_mut().zip(values) {
        *place += factor * value;
    }
}
