"""The action of motions and paths, and its variations: Hamilton's principle, and where it is a minimum."""

from typing import Any

import numpy as np
import pytest

import visviva as vv


def hat(t: Any, end: float = 2.0) -> Any:
    """A variation that vanishes at both ends."""
    return np.sin(np.pi * t / end) * np.exp(t / 3.0)


def test_the_action_of_a_path_is_its_integral() -> None:
    """x = sin t, L = v²/2 − x²/2: S = ∫ cos 2t /2 dt = sin 2T/4."""
    swing = vv.systems.oscillator(k=1.0, m=1.0, position=[0.0], velocity=[1.0])
    for end in (0.5, 3.0, -2.0):
        exact = np.sin(2.0 * end) / 4.0
        assert abs(swing.action(end) - exact) < 4e-13
        assert abs(swing.action(end, path=np.sin) - exact) < 4e-13
        assert abs(swing.action(end, path=lambda t: np.sin(t)[:, None]) - exact) < 4e-13
    assert swing.action(0.0) == 0.0


def test_an_action_knows_time_and_several_coordinates() -> None:
    """L = v·v/2 + t x y along (t, t²): ∫ (1 + 4t²)/2 + t⁴ dt."""
    system = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 + t * q[0] * q[1], ["x", "y"], position=[0.0, 0.0], t0=1.0
    )
    exact = sum(c * (2.0**k - 1.0) for c, k in ((0.5, 1), (2 / 3, 3), (0.2, 5)))
    assert abs(system.action(2.0, path=lambda t: np.stack([t, t**2], axis=1)) - exact) < 1e-12 * exact


@pytest.mark.parametrize(
    "system",
    [
        vv.systems.pendulum(position=[2.5]),
        vv.systems.double_pendulum(position=[1.0, -0.5]),
        vv.systems.charged_particle(),
        vv.systems.kapitza(Omega=9.0),
        vv.systems.swinging_atwood(),
    ],
    ids=repr,
)
def test_the_action_of_a_motion_is_stationary(system: vv.Lagrangian) -> None:
    n = len(system.coordinates)
    shape = np.linspace(1.0, 2.0, n)

    def variation(t: Any) -> Any:
        return hat(t)[:, None] * shape

    path_of = system.run(2.0 * np.linspace(0.0, 1.0, 5))
    size = abs(system.action(2.0)) + np.abs(path_of.momentum).max()
    # The tolerance of the run, by an integral over two units of time.
    assert abs(system.first_variation(2.0, variation)) < 2e-10 * size
    # What does not vanish at the ends changes the action by the momenta there: dS = p η, at the end less at the start.
    grows = system.first_variation(2.0, lambda t: t[:, None] * shape)
    assert abs(grows - 2.0 * path_of.momentum[-1] @ shape) < 1e-9 * size


def test_variations_are_the_derivatives_of_the_action() -> None:
    """S(q + εη) = S + ε δS + ε² δ²S/2 + O(ε³), along a path that is no motion."""
    double = vv.systems.double_pendulum(position=[0.0, 0.0])

    def path(t: Any) -> Any:
        return np.stack([0.3 * t**2, np.sin(t)], axis=1)

    def variation(t: Any) -> Any:
        return np.stack([np.cos(t), t * (2.0 - t)], axis=1)

    epsilon = 1e-3
    moved = [
        double.action(2.0, path=lambda t, step=step: path(t) + step * variation(t))
        for step in (-2 * epsilon, -epsilon, 0.0, epsilon, 2 * epsilon)
    ]
    first = (moved[0] - 8 * moved[1] + 8 * moved[3] - moved[4]) / (12 * epsilon)
    second = (-moved[0] + 16 * moved[1] - 30 * moved[2] + 16 * moved[3] - moved[4]) / (12 * epsilon**2)
    size = abs(moved[2]) + 1.0
    # Differences of the fourth order: 1e-12 of the fifth derivative, and the rounding of S over ε and ε².
    assert abs(double.first_variation(2.0, variation, path=path) - first) < 1e-8 * size
    assert abs(double.second_variation(2.0, variation, path=path) - second) < 1e-5 * size


def test_an_oscillators_action_is_least_for_half_a_period() -> None:
    """(m/2T)(π² − ω²T²) of η = sin πt/T changes its sign at T = π/ω."""
    m, k = 1.5, 6.0
    swing = vv.systems.oscillator(k=k, m=m, position=[1.0])
    half = np.pi / np.sqrt(k / m)
    for end in (0.5 * half, (1 - 1e-6) * half, (1 + 1e-6) * half, 2.5 * half):
        found = swing.second_variation(end, lambda t, end=end: np.sin(np.pi * t / end))
        exact = m / (2 * end) * (np.pi**2 - k / m * end**2)
        assert abs(found - exact) < 1e-11 * m / end * np.pi**2
        assert (found > 0) == (end < half)


@pytest.mark.parametrize(
    ("call", "argument", "message"),
    [
        (lambda s: s.action("2"), "t", "number"),
        (lambda s: s.action(1.0, path=3.0), "path", "expected a function of times"),
        (lambda s: s.action(1.0, path=lambda t: np.ones((len(t), 2))), "path", r"of shape \(128, 1\) at 128 times"),
        (lambda s: s.action(1.0, path=lambda t: t * np.nan), "path", "finite"),
        (lambda s: s.first_variation(1.0, None), "variation", "expected a function of times"),
        (lambda s: s.second_variation(1.0, lambda t: 1.0), "variation", "shape"),
    ],
)
def test_what_is_no_path_is_refused(call: Any, argument: str, message: str) -> None:
    with pytest.raises(vv.InvalidInput, match=message) as caught:
        call(vv.systems.pendulum(position=[1.0]))
    assert caught.value.argument == argument


def test_a_path_with_a_kink_is_told() -> None:
    with pytest.raises(vv.ConvergenceError, match="does not settle: expected it, and its variation, to be smooth"):
        vv.systems.pendulum().action(1.0, path=lambda t: np.sqrt(np.abs(t - 0.3)))
