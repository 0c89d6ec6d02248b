//! Functions that models are written in.

use crate::common::*;
use dalembert::hybrid::Method;

/// A recurrence that is wrong sends its body elsewhere: the implicit method knows of none.
#[test]
fn the_series_of_every_function_is_that_of_its_values() {
    let ends = |method| {
        let mut bodies = problem("functions", &[]);
        let names: Vec<&str> = bodies.model.coordinates.iter().map(|c| c.name).collect();
        for (k, name) in names.iter().enumerate() {
            bodies
                .set_initial(name, 0.5 - 0.03 * k as f64)
                .expect("a place");
        }
        bodies.set_tolerance(1e-13);
        bodies.method = method;
        bodies.end.time = 3.0;
        let run = run(&bodies);
        let named = |name: &str| (String::from(name), at_end(&run, name));
        names.into_iter().map(named).collect::<Vec<_>>()
    };
    let [taylor, radau] = [Method::Taylor, Method::Radau].map(ends);
    for ((name, one), (_, other)) in taylor.iter().zip(&radau) {
        assert!((one - other).abs() < 1e-12, "{name}: {one} {other}");
    }
}
