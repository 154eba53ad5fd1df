"""What motion in central potentials refuses by name, and its pictures."""

from typing import Any

import numpy as np
import pytest
from nearness import close

import visviva as vv
from visviva.potentials import Coulomb, LennardJones, Yukawa


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ({"energy": np.nan, "angular_momentum": 1.0}, "energy"),
        ({"energy": -0.1, "angular_momentum": -1.0}, "angular_momentum"),
        ({"energy": -0.1, "angular_momentum": 1.0, "mass": 0.0}, "mass"),
        ({"energy": [0.1, 0.2], "angular_momentum": [1.0, 1.0, 1.0]}, "angular_momentum"),
    ],
)
def test_bad_input_is_refused_by_name(arguments: dict[str, Any], name: str) -> None:
    with pytest.raises(vv.InvalidInput, match=f"^{name}"):
        vv.orbits.radial_motion(Coulomb(-1.0), **arguments)


def test_what_else_is_refused() -> None:
    lj = LennardJones(1.0, 1.0)
    with pytest.raises(vv.InvalidInput, match=r"near.*to"):
        vv.orbits.radial_motion(lj, energy=0.1, angular_momentum=1.5)
    with pytest.raises(vv.InvalidInput, match=r"end.*range of motion, which is"):
        vv.orbits.time_of_flight(lj, 1.2, 9.0, energy=0.1, angular_momentum=1.5)
    with pytest.raises(vv.InvalidInput, match=r"radius.*attracts"):
        vv.orbits.circular_orbit(Coulomb(1.0), 1.0)
    with pytest.raises(vv.InvalidInput, match="potential"):
        vv.orbits.radial_motion([], energy=0.1, angular_momentum=1.5)
    with pytest.raises(vv.InvalidInput, match="position"):
        vv.orbits.central_orbit(lj, position=[0.0, 0.0, 0.0], velocity=[1.0, 0.0, 0.0])
    fall = vv.orbits.central_orbit(Coulomb(-1.0), position=[2.0, 0.0, 0.0], velocity=[0.0, 0.0, 0.0])
    close(fall.position(2.5707963267948966), [1.0, 0.0, 0.0], 1e-13)
    with pytest.raises(vv.InvalidInput, match="before the motion ends"):
        fall.position(4.0)
    with pytest.raises(vv.InvalidInput, match="radial motion"):
        fall.radius(1.0)


def test_pictures() -> None:
    pytest.importorskip("matplotlib")
    for potential, speed in ((Yukawa(-1.0, 2.0), 0.7), (Coulomb(-1.0), 1.9)):
        orbit = vv.orbits.central_orbit(potential, position=[1.0, 0, 0], velocity=[0.1, speed, 0])
        nearest = orbit.radius(-orbit.angle_since_pericenter)
        close(nearest, orbit.turning_points[0], 4e-16)
        for kind in ("orbit", "effective_potential"):
            figure = orbit.plot(kind)
            assert orbit.plot(kind, ax=figure.axes[0]) is figure
            figure.canvas.draw()
    with pytest.raises(vv.InvalidInput, match="kind"):
        orbit.plot("orbits")


@pytest.mark.parametrize("mass", [1.0, 0.3])
def test_where_every_distance_is_a_circle(mass: float) -> None:
    """V = −l²/2mr² and E = 0: the radial energy is 0 everywhere, and rounding makes no ends."""
    force = vv.potentials.PowerLaw(-0.5 / mass, 2.0)
    (everywhere,) = vv.orbits.range_of_motion(force, energy=0.0, angular_momentum=1.0, mass=mass)
    assert (everywhere.r_min, everywhere.r_max, everywhere.kind) == (0.0, np.inf, "circular")
    # A little less of the force, or more: it is pushed away, or falls.
    for strength, kind in ((-0.49, "escapes"), (-0.51, "reaches_the_center")):
        parts = vv.orbits.range_of_motion(
            vv.potentials.PowerLaw(strength / mass, 2.0),
            energy=0.1 if kind == "escapes" else -0.1,
            angular_momentum=1.0,
            mass=mass,
        )
        assert [part.kind for part in parts] == [kind]
