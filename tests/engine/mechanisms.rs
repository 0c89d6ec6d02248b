//! Shipped mechanisms, declared by contacts and constraints alone, against integrals of closed form, second methods and laws.

use crate::common::*;
use dalembert::hybrid::{ImpactLaw, Method, Problem};
use dalembert::model::models;
use dalembert::record::Run;
use std::fs;

/// The shipped models that have contacts or constraints and nothing by hand.
const DECLARED: [&str; 15] = [
    "bead_on_hoop",
    "double_four_bar",
    "four_bar",
    "rigid_block",
    "rod",
    "slider_chain",
    "slider_crank",
    "stacked_blocks",
    "woodpecker",
    "bouncing_ball",
    "vibrating_table_ball",
    "belt_oscillator",
    "coulomb_oscillator",
    "sliding_oscillator",
    "rocking_block",
];

#[test]
fn models_of_contacts_have_no_mode_no_transition_and_no_rest() {
    for name in DECLARED {
        let path = format!("{}/models/{name}/model.py", env!("CARGO_MANIFEST_DIR"));
        let text = fs::read_to_string(path).unwrap();
        for word in ["mode(", "transition(", "rest(", "requires(mode", "by_hand("] {
            assert!(!text.contains(&format!("model.{word}")), "{name}: {word}");
        }
        assert!(models().find(name).is_some(), "{name}");
    }
}

