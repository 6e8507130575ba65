//! A function: its prototype stands in the header, its body in the source.

use crate::writer::Writer;

/// Longest line of generated code.
const LINE: usize = 120;

/// A function of the generated interface.
#[derive(Debug, Clone)]
pub(super) struct Function {
    /// Lines of a comment; none for what the gate's comment tells.
    pub(super) doc: &'static str,
    /// `scl_status` or `void`.
    pub(super) result: &'static str,
    pub(super) name: String,
    pub(super) parameters: Vec<String>,
    /// Lines of C.
    pub(super) body: Vec<String>,
}

impl Function {
    /// The comment and the prototype.
    pub(super) fn declare(&self, out: &mut Writer) {
        if !self.doc.is_empty() {
            out.line(format!("/* {} */", self.doc));
        }
        out.line(format!("{};", self.signature()));
    }

    /// The whole function.
    pub(super) fn define(&self, out: &mut Writer) {
        out.blank();
        out.line(self.signature());
        out.block("{", "}", |out| self.body.iter().for_each(|line| out.line(line)));
    }

    fn signature(&self) -> String {
        let start = format!("{} {}(", self.result, self.name);
        let line = format!("{start}{})", self.parameters.join(", "));
        if line.len() < LINE {
            return line;
        }
        let separator = format!(",\n{}", " ".repeat(start.len()));
        format!("{start}{})", self.parameters.join(&separator))
    }
}
