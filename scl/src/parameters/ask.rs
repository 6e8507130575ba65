//! Asking a running component to change its live parameters.

use super::wire;
use crate::runtime_dir::SystemDir;
use crate::time::Rounded;
use crate::transport::zeromq::ZeroMq;
use crate::transport::{Answer, Endpoint, Requester, Transport, TransportError};
use crate::transport_kind::TransportKind;
use std::future::poll_fn;
use std::time::Duration;
use thiserror::Error;

/// A running component was not asked, or did not do what it was asked for.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AskError {
    /// The component says why it refuses.
    #[error("{reason}")]
    Refused {
        /// Why.
        reason: String,
    },
    /// The component did not answer in time.
    #[error(
        "component `{component}` did not answer within {}: it hangs, does not run, or has no live parameters",
        Rounded(*waited)
    )]
    NoAnswer {
        /// The component.
        component: String,
        /// How long it was waited for.
        waited: Duration,
    },
    /// The answer is not one of SCL.
    #[error("something else than component `{component}` of SCL answers at its socket")]
    Foreign {
        /// The component.
        component: String,
    },
    /// The socket cannot be reached.
    #[error(transparent)]
    Transport(#[from] TransportError),
}

/// Asks a component to change live parameters, given by name with values as texts like in the topology file: all of
/// them change, or none.
///
/// ```no_run
/// # async fn example(system: scl::runtime_dir::SystemDir) -> Result<(), scl::parameters::AskError> {
/// use std::time::Duration;
/// scl::parameters::ask_to_set(&system, "controller", [("gain", "2")], Duration::from_secs(5)).await?;
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`AskError::Refused`]: the component does not have such a live parameter, or it cannot have the value;
/// [`AskError::NoAnswer`] after `timeout`: it hangs, does not run, or has no live parameters. One that hangs may still
/// set the values later.
///
/// # Cancel safety
/// The values may be set or not.
///
/// # Panics
/// If called outside of a tokio runtime with I/O and time. Any flavour will do.
pub async fn ask_to_set<'v>(
    dir: &SystemDir,
    component: &str,
    values: impl IntoIterator<Item = (&'v str, &'v str)>,
    timeout: Duration,
) -> Result<(), AskError> {
    let mut requester = ZeroMq::new(dir.clone(), TransportKind::Ipc)
        .request(&Endpoint::accepting(wire::socket(component), wire::LIMIT))?;
    let foreign = || AskError::Foreign { component: component.to_owned() };
    let asked = tokio::time::timeout(timeout, exchange(&mut *requester, wire::request(values))).await;
    let no_answer = |_| AskError::NoAnswer { component: component.to_owned(), waited: timeout };
    match wire::read_answer(&asked.map_err(no_answer)?.ok_or_else(foreign)?).ok_or_else(foreign)? {
        Ok(()) => Ok(()),
        Err(reason) => Err(AskError::Refused { reason }),
    }
}

/// Sends a request and waits for its answer, again if the connection breaks: setting a value twice does no harm.
/// `None` if the request is refused as none.
async fn exchange(requester: &mut dyn Requester, request: bytes::Bytes) -> Option<bytes::Bytes> {
    for id in 1.. {
        poll_fn(|cx| requester.poll_connected(cx)).await;
        if poll_fn(|cx| std::task::Poll::Ready(requester.request(cx, id, request.clone()))).await.is_err() {
            continue;
        }
        match poll_fn(|cx| requester.poll_answer(cx)).await {
            Answer::Reply { body, .. } => return Some(body),
            Answer::Refused { .. } => return None,
            _ => {}
        }
    }
    None
}
