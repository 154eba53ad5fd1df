"""Four bodies of which one falls on another, under forces that tell bodies apart: what is left of each is by hand."""

from __future__ import annotations

from typing import Any

import numpy as np

import visviva as vv

GRAVITY = vv.Gravity(1.0)
TIMES = np.linspace(0.0, 1.8, 10)
#: Body 1 falls on body 0, and then body 2 on what they have become; body 3 goes its way.
MASS = [5.0, 1.0, 0.5, 0.2]
POSITION = [[0, 0, 0], [3, 0.05, 0], [0, 4, 0], [-6, 0.3, 0.2]]
VELOCITY = [[0, 0, 0], [-1, 0, 0], [0, -1.0, 0.02], [0, 0.5, 0]]
CHARGE = [1.0, -0.5, 0.25, 0.125]
OBLATE: dict[str, Any] = {"G": 1.0, "axis": [0.1, 0.2, 1.0]}


def slowed(bodies: int | list[int]) -> vv.ExpressionForce:
    """Drag by a gas that turns, on some bodies."""
    return vv.ExpressionForce(
        acceleration=lambda r, v, t, rate: [-rate * (v[0] + r[1] / 4), -rate * (v[1] - r[0] / 4), -rate * v[2]],
        parameters={"rate": 0.2},
        bodies=bodies,
    )


#: A force on four bodies, and that on bodies 0, 2 and 3 when body 1 is a part of body 0.
FORCES: dict[str, tuple[vv.forces.Force, vv.forces.Force | None]] = {
    "oblate host": (vv.Oblate(0, J2=0.01, radius=0.5, **OBLATE), vv.Oblate(0, J2=0.01, radius=0.5, **OBLATE)),
    "oblate part": (vv.Oblate(1, J2=0.01, radius=0.3, **OBLATE), None),
    "several oblate": (
        vv.Oblate([2, 1, 0], J2=[0.01, 0.02, 0.03], radius=[0.3, 0.4, 0.5], J4=[1e-3, 2e-3, 3e-3], **OBLATE),
        vv.Oblate([1, 0], J2=[0.01, 0.03], radius=[0.3, 0.5], J4=[1e-3, 3e-3], **OBLATE),
    ),
    "relativistic part": (vv.PostNewtonian(1, G=1.0, c=20.0), vv.PostNewtonian(0, G=1.0, c=20.0)),
    "both relativistic": (vv.PostNewtonian([1, 3, 0], G=1.0, c=20.0), vv.PostNewtonian([0, 2], G=1.0, c=20.0)),
    "spring between them": (vv.Spring(0, 1, k=0.1, length=1.0), None),
    "springs": (
        vv.Spring([0, 1, 3], [1, 2, 1], k=[0.1, 0.2, 0.3], length=[0.5, 0.0, 2.0]),
        vv.Spring([0, 2], [1, 0], k=[0.2, 0.3], length=[0.0, 2.0]),
    ),
    "dampers": (vv.Damper([0, 1, 3], [1, 2, 1], c=[0.1, 0.2, 0.3]), vv.Damper([0, 2], [1, 0], c=[0.2, 0.3])),
    "charges": (vv.Coulomb(CHARGE, k=0.5), vv.Coulomb([0.5, 0.25, 0.125], k=0.5)),
    "equal charges": (vv.Coulomb(0.5, k=0.5), vv.Coulomb([1.0, 0.5, 0.5], k=0.5)),
    "charges in an electric field": (
        vv.UniformElectricField([0.1, 0.2, 0.3], CHARGE),
        vv.UniformElectricField([0.1, 0.2, 0.3], [0.5, 0.25, 0.125]),
    ),
    "charges in a magnetic field": (
        vv.UniformMagneticField([0.1, 0.2, 0.3], CHARGE),
        vv.UniformMagneticField([0.1, 0.2, 0.3], [0.5, 0.25, 0.125]),
    ),
    # A body goes on as before when others go into it: dragged or not.
    "an acceleration of parts": (slowed([2, 1]), slowed(1)),
    "an acceleration of the host": (slowed([0, 1, 3]), slowed([0, 2])),
    "an acceleration of one that goes": (slowed(1), None),
}
HOW: dict[str, Any] = {"collisions": "merge", "method": "dop853", "rtol": 1e-13}


def falling(*forces: vv.forces.Force) -> vv.Scene:
    return vv.Scene(vv.Particles(MASS, POSITION, VELOCITY, radius=[0.5, 0.3, 0.3, 0.2]), *forces)


def contact(name: str) -> tuple[vv.Trajectory, vv.Scene, vv.Scene]:
    """The run through the first contact, the scene there, and the scene put together by hand of what is left."""
    before, after = FORCES[name]
    out = falling(GRAVITY, before).run(TIMES, **HOW)
    met = falling(GRAVITY, before).run(TIMES[-1], **(HOW | {"collisions": "stop"})).final
    mass, position, velocity = met.particles.mass, met.particles.position.copy(), met.particles.velocity.copy()
    position[0], velocity[0] = (mass[:2] @ of[:2] / mass[:2].sum() for of in (position, velocity))
    there = [0, 2, 3]
    bodies = vv.Particles(
        [6.0, 0.5, 0.2], position[there], velocity[there], radius=[np.cbrt(0.5**3 + 0.3**3), 0.3, 0.2]
    )
    forces = [GRAVITY] if after is None else [GRAVITY, after]
    return out, met, vv.Scene(bodies, *forces, t0=met.t0)
