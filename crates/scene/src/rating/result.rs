//! What ratings have given, and how it is kept in result files.

use std::path::Path;

use gearmesh_model::{DataArray, DataTree, FileError};

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
#[derive(Debug, Clone, PartialEq)]
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

    /// The value of a figure.
    #[must_use]
    pub fn figure(&self, name: &str) -> Option<f64> {
        let mut figures = self.figures.iter();
        figures.find(|f| f.name == name).map(|f| f.value)
    }
}

/// All figures there are: name, unit, description.
const KINDS: [(&str, &str, &str); 15] = [
    ("least_stress_Pa", "Pa", "smallest stress at the gauge"),
    ("largest_stress_Pa", "Pa", "largest stress at the gauge"),
    ("cycles", "1", "cycles counted, halves as one half"),
    (
        "most_damaging_amplitude_Pa",
        "Pa",
        "stress amplitude of the cycle that does most of the damage, 0 without damage",
    ),
    (
        "most_damaging_mean_Pa",
        "Pa",
        "mean stress of the cycle that does most of the damage, 0 without damage",
    ),
    ("damage", "1", "Miner's sum of one passage of the history"),
    (
        "life_passages",
        "1",
        "passages of the history until the sum is 1",
    ),
    ("life_h", "h", "the same in hours"),
    (
        "life_revolutions",
        "1",
        "the same in revolutions of the gear",
    ),
    (
        "largest_force_N",
        "N",
        "largest normal force, which one tooth is taken to bear alone at its root",
    ),
    ("lewis_factor_gear1", "1", "Lewis's form factor Y of gear 1"),
    ("lewis_factor_gear2", "1", "Lewis's form factor Y of gear 2"),
    (
        "lewis_stress_gear1_Pa",
        "Pa",
        "Lewis's nominal root stress of gear 1",
    ),
    (
        "lewis_stress_gear2_Pa",
        "Pa",
        "Lewis's nominal root stress of gear 2",
    ),
    (
        "hertz_pressure_Pa",
        "Pa",
        "nominal flank pressure where the contact lines are shortest",
    ),
];

/// Figures of these names and values, in the order of the names.
pub(super) fn figures(values: &[(&str, f64)]) -> Vec<RatingFigure> {
    let kinds = KINDS.iter().filter_map(|&(name, unit, description)| {
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

/// Puts ratings into a result file.
pub fn put_ratings(tree: &mut DataTree, ratings: &[RatingResult]) {
    for (i, rating) in ratings.iter().enumerate() {
        let name = |part: &str| format!("ratings/{i}/{part}");
        tree.put_text(name("name"), rating.name.clone());
        tree.put_text(name("method"), rating.method.clone());
        for (part, text) in [
            ("problem", &rating.problem),
            ("incomplete", &rating.incomplete),
        ] {
            tree.put_text(name(part), text.clone().unwrap_or_default());
        }
        for f in &rating.figures {
            let value = DataArray::scalar(f.value, f.unit, f.description);
            tree.put(name(f.name), value);
        }
    }
}

/// Takes them out again; none from a file without.
///
/// # Errors
/// [`FileError`] for a part that is missing or of another kind.
pub fn take_ratings(tree: &mut DataTree, path: &Path) -> Result<Vec<RatingResult>, FileError> {
    let count = tree.children("ratings").len();
    let mut rating = |i: usize| {
        let name = |part: &str| format!("ratings/{i}/{part}");
        let problem = Some(tree.take_text(path, &name("problem"))?).filter(|p| !p.is_empty());
        // Files of older programs do not say.
        let incomplete = tree.texts.remove(&name("incomplete"));
        let mut values = Vec::new();
        for (figure, _, _) in KINDS {
            if tree.arrays.contains_key(&name(figure)) {
                values.push((figure, tree.take_scalar(path, &name(figure))?));
            }
        }
        Ok(RatingResult {
            name: tree.take_text(path, &name("name"))?,
            method: tree.take_text(path, &name("method"))?,
            problem,
            incomplete: incomplete.filter(|text| !text.is_empty()),
            figures: figures(&values),
        })
    };
    (0..count).map(&mut rating).collect()
}
