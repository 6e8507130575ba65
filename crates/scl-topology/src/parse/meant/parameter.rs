//! What a wrong value of a parameter may mean.

use super::{decimal, durations, numbers, words};
use crate::habits;
use scl_plan::{ParameterPlan, ParameterType, Scalar};

/// The values that may be meant by a text that the parameter cannot have, the most probable first.
pub fn meant_values(plan: &ParameterPlan, text: &str) -> Vec<String> {
    let text = text.trim();
    let mut values = match &plan.kind {
        ParameterType::OneOf(known) => words("", text, &known.iter().map(|word| &**word).collect::<Vec<_>>()).0,
        ParameterType::List(..) if text.starts_with('[') => vec![text.to_owned()],
        ParameterType::List(..) => vec![format!("[{text}]")],
        ParameterType::One(Scalar::Bool) => habits::boolean(text).map(str::to_owned).into_iter().collect(),
        ParameterType::One(Scalar::Duration) => durations(text).0,
        ParameterType::One(Scalar::Text) => Vec::new(),
        ParameterType::One(_) => {
            // `2 m/s` of a parameter with this unit.
            let number = plan.unit.as_ref().and_then(|unit| text.strip_suffix(&**unit)).unwrap_or(text).trim();
            let mut values = numbers(number).0;
            values.extend(decimal(number).filter(|number| !values.contains(number)));
            values
        }
    };
    values.retain(|value| plan.read(value).is_ok());
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values that a text may mean, of a parameter with this type, this unit and this range.
    fn meant(kind: ParameterType, text: &str) -> String {
        let range = kind.scalar().filter(|scalar| scalar.is_number()).map(|_| ("0".into(), "1000".into()));
        let plan = ParameterPlan {
            name: "speed".into(),
            kind,
            default: None,
            range,
            unit: Some("m/s".into()),
            doc: None,
            live: false,
            declared_at: "".into(),
        };
        meant_values(&plan, text).join(" ")
    }

    #[test]
    fn other_spellings_are_values_if_the_parameter_can_have_them() {
        let one = ParameterType::One;
        let cases = [
            (one(Scalar::U16), "0x10", "16"),
            (one(Scalar::U16), "five", "5"),
            (one(Scalar::U16), "2.0", "2"),
            (one(Scalar::U16), "2k", ""),
            (one(Scalar::U16), "1.5", ""),
            (one(Scalar::F64), "0,5", "0.5"),
            (one(Scalar::F64), "1,000", "1000 1.000"),
            (one(Scalar::F64), "2.5 m/s", "2.5"),
            (one(Scalar::F64), "fast", ""),
            (one(Scalar::F64), "-1", ""),
            (one(Scalar::Bool), "Yes", "true"),
            (one(Scalar::Bool), "maybe", ""),
            (one(Scalar::Duration), "20 msec", "20ms"),
            (one(Scalar::Duration), "20", "20s 20ms"),
            (one(Scalar::Text), "", ""),
            (ParameterType::OneOf(vec!["manual".into(), "auto".into()].into()), "AUTO", "auto"),
            (ParameterType::OneOf(vec!["manual".into(), "auto".into()].into()), "manaul", "manual"),
            (ParameterType::List(Scalar::F64, Some(2)), "1, 2", "[1, 2]"),
            (ParameterType::List(Scalar::F64, Some(2)), "1", ""),
        ];
        for (kind, text, expected) in cases {
            assert_eq!(meant(kind.clone(), text), expected, "{kind} {text}");
        }
    }
}
