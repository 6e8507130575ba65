//! The difference of two texts in the unified format, which `patch` reads.

use similar::TextDiff;
use std::time::Duration;

/// Lines shown before and after a change.
const CONTEXT: usize = 3;

/// After this time, the difference may become longer than needed: the shortest one can take quadratic time.
const SEARCH: Duration = Duration::from_secs(1);

/// `--- path`, `+++ path` and the hunks; empty if nothing differs.
pub(super) fn unified_diff(path: &str, old: &str, new: &str) -> String {
    // Not `diff_lines`, which also splits lines at carriage returns.
    let [old, new] = [old, new].map(|text| text.split_inclusive('\n').collect::<Vec<_>>());
    let diff = TextDiff::configure().timeout(SEARCH).newline_terminated(true).diff_slices(&old, &new);
    diff.unified_diff().context_radius(CONTEXT).header(path, path).to_string()
}

#[cfg(test)]
mod tests {
    use super::unified_diff;
    use expect_test::{Expect, expect};

    fn check(old: &str, new: &str, expected: Expect) {
        expected.assert_eq(&unified_diff("t.yaml", old, new));
    }

    #[test]
    fn far_changes_have_hunks_of_their_own() {
        let lines: Vec<String> = (1..=20).map(|line| format!("line {line}\n")).collect();
        let old = lines.concat();
        let new = old.replace("line 2\n", "LINE 2\n").replace("line 18\n", "").replace("line 20\n", "line 20\nend\n");
        check(
            &old,
            &new,
            expect![[r#"
                --- t.yaml
                +++ t.yaml
                @@ -1,5 +1,5 @@
                 line 1
                -line 2
                +LINE 2
                 line 3
                 line 4
                 line 5
                @@ -15,6 +15,6 @@
                 line 15
                 line 16
                 line 17
                -line 18
                 line 19
                 line 20
                +end
            "#]],
        );
    }

    #[test]
    fn a_missing_last_newline_is_told() {
        check(
            "a\nb",
            "a\nc",
            expect![[r#"
                --- t.yaml
                +++ t.yaml
                @@ -1,2 +1,2 @@
                 a
                -b
                \ No newline at end of file
                +c
                \ No newline at end of file
            "#]],
        );
        check(
            "",
            "a\n",
            expect![[r#"
                --- t.yaml
                +++ t.yaml
                @@ -0,0 +1 @@
                +a
            "#]],
        );
    }

    #[test]
    fn equal_texts_have_no_difference() {
        assert_eq!(unified_diff("t.yaml", "a\r\n", "a\r\n"), "");
    }

    #[test]
    fn a_long_change_is_one_hunk() {
        let old: String = (0..500).map(|line| format!("{line}\n")).collect();
        let diff = unified_diff("t.yaml", &old, "new\n");
        assert!(diff.contains("@@ -1,500 +1 @@\n-0\n"), "{diff}");
    }
}
