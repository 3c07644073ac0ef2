//! What ratings have given, and how it is kept in result files.

use gearmesh_model::{Fields, FileError, Record};

use super::rule::RatingRule;

/// A figure of a rating.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RatingFigure {
    /// Name with unit.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// What it is.
    pub description: &'static str,
    /// Value; infinite lives are infinite.
    pub value: f64,
}

/// What a rating has given.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RatingResult {
    /// What is rated.
    pub name: String,
    /// How.
    pub method: String,
    /// Why there are no figures, where there are none.
    pub problem: Option<String>,
    /// What the run has not seen of what is rated, so that a longer one may change the figures.
    pub incomplete: Option<String>,
    /// Figures.
    pub figures: Vec<RatingFigure>,
    /// What of the loads is beyond a limit, in sentences.
    pub warnings: Vec<String>,
}

impl RatingResult {
    /// A rating with its figures, or the reason why it has none.
    #[must_use]
    pub fn new(name: String, method: String, figures: Result<Vec<RatingFigure>, String>) -> Self {
        let (figures, problem) = match figures {
            Ok(figures) => (figures, None),
            Err(problem) => (Vec::new(), Some(problem)),
        };
        Self {
            name,
            method,
            problem,
            incomplete: None,
            figures,
            warnings: Vec::new(),
        }
    }

    /// The same with what the run has not seen of what is rated.
    #[must_use]
    pub fn incomplete_by(self, missing: Option<String>) -> Self {
        Self {
            incomplete: missing,
            ..self
        }
    }

    /// The same with warnings.
    #[must_use]
    pub fn warning(self, warnings: Vec<String>) -> Self {
        Self { warnings, ..self }
    }

    /// All that is to be reported of it, in sentences that name it: why it has no figures, what is beyond a limit.
    pub fn reported(&self) -> impl Iterator<Item = String> + '_ {
        let problem = self.problem.iter();
        let problem = problem.map(|problem| format!("{} is not rated: {problem}", self.name));
        let warnings = self.warnings.iter();
        problem.chain(warnings.map(|warning| format!("{}: {warning}", self.name)))
    }

    /// The value of a figure.
    #[must_use]
    pub fn figure(&self, name: &str) -> Option<f64> {
        let mut figures = self.figures.iter();
        figures.find(|f| f.name == name).map(|f| f.value)
    }
}

/// All figures there are: name, unit, description.
#[rustfmt::skip] // a table, a row a line
const KINDS: [[&str; 3]; 39] = [
    ["least_stress_Pa", "Pa", "smallest stress at the gauge"],
    ["largest_stress_Pa", "Pa", "largest stress at the gauge"],
    ["cycles", "1", "cycles counted, halves as one half"],
    ["most_damaging_amplitude_Pa", "Pa", "stress amplitude of the cycle that does most of the damage, 0 without damage"],
    ["most_damaging_mean_Pa", "Pa", "mean stress of the cycle that does most of the damage, 0 without damage"],
    ["damage", "1", "Miner's sum of one passage of the history"],
    ["life_passages", "1", "passages of the history until the sum is 1"],
    ["life_h", "h", "the same in hours"],
    ["life_revolutions", "1", "the same in revolutions of the gear"],
    ["largest_force_N", "N", "largest normal force, which one tooth is taken to carry alone at its root"],
    ["lewis_factor_gear1", "1", "Lewis's form factor Y of gear 1"],
    ["lewis_factor_gear2", "1", "Lewis's form factor Y of gear 2"],
    ["lewis_stress_gear1_Pa", "Pa", "Lewis's nominal root stress of gear 1"],
    ["lewis_stress_gear2_Pa", "Pa", "Lewis's nominal root stress of gear 2"],
    ["hertz_pressure_Pa", "Pa", "Hertz's flank pressure where the contact lines are shortest"],
    ["iso_contact_stress_Pa", "Pa", "nominal contact stress sigma_H0 of ISO 6336-2 at the pitch point: Z_H Z_E Z_epsilon Z_beta, all K one"],
    ["iso_Z_H", "1", "zone factor Z_H of ISO 6336-2"],
    ["iso_Z_epsilon", "1", "contact ratio factor of ISO 6336-2"],
    ["iso_Z_beta", "1", "helix angle factor of ISO 6336-2"],
    ["iso_root_stress_gear1_Pa", "Pa", "nominal root stress sigma_F0 of ISO 6336-3, method B, of gear 1: Y_F Y_S Y_beta Y_B Y_DT, all K one"],
    ["iso_Y_F_gear1", "1", "form factor Y_F of ISO 6336-3 of gear 1"],
    ["iso_Y_S_gear1", "1", "stress correction factor Y_S of the fillet's notch of gear 1"],
    ["iso_Y_beta_gear1", "1", "helix angle factor of ISO 6336-3"],
    ["iso_Y_B_gear1", "1", "rim factor Y_B of gear 1"],
    ["iso_Y_DT_gear1", "1", "deep tooth factor Y_DT of ISO 6336-3 of gear 1"],
    ["iso_root_stress_gear2_Pa", "Pa", "nominal root stress sigma_F0 of ISO 6336-3, method B, of gear 2: Y_F Y_S Y_beta Y_B Y_DT, all K one"],
    ["iso_Y_F_gear2", "1", "form factor Y_F of ISO 6336-3 of gear 2"],
    ["iso_Y_S_gear2", "1", "stress correction factor Y_S of the fillet's notch of gear 2"],
    ["iso_Y_beta_gear2", "1", "helix angle factor of ISO 6336-3"],
    ["iso_Y_B_gear2", "1", "rim factor Y_B of gear 2"],
    ["iso_Y_DT_gear2", "1", "deep tooth factor Y_DT of ISO 6336-3 of gear 2"],
    ["bearing_equivalent_load_N", "N", "dynamic equivalent load P of ISO 281 over the whole history"],
    ["bearing_l10_mrev", "1", "basic rating life L10 in millions of turns"],
    ["bearing_l10r_mrev", "1", "reference rating life L10r of the loads of all rolling elements in millions of turns"],
    ["bearing_l10mr_mrev", "1", "modified reference rating life L10mr in millions of turns"],
    ["bearing_mean_speed_rad_per_s", "rad/s", "mean speed of the rings against each other"],
    ["bearing_l10_h", "h", "basic rating life in hours"],
    ["bearing_l10r_h", "h", "reference rating life in hours"],
    ["bearing_l10mr_h", "h", "modified reference rating life in hours"],
];

