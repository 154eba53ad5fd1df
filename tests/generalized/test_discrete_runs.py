"""Runs of variational integrators: copies, outputs, sections, the action of paths, and what is refused.

Bounds: an action of one step is a sum of some products, 1e-15 of it; a section and a run that goes on are met to some
roundings, 1e-14.
"""

import math
import pickle
from typing import Any

import numpy as np
import pytest
from discrete_systems import ORDERS, charge_in_a_well, systems
from test_runs import states

import visviva as vv


@pytest.mark.parametrize("method", ORDERS)
def test_a_copy_has_the_bits_it_has_alone(method: str) -> None:
    random = np.random.default_rng(3)
    times = np.linspace(0.0, 1.03, 7)
    how: dict[str, Any] = {"method": method, "dt": 0.05}
    ensembles = [
        vv.systems.double_pendulum().ensemble(
            position=random.uniform(-2, 2, (7, 2)), parameters={"l1": np.linspace(0.5, 2, 7)}
        ),
        vv.systems.kapitza(Omega=9.0).ensemble(parameters={"a": np.linspace(0.0, 0.3, 5)}),
        charge_in_a_well().ensemble(velocity=random.normal(size=(9, 2))),
    ]
    for many in ensembles:
        out = many.run(times, threads=1, **how)
        for threads in (2, 3):
            again = many.run(times, threads=threads, **how)
            assert np.array_equal(again.position, out.position)
            assert np.array_equal(again.velocity, out.velocity)
        for member in range(len(many)):
            alone = many[member].run(times, **how)
            assert np.array_equal(alone.position, out.position[member])
            assert np.array_equal(alone.momentum, out.momentum[member])
            assert (alone.steps, alone.evaluations) == (out.steps[member], out.evaluations[member])


@pytest.mark.parametrize("method", ORDERS)
def test_outputs_change_no_step(method: str) -> None:
    system = systems()["double_pendulum"]
    end = system.run(2.0, method=method, dt=0.07)
    for times in ([1.0, 2.0], np.linspace(0.0, 2.0, 101)):
        out = system.run(times, method=method, dt=0.07)
        assert np.array_equal(states(out)[-1], states(end)[-1])
        assert out.steps == end.steps == 29
    fine = states(system.run(np.linspace(0.0, 2.0, 101), rtol=1e-14))
    # Between nodes as good as at them: an error of the order of the method, with one constant.
    assert np.abs(states(out) - fine).max() <= 10 * np.abs(states(out)[-1] - fine[-1]).max() + 1e-13


def test_a_section_is_met() -> None:
    swing = systems()["pendulum"].poincare("theta", t=50.0, method="variational_lobatto8", dt=0.1)
    exact = systems()["pendulum"].poincare("theta", t=50.0)
    assert len(swing.t) == len(exact.t) > 3
    assert np.abs(swing.position).max() <= 1e-14
    # A step of 0.1 of order 8 is exact to rounding here: of times up to 50 measured 2.1e-14, three spacings.
    assert np.abs(swing.t - exact.t).max() <= 1e-13


def test_it_goes_on_and_from_another_time() -> None:
    driven = systems()["kapitza"]
    how: dict[str, Any] = {"method": "variational_lobatto6", "dt": 0.05}
    whole, first = driven.run([1.0, 2.0], **how), driven.run(1.0, **how)
    assert np.abs(states(first.final.run(2.0, **how))[-1] - states(whole)[-1]).max() <= 1e-14
    again = pickle.loads(pickle.dumps(whole))
    assert np.array_equal(again.position, whole.position)
    assert np.array_equal(again.system.discrete_action(again).residual, whole.system.discrete_action(whole).residual)


