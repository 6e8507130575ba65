//! The keys and the rules of launch files with their documentation, for `scl explain`.

use super::document::LaunchDocument;
use super::keys::{COMPONENT, GATEWAY, HOST, Key, TOP};
use super::rules::LAUNCH_RULES;
use scl_topology::catalogue::entry;
use scl_topology::diagnostic::render;
use scl_topology::grammar::Entry;

/// Every key of launch files, in the order of the page, and the names that other tools use for it.
pub fn launch_keys() -> Vec<(Entry, &'static [&'static str])> {
    let all = [
        (TOP, "key of a launch file"),
        (COMPONENT, "key of a program"),
        (HOST, "key of a host"),
        (GATEWAY, "key of `gateway`"),
    ];
    all.iter().flat_map(|(keys, what)| keys.iter().map(|key| (explained(key, what), key.also))).collect()
}

fn explained(key: &Key, what: &'static str) -> Entry {
    // Drop the links: they lead to other sections of `docs/launch.md`.
    let sentences = without_links(key.meaning);
    let summary = key.meaning.split(". ").next().unwrap_or_default().trim_end_matches('.');
    let meaning = sentences.split(" See ").next().unwrap_or_default();
    let defaults = if key.in_defaults { "It may also stand in `defaults`, for all programs.\n" } else { "" };
    let text = format!(
        "# {} ({what})\n\n{meaning}\n\nValue: {}\nDefault: {}\n{defaults}\nSee docs/launch.md.\n",
        key.name,
        without_links(&key.form.description()),
        without_links(key.default),
    );
    Entry { word: key.name, what, summary, text }
}

/// Replaces links by their texts: `[Hosts](#hosts)` becomes `Hosts`.
fn without_links(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('[') {
        let Some((name, after)) =
            after.split_once("](").and_then(|(name, after)| Some((name, after.split_once(')')?.1)))
        else {
            break;
        };
        plain.push_str(before);
        plain.push_str(name);
        rest = after;
    }
    plain + rest
}

/// Returns the explanation of a rule about launch files as Markdown, or `None` if no rule has this code.
pub fn explain_launch_rule(code: &str) -> Option<String> {
    let rule = LAUNCH_RULES.iter().find(|rule| rule.code == code)?;
    Some(format!("# {}", entry(rule, "yaml", told)))
}

/// Returns the messages about an example, as they are shown to the user.
fn told(text: &str) -> String {
    let document = LaunchDocument::parse("launch.yaml", text);
    let found = document.check(None).1;
    found.iter().map(|problem| render(problem, &document.sources)).collect::<Vec<_>>().join("\n\n")
}

#[cfg(test)]
mod tests {
    use super::{LAUNCH_RULES, LaunchDocument, explain_launch_rule};
    use expect_test::expect;

    /// The promise: the wrong example of a rule has this mistake and no other, and the right one has none.
    #[test]
    fn examples_are_what_they_say() {
        for rule in LAUNCH_RULES.iter().filter(|rule| !rule.example.is_empty()) {
            let codes = |text: &str| {
                let found = LaunchDocument::parse("launch.yaml", text).check(None).1;
                found.iter().map(|problem| problem.code()).collect::<Vec<_>>()
            };
            assert_eq!(codes(&rule.bad_example()), [rule.code]);
            assert_eq!(codes(&rule.good_example()), [""; 0], "{}", rule.code);
        }
    }

    #[test]
    fn codes_are_in_order_and_explained() {
        assert!(LAUNCH_RULES.is_sorted_by_key(|rule| rule.code));
        let text = explain_launch_rule("SCL1202").unwrap();
        expect![[r#"
            # SCL1202 value that the key does not accept (error)

            The key does not accept this value: a time without its unit, an unknown word, or a number out of range. The message says what the key accepts.

            Wrong:

            ```yaml
            components:
              sensor:
                command: ./sensor
                restart: on-failure
            ```

            ```text
            error: [SCL1202] `restart` is `never`, `on_abnormal`, `on_failure` or `always`, not `on-failure`
             --> launch.yaml:4:14
              |
            4 |     restart: on-failure
              |              ^^^^^^^^^^
              |
              = help: did you mean `restart: on_failure`?
            ```

            Right:

            ```yaml
            components:
              sensor:
                command: ./sensor
                restart: on_failure
            ```
        "#]].assert_eq(&text);
        assert_eq!(explain_launch_rule("SCL0502"), None);
    }
}
