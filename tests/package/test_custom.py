"""Functions of one's own as potentials: sampled once, met to a tolerance that is checked, filed as built.

Bounds: a table holds the tolerance that it was made with; runs and integrals along it, ten times what they reach at
the default of 1e-12.
"""

import ctypes
import ctypes.util
import math
import pickle
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva.potentials import Custom, LennardJones, PiecewisePolynomial

WELL = LennardJones(epsilon=1.0, sigma=1.0)
MADE = Custom(WELL.value, 0.8, 8.0)


@pytest.mark.parametrize(
    ("function", "r_min", "r_max"),
    [
        (WELL.value, 0.4, 30.0),
        (lambda r: np.exp(-r) / r, 1e-6, 300.0),
        (lambda r: 1.0 / np.sqrt(1.0 + r**4), 0.0, 50.0),
        (lambda r: np.sin(20.0 * r), 0.0, 10.0),
        (lambda r: 1e-200 / r, 1e-100, 1e-80),
        (lambda r: np.where(r < 2.0, (2.0 - r) ** 8, 0.0), 1.0, 3.0),
    ],
    ids=["well", "yukawa", "soft", "waves", "small", "cutoff"],
)
@pytest.mark.parametrize("tolerance", [1e-5, 1e-8, 1e-12])
def test_the_tolerance_is_met_where_it_was_not_checked(
    function: Any, r_min: float, r_max: float, tolerance: float
) -> None:
    made = Custom(function, r_min, r_max, tolerance=tolerance)
    assert made.error <= tolerance
    rng = np.random.default_rng(3)
    r = np.concatenate([rng.uniform(r_min, r_max, 5000), np.geomspace(max(r_min, 1e-3), r_max, 5000)])
    r = np.clip(r, r_min, r_max)
    piece = np.clip(np.searchsorted(made.breaks, r, side="right") - 1, 0, len(made.breaks) - 2)
    largest = np.array([np.abs(function(np.linspace(a, b, 50))).max() for a, b in pairwise(made.breaks)])[piece]
    change = made.breaks[piece + 1] * np.abs(made.force(r))
    size = np.abs(function(r)) + np.clip(change, 0.01 * largest, 100.0 * largest)
    # Nothing is met relative to itself where it comes to zero: there is a floor of 1e-16 of what is within an octave.
    size += 1e-16 * np.abs(function(np.maximum(r / 2.0, r_min)))
    # Between its places a polynomial errs by little more than in them, but for what rounding of the function (of
    # sin 20 r by 1e-14) makes of second derivatives that are made to agree.
    assert np.all(np.abs(made.value(r) - function(r)) <= (1.5 * tolerance + 3e-12) * size)


def test_force_and_curvature_are_those_of_the_function() -> None:
    r = np.linspace(0.81, 7.9, 1001)
    # Of pieces of relative width 1/20 and polynomials of degree 13: a derivative takes 13² · 20 digits at most.
    assert np.all(np.abs(MADE.force(r) - WELL.force(r)) <= 1e-9 * (np.abs(WELL.force(r)) + np.abs(WELL.value(r))))
    assert np.all(np.abs(MADE.curvature(r) - WELL.curvature(r)) <= 1e-6 * (np.abs(WELL.curvature(r)) + 1e-3))
    ends = MADE.breaks[1:-1]
    for asked in (MADE.value, MADE.force, MADE.curvature):
        after, before = asked(ends), asked(np.nextafter(ends, 0.0))
        assert np.abs(after - before).max() <= 1e-11 * np.abs(asked(r)).max()


def test_it_is_what_was_built(tmp_path: Path) -> None:
    asked = []

    def function(r: Any) -> Any:
        asked.append(len(r))
        return WELL.value(r)

    made = Custom(function, 0.8, 8.0)
    count = len(asked)
    assert isinstance(made, PiecewisePolynomial)
    assert made == MADE
    assert hash(made) == hash(MADE)
    assert pickle.loads(pickle.dumps(made)) == made
    bodies = vv.Particles([1.0, 1.0], [[0, 0, 0], [1.2, 0, 0]], [[0, 0, 0], [0, 0.1, 0]])
    scene = vv.Scene(bodies, vv.PairPotential(made))
    out = scene.run(t=np.linspace(0.0, 5.0, 11), rtol=1e-11)
    assert np.ptp(out.energy) < 2e-11
    # The force is that of the well to 1e-10, over a span of few periods.
    same = vv.Scene(bodies, vv.PairPotential(WELL)).run(t=out.t, rtol=1e-11)
    assert np.abs(out.position - same.position).max() < 1e-7
    out.save(tmp_path / "run.npz")
    assert vv.load(tmp_path / "run.npz").final.forces == scene.forces
    assert len(asked) == count, "the function is asked when it is built, and not again"


