//! Ratings of scenes of both kinds: a table for each.

use gearmesh_scene::rating::{RatingFigure, RatingResult};

use crate::page::{Align, Section, Table, Text};
use crate::short_number::{short, usual_unit};

/// The section, where there are ratings.
pub(crate) fn section(title: &str, ratings: &[RatingResult]) -> Option<Section> {
    if ratings.is_empty() {
        return None;
    }
    let mut section = Section::new(format!("{title}: rating"));
    for rated in ratings {
        section = section.push(Text::paragraph(format!(
            "{}: {}.",
            rated.name, rated.method
        )));
        if let Some(missing) = &rated.incomplete {
            section = section.push(Text::note(format!("{}: {missing}", rated.name)));
        }
        section = match &rated.problem {
            Some(problem) => section.push(Text::note(format!("Not rated: {problem}"))),
            None => section.push(table(rated)),
        };
    }
    Some(section)
}

fn table(rated: &RatingResult) -> Table {
    let mut table = Table::new(rated.name.clone())
        .column("figure", Align::Left)
        .column("value", Align::Right)
        .column("unit", Align::Left);
    for figure in &rated.figures {
        let (value, unit) = in_usual_units(figure);
        table = table.row([figure.description.to_owned(), value, unit.to_owned()]);
    }
    table
}

fn in_usual_units(figure: &RatingFigure) -> (String, &'static str) {
    match (figure.unit, figure.value) {
        (_, value) if value == f64::INFINITY => ("no damage".to_owned(), ""),
        ("1", value) => (short(value), ""),
        (unit, value) => {
            let (factor, unit) = usual_unit(unit, value.abs());
            (short(factor * value), unit)
        }
    }
}
