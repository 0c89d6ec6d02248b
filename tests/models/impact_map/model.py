"""Up to four contacts of any kind on five coordinates: a map of an impact, given by its matrices."""

from codegen.model import *

model = Model("Map of an impact", source="Moreau, J. J. (1988), Unilateral contact and dry friction in finite freedom dynamics, CISM 302, 1-82")

BODIES, CONTACTS, ROUGH = 5, 4, 2
q = [model.coordinate(f"q_{i}", "m", "a place") for i in range(1, BODIES + 1)]
spare = [model.coordinate(f"s_{k}", "m", "what a smooth contact slips along") for k in range(1, ROUGH + 1)]
for i, x in enumerate(q, 1):
    mass = model.parameter(f"m_{i}", "kg", 1.0, "mass", above=0)
    model.kinetic(mass * x.rate**2 / 2)
for x in spare:
    model.kinetic(model.parameter(f"m_{x.name()}", "kg", 1.0, "mass", above=0) * x.rate**2 / 2)
for k in range(1, CONTACTS + 1):
    along = lambda what, default: sum(
        model.parameter(f"{what}_{k}_{i}", "1", default, "change with a place") * x for i, x in enumerate(q, 1))
    gap = along("normal", 0.0) + model.parameter(f"away_{k}", "m", 1.0, "gap at the places 0", minimum=0)
    e = model.parameter(f"e_{k}", "1", 0.0, "restitution", minimum=0, maximum=1)
    if k <= ROUGH:
        slip = along("tangent", 0.0) + model.parameter(f"smooth_{k}", "1", 1.0, "1: without friction") * spare[k - 1]
        mu = model.parameter(f"mu_{k}", "1", 0.0, "friction", minimum=0)
        back = model.parameter(f"back_{k}", "1", 0.0, "tangential restitution", minimum=0, maximum=1)
        model.contact(f"c_{k}", gap=gap, slip=slip, kinetic=mu, restitution=e, tangential_restitution=back)
    else:
        model.contact(f"c_{k}", gap=gap, restitution=e)
