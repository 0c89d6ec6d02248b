//! States with no motion, or several, that agree with the law of friction (Painlevé 1895), against references.

use crate::common::*;
use dalembert::hybrid::{Method, Reason, simulate};
use dalembert::record::Silent;

#[test]
fn a_block_that_slides_on_a_corner_has_one_motion_or_none_or_several() {
    let reference = reference("13e_block_painleve");
    for case in reference["reference"].as_array().unwrap() {
        let of = |name: &str| number(&case[name]);
        let (b, h) = (0.2, 0.4);
        let (mu, theta, omega) = (of("mu"), of("theta"), of("omega"));
        let given = [("b", b), ("h", h), ("mu_s", mu), ("mu_k", mu)];
        for method in [Method::Taylor, Method::Radau] {
            let mut block = problem("rigid_block", &given);
            block.method = method;
            // The left corner from the centre, and its rate.
            let (sin, cos) = theta.sin_cos();
            let corner = [-b * cos + h * sin, -b * sin - h * cos];
            for (name, value) in [
                ("x", -corner[0]),
                ("y", -corner[1]),
                ("theta", theta),
                ("x.rate", of("slip_velocity") + omega * corner[1]),
                ("y.rate", -omega * corner[0]),
                ("theta.rate", omega),
            ] {
                block.set_initial(name, value).unwrap();
            }
            block.end.time = 1e-6;
            let outcome = simulate(&block, &mut Silent);
            let expected = case["classification"].as_str().unwrap();
            let found = match &outcome {
                Ok(run) => match &run.failure {
                    None => "unique",
                    Some(failure) => panic!("{failure:?}"),
                },
                Err(Reason::NoMotion { contacts }) => {
                    assert_eq!(contacts[..], ["left"]);
                    "inconsistent"
                }
                Err(Reason::SeveralMotions { contacts, .. }) => {
                    assert_eq!(contacts[..], ["left"]);
                    "indeterminate"
                }
                Err(other) => panic!("{other}"),
            };
            assert_eq!(found, expected, "{case} {method:?}");
            if let Ok(run) = outcome {
                let name = &run.layout.modes.name(run.end.mode);
                let wanted = case["smooth_modes"][0].as_str().unwrap();
                let wanted = match wanted {
                    "open/open" => "left open, right open",
                    _ => "left slides, right open",
                };
                assert_eq!(name, wanted, "{case}");
            }
        }
    }
}
