"""Drag as a function of the Reynolds number: laws with a name, functions and tables of one's own.

Bounds: closed forms to some roundings, 1e-15 to 1e-14; what a fit says of its own error, what it was asked for.
"""

import math
import pickle
from typing import Any

import mpmath
import numpy as np
import pytest

import visviva as vv

Number = Any
LAWS = ["schiller_naumann", "clift_gauvin", "turton_levenspiel", "stokes"]
CRISIS = 1e5


def coefficient(law: str, Re: Number) -> Number:
    """As the papers print it, of the Reynolds number with the diameter."""
    Re = mpmath.mpf(Re)
    if law == "stokes":
        return 24 / Re
    if law == "turton_levenspiel":
        return 24 / Re * (1 + mpmath.mpf("0.173") * Re ** mpmath.mpf("0.657")) + mpmath.mpf("0.413") / (
            1 + 16300 * Re ** mpmath.mpf("-1.09")
        )
    slow = 24 / Re * (1 + mpmath.mpf("0.15") * Re ** mpmath.mpf("0.687"))
    if law == "clift_gauvin":
        return slow + mpmath.mpf("0.42") / (1 + 42500 * Re ** mpmath.mpf("-1.16"))
    return max(slow, mpmath.mpf("0.44"))


def drag(force: vv.forces.Force, speed: float, mass: float = 1.0) -> float:
    """The force against the motion."""
    scene = vv.Scene(vv.Particles([mass], [[0.0, 0.0, 0.0]], [[0.0, speed, 0.0]]), force)
    across, along, up = (mass * scene.acceleration()[0]).tolist()
    assert (across, up) == (0.0, 0.0)
    return -along


@pytest.mark.parametrize("law", LAWS)
def test_the_force_is_that_of_the_paper(law: str) -> None:
    mpmath.mp.dps = 30
    rng = np.random.default_rng(1)
    for R in 10 ** rng.uniform(-9, 5, 60):
        rho, mu, a, m = (float(x) for x in 10 ** rng.uniform(-3, 3, 4))
        v = float(R) * mu / rho / a
        Re = 2 * mpmath.mpf(rho) * a * v / mu
        right = coefficient(law, Re) * mpmath.pi * mpmath.mpf(rho) * mpmath.mpf(a) ** 2 * mpmath.mpf(v) ** 2 / 2
        # Some ten roundings, and what one of R makes: less than itself.
        assert abs(drag(vv.Drag(rho, mu, a, law), v, m) / right - 1) < 3e-15


def test_it_is_linear_when_slow_and_quadratic_when_fast() -> None:
    rho, mu, a = 1.2, 1.8e-5, 0.01
    slow, fast = 1e-14 * mu / rho / a, 0.9 * CRISIS * mu / rho / a
    stokes = drag(vv.drag.stokes(mass=1.0, radius=a, viscosity=mu), slow)
    newton = drag(vv.drag.quadratic(density=rho, radius=a, drag_coefficient=0.44), fast)
    for law in LAWS:
        # 1 + 0.173 (2e-14)^0.657, at most.
        assert drag(vv.Drag(rho, mu, a, law), slow) == pytest.approx(stokes, rel=2e-10, abs=0)
    assert drag(vv.Drag(rho, mu, a), fast) == pytest.approx(newton, rel=1e-15, abs=0)
    assert drag(vv.Drag(rho, mu, a), 0.02 * fast) == pytest.approx(newton / 2500, rel=1e-15, abs=0)
    assert drag(vv.Drag(rho, mu, a), 0.0) == 0.0


# S. A. Morsi, A. J. Alexander, J. Fluid Mech. 55 (1972) 193: measured.
MEASURED = {0.1: 240.0, 1.0: 26.5, 10.0: 4.1, 100.0: 1.07, 1000.0: 0.46, 10000.0: 0.41, 50000.0: 0.488}


@pytest.mark.parametrize("law", LAWS[:3])
def test_they_are_near_what_was_measured(law: str) -> None:
    for Re, found in MEASURED.items():
        measured = drag(vv.Drag(1.0, 1.0, 1.0, law), Re / 2) / (0.5 * math.pi * (Re / 2) ** 2)
        # Measurements scatter by some percent; 0.44 is a mean of what they rise and fall by.
        assert measured == pytest.approx(found, rel=0.11, abs=0)


