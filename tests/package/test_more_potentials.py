"""The potentials of the books: minima, limits, screening, and what has no force.

Bounds: powers of a ratio lose their exponent's roundings, n m of a force that vanishes; published numbers to the
digits in which they are printed (nine of screening functions, six of a length).
"""

import numpy as np
import pytest

import visviva as vv
from visviva import potentials
from visviva.potentials import (
    Buckingham,
    Coulomb,
    HardSphere,
    LennardJones,
    Mie,
    Morse,
    Plummer,
    PowerLaw,
    ScreenedCoulomb,
    SoftSphere,
    SquareWell,
    Yukawa,
)

R = np.geomspace(0.3, 20.0, 200)


def test_special_cases_are_each_other() -> None:
    # (σ/r)¹² by products in another order: twelve roundings on each side.
    assert Mie(2.0, 1.3, 12.0, 6.0).value(R) == pytest.approx(LennardJones(2.0, 1.3).value(R), rel=1e-13, abs=1e-14)
    assert PowerLaw(2.0, 1.0).force(R) == pytest.approx(Coulomb(2.0).force(R), rel=1e-15, abs=0)
    assert Plummer(-2.0, 1e-9).value(R) == pytest.approx(Coulomb(-2.0).value(R), rel=1e-15, abs=0)
    assert Buckingham(3.0, 2.0, 0.0).value(R) == pytest.approx(3.0 * np.exp(-2.0 * R), rel=2e-15, abs=0)
    # An exponent off 2 by the last digit goes by another way, by logarithms: r^(2 ± 4e-16).
    near = PowerLaw(1.0, np.nextafter(2.0, 3.0))
    assert near.value(R) == pytest.approx(PowerLaw(1.0, 2.0).value(R), rel=4e-15, abs=0)


@pytest.mark.parametrize(("n", "m"), [(12.0, 6.0), (9.0, 6.0), (7.5, 3.25)])
def test_the_minimum_of_a_mie_potential(n: float, m: float) -> None:
    well = Mie(epsilon=3.0, sigma=1.5, n=n, m=m)
    bottom = 1.5 * (n / m) ** (1.0 / (n - m))
    assert float(well.value(1.5)) == 0.0
    assert float(well.value(bottom)) == pytest.approx(-3.0, rel=1e-14, abs=0)
    assert abs(float(well.force(bottom))) < 1e-14 * 3.0 * n * m
    assert float(well.curvature(bottom)) == pytest.approx(3.0 * n * m / bottom**2, rel=1e-13, abs=0)


def test_morse_and_plummer_at_their_marks() -> None:
    well = Morse(depth=4.0, a=1.5, r_e=2.0)
    assert (float(well.value(2.0)), float(well.force(2.0)), float(well.curvature(2.0))) == (-4.0, 0.0, 2 * 4 * 1.5**2)
    sphere = Plummer(k=-6.0, a=3.0)
    assert (float(sphere.value(0.0)), float(sphere.force(0.0))) == (-2.0, 0.0)
    assert float(sphere.value(4.0)) == -1.2
    # The pull is strongest at a/√2.
    assert abs(float(sphere.curvature(3.0 / np.sqrt(2.0)))) < 1e-16


@pytest.mark.parametrize("n", [2.0, 2.5, 4.0])
def test_soft_spheres_touch(n: float) -> None:
    sphere = SoftSphere(k=8.0, radius=2.0, n=n)
    assert sphere.value([0.0, 2.0, 3.0]).tolist() == [8.0, 0.0, 0.0]
    assert float(sphere.value(1.0)) == pytest.approx(8.0 * 0.5**n, rel=1e-15, abs=0)
    assert sphere.force([2.0, 5.0]).tolist() == [0.0, 0.0]
    assert float(sphere.curvature(2.5)) == 0.0


# φ(1), from the formulas by mpmath; Thomas and Fermi's from tools/thomas_fermi.py. And −φ'(0).
SCREENED = {
    "zbl": 0.4164394107,
    "moliere": 0.4251910692,
    "kr_c": 0.4442010742,
    "lenz_jensen": 0.4037412463,
    "thomas_fermi": 0.4240080521,
}
SLOPES = {
    "zbl": 0.18175 * 3.1998 + 0.50986 * 0.94229 + 0.28022 * 0.40290 + 0.02817 * 0.20162,
    "moliere": 0.35 * 0.3 + 0.55 * 1.2 + 0.1 * 6.0,
    "kr_c": 0.190945 * 0.278544 + 0.473674 * 0.637174 + 0.335381 * 1.919249,
    "lenz_jensen": 9.67 * (0.5 - 0.3344),
    "thomas_fermi": 1.588071022611375,
}


