"""SymPy's ``t`` is the time, whatever is assumed of it."""

import numpy as np
import pytest

import visviva as vv

sp = pytest.importorskip("sympy")


@pytest.mark.parametrize("assumed", [{}, {"real": True}, {"positive": True}])
def test_it_is_the_time(assumed: dict[str, bool]) -> None:
    """x'' = −cos t from rest: x = 0.1 − (1 − cos t)."""
    t = sp.Symbol("t", **assumed)
    x, v = sp.symbols("x v", real=True)
    pushed = vv.Lagrangian(v**2 / 2 - sp.cos(t) * x, [x], velocities=[v], position=[0.1])
    assert pushed.run(t=1.0).position[-1, 0] == pytest.approx(0.1 - (1.0 - np.cos(1.0)), rel=1e-12, abs=0.0)
    with pytest.raises(vv.InvalidInput, match="t is the time"):
        vv.Lagrangian(v**2 / 2 - x, [x], velocities=[v], parameters={t: 0.0}, position=[0.1])


def test_functions_of_another_symbol_are_no_coordinates() -> None:
    x = sp.Function("x")(sp.Symbol("t", real=True))
    with pytest.raises(vv.InvalidInput, match=r"no function of the time: that is vv\.time"):
        vv.Lagrangian(x**2, [x])


@pytest.mark.parametrize(("method", "dt"), [("stormer13", 0.1), ("stormer13", 0.2), ("yoshida4", 2.5)])
def test_what_has_blown_up_is_told_wherever_it_ends(method: str, dt: float) -> None:
    """A pendulum that swings by a radian: its energy may come back to a tenth of what it went through."""
    swinging = vv.systems.pendulum(position=[1.0], g=4.0)
    for t in np.linspace(60.0, 96.0, 7):
        with pytest.warns(vv.AccuracyWarning, match="energy"):
            swinging.run(t=float(t), method=method, dt=dt)  # type: ignore[arg-type]
