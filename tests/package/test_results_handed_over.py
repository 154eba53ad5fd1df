"""Results are handed over alike: coordinates by their names, the method beside the numbers, sections as tables.

And names of books that are not those of visviva are refused with what they are called here.
"""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

S = vv.scattering
COULOMB = vv.potentials.Coulomb(k=1.0)
STARS = vv.systems.henon_heiles()


def test_events_of_coordinates_have_their_names() -> None:
    """They had numbers, where the run beside them had names."""
    out = STARS.run(t=[0.0, 20.0], events=["x"])
    names = ["x", "y"]
    frame, data = out.events.to_pandas(), out.events.to_xarray()
    assert list(frame["position"].columns) == names == list(out.to_pandas()["position"].columns)
    assert (frame["momentum", "y"].to_numpy() == out.events.momentum[:, 1]).all()
    assert data["coordinate"].values.tolist() == names == out.to_xarray()["coordinate"].values.tolist()


def test_ensembles_tell_their_method_as_single_runs_do() -> None:
    one, all_of_them = STARS.run(t=1.0), STARS.ensemble(momentum=[[0.4, 0.1], [0.4, 0.2]]).run(t=1.0)
    assert all_of_them.to_xarray().attrs == {"method": one.to_xarray().attrs["method"]}


def test_sections_are_tables(tmp_path: Path) -> None:
    section = STARS.poincare("x", t=100.0)
    assert len(section) > 5
    frame, data = section.to_pandas(), section.to_xarray()
    assert (frame["t"].to_numpy() == section.t).all()
    for name in ("position", "momentum"):
        assert (frame[name, "y"].to_numpy() == getattr(section, name)[:, 1]).all()
        assert (data[name].sel(coordinate="y").values == getattr(section, name)[:, 1]).all()
    assert data[["position"]].sizes == {"event": len(section), "coordinate": 2}
    assert list(section.to_xarray("momentum")) == ["momentum"]
    section.to_parquet(tmp_path / "section.parquet")
    assert (pickle.loads(pickle.dumps(section)).momentum == section.momentum).all()


def test_of_two_quantities_what_the_disc_reaches_is_handed_over_as_of_one() -> None:
    pair = ("cm_angle", "lab_angle")
    run = S.monte_carlo(
        COULOMB, beam_energy=1.0, masses=(1.0, 4.0), b_max=10.0, n_events=100, seed=1, tally=[pair, "cm_angle"], bins=5
    )
    for tally in (run[pair], run["cm_angle"]):
        assert (tally.to_xarray()["reachable"].values == tally.reachable).all()


BEAM = {"beam_energy": 1.0, "masses": (1.0, 4.0), "b_max": 10.0, "n_events": 1, "seed": 1}
SYMBOLS: dict[str, tuple[Callable[[], object], str]] = {
    "b": (lambda: S.deflect(COULOMB, energy=1.0, b=1.0), "impact_parameter"),
    "E": (lambda: S.deflect(COULOMB, E=1.0, impact_parameter=1.0), "energy"),
    "theta": (lambda: S.cross_section(COULOMB, energy=1.0, theta=1.0), "angle"),
    "N": (lambda: S.monte_carlo(COULOMB, **{**BEAM, "N": 1}), "n_events"),
    "n": (lambda: S.Foil("gold", 0.1).run("alpha", beam_energy=1e6, n=1, seed=1), "n_events"),
    "q0": (lambda: vv.Lagrangian(lambda q, v, t: v[0] ** 2, ["x"], q0=[1.0]), "position"),
    "p0": (lambda: vv.Hamiltonian(lambda q, p, t: p[0] ** 2, ["x"], p0=[1.0]), "momentum"),
}


@pytest.mark.parametrize("symbol", SYMBOLS)
def test_symbols_of_books_are_told_by_what_they_are_called(symbol: str) -> None:
    """Of q0 it was asked whether it was t0 that was meant, of a foil's n whether times were."""
    wrong, called = SYMBOLS[symbol]
    with pytest.raises(vv.UnknownKeyword, match=rf"got '{symbol}'; give it as {called}$"):
        wrong()


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("x", r"it is out\['x'\]"),
        ("q", "it is position"),
        ("p", "it is momentum"),
        ("times", "it is t"),
        ("df", r"it is to_pandas\(\)"),
    ],
)
def test_attributes_of_other_packages_are_told_by_what_they_are_called(name: str, told: str) -> None:
    for out in (STARS.run(t=1.0), STARS.ensemble(momentum=[[0.4, 0.1]]).run(t=1.0)):
        with pytest.raises(AttributeError, match=f"no attribute '{name}'; {told}$"):
            getattr(out, name)
        with pytest.raises(AttributeError, match=r"no attribute 'angular_momentum'$"):
            getattr(out, "angular_" + "momentum")
        assert np.array_equal(pickle.loads(pickle.dumps(out)).position, out.position)


def test_what_copies_have_is_told_of_an_ensemble() -> None:
    out = STARS.ensemble(momentum=[[0.4, 0.1]]).run(t=1.0)
    with pytest.raises(AttributeError, match=r"each copy has one: out\[i\]\.animate"):
        getattr(out, "ani" + "mate")


def test_a_run_is_not_gone_through_as_if_it_were_rows() -> None:
    with pytest.raises(TypeError, match=r"read by its columns: t, position, …; out\['name'\] is a coordinate"):
        list(STARS.run(t=1.0))


def test_what_tallies_have_is_told_of_a_result() -> None:
    beam = S.monte_carlo(COULOMB, **BEAM)
    foil = S.Foil("gold", 0.1).run("alpha", beam_energy=1e6, n_events=1, seed=1, tally="lab_angle")
    for result, tally in ((beam, "cm_angle"), (foil, "lab_angle")):
        for name in ("counts", "to_pandas", "edges"):
            with pytest.raises(AttributeError, match=rf"each tally has one: result\['{tally}'\]\.{name}$"):
                getattr(result, name)
        with pytest.raises(AttributeError, match=rf"it is result\['{tally}'\]$"):
            getattr(result, tally)
        with pytest.raises(AttributeError, match=r"no attribute 'temperature'$"):
            getattr(result, "temper" + "ature")
        assert pickle.loads(pickle.dumps(result)) == result
