//! A damped oscillator under a force that is linear in time, exactly (Nigam & Jennings, 1969).

/// u″ + 2ζω u′ + ω² u = f(t).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Oscillator {
    /// ω > 0, rad/s.
    pub omega: f64,
    /// 0 ≤ ζ < 1.
    pub zeta: f64,
}

/// Responses over a time: to unit displacement, unit velocity, unit force and a force that grows by
/// one a second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Responses {
    /// Displacement and velocity after unit displacement; of the first this is 1 − ω² step.
    displaced: [f64; 2],
    /// After unit velocity.
    moved: [f64; 2],
    /// Displacement under unit force; its velocity is that after unit velocity.
    step: f64,
    /// Displacement under the growing force.
    ramp: f64,
}

impl Oscillator {
    /// Responses after a time h ≥ 0, s.
    pub fn responses(&self, h: f64) -> Responses {
        let Oscillator { omega, zeta } = *self;
        let (impulse, impulse_rate, step, ramp) = if omega * h < 1.0 {
            // The closed form cancels for short times: powers of h instead, from the equation.
            let (mut before, mut c) = (0.0, 1.0);
            let (mut impulse, mut rate, mut step, mut ramp) = (0.0, 0.0, 0.0, 0.0);
            let mut power = 1.0;
            // With ω h < 1 the last term is below 1/25! of the sum.
            for k in 1..=25 {
                let n = f64::from(k);
                rate += n * c * power;
                power *= h;
                impulse += c * power;
                step += c * power * h / (n + 1.0);
                ramp += c * power * h * h / ((n + 1.0) * (n + 2.0));
                let next = -(2.0 * zeta * omega * n * c + omega * omega * before) / (n * (n + 1.0));
                (before, c) = (c, next);
            }
            (impulse, rate, step, ramp)
        } else {
            let damped = omega * (1.0 - zeta * zeta).sqrt();
            let decay = (-zeta * omega * h).exp();
            let (sin, cos) = (damped * h).sin_cos();
            let impulse = decay * sin / damped;
            let rate = decay * cos - zeta * omega * impulse;
            let step = (1.0 - decay * cos - zeta * omega * impulse) / (omega * omega);
            let ramp = (h - impulse - 2.0 * zeta * omega * step) / (omega * omega);
            (impulse, rate, step, ramp)
        };
        let square = omega * omega;
        Responses {
            displaced: [1.0 - square * step, -square * impulse],
            moved: [impulse, impulse_rate],
            step,
            ramp,
        }
    }

    /// u″.
    pub fn acceleration(&self, [u, v]: [f64; 2], f: f64) -> f64 {
        f - 2.0 * self.zeta * self.omega * v - self.omega * self.omega * u
    }
}

impl Responses {
    /// Displacement and velocity from those before, under a force and its growth per second.
    pub fn after(&self, [u, v]: [f64; 2], force: f64, slope: f64) -> [f64; 2] {
        [
            self.displaced[0] * u + self.moved[0] * v + self.step * force + self.ramp * slope,
            self.displaced[1] * u + self.moved[1] * v + self.moved[0] * force + self.step * slope,
        ]
    }
}
