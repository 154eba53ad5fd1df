"""Foils that are no foils: thinner than atoms are apart, or than the way between two collisions."""

import warnings

import numpy as np
import pytest

import visviva as vv

S = vv.scattering
ASKED = {"beam_energy": 7.687e6, "n_events": 1000, "seed": 1}


def test_a_foil_thinner_than_an_atom_is_warned_of_with_the_figure():
    # Gold, 19.32 g/cm³ of 196.97 u: n^(-1/3) = 2.57 Å.
    foil = S.Foil("gold", 1e-4)
    with pytest.warns(vv.AccuracyWarning, match=r"thickness = 0\.0001 µm is 1 Å, less than the 2\.6 Å") as caught:
        foil.run("alpha", **ASKED)
    assert caught[0].filename == __file__


def test_a_foil_thinner_than_the_way_between_collisions_is_warned_of_with_the_figure():
    foil = S.Foil("gold", 0.4, minimum_angle=0.01)
    with pytest.warns(vv.AccuracyWarning, match=r"0\.58 collisions.*0\.4 µm.*minimum_angle = 0\.01") as caught:
        out = foil.run("alpha", **ASKED, tally={"transmitted_angle": [0.0, 1e-12, np.pi / 2]})
    assert len(caught) == 1
    # The ions that are turned by nothing are those of no collision, e^-0.583 of them: five standard deviations.
    part = np.exp(-out.collisions_across)
    assert out["transmitted_angle"].counts[0] == pytest.approx(
        1000 * part, rel=0.0, abs=5.0 * np.sqrt(1000 * part * (1.0 - part))
    )


def test_what_is_meant_for_thin_foils_runs_without_a_word():
    forced = np.radians(60.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        S.Foil("gold", 1e-4).run("alpha", **ASKED, collisions="single", forced_angle=forced)
        S.Foil("gold", 0.4, minimum_angle=0.01).run("alpha", **ASKED, forced_angle=forced)
        S.Foil("gold", 0.4).run("alpha", **ASKED)
