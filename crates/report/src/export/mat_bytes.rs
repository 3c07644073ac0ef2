//! Tables as a MATLAB file of level 5, which MATLAB, Octave and SciPy read: each a struct with `data` (rows × columns),
//! `columns` (their names), and `texts` with `text_columns` where it has columns of text.
//!
//! Source: MathWorks, "MAT-File Format", chapter 1 (level 5). An element is a type, a number of bytes and the bytes,
//! filled up to a multiple of eight; an array (miMATRIX) holds its flags with the class, dimensions, name and content
//! as elements of their own.

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

/// Length of the text that a file begins with.
const HEADER_TEXT: usize = 116;

/// The file's bytes.
///
/// # Errors
/// [`ExportError::TooLarge`] for a table of 2 GB and more.
pub fn mat_bytes(tables: &[Table]) -> Result<Vec<u8>, ExportError> {
    let text = b"MATLAB 5.0 MAT-file, written by gearmesh";
    let mut file = text.to_vec();
    file.resize(HEADER_TEXT, b' ');
    file.extend([0; 8]);
    file.extend(0x0100_u16.to_le_bytes());
    file.extend(*b"IM");
    for table in tables {
        let bytes = 8 * table.rows() * table.columns.len();
        if bytes >= i32::MAX as usize {
            let table = table.name.clone();
            return Err(ExportError::TooLarge { table, bytes });
        }
        file.extend(table_struct(table));
    }
    Ok(file)
}

fn table_struct(table: &Table) -> Vec<u8> {
    let (mut data, mut names) = (Vec::new(), Vec::new());
    let (mut texts, mut text_names) = (Vec::new(), Vec::new());
    for (name, cells) in &table.columns {
        match cells {
            Cells::Numbers(values) => {
                data.extend_from_slice(values);
                names.push(text_array(name));
            }
            Cells::Texts(values) => {
                texts.extend(values.iter().map(|value| text_array(value)));
                text_names.push(text_array(name));
            }
        }
    }
    let rows = table.rows();
    let columns = names.len();
    let mut fields = vec![
        ("data", number_array([rows, columns], &data)),
        ("columns", cell_array([1, columns], &names)),
    ];
    if !text_names.is_empty() {
        let count = text_names.len();
        fields.push(("texts", cell_array([rows, count], &texts)));
        fields.push(("text_columns", cell_array([1, count], &text_names)));
    }
    let mut content = small_element(INT32, &(NAME_LENGTH as i32).to_le_bytes());
    let mut list = Vec::new();
    for (name, _) in &fields {
        let start = list.len();
        list.extend(name.bytes());
        list.resize(start + NAME_LENGTH, 0);
    }
    content.extend(element(INT8, &list));
    fields
        .into_iter()
        .for_each(|(_, field)| content.extend(field));
    array(STRUCT_CLASS, [1, 1], &table.name, &content)
}

/// Columns one after the other.
fn number_array(shape: [usize; 2], values: &[f64]) -> Vec<u8> {
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    array(DOUBLE_CLASS, shape, "", &element(DOUBLE, &bytes))
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
    let flags = [class.to_le_bytes(), 0_u32.to_le_bytes()].concat();
    let shape: Vec<u8> = shape
        .iter()
        .flat_map(|n| (*n as i32).to_le_bytes())
        .collect();
    let parts = [
        element(UINT32, &flags),
        element(INT32, &shape),
        element(INT8, name.as_bytes()),
        content.to_vec(),
    ];
    element(MATRIX, &parts.concat())
}

fn element(kind: u32, bytes: &[u8]) -> Vec<u8> {
    let mut all = [kind.to_le_bytes(), (bytes.len() as u32).to_le_bytes()].concat();
    all.extend_from_slice(bytes);
    all.resize(all.len().next_multiple_of(8), 0);
    all
}

/// An element of at most four bytes, its length beside the type.
fn small_element(kind: u32, bytes: &[u8; 4]) -> Vec<u8> {
    [(kind | 4 << 16).to_le_bytes(), *bytes].concat()
}
