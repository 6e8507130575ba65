//! SCL1902: defaults, ranges and lengths that a parameter cannot have.

use crate::diagnostic::{Diagnostics, Edit, Rule, Severity};
use crate::grammar::parameter::{LONGEST_LIST, length};
use crate::model::{ParameterModel, WrittenValue};
use crate::source::Sources;
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
            problems.push(WRONG_VALUE.at(headline, end.span, reason));
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
            problems.push(found.labels(range.map(|(_, range)| (range.span(), "its range"))));
            None
        }
    }
}

/// The length of a list.
pub(super) fn check_length(parameter: &ParameterModel, problems: &mut Diagnostics) {
    let Some(written) = parameter.key("length") else { return };
    if written.text().and_then(length).is_none() {
        let headline = format!("`length` is a whole number from 1 to {LONGEST_LIST}");
        problems.push(WRONG_VALUE.at(headline, written.span(), "").help("without it, a list may have any length"));
    }
}
