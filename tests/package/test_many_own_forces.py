"""Parameters of a great many copies: arrays are looked at as a whole, and each copy is what it would be by itself."""

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from calls import python_calls

import visviva as vv

MANY = 8000
UP = 1.0 + np.arange(MANY) / MANY
BODIES = vv.Particles([1.0, 2.0], [[0, 0, 0], [2.0, 0, 0]], [[0, 0.3, 0], [0, -0.3, 0.1]])
BULGE = vv.Oblate(0, G=1.0, J2=1e-3, radius=0.1, axis=[0, 0, 1.0])
PUSH = vv.ExpressionForce(acceleration=lambda r, v, t, k: (-k * r[0], 0.0, 0.0), parameters={"k": 1.0})
V = vv.potentials
KINDS: list[tuple[vv.forces.Force, dict[str, Any]]] = [
    (vv.LinearDrag(1.0), {"tau": UP}),
    (vv.Gravity(1.0), {"G": UP, "softening": UP.astype(np.float32)}),
    (BULGE, {"J2": UP, "axis": np.multiply.outer(UP, [1.0, 0.0, -2.0])}),
    (vv.Harmonic(1.0), {"center": np.asfortranarray(np.multiply.outer(UP, [0.0, -1.0, 2.0]))}),
    (vv.Coulomb([1.0, 1.0], k=1.0), {"charge": np.multiply.outer(UP, [1.0, -2.0]), "k": np.arange(MANY)}),
    (vv.Drag(density=1.0, viscosity=1.0, radius=0.1), {"radius": UP[:, None], "density": UP}),
    (vv.CentralField(V.Coulomb(-1.0)), {"potential": [V.Coulomb(-1.0), V.Yukawa(1.0, 2.0)] * (MANY // 2)}),
    (PUSH, {"values": UP[:, None]}),
]


@pytest.mark.parametrize(("force", "own"), KINDS, ids=[type(force).__name__ for force, _ in KINDS])
def test_each_is_the_force_that_is_made_by_itself(force: Any, own: dict[str, Any]) -> None:
    copies = vv.Scene(BODIES, vv.UniformField([0.0, 0.0, 1.0]), force).ensemble(parameters={1: own})
    assert len(copies) == MANY
    for copy in (0, 1, 4711, MANY - 1):
        alone = dataclasses.replace(force, **{name: values[copy] for name, values in own.items()})
        made = copies.forces[copy][1]
        assert (made, repr(made), hash(made)) == (alone, repr(alone), hash(alone))
        assert copies[copy] == vv.Scene(BODIES, copies.forces[copy][0], alone)
        for name in own:
            kept, expected = getattr(made, name), getattr(alone, name)
            assert type(kept) is type(expected)
            assert not isinstance(kept, np.ndarray) or not kept.flags.writeable


@pytest.mark.parametrize(
    ("force", "name", "values", "message"),
    [
        (vv.LinearDrag(1.0), "tau", -1.0, "LinearDrag of copy 7317: tau: expected a positive number, got -1.0"),
        (vv.LinearDrag(1.0), "tau", np.nan, "LinearDrag of copy 7317: tau: expected finite numbers"),
        (vv.Harmonic(1.0), "k", -2.0, "Harmonic of copy 7317: k: expected a number of at least 0, got -2.0"),
        (vv.Harmonic(1.0), "center", [0.0, np.inf, 0.0], r"Harmonic of copy 7317: center: .*center\[1\] is inf"),
        (BULGE, "axis", [0.0, 0.0, 0.0], "Oblate of copy 7317: axis: expected a direction"),
        (BULGE, "J2", np.inf, "Oblate of copy 7317: J2: expected finite numbers"),
        (BULGE, "radius", 0.0, "Oblate of copy 7317: radius: expected a positive number, got 0.0"),
        (vv.QuadraticDrag([1.0, 1.0]), "coefficient", [1.0, -1.0], "QuadraticDrag of copy 7317: coefficient: .* -1.0"),
        (PUSH, "length", 1e-320, "ExpressedForce of copy 7317: length: expected units"),
        (PUSH, "k", np.nan, "ExpressedForce of copy 7317: values: expected finite numbers"),
    ],
)
def test_the_copy_of_a_bad_value_is_named(force: Any, name: str, values: Any, message: str) -> None:
    given = np.ones((MANY, *np.shape(values)))
    given[7317] = values
    with pytest.raises(vv.InvalidInput, match=message) as refused:
        vv.Scene(BODIES, force).ensemble(parameters={0: {name: given}})
    assert refused.value.argument == "parameters"


def test_the_first_copy_with_a_bad_value_is_named() -> None:
    """And in it the first of its forces."""
    scene = vv.Scene(BODIES, vv.Harmonic(1.0), vv.LinearDrag(1.0))
    stiffness, times = UP.copy(), UP.copy()
    stiffness[50], times[40:60] = -1.0, 0.0
    with pytest.raises(vv.InvalidInput, match="LinearDrag of copy 40"):
        scene.ensemble(parameters={0: {"k": stiffness}, 1: {"tau": times}})
    times[40:50] = 1.0
    with pytest.raises(vv.InvalidInput, match="Harmonic of copy 50"):
        scene.ensemble(parameters={1: {"tau": times}, 0: {"k": stiffness}})


def test_values_that_are_equal_are_one_set() -> None:
    scene = vv.Scene(BODIES, vv.Gravity(1.0), vv.Drag(density=1.0, viscosity=1.0, radius=0.1))
    own = {0: {"G": np.tile([0.0, -0.0, 1.0, 1.0], 50)}, 1: {"radius": np.tile([0.1, 0.1, 0.1, 0.2], 50)[:, None]}}
    assert "3 of 2 kinds" in str(scene.ensemble(parameters=own).plan(t=1.0))
    same = scene.ensemble(parameters={0: {"G": [2.0] * 9}})
    assert "parameters of their own" not in str(same.plan(t=1.0))
    assert same[3].forces[0] == vv.Gravity(2.0)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        # Of two forces, under one name: as many copies were run as the last of them had values for.
        ({0: {"tau": [1.0, 2.0, 3.0]}, 1: {"tau": [1.0, 2.0]}}, "'tau' for 3 copies like tau, got 2"),
        ({0: {"tau": [1.0, 2.0]}, 1: {"tau": [1.0, 2.0, 3.0]}}, "'tau' for 2 copies like tau, got 3"),
        ({0: {"tau": [10**400, 1]}}, "values of 'tau' with a leading axis"),
        ({2: {"k": [V.Coulomb(1.0)]}}, "one number 'k' for each copy"),
    ],
)
def test_what_was_no_refusal_is_one(parameters: dict[Any, Any], message: str) -> None:
    scene = vv.Scene(BODIES, vv.LinearDrag(1.0), vv.LinearDrag(2.0), PUSH)
    with pytest.raises(vv.InvalidInput, match=message) as refused:
        scene.ensemble(parameters=parameters)
    assert refused.value.argument == "parameters"


@pytest.mark.parametrize(
    ("force", "name"),
    [(vv.LinearDrag(1.0), "tau"), (vv.Harmonic(1.0), "k"), (vv.Gravity(1.0), "softening"), (BULGE, "J2"), (PUSH, "k")],
)
def test_hardly_any_python_is_run_for_each_copy(force: Any, name: str) -> None:
    """What a copy tells the core, and what it is compared by: 1 to 3 calls (there were 74 to 270)."""
    scene = vv.Scene(BODIES, vv.UniformField([0.0, 0.0, 1.0]), force)
    few, many = (
        python_calls(lambda values=values: scene.ensemble(parameters={1: {name: values}}))  # type: ignore[misc]
        for values in (UP[:100], UP[:1100])
    )
    assert many - few <= 4 * 1000


def test_a_file_makes_once_what_copies_share(tmp_path: Path) -> None:
    """Forces that copies have in common are one again; of the rest 20 calls are made for each copy (68 before)."""
    scene = vv.Scene(BODIES, vv.Harmonic(1.0), vv.UniformField([0.0, 0.0, 1.0]), vv.LinearDrag(1.0))
    calls = []
    for count in (20, 220):
        copies = scene.ensemble(parameters={2: {"tau": UP[:count]}})
        copies.run(t=0.1, method="rk4", dt=0.1).save(tmp_path / "run.npz")
        loaded = vv.load(tmp_path / "run.npz")
        assert isinstance(loaded, vv.EnsembleTrajectory)
        assert loaded.ensemble.forces == copies.forces
        for place, kinds in ((0, 1), (1, 1), (2, count)):
            assert len({id(forces[place]) for forces in loaded.ensemble.forces}) == kinds
        calls.append(python_calls(lambda: vv.load(tmp_path / "run.npz")))
    assert calls[1] - calls[0] <= 30 * 200
