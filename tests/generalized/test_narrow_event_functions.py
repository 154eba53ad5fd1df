"""Events whose functions are narrower than the steps of a run: none of their zeros is missed.

Steps of linear systems, and those of a Taylor series, are as long as a motion allows. A function of the state that is
a thin feature on its way, a contact or a resonance, has its zeros told by bounds over the states that a part of a step
leads through.
"""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

import visviva as vv

X, V = sp.symbols("x v")
SPAN = 40.0
METHODS = ("auto", "dop853", "taylor", "gauss16", "verner98")
#: Functions of x = cos t, each thin.
FUNCTIONS: dict[str, sp.Expr] = {
    "gauss": sp.exp(-(((X - 0.3) / 0.1) ** 2)) - 0.5,
    "thin gauss": sp.exp(-(((X - 0.3) / 1e-4) ** 2)) - 0.5,
    "lorentz": 1 / (1 + ((X - 0.3) / 0.03) ** 2) - 0.5,
    "two switches": sp.tanh((X - 0.25) / 0.05) - sp.tanh((X - 0.35) / 0.05) - 0.5,
    "passing a charge": 1 / sp.sqrt((X - 0.3) ** 2 + 1e-4) - 20,
    "power": (1 - X**2) ** 40 - 0.5,
    "sech": 1 / sp.cosh((X - 0.3) / 0.1) - 0.5,
    "distance": sp.sqrt((X - 0.3) ** 2 + 1e-8) - 1e-3,
}


def oscillator() -> vv.Hamiltonian:
    return vv.Hamiltonian(V**2 / 2 + X**2 / 2, [X], [V], position=[1.0], momentum=[0.0])


def zeros(function: sp.Expr) -> np.ndarray:
    """The times at which it is zero on x = cos t: of a function of x, on both branches of t = ± arccos x + 2πk."""
    of = sp.lambdify(X, function, "numpy")
    x = np.unique(np.concatenate([np.linspace(-1.0, 1.0, 20001), 0.3 + np.linspace(-1e-2, 1e-2, 200001)]))
    values = of(x)
    roots = []
    for k in np.flatnonzero(values[:-1] * values[1:] < 0.0):
        low, high = x[k], x[k + 1]
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if of(middle) * of(low) > 0.0 else (low, middle)
        roots.append(0.5 * (low + high))
    angles = np.arccos(np.array(roots))
    turns = 2.0 * np.pi * np.arange(8)[:, None]
    times = np.concatenate([(turns + angles).ravel(), (turns - angles).ravel()])
    return np.sort(times[(times > 0.0) & (times < SPAN)])


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_no_zero_of_a_thin_function_is_missed(name: str, method: str) -> None:
    expected = zeros(FUNCTIONS[name])
    assert len(expected) >= 24
    found = oscillator().run(SPAN, events=[FUNCTIONS[name]], method=method, rtol=1e-11).events.t
    assert len(found) == len(expected)
    # Where x moves slowest at a zero by 0.9 in a unit of time; of the error of a run in forty units.
    assert found == pytest.approx(expected, rel=0.0, abs=1e-8)


@pytest.mark.parametrize("distance", [0.5, 0.2, 0.1, 0.04])
@pytest.mark.parametrize("method", METHODS)
def test_a_free_particle_stops_at_a_distance_however_long_its_steps_are(method: str, distance: float) -> None:
    x, y, p, q = sp.symbols("x y p q")
    free = vv.Lagrangian((p**2 + q**2) / 2, [x, y], velocities=[p, q], position=[-10.0, 0.03], velocity=[1.0, 0.0])
    contact = vv.events.expression(sp.sqrt(x * x + y * y) - distance, terminal=True)
    out = free.run(40.0, events=[contact], method=method)
    assert out.status == vv.Status.STOPPED
    assert out.t[-1] == pytest.approx(10.0 - np.sqrt(distance**2 - 0.03**2), rel=0.0, abs=1e-11)


@pytest.mark.parametrize("frequency", [6000.0, 20000.0])
def test_dense_zeros_are_all_there(frequency: float) -> None:
    t = sp.Symbol("t")
    out = oscillator().run(10.1, events=[sp.sin(frequency * t + sp.Rational(1, 1000))])
    count = int((frequency * 10.1 + 1e-3) / np.pi)
    assert len(out.events.t) == count
    expected = (np.pi * np.arange(1, count + 1) - 1e-3) / frequency
    # The phase is known to an ulp of 2e5, and a zero by as much of its turn.
    assert np.asarray(out.events.t) == pytest.approx(expected, rel=0.0, abs=1e-14 * frequency / 6000.0 + 4e-15)


def test_more_zeros_than_can_be_looked_for_are_refused_by_name() -> None:
    t = sp.Symbol("t")
    with pytest.raises(vv.ConvergenceError, match="more zeros in one step"):
        oscillator().run(10.1, events=[sp.sin(1e7 * t)])


def test_copies_find_what_each_finds_alone() -> None:
    copies = oscillator().ensemble(position=np.array([[1.0], [0.9], [0.31]]), momentum=np.zeros((3, 1)))
    event = FUNCTIONS["thin gauss"]
    out = copies.run(SPAN, events=[event])
    for copy, start in enumerate((1.0, 0.9, 0.31)):
        alone = vv.Hamiltonian(V**2 / 2 + X**2 / 2, [X], [V], position=[start], momentum=[0.0]).run(
            SPAN, events=[event]
        )
        assert len(alone.events.t) == 26 or start < 0.9
        assert np.array_equal(out.events.t[out.events.member == copy], alone.events.t)


def test_a_state_on_the_edge_of_a_function_is_no_reason_to_end() -> None:
    x, y, p, q = sp.symbols("x y p q")
    kinetic = (p**2 + q**2) / 2
    away = vv.Lagrangian(kinetic, [x, y], velocities=[p, q], position=[-1.0, 0.0], velocity=[-1.0, 0.0])
    # Along the negative axis an angle is π, or -π, and its cosine is -1, or beyond by rounding.
    asked = [sp.atan2(y, x) - 1, sp.acos(x / sp.sqrt(x**2 + y**2)) - 2]
    for system in (away, away.at(velocity=[0.0, 0.0])):
        for method in ("auto", "dop853", "gauss16"):
            out = system.run(10.0, events=asked, method=method)
            assert out.status == vv.Status.OK
            assert len(out.events.t) == 0
