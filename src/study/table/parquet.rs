//! A table as Parquet: columns of doubles, whole numbers, flags and texts, in row groups of a fixed length, without
//! compression, so that the same table gives the same bytes.

use std::sync::Arc;

use parquet::basic::{ConvertedType, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;

use super::{Cells, Column};

/// Rows of a group.
const GROUP: usize = 65_536;

/// The table; units and meanings of its columns are in the metadata of the file, as `NAME.unit` and `NAME.meaning`.
pub(crate) fn parquet(columns: &[Column]) -> Result<Vec<u8>, ParquetError> {
    let fields = columns.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("runs")
        .with_fields(fields)
        .build()?;
    let described = columns.iter().flat_map(|column| {
        let Column {
            name,
            unit,
            meaning,
            ..
        } = column;
        [
            KeyValue::new(format!("{name}.unit"), unit.clone()),
            KeyValue::new(format!("{name}.meaning"), meaning.clone()),
        ]
    });
    let properties = WriterProperties::builder()
        .set_created_by(format!("dalembert {}", env!("CARGO_PKG_VERSION")))
        .set_key_value_metadata(Some(described.collect()))
        .build();
    let mut out = Vec::new();
    let mut file = SerializedFileWriter::new(&mut out, Arc::new(schema), Arc::new(properties))?;
    let rows = columns.first().map_or(0, |column| column.cells.len());
    for start in (0..rows).step_by(GROUP) {
        let end = rows.min(start + GROUP);
        let mut group = file.next_row_group()?;
        for column in columns {
            let Some(mut writer) = group.next_column()? else {
                unreachable!("the schema has a column for each")
            };
            write(&mut writer, &column.cells, start..end)?;
            writer.close()?;
        }
        group.close()?;
    }
    file.close()?;
    Ok(out)
}

/// A column of the schema.
fn field(column: &Column) -> Result<Arc<Type>, ParquetError> {
    let physical = match column.cells {
        Cells::Numbers(_) => Physical::DOUBLE,
        Cells::Counts(_) => Physical::INT64,
        Cells::Flags(_) => Physical::BOOLEAN,
        Cells::Texts(_) => Physical::BYTE_ARRAY,
    };
    let mut builder =
        Type::primitive_type_builder(&column.name, physical).with_repetition(Repetition::OPTIONAL);
    if physical == Physical::BYTE_ARRAY {
        builder = builder
            .with_logical_type(Some(LogicalType::String))
            .with_converted_type(ConvertedType::UTF8);
    }
    Ok(Arc::new(builder.build()?))
}

fn write(
    writer: &mut SerializedColumnWriter,
    cells: &Cells,
    rows: std::ops::Range<usize>,
) -> Result<(), ParquetError> {
    /// The values that are there, and for each cell whether one is.
    fn parts<T, U>(cells: &[Option<T>], value: impl Fn(&T) -> U) -> (Vec<U>, Vec<i16>) {
        let present = cells.iter().flatten().map(value).collect();
        let levels = cells.iter().map(|cell| i16::from(cell.is_some())).collect();
        (present, levels)
    }
    match cells {
        Cells::Numbers(cells) => {
            let (values, levels) = parts(&cells[rows], |x| *x);
            writer
                .typed::<DoubleType>()
                .write_batch(&values, Some(&levels), None)?;
        }
        Cells::Counts(cells) => {
            let (values, levels) = parts(&cells[rows], |x| *x);
            writer
                .typed::<Int64Type>()
                .write_batch(&values, Some(&levels), None)?;
        }
        Cells::Flags(cells) => {
            let (values, levels) = parts(&cells[rows], |x| *x);
            writer
                .typed::<BoolType>()
                .write_batch(&values, Some(&levels), None)?;
        }
        Cells::Texts(cells) => {
            let (values, levels) =
                parts(&cells[rows], |text: &String| ByteArray::from(text.as_str()));
            writer
                .typed::<ByteArrayType>()
                .write_batch(&values, Some(&levels), None)?;
        }
    }
    Ok(())
}
