"""Names of types are those that the package takes."""

from __future__ import annotations

import re
from contextlib import suppress
from itertools import product
from typing import TYPE_CHECKING, Any, get_args

import pytest
import sympy as sp

import visviva as vv
from visviva import typing
from visviva.generalized._methods import CONSTRAINED, DISCRETE, EXACT, GAUSS

if TYPE_CHECKING:
    from collections.abc import Callable


def words(alias: Any) -> set[str]:
    """The words of a Literal, or of a union of them."""
    return {word for part in get_args(alias) for word in ([part] if isinstance(part, str) else words(part))}


def test_methods_in_generalized_coordinates() -> None:
    of_bodies = {method.name for method in (*vv.methods(), *vv.rigid.methods())}
    assert words(typing.GeneralizedMethodName) == {"auto", *EXACT, *GAUSS, *DISCRETE, *CONSTRAINED, *of_bodies}
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


def refused(call: Callable[[], object], before: str) -> set[str]:
    """The words that a refusal says there are."""
    with pytest.raises(vv.InvalidInput) as caught:
        call()
    return known(caught.value.message, before)


def test_what_foils_are_made_of() -> None:
    foil = vv.scattering.Foil("gold", 0.1)
    materials = refused(lambda: vv.scattering.Foil("?", 0.1), "a Material or one of")  # type: ignore[arg-type]
    assert materials == words(typing.MaterialName)
    ions = refused(lambda: foil.stopping_power("?", 1e6), "an Ion or one of")  # type: ignore[arg-type]
    assert ions == words(typing.IonName)
    screenings = refused(lambda: vv.scattering.Foil("gold", 0.1, potential="?"), "expected one of")  # type: ignore[arg-type]
    assert screenings >= words(typing.ScreeningName) | {"coulomb"}
    for name in words(typing.ScreeningName):
        assert vv.potentials.ScreenedCoulomb.between(2, 79, screening=name).screening == name  # type: ignore[arg-type]


def test_columns_of_tables() -> None:
    pytest.importorskip("pandas")
    scene = vv.problems.kepler(e=0.5).scene
    out = scene.run(1.0, events=[vv.events.apsis(1, 0)])
    swing = vv.systems.pendulum().run(1.0, events=["theta"]).events
    balls = vv.Particles([1.0, 1.0], [[-2.0, 0, 0], [2.0, 0, 0]], [[1.0, 0, 0], [-1.0, 0, 0]], radius=0.5)
    struck = vv.Scene(balls).run(t=4.0, collisions="bounce").collisions
    tables: list[tuple[Any, Any]] = [
        (out.events, typing.EventColumnName),
        (swing, typing.GeneralizedEventColumnName),
        (struck, typing.CollisionColumnName),
        (out.elements([1], about=0), typing.ElementName),
    ]
    for table, alias in tables:
        assert refused(lambda table=table: table.to_pandas("?"), "there are") == words(alias)  # type: ignore[misc]


def test_columns_of_scattering_events() -> None:
    asked: dict[str, Any] = {"beam_energy": 1.0, "masses": (1.0, 1.0), "b_max": 1.0, "n_events": 3, "seed": 1}
    channel = vv.scattering.Channel(-0.1, 0.5)
    strata = vv.scattering.Strata([0.0, 0.1, 1.0])
    potential = vv.potentials.PowerLaw(1.0, 1.0)
    events: Any = vv.scattering.scattering_events(potential, **asked, channels=channel, importance=strata)
    assert set(events) == words(typing.ScatteringColumnName)
    with pytest.raises(KeyError, match=r"no column 'chanel'; there are event, .*did you mean 'channel'"):
        events["chanel"]


def test_conventions_of_euler_angles() -> None:
    taken = set()
    for letters in product("xyzXYZ", repeat=3):
        with suppress(vv.InvalidInput):
            vv.rigid.euler_angles([0.0, 0.0, 0.0, 1.0], "".join(letters))  # type: ignore[arg-type]
            taken.add("".join(letters))
    assert taken == words(typing.EulerConvention)


def test_the_way_of_an_ion_and_settings_of_a_run() -> None:
    way = vv.scattering.Foil("gold", 0.1).history("alpha", beam_energy=1e6, seed=1)
    assert set(way) == set(typing.IonHistory.__annotations__)
    for name in ("figure_eight", "outer_solar_system"):
        advice = getattr(vv.problems, name)().scene.advise(t=1.0, accuracy=1e-3)
        for option in advice.options:
            assert set(option.how) <= set(typing.RunSettings.__annotations__)
            assert option.how["method"] in words(typing.MethodName)
