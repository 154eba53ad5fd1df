"""What a foil and its runs refuse, by name."""

import pytest

import visviva as vv

S = vv.scattering


REFUSED = {
    "material": lambda: S.Foil("glod", 0.1),
    "thickness": lambda: S.Foil("gold", 0.0),
    "minimum_angle": lambda: S.Foil("gold", 0.1, minimum_angle=0.0),
    "stopping": lambda: S.Foil("gold", 0.1, stopping="beth"),
    "potential": lambda: S.Foil("gold", 0.1, potential="zbi"),
    "mass": lambda: S.Material(1.0, [1, 8], [1.008]),
    "density": lambda: S.Material(-1.0, 1, 1.0),
    "fraction": lambda: S.Material(1.0, [1, 8], [1.0, 16.0], [2.0, 0.0]),
    "atomic_number": lambda: S.Ion(0, 1.0),
    "ion": lambda: S.Foil("gold", 0.1).run("alhpa", beam_energy=1e6, n_events=1, seed=1),
    "beam_energy": lambda: S.Foil("gold", 0.1).run("alpha", beam_energy=-1.0, n_events=1, seed=1),
    "lowest_energy": lambda: S.Foil("gold", 0.1).run("alpha", beam_energy=1e6, lowest_energy=1e6, n_events=1, seed=1),
    "incidence": lambda: S.Foil("gold", 0.1).run("alpha", beam_energy=1e6, incidence=1.6, n_events=1, seed=1),
    "collisions": lambda: S.Foil("gold", 0.1).run("alpha", beam_energy=1e6, collisions="one", n_events=1, seed=1),
    "forced_angle": lambda: S.Foil("gold", 0.1).run("alpha", beam_energy=1e6, collisions="single", n_events=1, seed=1),
    "n_events": lambda: S.Foil("gold", 0.1).run("alpha", beam_energy=1e6, n_events=0, seed=1),
    "seed": lambda: S.Foil("gold", 0.1).run("alpha", beam_energy=1e6, n_events=1, seed=-1),
    "tally": lambda: S.Foil("gold", 0.1).run("alpha", beam_energy=1e6, n_events=1, seed=1, tally="cm_angle"),
    "lab_angle": lambda: S.Foil("gold", 0.1).run(
        "alpha", beam_energy=1e6, n_events=1, seed=1, tally={"lab_angle": [0, 90]}
    ),
    "stopped_depth": lambda: S.Foil("gold", 0.1).run(
        "alpha", beam_energy=1e6, n_events=1, seed=1, tally={"stopped_depth": [0, 0.2]}
    ),
    "mean_excitation_energy": lambda: S.Foil(S.Material(19.3, 79, 197.0), 0.1).run(
        "alpha", beam_energy=1e6, n_events=1, seed=1
    ),
    "energy": lambda: S.Foil("gold", 0.1).range("alpha", 10.0, lowest_energy=20.0),
}


@pytest.mark.parametrize("argument", REFUSED)
def test_bad_input_is_refused_by_name(argument):
    with pytest.raises(vv.InvalidInput) as caught:
        REFUSED[argument]()
    assert caught.value.argument == argument


def test_relativistic_ions_are_refused():
    foil = S.Foil("gold", 0.1)
    with pytest.raises(vv.InvalidInput, match="beam_energy: expected at most a tenth of the ion's rest energy"):
        foil.run("proton", beam_energy=1e8, n_events=1, seed=1)
    with pytest.raises(vv.InvalidInput, match=r"energy: expected at most 10\.0 times the ion's rest energy"):
        foil.stopping_power("proton", [1e6, 1e10])


def test_mega_electron_volts_are_told_from_electron_volts():
    """5.5 of an alpha's MeV as it is written down: at 5.5 eV nothing of the model holds."""
    with pytest.raises(vv.InvalidInput, match=r"at least 30\.0 eV.*got 5\.5 eV.*1 MeV is 1e6") as caught:
        S.Foil("gold", 0.4).run("alpha", beam_energy=5.5, n_events=1, seed=1)
    assert caught.value.argument == "beam_energy"


def test_potentials_without_a_way_on_are_refused():
    foil = S.Foil("carbon", 0.1, potential=vv.potentials.PowerLaw(-100.0, 4.0))
    with pytest.raises(vv.InvalidInput, match="captures") as caught:
        foil.run("proton", beam_energy=1e4, n_events=1, seed=1)
    assert caught.value.argument == "potential"
