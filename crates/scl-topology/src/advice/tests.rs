//! The trial on a language of four words, so that each test shows the whole of its case.

use super::{Extent, Judged, MOST_TRIES, try_advice};
use crate::diagnostic::{Diagnostic, Edit};
use crate::external::{FILE_NOT_FOUND, NOT_UTF8};
use crate::source::{FileId, Sources, Span};

/// Each word that is a problem, and what is proposed for it.
const WORDS: [(&str, &[&str]); 4] = [
    ("bad", &["good"]),
    // Leaves its problem, or adds another.
    ("worse", &["worse!", "bad"]),
    ("unsure", &["one", "bad", "two"]),
    ("stuck", &["stuck!"]),
];

/// The problems of a text; it is cut off at the first `(`.
fn judge(sources: &Sources, file: FileId) -> Judged {
    let text = sources.file(file).text();
    let read = text.find('(').unwrap_or(text.len());
    let mut problems: Vec<Diagnostic> = Vec::new();
    for (word, meant) in WORDS {
        for (at, _) in text[..read].match_indices(word) {
            let span = Span { file, start: at as u32, end: (at + word.len()) as u32 };
            problems.push(FILE_NOT_FOUND.at(word, span, "").did_you_mean(word, meant).otherwise("nothing is allowed"));
        }
    }
    if read < text.len() {
        let open = Span { file, start: read as u32, end: read as u32 + 1 };
        problems.push(NOT_UTF8.at("open", open, "").propose("remove it", [Edit::new(open, "")]));
        if let Some(end) = text[read..].find(' ') {
            let end = Span { start: (read + end) as u32, end: (read + end) as u32, ..open };
            problems.last_mut().into_iter().for_each(|last| {
                *last = last.clone().suggest("close it", [Edit::new(open, "["), Edit::new(end, "]")]);
            });
        }
    }
    problems.sort_by_key(|problem| problem.primary.as_ref().map(|label| label.span.start));
    Judged { problems, extent: Extent { is_cut_off: read < text.len(), unread: 0 } }
}

/// The helps of each problem after the trial, the number of proposals that are sure, and the number of copies checked.
fn tried(text: &str) -> (Vec<String>, usize, usize) {
    let mut sources = Sources::new();
    let file = sources.add("", text);
    let (mut found, mut copies) = (judge(&sources, file), 0);
    try_advice(&mut found, sources.file(file), |copy| {
        copies += 1;
        judge(&sources.with_text(file, copy), file)
    });
    let helps = |problem: &Diagnostic| problem.shown_helps().map(|help| help.text().into_owned()).collect::<Vec<_>>();
    let sure = found.problems.iter().flat_map(Diagnostic::proposals).filter(|proposal| proposal.is_sure).count();
    (found.problems.iter().map(|problem| helps(problem).join(", ")).collect(), sure, copies)
}

#[test]
fn only_what_solves_its_problem_and_adds_none_is_shown() {
    for (text, helps, sure) in [
        ("good", &[][..], 0),
        ("bad", &["did you mean `good`?"], 1),
        ("worse", &["nothing is allowed"], 0),
        ("stuck", &["nothing is allowed"], 0),
        ("unsure", &["did you mean `one` or `two`?"], 0),
        ("bad bad", &["did you mean `good`?", "did you mean `good`?"], 2),
        ("stuck bad", &["nothing is allowed", "did you mean `good`?"], 1),
    ] {
        let (told, are_sure, _) = tried(text);
        assert_eq!((told.iter().map(String::as_str).collect::<Vec<_>>(), are_sure), (helps.to_vec(), sure), "{text}");
    }
}

/// What is left of several alternatives is not certain.
#[test]
fn the_last_of_several_is_not_sure() {
    let mut sources = Sources::new();
    let file = sources.add("", "worse");
    let span = Span { file, start: 0, end: 5 };
    let mut found = judge(&sources, file);
    found.problems = vec![FILE_NOT_FOUND.at("worse", span, "").did_you_mean("worse", &["bad", "good"])];
    try_advice(&mut found, sources.file(file), |copy| judge(&sources.with_text(file, copy), file));
    let left: Vec<_> = found.problems[0].proposals().map(|left| (&*left.edits[0].replacement, left.is_sure)).collect();
    assert_eq!(left, [("good", false)]);
}

#[test]
fn many_proposals_are_tried_together() {
    let (told, sure, copies) = tried(&"bad ".repeat(500));
    assert_eq!((told.len(), sure, copies), (500, 500, 1));
    let (told, sure, copies) = tried(&format!("{}stuck {}", "bad ".repeat(99), "bad ".repeat(100)));
    let helped = told.iter().filter(|help| *help == "did you mean `good`?").count();
    assert_eq!((told[99].as_str(), copies <= MOST_TRIES), ("nothing is allowed", true));
    assert_eq!((helped, sure), (199, 199), "{copies} copies");
    // What cannot be tried any more is not shown.
    let (told, sure, copies) = tried(&"bad stuck ".repeat(500));
    assert_eq!((told.len(), copies), (1_000, MOST_TRIES));
    assert!(sure < 500, "{sure}");
}

#[test]
fn one_copy_of_a_large_text_is_checked() {
    let text = format!("bad{}bad", " ".repeat(3 << 20));
    assert_eq!(tried(&text).1, 2);
    assert_eq!(tried(&text).2, 1);
}

/// What stands behind the place where reading stopped was wrong before; what stands in its line may be wrong now.
#[test]
fn problems_further_down_are_revealed() {
    assert_eq!(tried("(a b\nbad").0, ["close it"], "it was there before");
    assert_eq!(tried("(a bad").0, [""], "it may be the consequence");
    assert_eq!(tried("(a b\n  bad").0, [""], "it belongs to the changed line");
    assert_eq!(tried("(a b\n(c").0, [""], "it may be the same mistake, moved");
    assert_eq!(tried("(a b\nc\n(d").0, ["close it"]);
    assert_eq!(tried("(a b\nc").0, ["remove it, close it"]);
}

#[test]
fn a_text_with_other_line_ends_keeps_them() {
    let mut sources = Sources::new();
    let file = sources.add("", "a\r\nb\r\n");
    let at = Span { file, start: 3, end: 4 };
    let edit = |replacement| Edit::new(at, replacement);
    assert_eq!(super::apply("a\r\nb\r\n", &[&edit("c\nd")]).as_deref(), Some("a\r\nc\r\nd\r\n"));
    assert_eq!(super::apply("a\nb", &[&edit("c")]), None, "outside of the text");
    assert_eq!(super::apply("a\r\nb\r\n", &[&edit("c"), &edit("d")]), None, "they overlap");
}
