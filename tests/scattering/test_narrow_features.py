"""Shells, wells and edges that are narrow against their distance: no grid and no equal steps meet them alone."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import mpmath as mp
import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable

s = vv.scattering
V = vv.potentials

#: Where the shells are: on no power of two, nor a sixteenth part of an octave.
RADIUS = 1.03
#: What they are in: nothing, or a core that repels.
CORES = {"alone": 0.0, "about a core": 0.25}


def shell(r: mp.mpf, height: float, width: float, core: float, exp: Callable[[mp.mpf], mp.mpf] = mp.exp) -> mp.mpf:
    return core * exp(-r) / r + height * exp(-(((r - RADIUS) / width) ** 2))


def formula(height: float, width: float, core: float) -> vv.potentials.Potential:
    return V.Custom(lambda r, h, w, c: shell(r, h, w, c, np.exp), parameters={"h": height, "w": width, "c": core})


def sampled(height: float, width: float, core: float) -> vv.potentials.Potential:
    # Of what is narrower the function itself is rounded by more than 1e-12.
    tolerance = 1e-12 if width >= 1e-3 else 1e-9
    return V.Custom(lambda r: shell(r, height, width, core, np.exp), 0.01, 60.0, tolerance=tolerance)


def turning_point(energy: float, b: float, height: float, width: float, core: float) -> mp.mpf:
    """The outermost zero of 1 − V/E − b²/r²: from far out inward, in steps that no shell escapes."""

    def rest(r: mp.mpf) -> mp.mpf:
        return 1 - shell(r, height, width, core) / energy - (b / r) ** 2

    within = [mp.mpf(RADIUS) + width * mp.mpf(k) / 64 for k in range(512, -513, -1)]
    far = [mp.mpf(60) * mp.mpf("0.97") ** k for k in range(600)]
    places = sorted({*within, *far, mp.mpf(b)}, reverse=True)
    for outer, inner in pairwise(places):
        if rest(inner) < 0:
            low, high = inner, outer
            for _ in range(170):
                middle = (low + high) / 2
                low, high = (middle, high) if rest(middle) < 0 else (low, middle)
            return high
    raise AssertionError("no turning point")


def angle(energy: float, b: float, height: float, width: float, core: float) -> mp.mpf:
    """ψ by the textbook's integral, cut at the edges of the shell; nothing is shared with the core."""
    with mp.workdps(40):
        first = turning_point(energy, b, height, width, core)

        def integrand(t: mp.mpf) -> mp.mpf:
            # u = u₀(1 − t²).
            u = (1 - t * t) / first
            rest = 1 - (b * u) ** 2 - shell(1 / u, height, width, core) / energy
            return 2 * t / first / mp.sqrt(abs(rest))

        edges = [mp.mpf(RADIUS) + width * k for k in (-9, -7, -5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 5, 7, 9)]
        marks = [mp.mpf(10) ** -k for k in range(1, 9)] + [mp.mpf(k) / 16 for k in range(2, 16)]
        marks += [mp.sqrt(1 - first / edge) for edge in edges if edge > first]
        marks = [mp.mpf("1e-12"), *sorted(mark for mark in marks if mark > mp.mpf("1e-9")), 1 - mp.mpf("1e-3"), 1]
        value = mp.quad(integrand, sorted(marks), method="gauss-legendre")
        # Of what is left out at the turning point: the integrand is even there.
        value += mp.mpf("1e-12") * integrand(mp.mpf("1e-12"))
        return mp.pi - 2 * b * value


CASES = [
    (energy, b, height, width, core)
    for width in (3e-2, 3e-3, 1e-4, 1e-6)
    for energy, b, height, core in (
        (0.5, 0.3, 1.0, 0.0),
        (2.0, 0.9, 1.0, 0.0),
        (2.0, 0.5, -1.0, 0.25),
        (2.0, 0.2, 1e-3, 0.25),
    )
]


