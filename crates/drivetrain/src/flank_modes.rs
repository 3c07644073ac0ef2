//! Vibration modes of a gear body at its flanks: how they move the gaps.
//!
//! ```text
//! g = g_rigid + φ₁(ξ₁)·η₁ + φ₂(ξ₂)·η₂ + C_r F + δ(F),      C_r = C − Σ φ φᵀ/ω²         force on η: φ F
//! ```
//!
//! φ is NᵀΦ of the reduced gear along the flank's inward normal, combined to slices with the same shares as the
//! compliance, so that at rest, η = Ω⁻²φF, the gaps are those without modes to rounding. A pressing force moves the
//! flank inwards: positive φη opens the gap. Where slices walk along the teeth (gear 2 of a bevel pair), φ changes
//! along them, too. Friction pushes on the modes by the shapes in the tangent plane. Theory:
//! docs/theory/gear_meshes.md.

use gearmesh_contact::{FlankSlices, ProfileHats, SliceWalk, WalkedSlice};
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
    walk: Option<SliceWalk>,
    stations: usize,
    slices: usize,
    /// Along the inward normal, along the profile towards the tip, along the tooth, `[tooth][station][slice][mode]`;
    /// the last one is empty for involute flanks, which do not slide along their teeth.
    rows: [Vec<f64>; 3],
    /// Largest entry of each mode along the normal, `[tooth][mode]`.
    largest: Vec<f64>,
}

impl FlankModes {
    /// The lowest `modes` modes of a model at its flanks of one side; `slices`: where their forces sit on the gear.
    ///
    /// # Errors
    /// [`DrivetrainError::Model`] if the model has no modes or no loads on that side, [`DrivetrainError::Length`] if it
    /// has fewer modes.
    pub fn new(
        gear: &ReducedGear,
        side: Flank,
        modes: usize,
        slices: FlankSlices,
    ) -> Result<Self, DrivetrainError> {
        gear.flank_index(side)?;
        let basis = gear.modal_basis()?;
        DrivetrainError::check_modes("modal gear body", basis.count(), modes)?;
        let FlankSlices { hats, spread, walk } = slices;
        let grid = &gear.grid;
        let (stations, slices) = (grid.roll_angles_rad.len(), spread.slices());
        let zeros = || vec![0.0; gear.teeth * stations * slices * modes];
        let along_tooth = gear.bevel.as_ref().map(|_| zeros());
        let mut rows = [zeros(), zeros(), along_tooth.unwrap_or_default()];
        let mut largest = vec![0.0_f64; gear.teeth * modes];
        for mode in 0..modes {
            for tooth in 0..gear.teeth {
                let shape = gear.mode_at_flank(mode, tooth, side)?;
                for (station, slice) in (0..stations * slices).map(|k| (k / slices, k % slices)) {
                    let row = ((tooth * stations + station) * slices + slice) * modes + mode;
                    let along = |component: usize| -> f64 {
                        (spread.shares(slice).iter())
                            .map(|&(axial, share)| {
                                share * shape[3 * grid.load(station, axial) + component]
                            })
                            .sum()
                    };
                    for (component, rows) in rows.iter_mut().enumerate() {
                        if let Some(place) = rows.get_mut(row) {
                            *place = along(component);
                        }
                    }
                    let most = &mut largest[tooth * modes + mode];
                    *most = most.max(rows[0][row].abs());
                }
            }
        }
        Ok(Self {
            omega_squared: basis.omega_squared[..modes].to_vec(),
            hats,
            walk,
            stations,
            slices,
            rows,
            largest,
        })
    }

    /// Number of modes.
    #[must_use]
    pub fn count(&self) -> usize {
        self.omega_squared.len()
    }

    /// How far the modes bend any flank along its normal at most \[m\], as a bound.
    pub(crate) fn most_bent_m(&self, coordinates: &[f64]) -> f64 {
        let of_tooth = |largest: &[f64]| -> f64 {
            let each = largest.iter().zip(coordinates);
            each.map(|(phi, eta)| phi * eta.abs()).sum()
        };
        let teeth = self.largest.chunks_exact(self.count().max(1));
        teeth.map(of_tooth).fold(0.0, f64::max)
    }

    /// Memory for the rows of so many contacts.
    pub(crate) fn rows_with_capacity(&self, contacts: usize) -> ModalRows {
        let rows = || Vec::with_capacity(contacts * self.count());
        ModalRows {
            omega_squared: self.omega_squared.clone(),
            shapes: rows(),
            slopes: rows(),
            slopes_along: self.walk.map_or_else(Vec::new, |_| rows()),
            sliding: [rows(), rows()],
        }
    }

    /// Where a force sits along the tooth whose patch belongs to a slice and stands at v \[m\].
    fn along_tooth(&self, slice: usize, v_m: f64) -> AlongTooth {
        match self.walk {
            Some(walk) => AlongTooth::Walks(walk.at(slice, v_m)),
            None => AlongTooth::Stays(slice),
        }
    }

    /// Adds the rows of a component at stations and slices with their shares.
    fn add(
        &self,
        component: usize,
        tooth: usize,
        (stations, slices): (
            impl Iterator<Item = (usize, f64)>,
            impl Iterator<Item = (usize, f64)> + Clone,
        ),
        sum: &mut [f64],
    ) {
        let modes = self.count();
        for (station, share) in stations {
            for (slice, part) in slices.clone() {
                let row = ((tooth * self.stations + station) * self.slices + slice) * modes;
                add_scaled(sum, share * part, &self.rows[component][row..][..modes]);
            }
        }
    }

