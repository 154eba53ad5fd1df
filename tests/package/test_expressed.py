"""Formulas of one's own as potentials, run as bytecode: what they give, where they go, and what is refused.

Bounds: the same expression by two ways, or in two units, to some ten roundings of its terms; angles and slopes of
deflections as exact as their integrals, 1e-14 of π.
"""

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp

import visviva as vv
from visviva.potentials import Custom, Expressed

p = vv.potentials
r, k, length = sp.symbols("r k length", positive=True)
# Each by SymPy or as a function, and what visviva has by name.
PAIRS = {
    "coulomb": (Custom(k / r, parameters={k: -1.5}), p.Coulomb(-1.5)),
    "yukawa": (
        Custom(k * sp.exp(-r / length) / r, parameters={"k": 1.3, "length": 0.7}),
        p.Yukawa(1.3, 0.7),
    ),
    "lennard-jones": (
        Custom(lambda r, e, s: 4.0 * e * ((s / r) ** 12 - (s / r) ** 6), parameters={"e": 1.2, "s": 0.9}),
        p.LennardJones(1.2, 0.9),
    ),
    "morse": (
        Custom(lambda r, a, b: 2.0 * ((1.0 - np.exp(-a * (r - b))) ** 2 - 1.0), parameters={"a": 1.5, "b": 1.1}),
        p.Morse(2.0, 1.5, 1.1),
    ),
    "plummer": (Custom(lambda r: -1.0 / np.sqrt(r * r + 0.25)), p.Plummer(-1.0, 0.5)),
    "power law": (Custom(0.5 * r**-2.5), p.PowerLaw(0.5, 2.5)),
}  # fmt: skip


@pytest.mark.parametrize("pair", PAIRS.values(), ids=PAIRS)
def test_values_and_derivatives(pair: tuple[Any, p.Potential]) -> None:
    made, named = pair
    assert isinstance(made, Expressed)
    places = np.geomspace(0.3, 30.0, 500)
    for what in ("value", "force", "curvature"):
        found, expected = getattr(made, what)(places), getattr(named, what)(places)
        # Some tens of roundings of the largest of the terms, which farther out are no larger than here.
        size = np.maximum.accumulate(np.abs(expected)[::-1])[::-1]
        assert (np.abs(found - expected) <= 1e-14 * size + 4e-16 * np.abs(named.value(0.3))).all(), what


@pytest.mark.parametrize("count", [2, 7, 9, 40])
@pytest.mark.parametrize("name", ["yukawa", "lennard-jones", "morse", "plummer"])
def test_pairs_move_as_by_the_named_potential(name: str, count: int) -> None:
    made, named = PAIRS[name]
    rng = np.random.default_rng(count)
    grid = np.stack(np.meshgrid(*[np.arange(4.0)] * 3), axis=-1).reshape(-1, 3)[:count]
    bodies = vv.Particles(rng.uniform(1.0, 2.0, count), 1.2 * grid + 0.05 * rng.normal(size=grid.shape))
    runs = [
        vv.Scene(bodies, vv.PairPotential(potential), vv.Gravity(0.01)).run(t=1.0, method="dop853", rtol=1e-12)
        for potential in (made, named)
    ]
    # Of the tolerance, over a span of a few collisions.
    assert np.abs(runs[0].position - runs[1].position).max() < 1e-9
    assert np.abs(runs[0].energy - runs[1].energy).max() < 1e-9 * np.abs(runs[1].energy).max()


def test_a_member_has_the_bits_it_has_alone() -> None:
    """Copies that share lanes, in units of their own, and others whose formula differs, on one thread and on three."""
    yukawa, rng, count = PAIRS["yukawa"][0], np.random.default_rng(1), 19
    pairs = [yukawa.rescaled(length=2.0 ** (i % 3), time=2.0) for i in range(count)]
    bowls = [Custom(k * r**2, parameters={k: 0.5 + i % 2}) for i in range(count)]
    bodies = vv.Particles(np.ones(3), rng.normal(size=(3, 3)), rng.normal(size=(3, 3)))
    scene = vv.Scene(bodies, vv.PairPotential(yukawa), vv.CentralField(bowls[0]))
    times = [0.0, 0.5, 1.0]
    alone = [
        vv.Scene(bodies, vv.PairPotential(pair), vv.CentralField(bowl)).run(t=times).position
        for pair, bowl in zip(pairs, bowls, strict=True)
    ]
    own = {"PairPotential": {"potential": pairs}, "CentralField": {"potential": bowls}}
    for threads in (1, 3):
        out = scene.ensemble(parameters=own).run(t=times, threads=threads)
        assert all(np.array_equal(one, other) for one, other in zip(alone, out.position, strict=True))


