//! What the chassis does. It is apart from the program so that a test can run it, too.

use std::collections::HashSet;
use std::time::Duration;

use scl::{Live, Pub, Sub};
use tracing::{info, warn};

use crate::WheelInstance;
use crate::rover::{Setpoint, WheelState};

/// Drives at the speed that is set, in m/s, while all wheels report, and stops them when one does not.
pub async fn run(
    mut setpoints: Pub<Setpoint>,
    mut states: Sub<WheelState, WheelInstance>,
    speed: Live<f64>,
) -> scl::Result<()> {
    let mut tick = scl::time::interval(Duration::from_millis(50))?;
    let mut reports = Reports::default();
    loop {
        tokio::select! {
            missed = states.deadline_missed() => {
                missed?;
                if reports.begin_again() {
                    warn!("stops: a wheel does not report");
                }
            }
            state = states.recv_from() => {
                let (wheel, _state) = state?;
                if reports.add(wheel) {
                    info!("drives: all wheels report");
                }
            }
            ticked = tick.tick() => {
                ticked?;
                let speed = if reports.are_complete() { speed.get() } else { 0.0 };
                setpoints.send(&Setpoint { speed }).await?;
            }
        }
    }
}

/// The wheels that have reported since one was missing.
#[derive(Debug, Default)]
pub struct Reports(HashSet<WheelInstance>);

impl Reports {
    /// Returns true if this wheel is the last one that reports.
    pub fn add(&mut self, wheel: WheelInstance) -> bool {
        self.0.insert(wheel) && self.are_complete()
    }

    pub fn are_complete(&self) -> bool {
        self.0.len() == WheelInstance::ALL.len()
    }

    /// From now on, all wheels have to report again. Returns true if all had.
    pub fn begin_again(&mut self) -> bool {
        let were_complete = self.are_complete();
        self.0.clear();
        were_complete
    }
}
