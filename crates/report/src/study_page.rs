//! The page of a study: what each parameter does to each column, columns against each other, all cases.

mod cases_table;

use gearmesh_scene::optimise::{Trial, front};
use gearmesh_scene::study::{CaseResult, Selected, SelectedValue};
use gearmesh_scene::system_run::Figures;
use gearmesh_specification::study::Study;

use crate::column_words::{self, axis, shown};
use crate::min_max::ends;
use crate::page::{Align, Axis, KeyFigures, Page, PointSeries, ScatterChart, Section, Table, Text};
use crate::short;

/// Pictures of one kind beyond which a page would be long without saying more.
const MOST_PICTURES: usize = 24;

/// Columns whose pairs are drawn against each other.
const MOST_AGAINST: usize = 4;

/// Torques that are drawn in one picture.
const MOST_TORQUES: usize = 6;

/// Groups of as many cases each, by the values of a parameter that is drawn.
const GROUPS: usize = 8;

/// The page of an outcome.
#[must_use]
pub fn study_page(study: &Study, cases: &[CaseResult]) -> Page {
    let columns: Vec<Column> = (0..study.tables.columns.len())
        .filter_map(|place| Column::of(study, cases, place))
        .collect();
    let failed = cases.iter().filter(|case| case.figures.is_err()).count();
    let mut figures = KeyFigures::new();
    for column in columns.iter().take(8) {
        let [least, largest] = column.ends();
        let range = format!("{} … {}", short(least), short(largest));
        figures = figures.figure(column.words.clone(), range, column.unit);
    }
    let failures = match failed {
        0 => String::new(),
        _ => format!(" {failed} of them failed."),
    };
    let parameters = match study.tables.parameter.len() {
        1 => "1 parameter".to_owned(),
        count => format!("{count} parameters"),
    };
    let told = format!(
        "{} cases of {parameters}.{failures} The numbers are in study.csv.",
        cases.len()
    );
    let mut first = Section::new("What was found");
    if !figures.is_empty() {
        first = first.push(figures);
    }
    first = first.push(Text::paragraph(told));
    let mut page = Page::new(study.tables.title.clone())
        .subtitle("Parameter study")
        .section(first);
    if let Some(section) = main_effects(study, cases, &columns) {
        page = page.section(section);
    }
    if let Some(section) = against_each_other(cases, &columns) {
        page = page.section(section);
    }
    page.section(Section::new("Cases").push(cases_table::table(study, cases, &columns)))
        .footer(format!("by gearmesh {}", env!("CARGO_PKG_VERSION")))
}

/// What a case has of one of `count` columns: a number for each torque, or a single one.
fn of_column(case: &CaseResult, place: usize, count: usize) -> Vec<Selected> {
    let all = case.figures.as_ref().map_or(&[][..], Vec::as_slice);
    all.iter().skip(place).step_by(count).cloned().collect()
}

/// Whether a column that stands there for several torques does not depend on them in any case.
fn is_same_at_every_torque(of_cases: &[Vec<Selected>]) -> bool {
    let is_one = |own: &Vec<Selected>| own.windows(2).all(|pair| pair[0].value == pair[1].value);
    of_cases.iter().any(|own| own.len() > 1) && of_cases.iter().all(is_one)
}

/// A column of a study: its numbers at each torque, in the unit in which people read them.
struct Column {
    name: String,
    words: String,
    unit: &'static str,
    factor: f64,
    /// Name of a curve (a torque, or a figure of a series) and its number for each case.
    curves: Vec<(String, Vec<Option<f64>>)>,
}