@pytest.mark.parametrize("screening", SCREENED)
def test_screening_functions(screening: str) -> None:
    potential = ScreenedCoulomb(1.0, 1.0, screening)  # type: ignore[arg-type]
    assert float(potential.value(1e-300)) == pytest.approx(1e300, rel=2e-15)
    assert float(potential.value(1.0)) == pytest.approx(SCREENED[screening], rel=1e-9, abs=0)
    x = 1e-8
    # φ = 1 − slope x + O(x^3/2), so that the second term is x^1/2 of the first; rounding is 1e-16/x.
    assert (1.0 - float(potential.value(x)) * x) / x == pytest.approx(SLOPES[screening], rel=2e-4, abs=0)
    x = np.geomspace(1e-4, 1e4, 400)
    phi = potential.value(x) * x
    assert np.all(np.diff(phi) <= 0.0)
    assert np.all(potential.force(x) >= phi / x**2 * (1.0 - 1e-15))


def test_thomas_and_fermi() -> None:
    """The equation itself, φ'' = φ^(3/2)/√x."""
    potential = ScreenedCoulomb(1.0, 1.0, "thomas_fermi")
    x = np.geomspace(1e-3, 1e6, 500)
    phi = potential.value(x) * x
    slope = (phi - potential.force(x) * x * x) / x
    bend = (potential.curvature(x) * x**3 - 2.0 * (phi - x * slope)) / x**2
    # A difference of numbers of order φ, against x² φ'' = (x φ)^1.5; two derivatives of polynomials in pieces of a
    # tenth of their distance take two to three digits.
    assert np.all(np.abs(bend * x**2 - (x * phi) ** 1.5) < 2e-13 * (phi + (x * phi) ** 1.5))
    far = ScreenedCoulomb(1.0, 1.0, "thomas_fermi").value(1e9) * 1e9
    # 144/x³ (1 − 13.27 x^−0.772 + …): at 1e9 off by 1.5e-6.
    assert float(far) == pytest.approx(144e-27 * (1.0 - 13.270973848 * 1e9**-0.7720018726587652), rel=1e-11, abs=0)


def test_two_nuclei() -> None:
    helium_gold = ScreenedCoulomb.between(2, 79)
    assert helium_gold.k == 2 * 79 * 14.399645478
    assert helium_gold.length == pytest.approx(0.119985, abs=5e-7)
    firsov = ScreenedCoulomb.between(18, 18, "kr_c")
    assert firsov.length == pytest.approx(
        0.8853413770 * 0.529177210544 / (2.0 * np.sqrt(18.0)) ** (2.0 / 3.0), rel=2e-12, abs=0
    )
    in_nanometers = ScreenedCoulomb.between(2, 79, e2=1.4399645478, bohr_radius=0.0529177210544)
    assert float(in_nanometers.value(0.03)) == pytest.approx(float(helium_gold.value(0.3)), rel=1e-14, abs=0)


ENDLESS = [
    Coulomb(1.3),
    PowerLaw(1.3, 2.5),
    PowerLaw(-1.3, 4.0),
    Yukawa(1.3, 0.7),
    LennardJones(1.3, 0.7),
    Mie(1.3, 0.7, 8.5, 5.0),
    Morse(1.3, 0.7, 2.0),
    Buckingham(1.3, 0.7, 2.0),
    Buckingham(1.3, 0.7, 0.0),
    Plummer(1.3, 0.7),
    SoftSphere(1.3, 0.7, 2.5),
    *(ScreenedCoulomb(1.3, 0.7, name) for name in SCREENED),  # type: ignore[arg-type]
]


