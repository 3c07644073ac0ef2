//! A table as Parquet: one row group, doubles and UTF-8 texts, not compressed.

use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::{Cells, ExportError, Table};

/// The file's bytes.
///
/// # Errors
/// [`ExportError::Parquet`].
pub fn parquet_bytes(table: &Table) -> Result<Vec<u8>, ExportError> {
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
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for (_, cells) in &table.columns {
        let Some(mut column) = group.next_column()? else {
            break;
        };
        match cells {
            Cells::Numbers(values) => {
                column
                    .typed::<DoubleType>()
                    .write_batch(values, None, None)?;
            }
            Cells::Texts(values) => {
                let values: Vec<ByteArray> = values.iter().map(|v| v.as_str().into()).collect();
                column
                    .typed::<ByteArrayType>()
                    .write_batch(&values, None, None)?;
            }
        }
        column.close()?;
    }
    group.close()?;
    Ok(writer.into_inner()?)
}

fn column_type(name: &str, cells: &Cells) -> Result<Type, ParquetError> {
    let (physical, logical) = match cells {
        Cells::Numbers(_) => (Physical::DOUBLE, None),
        Cells::Texts(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    Type::primitive_type_builder(name, physical)
        .with_repetition(Repetition::REQUIRED)
        .with_logical_type(logical)
        .build()
}
