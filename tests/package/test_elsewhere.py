"""Words of other packages, and what a beginner writes first: refused with what to write here."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import visviva as vv

SCENE = vv.problems.kepler(e=0.5).scene
SUN = vv.Particles([1.0], [[0, 0, 0]], names=["Sun"])
METHODS = {method.name for method in vv.methods()}


@pytest.mark.parametrize(
    ("method", "cure"),
    [
        ("ias15", "taylor"),
        ("IAS15", "verner98"),
        ("bs", "verner98"),
        ("whfast", "kahan_li8"),
        ("wisdom_holman", "kahan_li8"),
        ("Wisdom Holman", "kahan_li8"),
        ("janus", "kahan_li8"),
        ("mercurius", "verner98"),
        ("trace", "verner98"),
        ("RK45", "dormand_prince54"),
        ("velocity-verlet", "leapfrog"),
        ("LSODA", "implicit"),
    ],
)
def test_methods_of_others_are_answered_with_ours(method: str, cure: str) -> None:
    with pytest.raises(vv.InvalidInput, match=rf"^method: {method} is none of visviva.methods.*{cure}") as refused:
        SCENE.run(t=1.0, method=method)  # type: ignore[arg-type]
    # Whatever method it names, there is.
    for name in str(refused.value).split("'")[1::2]:
        assert name in METHODS


def test_no_method_of_ours_is_taken_for_anothers() -> None:
    from visviva._methods_elsewhere import OF_OTHERS

    assert not METHODS & {*OF_OTHERS}


@pytest.mark.parametrize(
    ("name", "cure"),
    [
        ("integrate", "run"),
        ("energy", "invariants().energy"),
        ("add", "new Scene"),
        ("plot", ".plot()"),
        ("init_megno", "megno(t=…)"),
    ],
)
def test_a_scene_says_where_something_is(name: str, cure: str) -> None:
    with pytest.raises(AttributeError, match=rf"'Scene' object has no attribute '{name}'") as refused:
        getattr(SCENE, name)
    assert cure in str(refused.value)
    assert not hasattr(SCENE, name)


@pytest.mark.parametrize(("name", "cure"), [("Simulation", "Scene"), ("odeint", "solve_ivp"), ("MjModel", "RigidBody")])
def test_the_package_says_what_takes_the_place_of_others(name: str, cure: str) -> None:
    with pytest.raises(AttributeError, match=rf"no attribute '{name}'; .*{cure}"):
        getattr(vv, name)


@pytest.mark.parametrize(
    ("call", "argument", "cure"),
    [
        (lambda: vv.Particles(1.0, [0, 0, 0], [1, 0, 0]), "mass", "one body is [1.0], [[x, y, z]]"),
        (lambda: vv.Particles([1.0], [[0, 0]]), "position", "in a plane give z = 0"),
        (lambda: vv.collisions.elastic(1.0, 2.0, [1, 0, 0], [0, 0, 0]), "normal", "on a line, normal=[1, 0, 0]"),
        (lambda: vv.Scene(SCENE.particles, SCENE.particles), "parts", "np.concatenate([a.mass, b.mass])"),
        (
            lambda: vv.Particles.from_elements(SUN, np.zeros(1000), G=1.0, semi_major_axis=1.0),
            "names",
            "expected 1000 names, of each new body, as those that are there have some; give your own, or "
            "names=[f'particle {i}' for i in range(1000)]",
        ),
        (lambda: vv.Particles.from_elements(1.0, a=1.0), "a", "semi_major_axis"),
        (lambda: vv.scattering.Foil("Au", 0.4), "material", "did you mean 'gold'?"),
    ],
)
def test_first_attempts_are_answered_with_the_call_that_works(
    call: Callable[[], Any], argument: str, cure: str
) -> None:
    with pytest.raises(vv.InvalidInput, match=rf"^{argument}: ") as refused:
        call()
    assert cure in str(refused.value)


def test_counts_are_loaded_where_runs_are(tmp_path: Any) -> None:
    run = vv.scattering.monte_carlo(
        vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=10, seed=1
    )
    run.save(tmp_path / "counts.npz")
    assert vv.load(tmp_path / "counts.npz") == run


def test_a_few_places_are_no_path() -> None:
    """Of two outputs a line would be a chord; of many it is the orbit."""
    pytest.importorskip("matplotlib")
    chord, path = (SCENE.run(t=t).plot().axes[0].lines[0] for t in (5.0, np.linspace(0.0, 5.0, 101)))
    assert (chord.get_linestyle(), chord.get_marker()) == ("None", ".")
    assert (path.get_linestyle(), path.get_marker()) == ("-", "None")


def test_deflections_are_short_in_words_and_a_table_in_a_notebook() -> None:
    found = vv.scattering.deflect(
        vv.potentials.PowerLaw(-1.0, 4), energy=1.0, impact_parameter=np.linspace(1.0, 3.0, 50)
    )
    assert repr(found) == "Deflection(50 motions of shape (50,), 11 captured, PowerLaw(k=-1.0, n=4.0))"
    table = found._repr_html_()
    assert "and 38 more" in table
    assert "captured" in table


def test_potentials_and_forces_act_together_as_a_sum_of_them_is_told_to() -> None:
    """The sampled sum is what both are to 1e-12 of the larger; two forces in a scene add up to a rounding."""
    a, b = vv.potentials.Yukawa(1.0, 2.0), vv.potentials.PowerLaw(-0.5, 4)
    for added in (lambda: a + b, lambda: sum([a, b]), lambda: a + 1.0):
        with pytest.raises(TypeError, match=r"^potentials are not added; in a scene give each to a force") as refused:
            added()
    told = str(refused.value).rpartition("range, ")[2]
    r = np.linspace(0.1, 10.0, 50)
    both = eval(told, {"Custom": vv.potentials.Custom, "a": a, "b": b})
    # What is met is 1e-12 of |V| + r |V'|; of r^-4 that is five times V.
    np.testing.assert_allclose(both.value(r), a.value(r) + b.value(r), rtol=0, atol=5e-12 * np.abs(b.value(0.1)))
    np.testing.assert_allclose(both.force(2.0), a.force(2.0) + b.force(2.0), rtol=1e-9, atol=0)
    forces = vv.PairPotential(a), vv.PairPotential(b)
    with pytest.raises(TypeError, match=r"^forces are not added; give a scene several, as Scene\(particles, a, b\)"):
        sum(forces)
    particles = vv.Particles([1.0, 1.0], [[0.0, 0, 0], [2.0, 0, 0]])
    energies = [vv.Scene(particles, *some).invariants().potential_energy for some in (forces, forces[:1], forces[1:])]
    assert energies[0] == pytest.approx(energies[1] + energies[2], rel=1e-15, abs=0)


def test_bodies_are_joined_as_a_sum_of_them_is_told_to() -> None:
    a, b = SCENE.particles, SUN
    for added in (lambda: a + b, lambda: sum([a, b])):
        with pytest.raises(TypeError, match=r"^Particles are not added; join their arrays: ") as refused:
            added()
    told = str(refused.value).partition("arrays: ")[2].partition(", and names")[0]
    both = eval(told, {"vv": vv, "np": np, "a": a, "b": b})
    assert len(both) == len(a) + len(b)
    assert np.array_equal(both.velocity[: len(a)], a.velocity)
