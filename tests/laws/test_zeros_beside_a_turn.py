"""Two zeros of an event on either side of a place where it turns, between two nodes of a step: both are found.

x = cos t: it passes 1 - d twice in every period, √(2d) before and after its maximum, wherever the steps have nodes.

Bounds: a zero beside a turn is found to the error of the function over its slope, √(2d): ten times what it is off by.
"""

from collections.abc import Callable

import numpy as np
import pytest

import visviva as vv

SWING = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 0.5, 0.0]]), vv.Harmonic(1.0))


def plane(d: float, **how: object) -> vv.events.Event:
    return vv.events.plane([1.0 - d, 0.0, 0.0], [1.0, 0.0, 0.0], **how)


# As near as the method errs itself over that time, and a decade nearer than an error of 1e-9 in a step would be.
@pytest.mark.parametrize(
    ("method", "how", "distances"),
    [
        ("taylor", {}, [1e-3, 5e-4, 2e-4, 1e-4, 1e-5, 1e-6]),
        ("taylor", {"rtol": 1e-13}, [1e-4, 1e-7]),
        ("dop853", {"rtol": 1e-12}, [1e-3, 1e-5, 1e-6]),
        ("verner98", {"rtol": 1e-12}, [1e-3, 1e-5, 1e-6]),
        ("dormand_prince54", {"rtol": 1e-12}, [1e-3, 1e-6]),
    ],
)
def test_both_zeros_beside_every_maximum(method: str, how: dict[str, float], distances: list[float]) -> None:
    end = 1000.0
    out = SWING.run(end, method=method, events=[plane(d) for d in distances], **how)
    for index, d in enumerate(distances):
        half = np.arccos(1.0 - d)
        turns = 2.0 * np.pi * np.arange(1, 160)
        expected = np.sort(np.concatenate([[half], turns - half, turns + half]))
        expected = expected[expected <= end]
        found = out.events.t[out.events.which == index]
        assert len(found) == len(expected), d
        # A place that is off by 1e-9 passes the plane that much over its speed, √(2d), earlier or later.
        assert np.abs(found - expected).max() < 1e-9 / half


@pytest.mark.parametrize("phase", np.linspace(0.1, 6.2, 24))
@pytest.mark.parametrize("d", [1e-4, 1e-6])
def test_a_terminal_event_ends_the_run_at_the_first_of_both(phase: float, d: float) -> None:
    body = vv.Particles([1.0], [[np.cos(phase), 0.0, 0.0]], [[-np.sin(phase), 0.5, 0.0]])
    out = vv.Scene(body, vv.Harmonic(1.0)).run(7.0, method="taylor", events=[plane(d, terminal=True)])
    assert out.status.name == "STOPPED"
    first = 2.0 * np.pi - phase - np.arccos(1.0 - d)
    assert out.events.t[-1] == pytest.approx(first, abs=2e-12 / np.sqrt(d))


def test_in_a_magnetic_field_by_its_closed_form() -> None:
    scene = vv.Scene(
        vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]]),
        vv.UniformMagneticField([0.0, 0.0, 1.0], charge=[1.0]),
    )
    run = scene.run(200.0, rtol=1e-12, events=[vv.events.plane([0.0, -2.0 + 1e-6, 0.0], [0.0, 1.0, 0.0])])
    expected = 2 * len([k for k in range(40) if np.pi + 2.0 * np.pi * k < 199.9])
    assert len(run.events) == expected


PHASES = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
NARROW = 0.4  # Half the smaller axis of an ellipse x = cos t, y = 0.4 sin t.


def equal_steps(event: vv.events.Event | Callable[..., float], phase: float, method: str, dt: float) -> np.ndarray:
    """When two bodies opposite each other on halves of the ellipse have the event, from this phase on to t = 6."""
    place = np.array([np.cos(phase), NARROW * np.sin(phase), 0.0])
    speed = np.array([-np.sin(phase), NARROW * np.cos(phase), 0.0])
    bodies = vv.Particles([1.0, 1.0], [0.5 * place, -0.5 * place], [0.5 * speed, -0.5 * speed])
    return np.array(vv.Scene(bodies, vv.Harmonic(1.0)).run(6.0, method=method, dt=dt, events=[event]).events.t)


# A node of the samples of a step falls between both zeros, or just beside them, at one phase or another; the cubic
# through the ends of a step of 0.25 is 1e-5 off, ten times as much as x = -0.99999 is short of the turn.
@pytest.mark.parametrize("d", [1e-4, 1e-5])
@pytest.mark.parametrize("kind", ["plane", "greatest", "least", "function"])
# In steps of 0.6 the cubic turns beside another sample than the motion.
@pytest.mark.parametrize(
    ("method", "dt", "off"), [("kahan_li8", 0.25, 1e-8), ("stormer13", 0.08, 1e-8), ("kahan_li8", 0.6, 1e-5)]
)
def test_both_zeros_within_one_equal_step(kind: str, d: float, method: str, dt: float, off: float) -> None:
    least, period = NARROW * (1.0 + d), np.pi
    half = np.arccos(np.sqrt((least**2 - NARROW**2) / (1.0 - NARROW**2)))
    event: vv.events.Event | Callable[..., float]
    if kind == "plane":
        event, half, period = vv.events.plane([0.5 * (d - 1.0), 0, 0], [1, 0, 0]), np.arccos(d - 1.0), 2.0 * np.pi
    elif kind == "greatest":
        event = vv.events.distance(0, 1, below=1.0 - d, direction=0)
        half = np.arcsin(np.sqrt((1.0 - (1.0 - d) ** 2) / (1.0 - NARROW**2)))
    elif kind == "least":
        event = vv.events.distance(0, 1, below=least, direction=0)
    else:
        event = lambda t, x, v: ((x[0] - x[1]) ** 2).sum() - least**2  # noqa: E731
    for phase in PHASES[:: 8 if kind == "function" else 1]:
        turns = period * np.arange(-3, 5) - phase
        expected = np.sort(np.concatenate([turns - half, turns + half]))
        expected = expected[(expected > 0.0) & (expected < 6.0)]
        # The methods are within 1e-11 of the place in a turn, in ten steps within 1e-8; there the slope is √d or more.
        np.testing.assert_allclose(equal_steps(event, phase, method, dt), expected, rtol=0.0, atol=off)
