//! Whole files: what is fixed, and that everything else stays as it was.

use super::{fix, unified_diff};
use expect_test::{Expect, expect};
use scl_loader::{Request, load_bytes};
use scl_topology::catalogue::ALL;
use scl_topology::diagnostic::Severity;
use scl_topology::rule::Examples;

fn fixed(text: &str) -> (String, usize, usize) {
    let check = |text: &str| load_bytes(&Request::new("topology.yaml"), text.as_bytes().to_vec());
    let fixed = fix(check(text), text.to_owned(), check);
    let errors = fixed.loaded.diagnostics.iter().filter(|found| found.severity == Severity::Error).count();
    (fixed.text, fixed.applied, errors)
}

/// Number of fixes, number of errors that are left, and the difference; the same with other line ends, a byte order mark,
/// and without the last line break.
#[track_caller]
fn check(text: &str, expected: Expect) {
    let (new, applied, errors) = fixed(text);
    expected.assert_eq(&format!("{applied} fixed, {errors} left\n{}", unified_diff("topology.yaml", text, &new)));
    let crlf = |text: &str| text.replace('\n', "\r\n");
    let marked = |text: &str| format!("\u{feff}{text}");
    let cut = |text: &str| text.trim_end_matches('\n').to_owned();
    for spelling in [&crlf as &dyn Fn(&str) -> String, &marked, &cut] {
        assert_eq!(fixed(&spelling(text)), (spelling(&new), applied, errors));
    }
}

#[test]
fn several_problems_at_once() {
    check(
        "\
components:
  - name: sensor
    gates:
      - measurements: publish
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor/measurements, sensor.controller]
",
        expect![[r#"
            3 fixed, 0 left
            --- topology.yaml
            +++ topology.yaml
            @@ -1,9 +1,9 @@
             components:
               - name: sensor
                 gates:
            -      - measurements: publish
            +      - measurements: pub
               - name: controller
                 gates:
                   - sensor: sub
             connections:
            -  - [sensor/measurements, sensor.controller]
            +  - [sensor.measurements, controller.sensor]
        "#]],
    );
}

#[test]
fn what_may_mean_several_things_is_left() {
    let text = "components:\n  - name: a\n    gates:\n      - x1: pub\n      - x2: pub\n  - name: b\n    gates:\n      - x: sub\n\
                connections:\n  - [a.x3, b.x]\n";
    assert_eq!(fixed(text).0, text);
}

#[test]
fn a_file_without_problems_stays() {
    let text = "components: []\n";
    assert_eq!(fixed(text).0, text);
}

/// The rules whose examples are fixed, so that it shows when a rule stops offering its fix.
#[test]
fn a_sure_fix_of_an_example_removes_its_problem() {
    let mut fixed_rules = Vec::new();
    for rule in ALL.iter() {
        let Examples::Topology { bad, .. } = rule.examples else { continue };
        let check = |text: &str| load_bytes(&Request::new("topology.yaml"), text.as_bytes().to_vec());
        let loaded = check(bad);
        let has_fix =
            loaded.diagnostics.iter().any(|found| found.rule == *rule && found.fixes.iter().any(|fix| fix.sure));
        if has_fix {
            let fixed = fix(loaded, bad.to_owned(), check);
            let left = fixed.loaded.diagnostics.iter().find(|found| found.rule == *rule);
            assert!(left.is_none(), "{}: {left:?} in {}", rule.code, fixed.text);
            fixed_rules.push(rule.code);
        }
    }
    expect!["SCL0102 SCL0103 SCL0122 SCL0123 SCL0124 SCL0127 SCL0304 SCL0401 SCL0501 SCL0502 SCL0503 SCL0504"].assert_eq(&fixed_rules.join(" "));
}
