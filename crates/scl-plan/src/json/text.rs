//! JSON text with the fields in the order in which they are read best.

/// A value to be written.
pub(super) enum Json {
    Null,
    Bool(bool),
    Number(u64),
    Text(String),
    List(Vec<Json>),
    Object(Vec<(String, Json)>),
}

impl Json {
    pub(super) fn object<'k>(fields: impl IntoIterator<Item = (&'k str, Json)>) -> Self {
        Self::Object(fields.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
    }

    pub(super) fn text(text: &str) -> Self {
        Self::Text(text.to_owned())
    }

    pub(super) fn or_null(text: Option<&str>) -> Self {
        text.map_or(Self::Null, Self::text)
    }

    /// Appends the value, indented by two spaces a level, with a line for each field and each element.
    pub(super) fn write(&self, depth: usize, out: &mut String) {
        match self {
            Json::Null => out.push_str("null"),
            Json::Bool(value) => out.push_str(if *value { "true" } else { "false" }),
            Json::Number(number) => out.push_str(&number.to_string()),
            // `Value` prints itself as JSON.
            Json::Text(text) => out.push_str(&serde_json::Value::from(text.as_str()).to_string()),
            Json::List(items) => write_lines(["[", "]"], depth, out, items, |item, out| item.write(depth + 1, out)),
            Json::Object(fields) => write_lines(["{", "}"], depth, out, fields, |(key, value), out| {
                Json::text(key).write(depth, out);
                out.push_str(": ");
                value.write(depth + 1, out);
            }),
        }
    }
}

fn write_lines<T>(
    [open, close]: [&str; 2],
    depth: usize,
    out: &mut String,
    items: &[T],
    mut write: impl FnMut(&T, &mut String),
) {
    out.push_str(open);
    for (index, item) in items.iter().enumerate() {
        out.push_str(if index == 0 { "\n" } else { ",\n" });
        out.push_str(&"  ".repeat(depth + 1));
        write(item, out);
    }
    if !items.is_empty() {
        out.push('\n');
        out.push_str(&"  ".repeat(depth));
    }
    out.push_str(close);
}
