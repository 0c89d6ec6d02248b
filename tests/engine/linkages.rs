//! Linkages, friction between bodies and contacts of linkages, by multipliers, against references.

use super::multipliers::{check, scenes};
use crate::common::*;
use dalembert::hybrid::{Method, Problem, Simulator};
use dalembert::record::Silent;

/// The demand of the IVP test set at a tolerance of 1e-13, of relative errors: two digits less.
const DEMAND: f64 = 1e-11;

#[test]
fn a_pendulum_in_cartesian_coordinates_keeps_its_length() {
    let reference = reference("14a_pendulum_cartesian");
    for method in [Method::Taylor, Method::Radau] {
        let mut pendulum = problem("constrained_pendulum", &[]);
        pendulum.set_initial("x", -1.0).unwrap();
        pendulum.set_tolerance(TIGHTEST);
        pendulum.end.time = 10.0;
        pendulum.method = method;
        pendulum.record.every = Some(0.01);
        pendulum.record.columns.outputs = true;
        let run = run(&pendulum);
        let column = |name: &str| run.trajectory.column(name).expect("a column");
        let force = column("rod.force");
        for exact in reference["reference"].as_array().unwrap() {
            let t = number(&exact["t"]);
            let row = run.trajectory.row((t / 0.01).round() as usize);
            let force = row[force];
            for (value, key) in [(row[0], "x"), (row[1], "y"), (row[2], "vx"), (row[3], "vy")] {
                let exact = number(&exact[key]);
                assert!(
                    (value - exact).abs() <= 1e-12 * t.max(1.0),
                    "{key} at {t}: {value} {exact}"
                );
            }
            let tension = number(&exact["tension"]);
            assert!(
                (force + tension).abs() <= 1e-11 * tension,
                "{force} {tension}"
            );
        }
        for k in 0..run.trajectory.t.len() {
            let row = run.trajectory.row(k);
            let length = (row[0] * row[0] + row[1] * row[1]).sqrt();
            let rate = (row[0] * row[2] + row[1] * row[3]) / length;
            assert!(
                (length - 1.0).abs() <= 1e-14 && rate.abs() <= 1e-14,
                "{length} {rate}"
            );
        }
    }
}

#[test]
fn a_double_pendulum_strikes_a_wall_slides_along_it_and_leaves() {
    for (_, scene) in scenes("17_double_pendulum_wall") {
        for method in [Method::Taylor, Method::Radau] {
            let of = |name: &str| number(&scene["parameters"][name]);
            let given = [("wall", of("xw")), ("mu", of("mu")), ("e", of("e"))];
            let mut pendulum = problem("double_pendulum_wall", &given);
            pendulum.method = method;
            let q = numbers(&scene["initial"]["q"]);
            pendulum.set_initial("phi_1", q[0]).unwrap();
            pendulum.set_initial("phi_2", q[1]).unwrap();
            pendulum.set_tolerance(TIGHTEST);
            pendulum.end.time = number(&scene["t_end"]);
            pendulum.record.every = Some(0.1);
            check(&scene, &run(&pendulum), 2, method);
        }
    }
}

/// Reference 14b: the cranks stand, and the first pin moves at 1 m/s to the right.
fn double_four_bar(tolerance: f64, method: Method) -> Problem {
    let mut linkage = problem("double_four_bar", &[]);
    for crank in ["crank_1", "crank_2", "crank_3"] {
        linkage
            .set_initial(crank, std::f64::consts::FRAC_PI_2)
            .unwrap();
        linkage.set_initial(&format!("{crank}.rate"), -1.0).unwrap();
    }
    linkage.project = true;
    linkage.method = method;
    linkage.set_tolerance(tolerance);
    linkage.end.time = 10.0;
    linkage.record.every = Some(0.5);
    linkage.record.ledger = true;
    linkage
}

#[test]
fn five_bars_pass_positions_in_which_all_are_in_line() {
    let reference = reference("14b_n_four_bar");
    let exact = reference["reference"].as_array().unwrap();
    // The demand of the reference; and what is chosen by itself, within ten times its tolerance.
    for (method, tolerance, demand) in [(Method::Taylor, 1e-11, 1e-10), (Method::Auto, 1e-9, 1e-8)]
    {
        let run = run(&double_four_bar(tolerance, method));
        let mut compared = 0;
        for exact in exact.iter().filter(|e| e["N"] == 2) {
            let row = run
                .trajectory
                .row((number(&exact["t"]) / 0.5).round() as usize);
            let place = numbers(&exact["B0"]);
            for crank in 0..3 {
                let (sin, cos) = row[crank].sin_cos();
                let off = (cos - place[0]).abs().max((sin - place[1]).abs());
                let rate = (row[5 + crank] - number(&exact["omega"])).abs();
                assert!(
                    off < demand && rate < demand,
                    "{method:?}: {off:e} {rate:e}"
                );
            }
            compared += 1;
        }
        assert_eq!(compared, 5);
        let energy = run.energy.as_ref().unwrap();
        let imbalance = energy.imbalance() / energy.initial;
        assert!(imbalance.abs() < 0.1 * demand, "{method:?}: {imbalance:e}");
    }
}

