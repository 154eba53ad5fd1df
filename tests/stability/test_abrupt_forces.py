"""Forces that begin abruptly on a long free way: walls without a length of their own, and contacts of stiff spheres.

What turns back is known beforehand: an elastic head-on collision sends a body back as fast as it came, and exchanges
the velocities of two that are equally heavy.
"""

import numpy as np
import pytest

import visviva as vv

#: A drag that takes nothing in that time: energies say nothing then, so no warning could.
NO_DRAG = vv.LinearDrag(1e14)


@pytest.mark.parametrize("method", ["dop853", "verner98", "tsitouras54", "dormand_prince54", "bogacki_shampine32"])
@pytest.mark.parametrize("n", [3.0, 4.0, 6.0, 12.0, 24.0])
@pytest.mark.filterwarnings("error")
def test_no_power_law_is_passed_through(n: float, method: str) -> None:
    """V = 1/rⁿ at energy 1/2, from afar: how far does not matter."""
    wall = vv.potentials.PowerLaw(1.0, n)
    for distance in np.geomspace(3.0, 9000.0, 12):
        body = vv.Particles([1.0], [[-distance, 0.0, 0.0]], [[1.0, 0.0, 0.0]])
        # A low order needs a tolerance it can meet.
        rtol = 1e-6 if method == "bogacki_shampine32" else 1e-9
        out = vv.Scene(body, vv.CentralField(wall)).run(2.0 * distance + 4.0, method=method, rtol=rtol)
        gone = 0.5 * out.velocity[-1, 0, 0] ** 2
        # Energy is kept to what the tolerance makes of the speed over some hundreds of steps.
        assert out.velocity[-1, 0, 0] < 0.0, distance
        assert gone + float(wall.value(np.abs(out.position[-1, 0, 0]))) == pytest.approx(
            0.5 + distance**-n, rel=3e3 * rtol, abs=0
        )


@pytest.mark.parametrize("method", ["auto", "verner98", "tsitouras54"])
@pytest.mark.filterwarnings("error")
def test_two_bodies_turn_back_from_a_power_law(method: str) -> None:
    wall = vv.PairPotential(vv.potentials.PowerLaw(1.0, 12.0))
    starts = np.geomspace(3.0, 3000.0, 9)
    for distance in starts:
        bodies = vv.Particles([1.0, 1.0], [[-distance, 0, 0], [distance, 0, 0]], [[1.0, 0, 0], [-1.0, 0, 0]])
        out = vv.Scene(bodies, wall).run(2.0 * distance, method=method)
        # The tail of the wall is 1e-5 of the energy where they start at 3, and less farther out.
        assert out.velocity[-1, :, 0] == pytest.approx([-1.0, 1.0], abs=3e-6), distance


@pytest.mark.parametrize("method", ["auto", "dop853", "verner98", "tsitouras54", "dormand_prince54"])
@pytest.mark.parametrize("n", [2.0, 2.5, 3.0])
@pytest.mark.filterwarnings("error")
def test_stiff_spheres_bounce(n: float, method: str) -> None:
    """Against a fixed center: as fast back, whatever the step at which the contact begins."""
    rng = np.random.default_rng(7)
    for _ in range(25):
        distance, stiffness = rng.uniform(2.0, 40.0), 10.0 ** rng.uniform(3.0, 5.0)
        body = vv.Particles([1.0], [[-distance, 0, 0]], [[1.0, 0, 0]])
        contact = vv.CentralField(vv.potentials.SoftSphere(stiffness, 1.0, n))
        for forces in ((contact,), (contact, NO_DRAG)):
            out = vv.Scene(body, *forces).run(2.0 * distance, method=method, rtol=1e-9)
            # In the contact the rate is large and a derivative leaps: some thousand tolerances (measured 1.3e-6).
            assert out.velocity[-1, 0, 0] == pytest.approx(-1.0, abs=3e-6), (distance, stiffness, len(forces))


@pytest.mark.parametrize("threads", [1, 3])
def test_copies_meet_the_sphere_as_each_alone(threads: int) -> None:
    distances = np.linspace(2.0, 40.0, 19)
    body = vv.Particles([1.0], [[-2.0, 0, 0]], [[1.0, 0, 0]])
    scene = vv.Scene(body, vv.CentralField(vv.potentials.SoftSphere(6e4, 1.0, 2.0)), NO_DRAG)
    places = np.zeros((19, 1, 3))
    places[:, 0, 0] = -distances
    out = scene.ensemble(position=places).run(60.0, method="verner98", threads=threads)
    for place, velocity in zip(places, out.velocity[:, -1], strict=True):
        alone = scene.with_state(place, body.velocity, 0.0).run(60.0, method="verner98").velocity[-1]
        assert np.array_equal(alone, velocity)
        # Some tolerances of 1e-9, as a derivative leaps at the surface; measured 4.1e-8.
        assert velocity[0, 0] == pytest.approx(-1.0, abs=2e-7)
