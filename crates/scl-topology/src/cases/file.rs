//! The format of the files with cases.

/// One case.
pub(super) struct Case {
    /// The check that it is about.
    pub(super) code: String,
    pub(super) title: String,
    /// The lines as written.
    lines: Vec<String>,
    /// The topology that the lines expand to.
    pub(super) text: String,
    /// Whether it is the first of its check.
    is_first: bool,
}

/// The cases of a file.
pub(super) fn read(file: &str) -> Vec<Case> {
    let mut cases: Vec<Case> = Vec::new();
    let (mut code, mut is_first) = (String::new(), false);
    for line in file.lines() {
        if let Some(of) = line.strip_prefix("# SCL") {
            (code, is_first) = (format!("SCL{of}"), true);
        } else if let Some(title) = line.strip_prefix("-- ") {
            let (code, title) = (code.clone(), title.to_owned());
            cases.push(Case { code, title, lines: Vec::new(), text: String::new(), is_first });
            is_first = false;
        } else if !line.starts_with("=> ") && !line.is_empty() {
            cases.last_mut().unwrap().lines.push(line.to_owned());
        }
    }
    cases.iter_mut().for_each(|case| case.text = expanded(&case.lines));
    cases
}

impl Case {
    pub(super) fn write(&self, outcome: &[String], out: &mut String) {
        if self.is_first {
            let gap = if out.is_empty() { "" } else { "\n" };
            out.push_str(&format!("{gap}# {}\n", self.code));
        }
        out.push_str(&format!("-- {}\n", self.title));
        self.lines.iter().chain(outcome).for_each(|line| out.push_str(&format!("{line}\n")));
    }
}

/// Expands the shorthand of a case to the text of a topology.
fn expanded(lines: &[String]) -> String {
    let mut text = String::new();
    for line in lines.iter().map(|line| shown(line)) {
        if let Some(ends) = line.strip_prefix("@- ") {
            section("connections:\n", &mut text);
            text.push_str(&format!("  - [{ends}]\n"));
        } else if let Some((name, gates)) = line.strip_prefix('@').and_then(|short| short.split_once(" | ")) {
            section("components:\n", &mut text);
            text.push_str(&format!("  - name: {name}\n    gates:\n"));
            gates.split("; ").for_each(|gate| text.push_str(&format!("      - {gate}\n")));
        } else {
            text.push_str(&format!("{line}\n"));
        }
    }
    text
}

fn section(head: &str, text: &mut String) {
    if !text.contains(head) {
        text.push_str(head);
    }
}

/// Replaces escapes, such as `<TAB>` and `<U+00A0>`, by the characters that an editor would hide.
fn shown(line: &str) -> String {
    let mut out = String::new();
    let mut rest = line;
    while let Some((before, after)) = rest.split_once('<') {
        out.push_str(before);
        let name = after.split('>').next().unwrap();
        let code = name.strip_prefix("U+").and_then(|code| u32::from_str_radix(code, 16).ok());
        match code.and_then(char::from_u32).or((name == "TAB").then_some('\t')) {
            Some(character) => {
                out.push(character);
                rest = &after[name.len() + 1..];
            }
            None => {
                out.push('<');
                rest = after;
            }
        }
    }
    out + rest
}

/// Replaces hidden characters by escapes; the inverse of [`shown`].
pub(super) fn hidden(line: &str) -> String {
    line.chars()
        .map(|character| match character {
            '\t' => "<TAB>".to_owned(),
            other if other.is_ascii() && !other.is_control() => other.to_string(),
            other => format!("<U+{:04X}>", u32::from(other)),
        })
        .collect()
}
