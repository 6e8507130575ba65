//! The programs with their gates, in one process.

use arcade::arcade::{Action, Command, Inertial, Mode, Motors, Vector};
use arcade::autopilot::state;
use arcade::flight_loop::{self, Memory};
use arcade::simulation::{Settings, Simulation};
use arcade::{Autopilot, Simulator, simulator};
use std::thread;
use std::time::Duration;

fn reading(beat: u64) -> Inertial {
    let vector = |z| Some(Vector { z, ..Vector::default() });
    Inertial { time_us: beat * 3_333, acceleration: vector(9.81), rates: vector(0.0), angles: vector(0.0) }
}

#[tokio::test(start_paused = true)]
async fn the_simulator_sends_the_readings_of_the_simulation() -> scl::Result<()> {
    let (gates, mut peer) = Simulator::test().await?;
    let mut simulation = Simulation::new(&Settings::new(&gates.parameters));
    tokio::spawn(simulator::run(gates, None));
    for _ in 0..6 {
        assert_eq!(peer.imu.recv().await?, simulation.step().inertial);
    }
    assert_eq!(peer.world.recv().await?.time_us, 20_000);
    assert_eq!(peer.height.recv().await?.time_us, 50_000);
    assert_eq!(peer.battery.recv().await?.time_us, 100_000);
    Ok(())
}

#[tokio::test(start_paused = true)]
async fn the_simulator_obeys_set_points() -> scl::Result<()> {
    let (gates, mut peer) = Simulator::test().await?;
    tokio::spawn(simulator::run(gates, None));
    loop {
        peer.motors
            .send(&Motors { front_left: 0.9, front_right: 0.9, rear_left: 0.9, rear_right: 0.9, ..Motors::default() })
            .await?;
        if peer.world.recv().await?.position.is_some_and(|position| position.z > 1.0) {
            return Ok(());
        }
    }
}

#[test]
fn the_autopilot_answers_each_reading_with_set_points_and_a_beat() -> scl::Result<()> {
    let (gates, mut peer) = Autopilot::test_blocking()?;
    let _flying = thread::spawn(move || flight_loop::run(gates, Memory::default()));
    // 11 beats are a little longer than 1/30 s.
    for beat in 1..=11 {
        peer.imu.send_blocking(&reading(beat))?;
        assert_eq!(peer.motors.recv_blocking()?.time_us, reading(beat).time_us);
        assert_eq!(peer.beats.recv_blocking()?.time_us, reading(beat).time_us);
    }
    assert_eq!(peer.flight.recv_blocking()?.mode(), Mode::Grounded);
    Ok(())
}

#[test]
fn the_autopilot_refuses_commands_with_the_reason() -> scl::Result<()> {
    let (gates, mut peer) = Autopilot::test_blocking()?;
    let _flying = thread::spawn(move || flight_loop::run(gates, Memory::default()));
    let command = Command { id: 1, action: Action::TakeOff.into(), ..Command::default() };
    assert_eq!(peer.control.call_timeout(&command, Duration::from_secs(300))?.reason, "no inertial readings");
    Ok(())
}

#[test]
fn the_autopilot_carries_on_from_its_file() -> scl::Result<()> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("state");
    let mut aircraft = crate::aircraft::Aircraft::new(crate::aircraft::wind(1));
    aircraft.take_off(5.0);
    let saved = state::save(aircraft.autopilot());
    let (mut file, _) = arcade::autopilot::resume::StateFile::open(&path, state::COUNT)?;
    file.store(&saved)?;

    let (gates, mut peer) = Autopilot::test_blocking()?;
    let _flying = thread::spawn(move || flight_loop::run(gates, Memory::open(&path)));
    let time_us = aircraft.autopilot().time_us + 150_000;
    peer.imu.send_blocking(&Inertial { time_us, ..reading(1) })?;
    let flight = peer.flight.recv_blocking()?;
    assert_eq!((flight.mode(), flight.restarts), (Mode::Flying, 1));
    assert!(peer.motors.recv_blocking()?.front_left > 0.1);
    Ok(())
}