def test_units_of_powers_of_two_change_no_bit() -> None:
    scaled = MADE.rescaled(length=2.0**100, mass=2.0**-300, time=2.0**10)
    r = np.random.default_rng(1).uniform(0.8, 8.0, 500)
    energy = 2.0 ** (200 - 300 - 20)
    assert np.array_equal(scaled.value(r * 2.0**100), MADE.value(r) * energy)
    assert np.array_equal(scaled.force(r * 2.0**100), MADE.force(r) * (energy / 2.0**100))


@pytest.mark.parametrize(
    ("function", "given", "argument", "words"),
    [
        (3.5, {}, "function", "got float"),
        (lambda r: 1.0, {}, "function", "one value for each r"),
        (lambda r: 1j * r, {}, "function", "complex128"),
        (lambda r: 1.0 / (r - 2.0), {}, "function", "got inf at r = 2"),
        (lambda r: np.abs(r - 1.5), {}, "function", "pieces it is met to"),
        (lambda r: np.sign(r - 1.3), {"tolerance": 1e-4}, "function", "pieces it is met to"),
        (np.sqrt, {"r_min": 0.0}, "function", "at worst, from r = 0"),
        (lambda r: r, {"r_min": -1.0}, "r_min", "-1"),
        (lambda r: r, {"r_max": 0.5}, "r_max", "beyond r_min"),
        (lambda r: r, {"tolerance": 1e-13}, "tolerance", "from 1e-12 to 1e-4"),
    ],
)
def test_what_cannot_be_met_is_refused_by_name(
    function: Any, given: dict[str, float], argument: str, words: str
) -> None:
    with np.errstate(divide="ignore"), pytest.raises(vv.InvalidInput, match=words) as caught:
        Custom(function, **({"r_min": 1.0, "r_max": 2.0} | given))
    assert caught.value.argument == argument


def test_what_the_function_raises_is_raised() -> None:
    with pytest.raises(ZeroDivisionError):
        Custom(lambda r: r / (1 // 0), 1.0, 2.0)


def test_compiled_functions_are_called() -> None:
    library = ctypes.CDLL(ctypes.util.find_library("m"))
    erfc = library.erfc
    erfc.restype, erfc.argtypes = ctypes.c_double, [ctypes.c_double]
    address = ctypes.cast(erfc, ctypes.c_void_p).value
    made = Custom(erfc, 0.1, 5.0)
    assert Custom(address, 0.1, 5.0) == made
    assert float(made.value(1.25)) == pytest.approx(math.erfc(1.25), rel=1e-12, abs=0)
    with pytest.raises(vv.InvalidInput, match=r"double f\(double r\), got void\(\)"):
        Custom(ctypes.CFUNCTYPE(None)(), 1.0, 2.0)


def test_a_cfunc_of_numba_is_called() -> None:
    numba = pytest.importorskip("numba")
    compiled = numba.cfunc("float64(float64)")(lambda r: 1.0 / (r * r))
    made = Custom(compiled, 1.0, 4.0)
    assert float(made.value(2.0)) == pytest.approx(0.25, rel=1e-14, abs=0)
    other = numba.cfunc("float64(float64, float64)")(lambda r, s: r * s)
    with pytest.raises(vv.InvalidInput, match=r"got double\(double,double\)"):
        Custom(other, 1.0, 4.0)


def test_a_low_level_callable_is_called() -> None:
    scipy = pytest.importorskip("scipy")
    library = ctypes.CDLL(ctypes.util.find_library("m"))
    library.erfc.restype, library.erfc.argtypes = ctypes.c_double, [ctypes.c_double]
    made = Custom(scipy.LowLevelCallable(library.erfc), 0.1, 5.0)
    assert made == Custom(library.erfc, 0.1, 5.0)
