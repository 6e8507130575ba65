//! Values of the crate `scl` behind Python objects.

use crate::process::Inside;
use pyo3::prelude::*;
use scl_fork::ProcessMark;
use std::ops::Deref;

/// A value that is dropped with the interpreter released, because dropping it may wait for peers, and only in the
/// process that made it.
///
/// The interpreter of a forked child drops all objects that it has inherited, too. Their values may be locked, or half
/// changed, by threads that exist in the parent only.
pub(crate) struct Native<T: Send> {
    /// `None` once dropped.
    value: Option<T>,
    process: ProcessMark,
}

impl<T: Send> Native<T> {
    pub(crate) fn new(value: T, process: ProcessMark) -> Self {
        Self { value: Some(value), process }
    }
}

impl<T: Send> Deref for Native<T> {
    type Target = T;

    fn deref(&self) -> &T {
        match &self.value {
            Some(value) => value,
            None => unreachable!("the value is taken only when it is dropped"),
        }
    }
}

impl<T: Send> Drop for Native<T> {
    fn drop(&mut self) {
        let mut value = self.value.take();
        if !self.process.is_own() {
            return std::mem::forget(value);
        }
        Python::try_attach(|py| match Inside::enter() {
            Some(_inside) => py.detach(|| drop(value.take())),
            None => drop(value.take()),
        });
        drop(value);
    }
}
