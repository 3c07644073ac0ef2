//! Functions of a table as a universal file: data set 164 (units), then a data set 58 in text for each function. One
//! function after the other is read and written, so that none of the others is in memory.
//!
//! Source: the descriptions of both data sets by the Structural Dynamics Research Laboratory, University of Cincinnati;
//! tests read the files by pyuff.

use std::io::Write;

use super::functions::{Function, for_each_function};
use super::{ExportError, Table};

/// Specific data types of data set 58, by SI unit; all else is "general".
const KINDS: [(&str, u32); 6] = [
    ("m", 8),
    ("N", 13),
    ("m/s", 11),
    ("m/s²", 12),
    ("Pa", 15),
    ("s", 17),
];
const GENERAL: u32 = 1;

/// What the format's ASCII has no signs for.
const ASCII: [(&str, &str); 4] = [("·", "*"), ("²", "2"), ("√", "sqrt "), ("µε", "ustrain")];

/// Letters of a line of a head, and of the label and the unit of an axis.
const LINE: usize = 80;
const LABEL: usize = 20;

/// Steps that differ by less, as a share, are even.
const EVEN: f64 = 1e-6;

/// Writes the functions of a table; how many there are. `title` is that of the result, `program` what has written it.
///
/// # Errors
/// [`ExportError::Write`]; [`ExportError::File`] if a column cannot be read.
pub fn write_universal(
    table: &Table<'_>,
    (title, program): (&str, &str),
    out: &mut dyn Write,
) -> Result<usize, ExportError> {
    write!(out, "    -1\n   164{:74}\n", "")?;
    writeln!(out, "{:>10}{:>20}{:>10}", 1, "SI", 1)?;
    let factors = [1.0, 1.0, 1.0, 0.0].map(|factor| fixed(factor, 25, 16).replace('e', "D"));
    let [length, force, temperature, offset] = factors;
    write!(out, "{length}{force}{temperature}\n{offset}\n    -1\n")?;
    let mut count = 0;
    for_each_function(table, &mut |function| {
        count += 1;
        write_function(&function, count, (title, program), out)
    })?;
    Ok(count)
}

fn write_function(
    function: &Function,
    number: usize,
    (title, program): (&str, &str),
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    let Function { x, y, .. } = function;
    let step = x[1] - x[0];
    let steps = x.windows(2).map(|pair| pair[1] - pair[0]);
    let is_even = steps
        .into_iter()
        .all(|one| (one - step).abs() <= EVEN * step.abs());
    // The step over the whole length: of few digits in the file, it should be right at the end.
    let (begin, step) = match is_even {
        true => (x[0], (x[x.len() - 1] - x[0]) / (x.len() - 1) as f64),
        false => (0.0, 0.0),
    };
    let name = ascii(&function.name, 2 * LINE);
    let (first, second) = name.split_at(name.len().min(LINE));
    write!(out, "    -1\n    58{:74}\n", "")?;
    for line in [
        first,
        if second.is_empty() { "NONE" } else { second },
        &ascii(&function.condition, LINE),
        &ascii(title, LINE),
        &ascii(program, LINE),
    ] {
        writeln!(out, "{line:<LINE$}")?;
    }
    let kind = u32::from(function.axis_unit == "s");
    let none = "NONE";
    writeln!(
        out,
        "{kind:>5}{number:>10}{:>5}{:>10} {none:>10}{number:>10}{:>4} {none:>10}{:>10}{:>4}",
        0, 0, 0, 0, 0
    )?;
    // Four: real numbers of double precision.
    writeln!(
        out,
        "{:>10}{:>10}{:>10}{}{}{}",
        4,
        y.len(),
        u32::from(is_even),
        fixed(begin, 13, 5),
        fixed(step, 13, 5),
        fixed(0.0, 13, 5)
    )?;
    for (kind, label, unit) in [
        (
            kind_of(&function.axis_unit),
            &*function.axis,
            &*function.axis_unit,
        ),
        (kind_of(&function.unit), &*function.name, &*function.unit),
        (0, none, none),
        (0, none, none),
    ] {
        // The end of a column's name says what it is.
        let label = ascii(label.rsplit('/').next().unwrap_or(label), LABEL);
        let unit = ascii(unit, LABEL);
        writeln!(
            out,
            "{kind:>10}{:>5}{:>5}{:>5} {label:<LABEL$} {unit:<LABEL$}",
            0, 0, 0
        )?;
    }
    let in_a_line = if is_even { 4 } else { 2 };
    for (places, values) in x.chunks(in_a_line).zip(y.chunks(in_a_line)) {
        for (place, value) in places.iter().zip(values) {
            if !is_even {
                out.write_all(fixed(*place, 13, 5).as_bytes())?;
            }
            out.write_all(fixed(*value, 20, 11).as_bytes())?;
        }
        out.write_all(b"\n")?;
    }
    out.write_all(b"    -1\n")?;
    Ok(())
}

fn kind_of(unit: &str) -> u32 {
    let known = KINDS.iter().find(|(known, _)| *known == unit);
    known.map_or(GENERAL, |(_, kind)| *kind)
}

/// A number with so many digits behind the point and two digits or more in its exponent, as Fortran and C write it.
fn fixed(value: f64, width: usize, digits: usize) -> String {
    let text = format!("{value:.digits$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let (sign, exponent) = match exponent.strip_prefix('-') {
        Some(exponent) => ('-', exponent),
        None => ('+', exponent),
    };
    format!("{:>width$}", format!("{mantissa}e{sign}{exponent:0>2}"))
}

/// The text in so many letters of ASCII; a line break or another control character would end its line.
fn ascii(text: &str, width: usize) -> String {
    let mut shown = text.to_owned();
    for (found, put) in ASCII {
        shown = shown.replace(found, put);
    }
    let plain = |c: char| {
        if c.is_ascii_graphic() || c == ' ' {
            c
        } else {
            '?'
        }
    };
    let shown: String = shown.chars().map(plain).take(width).collect();
    if shown.is_empty() {
        "NONE".to_owned()
    } else {
        shown
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_width_of_the_format() {
        assert_eq!(fixed(1.5e-7, 20, 11), "   1.50000000000e-07");
        assert_eq!(fixed(-2.0, 13, 5), " -2.00000e+00");
        assert_eq!(fixed(1e-120, 13, 5), " 1.00000e-120");
    }

    #[test]
    fn uneven_functions_of_an_odd_number_of_values_have_all_of_them() {
        let mut table = Table::new("rows");
        table.numbers("time_s", vec![0.0, 1.0, 3.0]);
        table.numbers("a\nb_N", vec![1.0, 2.0, 4.0]);
        let mut text = Vec::new();
        let count = write_universal(&table, ("t", "p"), &mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert_eq!(count, 1);
        let end = "  0.00000e+00   1.00000000000e+00  1.00000e+00   2.00000000000e+00\n  3.00000e+00   4.00000000000e+00\n    -1\n";
        assert!(text.ends_with(end), "{text}");
        assert!(text.contains("\na?b_N "), "{text}");
    }
}
