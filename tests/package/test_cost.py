"""What `plan()` says of the cost before a run, against what the run then took."""

import pickle
import warnings
from time import perf_counter

import numpy as np
import pytest

import visviva as vv


@pytest.mark.parametrize(("span", "dt"), [(1000.0, 10.0), (-1000.0, -10.0), (1000.0, 7.0), (3.0, 10.0), (1e4, 0.5)])
def test_fixed_steps_are_counted(span: float, dt: float) -> None:
    scene = vv.problems.outer_solar_system().scene
    cost = scene.plan(span, method="leapfrog", dt=dt).cost()
    assert cost is not None
    assert cost.exact
    with warnings.catch_warnings(action="ignore", category=vv.AccuracyWarning):  # a step longer than the run
        assert cost.steps == scene.run(span, method="leapfrog", dt=dt).stats.steps
    assert 0.0 < cost.seconds < 5.0
    assert abs(cost.evaluations - cost.steps) < 0.5 * cost.steps + 10


def test_adaptive_steps_are_scaled_from_a_trial() -> None:
    """Of nearly circular planets every stretch is like another: to a tenth."""
    scene = vv.problems.outer_solar_system().scene
    cost, stats = scene.plan(1e6).cost(), scene.run(1e6).stats
    assert cost is not None
    assert not cost.exact or cost.steps == stats.steps
    assert abs(cost.steps / stats.steps - 1.0) < 0.1
    assert abs(cost.evaluations / stats.evaluations - 1.0) < 0.1


def test_the_memory_is_that_of_the_columns() -> None:
    scene = vv.problems.outer_solar_system().scene
    for record in (["position"], ["energy", "momentum"], ["position", "velocity", "energy", "center_of_mass"]):
        for t in (10.0, np.linspace(0.0, 10.0, 7)):
            copies = scene.ensemble(mass=scene.particles.mass * np.ones((3, 1)))
            for what in (scene, copies):
                cost = what.plan(t, record=record).cost()
                out = what.run(t, record=record)
                assert cost is not None
                assert cost.memory == sum(getattr(out, name).nbytes for name in record)


def test_the_steps_of_an_ensemble_are_those_of_all_copies() -> None:
    scene = vv.problems.figure_eight().scene
    copies = scene.ensemble(mass=scene.particles.mass * np.linspace(1.0, 1.001, 100)[:, None])
    cost = copies.plan(5.0).cost()
    assert cost is not None
    # A copy takes 37.4 steps on the average, of which a stretch tells whole ones (measured 1.2 %).
    assert abs(cost.steps / copies.run(5.0).stats.steps - 1.0) < 0.04


def test_copies_with_forces_of_their_own_are_tried_with_them() -> None:
    scene = vv.problems.figure_eight().scene
    copies = scene.ensemble(parameters={"Gravity": {"G": np.linspace(0.9, 1.1, 50)}})
    cost = copies.plan(5.0).cost()
    assert cost is not None
    # A stretch of each copy is a part of its motion, whose steps change along the orbit (measured 8 %).
    assert abs(cost.steps / copies.run(5.0).stats.steps - 1.0) < 0.15


def test_a_closed_form_takes_no_steps() -> None:
    cost = vv.problems.kepler().scene.plan(100.0).cost()
    assert cost is not None
    assert (cost.steps, cost.evaluations, cost.memory, cost.exact) == (0, 0, 2 * 2 * 6 * 8, True)


def test_it_is_printed_and_calls_nobody() -> None:
    def called(*_: object) -> float:
        raise AssertionError("an event function in a trial")

    plan = vv.problems.figure_eight().scene.plan(10.0, method="leapfrog", dt=0.01, events=[called])
    text = str(plan)
    for words in ("steps: 1 000\n", "force evaluations: about 1 0", "memory of the results: 288 bytes", "time: about"):
        assert words in text
    assert pickle.loads(pickle.dumps(plan)) == plan
    out = vv.problems.figure_eight().scene.run(10.0, method="leapfrog", dt=0.01)
    assert out.plan.cost() is None
    assert "expected" not in str(out.plan)


def test_what_cannot_be_tried_says_nothing() -> None:
    falls = vv.Scene(vv.Particles([1.0, 1.0], [[0, 0, 0], [1e-3, 0, 0]]), vv.Gravity(1.0))
    assert falls.plan(1e3, method="dop853").cost() is None
    assert vv.Scene(vv.Particles([], np.zeros((0, 3)))).plan(1.0, method="leapfrog", dt=0.1).cost() is None


def test_a_stretch_that_takes_far_more_steps_than_the_last_is_not_told_of() -> None:
    """A quiet beginning, and a spring a million times as fast from the middle on: the trial ends, and tells nothing."""
    fast = vv.ExpressionForce(
        force=lambda r, v, t: (-r[0] * (1.0 + 1e16 * (1.0 + np.tanh(100.0 * (t - 0.6)))), 0.0, 0.0)
    )
    scene = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 0.0, 0.0]]), fast)
    begun = perf_counter()
    assert scene.plan(1.0, method="dop853").cost() is None
    # The whole run takes 10⁸ steps: minutes.
    assert perf_counter() - begun < 10.0


@pytest.mark.parametrize("massless", [0, 30, 800])
def test_bodies_with_steps_of_their_own_are_counted_by_more_than_one_each(massless: int) -> None:
    """A stretch has a step of each at least, which was taken for a rate: of 800 three times too many were told."""
    radius = np.linspace(2.0, 4.0, massless)
    place = np.zeros((massless + 3, 3))
    velocity = np.zeros((massless + 3, 3))
    place[1:, 0] = [0.5, 1.0, *radius]
    velocity[1:, 1] = place[1:, 0] ** -0.5
    scene = vv.Scene(vv.Particles([1.0, 1e-6, 1e-6, *[0.0] * massless], place, velocity), vv.Gravity(1.0))
    cost = scene.plan(t=100.0).cost()
    assert cost is not None
    # Circles, whose steps do not change: a last one is broken (measured: 0, 0 and 0.7 %).
    assert cost.steps == pytest.approx(scene.run(t=100.0).stats.steps, rel=0.03, abs=0)


def test_bodies_that_do_not_know_of_each_other_take_their_steps_one_by_one() -> None:
    bodies = vv.Particles(np.ones(10), np.arange(30.0).reshape(10, 3))
    scene = vv.Scene(bodies, vv.Harmonic(k=1.0))
    cost, out = scene.plan(t=1000.0, method="rk4", dt=0.01).cost(), scene.run(t=1000.0, method="rk4", dt=0.01)
    assert cost is not None
    assert cost.exact
    assert cost.steps == out.stats.steps
    assert cost.evaluations == out.stats.evaluations


@pytest.mark.parametrize("t", [20.0, 200.0])
def test_steps_that_are_bounded_by_the_run_are_not_bounded_by_a_stretch_of_it(t: float) -> None:
    """Beside an ExpressionForce a step is at most 1/128 of the run: the trial took as many in each of its stretches."""
    rng = np.random.default_rng(0)
    bodies = vv.Particles(np.ones(10), 2.0 * rng.normal(size=(10, 3)), 0.3 * rng.normal(size=(10, 3)))
    trap = vv.ExpressionForce(potential=lambda r, v, t: 0.1 * r[0] ** 4)
    scene = vv.Scene(bodies, trap, vv.PairPotential(vv.potentials.Yukawa(k=0.1, length=1.0)))
    cost = scene.plan(t=t).cost()
    assert cost is not None
    # What comes after the stretch may be another motion: a factor of two.
    assert 0.5 < cost.steps / scene.run(t=t).stats.steps < 2.0
