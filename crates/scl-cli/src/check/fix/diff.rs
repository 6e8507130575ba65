//! The difference of two texts in the unified format, which `patch` reads.

use std::fmt::Write;
use std::ops::Range;

/// Lines shown before and after a change.
const CONTEXT: usize = 3;

/// How far the lines of two texts are searched for the end of a change. Fixes change few lines at a time; a longer change
/// is shown as one.
const WINDOW: usize = 64;

/// `--- path`, `+++ path` and the hunks; empty if nothing differs.
pub(super) fn unified_diff(path: &str, old: &str, new: &str) -> String {
    let (old, new): (Vec<&str>, Vec<&str>) = (old.split_inclusive('\n').collect(), new.split_inclusive('\n').collect());
    let changes = changes(&old, &new);
    let mut out = String::new();
    if !changes.is_empty() {
        let _ = write!(out, "--- {path}\n+++ {path}\n");
    }
    let mut rest = changes.as_slice();
    while let Some(first) = rest.first() {
        // Changes whose contexts meet share a hunk.
        let apart = |pair: &[Change]| pair[1].old.start - pair[0].old.end > 2 * CONTEXT;
        let count = rest.windows(2).position(apart).map_or(rest.len(), |at| at + 1);
        let (hunk, others) = rest.split_at(count);
        let last = hunk.last().unwrap_or(first);
        let before = first.old.start.min(CONTEXT);
        let after = (old.len() - last.old.end).min(CONTEXT);
        let lines = |range: Range<usize>| format!("{},{}", range.start + usize::from(!range.is_empty()), range.len());
        let old_lines = lines(first.old.start - before..last.old.end + after);
        let new_lines = lines(first.new.start - before..last.new.end + after);
        let _ = writeln!(out, "@@ -{old_lines} +{new_lines} @@");
        let mut at = first.old.start - before;
        for change in hunk {
            write_lines(' ', &old[at..change.old.start], &mut out);
            write_lines('-', &old[change.old.clone()], &mut out);
            write_lines('+', &new[change.new.clone()], &mut out);
            at = change.old.end;
        }
        write_lines(' ', &old[at..at + after], &mut out);
        rest = others;
    }
    out
}

/// Lines that were replaced by others; either may be none.
struct Change {
    old: Range<usize>,
    new: Range<usize>,
}

fn changes(old: &[&str], new: &[&str]) -> Vec<Change> {
    let mut changes = Vec::new();
    let (mut at_old, mut at_new) = (0, 0);
    while at_old < old.len() || at_new < new.len() {
        if old.get(at_old) == new.get(at_new) {
            (at_old, at_new) = (at_old + 1, at_new + 1);
            continue;
        }
        let (lost, added) = length_of_change(&old[at_old..], &new[at_new..]);
        changes.push(Change { old: at_old..at_old + lost, new: at_new..at_new + added });
        (at_old, at_new) = (at_old + lost, at_new + added);
    }
    changes
}

/// How many lines of each text differ until both go on with the same line.
fn length_of_change(old: &[&str], new: &[&str]) -> (usize, usize) {
    for distance in 1..2 * WINDOW {
        // Equally many lines on both sides are the most likely.
        let mut splits: Vec<usize> = (0..=distance).collect();
        splits.sort_by_key(|lost| (2 * lost).abs_diff(distance));
        let meets = |lost: &usize| match (old.get(*lost), new.get(distance - lost)) {
            (Some(old), Some(new)) => old == new,
            (None, None) => *lost == old.len() && distance - lost == new.len(),
            _ => false,
        };
        if let Some(lost) = splits.into_iter().find(meets) {
            return (lost, distance - lost);
        }
    }
    (old.len(), new.len())
}

fn write_lines(sign: char, lines: &[&str], out: &mut String) {
    for line in lines {
        let _ = write!(out, "{sign}{line}");
        if !line.ends_with('\n') {
            out.push_str("\n\\ No newline at end of file\n");
        }
    }
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
                @@ -0,0 +1,1 @@
                +a
            "#]],
        );
    }

    #[test]
    fn equal_texts_have_no_difference() {
        assert_eq!(unified_diff("t.yaml", "a\r\n", "a\r\n"), "");
    }

    #[test]
    fn a_change_longer_than_the_window_is_one_hunk() {
        let old: String = (0..500).map(|line| format!("{line}\n")).collect();
        let diff = unified_diff("t.yaml", &old, "new\n");
        assert!(diff.contains("@@ -1,500 +1,1 @@\n-0\n"), "{diff}");
    }
}
