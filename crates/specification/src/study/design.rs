//! How the values of a study's parameters are combined to cases.
//!
//! | design | cases |
//! | --- | --- |
//! | `one-at-a-time` | the scene as it is, then each value by itself |
//! | `grid` | every combination |
//! | `latin-hypercube` | as many as `samples` says; each parameter has one of them in each of as many shares of equal probability, in a random order (McKay, Beckman, Conover, Technometrics 21 (1979) 239-245) |
//! | `random` | as many as `samples` says, drawn one by one; more samples leave the first ones as they were |
//!
//! What is random depends on the seed and on the parameter's name alone: a further parameter changes none of the
//! others.

use fastrand::Rng;
use schemars::JsonSchema;
use serde::Deserialize;

use super::study_file::ParameterTable;

/// How the parameters are combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Design {
    /// The scene as it is, then each parameter by itself.
    #[default]
    OneAtATime,
    /// Every combination.
    Grid,
    /// Samples that fill the ranges evenly.
    LatinHypercube,
    /// Samples drawn independently.
    Random,
}

impl Design {
    /// Whether cases are drawn and not listed.
    #[must_use]
    pub fn is_sampled(self) -> bool {
        matches!(self, Self::LatinHypercube | Self::Random)
    }
}

/// One parameter at one value.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Name of the parameter.
    pub parameter: String,
    /// Keys of the scene that take the value.
    pub keys: Vec<String>,
    /// The value.
    pub value: toml::Value,
}

impl Setting {
    /// A value at one key, whose name it has.
    #[must_use]
    pub fn of(key: &str, value: impl Into<toml::Value>) -> Self {
        Self {
            parameter: key.to_owned(),
            keys: vec![key.to_owned()],
            value: value.into(),
        }
    }
}

/// What is changed in one run; nothing in the scene as it is.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Case {
    /// The settings.
    pub settings: Vec<Setting>,
    /// Keys that are taken away after them.
    pub removed: Vec<String>,
}

impl Case {
    /// Of some settings.
    #[must_use]
    pub fn of(settings: Vec<Setting>) -> Self {
        let removed = Vec::new();
        Self { settings, removed }
    }

    /// `load = -900.0, speed = 250.0`, or `as it is`.
    #[must_use]
    pub fn name(&self) -> String {
        if self.settings.is_empty() && self.removed.is_empty() {
            return "as it is".to_owned();
        }
        let settings = self.settings.iter();
        let words = settings.map(|setting| format!("{} = {}", setting.parameter, setting.value));
        let removed = self.removed.iter().map(|key| format!("without {key}"));
        let words = words.chain(removed);
        words.collect::<Vec<_>>().join(", ")
    }
}

/// The cases of a design, in the order of the table; `samples` and `seed` where they are drawn.
pub(super) fn cases(
    design: Design,
    parameters: &[ParameterTable],
    (samples, seed): (usize, u64),
) -> Vec<Case> {
    let setting = |parameter: &ParameterTable, value: toml::Value| Setting {
        parameter: parameter.name.clone(),
        keys: parameter.keys.clone(),
        value,
    };
    let listed = parameters.iter().map(|parameter| {
        let values = parameter.listed().into_iter();
        values
            .map(|value| setting(parameter, value))
            .collect::<Vec<_>>()
    });
    match design {
        Design::OneAtATime => {
            let varied = listed.flatten().map(|setting| Case::of(vec![setting]));
            std::iter::once(Case::default()).chain(varied).collect()
        }
        Design::Grid => listed.fold(vec![Case::default()], |cases, settings| {
            let extended = cases.iter().flat_map(|case| {
                settings.iter().map(|setting| {
                    let mut case = case.clone();
                    case.settings.push(setting.clone());
                    case
                })
            });
            extended.collect()
        }),
        Design::LatinHypercube | Design::Random => {
            let mut cases = vec![Case::default(); samples];
            for parameter in parameters {
                let drawn = probabilities(design, samples, seeded(seed, &parameter.name));
                for (case, probability) in cases.iter_mut().zip(drawn) {
                    let value = parameter.at_probability(probability);
                    case.settings.push(setting(parameter, value));
                }
            }
            cases
        }
    }
}

/// Random numbers that belong to a name: FNV-1a of it, mixed with the seed.
pub fn seeded(seed: u64, name: &str) -> Rng {
    let start = 0xcbf2_9ce4_8422_2325_u64 ^ seed;
    let mixed = name.bytes().fold(start, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    Rng::with_seed(mixed)
}

/// Cumulative probabilities, one a sample, strictly between 0 and 1.
pub fn probabilities(design: Design, samples: usize, mut rng: Rng) -> Vec<f64> {
    let inside = |p: f64| p.clamp(1e-12, 1.0 - 1e-12);
    if design == Design::Random {
        return (0..samples).map(|_| inside(rng.f64())).collect();
    }
    let mut shares: Vec<usize> = (0..samples).collect();
    rng.shuffle(&mut shares);
    let place = |share: usize, rng: &mut Rng| inside((share as f64 + rng.f64()) / samples as f64);
    shares
        .into_iter()
        .map(|share| place(share, &mut rng))
        .collect()
}
