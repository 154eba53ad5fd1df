"""What electrons take: published losses, and what the formulas tend to.

Bounds: those of what is published, beside each number; sums of two losses, a few roundings.
"""

import numpy as np
import pytest

import visviva as vv
from visviva.scattering._foil_material import _MATERIALS

S = vv.scattering


def mass_stopping(material, ion, energy, stopping="joined"):
    """In MeV cm²/g."""
    foil = S.Foil(material, 1.0, stopping=stopping)
    return float(foil.stopping_power(ion, energy)) * 1e-2 / foil.material.density


@pytest.mark.parametrize(
    ("energy", "published", "tolerance"),
    [(1e6, 260.6, 0.04), (1e7, 45.64, 0.01), (1e8, 7.288, 0.002), (2e8, 4.491, 0.002)],
)
def test_protons_in_water(energy, published, tolerance):
    """NIST's PSTAR (electronic, I = 75 eV); shell corrections, 0.5 % at 10 MeV, are not in Bethe's formula."""
    for stopping in ("bethe", "joined"):
        assert mass_stopping("water", "proton", energy, stopping) == pytest.approx(published, rel=tolerance, abs=0)


@pytest.mark.parametrize(("energy", "published", "percent"), [(1e4, 432.9, 30), (5e4, 776.8, 25)])
def test_slow_protons_in_water_lose_too_much_as_the_help_says(energy, published, percent):
    """PSTAR again (0.3 % of it nuclear losses at 10 keV): what users are told of the joined formula stays true."""
    assert mass_stopping("water", "proton", energy) == pytest.approx((1.0 + percent / 100) * published, rel=0.01, abs=0)
    assert f"{percent} %" in S.Foil.__doc__


@pytest.mark.parametrize(("material", "published"), [("aluminum", 588.0), ("silicon", 588.0), ("gold", 220.0)])
def test_alphas_of_americium(material, published):
    """5.5 MeV, near what ASTAR has: the joined formula is good to 10 %."""
    assert mass_stopping(material, "alpha", 5.5e6) == pytest.approx(published, rel=0.1, abs=0)


def test_slow_ions_lose_as_their_speed():
    foil = S.Foil("gold", 1.0, stopping="lindhard_scharff")
    loss = foil.stopping_power("alpha", [100.0, 400.0])
    assert loss[1] / loss[0] == pytest.approx(2.0, rel=1e-7)  # relativity: 1e-7 of it
    # 1.212 Z₁^(7/6) Z₂ (Z₁^⅔ + Z₂^⅔)^(−3/2) √(E/M) eV Å² an atom (Biersack & Haggmark 1980), whose M is in nucleons.
    printed = 1.212 * 2 ** (7 / 6) * 79 / (2 ** (2 / 3) + 79 ** (2 / 3)) ** 1.5 * np.sqrt(100.0 / 4.0015)
    assert loss[0] == pytest.approx(printed * foil.material.number_density * 1e4, rel=4e-3, abs=0)


def test_bethe_is_the_formula():
    """With CODATA's numbers, once more: K Z/A z²/β² (ln(2mc²β²γ²/I) − β²), K = 0.307075 MeV cm²/mol."""
    energy, rest = 50.0, 4.001506179127 * 931.49410242
    gamma = 1.0 + energy / rest
    beta2 = 1.0 - 1.0 / gamma**2
    logarithm = np.log(2 * 0.51099895e6 * beta2 * gamma**2 / 166.0) - beta2
    expected = 0.307075 * 13 / 26.9815384 * 4 / beta2 * logarithm
    # K is printed with six digits, half a unit of which is 1.6e-6; measured 2.4e-7.
    assert mass_stopping("aluminum", "alpha", 5e7, "bethe") == pytest.approx(expected, rel=1e-6, abs=0)


def test_losses_of_elements_add():
    """Bragg's rule, with the mean excitation energy of each."""
    both = S.Foil(S.Material(2.0, [6, 14], [12.0, 28.0], [3, 1], mean_excitation_energy=[81.0, 173.0]), 1.0)
    carbon = S.Foil(S.Material(2.0 * 36 / 64, 6, 12.0, mean_excitation_energy=81.0), 1.0)
    silicon = S.Foil(S.Material(2.0 * 28 / 64, 14, 28.0, mean_excitation_energy=173.0), 1.0)
    energy = np.geomspace(1e3, 1e7, 9)
    sums = [foil.stopping_power("alpha", energy) for foil in (carbon, silicon)]
    assert both.stopping_power("alpha", energy) == pytest.approx(sum(sums), rel=1e-13, abs=0)


def test_the_table_of_materials():
    """Every one of them can be hit, and has a number density like that of matter."""
    for name in _MATERIALS:
        foil = S.Foil(name, 0.01, minimum_angle=1e-2)
        # Atoms per Å³: from lead's 0.033 to diamond's 0.176.
        assert 0.02 < foil.material.number_density < 0.2
        with pytest.warns(vv.AccuracyWarning, match="minimum_angle"):  # that the tables be small
            out = foil.run("alpha", beam_energy=5e6, n_events=20, seed=1)
        assert out.transmitted + out.reflected + out.stopped == 20


def test_measured_losses():
    """A table of the formula's own numbers is the formula: what is between two of a hundred, to 1e-3."""
    foil = S.Foil("aluminum", 1.0)
    energy = np.geomspace(1e3, 1e7, 400)
    told = S.Foil("aluminum", 1.0, stopping=(energy, foil.stopping_power("alpha", energy)))
    between = np.geomspace(1.1e3, 9e6, 77)
    assert told.stopping_power("alpha", between) == pytest.approx(
        foil.stopping_power("alpha", between), rel=1e-3, abs=0
    )
    asked = {"beam_energy": 5e6, "n_events": 50, "seed": 1, "tally": "transmitted_energy"}
    assert told.run("alpha", **asked).transmitted == 50
    for wrong in ((energy, energy[1:]), (energy[::-1], energy), (energy, 0.0 * energy), "table", ([1.0], [1.0])):
        with pytest.raises(vv.InvalidInput) as caught:
            S.Foil("aluminum", 1.0, stopping=wrong)
        assert caught.value.argument == "stopping"
    with pytest.raises(vv.InvalidInput, match=r"stopping: expected losses up to 20000000.0, got a table that ends at"):
        told.run("alpha", **(asked | {"beam_energy": 2e7}))
