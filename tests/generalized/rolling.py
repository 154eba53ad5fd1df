"""What rolls: of several tests."""

import visviva as vv

MASS, RADIUS, STIFFNESS = 2.0, 0.5, 3.0


def cylinder_on_a_spring(x: float = 0.0, angle: float = 0.0) -> vv.Lagrangian:
    """A full cylinder that rolls on a line, as if it were half as heavy again."""
    return vv.Lagrangian(
        lambda q, v, t: MASS * (v[0] ** 2 + (RADIUS * v[1]) ** 2 / 2) / 2 - STIFFNESS * q[0] ** 2 / 2,
        ["x", "phi"],
        nonholonomic=[lambda q, v, t: v[0] - RADIUS * v[1]],
        position=[x, angle],
    )
