//! Messages made of other messages.

use scl_value::{FieldPath, MessageType, Value};

/// In a second.
const NANOSECONDS: u64 = 1_000_000_000;

/// A message in which texts that begin with `=` stand for fields of another message: `=position.x`, or the rotation of
/// its roll, pitch and yaw, `=quaternion(attitude)`, or the time at which it was sent, `=@time`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Template {
    Constant(Value),
    Field(FieldPath),
    Quaternion(FieldPath),
    Time,
    List(Vec<Template>),
    Map(Vec<(Value, Template)>),
}

impl Template {
    /// # Errors
    /// A text that begins with `=` names no field.
    pub(crate) fn of(value: &Value) -> Result<Self, String> {
        Ok(match value {
            Value::List(items) => Self::List(items.iter().map(Self::of).collect::<Result<_, _>>()?),
            Value::Map(entries) => {
                let entry = |(key, value): &(Value, Value)| Ok((key.clone(), Self::of(value)?));
                Self::Map(entries.iter().map(entry).collect::<Result<_, String>>()?)
            }
            value => match value.meaning() {
                Value::Text(text) => Self::of_text(text)?,
                _ => Self::Constant(value.clone()),
            },
        })
    }

    fn of_text(text: &str) -> Result<Self, String> {
        let Some(field) = text.strip_prefix('=') else { return Ok(Self::Constant(text.into())) };
        let path = |text: &str| text.trim().parse().map_err(|error: scl_value::PathError| error.to_string());
        if field == "@time" {
            return Ok(Self::Time);
        }
        match field.strip_prefix("quaternion(").and_then(|rest| rest.strip_suffix(')')) {
            Some(attitude) => path(attitude).map(Self::Quaternion),
            None => path(field).map(Self::Field),
        }
    }

    /// Whether a message without it has a field that says when it was sent.
    pub(crate) fn with_time(self, field: &str) -> Self {
        match self {
            Self::Map(mut entries) => {
                if !entries.iter().any(|(key, _)| *key.meaning() == Value::from(field)) {
                    entries.push((field.into(), Self::Time));
                }
                Self::Map(entries)
            }
            other => other,
        }
    }

    /// Checks that the source may have the fields.
    ///
    /// # Errors
    /// It has no such field.
    pub(crate) fn check(&self, source: &MessageType) -> Result<(), scl_value::Mismatch> {
        match self {
            Self::Constant(_) | Self::Time => Ok(()),
            Self::Field(path) | Self::Quaternion(path) => source.check_field(path),
            Self::List(items) => items.iter().try_for_each(|item| item.check(source)),
            Self::Map(entries) => entries.iter().try_for_each(|(_, value)| value.check(source)),
        }
    }

    /// The message for a source that was sent at this time, in nanoseconds since 1970.
    ///
    /// # Errors
    /// The source has no such field, or it has no roll, pitch and yaw.
    pub(crate) fn fill(&self, source: &Value, time: u64) -> Result<Value, String> {
        let find = |path: &FieldPath| path.find(source).ok_or_else(|| format!("the message has no field `{path}`"));
        Ok(match self {
            Self::Constant(value) => value.clone(),
            Self::Time => timestamp(time),
            Self::Field(path) => find(path)?.clone(),
            Self::Quaternion(path) => quaternion(find(path)?)
                .ok_or_else(|| format!("field `{path}` has no numbers `x`, `y` and `z`: roll, pitch and yaw"))?,
            Self::List(items) => {
                Value::List(items.iter().map(|item| item.fill(source, time)).collect::<Result<_, _>>()?)
            }
            Self::Map(entries) => {
                let entry = |(key, value): &(Value, Self)| Ok((key.clone(), value.fill(source, time)?));
                Value::Map(entries.iter().map(entry).collect::<Result<_, String>>()?)
            }
        })
    }
}

/// As protobuf's JSON has it: `2026-12-01T00:00:00Z`.
fn timestamp(time: u64) -> Value {
    let nanos = i32::try_from(time % NANOSECONDS).unwrap_or(0);
    let seconds = i64::try_from(time / NANOSECONDS).unwrap_or(i64::MAX);
    prost_types::Timestamp { seconds, nanos }.to_string().as_str().into()
}

/// The rotation by yaw about z, then by pitch about y, then by roll about x, in radians.
fn quaternion(angles: &Value) -> Option<Value> {
    let half = |name: &str| Some((angles.get(name)?.as_number()? / 2.0).sin_cos());
    let ((sr, cr), (sp, cp), (sy, cy)) = (half("x")?, half("y")?, half("z")?);
    Some(Value::fields([
        ("x", (sr * cp * cy - cr * sp * sy).into()),
        ("y", (cr * sp * cy + sr * cp * sy).into()),
        ("z", (cr * cp * sy - sr * sp * cy).into()),
        ("w", (cr * cp * cy + sr * sp * sy).into()),
    ]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use scl_value::read_yaml;

    fn fill(template: &str, source: &str) -> Result<Value, String> {
        let template = Template::of(&read_yaml(template).unwrap())?;
        template.fill(&read_yaml(source).unwrap(), 1_780_000_000_250_000_000)
    }

    #[test]
    fn fields_constants_and_times_are_filled_in() {
        let template = "{frame: home, at: =position, parts: [{x: =position.x, one: 1}], when: =@time}";
        let filled = fill(template, "{position: {x: 1.5, y: 2}}").unwrap();
        assert_eq!(filled.get("at").and_then(|at| at.get("y")), Some(&2_i64.into()));
        let Some(Value::List(parts)) = filled.get("parts") else { panic!("{filled:?}") };
        assert_eq!((parts[0].get("x"), parts[0].get("one")), (Some(&1.5.into()), Some(&1_i64.into())));
        assert_eq!(filled.get("when"), Some(&"2026-05-28T20:26:40.250Z".into()));
    }

    #[test]
    fn a_field_that_is_not_there_is_named() {
        assert_eq!(fill("{x: =position.x}", "{y: 1}").unwrap_err(), "the message has no field `position.x`");
        let error = fill("{x: =quaternion(y)}", "{y: 1}").unwrap_err();
        assert_eq!(error, "field `y` has no numbers `x`, `y` and `z`: roll, pitch and yaw");
        assert!(fill("{x: =position..x}", "{}").unwrap_err().contains("is not a field path"));
    }

    #[test]
    fn a_rotation_is_that_of_roll_pitch_and_yaw() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let turn = |angles: [f64; 3]| {
            let [x, y, z] = angles;
            let rotation = fill("{q: =quaternion(a)}", &format!("{{a: {{x: {x:?}, y: {y:?}, z: {z:?}}}}}")).unwrap();
            ["x", "y", "z", "w"].map(|name| rotation.get("q").unwrap().get(name).unwrap().as_number().unwrap())
        };
        let is_near = |one: [f64; 4], other: [f64; 4]| one.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(is_near(turn([quarter, 0.0, 0.0]), [half, 0.0, 0.0, half]));
        assert!(is_near(turn([0.0, quarter, 0.0]), [0.0, half, 0.0, half]));
        assert!(is_near(turn([0.0, 0.0, quarter]), [0.0, 0.0, half, half]));
        // Turned left, then rolled about the new axis ahead.
        assert!(is_near(turn([quarter, 0.0, quarter]), [0.5, 0.5, 0.5, 0.5]));
    }
}
