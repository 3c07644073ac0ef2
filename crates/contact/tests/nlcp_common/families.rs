//! Families of hard problems: what is special is made of a random problem.

use super::random::{Case, Kind, Random, case};

/// What is hard about a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Nothing further: all kinds of matrices and laws.
    Random,
    /// Slices that are copies of others: the matrix is singular, the split of their force is not unique.
    Duplicates,
    /// The same, but for a part in 1e9 to 1e13.
    NearDuplicates,
    /// Gaps of exactly zero and of exactly the same size: ties everywhere.
    TouchingGaps,
    /// One slice touches, all others are far away.
    AllOpen,
    /// No gaps and a load that presses every slice.
    AllClosed,
    /// Mean forces from 1e-9 to 1e9 N.
    Loads,
    /// Compliances over twelve decades in one problem.
    TwelveDecades,
    /// Friction whose sign turns within the slices: lever arms on both sides of the frictionless one, some exactly on
    /// it.
    FrictionTurns,
}

pub const FAMILIES: [Family; 9] = [
    Family::Random,
    Family::Duplicates,
    Family::NearDuplicates,
    Family::TouchingGaps,
    Family::AllOpen,
    Family::AllClosed,
    Family::Loads,
    Family::TwelveDecades,
    Family::FrictionTurns,
];

/// A problem of up to twenty slices that its seed alone makes.
pub fn problem(family: Family, seed: u64) -> Case {
    let mut random = Random::new(seed);
    let mut it = case(20, &mut random);
    let n = it.data.size();
    match family {
        Family::Random => {}
        Family::Duplicates => duplicate(&mut it, 0.0, &mut random),
        Family::NearDuplicates => {
            let apart = random.log_between(1e-13, 1e-9);
            duplicate(&mut it, apart, &mut random);
        }
        Family::TouchingGaps => {
            let step = it.data.compliance[0] * it.load / it.data.lever.iter().sum::<f64>();
            for (gap, w) in it.data.separation.iter_mut().zip(&it.data.closing) {
                *gap = w * step * random.below(3) as f64;
            }
        }
        Family::AllOpen => {
            let first = random.below(n);
            let far = 1e3 * it.data.compliance[first * n + first] * it.load / it.data.lever[first];
            for (i, gap) in it.data.separation.iter_mut().enumerate() {
                *gap = if i == first {
                    0.0
                } else {
                    far * random.between(1.0, 2.0)
                };
            }
        }
        Family::AllClosed => {
            it.data.separation.fill(0.0);
            it.load *= 1e3;
        }
        Family::Loads => it.load *= random.log_between(1e-6, 1e3),
        Family::TwelveDecades => {
            let scale: Vec<f64> = (0..n).map(|_| random.log_between(1e-3, 1e3)).collect();
            for i in 0..n {
                for j in 0..n {
                    it.data.compliance[i * n + j] *= scale[i] * scale[j];
                }
            }
        }
        Family::FrictionTurns => {
            let turn = random.below(n + 1);
            for i in 0..n {
                let ratio = match i.cmp(&turn) {
                    std::cmp::Ordering::Less => -0.15,
                    std::cmp::Ordering::Equal => 0.0,
                    std::cmp::Ordering::Greater => 0.15,
                };
                it.data.lever[i] = 0.07 * it.data.closing[i] * (1.0 + ratio);
            }
        }
    }
    it
}

/// Makes a third of the slices copies of others, their own compliance larger by a share.
fn duplicate(it: &mut Case, apart: f64, random: &mut Random) {
    let n = it.data.size();
    for _ in 0..n.div_ceil(3) {
        let (from, to) = (random.below(n), random.below(n));
        if from == to {
            continue;
        }
        let c = &mut it.data.compliance;
        for k in 0..n {
            c[to * n + k] = c[from * n + k];
        }
        for k in 0..n {
            c[k * n + to] = c[k * n + from];
        }
        c[to * n + to] = c[from * n + from] * (1.0 + apart);
        it.data.local[to] = it.data.local[from];
        it.data.separation[to] = it.data.separation[from];
        it.data.closing[to] = it.data.closing[from];
        it.data.lever[to] = it.data.lever[from];
    }
}

impl Family {
    /// Whether forces are unique and not sensitive, so that those of another solver can be compared.
    pub fn keeps_forces(self, kind: Kind) -> bool {
        let spoilt = matches!(
            self,
            Self::Duplicates | Self::NearDuplicates | Self::TwelveDecades
        );
        !spoilt && matches!(kind, Kind::GearLike | Kind::Gram)
    }

    /// In words.
    pub fn words(self) -> String {
        let name = format!("{self:?}");
        let mut words = String::new();
        for c in name.chars() {
            if c.is_uppercase() && !words.is_empty() {
                words.push(' ');
            }
            words.extend(c.to_lowercase());
        }
        words
    }
}
