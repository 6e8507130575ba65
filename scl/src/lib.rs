//! Typed components and gates, wired by one checked YAML file, over ZeroMQ.
//!
//! A system is made of several programs. One YAML file, the topology, says which components exist, which gates they
//! have and which gates are connected. [`topology!`] checks that file while a program compiles and generates one struct
//! per component, with one field per gate; [`main`](macro@main) opens a component and runs a program with it.
//!
//! ```yaml
//! system: rover
//! schemas: [rover.proto]
//!
//! components:
//!   - name: sensor
//!     gates:
//!       - measurements: {pub: rover.Measurement}
//!       - log: {push: rover.Measurement}
//!   - name: controller
//!     gates:
//!       - sensor: {sub: rover.Measurement, queue: 1}
//!       - commands: {rep: rover.Command -> rover.Status}
//!   - name: recorder
//!     gates:
//!       - log: {pull: rover.Measurement}
//!   - name: user_interface
//!     gates:
//!       - commands: {req: rover.Command -> rover.Status, timeout: 500ms}
//!
//! connections:
//!   - [sensor.measurements, controller.sensor]
//!   - [sensor.log, recorder.log]
//!   - [user_interface.commands, controller.commands]
//! ```
//!
//! ```no_run
//! scl::topology!("doc/rover.yaml");
//!
//! #[scl::main]
//! async fn main(mut c: Controller) -> scl::Result<()> {
//!     let mut target_speed = 0.0;
//!     loop {
//!         tokio::select! {
//!             measured = c.sensor.recv() => println!("{} m/s too fast", measured?.speed - target_speed),
//!             command = c.commands.recv() => {
//!                 let command = command?;
//!                 target_speed = command.target_speed;
//!                 command.reply(&rover::Status { accepted: true })?;
//!             }
//!         }
//!     }
//! }
//! ```
//!
//! | gate | async | from a plain thread | without waiting |
//! |---|---|---|---|
//! | [`Pub`], [`Push`] | `send` | `send_blocking`, `send_timeout` | `try_send`, `loan` |
//! | [`Sub`], [`Pull`] | `recv` | `recv_blocking`, `recv_timeout` | `try_recv`, `latest` |
//! | [`Req`] | `call`, `call_within` | `call_blocking`, `call_timeout` | |
//! | [`Rep`] | `recv`, then [`Request::reply`] | `recv_blocking`, `recv_timeout` | `try_recv` |
//!
//! Large messages of fixed layout (`codec: raw`) are written in place with [`Pub::loan`] and read in place with
//! [`Sub::recv_view`]: then they are never copied on a transport with shared memory.
//!
//! [`ReceivingGate::poll_ready`] tells whether a gate has a message or request without taking it; [`untyped`] waits for
//! several gates at once and has a file descriptor for event loops.
//!
//! Programs may start in any order, restart, and be killed: messages wait in the sending program, up to the receiving
//! gate's `queue`, and connections come back by themselves.
//!
//! # Where programs meet
//!
//! Programs meet in the runtime folder, see [`runtime_dir`], under names that the topology fixes. They speak plain
//! ZeroMQ there, so a program in any language can take a component's place.
//!
//! # Features
//!
//! | feature | what it adds |
//! |---|---|
//! | `protobuf` (default) | the codec, and `schemas:` |
//! | `json`, `raw` (default), and others | a codec each, see [`codec`] |
//! | `zeromq` (default) | the transport between programs |
//! | `shm` | shared memory for long messages between programs on it, see [`TransportKind::Shm`] |
//! | `memory` (default) | the transport within a program, for unit tests of components |
//! | `logging` (default) | [`main`](macro@main) logs to standard error, unless the program has a log of its own; `events` sends what is logged to a gate |
//! | `nightly` | the macro's problems shown in the YAML file itself; needs a nightly compiler |
//! | `conformance` | the tests that transports and codecs are put to, for those of your own |
#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::unwrap_used))]

