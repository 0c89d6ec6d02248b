//! Housner's rocking block against closed forms (tests/data/01_rocking_free.json).

mod common;
use common::*;

fn free_rocking(case: &serde_json::Value, end: f64) -> dalembert::record::Run {
    let (alpha, p) = (number(&case["alpha"]), number(&case["p"]));
    // p² = m g R / (I + m R²) = 3 g / (4 R) for the homogeneous block.
    let mut problem = problem(
        "rocking_block",
        &[
            ("alpha", alpha),
            ("e", number(&case["e"])),
            ("R", 3.0 * 9.81 / (4.0 * p * p)),
        ],
    );
    problem
        .set_initial("theta", number(&case["theta0"]))
        .unwrap();
    problem.set_tolerance(1e-13);
    problem.end.time = end;
    run(&problem)
}

fn check_impacts(case: &serde_json::Value, run: &dalembert::record::Run) {
    let exact = numbers(&case["reference"]["impact_times"]);
    let found = times(run, "landing");
    assert!(found.len() >= 40, "{} landings", found.len());
    for (k, (t, exact)) in found.iter().zip(&exact).enumerate() {
        assert!(
            (t / exact - 1.0).abs() < 1e-11,
            "impact {k}: {t:.17} instead of {exact:.17}"
        );
    }
}

#[test]
fn forty_impacts_and_the_accumulation_of_a_damped_block() {
    with_each_method(|| {
        let reference = reference("01_rocking_free");
        let case = &reference["reference"]["subcases"][0];
        assert_eq!(case["name"], "A_housner");
        let run = free_rocking(case, 11.0);
        check_impacts(case, &run);
        let rest = times(&run, "rest");
        let exact = number(&case["reference"]["accumulation_time"]);
        assert_eq!(rest.len(), 1);
        assert!(
            (rest[0] / exact - 1.0).abs() < 1e-9,
            "{} instead of {exact}",
            rest[0]
        );
        assert_eq!(run.layout.modes[run.end.mode], "stands");
        assert_eq!(at_end(&run, "theta"), 0.0);
        let before = run.events[0].before.v[0];
        let speed = number(&case["reference"]["impact_speed_before_first"]);
        assert!((before / -speed - 1.0).abs() < 1e-11);
    });
}

#[test]
fn forty_impacts_of_an_elastic_block() {
    with_each_method(|| {
        let reference = reference("01_rocking_free");
        let subcases = reference["reference"]["subcases"].as_array().unwrap();
        let case = subcases.iter().find(|c| c["name"] == "D_elastic").unwrap();
        let run = free_rocking(case, 1.01 * numbers(&case["reference"]["impact_times"])[40]);
        check_impacts(case, &run);
    });
}
