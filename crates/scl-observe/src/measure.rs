//! Measuring gates: each gate has a meter, which receives the messages at its tap.

use crate::{Activity, Component, ObservedGate, System, Tap, Taps, TapsEvent};
use scl::tap::{Observation, TapEvent};
use std::time::SystemTime;

/// Collects figures of the messages of one gate.
pub trait Meter {
    /// The figures that it returns.
    type Figures;
    /// Counts a message, request or reply.
    fn observe(&mut self, seen: &Observation);
    /// The connection to the tap was interrupted: the time between the last message before and the first one after is
    /// not counted.
    fn interrupt(&mut self) {}
    /// The figures since the last call.
    fn take_interval(&mut self) -> Self::Figures;
    /// The figures since the measurement began.
    fn total(&self) -> Self::Figures;
}

/// Measures gates of a running system, each at a tap.
pub struct Measurement<M> {
    system: System,
    taps: Taps,
    new_meter: Box<dyn Fn() -> M>,
    gates: Vec<Measured<M>>,
    /// By gate number of `taps`, the index in `gates`: a gate that starts again with another type has a new number.
    index_of: Vec<usize>,
}

struct Measured<M> {
    tap: Tap,
    meter: M,
}

/// The figures of one gate.
#[derive(Debug, Clone, PartialEq)]
pub struct GateReport<F> {
    /// The gate, as `component.gate`.
    pub gate: String,
    /// The figures of its meter.
    pub figures: F,
    /// The state of its component, to explain a lack of messages: `not running`.
    pub state: String,
}

impl<M: Meter> Measurement<M> {
    /// Measures these gates; gates without a tap are measured at their peers' taps, see [`at_taps`]. Must be called
    /// inside a tokio runtime.
    pub fn of(system: &System, gates: &[ObservedGate], new_meter: impl Fn() -> M + 'static) -> Self {
        let gates = at_taps(gates);
        let taps = Taps::open(system, gates.clone());
        let mut measurement = Self::empty(system, taps, new_meter);
        gates.into_iter().for_each(|gate| measurement.add(gate));
        measurement
    }

    /// Measures all gates that have a tap, also those of components that start later. Must be called inside a tokio
    /// runtime.
    pub fn of_all(system: &System, new_meter: impl Fn() -> M + 'static) -> Self {
        let taps = Taps::follow_all(system, |_| true);
        Self::empty(system, taps, new_meter)
    }

    /// Measures forever.
    ///
    /// # Cancel safety
    /// Cancel safe: what was counted stays.
    pub async fn run(&mut self) {
        loop {
            match self.taps.next().await {
                TapsEvent::Started(gate) => self.add(gate),
                TapsEvent::Event { gate, event } => {
                    let Some(measured) = self.index_of.get(gate).and_then(|index| self.gates.get_mut(*index)) else {
                        continue;
                    };
                    match event {
                        // A latched message was sent before the measurement began.
                        TapEvent::Observed(seen) if seen.latched => {}
                        TapEvent::Observed(seen) => measured.meter.observe(&seen),
                        TapEvent::Connected | TapEvent::Disconnected => measured.meter.interrupt(),
                    }
                }
            }
        }
    }

    /// The figures of each gate since the last call.
    pub fn take_interval(&mut self) -> Vec<GateReport<M::Figures>> {
        let states = self.states();
        let figures = self.gates.iter_mut().map(|it| (&it.tap, it.meter.take_interval()));
        figures.zip(states).map(report).collect()
    }

    /// The figures of each gate since the measurement began.
    pub fn total(&self) -> Vec<GateReport<M::Figures>> {
        self.gates.iter().map(|it| (&it.tap, it.meter.total())).zip(self.states()).map(report).collect()
    }

    fn empty(system: &System, taps: Taps, new_meter: impl Fn() -> M + 'static) -> Self {
        let (system, new_meter) = (system.clone(), Box::new(new_meter));
        Self { system, taps, new_meter, gates: Vec::new(), index_of: Vec::new() }
    }

    /// Describes the state of each gate's component.
    fn states(&self) -> Vec<String> {
        let (components, now) = (self.system.components(), SystemTime::now());
        let component = |name: &str| components.iter().find(|component| component.name == name);
        self.gates.iter().map(|it| describe_state(component(&it.tap.component), now)).collect()
    }

    fn add(&mut self, gate: ObservedGate) {
        let is_known = |it: &Measured<M>| it.tap.component == gate.component && it.tap.gate == gate.gate;
        let index = self.gates.iter().position(is_known).unwrap_or_else(|| {
            let tap = Tap { component: gate.component, gate: gate.gate, socket: String::new() };
            self.gates.push(Measured { tap, meter: (self.new_meter)() });
            self.gates.len() - 1
        });
        self.index_of.push(index);
    }
}

/// Describes in a few words whether a component runs, hangs or waits for peers: `not running`.
fn describe_state(component: Option<&Component>, now: SystemTime) -> String {
    match component.map_or(Activity::Stopped, |component| component.activity(now)) {
        Activity::Hangs(silence) => format!("hangs since {} s", silence.as_secs()),
        Activity::Stopped => "not running".to_owned(),
        Activity::Dead => "killed or crashed".to_owned(),
        Activity::Running | Activity::Ready => "running".to_owned(),
        Activity::Waiting => "waiting for its peers".to_owned(),
    }
}

fn report<F>(((tap, figures), state): ((&Tap, F), String)) -> GateReport<F> {
    GateReport { gate: format!("{}.{}", tap.component, tap.gate), figures, state }
}

/// Replaces gates without a tap (`sub`, `req`, `push`) by the peers at whose taps their messages are seen. Each tap
/// occurs once.
pub fn at_taps(gates: &[ObservedGate]) -> Vec<ObservedGate> {
    let mut replaced: Vec<ObservedGate> = Vec::new();
    for gate in gates {
        for tap in &gate.taps {
            if replaced.iter().all(|known| known.taps[0] != *tap) {
                let (component, name) = (tap.component.clone(), tap.gate.clone());
                replaced.push(ObservedGate { component, gate: name, taps: vec![tap.clone()], ..gate.clone() });
            }
        }
    }
    replaced
}
