"""Single and forced collisions in foils: against Rutherford's law, each other, and a reference number."""

import numpy as np
import pytest

import visviva as vv

S = vv.scattering
GOLD = 196.923232301
# 5.9e22 atoms to a cubic centimeter, and the nuclear mass: as the reference number has them.
REFERENCE_GOLD = S.Material(0.059 / 0.602214076 * GOLD, 79, GOLD, mean_excitation_energy=790.0)


def test_backscattering_of_single_collisions():
    """The reference number, 0.4 µm of gold, past 90° in the center-of-mass frame: within 3 errors, of 1e-3 at most."""
    foil = S.Foil(REFERENCE_GOLD, 0.4, potential="coulomb", stopping="none")
    assert foil.material.number_density == pytest.approx(0.059, rel=1e-14, abs=0)
    for seed in (1, 2, 3):
        out = foil.run(
            "alpha",
            beam_energy=7.687e6,
            n_events=1_500_000,
            seed=seed,
            collisions="single",
            forced_angle=np.radians(60.0),
            tally={"cm_angle": [0.0, np.pi / 2, np.pi]},
        )
        value, error = out["cm_angle"].fraction()
        assert error[1] < 1e-3 * value[1]
        assert abs(value[1] - 1.690358e-5) < 3.0 * error[1], (seed, value[1], error[1])
        assert out.missed == 0
        assert out.transmitted + out.reflected == out.n_events


def test_single_collisions_follow_rutherford():
    """The limit of a thin foil: every bin of the laboratory angle, transmitted or reflected."""
    foil = S.Foil("silver", 0.3, potential="coulomb", stopping="none")
    edges = np.radians(np.linspace(30.0, 180.0, 31))
    out = foil.run(
        "alpha",
        beam_energy=5.486e6,
        n_events=600_000,
        seed=4,
        collisions="single",
        forced_angle=np.radians(25.0),
        tally={"lab_angle": edges, "reflected_angle": edges, "transmitted_angle": edges},
    )
    mass = foil.material.mass[0]
    ratio = 4.001506179127 / mass
    cm = S.cm_angle(edges, mass_ratio=ratio)[0]
    kappa = 2 * 47 * 14.399645478 / (2 * 5.486e6 / (1 + ratio))
    beyond = np.pi * (kappa / np.tan(cm / 2.0)) ** 2
    expected = -np.diff(beyond) * foil.material.number_density * 3000.0
    value, error = out["lab_angle"].fraction()
    pulls = (value - expected) / error
    # 30 bins: χ² is 30 ± 8; four standard deviations.
    assert pulls @ pulls < 62
    assert error.max() < 0.05 * value[error.argmax()]
    assert np.array_equal(
        out["reflected_angle"].sums[1:-1] + out["transmitted_angle"].sums[1:-1], out["lab_angle"].sums[1:-1]
    )


def test_elements_take_their_parts():
    """Electrum: the expected number of single collisions past 90° is the sum of both metals'.

    And of discs of one size, each takes as many collisions as it has atoms.
    """
    alloy = S.Material(14.0, [79, 47], [196.96657, 107.8682], [3, 1], mean_excitation_energy=[790.0, 470.0])
    foil = S.Foil(alloy, 0.3, potential="coulomb", stopping="none", minimum_angle=2e-3)
    asked = {"beam_energy": 5e6, "seed": 3, "collisions": "single", "forced_angle": 1.0}
    out = foil.run("alpha", n_events=200_000, tally={"cm_angle": [0.0, np.pi / 2, np.pi]}, **asked)
    value, error = out["cm_angle"].fraction()
    expected = 0.0
    for number, mass, part in ((79, 196.96657, 0.75), (47, 107.8682, 0.25)):
        kappa = 2 * number * 14.399645478 / (2 * 5e6 / (1 + 4.001506179127 / mass))
        expected += np.pi * kappa**2 * part * alloy.number_density * 3000.0
    # Four standard errors, of 0.25 % each with so many ions; of the elements of 74 000 collisions 0.16 %.
    assert abs(value[1] - expected) < 4.0 * error[1] < 0.02 * expected
    metals = np.concatenate(
        [foil.history("alpha", beam_energy=5e4, seed=1, event=event)["element"] for event in range(30)]
    )
    spread = np.sqrt(0.25 * 0.75 / len(metals))
    assert abs(np.mean(metals == 0) - 0.75) < 4.0 * spread < 0.04


def test_forced_collisions_count_what_happens_by_itself():
    foil = S.Foil("gold", 0.02, minimum_angle=1e-3)
    asked = {"beam_energy": 1e5, "tally": {"lab_angle": np.radians([35, 50, 80, 110, 180])}, "incidence": 0.3}
    free = foil.run("alpha", n_events=60_000, seed=1, **asked)["lab_angle"].fraction()
    run = foil.run("alpha", n_events=60_000, seed=2, forced_angle=np.radians(10.0), **asked)
    forced = run["lab_angle"].fraction()
    pulls = (forced.value - free.value) / np.hypot(forced.error, free.error)
    # By hand: leaving out that none came before, 3 %, gives pulls of 5.
    assert np.abs(pulls).max() < 4.0, pulls
    assert (forced.error < 0.6 * free.error).all()
    assert 0 < run.missed < run.n_events


def test_an_inclined_foil_is_thicker():
    foil = S.Foil("silver", 0.3, potential="coulomb", stopping="none")
    asked = {"beam_energy": 5e6, "n_events": 20_000, "seed": 1, "collisions": "single", "forced_angle": 1.0}
    upright, inclined = (
        foil.run("alpha", tally={"cm_angle": [1.0, np.pi]}, incidence=angle, **asked)["cm_angle"]
        for angle in (0.0, 1.0)
    )
    # The same impact parameters.
    assert np.array_equal(upright.counts, inclined.counts)
    assert inclined.values() == pytest.approx(upright.values() / np.cos(1.0), rel=1e-12, abs=0)
