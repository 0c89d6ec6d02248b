//! The tank's bodies as the table of its derivation lists them, coded once more by hand.

use dalembert::hybrid::Problem;

/// Parameters by name.
pub struct Tank {
    pub m_0: f64,
    pub m_i: f64,
    pub m_e: f64,
    pub m_rb: f64,
    pub m_s: f64,
    pub r_0: f64,
    pub r_i: f64,
    pub r_s: f64,
    pub alpha_0: f64,
    pub alpha_i: f64,
    pub alpha_s: f64,
    pub mu_s: f64,
    pub mu_k: f64,
    pub g: f64,
}

/// State of the tank, and the velocity of the ground.
#[derive(Clone, Copy)]
pub struct Motion {
    pub theta: f64,
    pub x_i: f64,
    pub theta_rate: f64,
    pub x_i_rate: f64,
    pub x_rate: f64,
    pub side: f64,
    pub ground_velocity: f64,
    /// Of the ground, upwards.
    pub rise: f64,
}

impl Tank {
    pub fn of(problem: &Problem) -> Self {
        let p = |name| problem.parameters[problem.model.parameter(name).unwrap()];
        Tank {
            m_0: p("M_0"),
            m_i: p("M_I"),
            m_e: p("M_E"),
            m_rb: p("M_rb"),
            m_s: p("M_S"),
            r_0: p("R_0"),
            r_i: p("R_I"),
            r_s: p("R_S"),
            alpha_0: p("alpha_0"),
            alpha_i: p("alpha_I"),
            alpha_s: p("alpha_S"),
            mu_s: p("mu_s"),
            mu_k: p("mu_k"),
            g: p("g"),
        }
    }

    /// Mass of tank and contents.
    pub fn mass(&self) -> f64 {
        self.m_0 + self.m_s
    }

    /// Horizontal momentum in the inertial frame.
    pub fn horizontal_momentum(&self, m: &Motion) -> f64 {
        let u = m.x_rate + m.ground_velocity;
        let rocking = u - m.side * self.r_i * (self.alpha_i - m.theta).cos() * m.theta_rate
            + m.x_i_rate * m.theta.cos()
            - m.x_i * m.theta.sin() * m.theta_rate;
        let shell = u - m.side * self.r_s * (self.alpha_s - m.theta).cos() * m.theta_rate;
        self.m_rb * rocking + (self.m_i - self.m_rb) * (u + m.x_i_rate) + self.m_s * shell
    }

    /// Vertical momentum in the inertial frame.
    pub fn vertical_momentum(&self, m: &Motion) -> f64 {
        let arm = |r: f64, alpha: f64| r * (alpha - m.theta).sin() * m.theta_rate;
        let bulging = m.side * (m.x_i_rate * m.theta.sin() + m.x_i * m.theta.cos() * m.theta_rate);
        self.m_e * arm(self.r_0, self.alpha_0)
            + self.m_rb * bulging
            + self.m_s * arm(self.r_s, self.alpha_s)
            + self.mass() * m.rise
    }

    /// Moment that holds θ = 0 on the pivot's edge, from the accelerations of the bulging, of the base, and of the ground
    /// upwards.
    pub fn holding_moment(
        &self,
        m: &Motion,
        [x_i_acceleration, u_acceleration, rising]: [f64; 3],
    ) -> f64 {
        let weight = self.m_e * self.r_0 * self.alpha_0.sin()
            + self.m_rb * m.side * m.x_i
            + self.m_s * self.r_s * self.alpha_s.sin();
        let rocking = self.m_rb * self.r_i * self.alpha_i.cos();
        let shell = self.m_s * self.r_s * self.alpha_s.cos();
        (self.g + rising) * weight
            - m.side * (rocking * (x_i_acceleration + u_acceleration) + shell * u_acceleration)
    }
}
