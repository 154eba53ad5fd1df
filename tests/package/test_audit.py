"""Work, curl and the third law: what holds for every field, and a field that breaks each.

Bounds: quadratures of what is smooth, to some ten roundings of their terms; a curl is of differences whose step of
1e-4 is lost twice to rounding, 1e-12; the cubic between two times is of order 4, whose error at the finer of both is
5e-10.
"""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

import visviva as vv

Points = NDArray[np.float64]
FIELDS = [
    vv.Harmonic(k=2.0, center=(0.1, 0.2, 0.3)),
    vv.UniformField((1.0, -2.0, 3.0)),
    vv.CentralField(vv.potentials.Yukawa(k=-1.5, length=2.0), center=(4.0, 4.0, 4.0)),
    vv.CentralField(vv.potentials.LennardJones(epsilon=1.0, sigma=1.0), center=(4.0, 4.0, 4.0)),
]


def around(radius: float) -> Callable[[Points], Points]:
    """A closed path that is not plane."""
    return lambda s: (
        radius * np.stack([np.cos(2 * np.pi * s), np.sin(2 * np.pi * s), 0.3 * np.sin(4 * np.pi * s)], axis=-1)
    )


def turning(r: Points) -> Points:
    return np.stack([-r[:, 1], r[:, 0], 0 * r[:, 2]], axis=-1)


@pytest.mark.parametrize("force", FIELDS)
def test_no_work_around_a_closed_path(force: vv.forces.Force) -> None:
    path = around(1.5)
    there = vv.audit.work(force, path)
    size = vv.audit.work(lambda r: np.abs(vv.audit.field(force)(r)), lambda s: s[:, None] * np.ones(3), rtol=1e-3)
    assert abs(there) < 1e-13 * size
    assert vv.audit.curl(force, path(np.linspace(0, 1, 7))).conservative


@given(radius=st.floats(1e-3, 1e3))
def test_a_field_that_turns(radius: float) -> None:
    """Stokes: curl 2 over the area π R²."""
    assert vv.audit.work(turning, around(radius)) == pytest.approx(2 * np.pi * radius**2, rel=4e-14, abs=0)
    found = vv.audit.curl(turning, around(radius)(np.array([0.1, 0.6])))
    assert not found.conservative
    # Differences of places up to 1e3, whose rounding is divided by the step; 2e-10 was seen.
    np.testing.assert_allclose(found.value, [[0, 0, 2.0]] * 2, rtol=0, atol=1e-9)


@pytest.mark.parametrize("force", FIELDS)
def test_work_is_the_loss_of_potential_energy_on_every_path(force: vv.forces.Force) -> None:
    """Equation 3.17 of the source: W = V1 - V2."""
    ends = np.array([[1.0, 0, 0], [-0.5, 2.0, 1.25]])
    energies = [vv.Scene(vv.Particles([1.0], [end]), force).invariants().potential_energy for end in ends]
    for corners in (ends, [ends[0], [0.3, -1.0, 2.0], ends[1]]):
        assert vv.audit.work(force, corners) == pytest.approx(energies[0] - energies[1], rel=5e-14, abs=0)


def test_the_golden_case() -> None:
    """G3.17: V = (k/2)(x² + y²) + c x y z."""
    k, c = 2.0, 0.75

    def force(r: Points) -> Points:
        x, y, z = r.T
        return -np.stack([k * x + c * y * z, k * y + c * x * z, c * x * y], axis=-1)

    assert vv.audit.work(force, [[1.0, 0, 0], [-0.5, 2.0, 1.25]]) == pytest.approx(-2.3125, rel=1e-14, abs=0)


def test_work_along_a_run_is_the_growth_of_kinetic_energy() -> None:
    """With drag, that has no potential, and with a magnetic field, that does no work."""
    field, drag, magnetic = vv.UniformField((0, 0, -9.0)), vv.LinearDrag(tau=0.7), vv.UniformMagneticField((0, 2.0, 0))
    start = vv.Particles([2.0, 3.0], [[0, 0, 0], [1.0, 0, 0]], [[1.0, 2.0, 5.0], [0, 1.0, 0]])
    errors = []
    for times in (101, 201):
        out = vv.Scene(start, field, drag, magnetic).run(t=np.linspace(0.0, 2.0, times), method="dop853", rtol=1e-13)
        works = [vv.audit.work_along(out, force) for force in (field, drag, magnetic)]
        kinetic = 0.5 * start.mass * (out.velocity**2).sum(axis=-1)
        assert np.abs(works[2]).max() < 1e-14 * kinetic.max()
        assert (np.diff(works[1], axis=0) < 0.0).all()
        errors.append(np.abs(sum(works) - (kinetic - kinetic[0])).max() / kinetic.max())
    assert errors[1] < 1e-8
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.1)  # fourth order


