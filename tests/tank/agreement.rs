//! Loose and tight tolerances agree on what happens.

use crate::common::*;
use crate::scenes::{SCENES, scene};

#[test]
fn loose_and_tight_tolerances_agree_on_the_events() {
    for name in SCENES {
        let tolerances = ["accuracy.relative=1e-6", "accuracy.relative=1e-12"];
        let [loose, tight] = tolerances.map(|accuracy| run(&scene(name, &[accuracy])));
        let (mut expected, mut found) = (transitions(&tight), transitions(&loose));
        if name == "tank_free_release" {
            // The rocking dies out: infinitely many landings end at a limit. Both runs go there by
            // "rest" once what is left of the series moves nothing by more than their tolerances,
            // so the loose one does it some landings earlier, at the same limit.
            let rests = [&loose, &tight].map(|run| times(run, "rest"));
            assert_eq!(rests.each_ref().map(Vec::len), [1, 1]);
            assert!((rests[0][0] / rests[1][0] - 1.0).abs() < 1e-6, "{rests:?}");
            assert_eq!((expected.pop(), found.pop()), (Some("rest"), Some("rest")));
            assert!(found.len() > 30);
            let left_out = expected.split_off(found.len());
            assert!(left_out.iter().all(|&transition| transition == "landing"));
        }
        assert_eq!(found, expected, "{name}");
        for (loose, tight) in loose.events.iter().zip(&tight.events).take(found.len()) {
            let difference = (loose.t - tight.t).abs();
            assert!(
                difference < 1e-6,
                "{name}: {} at {}",
                loose.transition,
                loose.t
            );
        }
    }
}