def test_in_the_middle_a_smooth_formula_pulls_nowhere() -> None:
    bowl = Custom(lambda r: 2.0 * r**2 + r**4)
    scene = vv.Scene(vv.Particles([1.0, 1.0], [[0, 0, 0], [0, 0, 0]], [[1, 0, 0], [0, 0, 0]]), vv.PairPotential(bowl))
    out = scene.run(t=1.0, rtol=1e-12)
    assert np.isfinite(out.position).all()
    assert np.array_equal(out.position[0, 0], [0, 0, 0])
    one = vv.Scene(vv.Particles([1.0], [[0, 0, 0]]), vv.CentralField(bowl))
    assert (one.acceleration() == 0.0).all()


def test_units() -> None:
    made, _named = PAIRS["lennard-jones"]
    places = np.geomspace(0.8, 5.0, 50)
    scaled = made.rescaled(length=3.0, mass=0.1, time=7.0)
    energy = 9.0 * 0.1 / 49.0
    assert scaled.value(3.0 * places) == pytest.approx(made.value(places) * energy, rel=2e-14, abs=0)
    powers = made.rescaled(length=2.0**100, mass=2.0**-300, time=2.0**10)
    assert np.array_equal(powers.value(places * 2.0**100), made.value(places) * 2.0 ** (200 - 300 - 20))
    assert np.array_equal(powers.force(places * 2.0**100), made.force(places) * 2.0 ** (100 - 300 - 20))


# In the scene's units, and in those of an atom's scale in SI.
SCALES = [(1.0, 1.0), (3e-10, 1.6e-21), (1e20, 1e30)]


@pytest.mark.parametrize(("size", "depth"), SCALES)
@pytest.mark.parametrize("energy", [1e-3, 0.1, 0.7, 0.9, 5.0, 1e3])
def test_deflections_are_those_of_the_named_potential(energy: float, size: float, depth: float) -> None:
    made = Custom(lambda r: 4.0 * depth * ((size / r) ** 12 - (size / r) ** 6))
    named = p.LennardJones(depth, size)
    b = size * np.concatenate([[0.0], np.geomspace(1e-3, 20.0, 60)])
    found, expected = (vv.scattering.deflect(each, energy=energy * depth, impact_parameter=b) for each in (made, named))
    assert (found.status == expected.status).all()
    assert (found.turning_points == expected.turning_points).all()
    # Of the roundings of the formula, some of the energy and of the place that b is.
    bound = np.minimum(1e-12, 1e-10 * np.abs(expected.angle)) + 20.0 * 1.1e-16 * expected.conditioning
    assert (np.abs(found.angle - expected.angle) <= bound).all()
    assert found.closest_approach == pytest.approx(expected.closest_approach, rel=1e-12, abs=0)


@pytest.mark.parametrize("n", [1, 2, 3, 6, 12, 24])
@pytest.mark.parametrize(("size", "depth"), SCALES[:2])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_power_of_the_distance_needs_no_length(n: int, size: float, depth: float, sign: float) -> None:
    strength = sign * depth * size**n
    named = p.PowerLaw(strength, n)
    for made in (
        Custom(lambda r, k: k / r**n, parameters={"k": strength}),
        Custom(k / r**n, parameters={k: strength}),
        Custom(lambda r, k: k * r**-n, parameters={"k": strength}),
    ):
        places = size * np.geomspace(0.05, 300.0, 60)
        for what in ("value", "force", "curvature"):
            assert getattr(made, what)(places) == pytest.approx(getattr(named, what)(places), rel=2e-14, abs=0), what
        b = size * np.array([0.0, 1e-3, 0.4, 1.1, 1.7, 5.0, 40.0])
        found, expected = (vv.scattering.deflect(each, energy=depth, impact_parameter=b) for each in (made, named))
        assert (found.status == expected.status).all()
        bound = np.minimum(1e-12, 1e-10 * np.abs(expected.angle)) + 20.0 * 1.1e-16 * expected.conditioning
        assert (np.abs(found.angle - expected.angle) <= bound)[expected.status == 0].all()


