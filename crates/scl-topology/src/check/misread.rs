//! A word that YAML reads as a number or a boolean, or that has an invisible character in it, is reported once: its
//! other problems follow from that, or disappear when it is fixed.

use crate::diagnostic::Diagnostics;
use crate::parse::MISREAD;
use crate::source::Span;

pub(super) fn tell_once(problems: &mut Diagnostics) {
    let mut misread: Vec<Span> = Vec::new();
    problems.retain(|found| {
        let is_misread = MISREAD.contains(&found.rule);
        misread.extend(found.primary.as_ref().filter(|_| is_misread).map(|label| label.span));
        true
    });
    misread.sort_unstable();
    problems.retain(|found| {
        if MISREAD.contains(&found.rule) {
            return true;
        }
        let at = found.primary.iter().map(|label| label.span);
        let others = found.secondary.iter().map(|label| label.span);
        match found.code().get(..5) {
            Some("SCL03" | "SCL04" | "SCL05") => !at.into_iter().any(|span| meets(span, &misread)),
            // Two types may differ because either of them was misread.
            Some("SCL06") => !at.chain(others).any(|span| meets(span, &misread)),
            _ => true,
        }
    });
}

/// Whether a place overlaps one of `spans`, which are sorted and do not overlap each other.
fn meets(span: Span, spans: &[Span]) -> bool {
    let next = spans.partition_point(|other| (other.file, other.start) < (span.file, span.end));
    next > 0 && spans[next - 1].file == span.file && spans[next - 1].end > span.start
}

#[cfg(test)]
mod tests {
    use crate::check::testing::codes;

    #[test]
    fn a_number_is_no_name_with_a_dot() {
        let yaml =
            "components:\n  - name: 1.10\n    gates: []\n  - name: 2nd\n    gates: []\nconnections:\n  - [1.10, 2.x]\n";
        assert_eq!(codes(yaml), ["SCL0109", "SCL0305", "SCL0109", "SCL0501"]);
    }
}