@pytest.mark.parametrize(("energy", "b", "height", "width", "core"), CASES)
@pytest.mark.parametrize("made", [formula, sampled])
def test_angles_of_narrow_shells(
    made: Callable[..., vv.potentials.Potential], energy: float, b: float, height: float, width: float, core: float
) -> None:
    """They were 0 with an error of 0, or off by 1e-6 with an error of 1e-14 claimed."""
    if made is sampled and width < 1e-4:
        # Narrower than a 4096th of its distance: what no look meets cannot be known.
        return
    if made is sampled and width == 3e-2 and core == 0.0:
        # Its tails fall below all numbers where it is still looked at, and have no digits before that.
        with pytest.raises(vv.InvalidInput, match="function: expected a smooth one"):
            made(height, width, core)
        return
    potential = made(height, width, core)
    found = s.deflect(potential, energy=energy, impact_parameter=b)
    alone = float(s.deflection_angle(potential, energy=energy, impact_parameter=b))
    expected = float(angle(energy, b, height, width, core))
    # A distance is known to 1e-16, and V changes that much faster; what that leaves is not told from what sums leave.
    rounding = 1e-12 + 4e-15 / width
    assert float(found.status) == s.DeflectionStatus.SCATTERED
    for value in (float(found.angle), alone):
        if made is sampled:
            # The potential itself is off by its tolerance times its steepness.
            assert value == pytest.approx(expected, rel=0.0, abs=1e-10 if width >= 1e-3 else 1e-7)
        else:
            assert value == pytest.approx(expected, rel=0.0, abs=min(rounding, float(found.error) + 1e-15))
    assert float(found.error) <= 20.0 * rounding


@pytest.mark.parametrize("width", [3e-3, 1e-4, 1e-5])
def test_a_sampled_function_has_the_shells_it_is_sampled_from(width: float) -> None:
    """Its long pieces agreed with it wherever they were looked at, and there was no shell in them."""
    if width > 5e-5:
        potential = sampled(1.0, width, 0.0)
    else:
        # What no look meets cannot be known; where the range is cut it is.
        potential = V.Custom(lambda r: np.exp(-(((r - RADIUS) / width) ** 2)), 1.0299, 1.0301, tolerance=1e-8)
    for k in (-2.0, -0.5, 0.0, 1.0):
        r = RADIUS + k * width
        expected, off = np.exp(-(((r - RADIUS) / width) ** 2)), 1e-9 if width > 1e-3 else 1e-6
        assert float(potential.value(r)) == pytest.approx(expected, rel=0.0, abs=off)


@pytest.mark.parametrize("width", [3e-3, 1e-5])
@pytest.mark.parametrize("height", [1.0, 1e-2])
def test_orbits_and_rainbows_of_narrow_shells(height: float, width: float) -> None:
    potential, energy = formula(height, width, 0.25), 2.0
    with mp.workdps(40):

        def effective(r: mp.mpf) -> mp.mpf:
            return r * r * (1 - shell(r, height, width, 0.25) / energy)

        # Where h(r) is least on the way in something orbits, if it is positive and less than farther out.
        r = [mp.mpf(RADIUS) + width * mp.mpf(k) / 256 for k in range(-2048, 2049)]
        h = [effective(each) for each in r]
        least: list[mp.mpf] = []
        for k in range(len(r) - 2, 0, -1):
            if h[k] < h[k - 1] and h[k] < h[k + 1]:
                low, high = r[k - 1], r[k + 1]
                for _ in range(80):
                    third = (high - low) / 3
                    if effective(low + third) < effective(high - third):
                        high -= third
                    else:
                        low += third
                value = effective(low)
                if value > 0 and (not least or value < least[0] ** 2):
                    least.insert(0, mp.sqrt(value))
    found = s.orbiting(potential, energy=energy)
    assert len(found) == len(least)
    for orbit, expected in zip(found, least, strict=True):
        assert orbit.impact_parameter == pytest.approx(float(expected), rel=1e-10, abs=0.0)
    # Rainbows are all those that a fine grid sees.
    edges = [orbit.impact_parameter for orbit in found]
    marks = s.rainbows(potential, energy=energy)
    b = np.unique(np.concatenate([np.geomspace(1e-3, 3.0, 4001), RADIUS + width * np.linspace(-12.0, 4.0, 4001)]))
    slope = s.deflect(potential, energy=energy, impact_parameter=b).derivative
    for left, right in zip([0.0, *edges], [*edges, 3.0], strict=True):
        inside = slope[(b > left) & (b < right)]
        turns = int((np.sign(inside[:-1]) != np.sign(inside[1:])).sum())
        here = [mark for mark in marks if left < mark.impact_parameter < right]
        assert len(here) >= turns
        for mark in here:
            beside = mark.impact_parameter + 1e-4 * width * np.array([-1, 1])
            left_of, right_of = s.deflect(potential, energy=energy, impact_parameter=beside).derivative
            assert left_of * right_of <= 0.0


