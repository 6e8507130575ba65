//! What encoding and decoding takes, and how many bytes it makes: Table II of the paper, whose data was booleans, integers,
//! strings and floating point numbers. XML is there for comparison only.

mod record;
mod xml;

use crate::histogram::Times;
use crate::report::{Column, Others, Report, Row, Table};
use prost::Message;
use record::{Example, FlatRecord, Record};
use scl::bytes::{BufMut, Bytes, BytesMut};
use scl::codec::{Cbor, Codec, Json, Msgpack, Postcard, Protobuf, Raw};
use std::hint::black_box;
use std::time::Instant;
use xml::Xml;

/// Messages measured together, because one alone is too short for the clock.
const BATCH: usize = 100;

const XML: &str = "xml";
const BESIDE_XML: Others = &[("xml", XML)];

/// What [`measure_codecs`] is asked for.
#[derive(Debug, Clone)]
pub struct Codecs {
    /// How many messages each codec encodes and decodes.
    pub messages: usize,
}

/// A codec with a message, behind one face.
struct Subject {
    name: &'static str,
    beside: Others,
    /// Encodes into an empty buffer.
    encode: Box<Encode>,
    /// Decodes and drops the message.
    decode: Box<Decode>,
}

type Encode = dyn Fn(&mut BytesMut) -> scl::Result<()>;
type Decode = dyn Fn(Bytes) -> scl::Result<()>;

/// What came of one codec.
struct Measured {
    subject: Subject,
    encoding: Times,
    decoding: Times,
    bytes: usize,
}

/// Measures every codec on the same record, beside each other.
///
/// # Errors
///
/// A codec refuses the record, which none does.
pub fn measure_codecs(options: &Codecs) -> scl::Result<Report> {
    let mut all = Vec::new();
    for subject in subjects() {
        all.push(Measured { subject, encoding: Times::new()?, decoding: Times::new()?, bytes: 0 });
    }
    let batches = options.messages.div_ceil(BATCH).max(1);
    // A tenth more, first, to warm up.
    for batch in 0..batches + batches.div_ceil(10) {
        for measured in &mut all {
            measured.play(batch >= batches.div_ceil(10))?;
        }
    }
    let mut report = Report::new("codecs");
    report.add(table(&all));
    report.note("`raw` carries the same values at fixed lengths, so it has bytes for text that is not there");
    Ok(report)
}

fn subjects() -> Vec<Subject> {
    vec![
        subject::<Raw, FlatRecord>("raw"),
        subject::<Postcard, Record>("postcard"),
        subject::<Protobuf, Record>("protobuf").beside(&[("library", "prost alone"), ("xml", XML)]),
        prost_alone(),
        subject::<Msgpack, Record>("msgpack"),
        subject::<Cbor, Record>("cbor"),
        subject::<Json, Record>("json").beside(&[("library", "serde_json alone"), ("xml", XML)]),
        serde_json_alone(),
        subject::<Xml, Record>(XML).beside(&[]),
    ]
}

fn subject<C: Codec<T>, T: Example + 'static>(name: &'static str) -> Subject {
    let message = T::example();
    Subject {
        name,
        beside: BESIDE_XML,
        encode: Box::new(move |into| Ok(C::encode(black_box(&message), into)?)),
        decode: Box::new(|bytes| {
            black_box(C::decode(bytes)?);
            Ok(())
        }),
    }
}

impl Subject {
    fn beside(self, others: Others) -> Self {
        Self { beside: others, ..self }
    }
}

fn prost_alone() -> Subject {
    let message = Record::example();
    Subject {
        name: "prost alone",
        beside: BESIDE_XML,
        encode: Box::new(move |into| Ok(black_box(&message).encode(into)?)),
        decode: Box::new(|bytes| {
            black_box(Record::decode(bytes)?);
            Ok(())
        }),
    }
}

fn serde_json_alone() -> Subject {
    let message = Record::example();
    Subject {
        name: "serde_json alone",
        beside: BESIDE_XML,
        encode: Box::new(move |into| Ok(serde_json::to_writer(into.writer(), black_box(&message))?)),
        decode: Box::new(|bytes| {
            black_box(serde_json::from_slice::<Record>(&bytes)?);
            Ok(())
        }),
    }
}

impl Measured {
    fn play(&mut self, counts: bool) -> scl::Result<()> {
        let mut buffer = BytesMut::new();
        let started = Instant::now();
        for _ in 0..BATCH {
            buffer.clear();
            (self.subject.encode)(&mut buffer)?;
        }
        let encoded = started.elapsed();
        let bytes = buffer.freeze();
        let started = Instant::now();
        for _ in 0..BATCH {
            (self.subject.decode)(black_box(bytes.clone()))?;
        }
        let decoded = started.elapsed();
        if counts {
            // In picoseconds a message, so that the histogram keeps three digits of them.
            self.encoding.record(u64::try_from(encoded.as_nanos() * 1000 / BATCH as u128)?);
            self.decoding.record(u64::try_from(decoded.as_nanos() * 1000 / BATCH as u128)?);
            self.bytes = bytes.len();
        }
        Ok(())
    }
}

fn table(all: &[Measured]) -> Table {
    let columns = [Column::compared("encode_ns"), Column::compared("decode_ns"), Column::plain("bytes")];
    let title = "encoding and decoding a record of booleans, integers, strings and floating point numbers";
    let mut table = Table::new(title, &columns);
    for measured in all {
        // What was recorded as picoseconds comes out in nanoseconds.
        let [encode, decode] = [measured.encoding.quantile(0.5), measured.decoding.quantile(0.5)];
        let row = Row::new(measured.subject.name, vec![encode, decode, measured.bytes as f64]);
        table.add(row.beside_all(measured.subject.beside));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_subject_reads_what_it_wrote() {
        for subject in subjects() {
            let mut buffer = BytesMut::new();
            (subject.encode)(&mut buffer).unwrap();
            assert!(!buffer.is_empty(), "{}", subject.name);
            (subject.decode)(buffer.freeze()).unwrap();
        }
    }

    #[test]
    fn xml_keeps_every_value() {
        let mut buffer = BytesMut::new();
        Xml::encode(&Record::example(), &mut buffer).unwrap();
        assert_eq!(Xml::decode(buffer.freeze()).unwrap(), Record::example());
    }
}
