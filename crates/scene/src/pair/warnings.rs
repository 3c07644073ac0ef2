//! Where the model's assumptions are strained: each warning names the assumption and the figure.

use std::collections::BTreeMap;

/// Pressure over Young's modulus above which steel yields under the contact.
pub const ELASTIC_SHARE: f64 = 0.02;

/// Young's modulus of steel \[Pa\]: columns of pressure do not say whose it is.
const STEEL_PA: f64 = 206e9;

/// Name of a column and its largest pressure \[Pa\].
pub type ColumnPressure = (String, f64);

/// The column with the largest pressure, where steel yields under it.
pub fn yielding(columns: impl Iterator<Item = ColumnPressure>) -> Option<ColumnPressure> {
    let too_large = columns.filter(|(_, pa)| *pa > ELASTIC_SHARE * STEEL_PA);
    too_large.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// A sentence about a column under whose pressure steel yields.
#[must_use]
pub fn yielding_in_words((name, pa): &ColumnPressure) -> String {
    format!(
        "{name}: the pressure reaches {:.2} GPa; above {} % of Young's modulus, {:.2} GPa for steel, the material yields, and the elastic contact \
         computed here no longer holds",
        1e-9 * pa,
        100.0 * ELASTIC_SHARE,
        1e-9 * ELASTIC_SHARE * STEEL_PA
    )
}

/// Assumptions that a load can break.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Assumption {
    /// Hertz: the contact is narrow compared with the tooth.
    NarrowContact,
    /// Linear elasticity of the material under the contact.
    ElasticMaterial,
    /// Rigid geometry: the deflection is small compared with the teeth.
    SmallDeflection,
    /// The logarithm of the local term was frozen to stay monotone.
    LocalTermCapped,
}

/// All of them, in the order in which a position states its figures.
pub(super) const ASSUMPTIONS: [Assumption; 4] = [
    Assumption::NarrowContact,
    Assumption::ElasticMaterial,
    Assumption::SmallDeflection,
    Assumption::LocalTermCapped,
];

impl Assumption {
    fn text(self, value: f64) -> String {
        match self {
            Self::NarrowContact => format!(
                "narrow contact: the Hertz half width reaches {:.1} % of the distance to the opposite flank (above 10 % the half-plane theory no longer holds)",
                value * 100.0
            ),
            Self::ElasticMaterial => format!(
                "elastic material: the Hertz pressure reaches {:.2} % of Young's modulus (above 2 % steel yields)",
                value * 100.0
            ),
            Self::SmallDeflection => format!(
                "small deflection: the teeth deflect by {:.2} % of the base pitch (above 1 % contact starts far outside the line of action)",
                value * 100.0
            ),
            Self::LocalTermCapped => format!(
                "local compliance: on {value:.0} slices the load is beyond the range of the local term's logarithm, whose slope was frozen (the Hertz width comes near that of the hats: take fewer reduction.roll_stations)"
            ),
        }
    }

    fn limit(self) -> f64 {
        match self {
            Self::NarrowContact => 0.1,
            Self::ElasticMaterial => ELASTIC_SHARE,
            Self::SmallDeflection => 0.01,
            Self::LocalTermCapped => 0.5,
        }
    }
}

/// Collects the worst violation of each assumption, with the torque at which it occurred.
#[derive(Debug, Clone, Default)]
pub struct Warnings {
    worst: BTreeMap<Assumption, (f64, f64)>,
}

impl Warnings {
    /// Notes a figure; kept where it is above the assumption's limit and the worst so far.
    pub fn note(&mut self, assumption: Assumption, value: f64, torque_nm: f64) {
        if value > assumption.limit()
            && self
                .worst
                .get(&assumption)
                .is_none_or(|(worst, _)| value > *worst)
        {
            self.worst.insert(assumption, (value, torque_nm));
        }
    }

    /// The warnings as sentences.
    pub fn sentences(&self) -> Vec<String> {
        self.worst
            .iter()
            .map(|(a, (value, torque))| format!("at {torque} N m: {}", a.text(*value)))
            .collect()
    }
}