@pytest.mark.parametrize(("size", "depth"), SCALES)
def test_orbits_and_rainbows_are_those_of_the_named_potential(size: float, depth: float) -> None:
    made = Custom(4.0 * depth * ((size / r) ** 12 - (size / r) ** 6))
    named = p.LennardJones(depth, size)
    rainbows = [vv.scattering.rainbows(each, energy=2.0 * depth) for each in (made, named)]
    assert len(rainbows[0]) == len(rainbows[1]) > 0
    for mine, theirs in zip(*rainbows, strict=True):
        assert mine.impact_parameter == pytest.approx(theirs.impact_parameter, rel=2e-14, abs=0)
    orbiting = [vv.scattering.orbiting(each, energy=0.3 * depth) for each in (made, named)]
    for mine, theirs in zip(*orbiting, strict=True):
        assert mine.impact_parameter == pytest.approx(theirs.impact_parameter, rel=1e-14, abs=0)


def test_it_is_a_value_like_any_other(tmp_path: Path) -> None:
    made = PAIRS["morse"][0]

    def morse(b: float) -> Expressed:
        return Custom(lambda r, a, b: 2.0 * ((1.0 - np.exp(-a * (r - b))) ** 2 - 1.0), parameters={"a": 1.5, "b": b})

    assert made == morse(1.1)
    assert hash(made) == hash(morse(1.1))
    assert pickle.loads(pickle.dumps(made)) == made
    assert made != morse(1.2)
    scene = vv.Scene(vv.Particles([1.0, 1.0], [[0, 0, 0], [1.2, 0, 0]]), vv.PairPotential(made))
    out = scene.run(t=np.linspace(0.0, 5.0, 11), rtol=1e-11)
    out.save(tmp_path / "run.npz")
    assert vv.load(tmp_path / "run.npz").final.forces == scene.forces
    # A tolerance of 1e-11 a step; measured 1.3e-12.
    assert np.ptp(out.energy) < 1e-11


@pytest.mark.parametrize(
    ("make", "argument", "words"),
    [
        (lambda: Custom(k / r), "function", "free symbol 'k' has no value"),
        (lambda: Custom(sp.besselj(0, r)), "function", "not known"),
        (lambda: Custom(sp.Piecewise((r, r < 1), (0, True))), "function", "switches"),
        (lambda: Custom(lambda r: np.where(r < 1.0, r, 0.0)), "function", "r_min and r_max"),
        (lambda: Custom(lambda r: "text"), "function", "one number"),
        (lambda: Custom(lambda: 1.0), "function", r"called with \(r\)"),
        (lambda: Custom(lambda r: r, parameters={"k": 1.0}), "function", r"called with \(r, k=\)"),
        (lambda: Custom(3.5), "function", "got float"),
        (lambda: Custom(lambda r: r, parameters={"r": 1.0}), "parameters", "names that are not r"),
        (lambda: Custom(lambda r, k: r, parameters={"k": np.nan}), "parameters['k']", "finite"),
        (lambda: Custom(lambda r: r, parameters=[1.0]), "parameters", "values by parameter"),
        (lambda: Custom(lambda r: r, 1.0, 2.0, parameters={"k": 1.0}), "parameters", "none beside a range"),
        (lambda: Custom(lambda r: r, tolerance=1e-6), "tolerance", "none of a formula"),
        (lambda: Custom(1 / r, 1.0, 2.0), "r_min", "no range beside an expression"),
        (lambda: Custom(lambda r: r, r_min=1.0), "r_max", "end of the range"),
        (lambda: Custom(vv.systems.pendulum), "function", "called with"),
        (lambda: Custom(sp.Symbol("t") * r), "function", "free symbol 't'|one of the time"),
        (lambda: Expressed([3.0, 0.0], []), "nodes", "expected 1"),
        (lambda: Expressed([1.0, 0.0, 2.0, 0.0, 0.0], []), "nodes", "not there"),
        (lambda: Expressed([1.0, 0.0, 3.0, 0.0, 0.0], []), "nodes", "one of time"),
    ],
)
def test_what_is_no_formula_is_refused_by_name(make: Any, argument: str, words: str) -> None:
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        make()
    assert caught.value.argument == argument


