"""Equal steps that are too long for an orbit are told: total energies hardly know of a light body that is lost."""

import warnings

import numpy as np
import pytest

import visviva as vv

PLANETS = vv.datasets.solar_system().scene


@pytest.mark.parametrize("dt", [2.0, 2.5, 3.0])
def test_mercury_by_a_multistep_method(dt: float) -> None:
    """Two days are 44 steps in a turn of Mercury, which was thrown out to 192 AU without a word."""
    with pytest.warns(vv.AccuracyWarning, match=r"a turn of body 1 about body 0 has .*\(taylor, verner98\)"):
        PLANETS.run(t=3652.5, method="stormer13", dt=dt)
    assert any(row[0] == "step too long" for row in PLANETS.plan(t=3652.5, method="stormer13", dt=dt).rows)


def test_steps_that_serve_are_not_blamed() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        out = PLANETS.run(t=3652.5, method="stormer13", dt=1.0)
        PLANETS.run(t=3652.5, method="kahan_li8", dt=4.0)
    exact = PLANETS.run(t=3652.5, method="taylor", rtol=1e-13)
    assert np.abs(out.position[-1] - exact.position[-1]).max() < 2e-7  # of 88 steps in a turn of Mercury


def test_the_multistep_method_is_stable_from_the_steps_that_it_declares() -> None:
    """Of an oscillation: at 75 steps to a period its amplitude stays, at 68 it grows without bound."""
    circle = vv.problems.kepler(e=0.0).scene
    drift = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", vv.AccuracyWarning)
        for steps in (68, 75):
            out = circle.run(t=2 * np.pi * 60, method="stormer13", dt=2 * np.pi / steps)
            drift[steps] = out.conservation().energy.max
    # The error of order 13 with 75 steps to a period, which stays; measured 3e-9.
    assert drift[75] < 1e-8
    assert drift[68] > 1.0


def test_copies_are_named() -> None:
    orbit = vv.problems.kepler(e=0.0).scene
    wide = orbit.particles.position * np.array([1.0, 100.0, 1.0, 1.0])[:, None, None]
    slow = orbit.particles.velocity * np.array([1.0, 0.1, 1.0, 1.0])[:, None, None]
    copies = orbit.ensemble(position=wide, velocity=slow)
    with pytest.warns(vv.AccuracyWarning, match=r"in copy 0, a turn of body 0 about body 1 has 5\.03 steps"):
        copies.run(t=100.0, method="kahan_li8", dt=1.25)


@pytest.mark.parametrize("method", ["leapfrog", "kahan_li8", "rk4"])
@pytest.mark.parametrize("heavy", [0.0, 1e-2])
def test_a_light_body_on_a_long_ellipse(method: str, heavy: float) -> None:
    """Its pericenter is a hundredth of its axis: it was thrown out to a thousand axes without a word."""
    places, velocities = [[0.0, 0.0, 0.0], [1.99, 0.0, 0.1], [0.0, 40.0, 0.0]], [[0.0] * 3, [0.0, 0.07, 0.0], [0.0] * 3]
    scene = vv.Scene(vv.Particles([1.0, 0.0, heavy], places, velocities), vv.Gravity(G=1.0))
    with pytest.warns(vv.AccuracyWarning, match="a turn of body 1 about body 0, as tight as at its pericenter, has 0"):
        scene.run(t=100.0, method=method, dt=0.05)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene.run(t=100.0, method="taylor")


