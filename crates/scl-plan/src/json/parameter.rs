//! Parameters in JSON: `{"name": "gain", "type": "f64", "default": "0.8", "range": ["0", "10"], ...}`. In place of
//! `type`, a choice has `one_of`, and a list has `list` with the type of its items and perhaps `length`.

use super::object::{At, Object};
use crate::error::PlanError;
use crate::parameter::{ParameterPlan, ParameterType, Scalar};
use serde::ser::{Serialize, SerializeMap, Serializer};

const FIELDS: [&str; 11] =
    ["name", "type", "one_of", "list", "length", "default", "range", "unit", "doc", "live", "declared_at"];

pub(super) fn parameter(at: &At<'_>) -> Result<ParameterPlan, PlanError> {
    let fields = at.object(&FIELDS)?;
    let text = |field| if fields.has(field) { fields.text(field).map(|text| Some(text.into())) } else { Ok(None) };
    let range = match fields.has("range") {
        true => {
            let range = fields.field("range")?;
            let bounds = range.list(|it| it.text().map(str::to_owned))?;
            let [least, largest]: [String; 2] = bounds.try_into().map_err(|_| range.wrong("a list of two texts"))?;
            Some((least.into(), largest.into()))
        }
        false => None,
    };
    Ok(ParameterPlan {
        name: fields.text("name")?.into(),
        kind: kind(at, &fields)?,
        default: text("default")?,
        range,
        unit: text("unit")?,
        doc: text("doc")?,
        live: fields.has("live") && fields.field("live")?.flag()?,
        declared_at: fields.text("declared_at")?.into(),
    })
}

fn kind(at: &At<'_>, fields: &Object<'_>) -> Result<ParameterType, PlanError> {
    let scalar = |field| fields.field(field)?.word(&Scalar::WORDS, Scalar::of);
    match ["type", "one_of", "list"].map(|field| fields.has(field)) {
        [true, false, false] => scalar("type").map(ParameterType::One),
        [false, true, false] => {
            let words = fields.field("one_of")?.list(|it| it.text().map(|word| word.to_owned().into()))?;
            Ok(ParameterType::OneOf(words.into()))
        }
        [false, false, true] => {
            let length = fields.has("length").then(|| fields.field("length")?.number(u32::MAX));
            Ok(ParameterType::List(scalar("list")?, length.transpose()?))
        }
        _ => Err(at.wrong("an object with `type`, `one_of` or `list`")),
    }
}

impl Serialize for ParameterPlan {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { name, kind, default, range, unit, doc, live, declared_at } = self;
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("name", name)?;
        match kind {
            ParameterType::One(scalar) => map.serialize_entry("type", scalar.word())?,
            ParameterType::OneOf(words) => map.serialize_entry("one_of", words)?,
            ParameterType::List(scalar, length) => {
                map.serialize_entry("list", scalar.word())?;
                length.map_or(Ok(()), |length| map.serialize_entry("length", &length))?;
            }
        }
        default.as_ref().map_or(Ok(()), |default| map.serialize_entry("default", default))?;
        range.as_ref().map_or(Ok(()), |range| map.serialize_entry("range", range))?;
        unit.as_ref().map_or(Ok(()), |unit| map.serialize_entry("unit", unit))?;
        doc.as_ref().map_or(Ok(()), |doc| map.serialize_entry("doc", doc))?;
        if *live {
            map.serialize_entry("live", live)?;
        }
        map.serialize_entry("declared_at", declared_at)?;
        map.end()
    }
}
