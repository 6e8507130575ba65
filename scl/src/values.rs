//! The values of an open component's parameters.

use crate::error::SetError;
use crate::registration::ValuesWriter;
use crate::spec::ComponentSpec;
use crate::sync::lock;
use scl_plan::ParameterValue;
use scl_text::suggest::closest_name;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// The value of a parameter.
#[derive(Debug, Clone)]
pub(crate) struct Value {
    /// As it was given.
    text: String,
    value: ParameterValue,
    /// How often it has changed.
    changes: u64,
}

/// The values of all parameters of a component.
#[derive(Default)]
pub(crate) struct Values {
    /// In file order; none of a tool in the place of the program. Locked only for a moment, because control loops read
    /// them.
    current: Mutex<Vec<Value>>,
    /// How often any of them has changed.
    changes: AtomicU64,
    /// Locked while values are set: the file gets them in the order in which they were set.
    file: Mutex<Option<ValuesWriter>>,
}

impl Value {
    pub(crate) fn new(text: &str, value: ParameterValue) -> Self {
        Self { text: text.to_owned(), value, changes: 0 }
    }

    /// As it was given.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    #[cfg(test)]
    pub(crate) fn get(&self) -> &ParameterValue {
        &self.value
    }
}

impl Values {
    pub(crate) fn new(current: Vec<Value>, file: Option<ValuesWriter>) -> Self {
        Self { current: Mutex::new(current), changes: AtomicU64::new(0), file: Mutex::new(file) }
    }

    /// Calls `read` with the value at an index of the component's list, and how often it has changed; `None` if there
    /// is none.
    pub(crate) fn read<R>(&self, index: usize, read: impl FnOnce(&ParameterValue, u64) -> R) -> Option<R> {
        lock(&self.current).get(index).map(|value| read(&value.value, value.changes))
    }

    /// How often any of them has changed.
    pub(crate) fn changes(&self) -> u64 {
        self.changes.load(Ordering::Acquire)
    }

    /// Sets several values, given as texts by name: all of them, or none. Returns true if one of them has changed.
    ///
    /// # Errors
    /// One of them is not a live parameter of the component, or cannot have its value.
    pub(crate) fn set<'v>(
        &self,
        spec: &'static ComponentSpec,
        wanted: impl IntoIterator<Item = (&'v str, &'v str)>,
    ) -> Result<bool, SetError> {
        let read = wanted.into_iter().map(|(name, text)| read(spec, name, text));
        let read: Vec<(usize, Value)> = read.collect::<Result<_, _>>()?;
        let file = lock(&self.file);
        let has_changed = {
            let mut current = lock(&self.current);
            let mut has_changed = false;
            for (index, value) in read {
                // A tool in the place of the program has no values.
                let Some(now) = current.get_mut(index) else { continue };
                let changes = now.changes + u64::from(now.value != value.value);
                has_changed |= changes > now.changes;
                *now = Value { changes, ..value };
            }
            has_changed
        };
        if has_changed {
            self.changes.fetch_add(1, Ordering::Release);
        }
        if let Some(file) = &*file {
            file.write(&self.named(spec));
        }
        Ok(has_changed)
    }

    /// All names and values as texts, in file order.
    pub(crate) fn named(&self, spec: &'static ComponentSpec) -> Vec<(&'static str, String)> {
        let current = lock(&self.current);
        debug_assert!(current.is_empty() || current.len() == spec.parameters.len(), "each parameter has a value");
        spec.parameters.iter().zip(&*current).map(|(parameter, value)| (&*parameter.name, value.text.clone())).collect()
    }
}

/// The index of a parameter in the component's list.
///
/// # Errors
/// There is none of this name: the name that was probably meant, if there is one.
pub(crate) fn index_of(spec: &ComponentSpec, name: &str) -> Result<usize, Option<String>> {
    let index = spec.parameters.iter().position(|parameter| parameter.name == name);
    index.ok_or_else(|| closest_name(name, spec.parameters.iter().map(|it| &*it.name)).map(str::to_owned))
}

/// The new value of a live parameter, and its index.
fn read(spec: &'static ComponentSpec, name: &str, text: &str) -> Result<(usize, Value), SetError> {
    let component = spec.name;
    let unknown = |nearest| SetError::NoSuchParameter { component, parameter: name.to_owned(), nearest };
    let index = index_of(spec, name).map_err(unknown)?;
    let parameter = &spec.parameters[index];
    let name = &*parameter.name;
    if !parameter.live {
        return Err(SetError::Fixed { component, parameter: name });
    }
    let value = parameter.read(text).map_err(|reason| SetError::WrongValue { component, parameter: name, reason })?;
    Ok((index, Value::new(text, value)))
}
