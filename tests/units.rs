//! The same system in other units is the same motion: nothing in the engine has a unit of its own.

mod common;

use common::run;
use dalembert::hybrid::{Method, Problem};
use dalembert::input::{Function, Signals, Sine};
use dalembert::kernel::MODELS;
use dalembert::model::InputKind;
use dalembert::record::Run;

/// Sizes of new units: one metre, kilogram and second are so many of them.
#[derive(Debug, Clone, Copy)]
struct Units {
    metre: f64,
    kilogram: f64,
    second: f64,
}

impl Units {
    /// Size of a unit of a model, such as `N s/m` or `kg m^2`.
    fn of(&self, unit: &str) -> f64 {
        let product = |text: &str| -> f64 {
            text.split_whitespace()
                .map(|part| self.factor(part))
                .product()
        };
        match unit.split_once('/') {
            Some((above, below)) => product(above) / product(below),
            None => product(unit),
        }
    }

    fn factor(&self, part: &str) -> f64 {
        let (name, power) = part
            .split_once('^')
            .map_or((part, 1), |(name, power)| (name, power.parse().unwrap()));
        let newton = self.kilogram * self.metre / (self.second * self.second);
        let size = match name {
            "1" | "rad" => 1.0,
            "m" => self.metre,
            "kg" => self.kilogram,
            "s" => self.second,
            "N" => newton,
            "J" => newton * self.metre,
            "Hz" => 1.0 / self.second,
            other => panic!("unit `{other}`"),
        };
        f64::powi(size, power)
    }
}

/// A tank that is shaken and released, as `scenes/tank_rocks_and_slides.json` and
/// `scenes/tank_full_plate.json` have it, in some units.
fn tank(units: Units, rocks: bool, method: Method) -> Problem {
    let model = MODELS.iter().find(|m| m.name == "walking_tank").unwrap();
    let mut tank = Problem::new(model);
    if rocks {
        tank.set_parameter("mu_s", 1.4).unwrap();
        tank.set_parameter("mu_k", 1.4).unwrap();
    }
    for (value, parameter) in tank.parameters.iter_mut().zip(model.parameters) {
        *value *= units.of(parameter.unit);
    }
    for (i, coordinate) in model.coordinates.iter().enumerate() {
        let size = units.of(coordinate.unit);
        for all in [&mut tank.initial.q, &mut tank.accuracy.q_absolute] {
            all[i] *= size;
        }
        for all in [&mut tank.initial.v, &mut tank.accuracy.v_absolute] {
            all[i] *= size / units.second;
        }
    }
    let functions = model.inputs.iter().map(|input| match input.kind {
        InputKind::Acceleration => {
            let amplitude = 20.0 * units.of("m/s^2");
            let frequency = 2.0 * std::f64::consts::PI * 7.0;
            Function::from(Sine::new(amplitude, frequency / units.second, 0.0))
        }
        InputKind::Value => Function::zero(),
    });
    tank.signals = Signals::new(model.inputs, functions.collect());
    tank.end.time = 0.5 * units.second;
    tank.method = method;
    tank
}

/// The largest relative difference of events and end of a run in some units to those of another in SI.
fn difference(run: &Run, units: Units, si: &Run) -> f64 {
    assert_eq!(run.events.len(), si.events.len());
    let model = MODELS.iter().find(|m| m.name == "walking_tank").unwrap();
    let mut most = 0.0_f64;
    let mut compare = |found: f64, exact: f64, size: f64| {
        most = most.max((found - exact * size).abs() / (exact * size).abs().max(f64::MIN_POSITIVE));
    };
    for (event, other) in run.events.iter().zip(&si.events) {
        assert_eq!(event.transition, other.transition);
        compare(event.t, other.t, units.second);
    }
    for (i, coordinate) in model.coordinates.iter().enumerate() {
        let size = units.of(coordinate.unit);
        compare(run.end.state.q[i], si.end.state.q[i], size);
        compare(run.end.state.v[i], si.end.state.v[i], size / units.second);
    }
    most
}

const SI: Units = Units {
    metre: 1.0,
    kilogram: 1.0,
    second: 1.0,
};

#[test]
fn units_that_are_powers_of_two_give_the_same_bits() {
    let powers = [(10, -7, 0), (0, 0, 5), (-20, 30, -12), (40, -40, 20)];
    for method in [Method::Radau, Method::Taylor, Method::Auto] {
        for rocks in [false, true] {
            let si = run(&tank(SI, rocks, method));
            assert!(si.events.len() > 5, "{} events", si.events.len());
            for (metre, kilogram, second) in powers {
                let units = Units {
                    metre: f64::powi(2.0, metre),
                    kilogram: f64::powi(2.0, kilogram),
                    second: f64::powi(2.0, second),
                };
                let other = run(&tank(units, rocks, method));
                assert_eq!(other.solver.steps, si.solver.steps, "{method:?} {units:?}");
                let difference = difference(&other, units, &si);
                assert!(difference == 0.0, "{method:?} {units:?}: {difference:e}");
            }
        }
    }
}

#[test]
fn a_tank_in_millimetres_and_tonnes_is_the_same_to_rounding() {
    let units = Units {
        metre: 1e3,
        kilogram: 1e-3,
        second: 1.0,
    };
    for method in [Method::Radau, Method::Taylor, Method::Auto] {
        for rocks in [false, true] {
            let [si, other] = [SI, units].map(|units| run(&tank(units, rocks, method)));
            let difference = difference(&other, units, &si);
            // Some hundred roundings, carried on by the motion.
            assert!(difference < 1e-9, "{method:?}: {difference:e}");
            println!("{method:?} {rocks}: {difference:.1e}");
        }
    }
}
