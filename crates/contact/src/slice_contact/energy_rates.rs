//! How the complementary energy of the slices changes at constant forces as their contacts walk over the teeth, or as the width of a slice
//! that is partly on the path grows: what a mesh feels as a force besides those along the normals.
//!
//! ```text
//! E* = ½ FᵀCF + Σ∫δ dF          ∂E*/∂ξ_i = F_i Σ_j ∂_a C_ij F_j + ∂/∂ξ_i ∫δ_i dF
//! ```
//!
//! The slices of a spur line walk together and are one place; those of helical teeth are a place each.

use crate::contact_lines::ContactLine;
use crate::contact_slices::ContactSlice;
use crate::local_contact::{LawRate, LocalContact};
use crate::nlcp::LocalLawError;

use super::{SliceContact, block_number, dot};

impl SliceContact {
    /// [`Self::prepare`] for teeth on the path, with what [`Self::energy_by_roll`] and [`Self::energy_by_share`] need. Spur teeth: all
    /// slices of each line.
    ///
    /// # Errors
    /// As [`Self::prepare`].
    pub fn prepare_with_rates(
        &mut self,
        active: &[ContactLine],
        touching: &[ContactSlice],
        floor_n: f64,
    ) -> Result<(), (LocalLawError, usize)> {
        let helical = self.lines.pair.is_helical();
        if helical {
            self.fill_compliance_by_slices(touching);
        } else {
            self.find_places(active);
            self.fill_compliance_by_lines(active, true);
        }
        self.take_shares(touching);
        self.fill_laws(touching, floor_n)?;
        self.law_rates.clear();
        let laws_a_place = if helical { 1 } else { self.slices() };
        for place in 0..self.depths.len() {
            let line = if helical {
                &touching[place].section
            } else {
                &active[place]
            };
            let number = place * laws_a_place;
            let (contact, law) = (&self.hertz[number].0, &self.local[number]);
            let rates = std::array::from_fn(|gear| {
                let growths = [
                    self.depths[place][gear].growth_by_roll,
                    self.lines.relative_radius_growth(line, gear),
                ];
                self.local_contact.law_rate((contact, law), gear, growths)
            });
            self.law_rates.push(rates);
        }
        Ok(())
    }

    /// Whether any slice of a place carries, see [`Self::energy_by_roll`].
    #[must_use]
    pub fn carries(&self, place: usize) -> bool {
        self.forces_at(place).iter().any(|force| *force > 0.0)
    }

    /// Forces of the slices of a place.
    fn forces_at(&self, place: usize) -> &[f64] {
        let slices = if self.lines.pair.is_helical() {
            1
        } else {
            self.slices()
        };
        &self.work.forces()[place * slices..(place + 1) * slices]
    }

    /// ∂E*/∂ξ \[J/rad\] at the forces of the last solve as the contacts at `place` walk over gear 0 or 1: a line of spur teeth, a slice of
    /// helical ones, by their numbers in what was prepared. On the path.
    ///
    /// # Panics
    /// If the slices were prepared without rates.
    pub fn energy_by_roll(&self, place: usize, gear: usize) -> f64 {
        let rate = self.law_rates[place][gear];
        if self.lines.pair.is_helical() {
            let own = self.work.forces()[place];
            let law = &self.local[place];
            return law.complementary_energy_rate(own, rate.alpha, rate.cap)
                + own * self.deflection_by_roll(place, gear);
        }
        let slices = self.slices();
        let own = self.forces_at(place);
        let law = &self.local[place * slices];
        let local: f64 = (own.iter())
            .map(|force| law.complementary_energy_rate(*force, rate.alpha, rate.cap))
            .sum();
        let lines = self.places.len();
        let with_others = (0..lines).map(|other| {
            let block =
                &self.line_blocks[block_number(lines, gear, place.min(other), place.max(other))];
            if other < place {
                bilinear(self.forces_at(other), &block.by_b, own)
            } else {
                bilinear(own, &block.by_a, self.forces_at(other))
            }
        });
        local + with_others.sum::<f64>() + self.own_energy_by_roll(place, gear)
    }

    /// What the own compliance of a spur line's slices, over their share where there is no local law, adds to ∂E*/∂ξ.
    fn own_energy_by_roll(&self, place: usize, gear: usize) -> f64 {
        if self.local_contact != LocalContact::None {
            return 0.0;
        }
        let slices = self.slices();
        let block = &self.line_blocks[block_number(self.places.len(), gear, place, place)];
        let own = self.forces_at(place).iter().enumerate();
        own.map(|(i, force)| {
            let share = self.shares[place * slices + i];
            force * force * block.by_a[i * slices + i] * (1.0 / share - 1.0)
        })
        .sum()
    }

    /// Σ_j ∂_a C_ij F_j \[m/rad\] of a helical slice on one gear.
    fn deflection_by_roll(&self, slice: usize, gear: usize) -> f64 {
        let compliance = [&self.compliance_1, &self.compliance_2][gear];
        let a = &self.placed[slice][gear];
        let others = self.placed.iter().zip(self.work.forces()).enumerate();
        others
            .filter(|(_, (_, force))| **force > 0.0)
            .map(|(other, (b, force))| {
                let mut rate = compliance.between_slices_rate(a, &b[gear]);
                if other == slice && self.local_contact == LocalContact::None {
                    rate /= self.shares[slice];
                }
                force * rate
            })
            .sum()
    }

    /// ∂E*/∂s \[J\] at the forces of the last solve, s the share of the width of a place's slices that touches: a line of spur teeth, a slice of helical
    /// ones.
    ///
    /// # Panics
    /// If the slices were prepared without rates.
    pub fn energy_by_share(&self, place: usize) -> f64 {
        let laws = if self.lines.pair.is_helical() {
            1
        } else {
            self.slices()
        };
        let slices = place * laws..(place + 1) * laws;
        slices
            .map(|slice| self.slice_energy_by_share(slice, place))
            .sum()
    }

    fn slice_energy_by_share(&self, slice: usize, place: usize) -> f64 {
        let (force, share) = (self.work.forces()[slice], self.shares[slice]);
        if self.local_contact == LocalContact::None {
            // The slice's own compliance was divided by its share.
            let own = self.own_compliance[slice];
            return -0.5 * force * force * own / (share * share);
        }
        let (contact, law) = (&self.hertz[slice].0, &self.local[slice]);
        let growths = self.depths[place].map(|depth| depth.growth_by_share);
        let LawRate { alpha, beta, cap } =
            (self.local_contact).law_rate_by_share((contact, law), growths, share);
        law.complementary_energy_rate(force, alpha, cap)
            + beta * law.complementary_energy_by_beta(force)
    }
}

/// xᵀ M y, M in rows.
fn bilinear(x: &[f64], matrix: &[f64], y: &[f64]) -> f64 {
    let rows = matrix.chunks_exact(y.len().max(1));
    x.iter().zip(rows).map(|(x, row)| x * dot(row, y)).sum()
}
