"""What a method tells of itself, against what follows from it.

Bounds: a step by the coefficients, in another order of its some ten sums.
"""

import pickle

import numpy as np
import pytest

import visviva as vv

METHODS = {method.name: method for method in vv.methods()}
RUNGE_KUTTA = [name for name, method in METHODS.items() if "b" in method.coefficients]
SPLITTINGS = [name for name, method in METHODS.items() if "kicks" in method.coefficients]
# Sums of some tens of coefficients of up to a few tens.
ROUNDING = 1e-14


def test_every_method_has_coefficients_of_a_kind() -> None:
    kinds = {name: set(method.coefficients) for name, method in METHODS.items()}
    multistep = {name for name, kind in kinds.items() if kind == {"second_differences", "velocity"}}
    # A series has the coefficients of the motion.
    assert {name for name, kind in kinds.items() if not kind} == {"taylor"}
    assert kinds.keys() == {*RUNGE_KUTTA, *SPLITTINGS, *multistep, "taylor"}
    assert multistep == {"stormer13"}
    adaptive = {name for name, method in METHODS.items() if method.adaptive}
    assert {name for name, kind in kinds.items() if "error" in kind} == adaptive - {"taylor"}


@pytest.mark.parametrize("listed", [vv.methods(), vv.rigid.methods()], ids=["points", "bodies"])
def test_methods_read_as_a_table(listed: list[vv.Method]) -> None:
    lines = repr(listed).splitlines()
    assert lines[0] == f"{len(listed)} methods"
    assert lines[1].split() == ["method", "order", "stages", "kind", "for", "what"]
    kind = slice(lines[1].index("kind"), lines[1].index("for what"))
    for line, method in zip(lines[2:-1], listed, strict=True):
        assert line.split()[:3] == [method.name, str(method.order), str(method.stages)]
        for word in ("symplectic", "reversible", "adaptive"):
            assert (word in line[kind]) == getattr(method, word)
    shown = listed._repr_html_()  # type: ignore[attr-defined]
    assert shown.startswith(f"<table><caption>{len(listed)} methods</caption>")
    assert shown.count("<tr>") == len(listed) + 1
    # A list all the same.
    assert isinstance(listed, list)
    assert pickle.loads(pickle.dumps(listed)) == listed == list(listed)


@pytest.mark.parametrize("name", RUNGE_KUTTA)
def test_a_runge_kutta_method_is_consistent_and_of_its_order(name: str) -> None:
    """Σ b cᵏ⁻¹ = 1/k up to the order, and the nodes are the row sums."""
    method = METHODS[name]
    a, b, c = (method.coefficients[key] for key in "abc")
    # The first stage of the next step is the last one of this, where it is counted once.
    assert len(b) in (method.stages, method.stages + 1)
    assert np.abs(np.triu(a)).max(initial=0.0) == 0.0
    np.testing.assert_allclose(a.sum(axis=1), c, rtol=0, atol=ROUNDING * max(1.0, np.abs(a).max(initial=0.0)))
    for k in range(1, method.order + 1):
        assert b @ c ** (k - 1) == pytest.approx(1.0 / k, abs=ROUNDING)
    assert abs(b @ c**method.order - 1.0 / (method.order + 1)) > 1e-6 or method.order >= 8
    if "error" in method.coefficients:
        assert abs(method.coefficients["error"].sum()) < ROUNDING


@pytest.mark.parametrize("name", SPLITTINGS)
def test_a_splitting_goes_one_step_and_is_as_reversible_as_it_says(name: str) -> None:
    kicks, drifts = (METHODS[name].coefficients[key] for key in ("kicks", "drifts"))
    assert len(kicks) == len(drifts) + 1
    assert kicks.sum() == pytest.approx(1.0, abs=ROUNDING)
    assert drifts.sum() == pytest.approx(1.0, abs=ROUNDING)
    palindrome = np.array_equal(kicks, kicks[::-1]) and np.array_equal(drifts, drifts[::-1])
    assert palindrome == METHODS[name].reversible


def test_a_step_is_what_its_coefficients_say() -> None:
    """By hand, for a body on a spring: kicks and drifts in turn, stages of a Runge–Kutta method."""
    h, x0, v0 = 1 / 64, 1.0, 0.5
    scene = vv.Scene(vv.Particles([1.0], [[x0, 0.0, 0.0]], [[v0, 0.0, 0.0]]), vv.Harmonic(1.0))
    for name in [*RUNGE_KUTTA, *SPLITTINGS]:
        method = METHODS[name]
        if method.adaptive:
            continue
        tables, state = method.coefficients, np.array([x0, v0])
        if name in SPLITTINGS:
            for kick, drift in zip(tables["kicks"], [*tables["drifts"], 0.0], strict=True):
                state = state + kick * h * np.array([0.0, -state[0]])
                state = state + drift * h * np.array([state[1], 0.0])
        else:
            stages = np.zeros((len(tables["b"]), 2))
            for i, row in enumerate(tables["a"]):
                at = state + h * row @ stages
                stages[i] = at[1], -at[0]
            state = state + h * tables["b"] @ stages
        out = scene.run(t=h, method=name, dt=h)
        found = [out.position[-1, 0, 0], out.velocity[-1, 0, 0]]
        np.testing.assert_allclose(found, state, rtol=0, atol=4e-15, err_msg=name)


def test_coefficients_are_the_callers_own() -> None:
    method = METHODS["rk4"]
    method.coefficients["b"][0] = 7.0
    assert method.coefficients["b"][0] != 7.0