@pytest.mark.parametrize("potential", ENDLESS, ids=repr)
def test_near_and_far_there_are_limits(potential: potentials.Potential) -> None:
    near, far = [0.0, 5e-324, 1e-310, 1e-200, 1e-110], [1e110, 1e200, 1e300, 1.7e308]
    for asked in (potential.value, potential.force, potential.curvature):
        assert not np.isnan(asked(near)).any()
        assert np.all(np.abs(asked(far)) <= 1e-100)
    # And so where it acts: bodies that are far apart move freely, in whatever units.
    bodies = vv.Particles([1.0, 1.0], [[0, 0, 0], [1e200, 0, 0]], [[0, 0, 0], [0, 1.0, 0]])
    scene = vv.Scene(bodies, vv.PairPotential(potential))
    assert np.all(np.abs(scene.acceleration()) <= 1e-100)


def test_a_large_distance_of_a_plummer_sphere_is_no_overflow() -> None:
    assert float(Plummer(2.0, 1e200).value(1e200)) == pytest.approx(2.0 / (np.sqrt(2.0) * 1e200), rel=1e-15, abs=0)
    assert float(PowerLaw(1e-200, 2.0).value(1e-200)) == pytest.approx(1e200, rel=1e-15)
    assert float(PowerLaw(1e300, 3.5).value(1e100)) == pytest.approx(1e-50, rel=1e-14, abs=0)


@pytest.mark.parametrize("potential", [SquareWell(2.0, 1.5), HardSphere(1.5)], ids=repr)
def test_what_jumps_has_values_and_no_force(potential: potentials.Potential) -> None:
    inside = -2.0 if isinstance(potential, SquareWell) else np.inf
    assert potential.value([0.0, 1.4999, 1.5, 9.0]).tolist() == [inside, inside, 0.0, 0.0]
    assert potential.rescaled(length=2.0).value([2.9, 3.0]).tolist() == [4.0 * inside, 0.0]
    pair = vv.Scene(vv.Particles([1.0, 1.0], [[0, 0, 0], [3.0, 0, 0]]), vv.PairPotential(potential))
    around = vv.Scene(vv.Particles([1.0], [[3.0, 0, 0]]), vv.CentralField(potential))
    for asked in (potential.force, potential.curvature):
        with pytest.raises(vv.InvalidInput, match="jumps") as caught:
            asked(1.0)
        assert caught.value.argument == "potential"
    for scene in (pair, around):
        for act in (lambda s=scene: s.plan(t=1.0), lambda s=scene: s.run(t=1.0), scene.acceleration):
            with pytest.raises(vv.InvalidInput, match="jumps") as caught:
                act()
            assert caught.value.argument == "potential"


@pytest.mark.parametrize(
    ("make", "argument", "words"),
    [
        (lambda: Mie(1.0, 1.0, 6.0, 12.0), "m", "less than n = 6.0, got 12.0"),
        (lambda: Mie(1.0, 1.0, 6.0, 6.0), "m", "less than n"),
        (lambda: SoftSphere(1.0, 1.0, 1.5), "n", "at least 2"),
        (lambda: PowerLaw(1.0, 0.0), "n", "positive"),
        (lambda: Buckingham(1.0, 1.0, -1.0), "C", "at least 0"),
        (lambda: ScreenedCoulomb(1.0, 1.0, "bohr"), "screening", "one of zbl"),  # type: ignore[arg-type]
        (lambda: ScreenedCoulomb.between(0, 3), "Z1", "positive"),
        (lambda: ScreenedCoulomb.between(1, 3, "molier"), "screening", "did you mean 'moliere'"),  # type: ignore[arg-type]
    ],
)
def test_refusals(make: object, argument: str, words: str) -> None:
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        make()  # type: ignore[operator]
    assert caught.value.argument == argument


def test_energy_is_conserved_in_every_potential_with_a_force() -> None:
    bodies = vv.Particles([1.0, 2.0], [[0, 0, 0], [1.1, 0.2, 0]], [[0, 0.1, 0], [0, -0.05, 0.02]])
    for potential in ENDLESS:
        if potential in (PowerLaw(-1.3, 4.0), Buckingham(1.3, 0.7, 2.0)):
            continue  # in which they fall into each other
        out = vv.Scene(bodies, vv.PairPotential(potential)).run(t=np.linspace(0.0, 0.5, 6), rtol=1e-12)
        size = np.abs(out.energy).max() + abs(float(potential.value(1.1)))
        # Where a derivative jumps, in contact, the tolerance is all there is.
        assert np.ptp(out.energy) <= 1e-10 * size, potential
