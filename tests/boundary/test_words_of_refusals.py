"""What refusals and reports call things: functions of SymPy, texts that are meant to be numbers, notes, hints."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sympy as sp

import visviva as vv


@pytest.mark.parametrize("function", [sp.cos, sp.sin, sp.exp])
def test_functions_of_sympy_are_named_with_what_to_write(function: Any) -> None:
    """It said that a function `flat` is not known."""
    scene = vv.Particles([1.0], [[0.0, 0.0, 0.0]])
    for make in (
        lambda: vv.Hamiltonian(lambda q, p, t: p[0] ** 2 / 2 + function(q[0]), ["q"]),
        lambda: vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 + function(q[0]), ["q"]),
        lambda: vv.Scene(scene, vv.ExpressionForce(potential=lambda r, v, t: function(r[0]))).run(t=[0.0, 1.0]),
    ):
        with pytest.raises(vv.InvalidInput, match=r"expected functions of NumPy, such as np\.cos.*sympy\.cos"):
            make()


@pytest.mark.parametrize("text", ["1d3", "1D-3", "0x10", "1j", "2.5J", "1E", "0b11", " -1e "])
def test_what_is_meant_to_be_a_number_has_no_unit(text: str) -> None:
    with pytest.raises(vv.InvalidInput, match="mass: expected real numbers") as caught:
        vv.Particles([text], [[0.0, 0.0, 0.0]])
    assert "unit" not in str(caught.value)


@pytest.mark.parametrize(
    "text", ["1 kg", "-9.81m/s²", "5e3 km", "1e-3µm", "1 d", "3 J", "2 eV", "0 xu", "5 %", "1e5 km"]
)
def test_a_number_with_a_unit_has_one(text: str) -> None:
    with pytest.raises(vv.InvalidInput, match="leave the unit of"):
        vv.Particles([text], [[0.0, 0.0, 0.0]])


def test_an_exception_that_is_raised_again_has_its_note_once() -> None:
    gone = ValueError("gone")

    def height(t: float, position: Any, velocity: Any) -> float:
        raise gone

    scene = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 1.0]]), vv.UniformField([0.0, 0.0, -1.0]))
    notes = []
    for _ in range(2):
        with pytest.raises(ValueError, match="gone") as caught:
            scene.run(t=[0.0, 1.0], events=[height])
        notes.append(list(caught.value.__notes__))
    assert notes[0] == notes[1]
    assert len(notes[0]) == 1
    for _ in range(2):
        with pytest.raises(ValueError, match="gone"):
            vv.Lagrangian(lambda q, v, t: height(t, q, v), ["q"])
    assert len(gone.__notes__) == 2


def test_ensembles_say_that_forces_by_components_are_in_no_energy() -> None:
    scene = vv.Scene(
        vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]),
        vv.ExpressionForce(force=lambda r, v, t: [-r[0], -r[1], -r[2]]),
    )
    hint = "1 force is given by components, whose work is in no energy"
    assert hint in str(scene.run(t=[0.0, 1.0]).conservation())
    some = scene.ensemble(position=np.array([[[1.0, 0.0, 0.0]], [[2.0, 0.0, 0.0]]]))
    assert str(some.run(t=[0.0, 1.0]).conservation()).count(hint) == 1
    kept = vv.problems.kepler(e=0.5).scene.ensemble(velocity=[vv.problems.kepler(e=0.5).scene.particles.velocity] * 2)
    assert "given by components" not in str(kept.run(t=[0.0, 1.0]).conservation())
