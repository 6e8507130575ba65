//! Comments of declarations.

use crate::comment;
use crate::writer::Writer;

/// Writes a comment with a headline and the text of `doc:`.
pub(super) fn write_comment(headline: &str, doc: Option<&str>, out: &mut Writer) {
    let headline = comment::c_lines(headline).concat();
    let Some(doc) = doc else {
        out.line(format!("/* {headline} */"));
        return;
    };
    out.line(format!("/*\n * {headline}\n *"));
    comment::c_lines(doc).iter().for_each(|line| out.line(format!(" * {line}").trim_end()));
    out.line(" */");
}
