//! The loop that processes and gates close in the system: readings to the autopilot, set-points to the motors.

use arcade::arcade::{Action, Command, CommandResult, Fix, Flight, Height, Mode, Motors, Vector, World};
use arcade::autopilot::FlightController;
use arcade::autopilot::parameters::Parameters;
use arcade::autopilot::state;
use arcade::sensors::gps::Receiver;
use arcade::sensors::truth;
use arcade::simulation::{RATE, Settings, Simulation};

/// A fix every 60 readings.
const FIX_PERIOD: u64 = 60;

/// World, autopilot and GPS receiver, and what a test wants to know of the flight.
pub(crate) struct Aircraft {
    pub(crate) simulation: Simulation,
    /// None while the autopilot is killed.
    autopilot: Option<FlightController>,
    receiver: Receiver,
    pub(crate) fixes: bool,
    /// Messages arrive this many beats late.
    pub(crate) latency: u64,
    heights: Vec<(u64, Height)>,
    fix_messages: Vec<(u64, Fix)>,
    pub(crate) flight: Flight,
    /// All set-points so far.
    pub(crate) motors: Vec<Motors>,
    pub(crate) truth: World,
    steps: u64,
    next_id: u32,
    /// The largest roll or pitch so far, rad.
    pub(crate) steepest: f64,
}

impl Aircraft {
    pub(crate) fn new(settings: Settings) -> Self {
        let simulation = Simulation::new(&settings);
        Self {
            truth: truth(0, &simulation.world),
            simulation,
            autopilot: Some(FlightController::new(Parameters::defaults())),
            receiver: Receiver::new(settings.seed),
            fixes: true,
            latency: 0,
            heights: Vec::new(),
            fix_messages: Vec::new(),
            flight: Flight::default(),
            motors: Vec::new(),
            steps: 0,
            next_id: 100,
            steepest: 0.0,
        }
    }

    /// One beat.
    pub(crate) fn step(&mut self) {
        let readings = self.simulation.step();
        self.steps += 1;
        self.truth = truth(readings.inertial.time_us, &self.simulation.world);
        let attitude = self.truth.attitude.unwrap_or_default();
        self.steepest = self.steepest.max(attitude.x.abs()).max(attitude.y.abs());
        if let Some(height) = readings.height {
            self.heights.push((self.steps + self.latency, height));
        }
        if self.steps.is_multiple_of(FIX_PERIOD) {
            let fix = self.receiver.measure(&self.truth, Parameters::defaults().limits.home());
            if self.fixes {
                self.fix_messages.push((self.steps + self.latency, fix));
            }
        }
        let Some(autopilot) = &mut self.autopilot else { return };
        let steps = self.steps;
        for (_, height) in self.heights.extract_if(.., |(due, _)| *due <= steps) {
            autopilot.receive_height(&height);
        }
        for (_, fix) in self.fix_messages.extract_if(.., |(due, _)| *due <= steps) {
            autopilot.receive_fix(&fix);
        }
        let outputs = autopilot.step(&readings.inertial).expect("each reading is newer");
        self.simulation.receive(&outputs.motors);
        self.motors.push(outputs.motors);
        if let Some(flight) = outputs.flight {
            self.flight = flight;
        }
    }

    pub(crate) fn run(&mut self, seconds: f64) {
        (0..(seconds * f64::from(RATE)) as u64).for_each(|_| self.step());
    }

    /// Runs until a condition holds. Fails after `seconds`.
    pub(crate) fn run_until(&mut self, what: &str, seconds: f64, mut holds: impl FnMut(&Self) -> bool) {
        for _ in 0..(seconds * f64::from(RATE)) as u64 {
            self.step();
            if holds(self) {
                return;
            }
        }
        panic!("not {what} after {seconds} s: {:?}, {:?}", self.flight, self.truth);
    }

    pub(crate) fn autopilot(&self) -> &FlightController {
        self.autopilot.as_ref().expect("a running autopilot")
    }

