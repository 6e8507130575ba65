//! SCL1902: defaults, ranges and lengths that a parameter cannot have.

use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::grammar::parameter::{LONGEST_LIST, length};
use crate::model::{ParameterModel, WrittenValue};
use crate::parse::meant_values;
use crate::source::{Sources, Spanned};
use scl_plan::{ConstText, ParameterPlan, ParameterType, list_text};

/// SCL1902.
pub(crate) const WRONG_VALUE: Rule = Rule {
    code: "SCL1902",
    severity: Severity::Error,
    title: "value that a parameter cannot have",
    explanation: "The default of a parameter is of another type or out of its range, or its range is no range. A range \
                  has two ends, the smaller one first, and both belong to it. Durations have a unit, as in `10ms`.",
    example: " components:
   - name: controller
     parameters:
-      - gain: {f64: 20, range: [0, 10]}
+      - gain: {f64: 2, range: [0, 10]}
     gates: []
",
};

/// The range as texts; `None` if there is none, or it is none.
pub(super) fn range(
    parameter: &ParameterModel,
    declared: &ParameterPlan,
    problems: &mut Diagnostics,
) -> Option<(ConstText, ConstText)> {
    let written = parameter.key("range")?;
    let scalar = declared.kind.scalar().filter(|scalar| scalar.has_range())?;
    let WrittenValue::Many(ends, span) = written else {
        problems.push(WRONG_VALUE.at("`range` has two ends", written.span(), "").help("write `range: [0, 10]`"));
        return None;
    };
    let [least, largest] = ends.as_slice() else {
        let found = WRONG_VALUE.at("`range` has two ends", *span, format!("this has {}", ends.len()));
        problems.push(found.help("write the least and the largest value: `range: [0, 10]`"));
        return None;
    };
    for end in [least, largest] {
        if let Err(reason) = scalar.read(&end.value) {
            let headline = format!("`{}` cannot be an end of the range of `{}`", end.value, parameter.name.value);
            let end_of = ParameterPlan { kind: ParameterType::One(scalar), ..declared.clone() };
            problems.push(with_meant(WRONG_VALUE.at(headline, end.span, reason), &end_of, end));
            return None;
        }
    }
    let range = Some((least.value.clone().into(), largest.value.clone().into()));
    let ordered = ParameterPlan { range: range.clone(), ..declared.clone() };
    if ordered.bounds().is_none() {
        let found = WRONG_VALUE.at(format!("the range of `{}` is empty", parameter.name.value), *span, "");
        let swapped = format!("[{}, {}]", largest.value, least.value);
        let advice = format!("write the smaller end first: `{swapped}`");
        problems.push(found.propose(advice, [Edit::new(*span, swapped)]));
        return None;
    }
    range
}

/// The texts for people.
pub(super) fn check_texts(parameter: &ParameterModel, sources: &Sources, problems: &mut Diagnostics) {
    for key in ["unit", "doc"] {
        if let Some(WrittenValue::Many(items, span)) = parameter.key(key) {
            let found = WRONG_VALUE.at(format!("`{key}` is a text, not a list"), *span, "");
            problems.push(match items.as_slice() {
                [one] => {
                    let written = sources.snippet(one.span).to_owned();
                    found.propose(format!("write `{key}: {written}`"), [Edit::new(*span, written)])
                }
                _ => found.help(format!("write one text: `{key}: \"...\"`")),
            });
        }
    }
}

/// The default as text; `None` if the parameter cannot have it.
pub(super) fn default(
    parameter: &ParameterModel,
    declared: &ParameterPlan,
    written: &WrittenValue,
    problems: &mut Diagnostics,
) -> Option<ConstText> {
    let is_list = matches!(declared.kind, ParameterType::List(..));
    let read = match written {
        WrittenValue::Many(items, _) if is_list => Ok(list_text(items.iter().map(|item| &item.value))),
        WrittenValue::Many(..) => Err("this is a list".to_owned()),
        WrittenValue::One(_) if is_list => Err("write a list in brackets: `[1, 2]`".to_owned()),
        WrittenValue::One(text) => Ok(text.value.clone()),
    };
    match read.and_then(|text| declared.read(&text).map(|_| text)) {
        Ok(text) => Some(text.into()),
        Err(reason) => {
            let headline = format!("the default of parameter `{}` cannot be its value", parameter.name.value);
            let found = WRONG_VALUE.at(headline, written.span(), reason);
            let range = parameter.keys.iter().find(|(key, _)| key.value == "range" && declared.range.is_some());
            let found = found.labels(range.map(|(_, range)| (range.span(), "its range")));
            problems.push(match written {
                WrittenValue::One(text) => with_meant(found, declared, text),
                WrittenValue::Many(items, span) => match items.as_slice() {
                    [one] if !is_list => with_meant(found, declared, &Spanned { span: *span, ..one.clone() }),
                    _ => found,
                },
            });
            None
        }
    }
}

/// Suggests the values that may be meant.
fn with_meant(found: Diagnostic, plan: &ParameterPlan, written: &Spanned<String>) -> Diagnostic {
    let meant = meant_values(plan, &written.value);
    meant
        .into_iter()
        .fold(found, |found, value| found.suggest(format!("did you mean `{value}`?"), [Edit::new(written.span, value)]))
}

/// The length of a list.
pub(super) fn check_length(parameter: &ParameterModel, problems: &mut Diagnostics) {
    let Some(written) = parameter.key("length") else { return };
    if written.text().and_then(length).is_none() {
        let headline = format!("`length` is a whole number from 1 to {LONGEST_LIST}");
        problems.push(WRONG_VALUE.at(headline, written.span(), "").help("without it, a list may have any length"));
    }
}