def test_third_law_of_gravity_and_of_what_breaks_it() -> None:
    rng = np.random.default_rng(1)
    x, m = rng.normal(size=(5, 3)), rng.uniform(1, 2, 5)
    apart = x[None] - x[:, None]
    cubes = np.linalg.norm(apart, axis=-1, keepdims=True) ** 3 + np.eye(5)[:, :, None]
    forces = m[:, None, None] * m[None, :, None] * apart / cubes
    found = vv.audit.third_law(x, forces)
    assert found.weak
    assert found.strong
    np.testing.assert_allclose(found.force, 0.0, rtol=0, atol=1e-14)
    np.testing.assert_allclose(found.torque, 0.0, rtol=0, atol=1e-14)
    # The sum over the others is what a scene of them feels.
    accelerations = vv.Scene(vv.Particles(m, x), vv.Gravity(1.0)).acceleration()
    np.testing.assert_allclose(forces.sum(axis=1), m[:, None] * accelerations, rtol=1e-12)
    forces[0, 1] *= 1.0 + 1e-9
    assert not vv.audit.third_law(x, forces).weak


@pytest.mark.parametrize(
    "force",
    [
        vv.UniformElectricField([1.0, 0, 0], [1.0, 2.0]),
        vv.QuadraticDrag([1.0, 2.0]),
        vv.Drag(1.0, 1.0, [0.1, 0.2]),
        vv.UniformMagneticField([0, 0, 1.0], [1.0, 2.0]),
    ],
)
def test_work_of_forces_that_each_body_feels_in_its_own_way(force: vv.forces.Force) -> None:
    bodies = vv.Particles([1.0, 2.0], [[0, 0, 0], [1.0, 0, 0]], [[1.0, 0, 0], [0, 1.0, 0]])
    out = vv.Scene(bodies, force).run(np.linspace(0, 1, 100), rtol=1e-13)
    kinetic = 0.5 * bodies.mass * (out.velocity**2).sum(axis=2)
    # The fourth power of a hundredth, and 6π times the rates of Stokes.
    np.testing.assert_allclose(vv.audit.work_along(out, force), kinetic - kinetic[0], rtol=0, atol=1e-6)


@pytest.mark.parametrize(
    "force",
    [
        vv.PairPotential(vv.potentials.Yukawa(k=1.0, length=1e-3)),
        vv.PairPotential(vv.potentials.SoftSphere(k=1.0, radius=0.5, n=2)),
        vv.Spring(0, 1, k=1.0),
        vv.Damper("a", "b", c=1.0),
        vv.Coulomb([0.0, 0.0], k=1.0),
    ],
    ids=lambda force: type(force).__name__,
)
def test_what_acts_between_bodies_is_refused_however_short_it_reaches(force: vv.forces.Force) -> None:
    out = vv.Scene(vv.Particles([1, 1.0], [[0, 0, 0], [1.0, 0, 0]])).run(np.linspace(0, 1, 5))
    for asked in (
        lambda: vv.audit.field(force),
        lambda: vv.audit.curl(force, [[1.0, 0, 0]]),
        lambda: vv.audit.work_along(out, force),
    ):
        with pytest.raises(vv.InvalidInput, match="acts between bodies"):
            asked()


