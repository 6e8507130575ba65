//! Parameters that can be changed while the program runs.

use super::{NO_EFFECT, WRONG_VALUE};
use crate::diagnostic::{Diagnostics, Edit};
use crate::grammar::parameter::LIVE;
use crate::model::ParameterModel;
use crate::source::Sources;
use scl_plan::{ParameterPlan, ParameterType};

/// Whether the parameter can be changed while the program runs.
pub(super) fn is_live(parameter: &ParameterModel, problems: &mut Diagnostics) -> bool {
    let Some(written) = parameter.key(LIVE) else { return false };
    let text = written.text().unwrap_or_default();
    if let "true" | "false" = text {
        return parameter.is_live();
    }
    let found = WRONG_VALUE.at(format!("`{LIVE}` is `true` or `false`"), written.span(), "");
    problems.push(match text {
        "yes" | "on" | "1" | "True" | "TRUE" => {
            found.propose(format!("write `{LIVE}: true`"), [Edit::new(written.span(), "true")])
        }
        _ => found.help(format!("a parameter with `{LIVE}: true` can be changed while its program runs")),
    });
    false
}

/// Reports `live` at a parameter that can have one value only.
pub(super) fn report_constant(
    parameter: &ParameterModel,
    declared: &ParameterPlan,
    sources: &Sources,
    problems: &mut Diagnostics,
) {
    let reason = match &declared.kind {
        ParameterType::OneOf(words) if words.len() == 1 => "it has one word only",
        // Of an open list, the length may change.
        ParameterType::List(_, None) => return,
        _ if declared.bounds().is_some_and(|(least, largest)| least == largest) => "its range has one value only",
        _ => return,
    };
    let live = parameter.keys.iter().find(|(key, _)| key.value == LIVE).filter(|_| declared.live);
    let Some((key, written)) = live else { return };
    let entry = key.span.to(written.span());
    let headline = format!("`live` has no effect on parameter `{}`", parameter.name.value);
    let found = NO_EFFECT.at(headline, key.span, reason);
    problems.push(found.suggest_removal("remove it", sources.file(entry.file), entry));
}

#[cfg(test)]
mod tests {
    use crate::check::parameter::tests::{declared, file};
    use crate::check::testing::advice;
    use expect_test::expect;

    #[test]
    fn live_parameters_can_be_changed() {
        let shown = declared(
            "gain: {f64: 0.8, live: true}
             pin: {u8: 1, live: false}
             mode: {one_of: [manual, auto], live: true}
             offsets: {list: f64, live: true}",
        );
        assert_eq!(shown.iter().map(|it| it.live).collect::<Vec<_>>(), [true, false, true, true]);
        let constant = ["gain: {f64: 1, range: [1, 1], live: true}", "mode: {one_of: [manual], live: true}"];
        let told = constant.map(|case| advice(&file(case)));
        expect![[r#"
            SCL1903 `live` has no effect on parameter `gain` [remove it]
            SCL1903 `live` has no effect on parameter `mode` [remove it]"#]]
        .assert_eq(&told.join("\n"));
        let open = file("names: {list: u8, range: [1, 1], live: true}");
        assert_eq!(advice(&open), "");
        assert_eq!(
            advice(&file("gain: {f64: 1, dynamic: true}")),
            "SCL1901 unknown key `dynamic` of a parameter [did you mean `live`?]"
        );
    }
}
