//! Impacts on two contacts in turn, up to where they come to rest, against references.

use super::multipliers::{check, scenes};
use crate::common::*;
use dalembert::hybrid::Method;
use dalembert::record::ModeNames;

#[test]
fn a_disc_in_a_wedge_strikes_both_sides_in_turn_up_to_its_rest() {
    for (_, scene) in scenes("16b_disc_in_wedge") {
        for method in [Method::Taylor, Method::Radau] {
            let of = |name: &str| number(&scene["parameters"][name]);
            let mut disc = problem(
                "disc_in_wedge",
                &[("R", of("R")), ("mu", of("mu")), ("e", of("e_N"))],
            );
            disc.method = method;
            let [q, u] = ["q", "u"].map(|key| numbers(&scene["initial"][key]));
            for (i, name) in ["x", "y", "theta"].iter().enumerate() {
                disc.set_initial(name, q[i]).unwrap();
                disc.set_initial(&format!("{name}.rate"), u[i]).unwrap();
            }
            disc.set_tolerance(TIGHTEST);
            disc.end.time = number(&scene["t_end"]);
            disc.record.every = Some(0.1);
            let mut run = run(&disc);
            if of("mu") == 0.0 {
                // Without friction there is no difference between what sticks and what slides.
                let names = run.layout.modes.clone();
                let closed = |mode: usize| {
                    let name = names.name(mode);
                    name.replace("sticks", "closed").replace("slides", "closed")
                };
                run.layout.modes = ModeNames::listed((0..names.count()).map(closed).collect());
                let is_of_a_slip = |name: &str| {
                    let verbs = [" sticks", " slips", " reverses"];
                    verbs.iter().any(|verb| name.ends_with(verb))
                };
                run.events.retain(|event| !is_of_a_slip(event.transition));
            }
            if method == Method::Taylor {
                check(&scene, &run, 3, method);
                continue;
            }
            // By Radau's method hops end where its polynomials do not show them any more, some 1e-7 s before the limit.
            let limit = scene["events"].as_array().unwrap().last().unwrap();
            let rest = times(&run, "rest");
            assert_eq!(rest.len(), 1);
            assert!((rest[0] - number(&limit["t"])).abs() <= 1e-8, "{rest:?}");
        }
    }
}

#[test]
fn a_rod_that_falls_on_two_supports_rocks_on_them_or_rests_at_once() {
    for (_, scene) in scenes("16c_rod_on_two_supports") {
        for method in [Method::Taylor, Method::Radau] {
            let of = |name: &str| number(&scene["parameters"][name]);
            let given = [("a", of("a")), ("b", of("b")), ("e", of("e_N"))];
            let mut rod = problem("rod_on_supports", &given);
            rod.method = method;
            let [q, u] = ["q", "u"].map(|key| numbers(&scene["initial"][key]));
            for (i, name) in ["y", "theta"].iter().enumerate() {
                rod.set_initial(name, q[i]).unwrap();
                rod.set_initial(&format!("{name}.rate"), u[i]).unwrap();
            }
            rod.set_tolerance(TIGHTEST);
            rod.end.time = number(&scene["t_end"]);
            rod.record.every = Some(0.05);
            check(&scene, &run(&rod), 2, method);
        }
    }
}
