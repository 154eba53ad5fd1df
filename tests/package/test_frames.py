"""Changes of frame and of units, and the center of mass.

Bounds: sums and products of a few numbers, 1e-14 of them; angular momenta of twelve bodies cancel to a tenth of their
terms.
"""

import numpy as np
import pytest

import visviva as vv

RNG = np.random.default_rng(7)
CLUSTER = vv.Scene(
    vv.Particles(RNG.uniform(0.5, 2.0, 5), RNG.normal(size=(5, 3)), RNG.normal(size=(5, 3))),
    vv.Gravity(G=1.5, softening=0.1),
    t0=3.0,
)


def test_center_of_mass_frame_has_no_momentum() -> None:
    here = CLUSTER.center_of_mass_frame().invariants()
    # Five roundings of numbers of size 5.
    assert np.abs(here.momentum).max() < 5e-15
    assert np.abs(here.center_of_mass).max() < 5e-15


def test_frames_compose_and_invert() -> None:
    velocity, origin = np.array([0.5, -0.25, 2.0]), np.array([1.0, 2.0, -4.0])
    there = CLUSTER.in_frame(velocity=velocity, origin=origin)
    back = there.in_frame(velocity=-velocity, origin=-origin)
    assert np.allclose(back.particles.position, CLUSTER.particles.position, rtol=0, atol=2e-15)
    assert np.allclose(back.particles.velocity, CLUSTER.particles.velocity, rtol=0, atol=1e-15)
    assert back.forces == CLUSTER.forces


def test_energy_and_momentum_transform() -> None:
    """T' = T − P·V + M V²/2 and P' = P − M V; the potential energy does not notice."""
    velocity = np.array([0.5, -0.25, 2.0])
    old, new = CLUSTER.invariants(), CLUSTER.in_frame(velocity=velocity).invariants()
    assert new.momentum == pytest.approx(old.momentum - old.total_mass * velocity, abs=1e-14)
    expected = old.kinetic_energy - old.momentum @ velocity + old.total_mass * velocity @ velocity / 2
    assert new.kinetic_energy == pytest.approx(expected, rel=1e-14, abs=0)
    assert new.potential_energy == pytest.approx(old.potential_energy, rel=1e-14, abs=0)
    assert new.internal_kinetic_energy == pytest.approx(old.internal_kinetic_energy, rel=1e-14, abs=0)
    assert new.spin == pytest.approx(old.spin, abs=1e-13)


def test_units_scale_by_their_dimensions() -> None:
    """With L, M, T new units per old one: energy M L² / T², momentum M L / T, angular momentum M L² / T."""
    length, mass, time = 1.7, 0.3, 2.9
    old = CLUSTER.invariants()
    new = CLUSTER.rescaled(length=length, mass=mass, time=time).invariants()
    assert new.energy == pytest.approx(old.energy * mass * length**2 / time**2, rel=1e-13, abs=0)
    assert new.momentum == pytest.approx(old.momentum * mass * length / time, rel=1e-14, abs=0)
    assert new.angular_momentum == pytest.approx(old.angular_momentum * mass * length**2 / time, rel=1e-13, abs=0)
    ratio = old.internal_kinetic_energy / old.kinetic_energy
    assert new.internal_kinetic_energy / new.kinetic_energy == pytest.approx(ratio, rel=1e-14, abs=0)


def test_powers_of_two_change_no_mantissa() -> None:
    scaled = CLUSTER.rescaled(length=2.0**20, mass=2.0**-10, time=2.0**5)
    back = scaled.rescaled(length=2.0**-20, mass=2.0**10, time=2.0**-5)
    assert back == CLUSTER


def test_a_rotation_turns_vectors_and_fields() -> None:
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    field = vv.CentralField(vv.potentials.Coulomb(1.0), center=[1.0, 0.0, 0.0])
    scene = vv.Scene(vv.Particles([1.0], [[2.0, 0.0, 0.0]]), vv.UniformField([1.0, 0.0, 0.0]), field).rotated(quarter)
    assert scene.particles.position.tolist() == [[0.0, 2.0, 0.0]]
    assert scene.forces[0] == vv.UniformField([0.0, 1.0, 0.0])
    assert scene.forces[1] == vv.CentralField(vv.potentials.Coulomb(1.0), center=[0.0, 1.0, 0.0])


