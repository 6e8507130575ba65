//! Components: what `topology!` generates one struct a component for.

mod blocking;
mod core;
mod main;
mod opener;
mod options;
mod realtime;
mod site;

pub use self::core::Core;
pub use main::{Outcome, run_async, run_blocking};
pub use opener::{Idle, Opener};
pub use options::OpenOptions;

use crate::error::{NotFlushed, NotReady, OpenError};
use crate::gate::AnyGate;
use crate::spec::ComponentSpec;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How often the peers are looked at while a component waits for them.
const LOOK: Duration = Duration::from_millis(2);

/// A component of a topology. `topology!` implements it; its methods are also there as inherent ones.
pub trait Component: Sized + Send + 'static {
    /// What the topology says about the component.
    const SPEC: &'static ComponentSpec;

    #[doc(hidden)]
    fn assemble(opener: &mut Opener) -> Result<Self, OpenError>;

    /// Its gates, in file order.
    fn gates(&self) -> Vec<&dyn AnyGate>;
}

/// Opens a component on the tokio runtime of the caller.
#[doc(hidden)]
pub async fn open<C: Component>(options: OpenOptions) -> Result<C, OpenError> {
    if tokio::runtime::Handle::try_current().is_err() {
        return Err(OpenError::NoRuntime { component: C::SPEC.name });
    }
    Opener::begin(C::SPEC, options, None)?.finish::<C>()
}

/// Opens a component for a program without async.
#[doc(hidden)]
pub fn open_blocking<C: Component>(options: OpenOptions) -> Result<C, OpenError> {
    let runtime = blocking::OwnedRuntime::start(C::SPEC.name)?;
    let _entered = runtime.enter();
    Opener::begin(C::SPEC, options, Some(Arc::clone(&runtime)))?.finish::<C>()
}

/// Waits until all required peers are connected.
#[doc(hidden)]
pub async fn ready<C: Component>(component: &C, timeout: Duration) -> Result<(), NotReady> {
    let started = Instant::now();
    loop {
        let missing = missing(component);
        if missing.is_empty() {
            return Ok(());
        }
        if started.elapsed() >= timeout {
            return Err(NotReady { component: C::SPEC.name, missing, waited: started.elapsed() });
        }
        tokio::time::sleep(LOOK.min(timeout)).await;
    }
}

fn missing<C: Component>(component: &C) -> Vec<(&'static str, String)> {
    let gates = component.gates();
    let missing = gates.iter().flat_map(|gate| gate.missing().into_iter().map(|link| (gate.spec().name, link)));
    missing.map(|(gate, link)| (gate, format!("{}.{}", link.peer_component, link.peer_gate))).collect()
}

/// Hands over what connected peers still take, then closes.
#[doc(hidden)]
pub async fn close<C: Component>(component: C, timeout: Duration) -> Result<(), NotFlushed> {
    let core = component.gates().first().map(|gate| Arc::clone(gate.core()));
    drop(component);
    match core {
        Some(core) => core.flush(timeout).await,
        None => Ok(()),
    }
}

#[doc(hidden)]
pub fn close_blocking<C: Component>(component: C, timeout: Duration) -> crate::Result<()> {
    let core = component.gates().first().map(|gate| Arc::clone(gate.core()));
    match core {
        Some(core) => Ok(core.block_on(close(component, timeout))??),
        None => Ok(()),
    }
}

#[doc(hidden)]
pub fn block_on<C: Component, F: Future>(component: &C, future: F) -> Result<F::Output, crate::error::BlockingError> {
    match component.gates().first() {
        Some(gate) => gate.core().block_on(future),
        None => Err(crate::error::BlockingError::InsideAsync),
    }
}