/// The integral of a smooth function: Gauss's rule of ten points on panels.
fn integral(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let rule = [
        (0.148_874_338_981_631_2, 0.295_524_224_714_752_87),
        (0.433_395_394_129_247_2, 0.269_266_719_309_996_36),
        (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
        (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
        (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
    ];
    let panels = 200;
    let half = (to - from) / (2 * panels) as f64;
    let panel = |k: i32| {
        let middle = from + half * f64::from(2 * k + 1);
        let pair = |(x, w): &(f64, f64)| w * (f(middle + half * x) + f(middle - half * x));
        rule.iter().map(pair).sum::<f64>() * half
    };
    (0..panels).map(panel).sum()
}

fn column(run: &Run, name: &str) -> usize {
    run.trajectory.column(name).expect("a column")
}

/// The state of a four-bar linkage of one angle: its other pin, and the inertia and potential energy of uniform bars.
struct FourBar {
    lengths: [f64; 4],
    g: f64,
}

impl FourBar {
    fn pins(&self, angle: f64) -> [[f64; 2]; 2] {
        let [crank, coupler, rocker, ground] = self.lengths;
        let a = [crank * angle.cos(), crank * angle.sin()];
        let (dx, dy) = (ground - a[0], -a[1]);
        let d = dx.hypot(dy);
        let along = (coupler * coupler - rocker * rocker + d * d) / (2.0 * d);
        let across = (coupler * coupler - along * along).sqrt();
        let b = [
            a[0] + (along * dx - across * dy) / d,
            a[1] + (along * dy + across * dx) / d,
        ];
        [a, b]
    }

    /// Rates of the pins over that of the angle: both bars at the second pin keep their lengths.
    fn rates(&self, angle: f64) -> [[f64; 2]; 2] {
        let [a, b] = self.pins(angle);
        let u = [-a[1], a[0]];
        let (p, q) = ([b[0] - a[0], b[1] - a[1]], [b[0] - self.lengths[3], b[1]]);
        let load = p[0] * u[0] + p[1] * u[1];
        let determinant = p[0] * q[1] - p[1] * q[0];
        [u, [load * q[1] / determinant, -load * q[0] / determinant]]
    }

    /// Twice the kinetic energy over the square of the rate of the angle, and the potential energy.
    fn energies(&self, angle: f64) -> [f64; 2] {
        let [crank, coupler, rocker, _] = self.lengths;
        let [[a, b], [u, w]] = [self.pins(angle), self.rates(angle)];
        let dot = |x: [f64; 2], y: [f64; 2]| x[0] * y[0] + x[1] * y[1];
        let inertia = crank * dot(u, u) / 3.0
            + coupler * (dot(u, u) + dot(u, w) + dot(w, w)) / 3.0
            + rocker * dot(w, w) / 3.0;
        let height = crank * a[1] / 2.0 + coupler * (a[1] + b[1]) / 2.0 + rocker * b[1] / 2.0;
        [inertia, self.g * height]
    }
}

#[test]
fn a_crank_rocker_turns_as_its_one_angle_does() {
    let of = FourBar {
        lengths: [0.4, 1.0, 0.9, 1.1],
        g: 9.81,
    };
    let (start, rate) = (0.3_f64, 20.0_f64);
    let [a, b] = of.pins(start);
    let mut linkage = problem("four_bar", &[]);
    // The rates of the second pin are left to the projection, and so are some micrometres of its place.
    for (name, value) in [
        ("x_A", a[0]),
        ("y_A", a[1]),
        ("x_B", b[0] + 1e-6),
        ("y_B", b[1]),
        ("x_A.rate", -a[1] * rate),
        ("y_A.rate", a[0] * rate),
    ] {
        linkage.set_initial(name, value).unwrap();
    }
    linkage.project = true;
    linkage.set_tolerance(TIGHTEST);
    linkage.end.time = 5.0;
    linkage.record.every = Some(0.05);
    linkage.record.columns.outputs = true;
    linkage.record.columns.energies = true;
    let run = run(&linkage);
    let moved: Vec<&str> = run
        .subject
        .projected
        .iter()
        .map(|(name, _)| &**name)
        .collect();
    assert!(
        moved.contains(&"x_B") && moved.contains(&"y_B.rate"),
        "{moved:?}"
    );
    // What a projection changes is no impulse.
    let names = run.trajectory.columns.iter().map(|column| &*column.name);
    let impulses: Vec<usize> = (0..)
        .zip(names)
        .filter(|(_, n)| n.ends_with("impulse"))
        .map(|(i, _)| i)
        .collect();
    assert!(!impulses.is_empty());
    assert!(impulses.iter().all(|&i| run.trajectory.row(0)[i] == 0.0));
    let [angle, stored] = ["crank_angle", "energy.stored"].map(|name| column(&run, name));
    let energy = run.trajectory.row(0)[stored];
    let lag = |angle: f64| {
        let [inertia, potential] = of.energies(angle);
        (inertia / (2.0 * (energy - potential))).sqrt()
    };
    let pi = std::f64::consts::PI;
    let turn = integral(lag, 0.0, 2.0 * pi);
    let begun = run.trajectory.row(0)[angle];
    let mut turns = 0.0;
    let mut before = begun;
    for (k, &t) in run.trajectory.t.iter().enumerate() {
        let row = run.trajectory.row(k);
        let now = row[angle];
        turns += f64::from(u8::from(now < before - pi));
        before = now;
        let time = turns * turn + integral(lag, begun, now);
        // Energy is kept to some 1e-13 of it, and so is the time of a turn.
        assert!((time - t).abs() <= 1e-12, "{t}: {:e}", time - t);
        let [a, b] = of.pins(now);
        for (value, exact) in row[..4].iter().zip([a[0], a[1], b[0], b[1]]) {
            assert!((value - exact).abs() <= 2e-14, "{t}: {value} {exact}");
        }
        assert!((row[stored] - energy).abs() <= 1e-12 * energy.abs().max(1.0));
    }
    assert!(turns >= 5.0, "{turns}");
}

#[test]
fn a_bead_climbs_its_hoop_as_the_integral_of_its_energy_says() {
    let (radius, omega, g, rate) = (0.5_f64, 6.0_f64, 9.81_f64, 2.0_f64);
    let mut bead = problem("bead_on_hoop", &[]);
    bead.set_initial("y", -radius).unwrap();
    bead.set_initial("x.rate", radius * rate).unwrap();
    bead.set_tolerance(TIGHTEST);
    bead.end.time = 0.25;
    bead.record.every = Some(0.01);
    bead.record.columns.outputs = true;
    let run = run(&bead);
    let [angle, force] = ["angle", "hoop.force"].map(|name| column(&run, name));
    let square = |angle: f64| {
        rate * rate + (omega * angle.sin()).powi(2) + 2.0 * g / radius * (angle.cos() - 1.0)
    };
    let m = 0.2;
    for (k, &t) in run.trajectory.t.iter().enumerate() {
        let row = run.trajectory.row(k);
        let now = row[angle];
        let time = integral(|angle| square(angle).sqrt().recip(), 0.0, now);
        assert!((time - t).abs() <= 1e-13, "{t}: {:e}", time - t);
        assert!((row[0].hypot(row[1]) - radius).abs() <= 1e-15);
        // Outwards: against the weight, the centrifugal force of the hoop and that of the motion along it.
        let exact =
            -m * (radius * square(now) + radius * (omega * now.sin()).powi(2) + g * now.cos());
        assert!(
            (row[force] - exact).abs() <= 1e-12,
            "{t}: {} {exact}",
            row[force]
        );
    }
    let mut resting = problem("bead_on_hoop", &[("c", 0.5)]);
    resting.set_initial("x", 0.3).unwrap();
    resting.set_initial("y", -0.4).unwrap();
    resting.set_tolerance(TIGHTEST);
    resting.end.time = 60.0;
    let run = crate::common::run(&resting);
    let exact = g / (omega * omega * radius);
    assert!((-run.end.state.q[1] / radius - exact).abs() <= 1e-13);
}

#[test]
fn a_woodpecker_pecks_as_matrix_exponentials_say_under_both_laws() {
    let reference = reference("woodpecker");
    let cases = reference["cases"].as_array().unwrap();
    for (case, method) in cases
        .iter()
        .flat_map(|case| [Method::Taylor, Method::Radau].map(|method| (case, method)))
    {
        let parameters = ["mu", "e_sleeve"].map(|name| (name, number(&case[name])));
        let mut woodpecker = problem("woodpecker", &parameters);
        for (name, value) in case["initial"].as_object().unwrap() {
            woodpecker.set_initial(name, number(value)).unwrap();
        }
        woodpecker.collisions.law = match case["law"].as_str().unwrap() {
            "poisson" => ImpactLaw::Poisson,
            _ => ImpactLaw::Newton,
        };
        woodpecker.method = method;
        woodpecker.set_tolerance(TIGHTEST);
        woodpecker.end.time = number(&case["end"]);
        let run = run(&woodpecker);
        let exact = case["events"].as_array().unwrap();
        assert_eq!(run.events.len(), exact.len());
        let demand = if method == Method::Taylor {
            1e-13
        } else {
            1e-11
        };
        for (event, exact) in run.events.iter().zip(exact) {
            let off = event.t - number(&exact["t"]);
            assert!(off.abs() <= demand, "{method:?}, {}: {off:e}", event.t);
            assert_eq!(event.transition, exact["transition"].as_str().unwrap());
            assert_eq!(
                run.layout.modes.name(event.to),
                exact["mode_after"].as_str().unwrap()
            );
            // The stiff spring at the light sleeve: rates up to 10 rad/s, accelerations up to 1e6 rad/s².
            let sides = [
                (&event.after.q, "q", 10.0 * demand),
                (&event.after.v, "u_after", 1e6 * demand),
            ];
            for (state, key, demand) in sides {
                for (value, exact) in state.iter().zip(numbers(&exact[key])) {
                    assert!(
                        (value - exact).abs() <= demand,
                        "{}: {key} {value} {exact}",
                        event.t
                    );
                }
            }
        }
        let energy = run.energy.expect("a ledger");
        assert!(
            energy.imbalance().abs() <= 1e-15,
            "{:e}",
            energy.imbalance()
        );
    }
}

#[test]
fn a_rod_slides_or_lifts_as_the_reaction_of_its_end_says() {
    let reference = reference("06_painleve_rod");
    let mut judged = 0;
    for case in reference["reference"]["classification"].as_array().unwrap() {
        let of = |key: &str| number(&case[key]);
        let (theta, rate, mu) = (of("theta_deg").to_radians(), of("thetadot"), of("mu"));
        let sign = case["slip_sign"].as_f64().unwrap();
        let class = case["class"].as_str().unwrap();
        if !class.starts_with("unique") {
            continue;
        }
        let mut rod = problem("rod", &[("mu", mu)]);
        // The lower end slips at 1 m/s and neither lifts nor falls.
        for (name, value) in [
            ("y", theta.sin()),
            ("theta", theta),
            ("theta.rate", rate),
            ("x.rate", sign - rate * theta.sin()),
            ("y.rate", rate * theta.cos()),
        ] {
            rod.set_initial(name, value).unwrap();
        }
        rod.end.time = 1e-6;
        rod.record.every = Some(1e-6);
        rod.record.columns.outputs = true;
        let run = run(&rod);
        let (mode, force) = (run.trajectory.mode[0], column(&run, "lower.normal"));
        let name = &run.layout.modes.name(mode);
        let expected = match class {
            "unique detachment" => "lower open, upper open",
            _ => "lower slides, upper open",
        };
        assert_eq!(name, expected, "{case}");
        let (b, inverse) = (of("b"), of("B_times_m"));
        let exact = if b < 0.0 { -b / inverse } else { 0.0 };
        let normal = run.trajectory.row(0)[force];
        assert!(
            (normal - exact).abs() <= 1e-12 * exact.max(1.0),
            "{normal} {exact}"
        );
        judged += 1;
    }
    assert!(judged > 40, "{judged}");
}

/// A crank that turns, with the ideal joint or with clearance, whose pin begins in the middle of its bearing.
fn slider_crank(joint: &str, parameters: &[(&str, f64)]) -> Problem {
    let mut problem = problem("slider_crank", parameters);
    problem.choose(&[("joint", joint)]).unwrap();
    let (r, l, angle, rate) = (0.3_f64, 0.8_f64, 0.5_f64, 12.0_f64);
    let rod = (-r * angle.sin() / l).asin();
    let crank = [0.5 * r * angle.cos(), 0.5 * r * angle.sin()];
    let half = [0.5 * l * rod.cos(), 0.5 * l * rod.sin()];
    for (name, value) in [
        ("crank_x", crank[0]),
        ("crank_y", crank[1]),
        ("crank_angle", angle),
        ("crank_angle.rate", rate),
        ("rod_x", 2.0 * crank[0] + half[0]),
        ("rod_y", 2.0 * crank[1] + half[1]),
        ("rod_angle", rod),
        ("slider_x", 2.0 * (crank[0] + half[0])),
        // What the ideal joint makes of the rates of all.
        ("crank_x.rate", -crank[1] * rate),
        ("crank_y.rate", crank[0] * rate),
    ] {
        problem.set_initial(name, value).unwrap();
    }
    let rod_rate = -r * angle.cos() * rate / (l * rod.cos());
    for (name, value) in [
        ("rod_angle.rate", rod_rate),
        ("rod_x.rate", -2.0 * crank[1] * rate - half[1] * rod_rate),
        ("rod_y.rate", 2.0 * crank[0] * rate + half[0] * rod_rate),
        (
            "slider_x.rate",
            -2.0 * (crank[1] * rate + half[1] * rod_rate),
        ),
    ] {
        problem.set_initial(name, value).unwrap();
    }
    problem.project = true;
    problem.set_tolerance(1e-10);
    problem.record.columns.outputs = true;
    problem.record.every = Some(0.01);
    problem
}

#[test]
fn a_joint_with_clearance_keeps_its_laws_and_nears_the_ideal_one() {
    let mut ideal = slider_crank("ideal", &[]);
    ideal.end.time = 0.2;
    let ideal = run(&ideal);
    let mut off = Vec::new();
    for clearance in [4e-4, 1e-4] {
        let given = [("clearance", clearance), ("mu", 0.0)];
        let mut loose = slider_crank("clearance", &given);
        loose.end.time = 0.2;
        let run = run(&loose);
        let [gap, normal] = ["pin.gap", "pin.normal"].map(|name| column(&run, name));
        for k in 0..run.trajectory.len() {
            let row = run.trajectory.row(k);
            // Places of about 1 m.
            assert!(row[gap] >= -1e-15 && row[normal] >= -1e-10);
            assert!(row[gap] <= 1e-15 || row[normal] == 0.0);
        }
        assert!(run.tally.count("pin strikes") > 0);
        let energy = run.energy.expect("a ledger");
        assert!(energy.imbalance().abs() <= 1e-8, "{:e}", energy.imbalance());
        assert!(energy.lost_at_impacts >= 0.0);
        off.push((run.end.state.q[2] - ideal.end.state.q[2]).abs());
    }
    assert!(off[0] <= 2e-2 && off[1] <= 0.4 * off[0], "{off:?}");
}
