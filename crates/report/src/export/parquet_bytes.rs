//! A table as Parquet: row groups of some millions of numbers, doubles and UTF-8 texts, not compressed.

use std::io::Write;
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::{Cells, ExportError, Table};

/// Writes the file.
///
/// # Errors
/// [`ExportError::Parquet`]; [`ExportError::File`] if a column cannot be read.
pub fn write_parquet(table: &Table<'_>, out: &mut (dyn Write + Send)) -> Result<(), ExportError> {
    let columns = table.columns.iter();
    let fields = columns.map(|(name, cells)| column_type(name, cells).map(Arc::new));
    let fields = fields.collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder(&table.name)
        .with_fields(fields)
        .build()?;
    // Few of the numbers are equal: a dictionary would be larger than they are.
    let properties = WriterProperties::builder()
        .set_dictionary_enabled(false)
        .build();
    let mut writer = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties))?;
    for rows in table.blocks() {
        let mut group = writer.next_row_group()?;
        for (_, cells) in &table.columns {
            let Some(mut column) = group.next_column()? else {
                break;
            };
            if let Some(values) = cells.numbers(rows.clone())? {
                let numbers = column.typed::<DoubleType>();
                numbers.write_batch(&values, None, None)?;
            } else if let Cells::Texts(values) = cells {
                let values = values[rows.clone()].iter();
                let values: Vec<ByteArray> = values.map(|v| v.as_str().into()).collect();
                let texts = column.typed::<ByteArrayType>();
                texts.write_batch(&values, None, None)?;
            }
            column.close()?;
        }
        group.close()?;
    }
    writer.close()?;
    Ok(())
}

fn column_type(name: &str, cells: &Cells<'_>) -> Result<Type, ParquetError> {
    let (physical, logical) = match cells {
        Cells::Numbers(_) | Cells::Column(..) => (Physical::DOUBLE, None),
        Cells::Texts(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    Type::primitive_type_builder(name, physical)
        .with_repetition(Repetition::REQUIRED)
        .with_logical_type(logical)
        .build()
}
