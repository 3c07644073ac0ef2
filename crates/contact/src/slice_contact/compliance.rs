//! Compliance of the patches: that of two reduced gears at the patches' places, or of two half spaces.

use crate::contact_patch::ContactPatch;
use crate::local_contact::LocalContact;
use crate::placed_slice::ToothPlace;
use crate::slice_compliance::LocalDepth;

use super::{Elastic, Run, SliceContact};

/// What is filled.
pub(super) enum Part {
    Compliance,
    WithRates,
    Rates,
}

/// A loop over coupled places, to be compiled for what the processor has: everything in it is part of it
/// (`inline(always)`), for a function that is called was compiled for every processor.
pub(super) struct Filling<'a>(pub Part, pub &'a mut SliceContact);

impl pulp::NullaryFnOnce for Filling<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        match self.0 {
            Part::Compliance => self.1.fill_compliance(),
            Part::WithRates => self.1.fill_pairs_with_rates(),
            Part::Rates => self.1.fill_carrying_rates(),
        }
    }
}

impl SliceContact {
    /// Whether patches in a row at one u share what they have in common: not where each has a place along the tooth of
    /// its own.
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

    /// Where a patch stands on both gears, how deep its local laws reach, and Young's modulus \[Pa\] and Poisson's
    /// ratio.
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

    /// Fills C.
    pub(super) fn fill(&mut self) {
        match &self.elastic {
            Elastic::HalfSpaces(_) => self.fill_half_spaces(),
            Elastic::Reduced(_) => self.arch.dispatch(Filling(Part::Compliance, self)),
        }
    }

    /// Slices of one line feel each other, lines do not. A slice that touches in part counts as a whole one, and its
    /// local law with its part.
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

    #[inline(always)]
    fn fill_compliance(&mut self) {
        let Elastic::Reduced(flanks) = &self.elastic else {
            return;
        };
        let [flank_1, flank_2] = flanks;
        let n = self.slice.len();
        for (number, a) in self.runs.iter().enumerate() {
            for b in &self.runs[number..] {
                let on_1 = flank_1.between(&a.places[0], &b.places[0]);
                let on_2 = flank_2.between(&a.places[1], &b.places[1]);
                let along = [
                    a.along_normals[0] * b.along_normals[0],
                    a.along_normals[1] * b.along_normals[1],
                ];
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

    /// Fills the changes of C with the places between the patches that carry: of the others nobody feels them. Those of
    /// half spaces are known with C.
    pub(super) fn fill_rates(&mut self) {
        self.arch.dispatch(Filling(Part::Rates, self));
    }

    #[inline(always)]
    fn fill_carrying_rates(&mut self) {
        let Elastic::Reduced(flanks) = &self.elastic else {
            return;
        };
        let [flank_1, flank_2] = flanks;
        let n = self.slice.len();
        let forces = self.work.forces();
        let [rates_1, rates_2] = &mut self.rates;
        let carry = |run: &Run| {
            forces[run.patches[0]..run.patches[1]]
                .iter()
                .any(|f| *f > 0.0)
        };
        for (number, a) in self.runs.iter().enumerate() {
            if !carry(a) {
                continue;
            }
            for b in self.runs[number..].iter().filter(|run| carry(run)) {
                let on_1 = flank_1.between(&a.places[0], &b.places[0]);
                let on_2 = flank_2.between(&a.places[1], &b.places[1]);
                for i in (a.patches[0]..a.patches[1]).filter(|i| forces[*i] > 0.0) {
                    for j in (b.patches[0].max(i)..b.patches[1]).filter(|j| forces[*j] > 0.0) {
                        let slices = [self.slice[i], self.slice[j]];
                        let (here, across) = (i * n + j, j * n + i);
                        let (of_1, along_1) = on_1.coupling(slices);
                        let (of_2, along_2) = on_2.coupling(slices);
                        rates_1[across] = of_1.by_b;
                        rates_1[here] = of_1.by_a;
                        rates_2[across] = of_2.by_b;
                        rates_2[here] = of_2.by_a;
                        for (along, [by_a, by_b]) in self.along.iter_mut().zip([along_1, along_2]) {
                            if !along.is_empty() {
                                along[across] = by_b;
                                along[here] = by_a;
                            }
                        }
                    }
                }
            }
        }
        if self.local_contact == LocalContact::None {
            for (i, share) in self.shares.iter().enumerate() {
                for rates in self.rates.iter_mut().chain(&mut self.along) {
                    if let Some(rate) = rates.get_mut(i * n + i) {
                        *rate /= share;
                    }
                }
            }
        }
    }

    /// No local term takes the force of a slice that touches in part only to zero with its share: the slice's own
    /// compliance grows instead.
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
        }
    }
}
