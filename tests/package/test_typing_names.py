"""Names of types are those that the package takes."""

from __future__ import annotations

import re
from typing import Any, get_args

import pytest
import sympy as sp

import visviva as vv
from visviva import typing
from visviva.generalized._methods import CONSTRAINED, DISCRETE, GAUSS, LINEAR


def words(alias: Any) -> set[str]:
    """The words of a Literal, or of a union of them."""
    return {word for part in get_args(alias) for word in ([part] if isinstance(part, str) else words(part))}


def test_methods_in_generalized_coordinates() -> None:
    of_bodies = {method.name for method in (*vv.methods(), *vv.rigid.methods())}
    assert words(typing.GeneralizedMethodName) == {"auto", LINEAR, *GAUSS, *DISCRETE, *CONSTRAINED, *of_bodies}
    assert words(typing.DiscreteMethodName) == set(DISCRETE)


def known(message: str, before: str) -> set[str]:
    """What a refusal says there is."""
    return set(re.findall(r"\w+", message.partition(before)[2].partition(", got")[0]))


def test_columns_in_generalized_coordinates() -> None:
    x = vv.coordinate("x")
    run = vv.Lagrangian(x.diff(vv.time) ** 2 / 2 - sp.cos(x), [x], position=[0.1], velocity=[0.0]).run(0.1)
    pytest.importorskip("pandas")
    with pytest.raises(vv.InvalidInput) as caught:
        run.to_pandas("?")  # type: ignore[arg-type]
    assert known(caught.value.message, "there are") == words(typing.GeneralizedColumnName)


def test_tallies() -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        vv.scattering.monte_carlo(
            vv.potentials.PowerLaw(1.0, 1.0),
            beam_energy=1.0,
            masses=(1.0, 1.0),
            b_max=1.0,
            n_events=10,
            seed=1,
            tally="?",  # type: ignore[arg-type]
        )
    assert known(caught.value.message, "expected one of") == words(typing.TallyName)
    with pytest.raises(vv.InvalidInput) as caught:
        vv.scattering.Foil("gold", 0.1).run(
            "alpha",
            beam_energy=1e6,
            n_events=10,
            seed=1,
            tally="?",  # type: ignore[arg-type]
        )
    assert known(caught.value.message, "expected one of") == words(typing.FoilTallyName)
