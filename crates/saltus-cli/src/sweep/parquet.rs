//! The rows of a sweep as a file of Parquet, with the identity of the sweep.

use std::fs::File;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{ConvertedType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::Result;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::FileReader;
use parquet::file::serialized_reader::SerializedFileReader;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;
use saltus_scene::sweep::{Cells, KEY};

/// Columns as a file with the identity of the sweep.
pub(super) fn written(headers: &[String], columns: &[Cells], plan: &str) -> Result<Vec<u8>> {
    let fields = headers.iter().zip(columns).map(|(header, cells)| field(header, cells));
    let schema = Type::group_type_builder("rows").with_fields(fields.collect::<Result<_>>()?).build()?;
    let said = KeyValue::new(KEY.to_owned(), plan.to_owned());
    let properties = WriterProperties::builder().set_key_value_metadata(Some(vec![said])).build();
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
    let mut rows = writer.next_row_group()?;
    for cells in columns {
        if let Some(mut column) = rows.next_column()? {
            put(&mut column, cells)?;
            column.close()?;
        }
    }
    rows.close()?;
    writer.into_inner()
}

/// The identity of a file and the number of its rows; nothing where the file is torn.
pub(super) fn read(path: &Path) -> Option<(String, u64)> {
    let reader = SerializedFileReader::new(File::open(path).ok()?).ok()?;
    let file = reader.metadata().file_metadata();
    let said = file.key_value_metadata()?.iter().find(|pair| pair.key == KEY)?;
    Some((said.value.clone()?, u64::try_from(file.num_rows()).ok()?))
}

fn field(header: &str, cells: &Cells) -> Result<Arc<Type>> {
    let (physical, converted) = match cells {
        Cells::Numbers(_) => (Physical::DOUBLE, ConvertedType::NONE),
        Cells::Counts(_) => (Physical::INT64, ConvertedType::NONE),
        Cells::Words(_) => (Physical::BYTE_ARRAY, ConvertedType::UTF8),
    };
    let field = Type::primitive_type_builder(header, physical).with_converted_type(converted);
    Ok(Arc::new(field.with_repetition(Repetition::OPTIONAL).build()?))
}

fn put(column: &mut SerializedColumnWriter<'_>, cells: &Cells) -> Result<()> {
    fn there<T>(cells: &[Option<T>]) -> Vec<i16> {
        cells.iter().map(|cell| i16::from(cell.is_some())).collect()
    }
    match cells {
        Cells::Numbers(cells) => {
            let values: Vec<f64> = cells.iter().flatten().copied().collect();
            column.typed::<DoubleType>().write_batch(&values, Some(&there(cells)), None)?;
        }
        Cells::Counts(cells) => {
            let values: Vec<i64> =
                cells.iter().flatten().map(|count| i64::try_from(*count).unwrap_or(i64::MAX)).collect();
            column.typed::<Int64Type>().write_batch(&values, Some(&there(cells)), None)?;
        }
        Cells::Words(cells) => {
            let values: Vec<ByteArray> = cells.iter().flatten().map(|word| word.as_str().into()).collect();
            column.typed::<ByteArrayType>().write_batch(&values, Some(&there(cells)), None)?;
        }
    }
    Ok(())
}