#[test]
fn a_singular_position_that_rounding_hides_is_named() {
    let mut linkage = double_four_bar(1e-13, Method::Radau);
    linkage.end.time = 1.0;
    let mut simulator = Simulator::new(&linkage).unwrap();
    let reason = simulator.run(&mut Silent).unwrap_err();
    let text = reason.to_string();
    assert!(
        text.contains("singular position") && text.contains("pin_"),
        "{text}"
    );
}

#[test]
fn a_slider_crank_of_nine_coordinates_turns_as_that_of_one() {
    let reference = reference("14e_slider_crank");
    let (r, l, angle, rate) = (0.3_f64, 0.8_f64, 0.5_f64, 12.0_f64);
    let rod = (-r * angle.sin() / l).asin();
    let rod_rate = -r * angle.cos() * rate / (l * rod.cos());
    let crank = [0.5 * r * angle.cos(), 0.5 * r * angle.sin()];
    let crank_rate = [-crank[1] * rate, crank[0] * rate];
    let half = [0.5 * l * rod.cos(), 0.5 * l * rod.sin()];
    let half_rate = [-half[1] * rod_rate, half[0] * rod_rate];
    let of_rod = |i: usize| [2.0 * crank[i] + half[i], 2.0 * crank_rate[i] + half_rate[i]];
    let slider = [
        2.0 * (crank[0] + half[0]),
        2.0 * (crank_rate[0] + half_rate[0]),
    ];
    let mut problem = problem("slider_crank", &[]);
    for (name, [value, speed]) in [
        ("crank_x", [crank[0], crank_rate[0]]),
        ("crank_y", [crank[1], crank_rate[1]]),
        ("crank_angle", [angle, rate]),
        ("rod_x", of_rod(0)),
        ("rod_y", of_rod(1)),
        ("rod_angle", [rod, rod_rate]),
        ("slider_x", slider),
    ] {
        problem.set_initial(name, value).unwrap();
        problem.set_initial(&format!("{name}.rate"), speed).unwrap();
    }
    problem.set_tolerance(TIGHTEST);
    problem.end.time = 5.0;
    problem.record.every = Some(0.1);
    problem.record.columns.outputs = true;
    problem.record.ledger = true;
    for method in [Method::Taylor, Method::Radau] {
        problem.method = method;
        let run = run(&problem);
        for exact in reference["reference"].as_array().unwrap() {
            let t = number(&exact["t"]);
            let row = run.trajectory.row((t / 0.1).round() as usize);
            // The demand of the reference; samples of Radau IIA are those of its dense output.
            let demand = match method {
                Method::Radau => 1e-8,
                _ if t <= 1.0 => 1e-12,
                _ => 1e-11,
            };
            let error = row[2] - number(&exact["theta"]);
            assert!(error.abs() <= demand, "theta at {t}: {error:e}");
            if method == Method::Taylor {
                let forces = ["O.1", "O.2", "A.1", "A.2", "B.1", "B.2", "guide"];
                let names = ["O_x", "O_y", "A_x", "A_y", "B_x", "B_y", "guide_N"];
                for (force, name) in forces.into_iter().zip(names) {
                    let force = row[run.trajectory.column(&format!("{force}.force")).unwrap()];
                    let exact = number(&exact["multipliers"][name]);
                    let off = (force - exact).abs() / exact.abs();
                    assert!(off <= 1e-10, "{name} at {t}: {force} {exact}");
                }
            }
        }
        let energy = run.energy.expect("a ledger");
        let imbalance = energy.final_ - energy.initial - energy.input_work + energy.dissipated;
        assert!(imbalance.abs() <= 1e-12 * 6.6, "{imbalance:e}");
    }
}

