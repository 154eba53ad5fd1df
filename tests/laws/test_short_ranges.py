"""Bodies that come from far away to where a force of a short range acts: no step passes over the place."""

import numpy as np
import pytest

import visviva as vv

#: Of a step's tolerance of 1e-9: some ten steps of each meeting, beside steps of a fiftieth of the length.
CLOSE = 1e-6


def colliding(potential: vv.potentials.Potential, apart: float, offset: float) -> vv.Scene:
    place, velocity = [[0.0, 0.0, 0.0], [apart, offset, 0.0]], [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]
    return vv.Scene(vv.Particles([1.0, 1.0], place, velocity), vv.PairPotential(potential))


@pytest.mark.parametrize("apart", [2.0, 3.0, 5.0, 10.0, 20.0, 100.0])
@pytest.mark.parametrize("method", ["auto", "dormand_prince54", "verner98", "bogacki_shampine32"])
def test_soft_spheres_meet_from_any_distance(apart: float, method: str) -> None:
    """They came through each other at full speed, with status OK, where the first step was longer than the meeting."""
    scene = colliding(vv.potentials.SoftSphere(100.0, 1.0, 2.5), apart, 0.1)
    out = scene.run(t=apart, method=method, rtol=1e-9)
    fine = scene.run(t=apart, method="dop853", rtol=1e-12, max_step=0.02)
    assert fine.velocity[-1, 0, 0] < -0.9
    assert np.abs(out.velocity[-1] - fine.velocity[-1]).max() < 100.0 * CLOSE


@pytest.mark.parametrize(
    "potential",
    [
        vv.potentials.SoftSphere(100.0, 0.1, 2.5),
        vv.potentials.Yukawa(1.0, 0.1),
        vv.potentials.Morse(1.0, 10.0, 0.1),
        vv.potentials.Buckingham(100.0, 20.0, 0.0),
    ],
    ids=lambda potential: type(potential).__name__,
)
@pytest.mark.parametrize("apart", [3.0, 10.0, 30.0])
def test_a_field_about_a_point_is_met_from_any_distance(potential: vv.potentials.Potential, apart: float) -> None:
    bodies = vv.Particles([1.0], [[-apart, 0.01, 0.0]], [[1.0, 0.0, 0.0]])
    scene = vv.Scene(bodies, vv.CentralField(potential))
    out, fine = scene.run(t=2 * apart), scene.run(t=2 * apart, rtol=1e-12, max_step=0.005)
    turned = np.abs(fine.velocity[-1, 0] - [1.0, 0.0, 0.0]).max()
    assert turned > 1e-3
    # What the meeting turns is known as well as its steps; how far that leads grows with the way.
    assert np.abs(out.velocity[-1] - fine.velocity[-1]).max() < 100.0 * CLOSE


def test_through_the_center_of_a_soft_sphere() -> None:
    """Steps do not shrink with the distance to nothing: the sphere has a length of its own."""
    scene = colliding(vv.potentials.SoftSphere(0.1, 1.0, 2.5), 10.0, 0.0)
    out = scene.run(t=10.0)
    assert out.status is vv.Status.OK
    assert out.stats.steps < 200
    # In the center the force turns about at once, which costs a step's tolerance some hundred times.
    assert out.velocity[-1, 0, 0] == pytest.approx(1.0, abs=1e-6)


def test_from_rest_onto_a_sphere() -> None:
    """A fall is polynomial, and no error of a step tells of what comes."""
    bodies = vv.Particles([1.0], [[0.0, 0.0, 20.0]], [[0.0, 0.0, 0.0]])
    forces = (vv.UniformField([0.0, 0.0, -1.0]), vv.CentralField(vv.potentials.SoftSphere(1000.0, 1.0, 2.5)))
    out = vv.Scene(bodies, *forces).run(t=12.0, rtol=1e-10)
    fine = vv.Scene(bodies, *forces).run(t=12.0, rtol=1e-12, max_step=0.01)
    assert fine.velocity[-1, 0, 2] > 0.0  # it bounces
    # The bounce takes a hundredth of the time, and six units of it follow.
    assert np.abs(out.position[-1] - fine.position[-1]).max() < 1e-5


def test_copies_have_the_bits_of_one() -> None:
    scene = colliding(vv.potentials.SoftSphere(100.0, 1.0, 2.5), 10.0, 0.1)
    starts = scene.particles.position + np.array([0.0, 0.02, 0.0]) * np.arange(11)[:, None, None] * [[0.0], [1.0]]
    every = scene.ensemble(position=starts).run(t=10.0)
    for copy, start in enumerate(starts):
        particles = vv.Particles(scene.particles.mass, start, scene.particles.velocity)
        alone = vv.Scene(particles, *scene.forces).run(t=10.0)
        assert (every.position[copy] == alone.position).all()
