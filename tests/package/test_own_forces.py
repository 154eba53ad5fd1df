"""Ensembles over the parameters of forces: each copy is the scene that has them alone."""

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv

PULL = vv.Gravity(1.0)
DRAG = vv.LinearDrag(tau=1.0)
PARAMETERS: dict[Any, dict[str, Any]] = {DRAG: {"tau": [1.0, 2.0, 4.0, 2.0]}, "Gravity": {"G": [1.0, 1.0, 2.0, 1.0]}}


def ensemble(parameters: dict[Any, dict[str, Any]] = PARAMETERS) -> vv.EnsembleScene:
    bodies = vv.problems.figure_eight().scene.particles
    return vv.Scene(bodies, PULL, DRAG).ensemble(parameters=parameters)


@pytest.mark.parametrize("method", ["rk4", "dop853", "auto"])
def test_copies_have_the_bits_that_they_have_alone(method: str) -> None:
    how: dict[str, Any] = {"dt": 0.01} if method == "rk4" else {}
    columns = ("position", "energy", "angular_momentum")
    copies = ensemble()
    out = copies.run(t=[0.5, 1.0], method=method, record=columns, **how)
    for copy, scene in enumerate(copies):
        assert scene.forces == copies.forces[copy] == out[copy].final.forces
        assert scene.forces[1] == vv.LinearDrag(tau=[1.0, 2.0, 4.0, 2.0][copy])
        alone = scene.run(t=[0.5, 1.0], method=method, record=columns, **how)
        for name in columns:
            assert np.array_equal(getattr(out, name)[copy], getattr(alone, name))
    # It goes on with those forces, to the bit where steps are fixed.
    further, whole = out.final.run(t=1.5, method=method, **how), copies.run(t=1.5, method=method, **how)
    np.testing.assert_allclose(further.position[:, -1], whole.position[:, -1], rtol=0.0 if how else 1e-7)


def test_closed_forms_are_those_of_each_copy() -> None:
    """Terminal speeds g tau, and free motion where there is no field."""
    drop = vv.Scene(vv.Particles([1.0], [[0, 0, 0]], [[1.0, 0, 0]]), vv.UniformField((0, 0, -10.0)), DRAG)
    fields, times = np.array([[0, 0, -10.0], [0, 0, -5.0], [0, 0, 0]]), [0.5, 1.0, 2.0]
    out = drop.ensemble(parameters={0: {"g": fields}, DRAG: {"tau": times}}).run(t=200.0)
    assert out.stats.evaluations == 0
    np.testing.assert_allclose(out.velocity[:, -1, 0, 2], fields[:, 2] * times, rtol=1e-15)


def test_potentials_and_states_of_their_own() -> None:
    potentials = [vv.potentials.Coulomb(k) for k in (-1.0, -2.0, -3.0)]
    start = vv.Scene(vv.Particles([1.0], [[1.0, 0, 0]], [[0, 1.0, 0]]), vv.CentralField(potentials[0]))
    circles = [[[0, speed, 0]] for speed in np.sqrt([1.0, 2.0, 3.0])]
    copies = start.ensemble(velocity=circles, parameters={0: {"potential": potentials}})
    out = copies.run(t=np.linspace(0.0, 3.0, 7))
    np.testing.assert_allclose(np.linalg.norm(out.position[:, :, 0], axis=-1), 1.0, rtol=1e-14)
    assert len(copies[1:]) == 2
    assert copies[1:][0].forces == (vv.CentralField(potentials[1]),)


def test_files_and_pickles_keep_them(tmp_path: Path) -> None:
    copies = ensemble()
    assert pickle.loads(pickle.dumps(copies)).forces == copies.forces
    out = copies.run(t=1.0)
    out.save(tmp_path / "run.npz")
    loaded = vv.load(tmp_path / "run.npz")
    assert isinstance(loaded, vv.EnsembleTrajectory)
    assert loaded.ensemble.forces == loaded.final.forces == copies.forces
    assert np.array_equal(loaded.energy, out.energy)


def test_the_plan_says_so() -> None:
    plan = str(ensemble().plan(t=1.0))
    assert "sets of forces" in plan
    assert "3  (copies have parameters of their own" in plan
    with pytest.raises(vv.InvalidInput, match="leapfrog cannot take LinearDrag"):
        ensemble().plan(t=1.0, method="leapfrog", dt=0.1)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({DRAG: {"tau": [1.0, -1.0]}}, "LinearDrag of copy 1"),
        ({DRAG: {"tua": [1.0]}}, "did you mean 'tau'"),
        ({vv.Gravity(3.0): {"G": [1.0]}}, "it has none like that"),
        ({}, "expected a dictionary"),
        ({DRAG: {}}, "expected a dictionary"),
        ({0: {"G": 1.0}}, "leading axis over the copies"),
        ({5: {"G": [1.0]}}, "below 2"),
        ({DRAG: {"tau": [1.0, 2.0]}, PULL: {"G": [1.0, 2.0, 3.0]}}, "2 copies like tau"),
    ],
)
def test_what_makes_no_sense_is_refused(parameters: dict[Any, dict[str, Any]], message: str) -> None:
    with pytest.raises(vv.InvalidInput, match=message) as refused:
        ensemble(parameters)
    assert refused.value.argument == "parameters"
