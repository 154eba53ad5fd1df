"""Equal steps that resolve nothing of what energies know nothing of are told: under drag, without mass, in a field."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from pathlib import Path

FIELD = vv.UniformMagneticField((0.0, 0.0, 2.0), charge=[0.5, 0.0])
ACROSS = vv.UniformElectricField((0.1, 0.0, 0.0), charge=[0.5, 0.0])


def pair(*masses: float, speed: float = 1.0) -> vv.Particles:
    return vv.Particles(masses, [[1.0, 0.0, 0.0], [4.0, 0.0, 0.0]], [[speed, 0.0, 0.0], [-speed, 0.0, 0.0]])


def told(run: vv.Scene | vv.EnsembleScene, **how: Any) -> str:
    """The one warning of a run."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run.run(**how)
    assert [each.category for each in caught] == [vv.AccuracyWarning], [str(each.message) for each in caught]
    assert caught[0].filename == __file__
    return str(caught[0].message)


def step_named(message: str) -> float:
    return float(message.split("dt = ")[2].split(",", maxsplit=1)[0])


@pytest.mark.parametrize("method", ["boris", "boris4"])
@pytest.mark.parametrize("forces", [(FIELD,), (FIELD, ACROSS), (FIELD, vv.Gravity(1e-3), vv.UniformField((0, 0, -1)))])
def test_a_charge_that_is_carried_past_its_circle(method: str, forces: tuple[vv.forces.Force, ...]) -> None:
    """Velocities are turned exactly, energies are kept, and with twenty radians to a step every place was wrong."""
    scene = vv.Scene(pair(1.0, 1.0), *forces)
    message = told(scene, t=100.0, method=method, dt=2.0)
    assert message.startswith("a turn of body 0 in the magnetic field has 3.14 steps, and the method tells nothing of")
    assert "take a step that is 1.9 times shorter or less" in message
    rows = {row[0]: row[1] for row in scene.plan(t=100.0, method=method, dt=2.0).rows}
    assert rows["step too long"] == "3.14 in a turn of body 0 in the magnetic field"
    scene.run(t=100.0, method=method, dt=1.0)  # 6.28 steps to a turn
    back = vv.Scene(scene.particles, *forces, t0=100.0)
    assert told(back, t=0.0, method=method, dt=-2.0) == message


def test_fields_add_and_what_no_field_turns_is_not_blamed() -> None:
    against = vv.UniformMagneticField((0.0, 0.0, -1.9), charge=[0.5, 0.0])
    vv.Scene(pair(1.0, 1.0), FIELD, against).run(t=100.0, method="boris", dt=2.0)
    vv.Scene(pair(1.0, 0.0), vv.UniformMagneticField((0.0, 0.0, 1e3), charge=0.0)).run(t=9.0, method="boris", dt=1.0)


@pytest.mark.parametrize("threads", [1, 3])
def test_charges_of_copies_with_masses_and_fields_of_their_own(threads: int) -> None:
    scene = vv.Scene(pair(1.0, 1.0), FIELD)
    light = scene.ensemble(mass=[[9.0, 1.0], [2.0, 1.0], [0.25, 1.0], [1.0, 1.0]])
    message = told(light, t=100.0, method="boris", dt=1.0, threads=threads)
    assert message.startswith("in copy 2, a turn of body 0 in the magnetic field has 1.57 steps")
    strong = scene.ensemble(parameters={FIELD: {"B": [[0, 0, 1.0], [3.0, 0, 4.0], [0, 0, -2.0]]}})
    message = told(strong, t=100.0, method="boris", dt=1.0, threads=threads)
    assert message.startswith("in copy 1, a turn of body 0 in the magnetic field has 2.51 steps")


STRONG = vv.LinearDrag(0.1)
DRAGS = {
    "linear": ((1.0, 1.0), (STRONG,)),
    "massless": ((0.0, 0.0), (STRONG,)),
    "beside a mass": ((1.0, 0.0), (STRONG, vv.Gravity(1e-2))),
    "falling": ((1.0, 1.0), (STRONG, vv.UniformField((0.0, 0.0, -9.8)))),
    "of a sphere": ((1.0, 1.0), (vv.Drag(density=1e-3, viscosity=0.5, radius=1.0),)),
    "damper": ((1.0, 1.0), (vv.Spring(i=0, j=1, k=1.0, length=2.0), vv.Damper(i=0, j=1, c=5.0))),
    "written": ((1.0, 1.0), (vv.ExpressionForce(force=lambda r, v, t: [-10.0 * x for x in v]),)),
    "turning frame": ((0.0, 0.0), (vv.RotatingFrame((0.0, 0.0, 12.0)),)),
}