def test_what_becomes_level_has_no_force_there() -> None:
    """Woods and Saxon's well in its two forms: of e^x in a denominator derivatives left the range far out."""
    well = Custom(-50 / (1 + sp.exp(2 * (r - 3))))
    same = Custom(lambda r: -25.0 * (1.0 - np.tanh(r - 3.0)))
    places = np.array([0.5, 2.0, 3.0, 5.0, 30.0, 100.0, 357.0, 400.0, 1e6])
    assert well.force(places) == pytest.approx(same.force(places), rel=1e-14, abs=1e-40)
    assert np.abs(well.curvature(places)[-2:]).max() < 1e-300
    ways = [vv.scattering.deflect(each, energy=30.0, impact_parameter=[1.0, 3.0, 5.0, 400.0]) for each in (well, same)]
    assert ways[0].angle == pytest.approx(ways[1].angle, abs=4e-14)
    assert ways[0].derivative == pytest.approx(ways[1].derivative, rel=1e-13, abs=1e-15)
    rainbows = [vv.scattering.rainbows(each, energy=30.0) for each in (well, same)]
    # The extremum of one function in two forms; measured 1.8e-15.
    assert rainbows[0][0].impact_parameter == pytest.approx(rainbows[1][0].impact_parameter, rel=1e-13, abs=0)
    far = vv.Scene(vv.Particles([1.0], [[500.0, 0, 0]], [[0, 1.0, 0]]), vv.CentralField(well)).run(10.0)
    assert far.position[-1, 0].tolist() == [500.0, 10.0, 0.0]


@pytest.mark.parametrize(
    ("made", "force"),
    [
        (lambda r: 1.0 / r - 50.0 / (1.0 + np.exp((r - 5.0) / 0.5)), lambda r: r**-2),
        (lambda r: 0.5 * r**2 - 1.0 / (1.0 + np.exp(r - 5.0)), lambda r: -r),
        (lambda r: 3.0 * r + 1.0 / np.cosh(r), lambda r: np.full(r.shape, -3.0)),
        (lambda r: 1.0 / r + 1.0 / np.sinh(r) ** 2, lambda r: r**-2),
    ],
)
def test_what_fades_leaves_the_rest(made: Any, force: Any) -> None:
    """Where a term has left the range, the others are still there: a force is nothing nowhere but where it is."""
    places = np.array([100.0, 355.0, 360.0, 400.0, 720.0, 1e3, 1e6])
    potential = Custom(made)
    assert potential.force(places) == pytest.approx(force(places), rel=1e-14, abs=0)
    assert np.isfinite(potential.curvature(places)).all()
    near = np.array([1.0, 4.5, 5.0, 6.0, 9.0])
    slope = (potential.value(near + 1e-5) - potential.value(near - 1e-5)) / 2e-5
    # Of a difference over 2e-5: h²/6 of the third derivative, some hundreds, and rounding.
    assert potential.force(near) == pytest.approx(-slope, rel=1e-7, abs=1e-7)


@pytest.mark.parametrize(
    ("made", "shown"),
    [
        (Custom(lambda r: -1.0 / r), "Expressed(-1/r)"),
        (Custom(lambda r: (r - 1.0) ** 2 - 3.0 * r), "Expressed((r - 1)**2 - 3*r)"),
        (Custom(k * sp.exp(-r) / r, parameters={k: 1.5}), "Expressed(k*exp(-r)/r, k=1.5)"),
        (Custom(lambda r: sum(r**n / n for n in range(1, 20))), "Expressed(78 nodes)"),
        (Custom(lambda r: r).rescaled(length=2.0), "Expressed(r, length=2.0, energy=4.0)"),
        (Expressed([1.0, 0.0, 2.0, 0.0, 0.0], [3.0]), "Expressed(values[0], values[0]=3.0)"),
    ],
)
def test_a_formula_prints_as_one(made: Expressed, shown: str) -> None:
    assert repr(made) == shown
    assert shown in repr(vv.CentralField(made))


WRITTEN: list[Any] = [
    lambda r: (r - 1) ** 2 / (2 * r + 1) - 3 * r,
    lambda r: -2.5 * r**-1.5 + 4,
    lambda r: r ** (-r),
    lambda r: (-r) ** 2,
    lambda r: -(r**2),
    lambda r: r - (1 - r),
    lambda r: 1 / (1 / r),
    lambda r: 2 / (r * 3),
    lambda r: (r + 1) * -2 * (r - 3) / -r,
    lambda r: 2 ** (r + 1),
    lambda r: (r**2) ** 3,
    lambda r: r**-1e-7,
    lambda r: np.arctan2(r, 1) - (r / 2) ** -2,
]


@pytest.mark.parametrize("function", WRITTEN)
def test_the_formula_that_is_printed_is_the_one_that_is_computed(function: Any) -> None:
    made = Custom(function)
    text = repr(made).removeprefix("Expressed(").removesuffix(")")
    found = eval(text, {"r": 1.3, "atan2": np.arctan2})
    assert found == pytest.approx(function(1.3), rel=1e-14, abs=0)
