use super::*;

fn references() -> serde_json::Value {
    serde_json::from_str(include_str!("../../../tests/data/20_fragility.json")).unwrap()
}

fn number(value: &serde_json::Value) -> f64 {
    match value {
        serde_json::Value::String(text) => text.parse().unwrap(),
        other => other.as_f64().unwrap(),
    }
}

fn stripes(case: &serde_json::Value) -> Data {
    let column = |key: &str| case[key].as_array().unwrap();
    let row = |i: usize| Stripe {
        intensity: number(&column("im")[i]),
        runs: column("n")[i].as_u64().unwrap(),
        failures: column("k")[i].as_u64().unwrap(),
    };
    Data::Stripes((0..column("im").len()).map(row).collect())
}

#[track_caller]
fn near(value: f64, exact: &serde_json::Value, tolerance: f64) {
    let exact = number(exact);
    let error = (value / exact - 1.0).abs();
    assert!(error < tolerance, "{value} is not {exact}: {error:e}");
}

#[test]
fn fits_and_their_intervals_are_those_of_the_references() {
    for case in references()["fits"].as_array().unwrap() {
        let fit = fit(&stripes(case)).expect("there is a fit");
        near(fit.theta, &case["theta"], 1e-13);
        near(fit.beta, &case["beta"], 1e-13);
        near(fit.log_likelihood, &case["loglik_without_binomial"], 1e-14);
        // Where a profile is flat, its limit is as much worse known as the likelihood is.
        for i in 0..2 {
            near(
                fit.theta_interval[i].unwrap(),
                &case["profile95_theta"][i],
                1e-11,
            );
            near(
                fit.beta_interval[i].unwrap(),
                &case["profile95_beta"][i],
                1e-11,
            );
        }
        for (im, p) in case["im"]
            .as_array()
            .unwrap()
            .iter()
            .zip(case["p_at_im"].as_array().unwrap())
        {
            near(fit.probability(number(im)), p, 1e-11);
        }
    }
}

#[test]
fn what_data_do_not_determine_is_said() {
    let cases = references();
    let degenerate = cases["degenerate"].as_array().unwrap();
    let case = |name: &str| {
        degenerate
            .iter()
            .find(|c| c["name"] == name)
            .expect("it is there")
    };
    let problem = |name: &str| fit(&stripes(case(name))).expect_err("there is no fit");
    assert_eq!(
        problem("no_failures"),
        Problem::NoFailures {
            intensity: 0.6,
            runs: 10
        }
    );
    assert!(problem("no_failures").to_string().contains("0.2589"));
    let separated = |survived, failed| Problem::Separated { survived, failed };
    assert_eq!(problem("perfect_separation"), separated(0.4, 0.6));
    assert_eq!(problem("quasi_separation_k3"), separated(0.4, 0.4));
    assert_eq!(
        problem("decreasing_fractions"),
        Problem::Falls {
            share: (60.0, 24.0)
        }
    );
    for (name, key) in [("zero_im", "fit_if_treated"), ("n_zero_stripe", "fit")] {
        let fit = fit(&stripes(case(name))).expect("the other stripes determine it");
        near(fit.theta, &case(name)[key]["theta"], 1e-13);
        near(fit.beta, &case(name)[key]["beta"], 1e-13);
    }
    let at = |rows: &[(f64, u64, u64)]| {
        let stripe = |&(intensity, runs, failures): &_| Stripe {
            intensity,
            runs,
            failures,
        };
        fit(&Data::Stripes(rows.iter().map(stripe).collect()))
    };
    assert_eq!(at(&[]), Err(Problem::NoRuns));
    assert_eq!(at(&[(0.5, 0, 0)]), Err(Problem::NoRuns));
    assert_eq!(
        at(&[(0.5, 10, 3), (0.5, 4, 1)]),
        Err(Problem::OneIntensity { intensity: 0.5 })
    );
    assert_eq!(
        at(&[(0.4, 10, 10), (0.5, 4, 4)]),
        Err(Problem::AllFail {
            intensity: 0.4,
            runs: 10
        })
    );
    assert!(matches!(
        at(&[(0.4, 10, 10), (0.5, 4, 0)]),
        Err(Problem::Falls { .. })
    ));
}

#[test]
fn a_slope_that_may_be_none_has_no_limits() {
    let stripes = [(0.4, 3), (0.5, 4), (0.6, 4)];
    let stripe = |&(intensity, failures): &_| Stripe {
        intensity,
        runs: 10,
        failures,
    };
    let fit = fit(&Data::Stripes(stripes.iter().map(stripe).collect())).unwrap();
    assert_eq!(fit.beta_interval[1], None);
    assert_eq!(fit.theta_interval[1], None);
    let lower = fit.beta_interval[0].unwrap();
    assert!(lower > 0.0 && lower < fit.beta);
}

fn capacities(values: &[(f64, bool)]) -> Data {
    let capacity = |&(intensity, censored): &_| Capacity {
        intensity,
        censored,
    };
    Data::Capacities(values.iter().map(capacity).collect())
}

