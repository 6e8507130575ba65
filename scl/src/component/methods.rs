//! The methods of generated structs, in macros, so that their documentation is in one place.

/// The methods of a generated struct.
#[doc(hidden)]
#[macro_export]
macro_rules! __component_methods {
    // After the name: the bounds of the functions that open the component.
    ($component:ident $($bounds:tt)*) => {
        impl $component {
            /// Opens the component on the tokio runtime of the caller, whatever its flavour: registers the component,
            /// announces it and opens its gates. Peers connect by themselves, in whatever order they start.
            ///
            /// # Errors
            /// Another process runs this component, or the runtime folder cannot be used; the text says which.
            ///
            /// # Cancel safety
            /// It never waits.
            pub async fn open() -> ::core::result::Result<Self, $crate::OpenError>
            $($bounds)*
            {
                $crate::private::open(::core::default::Default::default()).await
            }

            /// `open` with options other than the environment's.
            ///
            /// # Errors
            /// Those of `open`.
            pub async fn open_with(options: $crate::OpenOptions) -> ::core::result::Result<Self, $crate::OpenError>
            $($bounds)*
            {
                $crate::private::open(options).await
            }

            /// Opens the component for a program without async, which uses the blocking and the non-waiting calls of
            /// its gates, from as many threads as it likes.
            ///
            /// # Errors
            /// Those of `open`.
            pub fn open_blocking() -> ::core::result::Result<Self, $crate::OpenError>
            $($bounds)*
            {
                $crate::private::open_blocking(::core::default::Default::default())
            }

            /// `open_blocking` with options other than the environment's.
            ///
            /// # Errors
            /// Those of `open`.
            pub fn open_blocking_with(options: $crate::OpenOptions) -> ::core::result::Result<Self, $crate::OpenError>
            $($bounds)*
            {
                $crate::private::open_blocking(options)
            }

            /// Waits until all required peers are connected. Gates that listen for any number of peers (`rep`, `pull`)
            /// have none to wait for.
            ///
            /// # Errors
            /// The peers that are missing after `timeout`, and why.
            ///
            /// # Cancel safety
            /// Cancel safe.
            pub async fn ready(&self, timeout: ::core::time::Duration) -> ::core::result::Result<(), $crate::NotReady> {
                $crate::private::ready(self, timeout).await
            }

            /// `ready` from a plain thread.
            ///
            /// # Errors
            /// Those of `ready`; inside async code or after a stop request, [`BlockingError`]($crate::BlockingError).
            pub fn ready_blocking(&self, timeout: ::core::time::Duration) -> $crate::Result<()> {
                ::core::result::Result::Ok($crate::private::block_on(self, self.ready(timeout))??)
            }

            /// Waits until every peer that is running has taken all messages, then closes. Peers that are running but
            /// not connected yet are waited for; one that is not running is named in a log line.
            ///
            /// Dropping the component hands over what is left, too, but waits no longer than a second, and only until
            /// it is written.
            ///
            /// # Errors
            /// The peers that have not taken everything after `timeout`, with the number of messages.
            ///
            /// # Cancel safety
            /// The component is closed in any case; what was not handed over is lost.
            pub async fn close(
                self,
                timeout: ::core::time::Duration,
            ) -> ::core::result::Result<(), $crate::NotFlushed> {
                $crate::private::close(self, timeout).await
            }

            /// `close` from a plain thread.
            ///
            /// # Errors
            /// Those of `close`; inside async code, [`BlockingError`]($crate::BlockingError), and the component is
            /// dropped.
            pub fn close_blocking(self, timeout: ::core::time::Duration) -> $crate::Result<()> {
                $crate::private::close_blocking(self, timeout)
            }
        }
    };
}

