//! Values of arguments: the words of files, as sides of the teeth and local contact terms, and bounded numbers.

use crate::mesh_file::LengthUnit;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use gearmesh_contact::LocalContact;
use gearmesh_geometry::Flank;

/// `right` and `left`.
pub(crate) fn flank_words() -> impl TypedValueParser<Value = Flank> {
    words(&Flank::ALL, Flank::name, |flank| match flank {
        Flank::Right => "Faces clockwise",
        Flank::Left => "Faces counter-clockwise",
    })
}

/// `m` and `mm`.
pub(crate) fn length_words() -> impl TypedValueParser<Value = LengthUnit> {
    words(&LengthUnit::ALL, LengthUnit::name, |unit| match unit {
        LengthUnit::M => "Metres",
        LengthUnit::Mm => "Millimetres",
    })
}

/// The local contact terms.
pub(crate) fn local_words() -> impl TypedValueParser<Value = LocalContact> {
    words(
        &LocalContact::ALL,
        LocalContact::name,
        |local| match local {
            LocalContact::None => "The mesh's own near field",
            LocalContact::WeberBanaschek => "Weber and Banaschek's logarithm on the patterns",
            LocalContact::Calibrated => {
                "The mesh's near field corrected by the model's plane-strain calibration"
            }
        },
    )
}

/// `wall` and `processor`: whether it is that of the processor.
pub(crate) fn time_words() -> impl TypedValueParser<Value = bool> {
    let name = |is_processor| if is_processor { "processor" } else { "wall" };
    let help = |is_processor| {
        if is_processor {
            "Processor time"
        } else {
            "Wall time"
        }
    };
    words(&[false, true], name, help)
}

/// A number that is more than zero.
///
/// # Errors
/// What is allowed.
pub fn positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "no number".to_owned())?;
    if value > 0.0 && value < 1e9 {
        Ok(value)
    } else {
        Err("allowed is more than 0, less than 1e9".to_owned())
    }
}

/// A parser of the names of these values, with a line of help for each.
fn words<T: Copy + Send + Sync + 'static>(
    values: &'static [T],
    name: fn(T) -> &'static str,
    help: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let possible = values
        .iter()
        .map(|&value| PossibleValue::new(name(value)).help(help(value)));
    PossibleValuesParser::new(possible).try_map(move |word| {
        let found = values.iter().copied().find(|&value| name(value) == word);
        found.ok_or("no such word")
    })
}