    /// Sends a command that takes effect in 100 ms.
    pub(crate) fn command(&mut self, action: Action, [x, y, z]: [f64; 3]) -> CommandResult {
        self.send(Command { action: action.into(), target: Some(Vector { x, y, z }), ..Command::default() })
    }

    fn send(&mut self, command: Command) -> CommandResult {
        self.next_id += 1;
        let effective_us = self.truth.time_us + 100_000;
        let autopilot = self.autopilot.as_mut().expect("a running autopilot");
        autopilot.receive_command(&Command { id: self.next_id, effective_us, ..command })
    }

    /// Sends a command that must be accepted, and runs until it is in effect.
    pub(crate) fn obey(&mut self, action: Action, target: [f64; 3]) {
        let result = self.command(action, target);
        self.await_effect(&result);
    }

    /// Starts for a point.
    pub(crate) fn go_to(&mut self, [x, y, z]: [f64; 3], yaw: f64, speed: f64) {
        let target = Some(Vector { x, y, z });
        let result = self.send(Command { action: Action::GoTo.into(), target, yaw, speed, ..Command::default() });
        self.await_effect(&result);
    }

    /// Flies to a point and stays there for a second.
    pub(crate) fn fly_to(&mut self, target: [f64; 3]) {
        self.obey(Action::GoTo, target);
        self.reach(target);
    }

    /// Waits as a mission does: until the estimate has been close to the target for a second.
    pub(crate) fn reach(&mut self, target: [f64; 3]) {
        let mut close = 0;
        self.run_until("there", 30.0, |aircraft| {
            close = if aircraft.estimated_distance_to(target) < 0.4 { close + 1 } else { 0 };
            close > RATE
        });
    }

    /// Lands from where it is.
    pub(crate) fn land(&mut self) {
        self.obey(Action::Land, [0.0; 3]);
        self.run_until("down", 30.0, |aircraft| aircraft.flight.mode() == Mode::Grounded);
        self.run(1.0);
    }

    fn await_effect(&mut self, result: &CommandResult) {
        assert!(result.accepted, "{}", result.reason);
        let id = self.next_id;
        self.run_until("in effect", 0.3, |aircraft| aircraft.flight.command_id == id);
    }

    /// Takes off from the ground after the first fixes.
    pub(crate) fn take_off(&mut self, height: f64) {
        self.run(2.0);
        self.obey(Action::TakeOff, [0.0, 0.0, height]);
        self.run_until("flying", 15.0, |aircraft| aircraft.flight.mode() == Mode::Flying);
    }

    pub(crate) fn kill(&mut self) {
        self.autopilot = None;
    }

    /// Kills the autopilot and starts it again from its state `seconds` later.
    pub(crate) fn restart(&mut self, seconds: f64) {
        let saved = state::save(self.autopilot());
        self.kill();
        self.run(seconds);
        let restored = state::restore(&saved, Parameters::defaults()).expect("a state");
        self.autopilot = Some(restored.resumed(self.truth.time_us).expect("a recent state"));
    }

    /// The true distance to a point.
    pub(crate) fn distance_to(&self, [x, y, z]: [f64; 3]) -> f64 {
        let position = self.truth.position.unwrap_or_default();
        ((position.x - x).powi(2) + (position.y - y).powi(2) + (position.z - z).powi(2)).sqrt()
    }

    /// The estimated distance to a point, by which a mission decides.
    pub(crate) fn estimated_distance_to(&self, [x, y, z]: [f64; 3]) -> f64 {
        let position = self.flight.position.unwrap_or_default();
        ((position.x - x).powi(2) + (position.y - y).powi(2) + (position.z - z).powi(2)).sqrt()
    }
}

/// The wind of the example.
pub(crate) fn wind(seed: u64) -> Settings {
    Settings { seed, ..Settings::defaults() }
}
