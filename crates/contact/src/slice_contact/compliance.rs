//! Compliance of the patches: that of two reduced gears at the patches' places, or of two half spaces.

use crate::contact_patch::ContactPatch;
use crate::local_contact::LocalContact;
use crate::placed_slice::ToothPlace;
use crate::slice_compliance::LocalDepth;

use super::{Elastic, Run, SliceContact};

impl SliceContact {
    /// Whether patches in a row at one u share what they have in common: not where each has a place along the tooth of its own.
    pub(super) fn shares_places(&self) -> bool {
        matches!(self.elastic, Elastic::Reduced(_)) && self.along.iter().all(Vec::is_empty)
    }

    /// ∂(ln h)/∂(ln length) of the local laws.
    pub(super) fn depth_by_length(&self) -> f64 {
        match &self.elastic {
            Elastic::Reduced(_) => 0.0,
            Elastic::HalfSpaces(_) => 1.0,
        }
    }

    /// Where a patch stands on both gears, how deep its local laws reach, and Young's modulus \[Pa\] and Poisson's ratio.
    pub(super) fn stand(
        &self,
        patch: &ContactPatch,
    ) -> ([ToothPlace; 2], [LocalDepth; 2], [(f64, f64); 2]) {
        match &self.elastic {
            Elastic::Reduced(flanks) => {
                let place = |gear: usize| {
                    let at = patch.places[gear];
                    let place = flanks[gear].on_tooth(patch.teeth[gear], at.u);
                    flanks[gear].walked(place, patch.slice, at.v)
                };
                let places = [place(0), place(1)];
                let depth = |gear: usize| {
                    let u = patch.places[gear].u;
                    flanks[gear].local_depth(u, &places[gear].place, (patch.slice, patch.share))
                };
                let materials = [0, 1].map(|gear: usize| flanks[gear].material());
                (places, [depth(0), depth(1)], materials)
            }
            Elastic::HalfSpaces(bodies) => {
                let depth = |gear: usize| LocalDepth {
                    depth_m: bodies.depth_m(gear, patch.length_m / patch.share),
                    growth_by_u: 0.0,
                    growth_by_share: 0.0,
                };
                (Default::default(), [depth(0), depth(1)], bodies.materials)
            }
        }
    }

    /// Fills C, and with rates its changes with the places.
    pub(super) fn fill(&mut self, with_rates: bool) {
        match (&self.elastic, with_rates) {
            (Elastic::HalfSpaces(_), _) => self.fill_half_spaces(),
            (Elastic::Reduced(_), false) => self.fill_compliance(),
            (Elastic::Reduced(_), true) => self.fill_compliance_with_rates(),
        }
    }

    /// Slices of one line feel each other, lines do not. A slice that touches in part counts as a whole one, and its local law with its part.
    fn fill_half_spaces(&mut self) {
        let Elastic::HalfSpaces(bodies) = &self.elastic else {
            return;
        };
        let n = self.slice.len();
        for (i, a) in self.runs.iter().enumerate() {
            for (j, b) in self.runs.iter().enumerate().skip(i) {
                let (here, across) = (i * n + j, j * n + i);
                let mut value = 0.0;
                if a.teeth == b.teeth {
                    let apart = self.slice[i].abs_diff(self.slice[j]);
                    let whole = |run: &Run, i: usize| run.contact.width_m / self.shares[i];
                    value = bodies.between(apart, [whole(a, i), whole(b, j)]);
                }
                self.c[across] = value;
                self.c[here] = value;
                for gear in 0..2 {
                    // In proportion to 1/√(l_i l_j).
                    self.rates[gear][across] = -0.5 * b.length_growth[gear] * value;
                    self.rates[gear][here] = -0.5 * a.length_growth[gear] * value;
                }
            }
        }
    }

    fn fill_compliance(&mut self) {
        let Elastic::Reduced(flanks) = &self.elastic else {
            return;
        };
        let [flank_1, flank_2] = &**flanks;
        let n = self.slice.len();
        for (number, a) in self.runs.iter().enumerate() {
            for b in &self.runs[number..] {
                let on_1 = flank_1.between(&a.places[0], &b.places[0]);
                let on_2 = flank_2.between(&a.places[1], &b.places[1]);
                let along = [0, 1].map(|gear: usize| a.along_normals[gear] * b.along_normals[gear]);
                for i in a.patches[0]..a.patches[1] {
                    for j in b.patches[0].max(i)..b.patches[1] {
                        let slices = [self.slice[i], self.slice[j]];
                        let value = along[0] * on_1.value(slices) + along[1] * on_2.value(slices);
                        self.c[i * n + j] = value;
                        self.c[j * n + i] = value;
                    }
                }
            }
        }
    }

    fn fill_compliance_with_rates(&mut self) {
        let Elastic::Reduced(flanks) = &self.elastic else {
            return;
        };
        let [flank_1, flank_2] = &**flanks;
        let n = self.slice.len();
        let [rates_1, rates_2] = &mut self.rates;
        for (number, a) in self.runs.iter().enumerate() {
            for b in &self.runs[number..] {
                let on_1 = flank_1.between(&a.places[0], &b.places[0]);
                let on_2 = flank_2.between(&a.places[1], &b.places[1]);
                for i in a.patches[0]..a.patches[1] {
                    for j in b.patches[0].max(i)..b.patches[1] {
                        let slices = [self.slice[i], self.slice[j]];
                        let (of_1, of_2) = (on_1.coupling(slices), on_2.coupling(slices));
                        let value = of_1.value + of_2.value;
                        let (here, across) = (i * n + j, j * n + i);
                        self.c[across] = value;
                        self.c[here] = value;
                        rates_1[across] = of_1.by_b;
                        rates_1[here] = of_1.by_a;
                        rates_2[across] = of_2.by_b;
                        rates_2[here] = of_2.by_a;
                        for (along, on) in self.along.iter_mut().zip([&on_1, &on_2]) {
                            if !along.is_empty() {
                                let [by_a, by_b] = on.along_teeth();
                                along[across] = by_b;
                                along[here] = by_a;
                            }
                        }
                    }
                }
            }
        }
    }

    /// No local term takes the force of a slice that touches in part only to zero with its share: the slice's own compliance grows instead.
    pub(super) fn divide_by_shares(&mut self) {
        self.own_compliance.clear();
        if self.local_contact != LocalContact::None {
            return;
        }
        let n = self.shares.len();
        for (i, share) in self.shares.iter().enumerate() {
            let own = i * n + i;
            self.own_compliance.push(self.c[own]);
            self.c[own] /= share;
            for rates in self.rates.iter_mut().chain(&mut self.along) {
                if let Some(rate) = rates.get_mut(own) {
                    *rate /= share;
                }
            }
        }
    }
}