    /// Writes shapes and slopes of all contacts on gear 0 or 1 and lets the modal coordinates move gaps, gap rates and
    /// gradients; `pose_rates`: (u̇, ω).
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
        begin(&mut rows.shapes, found.contacts.len() * modes);
        begin(&mut rows.slopes, found.contacts.len() * modes);
        if self.walk.is_some() {
            begin(&mut rows.slopes_along, found.contacts.len() * modes);
        }
        for section in &found.sections {
            let place = self.hats.place(section.touching_roll_rad[gear]);
            let walks = section.walks(gear);
            let up = &section.roll_gradient[gear];
            let roll_rate = up.dot(pose_rates);
            let (start, count) = section.contacts;
            for number in start..start + count {
                let contact = &mut found.contacts[number];
                let tooth = found.lines[contact.line].teeth[gear];
                let at = self.along_tooth(contact.slice, contact.heights_m[gear]);
                let shape = &mut rows.shapes[number * modes..][..modes];
                self.add(0, tooth, (place.shares(), at.shares()), shape);
                let slope = &mut rows.slopes[number * modes..][..modes];
                let climbs = place.rates().filter(|_| walks);
                self.add(0, tooth, (climbs, at.shares()), slope);
                contact.gap_m += dot(shape, coordinates);
                let bent = dot(slope, coordinates);
                contact.gradient += bent * up;
                contact.gap_rate_m_per_s += dot(shape, rates) + bent * roll_rate;
                if self.walk.is_some() {
                    let slope = &mut rows.slopes_along[number * modes..][..modes];
                    self.add(0, tooth, (place.shares(), at.rates()), slope);
                    let (bent, along) = (dot(slope, coordinates), &section.along_gradient[gear]);
                    contact.gradient += bent * along;
                    contact.gap_rate_m_per_s += bent * along.dot(pose_rates);
                }
            }
        }
    }

    /// Writes how fast vibration slides the flanks at all contacts on gear 0 or 1 of a side of this hand; `tangents`:
    /// as [`crate::FlankKinematics::tangents_on_flanks`] of this gear.
    pub(crate) fn lay_sliding(
        &self,
        (gear, hand): (usize, f64),
        tangents: impl Fn(usize) -> Option<[[f64; 2]; 2]>,
        found: &mut FlankContacts,
    ) {
        let modes = self.count();
        let sliding = &mut found.modal[gear].sliding;
        let in_plane = tangents(0).is_some();
        let (size, none) = (found.contacts.len() * modes, 0);
        begin(&mut sliding[0], size);
        begin(&mut sliding[1], if in_plane { size } else { none });
        // Gear 2 slides over gear 1.
        let moves = if gear == 0 { -1.0 } else { 1.0 };
        for section in &found.sections {
            let place = self.hats.place(section.touching_roll_rad[gear]);
            let (start, count) = section.contacts;
            for number in start..start + count {
                let contact = &found.contacts[number];
                let tooth = found.lines[contact.line].teeth[gear];
                let at = self.along_tooth(contact.slice, contact.heights_m[gear]);
                let mut add = |tangent: usize, component: usize, share: f64| {
                    let sum = &mut sliding[tangent][number * modes..][..modes];
                    let slices = at.shares().map(|(slice, part)| (slice, share * part));
                    self.add(component, tooth, (place.shares(), slices), sum);
                };
                match tangents(number) {
                    None if in_plane => {}
                    // w⊥ points to the tip of gear 1 and from that of gear 2 on right flanks.
                    None => add(0, 1, -hand),
                    Some(both) => {
                        for (tangent, [to_tip, along]) in both.into_iter().enumerate() {
                            add(tangent, 1, moves * to_tip);
                            add(tangent, 2, moves * along);
                        }
                    }
                }
            }
        }
    }
}

impl FlankContacts {
    /// How fast vibration slides gear 2's flank over gear 1's along one of the tangents at a contact \[m/s\]; zero
    /// without friction.
    #[must_use]
    pub fn sliding_by_vibration_m_per_s(
        &self,
        (contact, tangent): (usize, usize),
        modal_rates: &[&[f64]; 2],
    ) -> f64 {
        let of_gears = self.modal.iter().zip(modal_rates);
        of_gears
            .map(|(modal, rates)| dot(modal.sliding(contact, tangent), rates))
            .sum()
    }
}

/// Slices that share a force.
#[derive(Clone, Copy)]
enum AlongTooth {
    Stays(usize),
    Walks(WalkedSlice),
}

impl AlongTooth {
    /// With their shares.
    fn shares(&self) -> impl Iterator<Item = (usize, f64)> + Clone + use<> {
        let (first, shares, count) = match *self {
            Self::Stays(slice) => (slice, [1.0, 0.0, 0.0], 1),
            Self::Walks(walked) => (walked.first, walked.shares, 3),
        };
        (first..).zip(shares).take(count)
    }

    /// With the derivatives of the shares by the place along the tooth \[1/m\].
    fn rates(&self) -> impl Iterator<Item = (usize, f64)> + Clone + use<> {
        let (first, rates, count) = match *self {
            Self::Stays(slice) => (slice, [0.0; 3], 0),
            Self::Walks(walked) => (walked.first, walked.rates, 3),
        };
        (first..).zip(rates).take(count)
    }
}

/// So many zeros, in the memory that is there.
fn begin(values: &mut Vec<f64>, size: usize) {
    values.clear();
    values.resize(size, 0.0);
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