@pytest.mark.parametrize(
    ("force", "looks"),
    [
        (vv.LinearDrag(1.0), "velocities"),
        (vv.QuadraticDrag(1.0), "velocities"),
        (vv.Drag(1.0, 0.1, 0.1), "velocities"),
        (vv.UniformMagneticField([0.0, 0.0, 1.0]), "velocities"),
        (vv.RotatingFrame([0.0, 0.0, 1.0]), "velocities"),
        (vv.ExpressionForce(force=lambda r, v, t: (-v[0], -r[1], -r[2])), "velocities"),
        (vv.DrivenForce([1.0, 0.0, 0.0], 2.0), "the time"),
        (vv.ExpressionForce(potential=lambda r, v, t: np.cos(t) * r[0] ** 2), "the time"),
    ],
    ids=lambda value: type(value).__name__,
)
def test_what_depends_on_the_motion_is_not_called_conservative(force: vv.forces.Force, looks: str) -> None:
    """Of a body at rest a drag does nothing, and nothing has no curl."""
    for asked in (
        lambda: vv.audit.curl(force, [[1.0, 2.0, 3.0]]),
        lambda: vv.audit.work(force, [[0.0, 0, 0], [1.0, 0, 0]]),
    ):
        with pytest.raises(vv.InvalidInput, match=rf"^force: .*looks at {looks}.*work_along"):
            asked()
    # As a field at rest and at one time, which is then what was asked for.
    at_rest = vv.audit.field(force, t0=0.5)
    assert vv.audit.curl(at_rest, [[1.0, 2.0, 3.0]]).value.shape == (1, 3)


@pytest.mark.parametrize("width", [1e-2, 2e-3, 1e-3])
def test_what_is_felt_for_a_short_part_of_a_path_does_work(width: float) -> None:
    for middle in np.linspace(0.1, 0.9, 9) + 0.0333:

        def bump(r: Points, middle: float = middle) -> Points:
            return np.outer(np.exp(-(((r[:, 0] - middle) / width) ** 2)), [1.0, 2.0, 0.0])

        work = vv.audit.work(bump, [[0.0, 0, 0], [1.0, 0, 0]], rtol=1e-10)
        assert work == pytest.approx(np.sqrt(np.pi) * width, rel=1e-8, abs=0.0)


def test_no_work_is_done_in_no_time() -> None:
    scene = vv.Scene(vv.Particles([1.0, 2.0], [[1.0, 0, 0], [0, 1.0, 0]], [[0, 1.0, 0]] * 2), vv.Harmonic(1.0))
    assert vv.audit.work_along(scene.run(t=[0.0]), scene.forces[0]).tolist() == [[0.0, 0.0]]
    assert vv.audit.work_along(scene.run(t=[0.0, 0.0]), scene.forces[0]).tolist() == [[0.0, 0.0]] * 2


def test_refusals() -> None:
    with pytest.raises(vv.InvalidInput, match="acts between bodies"):
        vv.audit.field(vv.Gravity(1.0))
    with pytest.raises(vv.InvalidInput, match="two corners"):
        vv.audit.work(FIELDS[0], [[0.0, 0, 0]])
    with pytest.raises(vv.InvalidInput, match="on itself"):
        vv.audit.third_law(np.zeros((1, 3)), np.ones((1, 1, 3)))
    with pytest.raises(vv.InvalidInput, match="one place at least"):
        vv.audit.curl(turning, np.zeros((0, 3)))
    with pytest.raises(vv.ConvergenceError, match="jumps or is singular"):
        vv.audit.work(lambda r: np.sign(r - 0.123456789), [[0.0, 0, 0], [1.0, 0.7, 0.3]])


def test_curl_at_places_of_all_sizes_together() -> None:
    """One step for all places called a central field rotational near its center."""
    field = vv.CentralField(vv.potentials.Coulomb(-1.0))
    places = np.array([[0.01, 0.02, 0.005], [1.0, 1.0, 1.0], [1e5, 3e5, 0.0], [0.0, 0.0, 1e-6]])
    assert vv.audit.curl(field, places).conservative


def test_curl_near_a_center_that_is_far_from_the_origin() -> None:
    """A step of the size of the place goes across the center: the field seemed to turn."""
    field = vv.CentralField(vv.potentials.Coulomb(k=-1.0), center=[1000.0, 0, 0])
    places = [[1000.5, 0.1, 0.2], [1001.5, 2.0, -7.0], [0.0, 0.0, 0.0]]
    assert vv.audit.curl(field, places).conservative
    assert not vv.audit.curl(lambda r: vv.audit.field(field)(r) + 1e-3 * turning(r), places).conservative


UNIFORM = np.array([0.1, 0.0, -9.81])


