//! Seeded random problems.

use super::Data;
use gearmesh_contact::nlcp::{ContactBody, LineContact, LocalLaw};

/// Numbers that are the same in every run.
pub struct Random(fastrand::Rng);

impl Random {
    pub fn new(seed: u64) -> Self {
        Random(fastrand::Rng::with_seed(seed))
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0.f64()
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in the logarithm.
    pub fn log_between(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    pub fn below(&mut self, n: usize) -> usize {
        self.0.usize(..n)
    }

    /// Roughly normal: sum of twelve uniforms.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.unit()).sum::<f64>() - 6.0
    }
}

/// Kind of compliance matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Slices of some bodies side by side: coupling that decays along the width, a constant share from the blank.
    GearLike,
    /// Gram matrix of random vectors: entries of both signs.
    Gram,
    /// Gram matrix of lower rank with a ridge of 1e-10 of its diagonal.
    NearlySingular,
    /// Condition number 1e12: random orthogonal vectors, logarithmically spaced eigenvalues.
    Condition1e12,
}

pub const KINDS: [Kind; 4] = [
    Kind::GearLike,
    Kind::Gram,
    Kind::NearlySingular,
    Kind::Condition1e12,
];

/// Typical compliance of a slice \[m/N\].
const COMPLIANCE: f64 = 1e-8;

pub fn compliance(kind: Kind, n: usize, random: &mut Random) -> Vec<f64> {
    match kind {
        Kind::GearLike => gear_like(n, random),
        Kind::Gram => gram(n, n + 2, 0.0, random),
        Kind::NearlySingular => gram(n, n.div_ceil(2), 1e-10, random),
        Kind::Condition1e12 => spectrum(n, random),
    }
}

fn gear_like(n: usize, random: &mut Random) -> Vec<f64> {
    let per_tooth = 1 + random.below(n);
    let decay = random.between(0.3, 4.0);
    let share = random.between(0.0, 0.5);
    let stiffness: Vec<f64> = (0..n).map(|_| random.between(0.6, 1.6).sqrt()).collect();
    let mut c = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..n {
            let mut value = share;
            if i / per_tooth == j / per_tooth {
                value += (-(i.abs_diff(j) as f64) / decay).exp();
            }
            c[i * n + j] = COMPLIANCE * value * stiffness[i] * stiffness[j];
        }
    }
    c
}

fn gram(n: usize, rank: usize, ridge: f64, random: &mut Random) -> Vec<f64> {
    let rows: Vec<f64> = (0..n * rank).map(|_| random.normal()).collect();
    let mut c = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let value: f64 = (0..rank)
                .map(|k| rows[i * rank + k] * rows[j * rank + k])
                .sum();
            let value = COMPLIANCE * (value / rank as f64 + if i == j { ridge } else { 0.0 });
            c[i * n + j] = value;
            c[j * n + i] = value;
        }
    }
    c
}

fn spectrum(n: usize, random: &mut Random) -> Vec<f64> {
    let mut c = vec![0.0; n * n];
    for i in 0..n {
        let exponent = if n == 1 {
            0.0
        } else {
            -12.0 * i as f64 / (n - 1) as f64
        };
        c[i * n + i] = COMPLIANCE * 10f64.powf(exponent);
    }
    // Three random reflections H C H mix the eigenvectors.
    for _ in 0..3 {
        let v: Vec<f64> = (0..n).map(|_| random.normal()).collect();
        let norm: f64 = v.iter().map(|x| x * x).sum();
        let cv: Vec<f64> = (0..n)
            .map(|i| (0..n).map(|j| c[i * n + j] * v[j]).sum())
            .collect();
        let vcv: f64 = v.iter().zip(&cv).map(|(a, b)| a * b).sum();
        for i in 0..n {
            for j in 0..=i {
                let value = c[i * n + j] - 2.0 / norm * (v[i] * cv[j] + cv[i] * v[j])
                    + 4.0 / (norm * norm) * vcv * v[i] * v[j];
                c[i * n + j] = value;
                c[j * n + i] = value;
            }
        }
    }
    c
}

/// Steel slice contact of random width, radius and depth; the floor is a millionth of `mean_force` \[N\].
pub fn weber(mean_force: f64, random: &mut Random) -> LocalLaw {
    let body = |random: &mut Random| ContactBody {
        youngs_modulus_pa: random.between(7e10, 2.1e11),
        poisson_ratio: random.between(0.2, 0.35),
        depth_m: random.log_between(1e-3, 1e-2),
    };
    let bodies = [body(random), body(random)];
    let contact = LineContact {
        width_m: random.log_between(1e-3, 1e-2),
        relative_radius_m: random.log_between(3e-3, 3e-2),
        bodies,
    };
    LocalLaw::weber_banaschek(&contact, 1e-6 * mean_force).unwrap()
}

/// A problem and a load for it.
pub struct Case {
    pub kind: Kind,
    pub linear: bool,
    pub data: Data,
    pub load: f64,
}

/// One random problem of up to `largest` slices.
///
/// The mean force is uniform in its logarithm from 1e-3 N to 1e6 N; separations are of the size of the deflection, all
/// equal, or a million times larger; every third problem has a lever arm that differs from `w` by a friction-like
/// share.
pub fn case(largest: usize, random: &mut Random) -> Case {
    let n = 1 + random.below(largest);
    let kind = KINDS[random.below(KINDS.len())];
    let linear = random.unit() < 0.5;
    let mean_force = random.log_between(1e-3, 1e6);
    let mut compliance = compliance(kind, n, random);
    if kind == Kind::GearLike && random.unit() < 0.1 {
        // One tooth far stiffer than the rest.
        let factor = random.log_between(1e-3, 1.0);
        for k in 0..n {
            compliance[k] *= factor;
            compliance[k * n] *= factor;
        }
    }
    let local = (0..n)
        .map(|_| {
            if linear || random.unit() < 0.1 {
                LocalLaw::none()
            } else {
                weber(mean_force, random)
            }
        })
        .collect();
    let size = COMPLIANCE * mean_force;
    let offset = size * random.between(-10.0, 10.0);
    let separation = match random.below(4) {
        0 => vec![offset; n],
        1 => (0..n)
            .map(|_| offset + size * random.log_between(1e-6, 1e6))
            .collect(),
        _ => (0..n)
            .map(|_| offset + size * random.unit() * n as f64)
            .collect(),
    };
    let closing: Vec<f64> = if random.unit() < 0.5 {
        vec![1.0; n]
    } else {
        (0..n).map(|_| random.between(0.8, 1.2)).collect()
    };
    let radius = random.log_between(0.01, 1.0);
    let friction = if random.unit() < 0.33 { 0.1 } else { 0.0 };
    let lever: Vec<f64> = closing
        .iter()
        .map(|w| radius * w * (1.0 + friction * random.between(-1.0, 1.0)))
        .collect();
    let load = mean_force * lever.iter().sum::<f64>();
    Case {
        kind,
        linear,
        data: Data {
            compliance,
            local,
            separation,
            closing,
            lever,
        },
        load,
    }
}
