"""Ensembles over the parameters of potentials, named as if they were those of the force that has the potential."""

import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv

V = vv.potentials
PAIR = vv.Particles([1.0, 2.0], [[0, 0, 0], [2.0, 0, 0]], [[0, 0.3, 0], [0, -0.3, 0.1]])
STRENGTHS, SIZES = [-1.0, -2.0, -1.0, -0.5], [0.5, 0.25, 0.5, 1.0]
NAMED = {"k": STRENGTHS, "length": SIZES}


def softened(k: float, length: float) -> Any:
    """A formula one of whose parameters has the name of its unit."""
    return V.Custom(lambda r, k, length: k / np.sqrt(length**2 + r * r), parameters={"k": k, "length": length})


FORCES = {
    "central": (lambda potential: vv.CentralField(potential, center=[1.0, 2.0, 0.0]), "CentralField"),
    "pair": (vv.PairPotential, "PairPotential"),
}
KINDS: dict[str, Any] = {"formula": softened, "Yukawa": V.Yukawa, "Plummer": V.Plummer}
each_force = pytest.mark.parametrize("force", FORCES)


def named_as(kind: str) -> dict[str, Any]:
    names = ("k", "length") if kind == "formula" else [parameter.name for parameter in KINDS[kind]._parameters]
    return dict(zip(names, (STRENGTHS, SIZES), strict=True))


@each_force
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("method", [{"method": "leapfrog", "dt": 1 / 64}, {"method": "dop853", "rtol": 1e-9}])
def test_copies_have_the_bits_that_they_have_alone(force: str, kind: str, method: dict[str, Any]) -> None:
    """Those of a scene that is made with the potential of these numbers."""
    make, name = FORCES[force]
    start = vv.Scene(PAIR, vv.Gravity(0.1), make(KINDS[kind](STRENGTHS[0], SIZES[0])))
    how: dict[str, Any] = {"t": [0.5, 2.0], "record": ("position", "velocity", "energy"), **method}
    copies = start.ensemble(parameters={name: named_as(kind)})
    out = copies.run(**how)
    for copy, (k, length) in enumerate(zip(STRENGTHS, SIZES, strict=True)):
        alone = vv.Scene(PAIR, vv.Gravity(0.1), make(KINDS[kind](k, length)))
        assert copies[copy] == alone
        by_itself = alone.run(**how)
        for column in how["record"]:
            np.testing.assert_array_equal(getattr(out, column)[copy], getattr(by_itself, column))
    assert len({out.energy[copy, 0] for copy in range(4)}) == 3


@each_force
def test_equal_numbers_are_one_potential(force: str) -> None:
    """Whatever type they come as; what is not named is the scene's."""
    make, name = FORCES[force]
    start = vv.Scene(PAIR, make(softened(-1.0, 0.5)))
    for given in (np.array([-1, -2, -1]), [-1.0, -2.0, -1.0], (np.float32(-1.0), np.int64(-2), -1)):
        copies = start.ensemble(parameters={name: {"k": given}})
        first, second, third = (forces[0].potential for forces in copies.forces)  # type: ignore[attr-defined]
        assert first is third
        assert (first, second) == (softened(-1.0, 0.5), softened(-2.0, 0.5))
    assert "2 of 2 kinds" in str(copies.plan(t=1.0))


def test_places_and_strengths_together() -> None:
    """Circles by their closed form: v² = r V′; each about its own center, where others would be far from circles."""
    centers, sizes = np.array([[0.0, 0, 0], [0, 3.0, 0], [0, 0, -2.0]]), np.array([0.5, 1.0, 2.0])
    speeds = [math.sqrt(2.0 / math.hypot(1.0, size) ** 3) for size in sizes]
    start = vv.Scene(vv.Particles([1.0], [[1.0, 0, 0]]), vv.CentralField(softened(-2.0, 1.0)))
    copies = start.ensemble(
        position=(centers + np.array([1.0, 0, 0]))[:, None],
        velocity=[[[0, speed, 0]] for speed in speeds],
        parameters={0: {"length": sizes, "center": centers}},
    )
    out = copies.run(t=np.linspace(0.0, 10.0, 11))
    distances = np.linalg.norm(out.position[:, :, 0] - centers[:, None], axis=-1)
    # Tolerances of 1e-12 a step, over two turns.
    np.testing.assert_allclose(distances, 1.0, rtol=0, atol=2e-11)


def test_tables_and_words() -> None:
    """Parameters that are no numbers: values of a table, and the name of a screening function."""
    r = np.geomspace(0.25, 9.0, 40)
    values = np.stack([-1.0 / r, -2.0 / r])
    copies = vv.Scene(PAIR, vv.PairPotential(V.Tabulated(r, values[0]))).ensemble(parameters={0: {"V": values}})
    assert copies.forces[1] == (vv.PairPotential(V.Tabulated(r, values[1])),)
    screened = vv.Scene(PAIR, vv.PairPotential(V.ScreenedCoulomb(1.0, 2.0)))
    words = screened.ensemble(parameters={0: {"screening": ["zbl", "moliere"]}})
    assert words.forces[1] == (vv.PairPotential(V.ScreenedCoulomb(1.0, 2.0, "moliere")),)


def test_files_and_pickles_keep_them(tmp_path: Path) -> None:
    copies = vv.Scene(PAIR, vv.PairPotential(softened(-1.0, 0.5))).ensemble(parameters={"PairPotential": NAMED})
    assert pickle.loads(pickle.dumps(copies)).forces == copies.forces
    copies.run(t=0.5).save(tmp_path / "run.npz")
    loaded = vv.load(tmp_path / "run.npz")
    assert isinstance(loaded, vv.EnsembleTrajectory)
    assert loaded.ensemble.forces == copies.forces


@pytest.mark.parametrize(
    ("potential", "own", "message"),
    [
        (softened(-1.0, 0.5), {"k": [1.0, np.nan]}, "CentralField of copy 1: k: expected finite numbers"),
        (softened(-1.0, 0.5), {"k": [[1.0, 2.0]]}, "CentralField of copy 0: k: expected one real number"),
        (softened(-1.0, 0.5), {"k": [{}]}, "CentralField of copy 0: k: expected real numbers, got a dict"),
        (softened(-1.0, 0.5), {"k": 1.0}, "leading axis over the copies"),
        (softened(-1.0, 0.5), {"kk": [1.0]}, r"of its potential \(k, length\), got 'kk'; did you mean 'k'"),
        (softened(-1.0, 0.5), {"k": [1.0, 2.0], "length": [1.0]}, "'length' for 2 copies like k, got 1"),
        (softened(-1.0, 0.5), {"k": [1.0], "center": np.zeros((2, 3))}, "'center' for 1 copies like potential, got 2"),
        (softened(-1.0, 0.5), {"k": [1.0], "potential": [V.Coulomb(1.0)]}, "a potential for each copy or values of"),
        (V.Yukawa(1.0, 2.0), {"length": [1.0, 0.0]}, "CentralField of copy 1: length: expected a positive number"),
        (V.Yukawa(1.0, 2.0), {"lenght": [1.0]}, r"\(potential, center\) or of its potential.*did you mean 'length'"),
    ],
)
def test_what_makes_no_sense_is_refused(potential: Any, own: dict[str, Any], message: str) -> None:
    with pytest.raises(vv.InvalidInput, match=message) as refused:
        vv.Scene(PAIR, vv.CentralField(potential)).ensemble(parameters={0: own})
    assert refused.value.argument == "parameters"
