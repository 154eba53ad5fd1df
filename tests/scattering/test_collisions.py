"""Collisions in space: conservation, frames, the line of centers, and soft spheres that do the same.

Bounds: products and sums of velocities of size 1 to a few hundred roundings of them, as masses differ by any factor;
what is left of a speed after a release of nearly all of it, 1e-11.
"""

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.typing import NDArray

import visviva as vv

c = vv.collisions
masses = st.floats(-8.0, 8.0).map(lambda power: 10.0**power)
seeds = st.integers(0, 2**32 - 1)


def draw(seed: int, *shape: int) -> tuple[NDArray[np.float64], ...]:
    """Velocities of both and a normal, for bodies that meet with a part of their speed along it."""
    rng = np.random.default_rng(seed)
    v1, v2, n = rng.normal(size=(3, *shape, 3))
    return v1, v2, n


def along(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.einsum("...i,...i", a, b)


def kinetic(m1: Any, m2: Any, v1: NDArray[np.float64], v2: NDArray[np.float64]) -> NDArray[np.float64]:
    return 0.5 * m1 * along(v1, v1) + 0.5 * m2 * along(v2, v2)


def check(m1: float, m2: float, v1: Any, v2: Any, after: vv.collisions.CollisionOutcome, loss: Any) -> None:
    """Momentum, angular momentum about the point of contact and energy, to round-off of what is added."""
    size = np.abs(v1).max() + np.abs(v2).max() + np.abs(after.velocity1).max() + np.abs(after.velocity2).max()
    momentum = m1 * (after.velocity1 - v1) + m2 * (after.velocity2 - v2)
    assert np.abs(momentum).max() < 1e-15 * size * (m1 + m2)
    assert np.abs(m1 * (after.velocity1 - v1) - after.impulse).max() < 1e-15 * size * (m1 + 4 * min(m1, m2))
    assert np.abs(m2 * (after.velocity2 - v2) + after.impulse).max() < 1e-15 * size * (m2 + 4 * min(m1, m2))
    difference = kinetic(m1, m2, np.asarray(v1), np.asarray(v2)) - kinetic(m1, m2, after.velocity1, after.velocity2)
    assert np.abs(difference - after.energy_loss).max() < 4e-15 * size**2 * (m1 + m2)
    reduced = c.reduced_mass(m1, m2)
    assert np.asarray(after.energy_loss) == pytest.approx(loss, rel=1e-14, abs=4e-15 * size**2 * reduced)


@given(masses, masses, seeds, st.floats(0.0, 1.0))
def test_smooth_spheres(m1: float, m2: float, seed: int, coefficient: float) -> None:
    v1, v2, n = draw(seed, 7)
    after = c.restitution(m1, m2, v1, v2, coefficient=coefficient, normal=n)
    n = n / np.linalg.norm(n, axis=-1, keepdims=True)
    met, parted = along(v1 - v2, n), along(after.velocity1 - after.velocity2, n)
    check(m1, m2, v1, v2, after, 0.5 * c.reduced_mass(m1, m2) * (1.0 - coefficient**2) * met**2)
    size = 1e-14 * (1.0 + np.abs(v1).max() + np.abs(v2).max())
    assert parted == pytest.approx(-coefficient * met, abs=size)
    # Across the line of centers nothing happens to either.
    for before, now in ((v1, after.velocity1), (v2, after.velocity2)):
        across = (now - before) - along(now - before, n)[:, None] * n
        assert np.abs(across).max() < size
    assert c.impulse(m1, m2, v1, v2, normal=n * -3.0, coefficient=coefficient) == pytest.approx(
        after.impulse, rel=1e-13, abs=size * min(m1, m2)
    )


@given(masses, masses, seeds, st.floats(-0.999, 100.0), st.booleans())
def test_a_q_value_is_what_is_released(m1: float, m2: float, seed: int, released: float, central: bool) -> None:
    v1, v2, n = draw(seed)
    unit = n / np.linalg.norm(n)
    met = abs(along(v1 - v2, unit)) if central else np.linalg.norm(v1 - v2)
    assume(met > 1e-3)
    q = 0.5 * c.reduced_mass(m1, m2) * met**2 * released
    after = c.inelastic(m1, m2, v1, v2, q_value=q, **{"normal" if central else "direction": n})
    check(m1, m2, v1, v2, after, -q)
    parted = after.velocity1 - after.velocity2
    if central:
        assert along(parted, unit) * np.sign(along(v1 - v2, unit)) == pytest.approx(
            -met * np.sqrt(1.0 + released), rel=1e-11, abs=0
        )
    else:
        assert parted == pytest.approx(met * np.sqrt(1.0 + released) * unit, rel=1e-11, abs=1e-13 * (1.0 + met))


@given(masses, masses, seeds)
def test_every_frame_sees_the_same(m1: float, m2: float, seed: int) -> None:
    v1, v2, n = draw(seed)
    frame = np.random.default_rng(seed + 1).normal(size=3)
    turn = np.linalg.qr(np.random.default_rng(seed + 2).normal(size=(3, 3)))[0]
    here = c.restitution(m1, m2, v1, v2, coefficient=0.7, normal=n)
    there = c.restitution(m1, m2, turn @ (v1 - frame), turn @ (v2 - frame), coefficient=0.7, normal=turn @ n)
    for mine, theirs in ((here.velocity1, there.velocity1), (here.velocity2, there.velocity2)):
        assert turn @ (mine - frame) == pytest.approx(theirs, abs=1e-13)
    swapped = c.restitution(m2, m1, v2, v1, coefficient=0.7, normal=-n)
    assert swapped.velocity1 == pytest.approx(here.velocity2, abs=1e-13)
    assert swapped.impulse == pytest.approx(-here.impulse, rel=1e-12, abs=1e-13 * min(m1, m2))


@given(masses, masses, seeds)
def test_elastic_collisions_agree_with_the_angles_of_scattering(m1: float, m2: float, seed: int) -> None:
    """A projectile along x on a target at rest, by the direction of parting: angles and energies of `vv.scattering`."""
    psi = np.random.default_rng(seed).uniform(0.01, 3.13)
    after = c.elastic(m1, m2, [2.0, 0.0, 0.0], [0.0, 0.0, 0.0], direction=[np.cos(psi), np.sin(psi), 0.0])
    taken = 0.5 * m2 * along(after.velocity2, after.velocity2)
    share = vv.scattering.energy_transfer(psi, mass_ratio=m1 / m2)
    # A recoil next to a far lighter projectile is the difference of two velocities of order one.
    assert taken == pytest.approx(2.0 * m1 * share, rel=1e-11, abs=0)
    recoil = np.arctan2(-after.velocity2[1], after.velocity2[0])
    assert recoil == pytest.approx(vv.scattering.recoil_angle(psi), abs=1e-11)
    if 1e-3 < m1 / m2 < 1e3 and abs(m1 / m2 - 1.0) > 1e-3:
        lab = np.arctan2(after.velocity1[1], after.velocity1[0])
        assert lab == pytest.approx(vv.scattering.lab_angle(psi, mass_ratio=m1 / m2), abs=1e-11)
    # The line of centers halves the angle between before and after.
    normal = [-np.sin(psi / 2.0), np.cos(psi / 2.0), 0.0]
    again = c.elastic(m1, m2, [2.0, 0.0, 0.0], [0.0, 0.0, 0.0], normal=normal)
    assert again.velocity2 == pytest.approx(after.velocity2, abs=1e-14)


def test_head_on_and_its_limits() -> None:
    x, rest = np.array([1.0, 0.0, 0.0]), np.zeros(3)
    equal = c.elastic(3.0, 3.0, 2.0 * x, rest, normal=x)
    assert equal.velocity1.tolist() == [0.0, 0.0, 0.0]
    assert equal.velocity2.tolist() == [2.0, 0.0, 0.0]
    wall = c.elastic(1.0, 1e300, 2.0 * x, rest, normal=x)
    assert wall.velocity1.tolist() == [-2.0, 0.0, 0.0]
    # Bounces on the floor: heights in the ratio ε².
    floor = c.restitution(1.0, 1e300, [0.0, 0.0, -3.0], rest, coefficient=0.5, normal=[0.0, 0.0, 1.0])
    assert floor.velocity1[2] == 1.5
    assert c.elastic(1.0, 2.0, x, x, normal=x).impulse.tolist() == [0.0, 0.0, 0.0]
    # Sticking: ε = 0 head-on, and all of the energy of relative motion taken up.
    stuck = c.restitution(1.0, 2.0, 3.0 * x, rest, coefficient=0.0, normal=x)
    assert (stuck.velocity1 == stuck.velocity2).all()
    other = c.inelastic(1.0, 2.0, 3.0 * x, rest, q_value=-3.0, direction=[0.0, 0.0, 1.0])
    assert (other.velocity1 == stuck.velocity1).all()
    assert other.energy_loss == stuck.energy_loss == 3.0


@given(masses, masses, seeds, st.floats(0.0, 0.999), st.floats(1e-3, 1e3))
def test_spheres_that_fly_to_their_contact(m1: float, m2: float, seed: int, miss: float, distance: float) -> None:
    """The time of contact, the place there, the line of centers from the impact vector: one and the same."""
    v1, v2, b = draw(seed)
    relative = v1 - v2
    across = np.cross(relative, b)
    assume(np.linalg.norm(across) > 0.1 and np.linalg.norm(relative) > 0.1)
    across *= miss * distance / np.linalg.norm(across)
    start = across - 3.0 * distance * relative / np.linalg.norm(relative)
    r2 = distance * b
    time = c.contact_time(start + r2, r2, v1, v2, distance=distance)
    apart = (start + r2 + time * v1) - (r2 + time * v2)
    assert np.linalg.norm(apart) == pytest.approx(distance, rel=1e-13, abs=0)
    assert along(apart, relative) < 0.0
    normal = c.line_of_centers(v1, v2, impact=start, distance=distance)
    # Next to a miss the place along the path is known to the root of a rounding.
    assert normal == pytest.approx(apart / distance, abs=1e-13 / np.sqrt(1.0 - miss))
    assert c.contact_time(start + r2, r2, v2, v1, distance=distance) == np.inf
    # The scene's own bounce.
    particles = vv.Particles([m1, m2], [start + r2, r2], [v1, v2], radius=[0.25 * distance, 0.75 * distance])
    out = vv.Scene(particles, vv.UniformField([0.0, 0.0, 0.0])).run(2.0 * time, collisions="bounce", restitution=0.8)
    after = c.restitution(m1, m2, v1, v2, coefficient=0.8, normal=apart)
    slack = 1e-9 / (1.0 - miss)
    assert out.velocity[-1] == pytest.approx(np.array([after.velocity1, after.velocity2]), abs=slack)


def test_a_soft_sphere_gives_the_same_impulse() -> None:
    """A stiff spring between the surfaces, along the line of centers that hardly turns while they touch: the integral
    of the force is the impulse, and the Q-value is nothing. The duration of the contact is the error."""
    v1, v2, r1 = np.array([1.0, 0.3, -0.2]), np.array([-0.5, 0.0, 0.1]), np.array([-1.3, 0.2, 0.1])
    m1, m2, distance = 1.0, 2.5, 1.0
    time = c.contact_time(r1, np.zeros(3), v1, v2, distance=distance)
    normal = (r1 + time * v1) - time * v2
    errors = []
    for stiff in (60, 240):
        soft = vv.PairPotential(vv.potentials.PowerLaw(1e-3, stiff))
        out = vv.Scene(vv.Particles([m1, m2], [r1, np.zeros(3)], [v1, v2]), soft).run(2.0 * time, rtol=1e-11)
        received = m1 * (out.velocity[-1, 0] - v1)
        errors.append(np.abs(received - c.impulse(m1, m2, v1, v2, normal=normal)).max())
    assert errors[0] < 0.2
    assert errors[1] < errors[0] / 3.0


@given(masses, masses, seeds)
def test_center_of_mass_and_back(m1: float, m2: float, seed: int) -> None:
    r1, r2, v1 = draw(seed, 4)
    center, relative = c.to_relative(m1, m2, r1, r2)
    back = c.from_relative(m1, m2, center, relative)
    assert back[0] == pytest.approx(r1, abs=4e-15)
    assert back[1] == pytest.approx(r2, abs=4e-15)
    # König: ½m₁v₁² + ½m₂v₂² = ½MV² + ½μv².
    mu = c.reduced_mass(m1, m2)
    moving, inner = c.to_relative(m1, m2, r1, v1)
    whole = 0.5 * (m1 + m2) * along(moving, moving) + 0.5 * mu * along(inner, inner)
    assert whole == pytest.approx(kinetic(m1, m2, r1, v1), rel=1e-14, abs=0)
    assert mu <= min(m1, m2)


def test_reduced_masses() -> None:
    assert c.reduced_mass([4.0, 1e-300, 1e308, 3.0], [4.0, 1e300, 1e308, 6.0]) == pytest.approx(
        [2.0, 1e-300, 5e307, 2.0], rel=2e-16, abs=0
    )


def test_arrays_of_any_layout_broadcast() -> None:
    v1, v2, n = draw(5, 4, 6)
    m1 = np.linspace(1.0, 2.0, 12)[::2]
    table = c.restitution(m1, 2, v1, v2, coefficient=[[0.1], [0.2], [0.3], [0.4]], normal=n)
    assert (table.velocity1.shape, table.energy_loss.shape) == ((4, 6, 3), (4, 6))
    turned = c.restitution(
        m1, 2, np.asfortranarray(v1), v2[::-1][::-1], coefficient=[[0.1], [0.2], [0.3], [0.4]], normal=n
    )
    for i, j in np.ndindex(4, 6):
        one = c.restitution(m1[j], 2.0, v1[i, j], v2[i, j], coefficient=(i + 1) / 10, normal=n[i, j])
        for name in ("velocity1", "velocity2", "impulse", "energy_loss"):
            assert (getattr(table, name)[i, j] == getattr(one, name)).all()
            assert (getattr(table, name) == getattr(turned, name)).all()
        assert isinstance(one.energy_loss, float)
    empty = c.elastic(1.0, 1.0, np.empty((0, 3)), [0, 0, 0], normal=[1, 0, 0])
    assert (empty.velocity2.shape, empty.energy_loss.shape) == ((0, 3), (0,))


X, REST = [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("argument", "message", "call"),
    [
        ("mass1", "positive", lambda: c.elastic(0.0, 1.0, X, REST, normal=X)),
        ("mass2", r"-1.0 at mass2\[1\]", lambda: c.reduced_mass(1.0, [1.0, -1.0])),
        ("velocity1", r"last axis, got shape \(2,\)", lambda: c.elastic(1.0, 1.0, [1.0, 0.0], REST, normal=X)),
        ("normal", "got neither", lambda: c.elastic(1.0, 1.0, X, REST)),
        ("normal", "got both", lambda: c.elastic(1.0, 1.0, X, REST, normal=X, direction=X)),
        ("normal", "with a direction", lambda: c.elastic(1.0, 1.0, X, REST, normal=REST)),
        ("direction", "with a direction", lambda: c.elastic(1.0, 1.0, X, REST, direction=REST)),
        ("coefficient", "from 0 to 1, got 1.5", lambda: c.restitution(1, 1, X, REST, coefficient=1.5, normal=X)),
        ("coefficient", "entry 1 of 2", lambda: c.restitution(1, 1, X, REST, coefficient=[0.5, -1], normal=X)),
        ("q_value", "threshold, -0.25", lambda: c.inelastic(1, 1, X, REST, q_value=-0.26, direction=X)),
        ("q_value", "threshold, 0.0,", lambda: c.inelastic(1, 1, X, X, q_value=-0.26, direction=X)),
        ("normal", "not known", lambda: c.inelastic(1, 1, X, REST, q_value=1.0, normal=[0, 1, 0])),
        ("q_value", "finite", lambda: c.inelastic(1, 1, X, REST, q_value=np.inf, direction=X)),
        ("impact", "they miss", lambda: c.line_of_centers(X, REST, impact=[0, 1.5, 0], distance=1.0)),
        ("velocity1", "do not meet", lambda: c.line_of_centers(X, X, impact=[0, 0.5, 0], distance=1.0)),
        ("distance", "positive", lambda: c.contact_time(X, REST, REST, X, distance=0.0)),
        ("position1", "overlap", lambda: c.contact_time(X, REST, REST, X, distance=2.0)),
        ("velocity2", "broadcast", lambda: c.elastic(1, 1, np.ones((2, 3)), np.ones((4, 3)), normal=X)),
        ("velocity1", "other units", lambda: c.elastic(1, 1, [1e308, 0, 0], [-1e308, 0, 0], normal=X)),
    ],
)  # fmt: skip
def test_refusals(argument: str, message: str, call: object) -> None:
    with pytest.raises(vv.InvalidInput, match=message) as caught:
        call()  # type: ignore[operator]
    assert caught.value.argument == argument