@pytest.mark.parametrize(
    "field",
    [
        vv.UniformField([0.0, 0.0, -9.81]),
        vv.UniformElectricField([0.1, 0.2, 0.3]),
        vv.ExpressionForce(potential=lambda r, v, t: 9.81 * r[2]),
        vv.Harmonic(3.0, center=[3e5, 0.0, 0.0]),
    ],
    ids=lambda force: type(force).__name__,
)
def test_a_field_that_hardly_changes_has_no_curl(field: vv.forces.Force) -> None:
    """Differences of equal values are their rounding, in all derivatives alike."""
    found = vv.audit.curl(field, [[0.1, 0.2, 0.3], [1.3, -0.7, 0.4]])
    assert found.conservative, found.relative


@pytest.mark.parametrize("turning", [1e-3, 1e-6, 1e-9])
def test_a_weak_curl_beside_a_uniform_field_is_seen(turning: float) -> None:
    places = [[0.1, 0.2, 0.3], [1.3, -0.7, 0.4]]
    straight = vv.audit.curl(lambda r: UNIFORM + turning * r, places)
    around = vv.audit.curl(lambda r: UNIFORM + turning * np.stack([-r[:, 1], r[:, 0], 0.0 * r[:, 2]], axis=-1), places)
    assert straight.conservative
    assert not around.conservative
    # Differences of 9.81 over some 1e-3 of the places: 1e-12.
    np.testing.assert_allclose(around.value[:, 2], 2.0 * turning, rtol=0.0, atol=1e-11)


def test_third_law_far_from_the_origin() -> None:
    """Places at 1e11 are rounded to 1e-5: that is no torque."""
    place = np.array([[1.5e11, 0.3, 0.0], [1.5e11 + 3.0, 1.7, -0.1]])
    along = np.array([-3.00001, -1.4, 0.1])
    forces = np.zeros((2, 2, 3))
    forces[0, 1], forces[1, 0] = along, -along
    assert vv.audit.third_law(place, forces).strong
    assert not vv.audit.third_law(place - [1.5e11, 0.0, 0.0], forces).strong


@pytest.mark.parametrize("bend", [1e-10, 1.0, 1e12])
def test_the_curl_at_the_origin(bend: float) -> None:
    """Where places have no size, over which length a field bends only it knows."""

    def turning(r: np.ndarray) -> np.ndarray:
        return np.stack([np.cos(r[:, 1] / bend - 1), np.cos(r[:, 0] / bend + 2), 0 * r[:, 2] - 9.81], axis=-1)

    found = vv.audit.curl(turning, [[0.0, 0.0, 0.0]])
    # −sin 2 − sin 1 over the length: differences of fourth order tell seven digits and more of it, beside 9.81.
    np.testing.assert_allclose(found.value * bend, [[0.0, 0.0, -np.sin(2.0) - np.sin(1.0)]], rtol=1e-7, atol=1e-7)
    assert not found.conservative
    still = vv.audit.curl(vv.UniformField((0, 0, -9.8)), [[0.0, 0.0, 0.0]])
    assert still.conservative
    assert np.abs(still.value).max() < 1e-12
    assert vv.audit.curl(vv.Harmonic(k=3.0), [[0.0, 0.0, 0.0]]).conservative


def test_work_along_paths_that_stand_still() -> None:
    pull = vv.Harmonic(k=1.0)
    assert vv.audit.work(pull, [[1.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0]]) == pytest.approx(-1.5, rel=1e-14, abs=0.0)
    assert vv.audit.work(pull, [[1.0, 0, 0], [1.0, 0, 0]]) == 0.0
    assert vv.audit.work(pull, lambda s: np.ones((len(s), 3))) == 0.0


@pytest.mark.parametrize("length", [1e-10, 1.0, 1e9])
@pytest.mark.parametrize("spread", [0.0, 3.0])
def test_the_curl_at_the_origin_of_what_dies_away(length: float, spread: float) -> None:
    """(−y, x, 0) exp(−r²): far off it is 0, or what is linear beside it, which any step would do for."""

    def dying(r: np.ndarray) -> np.ndarray:
        x = r / length
        turning = np.stack([-x[:, 1], x[:, 0], 0 * x[:, 2]], axis=-1) * np.exp(-(x * x).sum(axis=1))[:, None]
        return turning + spread * x

    found = vv.audit.curl(dying, [[0.0, 0.0, 0.0]])
    np.testing.assert_allclose(found.value * length, [[0.0, 0.0, 2.0]], rtol=1e-7, atol=1e-7)
    assert not found.conservative
