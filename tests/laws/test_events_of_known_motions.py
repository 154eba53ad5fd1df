"""Events on motions that have closed forms: they are looked for on steps, which are as exact."""

import numpy as np
import pytest

import visviva as vv


@pytest.mark.parametrize(("turns", "bound"), [(16, 1e-10), (160, 1e-9), (1600, 1e-8)])
def test_pericenters_of_an_eccentric_orbit(turns: int, bound: float) -> None:
    """At the tolerance asked for the last pericenter of 1591 was 0.16 off; errors of phase grow with t² at worst."""
    scene = vv.problems.kepler(e=0.9).scene
    end = 2.0 * np.pi * (turns - 0.5)
    out = scene.run(t=end, events=[vv.events.apsis(1, 0, direction=1)])
    assert len(out.events) == turns - 1
    assert abs(out.events.t - 2.0 * np.pi * np.arange(1, turns)).max() < bound
    # Near the apocenter, where speeds are a tenth of the mean.
    assert np.abs(out.position[-1] - scene.run(t=end).position[-1]).max() < bound
    assert out.plan.method == "taylor"
    assert any(row[0] == "relative tolerance" for row in out.plan.rows)


def test_the_cost_is_that_of_the_steps() -> None:
    plan = vv.problems.kepler(e=0.9).scene.plan(t=1e3, events=[vv.events.apsis(1, 0)])
    cost = plan.cost()
    assert cost is not None
    assert cost.steps > 1000


def test_copies_of_which_some_are_known_have_the_bits_of_one() -> None:
    """Three bodies of which two have mass, and all: each copy is integrated as it is alone."""
    place, velocity = [[0.0, 0, 0], [1.0, 0, 0], [5.0, 0, 0]], [[0.0, 0, 0], [0, 1.0, 0], [0, 0.4, 0]]
    masses = np.array([[1.0, 0.0, 0.0], [1.0, 1e-3, 1e-2], [1.0, 1e-3, 0.0], [1.0, 0.0, 0.0]])
    events = [vv.events.apsis(1, 0, direction=1)]
    scene = vv.Scene(vv.Particles(masses[0], place, velocity), vv.Gravity(1.0))
    every = scene.ensemble(mass=masses).run(t=[10.0, 20.0], events=events)
    for copy, mass in enumerate(masses):
        alone = vv.Scene(vv.Particles(mass, place, velocity), vv.Gravity(1.0)).run(t=[10.0, 20.0], events=events)
        assert (every.position[copy] == alone.position).all()


@pytest.mark.parametrize("given", [None, "1", [1.0, 2.0], 1j])
def test_an_event_that_gives_no_number_is_refused_by_name(given: object) -> None:
    with pytest.raises(vv.InvalidInput, match="that give a number") as caught:
        vv.problems.kepler(e=0.5).scene.run(t=1.0, events=[lambda t, x, v: given])
    assert caught.value.argument == "events"


#: What is one about a place: forces there, and how many roundings of a place its errors come to after five turns.
CENTERED = {
    "harmonic": (lambda c: [vv.Harmonic(k=1.0, center=c)], 4.0),
    "harmonic in a field": (lambda c: [vv.Harmonic(k=1.0, center=c), vv.UniformField((0, -9.8, 0))], 8.0),
    "harmonic, damped": (lambda c: [vv.Harmonic(k=1.0, center=c), vv.LinearDrag(tau=50.0)], 4.0),
    "harmonic, driven": (lambda c: [vv.Harmonic(k=1.0, center=c), vv.DrivenForce((1, 0, 0), 0.7)], 4.0),
    "Kepler": (lambda c: [vv.CentralField(vv.potentials.Coulomb(k=-1.0), center=c)], 40.0),
    "rotating": (lambda c: [vv.RotatingFrame((0, 0, 0.3), center=c)], 8.0),
}


@pytest.mark.parametrize("far", [1e2, 1e5, 1e8])
@pytest.mark.parametrize("name", CENTERED)
def test_a_center_far_from_the_origin(name: str, far: float) -> None:
    """A tolerance below the rounding of places halved steps until they were of nothing: millions, for some hundred."""
    forces, roundings = CENTERED[name]
    center = (far, 0.0, 0.0)
    body = vv.Particles([1.0], [[far + 1.0, 0.0, 0.0]], [[0.0, 1.1, 0.0]])
    scene = vv.Scene(body, forces(center))
    crossing = vv.events.plane((far, 0.1, 0.0), (0.0, 1.0, 0.0))
    out, known = scene.run(t=20.0, events=[crossing]), scene.run(t=20.0)
    assert out.stats.steps < 2000
    bound = roundings * np.spacing(far)
    np.testing.assert_allclose(out.position, known.position, rtol=0, atol=bound)
    np.testing.assert_allclose(out.velocity, known.velocity, rtol=0, atol=bound)


