"""Times far from zero are numbers that lie apart: rates that change fast from one to the next are told, no others."""

import warnings
from typing import Any

import numpy as np
import pytest

import visviva as vv


def heard(run: Any) -> list[str]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run()
    return [str(warning.message) for warning in caught]


def driven(w: float, t0: float, energy: type = vv.Lagrangian) -> Any:
    drive = {"parameters": {"w": w}, "position": [1.0], "t0": t0}
    if energy is vv.Lagrangian:
        return vv.Lagrangian(lambda q, v, t, w: v[0] ** 2 / 2 - q[0] ** 2 / 2 + q[0] * np.cos(w * t), ["x"], **drive)
    return vv.Hamiltonian(lambda q, p, t, w: p[0] ** 2 / 2 + q[0] ** 2 / 2 - q[0] * np.cos(w * t), ["x"], **drive)


@pytest.mark.parametrize("energy", [vv.Lagrangian, vv.Hamiltonian])
@pytest.mark.parametrize(
    ("w", "t0", "told"),
    [(50.0, 0.0, False), (50.0, 1e4, False), (1.3, 1.7e9, True), (1.3, -1.7e9, True), (0.7, 1e9, True)],
)
def test_a_drive_of_the_time_since_1970(energy: type, w: float, t0: float, told: bool) -> None:
    messages = heard(lambda: driven(w, t0, energy).run(t0 + 1.0))
    assert len(messages) == told
    for message in messages:
        change = float(message.split("changes by ")[1].split()[0])
        # ω times the distance of numbers, its rounding with it, over the largest rate, which is 1 or 2.
        assert 0.1 * w * np.spacing(abs(t0)) < change < 4.0 * w * np.spacing(abs(t0))


def test_a_drive_too_fast_for_the_tolerance_is_told_of_where_it_fails() -> None:
    """Rates that jump by 1e-5 leave steps held to 1e-12 no length; what is wrong with the times is said beside it."""
    fast = driven(50.0, 1.7e9)
    with pytest.warns(vv.AccuracyWarning, match="count time from the start"), pytest.raises(vv.ConvergenceError):
        fast.run(1.7e9 + 1.0)


def test_the_fastest_copy_is_told_once() -> None:
    """Of frequencies that no scene of the others would be told of, and of one that is."""
    copies = driven(1.0, 1e6).ensemble(parameters={"w": [1e-3, 1e-2, 300.0]})
    messages = heard(lambda: copies.run(1e6 + 1.0))
    assert len(messages) == 1
    assert "a rate of the system changes by" in messages[0]
    assert heard(lambda: driven(1.0, 1e6).ensemble(parameters={"w": [1e-3, 1e-2]}).run(1e6 + 1.0)) == []


def test_units_do_not_matter() -> None:
    """Momenta of 1e-30 beside lengths of one."""
    small = vv.Hamiltonian(
        lambda q, p, t, m: p[0] ** 2 / (2 * m) + m * (q[0] ** 2 / 2 - q[0] * np.cos(1.3 * t)),
        ["x"],
        parameters={"m": 1e-30},
        position=[1.0],
        t0=1.7e9,
    )
    assert len(heard(lambda: small.run(1.7e9 + 1.0))) == 1


def test_what_has_no_time_in_it_is_as_exact_there() -> None:
    still = vv.systems.pendulum(position=[1.0]).at(t0=1.7e9)
    assert heard(lambda: still.run(1.7e9 + 1.0)) == []
    # Nor a drive over most of the time since zero.
    assert heard(lambda: driven(1.0, 1e4).run(3e4, method="dop853", rtol=1e-9)) == []


def test_a_rate_that_is_zero_but_for_rounding_is_none() -> None:
    """An isotropic trap in axes that turn: nothing depends on the time, and of a rate of 1e-17 all is rounding."""

    def turning(q, v, t, w):  # type: ignore[no-untyped-def]
        c, s = np.cos(w * t), np.sin(w * t)
        a, b = q[0] * c + q[1] * s, q[1] * c - q[0] * s
        return (v[0] ** 2 + v[1] ** 2) / 2 - (a**2 + b**2) / 2

    for w, t0 in ((1e-3, 1e4), (1.0, 1e6), (0.3, -1e5)):
        trap = vv.Lagrangian(turning, ["x", "y"], parameters={"w": w}, position=[1.0, 0.0], t0=t0)
        assert heard(lambda trap=trap, t0=t0: trap.run(t0 + 1.0)) == []


def test_a_drive_that_acts_away_from_the_start_is_seen_at_the_end() -> None:
    """x² cos(50 t) does nothing at x = 0, where the body begins, and everything where it has come to."""
    away = vv.Lagrangian(
        lambda q, v, t: v[0] ** 2 / 2 - q[0] ** 2 * (1 + np.cos(1.3 * t)) / 2,
        ["x"],
        position=[0.0],
        velocity=[1.0],
        t0=1.7e9,
    )
    assert len(heard(lambda: away.run(1.7e9 + 1.0))) == 1
    assert len(heard(lambda: away.ensemble(velocity=[[1.0], [2.0]]).run(1.7e9 + 1.0))) == 1
