//! A model from bytes: mostly names from a short list, so that references match, sometimes any text.

use arbitrary::{Result, Unstructured};
use scl_topology::grammar::OPTIONS;
use scl_topology::model::{ComponentModel, ConnectionModel, ControlModel, GateModel, Model, OptionModel};
use scl_topology::source::{FileId, Sources, Span, Spanned};

const NAMES: [&str; 8] = ["a", "b", "c", "a_peer", "set-point", "setPoint", "type", "1st"];
const KINDS: [&str; 8] = ["pub", "sub", "req", "rep", "push", "pull", "", "teapot"];
const TYPES: [&str; 6] = ["T", "U", "nav.T", "A -> B", "B -> A", "Vec<u8>"];
/// Values of options besides their examples.
const VALUES: [&str; 5] = ["0", "0B", "wait", "true", "jsn"];
const CONTROLS: [&str; 4] =
    ["scl: allow(SCL0701) why", "scl: allow(SCL0703, SCL0707)", "scl: warn(SCL0710, 1)", "scl: allow("];

/// Makes a model from bytes; its spans point into a text of blank lines.
pub fn model(bytes: &mut Unstructured<'_>, sources: &mut Sources) -> Result<Model> {
    let file = sources.add("topology.yaml", " \n".repeat(64));
    let mut reader = Reader { bytes, file };
    let mut model = Model { connections_unread: reader.bytes.ratio(1, 16)?, ..Model::default() };
    model.components_unread = reader.bytes.ratio(1, 16)?;
    for _ in 0..reader.bytes.int_in_range(0..=6)? {
        model.components.push(reader.component()?);
    }
    for _ in 0..reader.bytes.int_in_range(0..=12)? {
        let ends = [reader.end()?, reader.end()?];
        let span = reader.span()?;
        model.connections.push(ConnectionModel { ends, span });
    }
    for _ in 0..reader.bytes.int_in_range(0..=3)? {
        let text = reader.one_of(&CONTROLS)?;
        model.controls.push(ControlModel { text, line: reader.bytes.int_in_range(0..=70)? });
    }
    Ok(model)
}

struct Reader<'u, 'b> {
    bytes: &'u mut Unstructured<'b>,
    file: FileId,
}

impl Reader<'_, '_> {
    fn component(&mut self) -> Result<ComponentModel> {
        let name = self.name()?;
        let mut component = ComponentModel {
            name,
            doc: None,
            optional: false,
            gates: Vec::new(),
            gates_unread: self.bytes.ratio(1, 16)?,
        };
        for _ in 0..self.bytes.int_in_range(0..=5)? {
            component.gates.push(self.gate()?);
        }
        Ok(component)
    }

    fn gate(&mut self) -> Result<GateModel> {
        let (name, kind) = (self.name()?, self.one_of(&KINDS)?);
        let payload = if self.bytes.ratio(1, 2)? { Some(self.one_of(&TYPES)?) } else { None };
        let mut gate = GateModel { name, kind, payload, options: Vec::new(), span: self.span()? };
        for _ in 0..self.bytes.int_in_range(0..=3)? {
            let option = self.bytes.choose(OPTIONS)?;
            let value = if self.bytes.ratio(1, 2)? { option.example() } else { *self.bytes.choose(&VALUES)? };
            let (key, value) = (self.spanned(option.key.to_owned())?, self.spanned(value.to_owned())?);
            gate.options.push(OptionModel { key, value, quoted: false });
        }
        Ok(gate)
    }

    fn end(&mut self) -> Result<Spanned<String>> {
        let (component, gate) = (self.name()?, self.name()?);
        self.spanned(format!("{}.{}", component.value, gate.value))
    }

    fn name(&mut self) -> Result<Spanned<String>> {
        if self.bytes.ratio(1, 32)? {
            let any: String = self.bytes.arbitrary()?;
            return self.spanned(any);
        }
        self.one_of(&NAMES)
    }

    fn one_of(&mut self, words: &[&str]) -> Result<Spanned<String>> {
        let word = (*self.bytes.choose(words)?).to_owned();
        self.spanned(word)
    }

    fn spanned(&mut self, value: String) -> Result<Spanned<String>> {
        Ok(Spanned { value, span: self.span()? })
    }

    fn span(&mut self) -> Result<Span> {
        let start = self.bytes.int_in_range(0..=120)?;
        Ok(Span { file: self.file, start, end: start + self.bytes.int_in_range(0..=8)? })
    }
}