#[test]
fn capacities_have_the_median_and_dispersion_of_their_logarithms() {
    let ida = &references()["ida"];
    let mut values: Vec<f64> = ida["capacities"]
        .as_array()
        .unwrap()
        .iter()
        .map(number)
        .collect();
    let known: Vec<_> = values.iter().map(|v| (*v, false)).collect();
    let fit = fit(&capacities(&known)).unwrap();
    near(fit.theta, &ida["median_exp_mean_ln"], 1e-14);
    near(fit.beta, &ida["dispersion_n_minus_1"], 1e-14);
    near(fit.beta_likely, &ida["dispersion_n_ML"], 1e-13);
    // Of a normal sample the profile of the mean is Student's in another dress: n ln(1 + d²/s²) = χ².
    let (n, s): (f64, f64) = (20.0, fit.beta_likely);
    let d = s * ((3.841458820694126_f64 / n).exp() - 1.0).sqrt();
    for (limit, sign) in fit.theta_interval.into_iter().zip([-1.0, 1.0]) {
        let exact = fit.theta * (sign * d).exp();
        assert!((limit.unwrap() / exact - 1.0).abs() < 1e-12);
    }
    values.sort_by(f64::total_cmp);
    for (p, key) in [
        (0.16, "counted_16pct_type7"),
        (0.5, "counted_median_type7"),
        (0.84, "counted_84pct_type7"),
    ] {
        near(fractile(&values, p), &ida[key], 1e-14);
    }
}

/// The derivatives of the likelihood, by differences of its plain formula, are zero at the fit.
#[test]
fn censored_capacities_are_beyond_what_was_tried() {
    let data = [
        (0.5, false),
        (0.8, false),
        (0.9, false),
        (1.0, true),
        (1.0, true),
        (0.7, true),
    ];
    let fit = fit(&capacities(&data)).unwrap();
    let value = |theta: f64, beta: f64| -> f64 {
        let term = |&(x, censored): &(f64, bool)| {
            let z = (x / theta).ln() / beta;
            match censored {
                true => (0.5 * libm::erfc(z / 2f64.sqrt())).ln(),
                false => -0.5 * z * z - beta.ln(),
            }
        };
        data.iter().map(term).sum()
    };
    let (theta, beta, h) = (fit.theta, fit.beta, 1e-4);
    // Right to the fourth order in h.
    let slope =
        |f: &dyn Fn(f64) -> f64| (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h);
    assert!(slope(&|d| value(theta + d, beta)).abs() < 1e-8);
    assert!(slope(&|d| value(theta, beta + d)).abs() < 1e-8);
    assert_eq!(fit.beta, fit.beta_likely);
    let one = |data: &[(f64, bool)]| super::fit(&capacities(data));
    assert_eq!(
        one(&[(0.8, false)]),
        Err(Problem::OneCapacity { intensity: 0.8 })
    );
    assert_eq!(
        one(&[(0.8, false), (0.8, false)]),
        Err(Problem::NoDispersion { intensity: 0.8 })
    );
    assert_eq!(
        one(&[(0.8, true), (0.7, true)]),
        Err(Problem::NoFailures {
            intensity: 0.8,
            runs: 1
        })
    );
    assert!(one(&[(0.8, false), (0.9, true)]).is_ok());
}

#[test]
fn tables_say_where_they_are_wrong() {
    let table =
        Table::read("\u{feff}# counted\nim;n;k;note\n0.5; 10 ;2;x\n\n1.0;10;7;y\r\n").unwrap();
    let stripe = |intensity, failures| Stripe {
        intensity,
        runs: 10,
        failures,
    };
    assert_eq!(
        table.data,
        Data::Stripes(vec![stripe(0.5, 2), stripe(1.0, 7)])
    );
    assert_eq!(table.notes[0].message, "the column `note` is not read");
    let table = Table::read("capacity censored\n0.5 0\n1 true").unwrap();
    assert_eq!(table.data, capacities(&[(0.5, false), (1.0, true)]));
    for (text, message, place) in [
        ("", "the table is empty", ""),
        ("im,n\n1,2", "the column `k` is missing", "im,n"),
        (
            "im,n,k\n",
            "the table has names of columns and no rows",
            "im,n,k",
        ),
        ("im,n,k\n1,2", "2 fields, but 3 columns have names", "1,2"),
        ("im,n,k\n1,2,3", "3 failures among 2 runs", "3"),
        ("im,n,k\n1,2,0.5", "`0.5` is not a count", "0.5"),
        ("im,n,k\nnan,2,1", "`nan` is not a finite number", "nan"),
        ("im,n,k\n-1,2,1", "the intensity -1 is negative", "-1"),
        (
            "im,n,k\n0,2,1",
            "failures at the intensity 0, where no lognormal fragility has any",
            "1",
        ),
        ("im,im,n\n1,2,1", "the column `im` is there twice", "im"),
        (
            "im,capacity\n1,2",
            "counts and capacities exclude each other",
            "im,capacity",
        ),
        (
            "0.1,0.2\n1,2",
            "no column has a name that is known here",
            "0.1,0.2",
        ),
        ("capacity\n0", "the capacity 0 is not positive", "0"),
        (
            "capacity,censored\n1,maybe",
            "`maybe` is neither 0 nor 1",
            "maybe",
        ),
    ] {
        let fault = Table::read(text).expect_err(text);
        assert_eq!(fault.message, message);
        assert_eq!(&text[fault.range], place, "{text}");
    }
}
