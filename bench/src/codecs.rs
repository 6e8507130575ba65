//! The time that codecs take to encode and decode a record, and the size of the result: Table II of the paper, whose
//! data was booleans, integers, strings and floating point numbers.

mod record;

use crate::durations::Durations;
use crate::report::{Column, Report, Row, Table};
use prost::Message;
use record::{Example, FlatRecord, Record};
use scl::bytes::{BufMut, Bytes, BytesMut};
use scl::codec::{Cbor, Codec, Json, Msgpack, Postcard, Protobuf, Raw};
use std::hint::black_box;
use std::time::Instant;

/// Number of messages timed together, because a single one takes too little time for the clock.
const BATCH: usize = 100;

const PROST: &str = "prost alone";
const SERDE_JSON: &str = "serde_json alone";

/// A codec and a message, without their types.
struct Variant {
    name: &'static str,
    baselines: &'static [&'static str],
    /// Encodes the message into an empty buffer.
    encode: Box<Encode>,
    /// Decodes a message and drops it.
    decode: Box<Decode>,
}

type Encode = dyn Fn(&mut BytesMut) -> scl::Result<()>;
type Decode = dyn Fn(Bytes) -> scl::Result<()>;

/// A codec and its measurements.
struct Measurement {
    variant: Variant,
    encoding: Durations,
    decoding: Durations,
    bytes: usize,
}

/// Measures all codecs on the same record; each encodes and decodes this many messages.
pub(crate) fn measure_codecs(messages: usize) -> scl::Result<Report> {
    let mut measurements = Vec::new();
    for variant in variants() {
        let [encoding, decoding] = [Durations::new()?, Durations::new()?];
        measurements.push(Measurement { variant, encoding, decoding, bytes: 0 });
    }
    let batches = messages.div_ceil(BATCH).max(1);
    let warm_up = batches.div_ceil(10);
    for batch in 0..warm_up + batches {
        for measurement in &mut measurements {
            measurement.run(batch >= warm_up)?;
        }
    }
    let mut report = Report::new("codecs");
    report.tables.push(table(&measurements));
    report.note("`raw` has fields of fixed size, so it contains unused bytes for longer strings");
    Ok(report)
}

fn variants() -> Vec<Variant> {
    vec![
        codec::<Raw, FlatRecord>("raw", &[]),
        codec::<Postcard, Record>("postcard", &[]),
        codec::<Protobuf, Record>("protobuf", &[PROST]),
        variant(PROST, &[], |record: &Record, buffer| Ok(record.encode(buffer)?), |bytes| Ok(Record::decode(bytes)?)),
        codec::<Msgpack, Record>("msgpack", &[]),
        codec::<Cbor, Record>("cbor", &[]),
        codec::<Json, Record>("json", &[SERDE_JSON]),
        variant(
            SERDE_JSON,
            &[],
            |record: &Record, buffer| Ok(serde_json::to_writer(buffer.writer(), record)?),
            |bytes| Ok(serde_json::from_slice(&bytes)?),
        ),
    ]
}

fn codec<C: Codec<T>, T: Example + 'static>(name: &'static str, baselines: &'static [&'static str]) -> Variant {
    variant(name, baselines, |message: &T, buffer| Ok(C::encode(message, buffer)?), |bytes| Ok(C::decode(bytes)?))
}

fn variant<T: Example + 'static>(
    name: &'static str,
    baselines: &'static [&'static str],
    encode: impl Fn(&T, &mut BytesMut) -> scl::Result<()> + 'static,
    decode: impl Fn(Bytes) -> scl::Result<T> + 'static,
) -> Variant {
    let message = T::example();
    Variant {
        name,
        baselines,
        encode: Box::new(move |buffer| encode(black_box(&message), buffer)),
        decode: Box::new(move |bytes| {
            black_box(decode(bytes)?);
            Ok(())
        }),
    }
}

impl Measurement {
    fn run(&mut self, is_recorded: bool) -> scl::Result<()> {
        let mut buffer = BytesMut::new();
        let started = Instant::now();
        for _ in 0..BATCH {
            buffer.clear();
            (self.variant.encode)(&mut buffer)?;
        }
        let encoding = started.elapsed();
        let bytes = buffer.freeze();
        let started = Instant::now();
        for _ in 0..BATCH {
            (self.variant.decode)(black_box(bytes.clone()))?;
        }
        let decoding = started.elapsed();
        if is_recorded {
            // In picoseconds per message, so that the histogram keeps three digits.
            self.encoding.record(u64::try_from(encoding.as_nanos() * 1000 / BATCH as u128)?);
            self.decoding.record(u64::try_from(decoding.as_nanos() * 1000 / BATCH as u128)?);
            self.bytes = bytes.len();
        }
        Ok(())
    }
}

fn table(measurements: &[Measurement]) -> Table {
    let columns = [Column::compared("encode_ns"), Column::compared("decode_ns"), Column::plain("bytes")];
    let title = "encoding and decoding a record of booleans, integers, strings and floating point numbers";
    let mut table = Table::new(title, &columns);
    for Measurement { variant, encoding, decoding, bytes } in measurements {
        // `quantile` divides by 1000 and the values were recorded in picoseconds, so these are nanoseconds.
        let [encode, decode] = [encoding.quantile(0.5), decoding.quantile(0.5)];
        table.rows.push(Row::new(variant.name, vec![encode, decode, *bytes as f64]).with_baselines(variant.baselines));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_variant_decodes_what_it_encoded() {
        for variant in variants() {
            let mut buffer = BytesMut::new();
            (variant.encode)(&mut buffer).unwrap();
            assert!(!buffer.is_empty(), "{}", variant.name);
            (variant.decode)(buffer.freeze()).unwrap();
        }
    }
}