impl Column {
    /// None where no case has a number.
    fn of(study: &Study, cases: &[CaseResult], place: usize) -> Option<Self> {
        let count = study.tables.columns.len();
        let own = |case: &CaseResult| of_column(case, place, count);
        let of_cases: Vec<Vec<Selected>> = cases.iter().map(own).collect();
        let sample = of_cases.iter().find(|own| !own.is_empty())?;
        let number = |row: usize, of: &dyn Fn(&SelectedValue) -> f64| -> Vec<Option<f64>> {
            let value = |own: &Vec<Selected>| Some(of(&own.get(row)?.value));
            let finite = |own: &Vec<Selected>| value(own).filter(|x: &f64| x.is_finite());
            of_cases.iter().map(finite).collect()
        };
        let figure = |of: fn(&Figures) -> f64| {
            move |value: &SelectedValue| match value {
                SelectedValue::Single(value) => *value,
                SelectedValue::Series(figures) => of(figures),
            }
        };
        let single = figure(|f| f.mean);
        let curves = match sample[0].value {
            SelectedValue::Series(_) => {
                let peak_to_peak = number(0, &figure(Figures::peak_to_peak));
                vec![
                    ("mean".to_owned(), number(0, &single)),
                    ("largest".to_owned(), number(0, &figure(|f| f.largest))),
                    ("peak to peak".to_owned(), peak_to_peak),
                ]
            }
            SelectedValue::Single(_) if is_same_at_every_torque(&of_cases) => {
                vec![("the same at every torque".to_owned(), number(0, &single))]
            }
            SelectedValue::Single(_) => sample
                .iter()
                .enumerate()
                .map(|(row, one)| {
                    let torque = one.torque_nm;
                    let name = torque.map_or_else(|| "cases".to_owned(), |t| format!("{t} N m"));
                    (name, number(row, &single))
                })
                .collect(),
        };
        let name = study.tables.columns[place].clone();
        let any = curves
            .iter()
            .any(|(_, values)| values.iter().any(Option::is_some));
        let mut column = Self {
            words: String::new(),
            unit: "",
            factor: 1.0,
            name,
            curves,
        };
        let [least, largest] = column.ends();
        let amount = least.abs().max(largest.abs());
        (column.words, column.unit, column.factor) = shown(&column.name, amount);
        let values = column.curves.iter_mut().flat_map(|(_, values)| values);
        for value in values.flatten() {
            *value *= column.factor;
        }
        any.then_some(column)
    }

    fn axis(&self) -> Axis {
        Axis::new(self.words.clone(), self.unit)
    }

    fn ends(&self) -> [f64; 2] {
        ends(
            self.curves
                .iter()
                .flat_map(|(_, v)| v.iter().flatten().copied()),
        )
    }

    /// What is to be small: the amount, or of what is better large its negative.
    fn badness(&self, value: f64) -> f64 {
        let better_large = ["stiffness_", "life_", "rating_", "contact_ratio"];
        let mut better_large = better_large.iter();
        match better_large.any(|start| self.name.starts_with(start)) {
            true => -value,
            false => value.abs(),
        }
    }

    /// Mean over the torques, of a series its mean; none where one is missing.
    fn number(&self, case: usize) -> Option<f64> {
        if self.curves.first()?.0 == "mean" {
            return self.curves[0].1[case];
        }
        let values: Option<Vec<f64>> = self.curves.iter().map(|(_, v)| v[case]).collect();
        let values = values?;
        Some(values.iter().sum::<f64>() / values.len() as f64)
    }
}

/// The number that a case gives a parameter; none of texts and of cases that leave it as it is.
fn value_of(case: &CaseResult, parameter: &str) -> Option<f64> {
    let setting = case
        .case
        .settings
        .iter()
        .find(|s| s.parameter == parameter)?;
    match &setting.value {
        toml::Value::Float(value) => Some(*value),
        toml::Value::Integer(value) => Some(*value as f64),
        _ => None,
    }
}

/// Cases that give a parameter any value, in groups: those of the same value, or of drawn values as many each.
fn groups(cases: &[CaseResult], parameter: &str) -> Vec<(String, Option<f64>, Vec<usize>)> {
    let mut by_value: Vec<(String, Option<f64>, Vec<usize>)> = Vec::new();
    for (k, case) in cases.iter().enumerate() {
        let mut settings = case.case.settings.iter();
        let Some(setting) = settings.find(|s| s.parameter == parameter) else {
            continue;
        };
        let word = setting.value.to_string();
        match by_value.iter_mut().find(|(known, ..)| *known == word) {
            Some((.., members)) => members.push(k),
            None => by_value.push((word, value_of(case, parameter), vec![k])),
        }
    }
    let numbers = by_value.iter().all(|(_, value, _)| value.is_some());
    if numbers {
        by_value.sort_by(|a, b| a.1.partial_cmp(&b.1).unwrap_or(std::cmp::Ordering::Equal));
    }
    // Few values, or nothing else that varies: the values themselves.
    let alone = cases.iter().all(|case| case.case.settings.len() < 2);
    if !numbers || alone || by_value.len() <= 2 * GROUPS {
        return by_value;
    }
    let share = by_value.len().div_ceil(GROUPS);
    by_value
        .chunks(share)
        .map(|chunk| {
            let members: Vec<usize> = chunk.iter().flat_map(|one| one.2.iter().copied()).collect();
            let values = chunk.iter().filter_map(|one| one.1);
            let middle = values.sum::<f64>() / chunk.len() as f64;
            (short(middle), Some(middle), members)
        })
        .collect()
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value;
        count += 1.0;
    }
    (count > 0.0).then(|| sum / count)
}