@pytest.mark.parametrize(("energy", "width"), [(0.5, 1e-3), (2.0, 1e-3)])
@pytest.mark.parametrize("made", [formula, sampled])
def test_transport_of_narrow_shells(made: Callable[..., vv.potentials.Potential], energy: float, width: float) -> None:
    """It took minutes. The integral over b here is one of many points, cut wherever the shell may be felt."""
    potential = made(1.0, width, 0.25)
    started = time.perf_counter()
    found = float(s.transport_cross_section(potential, energy=energy))
    assert time.perf_counter() - started < 60.0
    edges = [orbit.impact_parameter for orbit in s.orbiting(potential, energy=energy)]
    off = np.geomspace(1e-12, 0.4, 640)
    away = np.geomspace(8.0, 500.0, 160)
    marks = np.concatenate(
        [
            np.linspace(0.0, 2.0, 161),
            np.geomspace(1e-8, 55.0, 200),
            RADIUS + width * np.concatenate([-away, np.linspace(-8.0, 8.0, 641), away]),
            *(edge + sign * off for edge in edges for sign in (-1.0, 1.0)),
            edges,
        ]
    )
    marks = np.unique(marks[(marks >= 0.0) & (marks < 55.0)])
    x, w = np.polynomial.legendre.leggauss(10)
    b = 0.5 * (marks[1:] + marks[:-1])[:, None] + 0.5 * np.diff(marks)[:, None] * x
    angle = s.deflection_angle(potential, energy=energy, impact_parameter=b)
    whole = float((np.diff(marks)[:, None] * w * 2.0 * np.pi * np.sin(0.5 * angle) ** 2 * b).sum())
    assert found == pytest.approx(whole, rel=1e-9, abs=0.0)


@pytest.mark.parametrize("a", [1e3, 1e5, 1e7])
def test_morse_wells_steep_without_measure(a: float) -> None:
    """Newton's steps came nearer to a turning point by a width each, and ended before it: no number, status 0."""
    well = V.Morse(1.0, a, RADIUS)
    found = s.deflect(well, energy=2.0, impact_parameter=[0.1, 0.5, 0.9])
    assert (found.status == s.DeflectionStatus.SCATTERED).all()
    # In the limit a hard sphere, but for what the well turns: by less than its width.
    sphere = s.deflect(V.HardSphere(RADIUS), energy=2.0, impact_parameter=[0.1, 0.5, 0.9])
    assert np.abs(found.angle - sphere.angle).max() < 12.0 / a
    assert (found.error < 1e-13 * a).all()


def test_what_never_ends_to_oscillate_is_refused() -> None:
    restless = V.Custom(lambda r: np.cos(1e9 * r) / (1.0 + r * r))
    with pytest.raises(vv.InvalidInput, match="can be resolved") as refused:
        s.deflect(restless, energy=1.0, impact_parameter=0.5)
    assert refused.value.argument == "potential"
    # Where that is too little to be felt it is no matter.
    assert np.isfinite(s.deflection_angle(restless, energy=1e30, impact_parameter=0.5))


LINES = s.Spectrum([0.8, 1.0, 2.4], [1.0, 2.0, 1.0])
BEAM: dict[str, Any] = {"masses": (1.0, 4.0), "b_max": 1.5, "seed": 7, "n_events": 200_000, "bins": 60}


def counts(threads: int) -> list[int]:
    """Of every beam energy and both ways to give the potential."""
    all_counts: list[int] = []
    for potential in (formula(0.9, 1e-3, 0.25), sampled(0.9, 1e-3, 0.25)):
        result = s.monte_carlo(
            potential, beam_energy=LINES, tally=[("lab_angle", "energy"), "cm_angle"], threads=threads, **BEAM
        )
        all_counts += result["cm_angle"].counts.tolist() + result["lab_angle", "energy"].counts.ravel().tolist()
    return all_counts


def test_events_of_narrow_shells() -> None:
    """Tables are certified beside shells, too; the counts are those of any threads and any tier."""
    one = counts(1)
    assert one == counts(3)
    code = f"from {__name__} import counts; print(counts(2))"
    environment = {**os.environ, "VISVIVA_SIMD": "portable"}
    other = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment, timeout=600
    )
    assert other.stdout.strip() == str(one)
    beam: dict[str, Any] = {**{key: BEAM[key] for key in ("masses", "b_max", "seed")}, "n_events": 20_000}
    events = s.scattering_events(formula(0.9, 1e-3, 0.25), beam_energy=1.5, **beam)
    direct = s.deflection_angle(formula(0.9, 1e-3, 0.25), energy=1.5 * 0.8, impact_parameter=events["impact_parameter"])
    off = np.abs(np.sin(0.5 * events["deflection"]) ** 2 - np.sin(0.5 * direct) ** 2)
    assert off.max() < 4e-6
