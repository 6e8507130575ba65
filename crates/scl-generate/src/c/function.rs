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

    /// A macro in front of the function that checks the types of its pointers, of which compilers may say nothing.
    pub(super) fn check(&self, out: &mut Writer) {
        let arguments: Vec<(&str, String)> = self.parameters.iter().map(|parameter| checked(parameter)).collect();
        let names: Vec<&str> = arguments.iter().map(|(name, _)| *name).collect();
        out.line(format!("#define {name}({}) \\", names.join(", "), name = self.name));
        let checks: Vec<String> = arguments.into_iter().map(|(_, check)| check).collect();
        let line = format!("    {}({})", self.name, checks.join(", "));
        match line.len() < LINE {
            true => out.line(line),
            false => out.line(format!("    {}( \\\n        {})", self.name, checks.join(", \\\n        "))),
        }
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

/// The name of a parameter, and what its macro passes on.
fn checked(parameter: &str) -> (&str, String) {
    let start = parameter.rfind(['*', ' ']).map_or(0, |end| end + 1);
    let (declared, name) = parameter.split_at(start);
    let check = match declared.strip_suffix('*').map(str::trim_end) {
        // Any pointer becomes one to `void`, and text is text.
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
