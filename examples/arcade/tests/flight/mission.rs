//! Exploration.

use crate::aircraft::Aircraft;
use arcade::arcade::{Action, Mode};
use arcade::simulation::Settings;

#[test]
fn explore() {
    for seed in 1..=6 {
        let mut a = Aircraft::new(Settings { seed, ..Settings::default() });
        a.take_off(5.0);
        let mut worst: f64 = 0.0;
        a.run(2.0);
        for _ in 0..10 * 300 {
            a.step();
            worst = worst.max((a.truth.position.unwrap().z - 5.0).abs());
        }
        println!("seed {seed} hover height error {worst:.3} horizontal {:?} t {}", a.truth.position, a.truth.time_us);
        for target in [[15.0, 0.0, 5.0], [15.0, 15.0, 8.0], [0.0, 15.0, 7.0], [0.0, 0.0, 6.0]] {
            a.obey(Action::GoTo, target);
            let start = a.truth.time_us;
            let mut within = 0;
            let mut limit = 30 * 300;
            while within < 300 {
                limit -= 1;
                assert!(limit > 0, "{:?} {:?}", a.flight, a.truth);
                a.step();
                within = if a.estimated_distance_to(target) < 0.4 { within + 1 } else { 0 };
            }
            println!(
                "  {target:?} after {:.1} s distance {:.2} est {:.2} {:?} steepest {:.1}",
                (a.truth.time_us - start) as f64 * 1e-6,
                a.distance_to(target),
                a.estimated_distance_to(target),
                a.truth.position.unwrap(),
                a.steepest.to_degrees()
            );
        }
        a.obey(Action::Land, [0.0; 3]);
        let start = a.truth.time_us;
        a.run_until("down", 30.0, |a| a.flight.mode() == Mode::Grounded);
        println!(
            "  landed after {:.1} s {:?} steepest {:.1} t {:.1}",
            (a.truth.time_us - start) as f64 * 1e-6,
            a.truth.position.unwrap(),
            a.steepest.to_degrees(),
            a.truth.time_us as f64 * 1e-6
        );
    }
}
