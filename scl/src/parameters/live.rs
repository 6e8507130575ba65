//! Parameters that can be changed while the program runs.

use super::from_value::FromParameter;
use crate::error::{BlockingError, SetError};
use crate::state::Owner;
use std::fmt;
use std::marker::PhantomData;
use std::time::Duration;

/// A parameter that is declared with `live: true`, so that its value can change while the program runs.
///
/// `scl set controller.gain=2` sets it, or the program itself with [`set`](Self::set). A value that the parameter
/// cannot have is refused before it gets here, so [`get`](Self::get) always returns a good one.
///
/// ```no_run
/// scl::topology!("doc/steering.yaml");
///
/// #[scl::main]
/// async fn main(mut steering: Steering) -> scl::Result<()> {
///     loop {
///         tokio::select! {
///             error = steering.error.recv() => {
///                 steering.angle.send(&(steering.parameters.gain.get() * error?)).await?;
///             }
///             mode = steering.parameters.mode.changed() => println!("the mode is now {}", mode?),
///         }
///     }
/// }
/// ```
///
/// Each value tells every change once to its holder; a clone tells changes to another holder. Like a gate, it keeps its
/// component open.
pub struct Live<T> {
    state: Owner,
    index: usize,
    /// How many changes were told.
    told: u64,
    value: PhantomData<fn() -> T>,
}

impl<T: FromParameter> Live<T> {
    /// The parameter at an index of the component's list; `None` if it is of another type.
    pub(crate) fn of(state: Owner, index: usize) -> Option<Self> {
        let live = Self { state, index, told: 0, value: PhantomData };
        live.read().map(|_| live)
    }

    /// Returns the value that it has now.
    ///
    /// # Panics
    /// Never: its type was checked when the component was opened.
    pub fn get(&self) -> T {
        match self.read() {
            Some((value, _)) => value,
            None => unreachable!("the type of a parameter was checked when the component was opened"),
        }
    }

    /// Waits until the value changes, and returns the new one. Changes since the component was opened, or since the
    /// last one that was told, are not missed; of several, it returns the newest value.
    ///
    /// # Errors
    /// [`BlockingError::Closed`] if the component's calls were ended; [`BlockingError::Forked`] in a forked child.
    ///
    /// # Cancel safety
    /// Cancel safe: a change is told only when this is ready.
    pub async fn changed(&mut self) -> Result<T, BlockingError> {
        let changes = self.state.changes();
        loop {
            let mut next = std::pin::pin!(changes.next());
            // Subscribe before looking, so that no change is missed.
            next.as_mut().enable();
            self.state.check_silently()?;
            if let Some(value) = self.try_changed() {
                return Ok(value);
            }
            let _waiting = self.state.waiting();
            next.await;
        }
    }

    /// [`changed`](Self::changed) from a plain thread.
    ///
    /// # Errors
    /// Those of `changed`, and [`BlockingError`] inside async code or after a stop request.
    pub fn changed_blocking(&mut self) -> Result<T, BlockingError> {
        let state = self.state.clone();
        state.block_on(self.changed())?
    }

    /// [`changed_blocking`](Self::changed_blocking) with a time limit; `None` if the value has not changed in time.
    ///
    /// # Errors
    /// Those of `changed_blocking`.
    pub fn changed_timeout(&mut self, timeout: Duration) -> Result<Option<T>, BlockingError> {
        let state = self.state.clone();
        state.block_on_for(timeout, self.changed())?.transpose()
    }

    /// Returns the value if it has changed since the component was opened, or since the last change that was told.
    pub fn try_changed(&mut self) -> Option<T> {
        let (value, changes) = self.read()?;
        debug_assert!(changes >= self.told, "changes are only added");
        let has_changed = changes > self.told;
        self.told = changes;
        has_changed.then_some(value)
    }

    /// Sets the value, as a text like in the topology file: `10ms`. Everybody who waits for a change is told, here too.
    ///
    /// # Errors
    /// [`SetError::WrongValue`] if the parameter cannot have it.
    pub fn set(&self, value: &str) -> Result<(), SetError> {
        self.state.set_parameters([(&*self.state.spec.parameters[self.index].name, value)])
    }

    fn read(&self) -> Option<(T, u64)> {
        self.state.parameters.read(self.index, |value, changes| Some((T::from_value(value)?, changes)))?
    }
}

/// A clone tells the changes that were not told to the original, too.
impl<T> Clone for Live<T> {
    fn clone(&self) -> Self {
        let Self { state, index, told, value } = self;
        Self { state: state.clone(), index: *index, told: *told, value: *value }
    }
}

/// Two are equal while they have the same value.
impl<T: FromParameter + PartialEq> PartialEq for Live<T> {
    fn eq(&self, other: &Self) -> bool {
        self.get() == other.get()
    }
}

impl<T: FromParameter + fmt::Debug> fmt::Debug for Live<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.get().fmt(f)
    }
}
