//! `<<`, the merge key of YAML 1.1, which tools disagree about.

use super::keys::{MERGE, is_own};
use super::reader::{KeyPath, Reader, joined};
use scl_terminal::Problem;
use serde_yaml::Value;

impl Reader<'_> {
    /// Reports each merge key below `at`, apart from those in keys of the user's own.
    pub(super) fn report_merge_keys(&mut self, value: &Value, at: KeyPath<'_>) {
        let Value::Mapping(entries) = value else { return };
        for (key, value) in entries {
            let Some(key) = key.as_str().filter(|key| !at.is_empty() || !is_own(key)) else { continue };
            let here = joined(at, key);
            if key != MERGE {
                self.report_merge_keys(value, &here);
                continue;
            }
            let problem = Problem::new("the merge key `<<` is not supported").at(self.text.place(&here));
            let problem = problem.help(instead(at)).note("an alias stands for a whole value, as in `build: *cmake`");
            self.problems.push(problem);
        }
    }
}

/// What to write in place of a merge key in the mapping at `at`.
fn instead(at: KeyPath<'_>) -> &'static str {
    match at {
        ["components", _] | ["profiles", _, _] => {
            "put what all components share into `defaults`, and write out the rest"
        }
        [.., "environment"] if at.len() > 1 => {
            "put what all programs share into `environment` at the top of the file, and write out the rest"
        }
        _ => "write out the keys",
    }
}

#[cfg(test)]
mod tests {
    use crate::launch_file::LaunchDocument;
    use expect_test::{Expect, expect};

    #[track_caller]
    fn check(text: &str, expected: &Expect) {
        let problems = LaunchDocument::parse("launch.yaml", text).unwrap().read(None).err().unwrap_or_default();
        expected.assert_eq(&problems.iter().map(|problem| format!("{problem}\n")).collect::<String>());
    }

    #[test]
    fn a_merge_key_is_one_mistake_with_a_way_out() {
        let common = "x-common: &common {command: ./a, restart: always}\nx-variables: &variables {A: 1}\n";
        check(
            &format!(
                "{common}components:\n  a: {{<<: *common}}\n  b:\n    <<: [*common]\n    environment:\n      <<: *variables\n"
            ),
            &expect![[r#"
                error: the merge key `<<` is not supported
                 --> launch.yaml:4:7
                  = help: put what all components share into `defaults`, and write out the rest
                  = note: an alias stands for a whole value, as in `build: *cmake`

                error: the merge key `<<` is not supported
                 --> launch.yaml:6:5
                  = help: put what all components share into `defaults`, and write out the rest
                  = note: an alias stands for a whole value, as in `build: *cmake`

                error: the merge key `<<` is not supported
                 --> launch.yaml:8:7
                  = help: put what all programs share into `environment` at the top of the file, and write out the rest
                  = note: an alias stands for a whole value, as in `build: *cmake`

            "#]],
        );
        check(
            &format!(
                "{common}environment: {{<<: *variables}}\ncomponents: {{a: *common}}\ndefaults: {{<<: {{restart: always}}}}\n"
            ),
            &expect![[r#"
                error: the merge key `<<` is not supported
                 --> launch.yaml:3:15
                  = help: write out the keys
                  = note: an alias stands for a whole value, as in `build: *cmake`

                error: the merge key `<<` is not supported
                 --> launch.yaml:5:12
                  = help: write out the keys
                  = note: an alias stands for a whole value, as in `build: *cmake`

            "#]],
        );
        check(
            &format!("{common}components:\n  a: *common\nprofiles:\n  sim:\n    a:\n      <<: *common\n"),
            &expect![[r#"
                error: the merge key `<<` is not supported
                 --> launch.yaml:8:7
                  = help: put what all components share into `defaults`, and write out the rest
                  = note: an alias stands for a whole value, as in `build: *cmake`

            "#]],
        );
        check(
            "components: {a: {command: ./a, <<: 3}}",
            &expect![[r#"
                error: the merge key `<<` is not supported
                 --> launch.yaml:1:32
                  = help: put what all components share into `defaults`, and write out the rest
                  = note: an alias stands for a whole value, as in `build: *cmake`

            "#]],
        );
    }

    #[test]
    fn keys_of_the_users_own_are_ignored_at_the_top_only() {
        check(
            "x-a: &a {<<: {b: c}, d: [1]}\nx-: 1\ncomponents: {a: {command: ./a, environment: {x-c: 1}}}\n",
            &expect![],
        );
        check(
            "x_a: 1\ncomponents: {a: {command: ./a, x-note: b}}\ndefaults: {x-command: c}\n",
            &expect![[r#"
                error: unknown key `x_a` in a launch file
                 --> launch.yaml:1:1
                  = note: the keys are `build`, `components`, `defaults`, `environment`, `gateway`, `hosts`, `profiles`, `topology`, `transport`, `transports`

                error: unknown key `x-note` in component `a`
                 --> launch.yaml:2:32
                  = help: keys of your own, which start with `x-`, belong at the top of the file

                error: unknown key `x-command` in `defaults`
                 --> launch.yaml:3:12
                  = help: keys of your own, which start with `x-`, belong at the top of the file

            "#]],
        );
    }
}