def test_drag_grows_with_the_speed() -> None:
    speeds = np.geomspace(1e-6, 0.999 * CRISIS, 4000)
    bodies = vv.Particles(np.ones(4000), np.zeros((4000, 3)), np.stack([speeds, 0 * speeds, 0 * speeds], axis=1))
    for law in LAWS:
        assert (np.diff(-vv.Scene(bodies, vv.Drag(1.0, 1.0, 1.0, law)).acceleration()[:, 0]) > 0).all()


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("size", [1e-4, 2e-3, 1e-2])
def test_a_long_fall_has_the_terminal_speed(law: str, size: float) -> None:
    """Where weight and drag are equal, found by mpmath, of steel in oil."""
    mpmath.mp.dps = 30
    rho, mu, g = 900.0, 0.1, 9.81
    m = 7800.0 * 4 / 3 * math.pi * size**3
    weight = mpmath.mpf(m) * g

    def lack(v: Number) -> Number:
        return coefficient(law, 2 * rho * size * v / mu) * mpmath.pi * rho * mpmath.mpf(size) ** 2 * v**2 / 2 - weight

    creeping = float(weight / (6 * mpmath.pi * mu * size))
    right = mpmath.findroot(lack, (creeping * 1e-3, creeping * 1.0001), solver="anderson")
    scene = vv.Scene(
        vv.Particles([m], [[0.0, 0.0, 0.0]], [[0.3 * creeping, 0.0, 0.0]]),
        vv.UniformField([0.0, 0.0, -g]),
        vv.Drag(rho, mu, size, law),
    )
    out = scene.run(t=60.0 * creeping / g, rtol=1e-12)
    # What is left of the start is e^-60, and the tolerance stays about a motion that attracts its neighbors.
    assert out.velocity[-1, 0].tolist() == pytest.approx([0.0, 0.0, -float(right)], rel=1e-10, abs=1e-12 * creeping)


@pytest.mark.parametrize("law", LAWS)
def test_coasting_takes_the_time_that_drag_needs(law: str) -> None:
    """t = ∫ m dv/D from the one speed to the other, x = ∫ m v dv/D, by mpmath."""
    mpmath.mp.dps = 20
    rho, mu, a, m, fast = 1.2, 1.8e-2, 0.03, 0.02, 300.0

    def force(v: Number) -> Number:
        return coefficient(law, 2 * rho * a * v / mu) * mpmath.pi * rho * a**2 * v**2 / 2

    slow = fast / 20
    bend = 491.81 * mu / rho / a  # of Schiller and Naumann: integrals go up to it and on
    parts = [slow, bend, fast] if slow < bend < fast else [slow, fast]
    time = float(m * mpmath.quad(lambda v: 1 / force(v), parts))
    way = float(m * mpmath.quad(lambda v: v / force(v), parts))
    direction = np.array([0.36, 0.48, 0.8])
    scene = vv.Scene(vv.Particles([m], [[0.0, 0.0, 0.0]], [fast * direction]), vv.Drag(rho, mu, a, law))
    out = scene.run(t=time, rtol=1e-11)
    # Of a tolerance of 1e-11 a step, at laws that bend: measured 4.5e-11 and 1.2e-10.
    assert np.allclose(out.velocity[-1, 0], slow * direction, rtol=5e-10, atol=0.0)
    assert np.allclose(out.position[-1, 0], way * direction, rtol=5e-10, atol=0.0)


def test_the_energy_that_is_lost_is_the_work_of_drag() -> None:
    rho, mu, a, m, g = 1.2, 1.8e-5, 0.02, 0.05, 9.8
    force = vv.Drag(rho, mu, a, "clift_gauvin")
    scene = vv.Scene(vv.Particles([m], [[0.0, 0.0, 0.0]], [[20.0, 0.0, 25.0]]), vv.UniformField([0.0, 0.0, -g]), force)
    nodes, weights = np.polynomial.legendre.leggauss(60)
    t = 2.0 + 2.0 * nodes
    out = scene.run(t=np.concatenate([[0.0], t, [4.0]]), rtol=1e-12)
    v = out.velocity[1:-1, 0]
    powers = [float(-drag(force, float(np.linalg.norm(u)), m) * np.linalg.norm(u)) for u in v]
    assert max(powers) < 0.0
    energy = 0.5 * m * (out.velocity[:, 0] ** 2).sum(1) + m * g * out.position[:, 0, 2]
    # Gauss's sum of 60 points leaves nothing of a power this smooth: the tolerance of the run; measured 5e-14.
    assert energy[-1] - energy[0] == pytest.approx(2.0 * float(np.dot(weights, powers)), rel=1e-12, abs=0)
    assert (np.diff(energy) < 0).all()


