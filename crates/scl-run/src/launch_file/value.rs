//! Values as they are written: commands and variables reach programs exactly as the file spells them. YAML would turn
//! `0x68` into `104`, and `1.10` into `1.1`.

use scl_topology::source::Span;
use scl_topology::yaml::{Node, NodeKind};

/// The text of a scalar, if it can be passed to a program.
pub(super) fn text(value: &Node) -> Option<&str> {
    value.text().filter(|text| !text.contains('\0'))
}

/// A path as written, which must not be empty.
pub(super) fn path(value: &Node) -> Option<String> {
    text(value).filter(|path| !path.is_empty()).map(str::to_owned)
}

/// `true` or `false`.
pub(super) fn flag(value: &Node) -> Option<bool> {
    match value.text().filter(|_| value.is_plain())? {
        "true" | "True" | "TRUE" => Some(true),
        "false" | "False" | "FALSE" => Some(false),
        _ => None,
    }
}

/// A whole number that is not negative, as YAML writes it.
pub(super) fn number(value: &Node) -> Option<u64> {
    let text = value.text().filter(|_| value.is_plain())?;
    match (text.strip_prefix("0x"), text.strip_prefix("0o")) {
        (Some(digits), _) => u64::from_str_radix(digits, 16).ok(),
        (_, Some(digits)) => u64::from_str_radix(digits, 8).ok(),
        _ => text.parse().ok(),
    }
}

/// A list of processors, or one of them; at least one.
pub(super) fn processors(value: &Node) -> Option<Vec<usize>> {
    let processor = |value: &Node| {
        // A hexadecimal number may be a mask of processors.
        let decimal = value.text().filter(|text| !text.starts_with("0x")).and_then(|_| number(value));
        let number = decimal.and_then(|number| usize::try_from(number).ok());
        number.filter(|number| *number < rustix::thread::CpuSet::MAX_CPU)
    };
    match value.items() {
        Some(numbers) if !numbers.is_empty() => numbers.iter().map(processor).collect(),
        Some(_) => None,
        None => Some(vec![processor(value)?]),
    }
}

/// The number of a port.
pub(super) fn port(value: &Node) -> Option<u16> {
    number(value).and_then(|number| u16::try_from(number).ok()).filter(|port| *port != 0)
}

/// The texts of a list; `None` if the value is not a list, or if an item is not a text.
pub(super) fn texts(value: &Node) -> Option<Vec<String>> {
    value.items()?.iter().map(|item| text(item).map(str::to_owned)).collect()
}

/// [`texts`] with their places.
pub(super) fn placed_texts(value: &Node) -> Option<Vec<(String, Span)>> {
    let places = value.items()?.iter().map(|item| item.span);
    Some(texts(value)?.into_iter().zip(places).collect())
}

/// Describes an unexpected value in messages.
pub(super) fn shown(value: &Node) -> String {
    match &value.kind {
        _ if value.is_null() => "nothing".to_owned(),
        NodeKind::Sequence { .. } => "a list".to_owned(),
        NodeKind::Mapping { .. } => "a mapping".to_owned(),
        NodeKind::Scalar { text, .. } => format!("`{text}`"),
        NodeKind::Unread => "what could not be read".to_owned(),
    }
}
