"""Every contradiction among elements, and all that has none, refused by name."""

from typing import Any

import numpy as np
import pytest

import visviva as vv

ORBIT: dict[str, Any] = {"G": 1.0, "semi_major_axis": 1.0}


@pytest.mark.parametrize(
    ("changes", "argument", "words"),
    [
        ({"semi_major_axis": None}, "semi_major_axis", "expected the size"),
        ({"pericenter": 0.5}, "pericenter", "semi_major_axis and pericenter"),
        ({"period": 0.5}, "period", "semi_major_axis and period"),
        ({"semi_major_axis": -1.0, "eccentricity": 2.0}, "semi_major_axis", "also for a hyperbola"),
        ({"semi_major_axis": 0.0}, "semi_major_axis", "positive"),
        ({"semi_major_axis": np.inf}, "semi_major_axis", "finite"),
        ({"eccentricity": -0.1}, "eccentricity", "e ≥ 0"),
        ({"eccentricity": 1.0}, "semi_major_axis", "no parabola"),
        ({"semi_major_axis": None, "period": 1.0, "eccentricity": 1.5}, "period", "ellipses"),
        ({"inclination": -0.1}, "inclination", "from 0 to π"),
        ({"inclination": 90.0}, "inclination", "radians"),
        ({"true_anomaly": 0.0, "mean_anomaly": 0.0}, "mean_anomaly", "true_anomaly and mean_anomaly"),
        ({"argument_of_pericenter": 0.0, "longitude_of_pericenter": 0.0}, "longitude_of_pericenter", "and"),
        ({"eccentricity": 2.0, "true_anomaly": 3.0}, "true_anomaly", "asymptotes"),
        ({"G": 0.0}, "mass", "attracts"),
        ({"G": -1.0}, "eccentricity", "repel"),
        ({"mass": -1.0}, "mass", "at least 0"),
        ({"central": 0.0, "mass": 0.0}, "mass", "attracts"),
        ({"central": -1.0}, "mass", "at least 0"),
        ({"central": "Sun"}, "central", "real number"),
        ({"about": 1}, "about", "there before body 1"),
        ({"about": 2}, "about", "from 0 to 1"),
        ({"about": "Sun"}, "about", "no names"),
        ({"about": [0, 0]}, "about", "one for each of 1"),
        ({"names": ["Sun"]}, "names", "expected 2 names"),
        ({"names": ["Sun", "jacobi"]}, "names", "another name"),
        ({"names": 3}, "names", "sequence"),
        ({"eccentricity": [[0.1]]}, "semi_major_axis", "one axis"),
        ({"eccentricity": [0.1, 0.2], "inclination": [0.0, 0.1, 0.2]}, "inclination", "broadcast"),
        ({"t0": np.nan}, "t0", "finite"),
        ({"node": 0.1}, "node", "longitude_of_ascending_node"),
        ({"eccentricty": 0.1}, "eccentricty", "did you mean 'eccentricity'"),
    ],
)
def test_what_makes_no_orbit_is_refused_by_name(changes: dict[str, Any], argument: str, words: str) -> None:
    given: dict[str, Any] = {"central": 1.0, "mass": 0.1, **ORBIT} | changes
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        vv.Particles.from_elements(**given)
    assert caught.value.argument == argument


@pytest.mark.parametrize(
    ("bodies", "about", "argument", "words"),
    [
        (None, 3, "about", "from 0 to 2"),
        (None, "Sun", "about", "no names"),
        ([0, 1], 0, "bodies", "other bodies than body 0"),
        (0, "jacobi", "bodies", "after the first"),
        (2, 1, "about", "at the very place"),
        (1, 2, "about", "at the very place"),
        ([1.5], 0, "bodies", "whole number"),
    ],
)
def test_elements_that_there_are_not_are_refused_by_name(bodies: Any, about: Any, argument: str, words: str) -> None:
    particles = vv.Particles([1.0, 1.0, 0.0], [[0, 0, 0], [1, 0, 0], [1, 0, 0]])
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        vv.Scene(particles, vv.Gravity(1.0)).elements(bodies, about=about)
    assert caught.value.argument == argument


def test_elements_need_masses_and_a_constant() -> None:
    two = vv.Particles([0.0, 0.0, 1.0], [[0, 0, 0], [1, 0, 0], [5, 0, 0]])
    scene = vv.Scene(two)
    with pytest.raises(vv.InvalidInput, match="no Gravity") as caught:
        scene.elements()
    assert caught.value.argument == "G"
    with pytest.raises(vv.InvalidInput, match="neither body 1 nor body 0"):
        scene.elements(1, G=1.0)
    with pytest.raises(vv.InvalidInput, match="bodies with mass"):
        scene.elements(2, about="jacobi", G=1.0)
    with pytest.raises(vv.InvalidInput, match="bodies with mass"):
        scene.elements(2, about="center_of_mass", G=1.0)
    assert scene.elements(1, about=2, G=2.0).mu == 2.0


def test_what_is_beyond_float64_is_refused_by_name() -> None:
    far = vv.Scene(vv.Particles([1.0, 1.0], [[-1e308, 0, 0], [1e308, 0, 0]]), vv.Gravity(1.0))
    with pytest.raises(vv.InvalidInput, match="distance of body 1 from body 0") as caught:
        far.elements()
    assert caught.value.argument == "about"
    heavy = vv.Scene(vv.Particles([1e200, 1.0], np.eye(3)[:2]), vv.Gravity(1e200))
    with pytest.raises(vv.InvalidInput, match="G times the masses"):
        heavy.elements()
    with pytest.raises(vv.InvalidInput, match="G times the masses"):
        vv.Particles.from_elements(1e200, 1.0, G=1e200, semi_major_axis=1.0)
    with pytest.raises(vv.InvalidInput, match="a time at which") as caught:
        vv.Particles.from_elements(
            1e10, 0.0, G=1e10, pericenter=1.0, eccentricity=3.0, time_of_pericenter=-1e307, t0=1e307
        )
    assert caught.value.argument == "time_of_pericenter"
