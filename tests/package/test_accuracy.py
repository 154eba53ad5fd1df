"""A run that resolved nothing does not end without a word, and a run that is fine is not spoken to."""

import warnings

import numpy as np
import pytest

import visviva as vv

PLANETS = vv.problems.outer_solar_system().scene


def step_named(message: str) -> float:
    return float(message.split("try dt = ")[1].split(",", maxsplit=1)[0])


@pytest.mark.parametrize(
    ("scene", "t", "method", "dt"),
    [
        (PLANETS, 1e5, "stormer13", 100.0),
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


def test_adaptive_and_closed_runs_are_not_spoken_to() -> None:
    PLANETS.run(t=1e4)
    vv.problems.kepler(e=0.9).scene.run(t=1.0)