/// Figures of these names and values, in the order of the names.
pub(super) fn figures(values: &[(&str, f64)]) -> Vec<RatingFigure> {
    let kinds = KINDS.into_iter().filter_map(|[name, unit, description]| {
        let (_, value) = values.iter().find(|(other, _)| *other == name)?;
        Some(RatingFigure {
            name,
            unit,
            description,
            value: *value,
        })
    });
    kinds.collect()
}

/// Names of the figures that a rule may give.
pub(crate) fn figure_names(rule: &RatingRule) -> Vec<&'static str> {
    let is_nominal = |name: &str| {
        let starts = ["lewis_", "hertz_", "iso_", "largest_force_"];
        starts.iter().any(|start| name.starts_with(start))
    };
    let names = KINDS.into_iter().map(|[name, ..]| name);
    let of_rule = |name: &&str| match rule {
        RatingRule::BearingLife(_) => name.starts_with("bearing_"),
        RatingRule::Nominal(_) => is_nominal(name),
        RatingRule::Fatigue(_) => !name.starts_with("bearing_") && !is_nominal(name),
    };
    names.filter(of_rule).collect()
}

impl Record for RatingResult {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.text("name", &mut self.name, "what is rated")?;
        f.text("method", &mut self.method, "how")?;
        let problem = "why there are no figures; empty otherwise";
        text_or_empty(f, "problem", &mut self.problem, problem)?;
        // Files of older programs do not say.
        if f.has("incomplete") {
            let what = "what the run has not seen of the quantity's period; empty where nothing is missing";
            text_or_empty(f, "incomplete", &mut self.incomplete, what)?;
        }
        if f.has("warnings") {
            let what = "what of the loads is beyond a limit";
            f.lines("warnings", &mut self.warnings, what)?;
        }
        let mut values = Vec::new();
        for [name, unit, description] in KINDS {
            let mut value = self.figure(name);
            f.number_if_there(name, &mut value, unit, description)?;
            values.extend(value.map(|value| (name, value)));
        }
        self.figures = figures(&values);
        Ok(())
    }
}

/// A text that may be missing in memory and is empty in the file then.
fn text_or_empty(
    f: &mut Fields<'_>,
    name: &str,
    value: &mut Option<String>,
    what: &str,
) -> Result<(), FileError> {
    let mut text = value.take().unwrap_or_default();
    f.text(name, &mut text, what)?;
    *value = Some(text).filter(|text| !text.is_empty());
    Ok(())
}
