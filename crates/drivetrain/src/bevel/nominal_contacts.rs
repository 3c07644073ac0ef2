//! Where the flanks of one pair of teeth are nearest in the pair as designed, over the turn of the pinion: the guess
//! from which every pose begins.
//!
//! Turned back to tooth 0 of gear 1, a pose and the nominal one next to it differ by a small step δ = (u, ϑ) of gear 2.
//! Gap and places follow to the first order:
//!
//! ```text
//! g ≈ g₀ + G·δ,   q ≈ q₀ + (∂q/∂pose) δ
//! ```
//!
//! The table is made once; nothing is kept from pose to pose, so that a contact depends on its pose only.

use nalgebra::{Matrix3, Matrix4x6, Vector3};

use super::contact_limits::Limits;
use super::nearest_points::Nearest;
use super::pose_derivatives::{PoseDerivatives, gradient};
use crate::pose::{Vector6, stacked};

/// Entries a pitch of the pinion.
const PER_PITCH: usize = 24;

/// A contact at a nominal pose.
#[derive(Debug, Clone)]
struct Entry {
    /// Gear 2 axes from gear 1 axes, both turned back to tooth 0.
    back: Matrix3<f64>,
    limits: Limits,
    at: [[f64; 2]; 2],
    gap_m: f64,
    gradient: Vector6,
    places: Matrix4x6<f64>,
}

/// Contacts of a side over the angle of the pinion's tooth from the plane of the axes.
#[derive(Debug, Clone)]
pub(crate) struct NominalContacts {
    first_rad: f64,
    step_rad: f64,
    entries: Vec<Option<Entry>>,
}

/// What an entry says of a pose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Guess {
    number: usize,
    pub gap_m: f64,
    pub at: [[f64; 2]; 2],
}

impl NominalContacts {
    /// Over `reach` pitches to either side: the rotation of gear 2 against gear 1 at each of [`Self::angles`], and what
    /// is nearest there.
    pub(crate) fn new(
        pitch_rad: f64,
        reach: f64,
        contacts: impl IntoIterator<Item = (Matrix3<f64>, Option<Nearest>)>,
    ) -> Self {
        let entry = |(rotation, found): (Matrix3<f64>, Option<Nearest>)| {
            let found = found?;
            let here = Vector3::zeros();
            Some(Entry {
                back: rotation.transpose(),
                limits: Limits::of(&found.held),
                at: found.at,
                gap_m: found.gap_m,
                gradient: gradient(&found, &here),
                places: PoseDerivatives::new(&found, &here).places,
            })
        };
        Self {
            first_rad: Self::angles(pitch_rad, reach)[0],
            step_rad: pitch_rad / PER_PITCH as f64,
            entries: contacts.into_iter().map(entry).collect(),
        }
    }

    /// Angles of the entries over `reach` pitches to either side \[rad\].
    pub(crate) fn angles(pitch_rad: f64, reach: f64) -> Vec<f64> {
        let step_rad = pitch_rad / PER_PITCH as f64;
        let half = (reach * PER_PITCH as f64).ceil() as usize;
        let number = |number: usize| (number as f64 - half as f64) * step_rad;
        (0..=2 * half).map(number).collect()
    }

    /// What holds the contact of an entry, and its places; none where nothing is nearest.
    pub(crate) fn entry(&self, number: usize) -> Option<(Limits, [[f64; 2]; 2])> {
        let entry = self.entries[number].as_ref()?;
        Some((entry.limits, entry.at))
    }

    /// The guess for a tooth at an angle; gear 2 in the frame of gear 1's tooth. None where nothing is nearest
    /// nominally.
    pub(crate) fn guess(
        &self,
        angle_rad: f64,
        displacement_m: &Vector3<f64>,
        rotation: &Matrix3<f64>,
    ) -> Option<Guess> {
        let number = ((angle_rad - self.first_rad) / self.step_rad).round();
        let number = number.clamp(0.0, (self.entries.len() - 1) as f64) as usize;
        self.guess_from(number, displacement_m, rotation)
    }

    /// The same from the entry nearby where there is none at the angle: sections reach the mate in a few pitches only,
    /// and a little earlier or later where the gears stand off the design.
    pub(crate) fn guess_nearby(
        &self,
        angle_rad: f64,
        displacement_m: &Vector3<f64>,
        rotation: &Matrix3<f64>,
    ) -> Option<Guess> {
        let number = ((angle_rad - self.first_rad) / self.step_rad).round();
        let last = self.entries.len() - 1;
        if !(-(PER_PITCH as f64)..=(last + PER_PITCH) as f64).contains(&number) {
            return None;
        }
        let number = number.clamp(0.0, last as f64) as usize;
        let exists = |at: &usize| self.entries.get(*at).is_some_and(Option::is_some);
        let near = (0..=PER_PITCH / 4).flat_map(|off| [number.wrapping_sub(off), number + off]);
        let number = near.into_iter().find(exists)?;
        self.guess_from(number, displacement_m, rotation)
    }

    fn guess_from(
        &self,
        number: usize,
        displacement_m: &Vector3<f64>,
        rotation: &Matrix3<f64>,
    ) -> Option<Guess> {
        let entry = self.entries[number].as_ref()?;
        let step = stacked(*displacement_m, small_turn(&(rotation * entry.back)));
        let by = entry.places * step;
        let at = [0, 1].map(|m: usize| {
            [0, 1].map(|k: usize| (entry.at[m][k] + by[2 * m + k]).clamp(0.0, 1.0))
        });
        Some(Guess {
            number,
            gap_m: entry.gap_m + entry.gradient.dot(&step),
            at,
        })
    }

    /// What may hold the contact of a guess, the likeliest first: that of the nominal contact, then those of the next
    /// ones that differ, on either side.
    pub(crate) fn limits(&self, guess: &Guess) -> impl Iterator<Item = Limits> + use<'_> {
        let own = guess.number;
        let of = move |number: usize| self.entries[number].as_ref().map(|entry| entry.limits);
        let here = of(own);
        let differs = move |limits: &Option<Limits>| limits.is_some() && *limits != here;
        let reach = PER_PITCH / 2;
        let after = move || {
            let mut entries = (own + 1..self.entries.len().min(own + reach)).map(of);
            entries.find(differs).flatten()
        };
        let before = move || {
            let mut entries = (own.saturating_sub(reach)..own).rev().map(of);
            entries.find(differs).flatten()
        };
        // The neighbours are looked at only where the likeliest does not hold.
        let others = std::iter::once_with(after).chain(std::iter::once_with(before));
        std::iter::once(here).chain(others).flatten()
    }
}

/// The vector of a small turn: its skew part.
pub(super) fn small_turn(turn: &Matrix3<f64>) -> Vector3<f64> {
    0.5 * Vector3::new(
        turn[(2, 1)] - turn[(1, 2)],
        turn[(0, 2)] - turn[(2, 0)],
        turn[(1, 0)] - turn[(0, 1)],
    )
}