@pytest.mark.parametrize("method", ["leapfrog", "rk4", "stormer13"])
@pytest.mark.parametrize(("mass", "planet"), [(0.0, None), (0.0, 1e-2), (1e-12, 1e-4)])
def test_a_comet_that_some_six_steps_throw_out(method: str, mass: float, planet: float | None) -> None:
    """At e = 0.99 what a method loses at the pericenter is two hundred times as much of the energy: 6.3 steps in a turn
    there had it hundreds of axes away."""
    several = planet is not None
    bodies = vv.Particles.from_elements(
        1.0,
        [mass, planet] if several else [mass],
        G=1.0,
        semi_major_axis=[1.0, 3.2] if several else [1.0],
        eccentricity=[0.99, 0.05] if several else [0.99],
        true_anomaly=[2.5, 1.0] if several else [2.5],
    )
    scene = vv.Scene(bodies, vv.Gravity(1.0))
    with pytest.warns(
        vv.AccuracyWarning, match="a turn of body 1 about body 0, as tight as at its pericenter, has 6.28"
    ):
        scene.run(t=31.4, method=method, dt=1e-3)
    if not several:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            out = scene.run(t=31.4, method=method, dt=1e-4)
        # Five passages in 63 steps to a turn there, each of which may take a fifth of the energy.
        assert np.linalg.norm(out.position[-1, 1] - out.position[-1, 0]) < 3.0


def test_a_moon_that_is_lost_is_told() -> None:
    """The Sun pulls our Moon twice as hard as the Earth does, about which it goes: equal steps threw it out."""
    G = 6.674e-11
    bodies = vv.Particles.from_elements(1.98841e30, 5.9722e24, G=G, semi_major_axis=1.495978707e11)
    bodies = vv.Particles.from_elements(bodies, 7.346e22, G=G, about=1, semi_major_axis=3.844e8)
    scene = vv.Scene(bodies, vv.Gravity(G))
    with pytest.warns(vv.AccuracyWarning, match="a turn of body 2 about body 1 has 3"):
        scene.run(t=5 * 3.156e7, method="leapfrog", dt=8 * 86400.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene.run(t=3.156e7, method="leapfrog", dt=0.5 * 86400.0)


@pytest.mark.parametrize("mass", [0.0, 1e-12])
@pytest.mark.parametrize("count", [63, 64, 200])
def test_many_light_bodies_are_looked_at_too(count: int, mass: float) -> None:
    """64 of them and more were flung from 0.5 AU to hundreds without a word."""
    axes = np.linspace(0.3, 0.5, count)
    bodies = vv.Particles.from_elements(1.0, np.full(count, mass), G=2.959e-4, semi_major_axis=axes)
    told = "a turn of body 1 about body 0, as tight as at its pericenter, has 1 steps" if mass == 0.0 else "off by"
    with pytest.warns(vv.AccuracyWarning, match=told):
        vv.Scene(bodies, vv.Gravity(2.959e-4)).run(t=36525.0, method="leapfrog", dt=60.0)


def test_softened_pulls_and_constants_of_copies_are_looked_at_too() -> None:
    """A circle in three steps a turn, which left for r = 47."""
    orbit = vv.Particles.from_elements(1.0, 0.0, G=1.0, semi_major_axis=1.0)
    how = {"t": 60.0, "method": "leapfrog", "dt": 2.0}
    with pytest.warns(vv.AccuracyWarning, match="a turn of body 1 about body 0.* has 3"):
        vv.Scene(orbit, vv.Gravity(1.0, 1e-6)).run(**how)
    gravity = vv.Gravity(1.0)
    copies = vv.Scene(orbit, gravity).ensemble(parameters={gravity: {"G": [1.0, 1.01]}})
    with pytest.warns(vv.AccuracyWarning, match="in copy 1, a turn of body 1 about body 0, .* has 3"):
        copies.run(**how)


@pytest.mark.parametrize("count", [14, 20, 100])
def test_a_cluster_that_gains_energy_is_told(count: int) -> None:
    """A thousand leapfrog steps of a hundred stars took its energy from −0.28 to +1.5; of 15 and more nobody looked."""
    random = np.random.default_rng(0)
    bodies = vv.Particles(np.ones(count) / count, random.normal(size=(count, 3)), 0.1 * random.normal(size=(count, 3)))
    with pytest.warns(vv.AccuracyWarning, match="the energy at the end is off by"):
        vv.Scene(bodies, vv.Gravity(1.0)).run(t=20.0, method="leapfrog", dt=0.02)