def test_each_body_has_its_radius() -> None:
    radius = np.array([0.5, 0.0, 2.0])
    rng = np.random.default_rng(2)
    bodies = vv.Particles([1.0, 0.0, 3.0], rng.normal(size=(3, 3)), rng.normal(size=(3, 3)))
    together = vv.Scene(bodies, vv.Drag(1.5, 0.5, radius)).run(t=1.0)
    for i, a in enumerate(radius):
        alone = vv.Scene(
            vv.Particles(bodies.mass[i : i + 1], bodies.position[i : i + 1], bodies.velocity[i : i + 1]),
            vv.Drag(1.5, 0.5, float(a)),
        )
        assert (alone.acceleration()[0] == vv.Scene(bodies, vv.Drag(1.5, 0.5, radius)).acceleration()[i]).all()
        if a:
            assert (alone.run(t=1.0).position[-1, 0] == together.position[-1, i]).all()
    assert np.allclose(together.position[-1, 1], bodies.position[1] + bodies.velocity[1], rtol=1e-15, atol=0)
    with pytest.raises(vv.InvalidInput, match="radius"):
        vv.Scene(bodies, vv.Drag(1.5, 0.5, [1.0, 0.0, 2.0, 3.0])).run(t=1.0)
    with pytest.raises(vv.InvalidInput, match="mass"):
        vv.Scene(bodies, vv.Drag(1.5, 0.5, 1.0)).run(t=1.0)


@pytest.mark.parametrize("how", [{}, {"method": "rk4", "dt": 1e-2}], ids=repr)
def test_beyond_the_crisis_nothing_is_known(how: dict[str, Any]) -> None:
    heavy = vv.Particles([50.0], [[0.0, 0.0, 0.0]], [[3.0, 0.0, 0.0]])
    scene = vv.Scene(heavy, vv.UniformField([0.0, 0.0, -9.8]), vv.Drag(1.2, 1.8e-5, 0.2))
    with pytest.raises(vv.ConvergenceError, match="not known") as caught:
        scene.run(t=100.0, **how)
    assert caught.value.trajectory.status is vv.Status.OUTSIDE_DOMAIN
    reached = scene.ensemble(velocity=[[[3.0, 0.0, 0.0]], [[0.0, 0.0, 2.0]]]).run(t=[0.1, 100.0], **how)
    assert reached.status.tolist() == [vv.Status.OUTSIDE_DOMAIN] * 2
    assert np.isfinite(reached.position[:, 0]).all()
    assert vv.Scene(heavy, *scene.forces[:1], vv.Drag(1.2, 1.8e-5, 0.2, "stokes")).run(t=100.0, **how).status == 0
    fast = vv.Particles([50.0], [[0.0, 0.0, 0.0]], [[9.0, 0.0, 0.0]])
    with pytest.raises(vv.InvalidInput, match=r"Reynolds number 100000.0, a speed of 7\.5 of this body"):
        vv.Scene(fast, vv.Drag(1.2, 1.8e-5, 0.2)).run(t=1.0)


FLUID = {"density": 1.5, "viscosity": 0.25, "radius": 0.5}


def test_a_function_is_met_to_its_tolerance() -> None:
    mine = vv.drag.custom(
        lambda R: np.array([float(math.pi / 2 * coefficient("clift_gauvin", 2 * r)) for r in R]), 1e-6, 9e4, **FLUID
    )
    assert 0.0 < mine.error <= 1e-12
    named = vv.Drag(**FLUID, law="clift_gauvin")
    for v in np.geomspace(1e-5, 2e4, 200):
        # The tolerance twice, as it is relative to f + R df/dR.
        assert drag(mine, float(v)) == pytest.approx(drag(named, float(v)), rel=2e-12, abs=0)
    # Slower than it is known, linear.
    assert drag(mine, 1e-9) == pytest.approx(3e-3 * drag(mine, 1e-6 / 3), rel=1e-12, abs=0)
    assert drag(mine, 2e-9) == 2 * drag(mine, 1e-9)
    again = pickle.loads(pickle.dumps(mine))
    assert again == mine
    assert hash(again) == hash(mine)
    assert vv.drag.custom(lambda R: 20 / R, 0.1, 10.0, **FLUID) != vv.drag.custom(lambda R: 21 / R, 0.1, 10.0, **FLUID)


