//! The motion of a mode from a state, and what depends on it, order by order.

use super::ORDERS;
use crate::input::Signals;
use crate::kernel::Context;
use crate::model::{Mode, Operands, Powers, Tape};
use crate::numerics::{self, Bounded, Dynamic, Lu, Size};

/// Where an expansion starts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Point<'a> {
    /// All coordinates.
    pub q: &'a [f64],
    /// All velocities.
    pub v: &'a [f64],
    /// All coordinates where the mode holds them, or where they were as it began; then the prescribed motions, where some mode needs them.
    pub held: &'a [f64],
    /// Rates of these; empty where nothing drifts.
    pub drift: &'a [f64],
    /// Discrete states.
    pub discrete: &'a [f64],
}

/// Room for the Taylor coefficients of a motion.
#[derive(Debug)]
pub(crate) struct Expansion {
    given: Operands,
    /// Coefficients of the signals, a row an order and one more.
    signal_rows: Box<[f64]>,
    /// Of each signal: it is wanted.
    wanted: Box<[bool]>,
    /// Coefficients of the instructions of the system of a mode.
    system: Vec<Powers>,
    /// Of what depends on the motion.
    others: Vec<Powers>,
    /// Inverse of the mass matrix at the start, row by row.
    inverse: Box<[f64]>,
    /// What the equations ask of the accelerations, these, and what they leave.
    rest: Box<[Bounded]>,
    accelerations: Box<[f64]>,
    left: Box<[f64]>,
}

impl Expansion {
    /// Room for a model with so many coordinates, prescribed motions and signals, at some parameters.
    pub fn new([coordinates, motions, signals]: [usize; 3], parameters: &[f64]) -> Self {
        let rows = |count: usize| vec![Powers::default(); count];
        Expansion {
            given: Operands {
                q: rows(coordinates),
                held: rows(coordinates + motions),
                v: rows(coordinates),
                a: rows(coordinates),
                signals: rows(signals),
                discrete: Vec::new(),
                parameters: parameters.into(),
            },
            signal_rows: vec![0.0; (ORDERS + 1) * signals].into(),
            wanted: vec![true; signals].into(),
            system: Vec::new(),
            others: Vec::new(),
            inverse: vec![0.0; coordinates * coordinates].into(),
            rest: vec![Bounded::default(); coordinates].into(),
            accelerations: vec![0.0; coordinates].into(),
            left: vec![0.0; coordinates].into(),
        }
    }

