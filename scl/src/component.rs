//! Components: the functions that generated code and `#[scl::main]` call.

mod enums;
mod expected;
mod kind;
mod main;
mod methods;
mod needs;
mod opener;
mod outcome;
mod realtime;
mod simulation;
mod transports;

pub(crate) use kind::started_as;
pub use main::{run_async, run_blocking};
pub use opener::Opener;
pub use outcome::Returned;
pub(crate) use realtime::Settings as RealTimeSettings;

use crate::error::{BlockingError, MissingPeer, NotFlushed, NotReady, OpenError, PeerName};
use crate::gate::{AnyGate, Watch};
use crate::log;
use crate::options::OpenOptions;
use crate::spec::{ComponentSpec, KindSpec};
pub use crate::state::ComponentHandle;
use crate::state::{Flush, OwnedRuntime};
use std::sync::Arc;
use std::time::Duration;
use tokio::time::Instant;

/// A component of a topology, or any component of a kind. Only `topology!` implements this trait. The methods that
/// open, await and close a component are inherent methods of the generated struct.
pub trait Component: Sized + Send + Sync + 'static {
    /// What the topology says about the component; for a kind, about its first component.
    const SPEC: &'static ComponentSpec;

    /// The kind, of which a program may be any component.
    const KIND: Option<&'static KindSpec> = None;

    #[doc(hidden)]
    fn assemble(opener: &mut Opener) -> Result<Self, OpenError>;

    #[doc(hidden)]
    fn handle(&self) -> &ComponentHandle;

    /// Returns the component's gates, in the order of the topology file.
    fn gates(&self) -> Vec<&dyn AnyGate>;
}

/// Opens a component on the tokio runtime of the caller.
#[doc(hidden)]
pub async fn open<C: Component>(options: OpenOptions) -> Result<C, OpenError> {
    open_spec(kind::spec::<C>(&options)?, &options)
}

/// Opens the component at an index of its kind's list.
#[doc(hidden)]
pub async fn open_as<C: Component>(index: usize, options: OpenOptions) -> Result<C, OpenError> {
    open_spec(kind::spec_at::<C>(index)?, &options)
}

fn open_spec<C: Component>(spec: &'static ComponentSpec, options: &OpenOptions) -> Result<C, OpenError> {
    if tokio::runtime::Handle::try_current().is_err() {
        return Err(OpenError::NoRuntime { component: spec.name });
    }
    C::assemble(&mut Opener::begin(spec, options, None)?)
}

/// Opens a component for a program without async.
#[doc(hidden)]
pub fn open_blocking<C: Component>(options: OpenOptions) -> Result<C, OpenError> {
    open_spec_blocking(kind::spec::<C>(&options)?, &options)
}

/// [`open_as`] for a program without async.
#[doc(hidden)]
pub fn open_blocking_as<C: Component>(index: usize, options: OpenOptions) -> Result<C, OpenError> {
    open_spec_blocking(kind::spec_at::<C>(index)?, &options)
}

fn open_spec_blocking<C: Component>(spec: &'static ComponentSpec, options: &OpenOptions) -> Result<C, OpenError> {
    let runtime = OwnedRuntime::start(spec.name)?;
    let _entered = runtime.enter();
    C::assemble(&mut Opener::begin(spec, options, Some(Arc::clone(&runtime)))?)
}

/// The index of an open component in the list of its kind.
#[doc(hidden)]
pub fn instance<C: Component>(component: &C) -> usize {
    let name = component.handle().0.spec.name;
    let components = C::KIND.map_or(&[][..], |kind| kind.components);
    // In a unit test, the component is the first of its kind.
    components.iter().position(|(other, _)| *other == name).unwrap_or_default()
}

/// Waits until all required peers are connected.
#[doc(hidden)]
pub async fn ready<C: Component>(component: &C, timeout: Duration) -> Result<(), NotReady> {
    let watches: Vec<Watch> = component.gates().into_iter().map(AnyGate::watch).collect();
    wait_for_peers(component.handle(), &watches, timeout).await
}

/// Waits until no peer is missing at any of these gates.
pub(crate) async fn wait_for_peers(
    handle: &ComponentHandle,
    watches: &[Watch],
    timeout: Duration,
) -> Result<(), NotReady> {
    let state = &handle.0;
    let missing = || watches.iter().flat_map(|watch| watch.missing().into_iter().map(|missing| (watch.spec, missing)));
    let _waiting = state.waiting();
    let changes = state.changes();
    let started = Instant::now();
    let deadline = started.checked_add(timeout);
    loop {
        let mut changed = std::pin::pin!(changes.next());
        // Subscribe before checking, so that no change is missed.
        changed.as_mut().enable();
        if missing().next().is_none() {
            return Ok(());
        }
        let ended = state.check().is_err();
        let changed = async {
            match deadline {
                Some(deadline) => tokio::time::timeout_at(deadline, changed).await.is_ok(),
                // The deadline overflows, so wait without one.
                None => {
                    changed.await;
                    true
                }
            }
        };
        if ended || !changed.await {
            let missing = missing().map(|(gate, missing)| {
                let reason = state.explain(gate, &missing);
                let (peer, refused) = (PeerName::of(missing.connection), missing.refusal.is_some());
                MissingPeer { gate: gate.name, peer, reason, refused }
            });
            let missing: Vec<MissingPeer> = missing.collect();
            return match missing.is_empty() {
                true => Ok(()),
                false => Err(NotReady { component: state.spec.name, missing, waited: started.elapsed() }),
            };
        }
    }
}

/// Closes the component, and waits until the peers that are running have taken all messages.
#[doc(hidden)]
pub async fn close<C: Component>(component: C, timeout: Duration) -> Result<(), NotFlushed> {
    let handle = component.handle().clone();
    drop(component);
    only_failures(handle.0.flush(Flush::Running, timeout).await)
}

#[doc(hidden)]
pub fn close_blocking<C: Component>(component: C, timeout: Duration) -> crate::Result<()> {
    let handle = component.handle().clone();
    handle.0.may_proceed()?;
    handle.0.may_close()?;
    drop(component);
    Ok(only_failures(handle.0.flush_blocking(Flush::Running, timeout))?)
}

/// Waits from a plain thread, as the blocking calls of gates do.
#[doc(hidden)]
pub fn block_on<C: Component, F: Future>(component: &C, future: F) -> Result<F::Output, BlockingError> {
    component.handle().0.block_on(future)
}

/// Returns the error if it [is a failure](NotFlushed::is_failure). Otherwise the peers were not running and could not
/// be waited for, so this logs a warning and returns `Ok`.
pub(crate) fn only_failures(flushed: Result<(), NotFlushed>) -> Result<(), NotFlushed> {
    match flushed {
        Err(error) if !error.is_failure() => {
            log::warn(&error.to_string());
            Ok(())
        }
        flushed => flushed,
    }
}