def test_the_action_of_paths_is_that_of_the_method() -> None:
    """A straight line between two places: L at its middle, at its ends; and what is stationary between them."""
    falling = vv.Lagrangian(lambda q, v, t, m: m * v[0] ** 2 / 2 - q[0] ** 3 - t * q[0], ["x"], parameters={"m": 3.0})
    h, q0, q1, t0 = 0.5, 1.0, 1.4, 2.0

    def L(x: float, t: float) -> float:
        return 3.0 * ((q1 - q0) / h) ** 2 / 2 - x**3 - t * x

    momentum = 3.0 * (q1 - q0) / h  # of the places as they are, 1.4 among them: 2.4 less two spacings
    path = ([t0, t0 + h], [q0, q1])
    middle = falling.discrete_action(path)
    assert middle.method == "variational_midpoint"
    assert float(middle) == pytest.approx(h * L(1.2, t0 + h / 2), rel=1e-15, abs=0)
    ends = falling.discrete_action(path, method="variational_trapezoidal")
    assert float(ends) == pytest.approx(h * (L(q0, t0) + L(q1, t0 + h)) / 2, rel=1e-15, abs=0)
    # −∂L_d/∂q₀ = m (q₁ − q₀)/h + h (3 q₀² + t)/2.
    assert ends.momentum_before[0, 0] == pytest.approx(momentum + h / 2 * (3 * q0**2 + t0), rel=1e-15, abs=0)
    assert ends.momentum_after[0, 0] == pytest.approx(momentum - h / 2 * (3 * q1**2 + t0 + h), rel=1e-15, abs=0)
    assert ends.residual.shape == (0, 1)
    # Finer and finer quadratures agree on the stationary action.
    actions = [float(falling.discrete_action(path, method=method)) for method in ORDERS][2:]
    assert abs(actions[1] - actions[2]) < abs(actions[0] - actions[2]) < 1e-3
    swing = vv.systems.oscillator(k=1.0, m=1.0, position=[0.0], velocity=[1.0])
    times = np.linspace(0.0, 1.0, 11)
    out = swing.run(times, method="variational_lobatto8", dt=0.1)
    assert float(swing.discrete_action(out)) == pytest.approx(math.sin(2.0) / 4.0, abs=1e-13)


def test_what_cannot_be_run_is_refused_by_name() -> None:
    def argument(call: Any, words: str) -> str:
        with pytest.raises(vv.InvalidInput, match=words) as caught:
            call()
        return caught.value.argument

    pendulum, well = vv.systems.pendulum(), vv.systems.henon_heiles()
    for method in ORDERS:
        assert argument(lambda m=method: pendulum.run(1.0, method=m), f"{method} has a fixed one") == "dt"
        assert argument(lambda m=method: pendulum.plan(1.0, method=m), "pass dt") == "dt"
        assert argument(lambda m=method: well.run(1.0, method=m, dt=0.1), "is of Lagrangians; gauss16") == "method"
        words = "keeps no constraints; rattle, gauss16 and dop853 do"
        assert argument(lambda m=method: vv.systems.atwood().run(1.0, method=m, dt=0.1), words) == "method"
    words = "did you mean 'variational_midpoint'"
    assert argument(lambda: pendulum.run(1.0, method="variational_midpiont", dt=0.1), words) == "method"
    out = pendulum.run([0.0, 0.1, 0.2])
    assert (
        argument(lambda: pendulum.discrete_action(out), "as the path is a run of elliptic_functions; pass method")
        == "method"
    )
    assert argument(lambda: pendulum.discrete_action(out, method="gauss4"), "expected one of variational") == "method"
    assert argument(lambda: pendulum.discrete_action(([0.0], [1.0])), "two times or more") == "path"
    assert argument(lambda: pendulum.discrete_action(([0.0, 1.0, 0.5], [1.0] * 3)), "all in order") == "path"
    assert argument(lambda: pendulum.discrete_action([1.0, 2.0, 3.0]), r"as \(t, q\), got list") == "path"
    assert argument(lambda: pendulum.discrete_action(vv.systems.atwood().run(0.1)), "expected a run of") == "path"
    atwood = vv.systems.atwood()
    assert argument(lambda: atwood.discrete_action(atwood.run(0.1)), "without constraints") == "path"


def test_steps_that_are_too_long_end_with_what_there_is() -> None:
    system = systems()["double_pendulum"].at(velocity=[30.0, -40.0])
    with pytest.raises(vv.ConvergenceError, match="take a smaller dt") as caught:
        system.run(np.linspace(0.0, 400.0, 9), method="variational_lobatto4", dt=2.5)
    assert caught.value.trajectory is not None
    assert len(caught.value.trajectory) < 9


def test_progress_may_interrupt() -> None:
    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        systems()["pendulum"].ensemble(position=np.linspace(0.1, 1.0, 50)[:, None]).run(
            50.0, method="variational_midpoint", dt=1e-3, progress=stop
        )


def test_the_plan_tells_the_step() -> None:
    plan = vv.systems.spherical_pendulum().plan(10.0, method="variational_lobatto4", dt=0.1)
    assert plan.method == "variational_lobatto4"
    assert "0.1, all alike" in str(plan)
