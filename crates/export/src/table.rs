//! Tables of designs as Parquet.

use std::sync::Arc;

use parquet::basic::Compression;
use parquet::data_type::{BoolType, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::parser::parse_message_type;

use kinefront_study::{Column, ColumnType};

/// Why a table cannot be converted to Parquet.
#[derive(Debug, thiserror::Error)]
pub enum ConversionError {
    /// The table is not CSV.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// The table has no header.
    #[error("the table has no columns")]
    NoColumns,
    /// A value is not of the type of its column.
    #[error("line {line}: `{text}` is not a valid value for the column `{column}`")]
    Value {
        /// Line in the table, from 1.
        line: usize,
        /// The text found.
        text: String,
        /// Name of the column.
        column: String,
    },
    /// The file cannot be encoded.
    #[error(transparent)]
    Encode(#[from] ParquetError),
}

/// A column with its values.
enum ParquetColumn {
    Int(Vec<Option<i64>>),
    Number(Vec<Option<f64>>),
    Truth(Vec<Option<bool>>),
    Text(Vec<Option<String>>),
}

impl ParquetColumn {
    /// Parses the values of a column. A column of Kinefront's tables has a known type; any other column contains
    /// numbers or, failing that, texts. An empty text is a missing value.
    fn new(name: &str, texts: &[&str]) -> Result<Self, ConversionError> {
        fn read<T: std::str::FromStr>(name: &str, texts: &[&str]) -> Result<Vec<Option<T>>, ConversionError> {
            let parse = |(row, text): (usize, &&str)| match *text {
                "" => Ok(None),
                text => text.parse().map(Some).map_err(|_| ConversionError::Value {
                    line: row + 2,
                    text: text.to_owned(),
                    column: name.to_owned(),
                }),
            };
            texts.iter().enumerate().map(parse).collect()
        }
        match Column::find(name).map(Column::kind) {
            Some(ColumnType::Integer) => read(name, texts).map(Self::Int),
            Some(ColumnType::Number) => read(name, texts).map(Self::Number),
            Some(ColumnType::Flag) => read(name, texts).map(Self::Truth),
            Some(ColumnType::Text) => read(name, texts).map(Self::Text),
            None => read(name, texts)
                .map(Self::Number)
                .or_else(|_| read(name, texts).map(Self::Text)),
        }
    }

    fn declaration(&self, name: &str) -> String {
        match self {
            Self::Int(_) => format!("optional int64 {name};"),
            Self::Number(_) => format!("optional double {name};"),
            Self::Truth(_) => format!("optional boolean {name};"),
            Self::Text(_) => format!("optional binary {name} (string);"),
        }
    }
}

/// Converts a table of designs, the contents of `front.csv` or `designs.csv`, to Parquet with the same columns.
///
/// # Errors
/// [`ConversionError`], which says what is wrong with the table.
pub fn front_to_parquet(table: &[u8]) -> Result<Vec<u8>, ConversionError> {
    let mut reader = csv::Reader::from_reader(table);
    let header = reader.headers()?.clone();
    if header.is_empty() {
        return Err(ConversionError::NoColumns);
    }
    let records: Vec<csv::StringRecord> = reader.records().collect::<Result<_, _>>()?;
    let columns: Vec<ParquetColumn> = header
        .iter()
        .enumerate()
        .map(|(place, name)| {
            let texts: Vec<&str> = records.iter().map(|record| &record[place]).collect();
            ParquetColumn::new(name, &texts)
        })
        .collect::<Result<_, _>>()?;
    Ok(write(&header, &columns)?)
}

fn write(header: &csv::StringRecord, columns: &[ParquetColumn]) -> Result<Vec<u8>, ParquetError> {
    let fields: Vec<String> = header
        .iter()
        .zip(columns)
        .map(|(name, column)| column.declaration(name))
        .collect();
    let schema = parse_message_type(&format!("message designs {{ {} }}", fields.join(" ")))?;
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(format!("Kinefront {}", env!("CARGO_PKG_VERSION")))
        .build();
    let mut bytes = Vec::new();
    let mut file = SerializedFileWriter::new(&mut bytes, Arc::new(schema), Arc::new(properties))?;
    let mut group = file.next_row_group()?;
    for column in columns {
        let Some(mut writer) = group.next_column()? else { break };
        match column {
            ParquetColumn::Int(values) => write_values::<Int64Type, _>(&mut writer, values, |value| *value),
            ParquetColumn::Number(values) => write_values::<DoubleType, _>(&mut writer, values, |value| *value),
            ParquetColumn::Truth(values) => write_values::<BoolType, _>(&mut writer, values, |value| *value),
            ParquetColumn::Text(values) => {
                write_values::<ByteArrayType, _>(&mut writer, values, |value| value.as_str().into())
            }
        }?;
        writer.close()?;
    }
    group.close()?;
    file.close()?;
    Ok(bytes)
}

fn write_values<T: DataType, V>(
    writer: &mut SerializedColumnWriter<'_>,
    values: &[Option<V>],
    make: impl Fn(&V) -> T::T,
) -> Result<(), ParquetError> {
    // A definition level of 0 marks a missing value.
    let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
    let values: Vec<T::T> = values.iter().flatten().map(make).collect();
    writer.typed::<T>().write_batch(&values, Some(&levels), None)?;
    Ok(())
}