#[cfg(test)]
mod tests {
    use super::WRONG_VALUE;
    use crate::check::parameter::tests::file;
    use crate::check::testing::{advice, rule_example};
    use expect_test::expect;

    #[test]
    fn wrong_values_are_told_with_the_reason() {
        let cases = [
            "pin: {u8: 256}",
            "pin: {u8: 1.5}",
            "gain: {f64: high}",
            "gain: {f64: [1]}",
            "gain: {f64: 11, range: [0, 10]}",
            "gain: {f64: 1, range: [10, 0]}",
            "gain: {f64: 1, range: 10}",
            "gain: {f64: 1, range: [0, 1, 2]}",
            "gain: {f64: 1, range: [0, many]}",
            "period: {duration: 10}",
            "gain: {f64: 1, range: ['0,5', 2]}",
            "pin: {u8: 0x10}",
            "pin: {u8: [5]}",
            "period: {duration: -5ms}",
            "period: {duration: 100Hz}",
            "enabled: {bool: yes}",
            "mode: {one_of: [manual, auto], default: atuo}",
            "offsets: {list: f64, length: 3, default: [0, 0]}",
            "offsets: {list: f64, length: 0}",
            "offsets: {list: f64, default: 1}",
            "offsets: {list: f64, default: [0, a]}",
            "offsets: {list: u8, default: [0, 9], range: [0, 5]}",
            "gain: {f64: 1, unit: [m/s]}",
            "gain: {f64: 1, doc: [a, b]}",
            "gain: {f64: 1, live: yes}",
            "gain: {f64: 1, live: sometimes}",
            "gain: {f64: 1, live: [true]}",
        ];
        let told: String = cases.iter().map(|case| format!("{case}\n    {}\n", advice(&file(case)))).collect();
        expect![[r#"
            pin: {u8: 256}
                SCL1902 the default of parameter `pin` cannot be its value []
            pin: {u8: 1.5}
                SCL1902 the default of parameter `pin` cannot be its value []
            gain: {f64: high}
                SCL1902 the default of parameter `gain` cannot be its value []
            gain: {f64: [1]}
                SCL1902 the default of parameter `gain` cannot be its value [did you mean `1`?]
            gain: {f64: 11, range: [0, 10]}
                SCL1902 the default of parameter `gain` cannot be its value []
            gain: {f64: 1, range: [10, 0]}
                SCL1902 the range of `gain` is empty [write the smaller end first: `[0, 10]`]
            gain: {f64: 1, range: 10}
                SCL1902 `range` has two ends [write `range: [0, 10]`]
            gain: {f64: 1, range: [0, 1, 2]}
                SCL1902 `range` has two ends [write the least and the largest value: `range: [0, 10]`]
            gain: {f64: 1, range: [0, many]}
                SCL1902 `many` cannot be an end of the range of `gain` []
            period: {duration: 10}
                SCL1902 the default of parameter `period` cannot be its value [did you mean `10s`? | did you mean `10ms`?]
            gain: {f64: 1, range: ['0,5', 2]}
                SCL1902 `0,5` cannot be an end of the range of `gain` [did you mean `0.5`?]
            pin: {u8: 0x10}
                SCL1902 the default of parameter `pin` cannot be its value [did you mean `16`?]
            pin: {u8: [5]}
                SCL1902 the default of parameter `pin` cannot be its value [did you mean `5`?]
            period: {duration: -5ms}
                SCL1902 the default of parameter `period` cannot be its value []
            period: {duration: 100Hz}
                SCL1902 the default of parameter `period` cannot be its value [did you mean `10ms`?]
            enabled: {bool: yes}
                SCL1902 the default of parameter `enabled` cannot be its value [did you mean `true`?]
            mode: {one_of: [manual, auto], default: atuo}
                SCL1902 the default of parameter `mode` cannot be its value [did you mean `auto`?]
            offsets: {list: f64, length: 3, default: [0, 0]}
                SCL1902 the default of parameter `offsets` cannot be its value []
            offsets: {list: f64, length: 0}
                SCL1902 `length` is a whole number from 1 to 10000 [without it, a list may have any length]
            offsets: {list: f64, default: 1}
                SCL1902 the default of parameter `offsets` cannot be its value [did you mean `[1]`?]
            offsets: {list: f64, default: [0, a]}
                SCL1902 the default of parameter `offsets` cannot be its value []
            offsets: {list: u8, default: [0, 9], range: [0, 5]}
                SCL1902 the default of parameter `offsets` cannot be its value []
            gain: {f64: 1, unit: [m/s]}
                SCL1902 `unit` is a text, not a list [write `unit: m/s`]
            gain: {f64: 1, doc: [a, b]}
                SCL1902 `doc` is a text, not a list [write one text: `doc: "..."`]
            gain: {f64: 1, live: yes}
                SCL1902 `live` is `true` or `false` [write `live: true`]
            gain: {f64: 1, live: sometimes}
                SCL1902 `live` is `true` or `false` [a parameter with `live: true` can be changed while its program runs]
            gain: {f64: 1, live: [true]}
                SCL1902 `live` is `true` or `false` [a parameter with `live: true` can be changed while its program runs]
        "#]]
        .assert_eq(&told);
    }

    #[test]
    fn value_that_a_parameter_cannot_have() {
        rule_example(
            &WRONG_VALUE,
            expect![[r#"
            error: [SCL1902] the default of parameter `gain` cannot be its value
             --> topology.yaml:4:21
              |
            4 |       - gain: {f64: 20, range: [0, 10]}
              |                     ^^         ------- its range
              |                     |
              |                     `20` is not from 0 to 10
        "#]],
        );
    }
}
