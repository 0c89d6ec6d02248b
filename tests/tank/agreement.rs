//! Loose and tight tolerances agree on what happens.

use crate::common::*;
use crate::scenes::{SCENES, scene};

#[test]
fn loose_and_tight_tolerances_agree_on_the_events() {
    for name in SCENES {
        let [loose, tight] = ["accuracy.relative=1e-6", "accuracy.relative=1e-12"]
            .map(|accuracy| run(&scene(name, &[accuracy])));
        let same = transitions(&loose)
            .iter()
            .zip(transitions(&tight))
            .take_while(|(a, b)| **a == *b)
            .count();
        println!(
            "{name}: {} and {} events, first {same} the same",
            loose.events.len(),
            tight.events.len()
        );
        for run in [&loose, &tight] {
            let from = same.saturating_sub(3);
            for e in run.events.iter().skip(from).take(8) {
                println!(
                    "   {} {} theta.rate {:e} {:e} x.rate {:e}",
                    e.t, e.transition, e.before.v[0], e.after.v[0], e.before.v[2]
                );
            }
        }
    }
}