#[cfg(feature = "zeromq")]
#[doc(hidden)]
pub mod bridge;
mod causes;
pub mod codec;
mod component;
#[cfg(feature = "conformance")]
pub mod conformance;
mod environment;
mod error;
#[cfg(feature = "logging")]
pub mod events;
#[doc(hidden)]
pub mod examine;
mod figures;
mod gate;
pub mod host;
mod intern;
mod log;
mod named_type;
#[cfg(feature = "zeromq")]
mod observation;
mod options;
pub mod parameters;
#[doc(hidden)]
pub mod private;
mod registration;
pub mod registry;
pub mod runtime_dir;
mod senders;
mod service;
mod set_variable;
pub mod spec;
mod state;
mod stderr_log;
mod stop;
mod sync;
#[cfg(feature = "zeromq")]
pub mod tap;
mod tap_meta;
pub mod time;
pub mod transport;
mod transport_choice;
mod transport_kind;
pub mod untyped;
mod values;

pub use bytes;
pub use component::Component;
pub use error::{
    BlockingError, CallError, Error, GateName, LoanError, MissingGuarantee, MissingPeer, NotFlushed, NotReady,
    OpenError, PeerName, Peers, RecvError, RecvTimeoutError, ReplyError, Result, SendError, SendTimeoutError, SetError,
    TrySendError, Unflushed,
};
#[cfg(feature = "raw")]
pub use gate::View;
pub use gate::{AnyGate, GateStats, Loaned, PeerStats, Pub, Pull, Push, ReceivingGate, Rep, Req, Request, Sub};
pub use options::OpenOptions;
pub use parameters::Live;
pub use scl_macros::main;
pub use scl_plan as plan;
pub use senders::Senders;
pub use stop::{is_stop_requested, stop_requested, stop_requested_blocking};
pub use transport_choice::{TransportChoice, TransportChoiceError};
pub use transport_kind::TransportKind;

/// Turns a topology file into one struct for each of its components or kinds, with a field for each gate.
///
/// ```no_run
/// scl::topology!("doc/rover.yaml", only = [sensor, recorder]);
/// # fn main() {}
/// ```
///
/// The file is looked for beside the calling source file, then in the package root, then in the workspace root. Cargo
/// rebuilds when it or a schema that it names changes. With `schemas:` in the file, each protobuf package becomes a
/// module with its messages.
///
/// A struct has the functions `open`, `open_blocking`, `ready` and `close`. In unit tests, `Component::test()` returns
/// it together with the other ends of all its gates.
///
/// `only = [..]` generates only the listed components, which keeps builds short in a system of hundreds. `max_size =
/// "8MiB"` allows a file of more than 1 MiB. `testable = true` is for a library that holds the topology of programs in
/// other crates: `Component::test()` then exists for their tests too.
///
/// # Kinds
/// All components of a kind become one struct, and an enum names them, so that one program can run each of them:
///
/// ```no_run
/// scl::topology!("doc/motors.yaml");
///
/// #[scl::main]
/// async fn main(mut motor: Motor) -> scl::Result<()> {
///     let reversed = motor.instance() == MotorInstance::RightMotor;
///     loop {
///         let setpoint = motor.setpoint.recv().await?;
///         motor.state.send(&if reversed { -setpoint } else { setpoint }).await?;
///     }
/// }
/// ```
///
/// `open` and `#[scl::main]` open the component that the program was started as: `scl run` and the unit files of
/// `scl deploy systemd` say so in the variable `SCL_COMPONENT`, by hand it is `SCL_COMPONENT=left_motor ./motor`.
/// A program that runs several of them opens each with `Motor::open_as(MotorInstance::LeftMotor)`. `Motor::test()`
/// returns the first of them.
///
/// # Parameters
/// A component with `parameters` has a field `parameters`, a struct with a field for each. Those that can be changed
/// while the program runs (`live: true`) are [`Live`] values. [`OpenOptions::set`] gives values, as `scl run --set` and
/// the environment do.
///
/// # Types
/// A type whose first part is a package of the `schemas` is one of their messages; any other is a Rust path, looked up
/// where the macro is called. A program needs only the Rust types of the components that it opens.
///
/// # Errors
/// Every mistake in the file becomes a compile error that shows its place there and what to write instead, all at once.
/// `scl explain CODE` explains each in more detail.
#[macro_export]
macro_rules! topology {
    ($($input:tt)*) => {
        $crate::private::__topology! { $crate, $($input)* }
    };
}
