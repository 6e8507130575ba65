//! Exploration.

use crate::aircraft::Aircraft;
use arcade::arcade::{Action, Mode};
use arcade::simulation::Settings;
use rand::{RngExt, SeedableRng};

#[test]
fn explore() {
    let mut a = Aircraft::new(Settings { seed: 3, ..Settings::default() });
    a.take_off(5.0);
    a.run(2.0);
    let mut sq = [0.0; 4];
    let (mut st, mut rs) = (0.0, 0.0);
    let mut last = [0.0; 4];
    for _ in 0..3000 {
        a.step();
        let p = a.autopilot.as_ref().unwrap();
        let m = a.simulation.world.motors.thrust;
        for i in 0..4 {
            sq[i] += (m[i] - last[i]).powi(2);
        }
        last = m;
        let t = a.truth.attitude.unwrap();
        let e = p.attitude.attitude.angles();
        st += (t.x - e.x).powi(2) + (t.y - e.y).powi(2);
        rs += a.simulation.world.body.rates.length_squared();
    }
    println!(
        "thrust step rms {:?} attitude error rms {:.5} rates rms {:.4}",
        sq.map(|s: f64| (s / 3000.0).sqrt()),
        (st / 3000f64).sqrt(),
        (rs / 3000.0f64).sqrt()
    );
    let p = a.autopilot.as_ref().unwrap();
    println!("{:?}\n{:?}\n{:?}\n{:?}", p.attitude, p.velocity_controller, p.rate_controller, p.position.bias);
}

#[test]
fn restarts() {
    for pause in [0.15, 0.3] {
        let mut steepest: Vec<f64> = Vec::new();
        for seed in 1..=20u64 {
            let mut rng = rand::rngs::StdRng::seed_from_u64(seed);
            let mut a = Aircraft::new(Settings { seed, ..Settings::default() });
            a.take_off(5.0);
            for target in [[15.0, 0.0, 5.0], [15.0, 15.0, 8.0], [0.0, 15.0, 7.0], [0.0, 0.0, 6.0]] {
                a.obey(Action::GoTo, target);
                for _ in 0..3 {
                    a.run(rng.random_range(0.0..2.5));
                    a.steepest = 0.0;
                    a.restart(pause);
                    a.run(1.0);
                    steepest.push(a.steepest.to_degrees());
                }
            }
            a.run(4.0);
            a.obey(Action::Land, [0.0; 3]);
            a.run_until("down", 30.0, |a| a.flight.mode() == Mode::Grounded);
        }
        steepest.sort_by(f64::total_cmp);
        println!(
            "pause {pause} n {} median {:.1} p90 {:.1} max {:.1}",
            steepest.len(),
            steepest[steepest.len() / 2],
            steepest[steepest.len() * 9 / 10],
            steepest[steepest.len() - 1]
        );
    }
}