#[test]
fn andrews_squeezing_mechanism_ends_where_quadruple_precision_does() {
    let squeezer = &reference("08_ivp_testset")["reference"]["andrews"];
    let exact = numbers(&squeezer["own"]);
    let mut problem = problem("squeezer", &[]);
    // Consistent to the last of the digits that Hairer and Wanner (1996), section VII.7, give.
    for (name, angle) in [
        ("beta", -0.061_713_890_014_276_45),
        ("gamma", 0.455_279_819_163_070_4),
        ("Phi", 0.222_668_390_165_885_9),
        ("delta", 0.487_364_979_543_842_55),
        ("Omega", -0.222_668_390_165_885_9),
        ("epsilon", 1.230_547_444_549_821_2),
    ] {
        problem.set_initial(name, angle).unwrap();
    }
    problem.end.time = number(&squeezer["t_end"]);
    problem.record.every = Some(problem.end.time);
    problem.record.columns.outputs = true;
    problem.record.ledger = true;
    problem.set_tolerance(1e-13);
    for method in [Method::Taylor, Method::Radau] {
        problem.method = method;
        let run = run(&problem);
        let (q, v) = (&run.end.state.q, &run.end.state.v);
        let off = |value: f64, i: usize| (value - exact[i]).abs() / exact[i].abs();
        for i in 0..7 {
            assert!(
                off(q[i], i) <= DEMAND,
                "{method:?}: q {i} {:e}",
                off(q[i], i)
            );
            assert!(
                off(v[i], 7 + i) <= DEMAND,
                "{method:?}: v {i} {:e}",
                off(v[i], 7 + i)
            );
        }
        let end = run.trajectory.row(run.trajectory.t.len() - 1);
        // The reference states M q'' = f - G^T lambda: a multiplier is less the force.
        for (i, name) in [
            "third.1", "third.2", "fourth.1", "fourth.2", "sixth.1", "sixth.2",
        ]
        .iter()
        .enumerate()
        {
            let force = end[run.trajectory.column(&format!("{name}.force")).unwrap()];
            assert!(
                off(-force, 21 + i) <= DEMAND,
                "{method:?}: {name} {:e}",
                off(-force, 21 + i)
            );
        }
        let energy = run.energy.expect("a ledger");
        let imbalance = energy.final_ - energy.initial - energy.input_work + energy.dissipated;
        assert!(
            imbalance.abs() <= 1e-13 * energy.final_,
            "{method:?}: {imbalance:e}"
        );
    }
}

#[test]
fn a_car_axis_ends_where_quadruple_precision_does() {
    let exact = numbers(&reference("08_ivp_testset")["reference"]["caraxis"]["own"]);
    let mut axis = problem("car_axis", &[]);
    for (name, value) in [
        ("y_l", 0.5),
        ("x_r", 1.0),
        ("y_r", 0.5),
        ("x_l.rate", -0.5),
        ("x_r.rate", -0.5),
        ("phase.rate", 10.0),
    ] {
        axis.set_initial(name, value).unwrap();
    }
    axis.end.time = 3.0;
    axis.record.every = Some(3.0);
    axis.record.columns.outputs = true;
    axis.set_tolerance(1e-13);
    for method in [Method::Taylor, Method::Radau] {
        axis.method = method;
        let run = run(&axis);
        let end = run.trajectory.row(run.trajectory.t.len() - 1);
        let names = ["x_l", "y_l", "x_r", "y_r"];
        let rates = names.map(|name| format!("{name}.rate"));
        let forces = ["upright.force", "length.force"].map(str::to_owned);
        let all = names.map(str::to_owned).into_iter().chain(rates);
        for (name, exact) in all.chain(forces).zip(&exact) {
            let value = end[run.trajectory.column(&name).expect("a column")];
            let off = (value - exact).abs() / exact.abs();
            assert!(off <= DEMAND, "{method:?}: {name} {off:e}");
        }
    }
}

#[test]
fn a_pin_with_friction_turns_back_and_sticks_where_quadrature_says() {
    let reference = &reference("14c_pendulum_pin_friction")["reference"];
    let turns = reference["turning_points"].as_array().unwrap();
    let samples = reference["samples"].as_array().unwrap();
    for method in [Method::Taylor, Method::Radau] {
        let mut pendulum = problem("pin_friction", &[]);
        pendulum.set_initial("phi", 1.5).unwrap();
        pendulum.set_tolerance(1e-14);
        pendulum.method = method;
        pendulum.end.time = 100.0;
        pendulum.record.every = Some(0.5);
        pendulum.record.event_states = true;
        let run = run(&pendulum);
        let expected = [
            "pin slips",
            "pin reverses",
            "pin reverses",
            "pin reverses",
            "pin reverses",
            "pin sticks",
        ];
        assert_eq!(transitions(&run), expected, "{method:?}");
        for (event, turn) in run.events[1..].iter().zip(turns) {
            let [t, phi] = ["t", "phi"].map(|key| number(&turn[key]));
            let off = (event.t - t).abs().max((event.after.q[0] - phi).abs());
            assert!(off <= 1e-13, "{method:?}: {off:e} at {t}");
        }
        for sample in samples {
            let row = (number(&sample["t"]) / 0.5).round() as usize;
            let row = run.trajectory.row(row);
            let exact = [&sample["q"], &sample["u"]].map(|of| numbers(of)[0]);
            // By Radau a rate within a step is that of its dense output, whose order is lower.
            let within = [
                1e-13,
                if method == Method::Taylor {
                    1e-13
                } else {
                    1e-11
                },
            ];
            for ((value, exact), within) in row.iter().zip(exact).zip(within) {
                let off = (value - exact).abs();
                assert!(off <= within, "{method:?}: {value} {exact}");
            }
        }
    }
}
