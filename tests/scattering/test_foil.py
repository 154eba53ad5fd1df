"""Ions through foils, collision by collision: closure, angles, ranges, and ends that are what is counted.

Bounds: a cosine that is turned back into an angle of size 1, after some hundred turns of the direction.
"""

import numpy as np
import pytest

import visviva as vv

S = vv.scattering


@pytest.mark.parametrize(
    ("foil", "ion", "energy"),
    [
        (S.Foil("gold", 0.1), "alpha", 7.687e6),
        (S.Foil("water", 0.5), S.Ion(18, 39.948), 2e5),  # heavier than what it meets, two elements
        (S.Foil("silicon", 0.05, stopping="none"), S.Ion(14, 28.085), 3e4),  # equal masses
        (S.Foil("gold", 0.05, potential="coulomb"), "proton", 1e5),
        (S.Foil("carbon", 0.05, potential=vv.potentials.Yukawa(300.0, 0.3)), "proton", 2e4),
    ],
)
def test_every_collision_closes(foil, ion, energy):
    made = S.Ion(1, 1.007276466621) if ion == "proton" else S.Ion(2, 4.001506179127) if ion == "alpha" else ion
    collisions = 0
    for event in range(6):
        way = foil.history(ion, beam_energy=energy, seed=3, event=event)
        collisions += len(way["depth"])
        before, after = way["energy"].T
        target = np.array(foil.material.mass)[way["element"].astype(int)]
        impulse = np.sqrt(2.0 * made.mass * way["energy"])[..., None] * way["direction"]
        recoil = np.sum((impulse[:, 0] - impulse[:, 1]) ** 2, axis=1) / (2.0 * target)
        # The target takes the momentum that is lost, and the energy that is: rounding of p, of which p²/2m is made.
        assert np.abs(recoil - (before - after)).max() < 1e-14 * energy * max(1.0, made.mass / target.min())
        assert np.abs(np.linalg.norm(way["direction"], axis=2) - 1.0).max() < 4e-16
        # Laboratory angles of the same collisions: the first turn is by that angle.
        cosine = np.sum(way["direction"][:, 0] * way["direction"][:, 1], axis=1)
        expected = np.cos(S.lab_angle(way["cm_angle"], mass_ratio=made.mass / target))
        # Equal masses head-on leave a direction of no meaning.
        sharp = after > 1e-9 * before
        assert np.abs(cosine - expected)[sharp].max() < 1e-14
        # Never behind the surfaces; energies fall along the way.
        assert ((way["depth"] >= 0.0) & (way["depth"] <= foil.thickness)).all()
        assert (np.diff(way["energy"].ravel()) <= 0.0).all()
    assert collisions > 6


def test_angles_are_those_of_the_deflection_function():
    """The table of energies and impact parameters, where ions happen to come: to 1e-5 of the angle, 1e-9 at least."""
    foil = S.Foil("silver", 1.0)
    potential = vv.potentials.ScreenedCoulomb.between(2, 47)
    way = foil.history("alpha", beam_energy=2e5, seed=1)
    assert len(way["depth"]) > 300
    share = 107.8682 / (107.8682 + 4.001506179127)
    found = S.deflect(potential, energy=way["energy"][:, 0] * share, impact_parameter=way["impact_parameter"])
    assert np.allclose(way["cm_angle"], found.angle, rtol=1e-5, atol=1e-9)
    assert way["cm_angle"].min() > 0.5e-4
    assert way["cm_angle"].max() > 0.1
    # Discs hold all that turn by the minimum angle and little more.
    below = way["cm_angle"] < 1e-4
    assert 0 < below.sum() < 0.1 * len(below)


@pytest.mark.parametrize(
    "potential",
    [
        vv.potentials.Plummer(30.0, 0.3),  # a hill that protons pass over, and as they slow down do not
        vv.potentials.LennardJones(0.01, 2.0),
        vv.potentials.HardSphere(0.5),
        vv.potentials.Coulomb(-50.0),
    ],
)
def test_any_potential(potential):
    foil = S.Foil("carbon", 0.01, potential=potential, stopping="none")
    hill = isinstance(potential, vv.potentials.Plummer)
    energy, lowest = (110.0, 90.0) if hill else (1e4, 5e3)
    way = foil.history("proton", beam_energy=energy, seed=1, lowest_energy=lowest)
    share = 12.011 / (12.011 + 1.007276466621)
    found = S.deflect(potential, energy=way["energy"][:, 0] * share, impact_parameter=way["impact_parameter"])
    folded = np.arccos(np.cos(found.angle))
    assert len(folded)
    # Angles are read from tables that may be off by 4e-6 of sin²(ψ/2); measured 6.2e-6 of small angles.
    assert np.allclose(way["cm_angle"], folded, rtol=2e-5, atol=2e-8)


