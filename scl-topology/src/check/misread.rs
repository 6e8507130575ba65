//! A word that YAML reads as a number or a boolean, or that has an invisible character in it, is told once: what else is
//! wrong with it follows from that, or goes when it is mended.

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
        let follows = found.code().starts_with("SCL03") || found.code().starts_with("SCL05");
        !(follows && found.primary.as_ref().is_some_and(|label| meets(label.span, &misread)))
    });
}

/// Whether a place overlaps with one of these, which do not overlap with each other.
fn meets(span: Span, spans: &[Span]) -> bool {
    let next = spans.partition_point(|other| other.start < span.end);
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
