"""Walls, wells and pulses of formulas that are narrower than steps: whoever chooses steps sees them.

A body that comes to a wall that is ten times as high as its energy allows turns back, however thin it is; a pulse gives
its impulse, however short.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import sympy

import visviva as vv

PLACE = 57.3
Formula = Callable[[Any], Any]

#: Walls of height 5 by the distance from their middle in widths, in functions of NumPy or of SymPy: nothing to either
#: side, by functions and by powers.
WALLS: dict[str, Callable[[Any, Any], Any]] = {
    "gauss": lambda of, u: 5 * of.exp(-(u**2)),
    "sech": lambda of, u: 5 / of.cosh(u) ** 2,
    "root": lambda of, u: 5 * of.exp(1 - of.sqrt(1 + u**2)),
    "product": lambda of, u: 5 / (1 + u**2) / (1 + u**2),
    "raised": lambda of, u: 5 * (1 / (1 + u**2)) ** 4,
    "cube": lambda of, u: 5 / of.sqrt(1 + u**2) ** 3,
    "sixth power": lambda of, u: 5 / (1 + u**6),
    "eighth power": lambda of, u: 5 / (1 + u**8),
    "twelfth power": lambda of, u: 5 / (1 + u**12),
}
WIDTHS = (0.1, 3e-3, 1e-3, 1e-4, 1e-5)
BODY = vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]])


def wall(name: str, width: float) -> vv.ExpressionForce:
    return vv.ExpressionForce(potential=lambda r, v, t: WALLS[name](np, (r[0] - PLACE) / width))


def back(name: str, width: float, place: float) -> float:
    """The velocity of a body on its way back, by its energy: powers are not quite nothing 40 away from their middle."""
    with np.errstate(over="ignore"):  # of a cosh that divides
        begun, there = (WALLS[name](np, (x - PLACE) / width) for x in (0.0, place))
    return -float(np.sqrt(1.0 + 2.0 * (begun - there)))


@pytest.mark.parametrize("method", ["auto", "dop853", "verner98", "tsitouras54", "taylor"])
@pytest.mark.parametrize("name", WALLS)
def test_a_body_turns_back_at_a_wall_however_thin(name: str, method: str) -> None:
    if (name, method) == ("sech", "taylor"):
        pytest.skip("cosh(57/width)² is beyond float64, and ends its series by name")
    for width in WIDTHS:
        out = vv.Scene(BODY, wall(name, width)).run(t=100.0, method=method, rtol=1e-8)
        place, velocity = out.position[-1, 0, 0], out.velocity[-1, 0, 0]
        # Of the tolerance of each of two hundred steps, of which some tens turn the body.
        assert velocity == pytest.approx(back(name, width, place), rel=0.0, abs=4e-8), width
        # It comes back as late as it came, but for the time that it spends where the wall is, of some widths.
        assert place == pytest.approx(2.0 * PLACE - 100.0, rel=0.0, abs=8.0 * width)


@pytest.mark.parametrize("name", WALLS)
@pytest.mark.parametrize("width", WIDTHS)
def test_so_do_systems_in_generalized_coordinates(name: str, width: float) -> None:
    q, t = vv.coordinate("q"), vv.time
    x, p = sympy.symbols("x p")

    def potential(u: Any) -> Any:
        return WALLS[name](sympy, u)

    kinetic = q.diff(t) ** 2 / 2
    lagrangian = vv.Lagrangian(kinetic - potential((q - PLACE) / width), [q], position=[0.0], velocity=[1.0])
    hamiltonian = vv.Hamiltonian(
        p**2 / 2 + potential((x - PLACE) / width), q=[x], p=[p], position=[0.0], momentum=[1.0]
    )
    at = lagrangian.run(100.0)
    by_momenta = hamiltonian.run(100.0)
    # Of the default tolerance of 1e-12, and of the rounding of u = 57/width where the wall is as steep as 5/width.
    allowed = 1e-10 + 4.0 * np.finfo(float).eps * PLACE / width
    assert at.velocity[-1, 0] == pytest.approx(back(name, width, at.position[-1, 0]), rel=0.0, abs=allowed)
    assert by_momenta.momentum[-1, 0] == pytest.approx(
        back(name, width, by_momenta.position[-1, 0]), rel=0.0, abs=allowed
    )


@pytest.mark.parametrize("method", ["auto", "dop853", "verner98"])
def test_an_atom_far_away_scatters_however_its_potential_is_written(method: str) -> None:
    """Lennard-Jones, 1e-3 across and passed within it: by quotients that are raised, and by powers that are divided."""

    def atom(of: Formula) -> vv.Scene:
        def potential(r: Any, v: Any, t: Any) -> Any:
            return of(((r[0] - PLACE) ** 2 + (r[1] - 0.3e-3) ** 2) ** 0.5)

        return vv.Scene(BODY, vv.ExpressionForce(potential=potential))

    s = 1e-3
    wanted = vv.scattering.deflect(vv.potentials.LennardJones(1.0, s), energy=0.5, impact_parameter=0.3 * s).angle
    for of in (lambda r: 4.0 * ((s / r) ** 12 - (s / r) ** 6), lambda r: 4.0 * (s**12 / r**12 - s**6 / r**6)):
        velocity = atom(of).run(t=80.0, method=method, rtol=1e-11).velocity[-1, 0]
        # The tolerance, of an angle that amplifies what steps are off: 4e-10 was seen.
        assert velocity[0] == pytest.approx(np.cos(wanted), rel=0.0, abs=2e-9)
        assert abs(velocity[1]) == pytest.approx(abs(np.sin(wanted)), rel=0.0, abs=2e-9)


@pytest.mark.parametrize("method", ["auto", "dop853", "verner98"])
@pytest.mark.parametrize("width", WIDTHS)
def test_a_pulse_gives_its_impulse_however_short(width: float, method: str) -> None:
    """Beside gravity, to the lighter of two bodies, at a right angle to their motion: z″ is no more than that then."""
    pulse = vv.ExpressionForce(
        acceleration=lambda r, v, t: [0.0, 0.0, np.exp(-(((t - PLACE) / width) ** 2)) / width], bodies=[1]
    )
    far = vv.Particles([1.0, 1e-3], [[0.0, 0.0, 0.0], [1e6, 0.0, 0.0]])
    out = vv.Scene(far, vv.Gravity(1.0), pulse).run(t=60.0, method=method, rtol=1e-9)
    # The tolerance, of a velocity that is all there is; of it the heavier body has what a pull of 1e-12 passes on.
    assert out.velocity[-1, 1, 2] == pytest.approx(np.sqrt(np.pi), rel=1e-9, abs=0.0)
    assert abs(out.velocity[-1, 0, 2]) < 1e-15


@pytest.mark.parametrize("method", ["dop853", "verner98", "taylor"])
def test_copies_see_what_each_sees_alone(method: str) -> None:
    """Eight in lanes, some of which go over low walls while others turn back: with the bits of each alone."""
    force = vv.ExpressionForce(
        potential=lambda r, v, t, w, height: height * np.exp(-(((r[0] - PLACE) / w) ** 2)),
        parameters={"w": 1.0, "height": 5.0},
    )
    widths = np.logspace(-5.0, 0.0, 11)
    heights = np.where(np.arange(11) % 3 == 0, 0.25, 5.0)
    copies = vv.Scene(BODY, force).ensemble(parameters={force: {"w": widths, "height": heights}})
    runs = [copies.run(t=100.0, method=method, rtol=1e-8, threads=threads) for threads in (1, 3)]
    alone = [copies[copy].run(t=100.0, method=method, rtol=1e-8) for copy in range(11)]
    for column in ("position", "velocity"):
        each = np.array([getattr(one, column) for one in alone])
        assert all(np.array_equal(getattr(run, column), each) for run in runs), column
    passes = runs[0].velocity[:, -1, 0, 0] > 0.0
    assert np.array_equal(passes, heights < 0.5)


@pytest.mark.parametrize("gravity", [False, True])
@pytest.mark.parametrize("method", ["dop853", "taylor"])
def test_one_of_many_bodies_turns_back(method: str, gravity: bool) -> None:
    """The others, whether a step is theirs alone or everybody's, pass far from the wall."""
    rng = np.random.default_rng(0)
    position = rng.normal(size=(12, 3)) * 100.0 + [0.0, 1000.0, 0.0]
    velocity = np.zeros((12, 3))
    position[7], velocity[7] = 0.0, [1.0, 0.0, 0.0]
    post = vv.ExpressionForce(potential=lambda r, v, t: 5.0 * np.exp(-(((r[0] - PLACE) / 1e-4) ** 2) - r[1] ** 2))
    forces: list[vv.forces.Force] = [post, vv.Gravity(1e-12)] if gravity else [post]
    out = vv.Scene(vv.Particles(np.ones(12), position, velocity), *forces).run(t=100.0, method=method, rtol=1e-8)
    # The tolerance of some tens of steps.
    assert out.velocity[-1, 7, 0] == pytest.approx(-1.0, rel=0.0, abs=4e-8)
    # G Σm/r² t of neighbors that are farther than 1 from each other.
    others = np.delete(out.velocity[-1], 7, axis=0)
    assert np.abs(others).max() < (1e-12 * 12.0 * 100.0 if gravity else 1e-15)


