"""Two point masses on massless rods, angles from the vertical: the textbook's equations."""

from codegen.verify import Paper, group

paper = Paper("Double pendulum", "any textbook of analytical mechanics",
              sets={"unit": {"m_1": "1", "m_2": "2", "l_1": "1", "l_2": "0.75", "g": "9.80665"}},
              box={"theta_1": (-3.2, 3.2), "theta_2": (-3.2, 3.2)})
paper.coordinate("theta_1", "rad", "angle of the upper rod from the vertical", mirror=-1)
paper.coordinate("theta_2", "rad", "angle of the lower rod from the vertical", mirror=-1)
paper.parameter("m_1", "kg", "upper mass")
paper.parameter("m_2", "kg", "lower mass")
paper.parameter("l_1", "m", "length of the upper rod")
paper.parameter("l_2", "m", "length of the lower rod")
paper.parameter("g", "m/s^2", "acceleration of gravity")


@paper.motion("1", of="theta_1", title="Upper rod", latex=r"""
(m_1 + m_2) l_1^2 \ddot{\theta}_1 + m_2 l_1 l_2 \cos(\theta_1 - \theta_2) \ddot{\theta}_2
+ m_2 l_1 l_2 \sin(\theta_1 - \theta_2) \dot{\theta}_2^2 + (m_1 + m_2) g l_1 \sin \theta_1 = 0
""")
def upper(s, m):
    return [
        *group(s.l_1**2 * s.ddtheta_1, s.m_1, s.m_2),
        s.m_2 * s.l_1 * s.l_2 * m.cos(s.theta_1 - s.theta_2) * s.ddtheta_2,
        s.m_2 * s.l_1 * s.l_2 * m.sin(s.theta_1 - s.theta_2) * s.dtheta_2**2,
        *group(s.g * s.l_1 * m.sin(s.theta_1), s.m_1, s.m_2),
    ]


@paper.motion("2", of="theta_2", title="Lower rod", latex=r"""
m_2 l_2^2 \ddot{\theta}_2 + m_2 l_1 l_2 \cos(\theta_1 - \theta_2) \ddot{\theta}_1
- m_2 l_1 l_2 \sin(\theta_1 - \theta_2) \dot{\theta}_1^2 + m_2 g l_2 \sin \theta_2 = 0
""")
def lower(s, m):
    return [
        s.m_2 * s.l_2**2 * s.ddtheta_2,
        s.m_2 * s.l_1 * s.l_2 * m.cos(s.theta_1 - s.theta_2) * s.ddtheta_1,
        -s.m_2 * s.l_1 * s.l_2 * m.sin(s.theta_1 - s.theta_2) * s.dtheta_1**2,
        s.m_2 * s.g * s.l_2 * m.sin(s.theta_2),
    ]