    /// Goes over to other parameters.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        self.given.parameters.copy_from_slice(parameters);
    }

    /// Sets the inputs to those just after time `t` (s), for which the context is set.
    pub fn set_signals(&mut self, context: &Context, signals: &Signals, t: f64) {
        let width = self.given.signals.len();
        self.signal_rows.fill(0.0);
        if width == 0 || context.autonomous {
            self.given.signals.fill(Powers::default());
            return;
        }
        let known = [context.signals(), context.signal_rates()];
        signals.series(t, known, &self.wanted, &mut self.signal_rows);
        for k in 0..ORDERS {
            let [row, next] = [k, k + 1].map(|k| &self.signal_rows[k * width..][..width]);
            for (signal, (&value, &next)) in self.given.signals.iter_mut().zip(row.iter().zip(next))
            {
                // The time is rounded, and an order of a recurrence adds a product.
                let slope = (k + 1) as f64 * next;
                let of_time = Bounded::rounded(slope * t, 1.0, 0.0).error;
                signal[k] = Bounded::rounded(value, (k + 1) as f64, of_time);
            }
        }
    }

    /// Begins at a state whose numbers are known to a rounding of themselves; or, given typical sizes of coordinates and
    /// rates, as a step of the motion leaves them. What the mode holds is exact.
    pub fn begin(&mut self, mode: &Mode, at: Point, sizes: Option<[&[f64]; 2]>) {
        let given = &mut self.given;
        given.discrete.clear();
        given.discrete.extend_from_slice(at.discrete);
        for i in 0..at.q.len() {
            let known = |value: f64, of: usize| match sizes {
                _ if !mode.free.contains(&i) => Bounded::exact(value),
                None => Bounded::rounded(value, 1.0, 0.0),
                Some(sizes) => Bounded::of_polynomial(value, numerics::ORDERS, sizes[of][i]),
            };
            given.q[i] = Powers::default();
            given.v[i] = Powers::default();
            given.a[i] = Powers::default();
            given.q[i][0] = known(at.q[i], 0);
            given.v[i][0] = known(at.v[i], 1);
            given.q[i][1] = given.v[i][0];
        }
        for (i, &place) in at.held.iter().enumerate() {
            given.held[i] = Powers::default();
            given.held[i][0] = Bounded::exact(place);
            given.held[i][1] = Bounded::exact(at.drift.get(i).copied().unwrap_or(0.0));
        }
        for (rows, tape) in [
            (&mut self.system, &mode.system),
            (&mut self.others, &mode.guard_values),
        ] {
            let count = tape.instructions.len();
            if rows.len() < count {
                rows.resize(count, Powers::default());
            }
        }
    }

    /// Goes on with the coefficients of order `k` of the motion's accelerations and of what a tape gives.
    pub fn expand(&mut self, mode: &Mode, tape: &Tape, k: usize) {
        self.move_on(mode, k);
        if self.others.len() < tape.instructions.len() {
            self.others
                .resize(tape.instructions.len(), Powers::default());
        }
        tape.expand(k, &self.given, &mut self.others);
    }

    /// What the last tape gives, by the index of the result.
    pub fn result(&self, tape: &Tape, index: usize) -> &Powers {
        &self.others[tape.results[index]]
    }

    /// Coefficients of the acceleration of a coordinate.
    pub fn acceleration(&self, coordinate: usize) -> &Powers {
        &self.given.a[coordinate]
    }

    /// Lets nothing be known of what follows where the mass matrix may be singular within the errors ΔM of its entries. What is solved by
    /// it is off by |M⁻¹| times what is left of the equations as long as B = |M⁻¹| ΔM is well below 1 (Neumann's series): where its
    /// spectral radius is. That is at most the 8th root of the largest row sum of B⁸, which hardly depends on units.
    fn check_inverse(&mut self, mode: &Mode) {
        let count = mode.free.len();
        let error = |i: usize, j: usize| self.system[mode.system.results[count * j + i]][0].error;
        let (sums, products) = (&mut self.accelerations[..count], &mut self.left[..count]);
        sums.fill(1.0);
        for _ in 0..8 {
            for (i, product) in products.iter_mut().enumerate() {
                *product = (0..count).map(|j| error(i, j) * sums[j]).sum();
            }
            for (i, sum) in sums.iter_mut().enumerate() {
                let inverse = |j: usize| self.inverse[i * count + j].abs();
                *sum = (0..count).map(|j| inverse(j) * products[j]).sum();
            }
        }
        let is_regular = sums.iter().all(|&sum| sum < 0.5f64.powi(8));
        if !is_regular {
            self.inverse[..count * count].fill(f64::NAN);
        }
    }

    /// The accelerations of order `k`, and rates and coordinates that follow from them.
    fn move_on(&mut self, mode: &Mode, k: usize) {
        let free = &mode.free;
        let count = free.len();
        mode.system.expand(k, &self.given, &mut self.system);
        if k == 0 {
            let mass =
                |i: usize, j: usize| self.system[mode.system.results[count * j + i]][0].value;
            let ones = Dynamic(count).repeat(1.0);
            match Lu::<f64, Dynamic>::factorize(mass, &ones) {
                Ok(mass) => mass.inverse(|i, j, entry| self.inverse[i * count + j] = entry),
                // Then nothing is known of what follows: errors without bound.
                Err(_) => self.inverse[..count * count].fill(f64::NAN),
            }
            self.check_inverse(mode);
        }
        let entry = |place: usize| &self.system[mode.system.results[place]];
        // M₀ a_k + rest = 0.
        let rest = &mut self.rest[..count];
        for (i, rest) in rest.iter_mut().enumerate() {
            *rest = entry(count * count + i)[k];
            for (j, &coordinate) in free.iter().enumerate() {
                let (mass, a) = (entry(count * j + i), &self.given.a[coordinate]);
                *rest = (1..=k).fold(*rest, |sum, n| sum + mass[n] * a[k - n]);
            }
        }
        let a = &mut self.accelerations[..count];
        for (i, a) in a.iter_mut().enumerate() {
            *a = -(0..count)
                .map(|j| self.inverse[i * count + j] * rest[j].value)
                .sum::<f64>();
        }
        // What these leave of the equations, times the inverse, is their error.
        let left = &mut self.left[..count];
        for (i, left) in left.iter_mut().enumerate() {
            let residual = (0..count).fold(rest[i], |sum, j| {
                sum + entry(count * j + i)[0] * Bounded::exact(a[j])
            });
            *left = residual.value.abs() + residual.error;
        }
        let given = &mut self.given;
        for (i, &coordinate) in free.iter().enumerate() {
            let error = (0..count)
                .map(|j| self.inverse[i * count + j].abs() * left[j])
                .sum::<f64>();
            let acceleration = Bounded { value: a[i], error };
            given.a[coordinate][k] = acceleration;
            if k + 1 < ORDERS {
                let rate = acceleration / Bounded::exact((k + 1) as f64);
                given.v[coordinate][k + 1] = rate;
                if k + 2 < ORDERS {
                    given.q[coordinate][k + 2] = rate / Bounded::exact((k + 2) as f64);
                }
            }
        }
    }
}