@pytest.mark.parametrize(
    ("change", "argument"),
    [
        (lambda scene: scene.rotated(np.ones((3, 3))), "rotation"),
        (lambda scene: scene.rescaled(length=0.0), "length"),
        (lambda scene: scene.rescaled(mass=-1.0), "mass"),
        (lambda scene: scene.in_frame(velocity=[1.0, 0.0, 0.0]), "velocity"),
        (lambda scene: scene.invariants(about="the sun"), "about"),
        (lambda scene: scene.invariants(about=[1.0, 2.0]), "about"),
    ],
)
def test_impossible_changes_are_refused_by_name(change: object, argument: str) -> None:
    scene = vv.Scene(vv.Particles([1.0], [[2.0, 0.0, 0.0]]), vv.CentralField(vv.potentials.Coulomb(1.0)))
    with pytest.raises(vv.InvalidInput) as caught:
        change(scene)  # type: ignore[operator]
    assert caught.value.argument == argument


@pytest.mark.parametrize(
    "potential",
    [
        vv.potentials.Coulomb(-2.0),
        vv.potentials.Yukawa(k=-2.0, length=0.7),
        vv.potentials.LennardJones(epsilon=0.3, sigma=0.9),
    ],
    ids=repr,
)
def test_a_potential_changes_its_units_with_the_scene(potential: vv.potentials.Potential) -> None:
    """V at the same place is the same energy: M L² / T² of the new units. Each parameter and r are rounded once."""
    length, mass, time = 1.7, 0.3, 2.9
    field = vv.CentralField(potential, center=[1.0, 0.0, 0.0])
    scene = vv.Scene(vv.Particles([1.5], [[2.0, 0.5, 0.0]], [[0.1, 0.2, 0.3]]), field)
    old, new = scene.invariants(), scene.rescaled(length=length, mass=mass, time=time).invariants()
    # V of Lennard-Jones magnifies an error of r twelvefold.
    assert new.potential_energy == pytest.approx(old.potential_energy * mass * length**2 / time**2, rel=1e-14, abs=0)
    assert new.torque == pytest.approx(old.torque * mass * length**2 / time**2, rel=1e-13, abs=0)
    r = np.array([0.5, 1.0, 3.0])
    scaled = potential.rescaled(length=length, mass=mass, time=time)
    assert scaled.force(r * length) == pytest.approx(potential.force(r) * mass * length / time**2, rel=1e-14, abs=0)
    back = scene.rescaled(length=2.0**9, mass=2.0**-4, time=2.0**3).rescaled(length=2.0**-9, mass=2.0**4, time=2.0**-3)
    assert back == scene


def test_a_fixed_center_moves_with_a_displacement() -> None:
    field = vv.CentralField(vv.potentials.Coulomb(1.0), center=[1.0, 0.0, 0.0])
    scene = vv.Scene(vv.Particles([1.0], [[2.0, 0.0, 0.0]]), field).shifted(position=[0.0, 5.0, 0.0])
    assert scene.forces[0] == vv.CentralField(vv.potentials.Coulomb(1.0), center=[1.0, 5.0, 0.0])


def test_massless_bodies_have_no_center() -> None:
    scene = vv.Scene(vv.Particles([0.0], [[1.0, 0.0, 0.0]]))
    with pytest.raises(vv.InvalidInput, match="total mass is zero"):
        scene.center_of_mass_frame()
    with pytest.raises(vv.InvalidInput, match="total mass is zero"):
        scene.invariants()


def test_kinetic_energies_add_where_squares_of_momenta_overflow() -> None:
    """T = T_cm + T_internal (König), in units in which P² is beyond double precision and T is not."""
    heavy = CLUSTER.rescaled(mass=2.0**600)
    here, plain = heavy.invariants(), CLUSTER.invariants()
    assert here.center_of_mass_kinetic_energy == plain.center_of_mass_kinetic_energy * 2.0**600
    # Three sums of some ten roundings each.
    together = here.center_of_mass_kinetic_energy + here.internal_kinetic_energy
    assert together == pytest.approx(here.kinetic_energy, rel=4e-15, abs=0)


def test_units_that_leave_numbers_without_their_digits_are_refused() -> None:
    """Below 2.2e-308 numbers have fewer digits: k = 0.9 came back as 0.875."""
    particles = vv.Particles([1.0, 2.0], [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    scene = vv.Scene(particles, vv.Coulomb([0.7, -1.1], k=0.9))
    with pytest.raises(vv.InvalidInput, match="all digits of it"):
        scene.rescaled(length=2.0**-107, mass=2.0**-130, time=2.0**310)
    # The last octave that has them all.
    scaled = scene.rescaled(time=2.0**510)
    assert scaled.rescaled(time=2.0**-510).forces[0] == scene.forces[0]