def test_without_collisions_the_range_is_the_integral():
    nothing = vv.potentials.HardSphere(1e-9)
    for stopping in ("joined", "lindhard_scharff", "bethe"):
        foil = S.Foil("aluminum", 100.0, potential=nothing, stopping=stopping)
        way = foil.history("alpha", beam_energy=5.486e6, seed=1, lowest_energy=1e4)
        assert way["fate"] == "stopped"
        assert not len(way["depth"])
        assert way["final_angle"] == 0.0
        expected = foil.range("alpha", 5.486e6, lowest_energy=way["final_energy"])
        # Steps of the midpoint rule lose 1/256 of the energy each: 1e-6 of the way and less (Bethe's edge: 1e-5).
        assert abs(way["final_depth"] / expected - 1.0) < 2e-5
        # The integral itself, by another rule in another variable.
        logarithm = np.linspace(np.log(1e4), np.log(5.486e6), 20_001)
        losses = np.exp(logarithm) / foil.stopping_power("alpha", np.exp(logarithm))
        integral = np.sum(0.5 * (losses[1:] + losses[:-1]) * np.diff(logarithm))
        assert foil.range("alpha", 5.486e6, lowest_energy=1e4) == pytest.approx(integral, rel=1e-7, abs=0)


def test_energy_left_behind_a_foil_is_that_of_the_range():
    foil = S.Foil("gold", 2.0, potential=vv.potentials.HardSphere(1e-9))
    way = foil.history("alpha", beam_energy=7.687e6, seed=1, incidence=0.5)
    whole, rest = foil.range("alpha", [7.687e6, way["final_energy"]], lowest_energy=1e4)
    # Midpoint steps of 1/256 of the energy, as above; measured 7e-7.
    assert whole - rest == pytest.approx(2.0 / np.cos(0.5), rel=3e-6, abs=0)


def test_every_ion_ends_somewhere():
    foil = S.Foil("gold", 0.06)
    out = foil.run("alpha", beam_energy=2e4, n_events=3000, seed=1)
    parts = (out.transmitted, out.reflected, out.stopped)
    assert min(parts) > 100
    assert sum(parts) == 3000
    assert out.missed == 0
    for name, count in zip(("transmitted_angle", "reflected_angle", "stopped_depth"), parts, strict=True):
        tally = out[name]
        assert tally.counts.sum() + tally.underflow + tally.overflow == count
        assert tally.underflow == tally.overflow == 0
    assert sum(out.fraction(fate).value for fate in ("transmitted", "reflected", "stopped")) == pytest.approx(1.0)
    assert out["transmitted_energy"].edges[-1] == 2e4
    assert out["stopped_depth"].edges[-1] == pytest.approx(0.06)


def test_histories_are_what_is_counted():
    """Every tally of 40 ions, from their ends one by one."""
    foil = S.Foil("gold", 0.06, minimum_angle=2e-3)
    asked = {"beam_energy": 2e4, "seed": 9, "incidence": 0.4, "lowest_energy": 1e3}
    names = ("lab_angle", "transmitted_angle", "transmitted_energy", "reflected_angle", "reflected_energy")
    out = foil.run("alpha", n_events=40, tally=(*names, "stopped_depth"), **asked)
    ends = [foil.history("alpha", event=event, **asked) for event in range(40)]
    assert min(out.transmitted, out.reflected, out.stopped) > 2
    for name, tally in out.items():
        fate, _, quantity = name.partition("_")
        fates = ("transmitted", "reflected") if fate == "lab" else (fate,)
        values = [way[f"final_{quantity}"] for way in ends if way["fate"] in fates]
        assert tally.counts.tolist() == np.histogram(values, tally.edges)[0].tolist(), name
    for way in ends:
        depth = {"transmitted": 0.06, "reflected": 0.0}.get(way["fate"], way["final_depth"])
        assert way["final_depth"] == depth
        assert way["weight"] == 1.0
        if way["fate"] != "stopped":
            direction = way["direction"][-1, 1]
            beam = np.array([np.sin(0.4), 0.0, np.cos(0.4)])
            assert way["final_angle"] == pytest.approx(np.arccos(direction @ beam), abs=1e-12)


def test_it_draws_itself():
    pytest.importorskip("matplotlib")
    out = S.Foil("gold", 0.06).run("alpha", beam_energy=2e4, n_events=300, seed=1)
    figure = out.plot()
    assert [axes.get_xlabel() for axes in figure.axes][-1] == "depth of stopped ions [µm]"
