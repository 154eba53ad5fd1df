"""Spreads of energies across which something orbits or is captured, where no table between energies would do: each
event is found by direct quadrature.
"""

from pathlib import Path

import numpy as np
import pytest

import visviva as vv

S, P = vv.scattering, vv.potentials
MASSES = (1.0, 4.0)
SHARE = 0.8  # of a beam's energy what is that of relative motion
LJ, LANGEVIN = P.LennardJones(1.0, 1.0), P.PowerLaw(-1.0, 4)
BEAMS = {
    "orbiting at its slow end": (LJ, 1.5, 0.05, 3.0),
    "orbiting": (LJ, 0.7, 0.01, 3.0),
    "hardly any spread": (LJ, 0.7, 1e-4, 3.0),
    "capture": (LANGEVIN, 1.0, 0.05, 3.0),
    "total reflection": (P.SquareWell(-1.0, 1.0), 1.0, 0.05, 1.2),
}


def beam(name: str, **more: object) -> dict[str, object]:
    potential, energy, part, b_max = BEAMS[name]
    given = energy / SHARE
    return {
        "potential": potential,
        "beam_energy": given,
        "masses": MASSES,
        "b_max": b_max,
        "energy_spread": part * given,
        "seed": 4,
        **more,
    }


@pytest.mark.parametrize("name", BEAMS)
def test_events_are_those_of_direct_quadrature(name: str) -> None:
    events = S.scattering_events(**beam(name, n_events=3000))
    energy, b = SHARE * events["beam_energy"], events["impact_parameter"]
    direct = S.deflect(BEAMS[name][0], energy=energy, impact_parameter=b)
    assert (np.isnan(events["deflection"]) == np.isnan(direct.angle)).all()
    told = ~np.isnan(direct.angle)
    # Energy and b are rounded on their way here, which orbits make more of: by as much as ψ changes from b to the next.
    slack = 1e-11 * (1.0 + np.abs(direct.angle)) + 1e-15 * (b + energy) * np.abs(direct.derivative)
    assert (np.abs(events["deflection"] - direct.angle) <= slack)[told].all()
    folded = np.abs(np.mod(direct.angle + np.pi, 2.0 * np.pi) - np.pi)
    assert (np.abs(events["cm_angle"] - folded) <= slack)[told].all()


def test_langevin_captures_what_comes_within_its_orbit() -> None:
    """b_c(E)² = 2 √(C/E), for each event with its energy."""
    events = S.scattering_events(**beam("capture", n_events=20_000))
    edge = 2.0 / np.sqrt(SHARE * events["beam_energy"])
    assert (np.isnan(events["cm_angle"]) == (events["impact_parameter"] ** 2 < edge)).all()
    run = S.monte_carlo(**beam("capture", n_events=20_000), bins=8)
    assert run["cm_angle"].captured == np.isnan(events["cm_angle"]).sum()


@pytest.mark.parametrize("name", BEAMS)
def test_counts_are_those_of_the_events(name: str, tmp_path: Path) -> None:
    """Of any number of threads, in parts, and of a file."""
    tally = ["cm_angle", "lab_angle", ("recoil_energy", "impact_parameter")]
    how = beam(name, n_events=17_001, tally=tally, bins=12)
    run = S.monte_carlo(**how, threads=1)
    assert run == S.monte_carlo(**how, threads=3)
    assert run == S.monte_carlo(**{**how, "n_events": 12_345}) + S.monte_carlo(
        **{**how, "n_events": 17_001 - 12_345}, first_event=12_345
    )
    events = S.scattering_events(**beam(name, n_events=17_001))
    for axis in ("cm_angle", "lab_angle"):
        counted, _ = np.histogram(events[axis][~np.isnan(events[axis])], run[axis].edges)
        assert (run[axis].counts == counted).all()
    run.save(tmp_path / "counts.npz")
    assert S.MonteCarlo.load(tmp_path / "counts.npz") == run


def test_lines_of_a_spectrum_have_tables_or_none() -> None:
    """One line far above orbiting, which tables tell, beside one that orbits: events of each are those it has alone."""
    lines = S.Spectrum([0.9, 12.0], [1.0, 2.0])
    how = beam("orbiting", n_events=4000) | {"beam_energy": lines, "energy_spread": 0.02}
    events = S.scattering_events(**how, divergence=0.01)
    for component, energy in enumerate(lines.energy):
        alone = S.scattering_events(**how | {"beam_energy": energy}, divergence=0.01)
        mine = events["component"] == component
        assert mine.sum() > 1000
        assert (events["deflection"][mine] == alone["deflection"][mine]).all()


def test_importance_and_channels() -> None:
    """Strata keep their parts of the events, and what a channel takes is what it takes of any beam."""
    how = beam("orbiting", n_events=20_000)
    events = S.scattering_events(**how, importance=S.LargeAngles(0.7, 0.3), channels=S.Channel(-0.1, 0.25))
    inner = events["weight"] == events["weight"][events["impact_parameter"].argmin()]
    # Five standard deviations of 20 000.
    assert abs(inner.mean() - 0.3) < 0.017
    assert not (events["cm_angle"][~inner] > 0.7 + 1e-6).any()
    assert abs((events["channel"] == 1).mean() - 0.25) < 0.016


def test_what_the_potential_does_not_tell_is_refused_before_there_is_an_event() -> None:
    r = np.linspace(1.2, 6.0, 200)
    short = P.Tabulated(r, 4.0 * (r**-12.0 - r**-6.0) * (1.0 - r / 6.0) ** 3)
    with pytest.raises(vv.InvalidInput, match="begins before the turning point") as refused:
        S.monte_carlo(**beam("orbiting", n_events=10**12) | {"potential": short})
    assert refused.value.argument == "potential"