def test_a_body_that_starts_in_a_center_far_away() -> None:
    """It has no distance to be measured against: its velocity keeps the digits that rounding of places leaves it."""
    center = (1e8, 0.0, 0.0)
    scene = vv.Scene(vv.Particles([1.0], [center], [[0.0, 1.0, 0.0]]), vv.Harmonic(k=1.0, center=center))
    out = scene.run(t=20.0, events=[vv.events.plane(center, (0.0, 1.0, 0.0))])
    assert out.velocity[-1, 0, 1] == pytest.approx(np.cos(20.0), abs=4 * np.spacing(1e8))


@pytest.mark.parametrize("radius", [6.4e6, 1.5e11])
def test_a_weak_force_of_a_far_center_loosens_nothing(radius: float) -> None:
    """A trap in a laboratory that turns with the Earth: its rounding is no measure of what the trap does."""
    stiff, turning = 1e6, 7.3e-5
    trap = [vv.Harmonic(k=stiff), vv.RotatingFrame((0, turning, 0), center=(0, 0, -radius))]
    scene = vv.Scene(vv.Particles([1.0], [[1e-6, 0, 0]], [[0, 1e-3, 0]]), trap)
    known = scene.run(t=0.02).position[-1, 0]
    for options in ({"rtol": 1e-12}, {"rtol": 1e-12, "atol": 1e-20}):
        out = scene.run(t=0.02, method="dop853", **options)
        # Both to less than a billionth of the swing, which was off by a thousandth and more.
        np.testing.assert_allclose(out.position[-1, 0], known, rtol=0, atol=1e-9 * np.abs(known).max())


def test_what_moves_across_the_way_to_a_far_center_keeps_its_digits() -> None:
    center = (1e8, 0.0, 0.0)
    scene = vv.Scene(vv.Particles([1.0], [[1e8, 1, 0]], [[0, 0, 1.0]]), vv.Harmonic(k=1.0, center=center))
    out = scene.run(t=20.0, method="dop853", rtol=1e-12)
    np.testing.assert_allclose(out.position[-1, 0, 1:], [np.cos(20.0), np.sin(20.0)], rtol=0, atol=1e-11)


@pytest.mark.parametrize("far", [1e2, 1e5, 1e8])
def test_a_far_body_loosens_nothing_about_a_center_at_the_origin(far: float) -> None:
    """Only a center that is far from the origin costs digits: not bodies that are far from one that is not."""
    bodies = vv.Particles([1e-20, 1e-20], [[1.0, 0, 0], [far, 0, 0]], [[0, 1.0, 0], [0, far**-0.5, 0]])
    scene = vv.Scene(bodies, [vv.CentralField(vv.potentials.PowerLaw(k=-1e-20, n=1)), vv.Gravity(1.0)])
    out = scene.run(t=20.0, method="dop853", rtol=1e-13)
    # What dop853 comes to at that tolerance in three turns.
    np.testing.assert_allclose(out.position[-1, 0], [np.cos(20.0), np.sin(20.0), 0.0], rtol=0, atol=3e-11)


@pytest.mark.parametrize("name", ["harmonic", "Kepler", "rotating"])
def test_copies_about_a_far_center_have_the_bits_of_one(name: str) -> None:
    """Each copy has the tolerance of its own bodies: own masses, events, one thread and three."""
    forces, random = CENTERED[name][0]((1e6, 0.0, 0.0)), np.random.default_rng(0)
    place = np.array([[1e6 + 1.0, 0, 0], [1e6, 2.0, 0]]) + 1e-2 * random.normal(size=(11, 2, 3))
    velocity, mass = np.array([[0, 1.1, 0], [0.7, 0, 0.1]]), random.uniform(1.0, 3.0, (11, 2))
    passes = [vv.events.plane((1e6, 0.1, 0.0), (0.0, 1.0, 0.0), body=0)]
    copies = vv.Scene(vv.Particles(mass[0], place[0], velocity), forces).ensemble(position=place, mass=mass)
    one, three = (copies.run(t=[0.0, 5.0, 20.0], events=passes, threads=threads) for threads in (1, 3))
    assert len(one.events) >= 11
    for made in ("t", "position", "member"):
        np.testing.assert_array_equal(getattr(one.events, made), getattr(three.events, made))
    np.testing.assert_array_equal(one.position, three.position)
    for copy in range(11):
        alone = vv.Scene(vv.Particles(mass[copy], place[copy], velocity), forces).run([0.0, 5.0, 20.0], events=passes)
        np.testing.assert_array_equal(one.position[copy], alone.position)
        np.testing.assert_array_equal(one.events.t[one.events.member == copy], alone.events.t)
