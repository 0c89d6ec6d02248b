//! Random mechanisms: a cart with a load between ends, a pendulum that strikes a wall, a body that is dropped on one foot or two. Coordinates are named as those of
//! random lines, and so are inputs.

use super::random::Random;
use super::random_models::HEAD;
use std::fmt::Write;

/// The kinds there are.
#[derive(Clone, Copy)]
pub enum Kind {
    /// A cart that rubs, with a load that slides on it between ends.
    Cart,
    /// A pendulum on a slider: the bob strikes walls that stand, or move.
    Pendulum,
    /// A body with feet, and a sprung load on it.
    Feet,
}

/// A model file, and how many coordinates it has.
pub fn mechanism(random: &mut Random, kind: Kind) -> (String, usize) {
    let mut text = HEAD.to_owned();
    text.push_str("g = model.parameter(\"g\", \"m/s^2\", 9.81, \"gravity\", above=0)\n");
    let n = match kind {
        Kind::Cart => cart(random, &mut text),
        Kind::Pendulum => pendulum(random, &mut text),
        Kind::Feet => feet(random, &mut text),
    };
    (text, n)
}

/// Friction coefficients, static and kinetic.
fn friction(random: &mut Random) -> [f64; 2] {
    let holds = random.within(0.1, 0.8);
    [holds, holds * random.within(0.6, 1.0)]
}

/// A restitution, often none.
fn restitution(random: &mut Random) -> f64 {
    random.either(0.0, (0.1, 0.9))
}

fn cart(random: &mut Random, text: &mut String) -> usize {
    let [cart, load] = [(0.5, 3.0), (0.3, 2.0)].map(|(from, to)| random.within(from, to));
    let [[holds, slides], [grips, slips]] = [(); 2].map(|()| friction(random));
    let [e, f] = [(); 2].map(|()| restitution(random));
    let [left, right] = [(); 2].map(|()| random.within(0.05, 0.3));
    let stiffness = random.either(0.0, (5.0, 40.0));
    let weight = cart + load;
    // Of the load, its place on the cart or in the room.
    let (on_cart, in_room) = match random.next().is_multiple_of(2) {
        true => ("x1", "x0 + x1"),
        false => ("(x1 - x0)", "x1"),
    };
    writeln!(
        text,
        "x0 = model.coordinate(\"x0\", \"m\", \"cart\")\n\
         x1 = model.coordinate(\"x1\", \"m\", \"load\")\n\
         model.point_mass({cart:.4} * m, position=(x0, 0 * one))\n\
         model.point_mass({load:.4} * m, position=({in_room}, 0 * one))\n\
         model.potential({stiffness:.4} * k * x0**2 / 2)\n\
         model.force(x0, F)\n\
         model.friction(\"rail\", slip=x0, normal={weight:.4} * m * g, static={holds:.4}, kinetic={slides:.4})\n\
         model.friction(\"tray\", slip={on_cart}, normal={load:.4} * m * g, static={grips:.4}, kinetic={slips:.4})\n\
         model.contact(\"left\", gap={on_cart} + {left:.4} * one, restitution={e:.4})\n\
         model.contact(\"right\", gap={right:.4} * one - {on_cart}, restitution={f:.4})"
    )
    .unwrap();
    2
}

