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