def test_a_table_is_met_and_monotone_between() -> None:
    Re, C = np.array(list(MEASURED)), np.array(list(MEASURED.values()))
    table = vv.drag.tabulated(Re / 2, math.pi / 2 * C, density=1.0, viscosity=1.0, radius=1.0)
    for number, c in MEASURED.items():
        assert drag(table, number / 2) == pytest.approx(c * math.pi / 2 * (number / 2) ** 2, rel=1e-14, abs=0)
    speeds = np.geomspace(1e-3, 2.5e4, 3000)
    bodies = vv.Particles(np.ones(3000), np.zeros((3000, 3)), np.stack([speeds, 0 * speeds, 0 * speeds], axis=1))
    slowing = -vv.Scene(bodies, table).acceleration()[:, 0]
    assert (np.diff(slowing) > 0).all()
    assert (np.diff(slowing / speeds) > -1e-12 * slowing[1:] / speeds[1:]).all()
    # Many points of a law come to it, by the fourth power of their distance or faster.
    apart = []
    for count in (60, 120):
        R = np.geomspace(1e-3, 1e4, count)
        own = vv.drag.tabulated(R, 6 * np.pi / R + 1.0, density=1.0, viscosity=1.0, radius=1.0)
        apart.append(max(abs(drag(own, v) / (6 * np.pi * v + v * v) - 1) for v in np.geomspace(2e-3, 9e3, 300)))
    assert apart[0] < 1e-14 or apart[1] < apart[0] / 12


@pytest.mark.parametrize(
    ("make", "argument", "words"),
    [
        (lambda: vv.Drag(0.0, 1.0, 1.0), "density", "positive"),
        (lambda: vv.Drag(1.0, -1.0, 1.0), "viscosity", "positive"),
        (lambda: vv.Drag(1.0, 1.0, -1.0), "radius", "at least 0"),
        (lambda: vv.Drag(1.0, 1.0, 1.0, "schiler_naumann"), "law", "schiller_naumann"),
        (lambda: vv.drag.custom(lambda R: -1 / R, 0.1, 1.0, **FLUID), "function", "does not drive"),
        (lambda: vv.drag.custom(lambda R: 1 / R, 0.0, 1.0, **FLUID), "R_min", "above 0"),
        (lambda: vv.drag.custom(lambda R: 1 / R, 1.0, 0.5, **FLUID), "R_max", "R_min = 1.0"),
        (lambda: vv.drag.custom(lambda R: np.sign(R - 3) + 2, 1.0, 9.0, **FLUID), "function", "smooth"),
        (lambda: vv.drag.custom(lambda R: R / 0 * 0, 1.0, 9.0, **FLUID), "function", "finite values"),
        (lambda: vv.drag.custom(lambda R: 1.0, 1.0, 9.0, **FLUID), "function", "one value for each R"),
        (lambda: vv.drag.custom(3.0, 1.0, 9.0, **FLUID), "function", "function of R"),
        (lambda: vv.drag.tabulated([1.0, 2.0, 3.0], [1.0, 1.0, 1.0], **FLUID), "R", "at least 4"),
        (lambda: vv.drag.tabulated([1.0, 3.0, 2.0, 4.0], [1.0] * 4, **FLUID), "R", "ascending"),
        (lambda: vv.drag.tabulated([0.0, 1.0, 2.0, 4.0], [1.0] * 4, **FLUID), "R", "above 0"),
        (lambda: vv.drag.tabulated([1.0, 2.0, 3.0, 4.0], [1.0] * 3, **FLUID), "F", "as many"),
        (lambda: vv.drag.tabulated([1.0, 2.0, 3.0, 4.0], [1.0, 1.0, -1.0, 1.0], **FLUID), "F", "does not drive"),
        (lambda: vv.SampledDrag(1.0, 1.0, 1.0, [0.0, 1.0], [-1.0] + [0.0] * 13), "coefficients", "does not drive"),
        (lambda: vv.SampledDrag(1.0, 1.0, 1.0, [0.0, 1.0], [1.0]), "coefficients", "14 for each piece"),
        (lambda: vv.SampledDrag(1.0, 1.0, 1.0, [1.0], []), "breaks", "at least 2"),
    ],
)
def test_refusals(make: Any, argument: str, words: str) -> None:
    with np.errstate(all="ignore"), pytest.raises(vv.InvalidInput, match=words) as caught:
        vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]]), make()).run(t=1.0)
    assert caught.value.argument == argument
