"""A run that resolved nothing does not end without a word, and a run that is fine is not spoken to.

Bounds: velocities that drag took are given back with the rounding of what was left of them, 1e-12 of it at rtol,
which backward in time grows as they do, a million times and more.
"""

import warnings
from typing import Any

import numpy as np
import pytest

import visviva as vv

PLANETS = vv.problems.outer_solar_system().scene


def step_named(message: str) -> float:
    return float(message.split("dt = ")[2].split(",", maxsplit=1)[0])


@pytest.mark.parametrize(
    ("scene", "t", "method", "dt"),
    [
        (PLANETS, 1e5, "stormer13", 100.0),
        (PLANETS, 1e5, "stormer13", 200.0),
        (PLANETS, 1e5, "leapfrog", 1000.0),
        (vv.problems.kepler(e=0.6).scene, 30.0, "rk4", 1.0),
        (vv.problems.kepler(e=0.9).scene, 30.0, "yoshida4", 0.3),
    ],
)
def test_a_step_that_resolves_nothing_is_named_and_so_is_one_that_does(
    scene: vv.Scene, t: float, method: str, dt: float
) -> None:
    with pytest.warns(vv.AccuracyWarning, match="kinetic") as caught:
        scene.run(t=t, method=method, dt=dt)
    assert caught[0].filename == __file__
    assert "an adaptive method (verner98)" in str(caught[0].message)
    better = step_named(str(caught[0].message))
    assert better < dt
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene.run(t=t, method=method, dt=better)


def test_the_copy_is_named() -> None:
    """The third copy is twenty times smaller and ninety times faster: a step is as long as its period."""
    scene = vv.problems.kepler(e=0.3).scene
    position = np.repeat(scene.particles.position[None], 3, axis=0)
    position[2] *= 0.05
    with pytest.warns(vv.AccuracyWarning, match="in copy 2"):
        scene.ensemble(position=position).run(t=20.0, method="leapfrog", dt=0.05)


def test_a_step_longer_than_the_run_is_said() -> None:
    with pytest.warns(vv.AccuracyWarning, match="longer than the run"):
        PLANETS.run(t=5.0, method="kahan_li8", dt=10.0)


@pytest.mark.parametrize(
    ("scene", "t", "how"),
    [
        (vv.problems.pythagorean().scene, 70.0, {"method": "dop853", "rtol": 0.1}),
        (PLANETS, 1e6, {"method": "bogacki_shampine32", "rtol": 1.0}),
    ],
)
def test_a_tolerance_that_resolves_nothing_is_said(scene: vv.Scene, t: float, how: dict[str, object]) -> None:
    with pytest.warns(vv.AccuracyWarning, match="rtol"):
        scene.run(t=t, **how)


BALLS = vv.Particles([1.0, 1.0], [[0, 0, 0], [1.0, 0, 0]], [[50.0, 0, 0], [0, 3.0, 0]])
DAMPED = [
    (vv.LinearDrag(0.1), vv.UniformField((0.0, 0.0, -9.8))),
    (vv.QuadraticDrag(0.5),),
    (vv.Spring(i=0, j=1, k=1.0), vv.Damper(i=0, j=1, c=5.0)),
    (vv.Drag(density=1e-3, viscosity=1.0, radius=1.0), vv.UniformMagneticField((0.0, 0.0, 1.0))),
]


@pytest.mark.parametrize("forces", DAMPED)
def test_energy_that_grows_where_forces_take_it_is_said(forces: tuple[vv.forces.Force, ...]) -> None:
    """Beyond the limit of stability every step multiplies a velocity by more than one: 1e229 came with status OK."""
    scene = vv.Scene(BALLS, *forces)
    with pytest.warns(vv.AccuracyWarning, match="kinetic") as caught:
        scene.run(t=0.4, method="rk4", dt=0.4)
    assert 0.0 < step_named(str(caught[0].message)) < 0.4
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene.run(t=0.4, method="rk4", dt=0.001)


@pytest.mark.parametrize("forces", DAMPED)
def test_energy_that_comes_back_is_not_blamed(forces: tuple[vv.forces.Force, ...]) -> None:
    """Backward in time drag gives what it took; forward it may take nearly all."""
    scene = vv.Scene(BALLS, *forces)
    out = scene.run(t=1.0, rtol=1e-12)
    back = vv.Scene(out.final.particles, *forces, t0=1.0)
    np.testing.assert_allclose(back.run(t=0.0, rtol=1e-12).velocity[-1], BALLS.velocity, rtol=0, atol=1e-4)


FROM_REST = {
    "bungee": ((vv.Harmonic(4.0), vv.UniformField((0.0, 0.0, -9.8))), np.pi),
    "cycloid": ((vv.UniformElectricField((0.0, 1.0, 0.0)), vv.UniformMagneticField((0.0, 0.0, 1.0))), 2.0 * np.pi),
    "quartic": ((vv.ExpressionForce(potential=lambda r, v, t: r[2] ** 4 / 4.0 + r[2]), vv.LinearDrag(1e14)), 4.3273635),
}


@pytest.mark.parametrize("how", [{"method": "rk4", "dt": 0.01}, {"method": "verner98"}, {"method": "dop853"}])
@pytest.mark.parametrize("motion", FROM_REST)
def test_a_motion_that_comes_back_to_rest_is_not_blamed(motion: str, how: dict[str, Any]) -> None:
    """At both ends all energies are zero but for rounding, of which every part was off by one."""
    forces, period = FROM_REST[motion]
    start = vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[0.0, 0.0, 0.0]])
    out = vv.Scene(start, *forces).run(t=period, **how)
    assert np.abs(out.velocity[-1]).max() < 1e-4


def test_a_named_step_is_never_longer_than_the_run() -> None:
    with pytest.warns(vv.AccuracyWarning) as caught:
        vv.problems.kepler(e=0.6).scene.run(t=1.0, method="rk4", dt=1e308)
    steps = [step_named(str(warning.message)) for warning in caught if "kinetic" in str(warning.message)]
    assert all(step < 1.0 for step in steps)


def test_accurate_adaptive_and_closed_runs_are_not_spoken_to() -> None:
    PLANETS.run(t=1e4)
    vv.problems.kepler(e=0.9).scene.run(t=1.0)
