//! SCL0126: the marks that git leaves where two versions contradict each other.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::source::SourceFile;
use std::ops::Range;

/// SCL0126.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0126",
    severity: Severity::Error,
    title: "merge conflict marker",
    explanation: "git could not merge two versions of the file and left both in it, between `<<<<<<<`, `=======` and \
                  `>>>>>>>`. Keep the lines that are right, and remove the others together with the markers.",
    example: " components:
-<<<<<<< HEAD
   - name: sensor
-=======
-  - name: imu
->>>>>>> rename
     gates: []
",
};

const MARKERS: [&str; 4] = ["<<<<<<<", "|||||||", "=======", ">>>>>>>"];

/// Reports the first marker, and replaces the markers and all versions but the first by spaces. The version that is
/// left may not be the one meant, so neither syntax errors nor problems with its shape are reported.
pub(super) fn check(source: &SourceFile, text: &mut String) -> Option<Diagnostic> {
    let markers = markers(text);
    // A line of `=` alone proves nothing: it may underline a heading in a text.
    let (first, _) = markers.iter().find(|(_, sign)| *sign != '=')?.clone();
    let mut problem = RULE
        .at("this is a conflict marker of git", source.span(first.start..first.start + 7), "left by a merge")
        .help("keep the lines that are right, and remove the others and the markers");
    if let [_, .., (last, _)] = markers.as_slice() {
        problem = problem.note(format!("{} markers, up to line {}", markers.len(), source.line(last.start)));
    }
    blank(&markers, text);
    Some(problem)
}

/// The lines that start with a marker, and the sign that it consists of.
fn markers(text: &str) -> Vec<(Range<usize>, char)> {
    let mut start = 0;
    let mut found = Vec::new();
    for line in text.split_inclusive('\n') {
        let rest = MARKERS.iter().find_map(|marker| line.strip_prefix(marker));
        if rest.is_some_and(|rest| rest.is_empty() || rest.starts_with([' ', '\n', '\r'])) {
            let sign = line.chars().next().unwrap_or(' ');
            found.push((start..start + line.trim_end_matches(['\n', '\r']).len(), sign));
        }
        start += line.len();
    }
    found
}

/// Puts spaces in the place of the markers, and of all versions but the first.
fn blank(markers: &[(Range<usize>, char)], text: &mut String) {
    let mut bytes = std::mem::take(text).into_bytes();
    let mut fill = |range: Range<usize>| {
        bytes[range].iter_mut().filter(|byte| !matches!(byte, b'\n' | b'\r')).for_each(|byte| *byte = b' ');
    };
    let mut dropped_from: Option<usize> = None;
    for (marker, sign) in markers {
        fill(marker.clone());
        match (sign, dropped_from) {
            ('|' | '=', None) => dropped_from = Some(marker.end),
            ('>', Some(start)) => {
                fill(start..marker.end);
                dropped_from = None;
            }
            _ => {}
        }
    }
    // Only whole lines became spaces, so the text is still valid UTF-8.
    *text = String::from_utf8_lossy(&bytes).into_owned();
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::parse::testing::check;
    use expect_test::expect;

    #[test]
    fn example() {
        check(
            &RULE,
            expect![[r#"
            error: [SCL0126] this is a conflict marker of git
             --> topology.yaml:2:1
              |
            2 | <<<<<<< HEAD
              | ^^^^^^^ left by a merge
              |
              = help: keep the lines that are right, and remove the others and the markers
              = note: 3 markers, up to line 6"#]],
        );
    }
}
