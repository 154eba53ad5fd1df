"""SciPy's own tests of `solve_ivp`, out of the installed SciPy, with visviva's in its place.

Where a test takes every method in turn, the implicit ones and complex states are SciPy's own; the rest is ours.
"""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import visviva as vv

suite = pytest.importorskip("scipy.integrate._ivp.tests.test_ivp")
original = pytest.importorskip("scipy.integrate").solve_ivp

NOT_OURS = {
    "test_args": "Radau alone; test_solve_ivp.py has the same with explicit methods",
    "test_event_dense_output_LSODA": "LSODA alone",
    "test_integration_complex": "complex states",
    "test_integration_const_jac": "implicit methods alone",
    "test_integration_sparse_difference": "implicit methods alone",
    "test_integration_stiff": "implicit methods alone",
    "test_ConstantDenseOutput": "a class of SciPy",
    "test_OdeSolution": "a class of SciPy",
    "test_classes": "classes of SciPy",
    "test_inital_maxstep": "a function of SciPy",
    "test_no_integration_class": "classes of SciPy",
    "test_num_jac": "a function of SciPy",
    "test_num_jac_sparse": "a function of SciPy",
}
IMPLICIT = ("Radau", "BDF", "LSODA")

for name, found in vars(suite).items():
    if name.startswith("test_") and name not in NOT_OURS:
        globals()[name] = found


@pytest.fixture(autouse=True)
def ours(monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> Iterator[None]:
    calls = {"ours": 0, "scipy": 0}

    def stand_in(fun: Callable[..., Any], t_span: Any, y0: Any, method: Any = "RK45", **options: Any) -> Any:
        name = method.__name__ if isinstance(method, type) else method
        scipys = name in IMPLICIT or np.iscomplexobj(y0)
        calls["scipy" if scipys else "ours"] += 1
        return (original if scipys else vv.solve_ivp)(fun, t_span, y0, method=method, **options)

    monkeypatch.setattr(suite, "solve_ivp", stand_in)
    yield
    if not any(method in request.node.name for method in IMPLICIT) and "left_out" not in request.node.name:
        assert calls["ours"], "the test asks nothing of visviva"


def test_the_names_that_are_left_out_are_there() -> None:
    assert all(hasattr(suite, name) for name in NOT_OURS)
    # The suite of SciPy 1.13 has more than twenty that are ours.
    assert sum(name.startswith("test_") for name in globals()) > 18