@pytest.mark.parametrize("drag", DRAGS)
@pytest.mark.parametrize(("method", "dt"), [("euler", 0.15), ("midpoint", 0.19), ("heun", 0.19), ("rk4", 0.25)])
def test_drag_that_takes_more_than_all_of_a_velocity_in_a_step(drag: str, method: str, dt: float) -> None:
    """Velocities changed their signs, or grew to 1e60 where bodies have no mass, with status OK and no word."""
    masses, forces = DRAGS[drag]
    scene = vv.Scene(pair(*masses, speed=1.0), *forces)
    message = told(scene, t=1.0, method=method, dt=dt)
    assert f"a step of dt = {dt:g} does not resolve this motion; try an adaptive method (verner98)" in message
    better = step_named(message)
    assert 1e-4 < better < dt
    scene.run(t=1.0, method=method, dt=better)


@pytest.mark.parametrize("method", ["euler", "midpoint", "heun", "rk4"])
@pytest.mark.parametrize("drag", DRAGS)
def test_steps_that_serve_are_not_blamed(drag: str, method: str) -> None:
    masses, forces = DRAGS[drag]
    vv.Scene(pair(*masses), *forces).run(t=1.0, method=method, dt=0.005)


@pytest.mark.parametrize(("method", "dt"), [("euler", 0.15), ("midpoint", 0.19)])
def test_drag_in_proportion_to_the_square_of_the_speed(method: str, dt: float) -> None:
    """At the start it is strong, at the end weak; of the four, `rk4` is right even there."""
    scene = vv.Scene(pair(1.0, 1.0), vv.QuadraticDrag(8.0), vv.UniformField((0.0, 0.0, -0.1)))
    assert told(scene, t=1.0, method=method, dt=dt).startswith(
        "after the first step the velocity of body 0 is off by 0."
    )
    scene.run(t=1.0, method="rk4", dt=0.25)


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("masses", [(1.0, 1.0), (0.0, 0.0)])
def test_drag_of_copies_with_parameters_of_their_own(threads: int, masses: tuple[float, float], tmp_path: Path) -> None:
    """What the worst of them is off is told, under the number of the copy, also of parts of an ensemble."""
    copies = vv.Scene(pair(*masses), STRONG).ensemble(parameters={STRONG: {"tau": [9.0, 1.0, 0.2, 0.3, 2.0] * 5}})
    how = {"t": 50.0, "method": "rk4", "dt": 0.5}
    message = told(copies, **how, threads=threads)
    assert message.startswith("in copy 22, after the first step the velocity of body 0 is off by 0.5")
    pytest.importorskip("pyarrow")
    with pytest.warns(vv.AccuracyWarning) as parts:
        copies.run_to_parquet(**how, threads=threads, to=tmp_path / "a", copies_at_once=8)
    assert [str(each.message) for each in parts] == [message]


def test_a_spring_that_comes_to_rest_where_it_pulls() -> None:
    """`rk4` has states of rest of its own: it ended pressed together to a half, with the energy of the start."""
    ends = vv.Particles([1.0, 1.0], [[0.0, 0.0, 0.0], [1.5, 0.0, 0.0]], [[0.0] * 3] * 2)
    spring = vv.Scene(ends, vv.Spring(0, 1, k=1.0, length=1.0))
    message = told(spring, t=100.0, method="rk4", dt=2.0)
    assert "after a step from the end the velocity of body" in message or "after the first step" in message
    spring.run(t=100.0, method="rk4", dt=0.1)


def test_a_fall_that_ends_at_another_speed() -> None:
    """The terminal speed is 10, and `rk4` stayed at 4.08 for good, which no step at the start would tell."""
    stone = vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[0.0, 0.0, 0.0]])
    scene = vv.Scene(stone, vv.QuadraticDrag(1.0), vv.UniformField((0.0, 0.0, -100.0)))
    assert told(scene, t=50.0, method="rk4", dt=0.2).startswith(
        "after a step from the end the velocity of body 0 is off"
    )
    assert scene.run(t=50.0, method="rk4", dt=0.05).velocity[-1, 0, 2] == pytest.approx(-10.0)


def test_what_rests_and_what_has_come_to_rest_is_not_blamed() -> None:
    """Forces that cancel leave their rounding, which no step resolves. One that moves gives energies a size."""
    places = np.vstack([np.arange(60.0).reshape(20, 3) / 7.0, [[0.0, 5.0, 0.0]]])
    row = vv.Particles(np.ones(21), places, [*[[0.0] * 3] * 20, [0.0, 1.0, 0.0]])
    length = float(np.linalg.norm(places[1] - places[0]))
    chain = vv.Spring(i=list(range(19)), j=list(range(1, 20)), k=0.5, length=length)
    vv.Scene(row, chain).run(t=1000.0, method="rk4", dt=1.0)
    vv.Scene(pair(1.0, 1.0), vv.LinearDrag(1.0)).run(t=400.0, method="rk4", dt=0.5)


def test_neither_results_nor_what_they_cost_know_of_the_look() -> None:
    out = vv.Scene(pair(1.0, 0.0), vv.LinearDrag(1.0), vv.Gravity(1.0)).run(t=10.0, method="rk4", dt=0.1)
    assert (out.stats.steps, out.stats.evaluations) == (100, 400)
