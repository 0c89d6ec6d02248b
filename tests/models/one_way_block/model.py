"""Newmark's block: it slips downhill only."""

from codegen.model import *

model = Model("Newmark's sliding block", source="Newmark, N. M. (1965), Géotechnique 15(2), 139-160")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
friction = model.parameter("friction", "N", 1.0, "force that holds the block", minimum=0)

s = model.coordinate("s", "m", "slip relative to the ground")
force = model.input("force", "N", "inertial force on the block")
model.point_mass(m, position=(s, 0))
model.force(s, force)

sticks = model.mode("sticks", "moves with the ground", freeze=[s])
slides = model.mode("slides", "slips")
slides.force(s, -friction)
model.transition("slip", sticks, slides, when=falls(friction + sticks.reaction(s)))
model.transition("stick", slides, sticks, when=falls(s.rate))