/// The methods that the struct of a kind has beside those of every component.
#[doc(hidden)]
#[macro_export]
macro_rules! __kind_methods {
    ($component:ident, $instance:ident $($bounds:tt)*) => {
        impl $component {
            /// `open` as a component of the kind. `open` takes the one that the program was started as, according to
            /// `$SCL_COMPONENT`.
            ///
            /// # Errors
            /// Those of `open`; the program was started as another component.
            ///
            /// # Cancel safety
            /// It never waits.
            pub async fn open_as(component: $instance) -> ::core::result::Result<Self, $crate::OpenError>
            $($bounds)*
            {
                $crate::private::open_as(component as usize, ::core::default::Default::default()).await
            }

            /// `open_as` with options other than the environment's.
            ///
            /// # Errors
            /// Those of `open_as`.
            pub async fn open_as_with(
                component: $instance,
                options: $crate::OpenOptions,
            ) -> ::core::result::Result<Self, $crate::OpenError>
            $($bounds)*
            {
                $crate::private::open_as(component as usize, options).await
            }

            /// `open_as` for a program without async.
            ///
            /// # Errors
            /// Those of `open_as`.
            pub fn open_blocking_as(component: $instance) -> ::core::result::Result<Self, $crate::OpenError>
            $($bounds)*
            {
                $crate::private::open_blocking_as(component as usize, ::core::default::Default::default())
            }

            /// `open_blocking_as` with options other than the environment's.
            ///
            /// # Errors
            /// Those of `open_as`.
            pub fn open_blocking_as_with(
                component: $instance,
                options: $crate::OpenOptions,
            ) -> ::core::result::Result<Self, $crate::OpenError>
            $($bounds)*
            {
                $crate::private::open_blocking_as(component as usize, options)
            }

            /// Returns which component of the kind it is.
            pub fn instance(&self) -> $instance {
                $instance::ALL[$crate::private::instance(self)]
            }
        }
    };
}

/// The functions that `#[scl::main]` calls. That macro has only the component's name, and cannot know the name under
/// which the program imports the crate `scl`.
#[doc(hidden)]
#[macro_export]
macro_rules! __component_main_functions {
    ($component:ident $($bounds:tt)*) => {
        impl $component {
            #[doc(hidden)]
            pub fn __scl_main_async<F: ::core::future::Future<Output = $crate::Result<()>>>(
                main: fn(Self) -> F,
            ) -> ::std::process::ExitCode
            $($bounds)*
            {
                $crate::private::run_async(main)
            }

            #[doc(hidden)]
            pub fn __scl_main_blocking(main: fn(Self) -> $crate::Result<()>) -> ::std::process::ExitCode
            $($bounds)*
            {
                $crate::private::run_blocking(main)
            }

            #[doc(hidden)]
            pub fn __scl_returned<R>(returned: &R) -> $crate::private::Returned<R> {
                $crate::private::Returned::of(returned)
            }
        }
    };
}

/// Without the in-process transport there is nothing to test components on.
#[cfg(not(feature = "memory"))]
#[doc(hidden)]
#[macro_export]
macro_rules! __component_test_methods {
    ($component:ident, $peer:ident $($bounds:tt)*) => {};
}

/// The functions for unit tests in the crate that calls `topology!`.
#[cfg(feature = "memory")]
#[doc(hidden)]
#[macro_export]
macro_rules! __component_test_methods {
    ($component:ident, $peer:ident $($bounds:tt)*) => {
        impl $component {
            /// Opens the component for a unit test, together with the other ends of all its gates, without processes,
            /// sockets or files.
            ///
            /// # Errors
            /// There is no tokio runtime.
            pub async fn test() -> ::core::result::Result<(Self, $peer), $crate::OpenError>
            $($bounds)*
            {
                Self::test_with(::core::default::Default::default()).await
            }

            /// `test` with values for parameters: `OpenOptions::new().set("controller.gain", "2")`. Of a kind, the
            /// first component is opened. Transports and folders in the options have no effect.
            ///
            /// # Errors
            /// A parameter has no value, or a wrong one; those of `test`.
            pub async fn test_with(
                options: $crate::OpenOptions,
            ) -> ::core::result::Result<(Self, $peer), $crate::OpenError>
            $($bounds)*
            {
                let transport = $crate::private::Memory::new();
                let component = $crate::private::open(options.for_test(transport.clone())).await?;
                let peer = $crate::private::open($crate::OpenOptions::new().for_test(transport)).await?;
                ::core::result::Result::Ok((component, peer))
            }

            /// `test` for a component without async.
            ///
            /// # Errors
            /// The operating system refuses a runtime.
            pub fn test_blocking() -> ::core::result::Result<(Self, $peer), $crate::OpenError>
            $($bounds)*
            {
                Self::test_blocking_with(::core::default::Default::default())
            }

            /// `test_with` for a component without async.
            ///
            /// # Errors
            /// Those of `test_with` and `test_blocking`.
            pub fn test_blocking_with(
                options: $crate::OpenOptions,
            ) -> ::core::result::Result<(Self, $peer), $crate::OpenError>
            $($bounds)*
            {
                let transport = $crate::private::Memory::new();
                let component = $crate::private::open_blocking(options.for_test(transport.clone()))?;
                let peer = $crate::private::open_blocking($crate::OpenOptions::new().for_test(transport))?;
                ::core::result::Result::Ok((component, peer))
            }
        }
    };
}