fn pendulum(random: &mut Random, text: &mut String) -> usize {
    let [slider, bob] = [(0.5, 3.0), (0.3, 2.0)].map(|(from, to)| random.within(from, to));
    let [e, f] = [(); 2].map(|()| restitution(random));
    let [at, place] = [(0.05, 0.6), (0.1, 0.5)].map(|(from, to)| random.within(from, to));
    let [damping, stiffness] = [(0.0, 0.5), (5.0, 40.0)].map(|range| random.either(0.0, range));
    // A stop on the rod, a wall on the slider, one in the room, or one that moves.
    let gap = *random.one_of(&[
        "x1 + at",
        "at * one + one * sin(x1)",
        "at * one + x0 + one * sin(x1)",
        "at * one + x0 - z + one * sin(x1)",
    ]);
    let gap = gap.replace("at", &format!("{at:.4}"));
    if gap.contains('z') {
        writeln!(text, "z = model.motion(\"z\", \"a wall\", input=\"a\")").unwrap();
    }
    writeln!(
        text,
        "x0 = model.coordinate(\"x0\", \"m\", \"slider\")\n\
         x1 = model.coordinate(\"x1\", \"rad\", \"angle\")\n\
         model.gravity(g)\n\
         model.point_mass({slider:.4} * m, position=(x0, 0 * one))\n\
         model.point_mass({bob:.4} * m, position=(x0 + one * sin(x1), -one * cos(x1)))\n\
         model.potential({stiffness:.4} * k * x0**2 / 2)\n\
         model.dissipation({damping:.4} * c * x0.rate**2 / 2)\n\
         model.force(x0, F)\n\
         model.contact(\"wall\", gap={gap}, restitution={e:.4})"
    )
    .unwrap();
    match random.next() % 3 {
        0 => writeln!(
            text,
            "model.contact(\"end\", gap={place:.4} * one - x0, restitution={f:.4})"
        ),
        1 => {
            let [holds, slides] = friction(random);
            writeln!(
                text,
                "model.friction(\"rail\", slip=x0, normal={slider:.4} * m * g, static={holds:.4}, kinetic={slides:.4})"
            )
        }
        _ => Ok(()),
    }
    .unwrap();
    2
}

fn feet(random: &mut Random, text: &mut String) -> usize {
    let [body, load] = [(0.5, 3.0), (0.2, 1.0)].map(|(from, to)| random.within(from, to));
    let [wide, high] = [(0.1, 0.4), (0.1, 0.5)].map(|(from, to)| random.within(from, to));
    let [stiffness, damping] =
        [(50.0, 400.0), (0.0, 2.0)].map(|(from, to)| random.within(from, to));
    writeln!(
        text,
        "x0 = model.coordinate(\"x0\", \"m\", \"centre, to the right\")\n\
         x1 = model.coordinate(\"x1\", \"m\", \"centre, upwards\")\n\
         x2 = model.coordinate(\"x2\", \"rad\", \"tilt\")\n\
         model.gravity(g)\n\
         model.rigid_body({body:.4} * m, inertia={body:.4} * m * one**2 / 8, position=(x0, x1), angle=x2)\n\
         model.force(x0, F)"
    )
    .unwrap();
    let (rests, height) = ("0.05 * one", format!("{high:.4}"));
    // One foot under the centre, which may turn, or two.
    let feet: &[(&str, f64)] = match random.next().is_multiple_of(3) {
        true => &[("foot", 0.0)],
        false => &[("left", -1.0), ("right", 1.0)],
    };
    for (name, side) in feet {
        let [holds, slides] = friction(random);
        let e = restitution(random);
        let across = side * wide;
        writeln!(
            text,
            "model.contact(\"{name}\", gap=x1 + {rests} + {across:.4} * one * sin(x2) - {height} * one * (cos(x2) - 1), \
             slip=x0 + {across:.4} * one * cos(x2) + {height} * one * sin(x2), static={holds:.4}, kinetic={slides:.4}, restitution={e:.4})"
        )
        .unwrap();
    }
    if random.next().is_multiple_of(2) {
        writeln!(
            text,
            "x3 = model.coordinate(\"x3\", \"m\", \"load on the body\")\n\
             model.point_mass({load:.4} * m, position=(x0 + x3 * cos(x2), x1 + x3 * sin(x2)))\n\
             model.potential({stiffness:.4} * k * x3**2 / 2)\n\
             model.dissipation({damping:.4} * c * x3.rate**2 / 2)"
        )
        .unwrap();
        return 4;
    }
    3
}
