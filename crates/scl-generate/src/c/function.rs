//! A function: its prototype goes into the header, its body into the source.

use crate::writer::Writer;

/// Longest line of generated code.
const LINE: usize = 120;

/// A function of the generated interface.
#[derive(Debug, Clone)]
pub(super) struct Function {
    /// The text of its comment; empty if the gate's comment is enough.
    pub(super) doc: &'static str,
    /// `scl_status` or `void`.
    pub(super) result: &'static str,
    pub(super) name: String,
    /// The parameters as in C, separated by commas.
    pub(super) parameters: String,
    /// Lines of C.
    pub(super) body: String,
}

impl Function {
    /// Creates a function that returns a status; `owner` is the prefix of its name.
    pub(super) fn new(owner: &str, call: &str, doc: &'static str, parameters: String, body: String) -> Self {
        Self { doc, result: "scl_status", name: format!("{owner}_{call}"), parameters, body }
    }

    /// Writes the comment and the prototype.
    pub(super) fn declare(&self, out: &mut Writer) {
        if !self.doc.is_empty() {
            out.line(format!("/* {} */", self.doc));
        }
        out.line(format!("{};", self.signature()));
    }

    /// Writes the whole function.
    pub(super) fn define(&self, out: &mut Writer) {
        out.blank();
        out.line(self.signature());
        out.block("{", "}", |out| out.line(&self.body));
    }

    /// Writes a macro that hides the function and checks the types of its pointers, about which compilers may say
    /// nothing.
    pub(super) fn check(&self, out: &mut Writer) {
        let (names, checks): (Vec<&str>, Vec<String>) = self.parameters.split(", ").map(checked).unzip();
        out.line(format!("#define {}({}) \\", self.name, names.join(", ")));
        let line = format!("    {}({})", self.name, checks.join(", "));
        match line.len() < LINE {
            true => out.line(line),
            false => out.line(format!("    {}( \\\n        {})", self.name, checks.join(", \\\n        "))),
        }
    }

    fn signature(&self) -> String {
        let start = format!("{} {}(", self.result, self.name);
        let line = format!("{start}{})", self.parameters);
        if line.len() < LINE {
            return line;
        }
        let separator = format!(",\n{}", " ".repeat(start.len()));
        format!("{start}{})", self.parameters.replace(", ", &separator))
    }
}

/// Returns the name of a parameter, and the argument that the macro passes on for it.
fn checked(parameter: &str) -> (&str, String) {
    let start = parameter.rfind(['*', ' ']).map_or(0, |end| end + 1);
    let (declared, name) = parameter.split_at(start);
    let check = match declared.strip_suffix('*').map(str::trim_end) {
        // Not checked: `const void *` accepts any pointer, and `const char *` is plain text.
        Some("const void" | "const char") | None => format!("({name})"),
        Some(pointee) => match pointee.strip_prefix("const ") {
            Some(pointee) => format!("SCL_CONST_POINTER({pointee}, {name})"),
            None => format!("SCL_POINTER({pointee}, {name})"),
        },
    };
    (name, check)
}

#[cfg(test)]
mod tests {
    use super::checked;

    #[test]
    fn pointers_to_types_are_checked() {
        let cases = [
            ("rover_sensor *self", "self", "SCL_POINTER(rover_sensor, self)"),
            ("const Rover__Setpoint *message", "message", "SCL_CONST_POINTER(Rover__Setpoint, message)"),
            ("Rover__Setpoint **message", "message", "SCL_POINTER(Rover__Setpoint *, message)"),
            ("uint64_t *ready", "ready", "SCL_POINTER(uint64_t, ready)"),
            ("const void *data", "data", "(data)"),
            ("const char *options_json", "options_json", "(options_json)"),
            ("int64_t timeout_ns", "timeout_ns", "(timeout_ns)"),
        ];
        for (parameter, name, check) in cases {
            assert_eq!(checked(parameter), (name, check.to_owned()));
        }
    }
}
