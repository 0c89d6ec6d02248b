//! What a reset can calculate: comparisons, logic, choices, least and greatest.

use crate::common::*;

#[test]
fn a_reset_decides_as_it_is_written() {
    let mut walls = problem("decisions", &[]);
    walls.set_initial("x", 0.5).unwrap();
    walls.set_initial("x.rate", -1.0).unwrap();
    walls.end.time = 2.0;
    let run = run(&walls);
    // less, not more, equal, unequal, not, both, either, choice, sign, copied sign, least, greatest
    let left = [
        1.0, 1.0, 0.0, 1.0, 0.0, 1.0, 1.0, 3.0, -1.0, -7.0, -1.0, -0.5,
    ];
    let right = [0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 5.0, 1.0, 7.0, 0.5, 1.0];
    assert_eq!(transitions(&run), ["left", "right"]);
    assert_eq!(run.events[0].after.v[1..], left);
    assert_eq!(run.events[1].after.v[1..], right);
}
