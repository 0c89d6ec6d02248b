//! A block that is let go from a tilt (Taniguchi 2004): it turns about its lower edge, which friction holds or lets slide. How far the edge has
//! slipped when the block lands, against an integration of its own, in the angle and the place of the edge.

use crate::common::*;
use dalembert::hybrid::simulate;
use dalembert::record::Silent;

const G: f64 = 9.81;
/// Half of width and height, m.
const B: f64 = 0.2;
const H: f64 = 0.6;
/// The tilt, rad.
const TILT: f64 = 0.2;

/// Where the centre is from the left edge, along the ground and up.
fn arms(theta: f64) -> [f64; 2] {
    let (sin, cos) = theta.sin_cos();
    [B * cos - H * sin, B * sin + H * cos]
}

/// Angle, its rate, place of the edge, its rate.
type State = [f64; 4];

/// Angular acceleration, and normal and friction force per unit of mass, while the edge slides in a direction or, at 0, is held.
fn forces(mu: f64, direction: f64, [theta, omega, ..]: State) -> [f64; 3] {
    let ([p, q], inertia) = (arms(theta), (B * B + H * H) / 3.0);
    if direction == 0.0 {
        let alpha = -G * p / (inertia + p * p + q * q);
        let normal = G + p * alpha - q * omega * omega;
        return [alpha, normal, -q * alpha - p * omega * omega];
    }
    // The normal force turns the block back, friction to the right turns it on.
    let lever = p + direction * mu * q;
    let normal = (G - q * omega * omega) / (1.0 + p * lever / inertia);
    [-normal * lever / inertia, normal, -direction * mu * normal]
}

/// A step of the classical method of Runge and Kutta.
fn step(mu: f64, direction: f64, y: State, h: f64) -> State {
    let slope = |y: State| {
        let ([p, q], [alpha, _, friction]) = (arms(y[0]), forces(mu, direction, y));
        let slips = friction + q * alpha + p * y[1] * y[1];
        [
            y[1],
            alpha,
            y[3],
            if direction == 0.0 { 0.0 } else { slips },
        ]
    };
    let add = |k: State, h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
    let first = slope(y);
    let second = slope(add(first, h / 2.0));
    let third = slope(add(second, h / 2.0));
    let fourth = slope(add(third, h));
    std::array::from_fn(|i| {
        y[i] + h / 6.0 * (first[i] + 2.0 * second[i] + 2.0 * third[i] + fourth[i])
    })
}

/// What an edge without a slip rate does: the direction in which it slides, or 0 where friction holds it.
fn direction(mu: f64, y: State) -> f64 {
    let [_, normal, friction] = forces(mu, 0.0, y);
    match friction.abs() <= mu * normal {
        true => 0.0,
        false => -friction.signum(),
    }
}

/// When it lands, where its edge is then, and how often what the edge does has changed.
fn landing(mu: f64) -> ([f64; 2], usize) {
    let (mut t, mut y, h) = (0.0, [TILT, 0.0, 0.0, 0.0], 1e-4);
    let (mut slides, mut changes) = (direction(mu, y), 0);
    loop {
        let goes_on = |y: State| {
            let [_, normal, friction] = forces(mu, slides, y);
            match slides == 0.0 {
                true => friction.abs() <= mu * normal,
                false => slides * y[3] >= 0.0,
            }
        };
        let next = step(mu, slides, y, h);
        if next[0] >= 0.0 && goes_on(next) {
            (t, y) = (t + h, next);
            continue;
        }
        // The last instant before something else happens, by halving.
        let [mut before, mut behind] = [0.0, h];
        while before < (before + behind) / 2.0 && (before + behind) / 2.0 < behind {
            let middle = (before + behind) / 2.0;
            let there = step(mu, slides, y, middle);
            match there[0] >= 0.0 && goes_on(there) {
                true => before = middle,
                false => behind = middle,
            }
        }
        let there = step(mu, slides, y, behind);
        (t, y) = (t + behind, there);
        if y[0] <= 0.0 {
            return ([t, y[2]], changes);
        }
        y[3] = 0.0;
        (slides, changes) = (direction(mu, y), changes + 1);
    }
}

#[test]
fn an_edge_that_slides_is_where_friction_has_let_it_when_the_block_lands() {
    with_each_method(|| {
        let mut turned = 0;
        for mu in [0.02, 0.05, 0.1, 0.15, 0.2] {
            let mut block = problem("rigid_block", &[("mu_k", mu), ("mu_s", mu)]);
            let [p, q] = arms(TILT);
            for (name, value) in [("theta", TILT), ("x", p), ("y", q)] {
                block.set_initial(name, value).unwrap();
            }
            block.project = true;
            block.end.time = 2.0;
            block.end.after = Some(("right strikes", 1));
            tighten(&mut block, 1.0);
            let run = simulate(&block, &mut Silent).unwrap();
            let landed = run.events.last().unwrap();
            let edge = landed.before.q[0] - arms(landed.before.q[2])[0];
            let ([t, slip], changes) = landing(mu);
            turned += changes;
            assert!(slip.abs() > 1e-4, "{slip}");
            assert_eq!(run.events.len(), 1 + changes, "{:?}", transitions(&run));
            assert!((landed.t - t).abs() < 1e-12, "{} {t}", landed.t);
            assert!((edge - slip).abs() < 1e-12, "{edge} {slip}");
        }
        assert!(
            turned > 0,
            "in some cases the edge comes to rest or turns back"
        );
    });
}

#[test]
fn an_edge_that_friction_holds_has_not_slipped() {
    with_each_method(|| {
        let mut block = problem("rigid_block", &[("mu_k", 0.5), ("mu_s", 0.5)]);
        let [p, q] = arms(TILT);
        for (name, value) in [("theta", TILT), ("x", p), ("y", q)] {
            block.set_initial(name, value).unwrap();
        }
        block.project = true;
        block.end.time = 2.0;
        block.end.after = Some(("right strikes", 1));
        tighten(&mut block, 1.0);
        let run = simulate(&block, &mut Silent).unwrap();
        let landed = run.events.last().unwrap();
        let edge = landed.before.q[0] - arms(landed.before.q[2])[0];
        let ([t, slip], changes) = landing(0.5);
        assert_eq!((slip, changes), (0.0, 0));
        assert!((landed.t - t).abs() < 1e-12, "{} {t}", landed.t);
        assert!(edge.abs() < 1e-14, "{edge}");
        assert_eq!(run.events.len(), 1);
    });
}
