//! A tank in a mirror moves as the mirrored tank.

use crate::common::*;
use crate::scenes::{SCENES, scene};
use dalembert::hybrid::Problem;
use dalembert::input::{Function, Sine};
use dalembert::record::Snapshot;

/// The mirror image of a state: side, slip, x_I and x change their signs.
fn mirrored(state: &Snapshot) -> Snapshot {
    let flip = |values: &[f64]| vec![values[0], -values[1], -values[2], values[3]];
    Snapshot {
        q: flip(&state.q),
        v: flip(&state.v),
        discrete: state.discrete.iter().map(|d| -d).collect(),
        reactions: vec![],
        outputs: vec![],
    }
}

fn in_a_mirror(problem: &Problem, shaken: bool) -> Problem {
    let mut mirror = problem.clone();
    let initial = &mut mirror.initial;
    for values in [&mut initial.q, &mut initial.v] {
        values[1] = -values[1];
        values[2] = -values[2];
    }
    initial.discrete.iter_mut().for_each(|d| *d = -*d);
    if shaken {
        let shake = Sine::new(-20.0, std::f64::consts::TAU * 7.0, 0.0);
        mirror
            .set_input("ground_acceleration", Function::from(shake))
            .unwrap();
    }
    mirror
}

#[test]
fn the_mirror_image_of_a_scene_gives_the_mirrored_result() {
    for name in SCENES {
        let problem = scene(name, &[]);
        let mut signals = vec![0.0; problem.model.signal_count()];
        problem.signals.rate(0.0, &mut signals);
        let shaken = signals[0] != 0.0;
        let [run, image] = [run(&problem), run(&in_a_mirror(&problem, shaken))];
        assert_eq!(transitions(&run), transitions(&image), "{name}");
        for (event, image) in run.events.iter().zip(&image.events) {
            assert_eq!(event.t, image.t, "{name}: {}", event.transition);
            let after = Snapshot {
                reactions: vec![],
                ..event.after.clone()
            };
            let image = Snapshot {
                reactions: vec![],
                ..image.after.clone()
            };
            assert_eq!(
                mirrored(&after).q,
                image.q,
                "{name}: {} at {}",
                event.transition,
                event.t
            );
            assert_eq!(
                mirrored(&after).v,
                image.v,
                "{name}: {} at {}",
                event.transition,
                event.t
            );
        }
        assert_eq!(mirrored(&run.end.state).q, image.end.state.q, "{name}");
    }
}