def test_walls_go_along_with_a_scene_that_is_rescaled_and_stand_there_backward_in_time() -> None:
    scene = vv.Scene(BODY, wall("gauss", 1e-4))
    # Each to the default tolerance of 1e-9, of some tens of steps.
    there = scene.run(t=-30.0).final.run(t=100.0)
    assert there.velocity[-1, 0, 0] == pytest.approx(-1.0, rel=0.0, abs=4e-8)
    other = scene.rescaled(length=2.0**-20, mass=8.0, time=2.0**7)
    out = other.run(t=100.0 * 2.0**7)
    assert out.velocity[-1, 0, 0] * 2.0**27 == pytest.approx(-1.0, rel=0.0, abs=4e-8)
    behind = vv.Scene(vv.Particles([1.0], [[100.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]]), wall("gauss", 1e-4))
    assert behind.run(t=-100.0).velocity[-1, 0, 0] == pytest.approx(-1.0, rel=0.0, abs=4e-8)


@pytest.mark.parametrize("method", ["auto", "dop853", "verner98", "taylor"])
@pytest.mark.parametrize("width", [1e-2, 1e-3, 1e-5])
def test_massless_bodies_turn_back_that_follow_massive_ones(width: float, method: str) -> None:
    # One whose pull is nothing, far behind; 40 of no mass, some of which the wall does not act on.
    bodies = vv.Particles(
        [1e-9, *[0.0] * 40],
        [[-1e3, 0.0, 0.0], *([0.0, place, 0.0] for place in range(40))],
        [[0.0, 0.0, 0.0], *[[1.0, 0.0, 0.0]] * 40],
    )

    def push(r: Any, v: Any, t: Any) -> tuple[Any, Any, Any]:
        u = (r[0] - PLACE) / width
        return 10.0 * u / width * np.exp(-(u**2)), 0.0 * t, 0.0 * t

    scene = vv.Scene(bodies, vv.Gravity(1.0), vv.ExpressionForce(acceleration=push, bodies=list(range(1, 31))))
    out = scene.run(t=100.0, method=method, rtol=1e-8)
    velocity = out.velocity[-1, 1:, 0]
    # Of the pull of 1e-9 from 1e3 away in 100 units of time 1e-13; of the tolerance as above.
    np.testing.assert_allclose(velocity[:30], -1.0, rtol=0.0, atol=4e-8)
    np.testing.assert_allclose(velocity[30:], 1.0, rtol=0.0, atol=1e-12)


def rigid(width: float) -> vv.Scene:
    body = vv.RigidBody(
        mass=1.0,
        moments=[1.0, 2.0, 3.0],
        position=[0.0] * 3,
        velocity=[1.0, 0.0, 0.0],
        angular_velocity=[0.3, 0.2, 0.1],
    )
    return vv.Scene([body], wall("gauss", width), vv.AppliedTorque([0.0, 0.0, 0.01], body=0))


@pytest.mark.parametrize("method", ["auto", "dop853", "taylor"])
@pytest.mark.parametrize("width", [1e-2, 1e-3, 1e-5])
def test_rigid_bodies_that_torques_turn_do_so_too(width: float, method: str) -> None:
    out = rigid(width).run(t=100.0, method=method, rtol=1e-8)
    assert out.velocity[-1, 0, 0] == pytest.approx(-1.0, rel=0.0, abs=4e-8)
    # The wall, which acts on the center, turns nothing.
    free = rigid(1.0).run(t=100.0, method=method, rtol=1e-8)
    assert out.angular_velocity[-1] == pytest.approx(free.angular_velocity[-1], rel=0.0, abs=1e-6)
