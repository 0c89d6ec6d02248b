//! All tolerances and methods agree on what happens.

use crate::common::*;
use crate::scenes::{SCENES, scene};
use dalembert::hybrid::Method;

#[test]
fn no_event_is_missed_or_doubled_at_any_tolerance() {
    for name in SCENES {
        let of = |digits: u32, method: Method| {
            let mut problem = scene(name, &[&format!("accuracy.relative=1e-{digits}")]);
            problem.method = method;
            run(&problem)
        };
        let tight = of(13, Method::Radau);
        for method in [Method::Auto, Method::Radau, Method::Taylor] {
            for digits in 3..=13 {
                let tolerance = 10f64.powi(-(digits as i32));
                // Found: at most 0.008 of the tolerance, and a rounding of t.
                let allowed = 0.02 * tolerance + 1e-15;
                let at = format!("{name}, {method:?}, {tolerance:e}");
                let loose = of(digits, method);
                let (mut expected, mut found) = (transitions(&tight), transitions(&loose));
                if name == "tank_free_release" {
                    // The rocking dies out: infinitely many landings end at a limit. All runs go there
                    // by "rest" once what is left of the series moves nothing by more than their
                    // tolerances, so the loose ones do it some landings earlier, at the same limit.
                    let rests = [&loose, &tight].map(|run| times(run, "rest"));
                    assert_eq!(rests.each_ref().map(Vec::len), [1, 1], "{at}");
                    assert!(
                        (rests[0][0] - rests[1][0]).abs() < allowed,
                        "{at}: {rests:?}"
                    );
                    assert_eq!((expected.pop(), found.pop()), (Some("rest"), Some("rest")));
                    assert!(found.len() > 25, "{at}");
                    let left_out = expected.split_off(found.len());
                    assert!(left_out.iter().all(|&transition| transition == "landing"));
                }
                assert_eq!(found, expected, "{at}");
                for (loose, tight) in loose.events.iter().zip(&tight.events).take(found.len()) {
                    let difference = (loose.t - tight.t).abs();
                    assert!(
                        difference < allowed,
                        "{at}: {} at {} off by {difference:e}",
                        loose.transition,
                        loose.t
                    );
                }
            }
        }
    }
}
