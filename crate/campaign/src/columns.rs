//! Rows as a Parquet file.

use std::sync::Arc;

use parquet::basic::Compression;
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;

use crate::row::TrialRow;

/// The values of one column; all may be absent.
enum Column {
    Text(Vec<Option<String>>),
    Real(Vec<Option<f64>>),
    Whole(Vec<Option<u64>>),
}

impl Column {
    fn declaration(&self) -> &'static str {
        match self {
            Self::Text(_) => "BINARY",
            Self::Real(_) => "DOUBLE",
            Self::Whole(_) => "INT64",
        }
    }

    fn annotation(&self) -> &'static str {
        match self {
            Self::Text(_) => " (UTF8)",
            Self::Real(_) => "",
            Self::Whole(_) => " (UINT_64)",
        }
    }
}

/// The rows, column by column, in the order of [`TrialRow`].
fn columns(rows: &[TrialRow]) -> Vec<(&'static str, Column)> {
    let text = |value: fn(&TrialRow) -> &String| {
        Column::Text(rows.iter().map(|row| Some(value(row).clone())).collect())
    };
    let maybe = |value: fn(&TrialRow) -> &Option<String>| {
        Column::Text(rows.iter().map(|row| value(row).clone()).collect())
    };
    let real = |value: fn(&TrialRow) -> Option<f64>| Column::Real(rows.iter().map(value).collect());
    let whole = |value: fn(&TrialRow) -> Option<u64>| Column::Whole(rows.iter().map(value).collect());
    vec![
        ("id", text(|row| &row.id)),
        ("campaign", text(|row| &row.campaign)),
        ("planner", text(|row| &row.planner)),
        ("route", text(|row| &row.route)),
        ("truth", text(|row| &row.truth)),
        ("parameters", text(|row| &row.parameters)),
        ("reality", text(|row| &row.reality)),
        ("seed", whole(|row| Some(row.seed))),
        ("outcome", text(|row| &row.outcome)),
        ("stop_reason", maybe(|row| &row.stop_reason)),
        ("error", maybe(|row| &row.error)),
        ("distance_m", real(|row| row.distance_m)),
        ("max_abs_roll_rad", real(|row| row.max_abs_roll_rad)),
        ("max_abs_pitch_rad", real(|row| row.max_abs_pitch_rad)),
        ("mean_vibration_rad_s", real(|row| row.mean_vibration_rad_s)),
        ("mean_elevation_rate_cm_s", real(|row| row.mean_elevation_rate_cm_s)),
        ("curvature_change_rad_m", real(|row| row.curvature_change_rad_m)),
        ("mean_abs_roll_rad", real(|row| row.mean_abs_roll_rad)),
        ("mean_abs_pitch_rad", real(|row| row.mean_abs_pitch_rad)),
        ("longest_standstill_s", real(|row| row.longest_standstill_s)),
        ("sim_time_s", real(|row| row.sim_time_s)),
        ("ticks", whole(|row| row.ticks)),
        ("straight_m", real(|row| Some(row.straight_m))),
        ("oracle_length_m", real(|row| row.oracle_length_m)),
        ("digest", maybe(|row| &row.digest)),
        ("configuration", text(|row| &row.configuration)),
    ]
}

/// The rows as the bytes of a Parquet file with one row group.
pub(crate) fn parquet(rows: &[TrialRow]) -> Result<Vec<u8>, ParquetError> {
    let columns = columns(rows);
    let fields: Vec<String> = columns
        .iter()
        .map(|(name, column)| format!("OPTIONAL {} {name}{};", column.declaration(), column.annotation()))
        .collect();
    let schema = parse_message_type(&format!("message trials {{ {} }}", fields.join(" ")))?;
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for (name, column) in columns {
        let mut writer =
            group.next_column()?.ok_or_else(|| ParquetError::General(format!("no column {name}")))?;
        match (column, writer.untyped()) {
            (Column::Text(values), ColumnWriter::ByteArrayColumnWriter(writer)) => {
                let levels = levels(&values);
                let values: Vec<ByteArray> =
                    values.into_iter().flatten().map(|text| text.into_bytes().into()).collect();
                writer.write_batch(&values, Some(&levels), None)?;
            }
            (Column::Real(values), ColumnWriter::DoubleColumnWriter(writer)) => {
                let present: Vec<f64> = values.iter().copied().flatten().collect();
                writer.write_batch(&present, Some(&levels(&values)), None)?;
            }
            (Column::Whole(values), ColumnWriter::Int64ColumnWriter(writer)) => {
                // Parquet keeps unsigned numbers in the bits of signed ones.
                let present: Vec<i64> = values.iter().copied().flatten().map(u64::cast_signed).collect();
                writer.write_batch(&present, Some(&levels(&values)), None)?;
            }
            _ => return Err(ParquetError::General(format!("column {name} has another type"))),
        }
        writer.close()?;
    }
    group.close()?;
    writer.close()?;
    Ok(bytes)
}

/// Definition levels: 1 where there is a value.
fn levels<T>(values: &[Option<T>]) -> Vec<i16> {
    values.iter().map(|value| i16::from(value.is_some())).collect()
}

#[cfg(test)]
mod tests {
    use parquet::file::reader::{FileReader as _, SerializedFileReader};

    use super::*;
    use crate::testing;

    fn row(seed: u64, distance_m: Option<f64>) -> TrialRow {
        let error = distance_m.is_none().then(|| "panic: \"comma, quote\"\nline".to_owned());
        TrialRow { distance_m, error, ..testing::row("default", "cht-ab", "none", seed, "reached") }
    }

    #[test]
    fn parquet_holds_what_csv_holds() {
        let rows = [row(u64::MAX, Some(0.1 + 0.2)), row(2, None)];
        let bytes = parquet(&rows).unwrap();
        assert_eq!(bytes, parquet(&rows).unwrap());
        let reader = SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap();
        let read: Vec<serde_json::Value> =
            reader.get_row_iter(None).unwrap().map(|row| row.unwrap().to_json_value()).collect();
        assert_eq!(read.len(), 2);
        for (read, row) in read.iter().zip(&rows) {
            let expected = serde_json::to_value(row).unwrap();
            assert_eq!(read, &expected);
        }
        // The same names in the same order as in the CSV file.
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.serialize(&rows[0]).unwrap();
        let text = String::from_utf8(writer.into_inner().unwrap()).unwrap();
        let names: Vec<&str> = columns(&rows).iter().map(|(name, _)| *name).collect();
        assert_eq!(text.lines().next().unwrap(), names.join(","));
    }

    #[test]
    fn no_rows_are_a_file_too() {
        let reader = SerializedFileReader::new(bytes::Bytes::from(parquet(&[]).unwrap())).unwrap();
        assert_eq!(reader.get_row_iter(None).unwrap().count(), 0);
    }
}