/// Pictures of each column over each parameter, and a table of what the means of groups differ by.
fn main_effects(study: &Study, cases: &[CaseResult], columns: &[Column]) -> Option<Section> {
    let mut table =
        Table::new("Largest less least mean of groups of cases, by the parameter's values")
            .columns(Align::Left, ["parameter", "column", "curve"])
            .columns(Align::Right, ["difference", "rank correlation"]);
    let mut pictures = Vec::new();
    for parameter in &study.tables.parameter {
        let (words, unit) = column_words::parameter(&parameter.name, &parameter.keys);
        let groups = groups(cases, &parameter.name);
        for column in columns {
            let chart = ScatterChart::new(
                format!("{} over {words}", column.words),
                axis((words.clone(), unit)),
                column.axis(),
            );
            let mut curves = Vec::new();
            for (name, values) in column.curves.iter().take(MOST_TORQUES) {
                let curve = Effect::of(cases, &parameter.name, &groups, values);
                if let Some([least, largest]) = curve.ends_of_means() {
                    let ranks = rank_correlation(&curve.points);
                    table.push_row([
                        words.clone(),
                        column.words.clone(),
                        name.clone(),
                        format!("{} {}", short(largest - least), column.unit),
                        ranks.map_or_else(String::new, |r| format!("{r:.2}")),
                    ]);
                }
                curves.extend(curve.drawn(name));
            }
            let mut told = Vec::new();
            if curves.iter().any(|(_, has_means)| *has_means) {
                told.push("lines: means of groups of cases".to_owned());
            }
            if column.curves.len() > MOST_TORQUES {
                let count = column.curves.len();
                told.push(format!("the first {MOST_TORQUES} of {count} torques"));
            }
            if !curves.is_empty() && pictures.len() < MOST_PICTURES {
                let series = curves.into_iter().map(|(series, _)| series);
                pictures.push(
                    series
                        .fold(chart, ScatterChart::series)
                        .told(told.join("; ")),
                );
            }
        }
    }
    if table.is_empty() {
        return None;
    }
    let told = "Other parameters vary among the cases of a group, where the design varies them together. Rank correlation (Spearman): 1 rises throughout, -1 falls throughout.";
    let section = Section::new("What each parameter does").push(Text::paragraph(told));
    let section = pictures.into_iter().fold(section, Section::push);
    Some(section.push(table))
}

/// What a column is over one parameter.
struct Effect {
    /// Of each group: its place on the axis, where it has one, and its mean.
    means: Vec<(Option<f64>, f64)>,
    /// Of each case: value of the parameter, and of the column.
    points: Vec<[f64; 2]>,
}

impl Effect {
    fn of(
        cases: &[CaseResult],
        parameter: &str,
        groups: &[(String, Option<f64>, Vec<usize>)],
        values: &[Option<f64>],
    ) -> Self {
        let mean_of = |members: &[usize]| mean(members.iter().filter_map(|k| values[*k]));
        let means = groups.iter();
        let means = means.filter_map(|(_, at, members)| Some((*at, mean_of(members)?)));
        let points = cases.iter().zip(values);
        let points = points.filter_map(|(case, y)| Some([value_of(case, parameter)?, (*y)?]));
        Self {
            means: means.collect(),
            points: points.collect(),
        }
    }

    /// Least and largest mean; none of a single group.
    fn ends_of_means(&self) -> Option<[f64; 2]> {
        (self.means.len() > 1).then(|| ends(self.means.iter().map(|m| m.1)))
    }

