//! The figures of systems for Prometheus, and for what reads its text format: Grafana, OpenTelemetry collectors.

mod families;
mod text;

use crate::http::{Answer, plain, respond, serve};
use families::{COMPONENT, CONNECTION, Figure, GATE, STATES, Seen};
use http_body_util::{BodyExt, Full};
use hyper::body::Incoming;
use hyper::{Method, Request, StatusCode};
use scl_observe::System;
use std::future::ready;
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::SystemTime;
use text::{Kind, Labels, Text};
use tokio::net::TcpListener;

/// What Prometheus asks for.
const CONTENT_TYPE: &str = "text/plain; version=0.0.4; charset=utf-8";

/// A dashboard for Grafana that shows these figures, as JSON to import.
pub const DASHBOARD: &str = include_str!("metrics/dashboard.json");

/// A server of the figures of systems.
pub struct MetricsServer {
    listener: TcpListener,
    address: SocketAddr,
    system: Option<System>,
}

impl MetricsServer {
    /// Listens at an address, whose port may be 0. Without a system, all that run are shown, whenever they start.
    ///
    /// # Errors
    /// The address is in use or not allowed.
    pub async fn bind(address: SocketAddr, system: Option<System>) -> io::Result<Self> {
        let listener = TcpListener::bind(address).await?;
        let address = listener.local_addr()?;
        Ok(Self { listener, address, system })
    }

    /// The address of the figures.
    #[must_use]
    pub fn url(&self) -> String {
        format!("http://{}/metrics", self.address)
    }

    /// Serves the figures until the future is dropped. Must be called inside a tokio runtime, with which connections
    /// end.
    pub async fn serve(self) {
        let system = Arc::new(self.system);
        serve(&self.listener, move |request| ready(answer(&request, system.as_ref().as_ref()))).await;
    }
}

fn answer(request: &Request<Incoming>, system: Option<&System>) -> Answer {
    if request.uri().path() != "/metrics" {
        return plain(StatusCode::NOT_FOUND, "the figures are at /metrics\n");
    }
    if request.method() != Method::GET {
        return plain(StatusCode::METHOD_NOT_ALLOWED, "only GET is answered\n");
    }
    let systems = match system {
        Some(system) => vec![system.clone()],
        // None runs yet, or the folder of all systems is not there yet.
        None => System::find_all(None).unwrap_or_default(),
    };
    respond(StatusCode::OK, CONTENT_TYPE, Full::from(metrics(&systems)).boxed())
}

/// The figures of these systems now.
#[must_use]
pub fn metrics(systems: &[System]) -> String {
    let seen: Vec<Seen> = systems.iter().flat_map(Seen::all).collect();
    let now = SystemTime::now();
    let mut text = Text::default();
    let states = seen.iter().flat_map(|it| {
        let is = it.component.activity(now).word();
        STATES.map(|state| ([it.labels(), vec![("state", state.into())]].concat(), f64::from(state == is)))
    });
    text.family("scl_component_state", Kind::Gauge, "1 for the state that the component is in.", states);
    tell(&mut text, &COMPONENT, &seen.iter().map(|it| (it.labels(), it)).collect::<Vec<_>>());
    tell(&mut text, &GATE, &seen.iter().flat_map(Seen::gates).collect::<Vec<_>>());
    tell(&mut text, &CONNECTION, &seen.iter().flat_map(Seen::connections).collect::<Vec<_>>());
    text.finish()
}

/// Adds figures of things, each with its labels.
fn tell<T>(text: &mut Text, figures: &[Figure<T>], things: &[(Labels<'_>, &T)]) {
    for figure in figures {
        let samples = things.iter().filter_map(|(labels, it)| Some((labels.clone(), (figure.value)(it)?)));
        text.family(figure.name, figure.kind, figure.help, samples);
    }
}
