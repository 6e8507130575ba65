//! Texts of the topology file inside comments of other languages. A text must not end its comment.

/// The lines of a text for a block comment of C and C++.
pub(crate) fn c_lines(text: &str) -> Vec<String> {
    lines(text).map(|line| without_trigraphs(&line).replace("*/", "* /").replace("/*", "/ *")).collect()
}

/// The lines of a text for line comments of C++. Backslashes at the end of a line are removed, because they would
/// continue the comment on the next line.
pub(crate) fn cpp_lines(text: &str) -> Vec<String> {
    lines(text).map(|line| without_trigraphs(line.trim_end_matches('\\')).trim_end().to_owned()).collect()
}

/// Breaks up the trigraph of a backslash, which compilers warn about even in comments.
fn without_trigraphs(line: &str) -> String {
    line.replace("??/", "?? /")
}

/// The lines of a text, without control characters and trailing spaces; empty ones at the end are left out.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = String> {
    let line = |line: &str| {
        let shown: String = line.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect();
        shown.trim_end().to_owned()
    };
    text.trim_end().lines().map(line)
}

#[cfg(test)]
mod tests {
    use super::{c_lines, cpp_lines};

    #[test]
    fn no_text_ends_its_comment() {
        assert_eq!(c_lines("one */ two\n\n/*/ \u{7} \n\n"), ["one * / two", "", "/ * /"]);
        assert_eq!(c_lines("really??/"), ["really?? /"]);
        assert_eq!(cpp_lines("one \\\\\ntwo??/\n\\"), ["one", "two?? /", ""]);
    }
}
