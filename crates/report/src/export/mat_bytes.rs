//! Tables as a MATLAB file of level 5, which MATLAB, Octave and SciPy read: each a struct with `data` (rows × columns),
//! `columns` (their names), and `texts` with `text_columns` where it has columns of text.
//!
//! Source: MathWorks, "MAT-File Format", chapter 1 (level 5). An element is a type, a number of bytes and the bytes,
//! filled up to a multiple of eight; an array (miMATRIX) holds its flags with the class, dimensions, name and content
//! as elements of their own.

use std::io::Write;

use super::{Cells, ExportError, Table};

/// Types of elements.
const INT8: u32 = 1;
const UINT16: u32 = 4;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const MATRIX: u32 = 14;

/// Classes of arrays.
const CELL_CLASS: u32 = 1;
const STRUCT_CLASS: u32 = 2;
const CHAR_CLASS: u32 = 4;
const DOUBLE_CLASS: u32 = 6;

/// Place of a field's name in the list of names, 31 letters and a zero.
const NAME_LENGTH: usize = 32;

/// Length of type and number of bytes.
const TAG: usize = 8;

/// Length of the text that a file begins with.
const HEADER_TEXT: usize = 116;

/// Writes the file.
///
/// # Errors
/// [`ExportError::TooLarge`] for a table of 2 GB and more, [`ExportError::Write`]; [`ExportError::File`] if a column
/// cannot be read.
pub fn write_mat(tables: &[Table<'_>], out: &mut dyn Write) -> Result<(), ExportError> {
    for table in tables {
        let bytes = 8 * table.rows() * table.columns.len();
        if bytes >= i32::MAX as usize {
            let table = table.name.clone();
            return Err(ExportError::TooLarge { table, bytes });
        }
    }
    let text = b"MATLAB 5.0 MAT-file, written by gearmesh";
    let mut head = text.to_vec();
    head.resize(HEADER_TEXT, b' ');
    head.extend([0; 8]);
    head.extend(0x0100_u16.to_le_bytes());
    head.extend(*b"IM");
    out.write_all(&head)?;
    for table in tables {
        write_struct(table, out)?;
    }
    Ok(())
}

/// A table as an array; its numbers go from where they are into the file, all else is small.
fn write_struct(table: &Table<'_>, out: &mut dyn Write) -> Result<(), ExportError> {
    let (mut numbers, mut names) = (Vec::new(), Vec::new());
    let (mut texts, mut text_names) = (Vec::new(), Vec::new());
    for (name, cells) in &table.columns {
        if let Cells::Texts(values) = cells {
            texts.extend(values.iter().map(|value| text_array(value)));
            text_names.push(text_array(name));
        } else {
            numbers.push(cells);
            names.push(text_array(name));
        }
    }
    let (rows, columns) = (table.rows(), names.len());
    let mut fields = vec![("columns", cell_array([1, columns], &names))];
    if !text_names.is_empty() {
        let count = text_names.len();
        fields.push(("texts", cell_array([rows, count], &texts)));
        fields.push(("text_columns", cell_array([1, count], &text_names)));
    }
    let mut list = Vec::new();
    for name in std::iter::once("data").chain(fields.iter().map(|field| field.0)) {
        let start = list.len();
        list.extend(name.bytes());
        list.resize(start + NAME_LENGTH, 0);
    }
    let mut head = array_head(STRUCT_CLASS, [1, 1], &table.name);
    head.extend(small_element(INT32, &(NAME_LENGTH as i32).to_le_bytes()));
    head.extend(element(INT8, &list));
    // The field of the numbers, columns one after the other.
    let own = array_head(DOUBLE_CLASS, [rows, columns], "");
    let number_bytes = 8 * rows * columns;
    let data_bytes = own.len() + TAG + number_bytes;
    let rest: Vec<u8> = fields.into_iter().flat_map(|(_, field)| field).collect();
    let all = head.len() + TAG + data_bytes + rest.len();
    out.write_all(&tag(MATRIX, all))?;
    out.write_all(&head)?;
    out.write_all(&tag(MATRIX, data_bytes))?;
    out.write_all(&own)?;
    out.write_all(&tag(DOUBLE, number_bytes))?;
    for cells in numbers {
        for value in cells.numbers(0..rows)?.iter().flat_map(|c| c.iter()) {
            out.write_all(&value.to_le_bytes())?;
        }
    }
    out.write_all(&rest)?;
    Ok(())
}

fn cell_array(shape: [usize; 2], cells: &[Vec<u8>]) -> Vec<u8> {
    array(CELL_CLASS, shape, "", &cells.concat())
}

fn text_array(text: &str) -> Vec<u8> {
    let units: Vec<u16> = text.encode_utf16().collect();
    let bytes: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
    let rows = usize::from(!units.is_empty());
    array(
        CHAR_CLASS,
        [rows, units.len()],
        "",
        &element(UINT16, &bytes),
    )
}

fn array(class: u32, shape: [usize; 2], name: &str, content: &[u8]) -> Vec<u8> {
    element(MATRIX, &[&array_head(class, shape, name), content].concat())
}

/// What an array begins with: flags, dimensions, name.
fn array_head(class: u32, shape: [usize; 2], name: &str) -> Vec<u8> {
    let flags = [class.to_le_bytes(), 0_u32.to_le_bytes()].concat();
    let shape: Vec<u8> = shape
        .iter()
        .flat_map(|n| (*n as i32).to_le_bytes())
        .collect();
    let parts = [
        element(UINT32, &flags),
        element(INT32, &shape),
        element(INT8, name.as_bytes()),
    ];
    parts.concat()
}

/// Type and number of bytes.
fn tag(kind: u32, bytes: usize) -> Vec<u8> {
    [kind.to_le_bytes(), (bytes as u32).to_le_bytes()].concat()
}

fn element(kind: u32, bytes: &[u8]) -> Vec<u8> {
    let mut all = tag(kind, bytes.len());
    all.extend_from_slice(bytes);
    all.resize(all.len().next_multiple_of(8), 0);
    all
}

/// An element of at most four bytes, its length beside the type.
fn small_element(kind: u32, bytes: &[u8; 4]) -> Vec<u8> {
    [(kind | 4 << 16).to_le_bytes(), *bytes].concat()
}
