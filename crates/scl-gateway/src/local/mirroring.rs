//! Mirrors one component of another host in the runtime folder of this host while it runs there.

use crate::slot::Slot;
use bytes::Bytes;
use scl::bridge::{Mirror, Profile};
use scl::host::text_with_causes;
use scl::runtime_dir::SystemDir;
use std::time::Duration;
use tokio::sync::mpsc::UnboundedReceiver;

/// Delay between attempts to mirror a component that also runs on this host, or while the runtime folder cannot be
/// used.
const RETRY: Duration = Duration::from_secs(1);

/// An event about a component of another host.
#[derive(Debug)]
pub(crate) enum Remote {
    /// The component has started on `host`; `content` is its profile.
    Started { host: String, content: Bytes },
    /// The component has stopped, or its host is no longer connected.
    Stopped { host: String },
    /// Files of components of other hosts were removed from the runtime folder.
    Removed,
}

/// Mirrors the runs of a component, one after the other.
pub(crate) async fn mirror(
    dir: SystemDir,
    component: String,
    mut remote: UnboundedReceiver<Remote>,
    mut slot: Slot<Mirror>,
) {
    let mut wanted: Option<(String, Profile)> = None;
    let mut failure = None;
    loop {
        let waits = wanted.is_some() && slot.is_empty();
        let next = tokio::select! {
            next = remote.recv() => next,
            () = tokio::time::sleep(RETRY), if waits => {
                show(&dir, &component, wanted.as_ref(), &mut slot, &mut failure);
                continue;
            }
        };
        match next {
            None => return,
            Some(Remote::Started { host, content }) => {
                slot.clear().await;
                tracing::info!("component `{component}` has started on host `{host}`");
                wanted = match Profile::from_bytes(content) {
                    Ok(profile) => Some((host, profile)),
                    Err(error) => {
                        tracing::error!(host, "cannot mirror component `{component}` here: {error}");
                        None
                    }
                };
                failure = None;
                show(&dir, &component, wanted.as_ref(), &mut slot, &mut failure);
            }
            Some(Remote::Removed) => restore(&component, &slot),
            Some(Remote::Stopped { host }) => {
                if wanted.take().is_some() {
                    tracing::info!(
                        "component `{component}` has stopped on host `{host}`, or that host is not connected"
                    );
                }
                slot.clear().await;
            }
        }
    }
}

fn restore(component: &str, slot: &Slot<Mirror>) {
    if let Some(Err(error)) = slot.view().borrow().as_ref().map(|mirror| mirror.restore()) {
        tracing::error!("cannot restore the mirror of component `{component}`: {}", text_with_causes(&error));
    }
}

/// Tries to mirror the component. A failure is logged if it differs from the last one.
fn show(
    dir: &SystemDir,
    component: &str,
    wanted: Option<&(String, Profile)>,
    slot: &mut Slot<Mirror>,
    failure: &mut Option<String>,
) {
    let Some((host, profile)) = wanted else { return };
    match Mirror::open(dir, component, host, profile) {
        Ok(mirror) => slot.put(mirror),
        Err(error) => {
            let text = text_with_causes(&error);
            if failure.as_ref() != Some(&text) {
                tracing::error!("cannot mirror component `{component}` of host `{host}` here: {text}");
                *failure = Some(text);
            }
        }
    }
}