    /// The series of a chart, and whether its line joins means of several cases; none without a line.
    fn drawn(self, name: &str) -> Option<(PointSeries, bool)> {
        let line = self.means.iter();
        let line = line.filter_map(|(at, value)| Some([(*at)?, *value]));
        let line: Vec<[f64; 2]> = line.collect();
        let has_means = self.points.len() > line.len();
        (line.len() > 1).then(|| match has_means {
            true => (PointSeries::new(name, self.points).through(line), true),
            false => (PointSeries::new(name, line).joined(), false),
        })
    }
}

/// Spearman's rank correlation; none where nothing varies.
fn rank_correlation(points: &[[f64; 2]]) -> Option<f64> {
    let ranks = |axis: usize| {
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_by(|a, b| points[*a][axis].total_cmp(&points[*b][axis]));
        let mut ranks = vec![0.0; points.len()];
        let mut first = 0;
        while first < order.len() {
            let value = points[order[first]][axis];
            let alike = order[first..].iter();
            let count = alike.take_while(|k| points[**k][axis] == value).count();
            // Equal values share their ranks' mean.
            let rank = first as f64 + 0.5 * (count as f64 - 1.0);
            for k in &order[first..first + count] {
                ranks[*k] = rank;
            }
            first += count;
        }
        ranks
    };
    let (a, b) = (ranks(0), ranks(1));
    let middle = 0.5 * (points.len() as f64 - 1.0);
    let product = |a: &[f64], b: &[f64]| -> f64 {
        let pairs = a.iter().zip(b);
        pairs.map(|(x, y)| (x - middle) * (y - middle)).sum()
    };
    let scale = (product(&a, &a) * product(&b, &b)).sqrt();
    (scale > 0.0).then(|| product(&a, &b) / scale)
}

/// Columns against each other, with the cases that no other one beats.
fn against_each_other(cases: &[CaseResult], columns: &[Column]) -> Option<Section> {
    let columns = &columns[..columns.len().min(MOST_AGAINST)];
    let mut section = Section::new("Columns against each other").push(Text::paragraph(
        "A point for each case: means over the torques, or over the series. The front is that of the smallest amounts, of stiffness, life, rating and contact ratio that of the largest: no case is better in both.",
    ));
    let mut drawn = false;
    for (a, first) in columns.iter().enumerate() {
        for second in &columns[a + 1..] {
            let trials: Vec<(usize, Trial)> = (0..cases.len())
                .filter_map(|k| {
                    let (x, y) = (first.number(k)?, second.number(k)?);
                    let trial = Trial {
                        values: vec![k as f64, x, y],
                        objectives: vec![first.badness(x), second.badness(y)],
                        yielding: None,
                    };
                    Some((k, trial))
                })
                .collect();
            if trials.len() < 2 {
                continue;
            }
            drawn = true;
            let point = |trial: &Trial| [trial.values[1], trial.values[2]];
            let all: Vec<Trial> = trials.iter().map(|(_, trial)| trial.clone()).collect();
            let best = front(&all);
            let name = |trial: &Trial| cases[trial.values[0] as usize].case.name();
            let chart = ScatterChart::new(
                format!("{} against {}", second.words, first.words),
                first.axis(),
                second.axis(),
            )
            .series(PointSeries::new("cases", all.iter().map(point).collect()))
            .series(
                PointSeries::new("front", best.iter().map(point).collect())
                    .joined()
                    .labels(best.iter().map(name).collect()),
            );
            section = section.push(chart);
        }
    }
    drawn.then_some(section)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn ranks_tell_rise_and_fall_and_share_ties() {
        let points: Vec<[f64; 2]> = (0..9).map(|k| [f64::from(k), f64::from(k * k)]).collect();
        assert!((rank_correlation(&points).unwrap() - 1.0).abs() < 1e-12);
        let falling: Vec<[f64; 2]> = points.iter().map(|p| [p[0], -p[1]]).collect();
        assert!((rank_correlation(&falling).unwrap() + 1.0).abs() < 1e-12);
        // Ranks of x 0, 1, 2, 3 and of y 0.5, 0.5, 2.5, 2.5: by hand 4/√(5·4).
        let ties = [[0.0, 1.0], [1.0, 1.0], [2.0, 5.0], [3.0, 5.0]];
        assert!((rank_correlation(&ties).unwrap() - 4.0 / 20.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(rank_correlation(&[[0.0, 1.0], [1.0, 1.0]]), None);
    }
}