/// The methods of a generated struct, in one place for their documentation.
#[doc(hidden)]
#[macro_export]
macro_rules! __component_methods {
    ($component:ident) => {
        impl $component {
            /// Opens the component on the tokio runtime of the caller: takes the component's name for this program,
            /// makes its gates, and announces it. Its peers connect by themselves, in whatever order they start.
            ///
            /// # Errors
            /// Another program plays this component, or the runtime folder cannot be used; the text says which.
            pub async fn open() -> ::core::result::Result<Self, $crate::OpenError> {
                $crate::private::open(::core::default::Default::default()).await
            }

            /// `open` with other choices than the environment's.
            ///
            /// # Errors
            /// Those of `open`.
            pub async fn open_with(options: $crate::OpenOptions) -> ::core::result::Result<Self, $crate::OpenError> {
                $crate::private::open(options).await
            }

            /// Opens the component for a program without async, whose gates then are used through their blocking and
            /// non-waiting calls.
            ///
            /// # Errors
            /// Those of `open`.
            pub fn open_blocking() -> ::core::result::Result<Self, $crate::OpenError> {
                $crate::private::open_blocking(::core::default::Default::default())
            }

            /// `open_blocking` with other choices than the environment's.
            ///
            /// # Errors
            /// Those of `open`.
            pub fn open_blocking_with(options: $crate::OpenOptions) -> ::core::result::Result<Self, $crate::OpenError> {
                $crate::private::open_blocking(options)
            }

            /// Waits until all required peers are connected. Gates that listen for any number of peers (`rep`, `pull`)
            /// have nobody to wait for.
            ///
            /// # Errors
            /// The peers that are missing after `timeout`.
            ///
            /// # Cancel safety
            /// Cancel safe.
            pub async fn ready(&self, timeout: ::core::time::Duration) -> ::core::result::Result<(), $crate::NotReady> {
                $crate::private::ready(self, timeout).await
            }

            /// `ready` from a program without async.
            ///
            /// # Errors
            /// Those of `ready`, or that the call could not wait.
            pub fn ready_blocking(&self, timeout: ::core::time::Duration) -> $crate::Result<()> {
                ::core::result::Result::Ok($crate::private::block_on(self, self.ready(timeout))??)
            }

            /// Hands over what connected peers have not taken yet, then closes. Dropping the component hands over only
            /// what they take at once.
            ///
            /// # Errors
            /// How many messages were left after `timeout`.
            pub async fn close(
                self,
                timeout: ::core::time::Duration,
            ) -> ::core::result::Result<(), $crate::NotFlushed> {
                $crate::private::close(self, timeout).await
            }

            /// `close` from a program without async. Messages that are pushed or answered are written before the call that
            /// gives them returns, so only what waits for a slow peer is left to hand over.
            ///
            /// # Errors
            /// Those of `close`, or that the call could not wait.
            pub fn close_blocking(self, timeout: ::core::time::Duration) -> $crate::Result<()> {
                $crate::private::close_blocking(self, timeout)
            }

            #[doc(hidden)]
            pub fn __scl_main_async<F, R>(main: fn(Self) -> F) -> ::std::process::ExitCode
            where
                F: ::core::future::Future<Output = R>,
                R: $crate::private::Outcome,
            {
                $crate::private::run_async(main)
            }

            #[doc(hidden)]
            pub fn __scl_main_blocking<R: $crate::private::Outcome>(main: fn(Self) -> R) -> ::std::process::ExitCode {
                $crate::private::run_blocking(main)
            }
        }
    };
}

/// Without the transport within a process there is nothing to test components on.
#[cfg(not(feature = "memory"))]
#[doc(hidden)]
#[macro_export]
macro_rules! __component_test_methods {
    ($component:ident, $peer:ident) => {};
}

/// What a component gets for the unit tests of the crate that it is generated in.
#[cfg(feature = "memory")]
#[doc(hidden)]
#[macro_export]
macro_rules! __component_test_methods {
    ($component:ident, $peer:ident) => {
        impl $component {
            /// Opens the component for a unit test, together with the other ends of all its gates: no processes, no
            /// sockets, no files, nothing to wait for.
            ///
            /// # Errors
            /// None that a test could meet but the lack of a tokio runtime.
            pub async fn test() -> ::core::result::Result<(Self, $peer), $crate::OpenError> {
                let place = $crate::private::Memory::new();
                let component = $crate::private::open($crate::OpenOptions::new().transport(place.clone())).await?;
                let peer = $crate::private::open($crate::OpenOptions::new().transport(place)).await?;
                ::core::result::Result::Ok((component, peer))
            }

            /// `test` for a component without async.
            ///
            /// # Errors
            /// The operating system gives no runtime.
            pub fn test_blocking() -> ::core::result::Result<(Self, $peer), $crate::OpenError> {
                let place = $crate::private::Memory::new();
                let component = $crate::private::open_blocking($crate::OpenOptions::new().transport(place.clone()))?;
                let peer = $crate::private::open_blocking($crate::OpenOptions::new().transport(place))?;
                ::core::result::Result::Ok((component, peer))
            }
        }
    };
}
