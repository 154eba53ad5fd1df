"""Forces with Taylor series: `taylor` beside closed forms and another method, and what it refuses."""

import re

import numpy as np
import pytest

import visviva as vv


def pulled(length: float = 0.0) -> vv.Scene:
    """Two bodies that a spring holds, thrown and turning."""
    bodies = vv.Particles([1.0, 3.0], [[0.0, 0.0, 0.0], [1.5, 0.5, -0.25]], [[0.5, -0.25, 1.0], [0.0, 0.75, 0.25]])
    return vv.Scene(bodies, vv.Spring(0, 1, k=12.0, length=length), t0=0.5)


@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-12])
def test_a_spring_without_length_swings_as_an_oscillator(rtol: float) -> None:
    """μ r″ = −k r with μ = 3/4: ω = 4; the center of mass goes straight on."""
    scene = pulled()
    times = scene.t0 + np.linspace(0.0, 10.0, 11)
    out = scene.run(t=times, method="taylor", rtol=rtol)
    mass, x, v = scene.particles.mass, scene.particles.position, scene.particles.velocity
    t = (times - scene.t0)[:, None]
    apart = (x[1] - x[0]) * np.cos(4.0 * t) + (v[1] - v[0]) * np.sin(4.0 * t) / 4.0
    center = mass @ x / 4.0 + t * (mass @ v) / 4.0
    exact = np.stack([center - 0.75 * apart, center + 0.25 * apart], axis=1)
    # Forty radians, whose phase may err by the tolerance each.
    assert np.abs(out.position - exact).max() < 40 * rtol + 1e-13


@pytest.mark.parametrize("count", [2, 7, 11])
def test_a_net_of_springs_in_a_field_goes_as_by_another_method(count: int) -> None:
    """With a uniform field, linear drag, a magnetic field and a driven force, in lanes of bodies and of systems."""
    rng = np.random.default_rng(count)
    bodies = vv.Particles(rng.uniform(0.5, 2.0, count), rng.normal(size=(count, 3)), rng.normal(size=(count, 3)))
    ends = np.arange(count - 1)
    forces = (
        vv.Spring(ends, ends + 1, k=rng.uniform(1.0, 20.0, count - 1)),
        vv.UniformField([0.0, 0.0, -9.75]),
        vv.LinearDrag(tau=8.0),
        vv.UniformMagneticField([0.0, 0.5, 1.0], charge=0.75),
        vv.DrivenForce([1.0, 0.0, 0.5], frequency=3.0),
    )
    scene = vv.Scene(bodies, *forces, t0=0.25)
    by_series = scene.run(t=4.25, method="taylor", rtol=1e-12)
    other = scene.run(t=4.25, method="verner98", rtol=1e-13)
    # Bodies fall by 70.
    assert np.abs(by_series.position[-1] - other.position[-1]).max() < 2e-10
    copies = scene.ensemble(position=np.stack([bodies.position, bodies.position + 0.5]))
    assert np.array_equal(copies.run(t=4.25, method="taylor", rtol=1e-12)[0].position, by_series.position)


def test_drag_by_the_square_of_the_speed_has_no_series_anywhere() -> None:
    """Where a body comes to rest and turns back the force turns about, of which a series would know nothing."""
    message = re.escape("method: taylor needs the Taylor series of every force, and QuadraticDrag has none")
    scene = vv.Scene(pulled().particles, *pulled().forces, vv.QuadraticDrag(0.0))
    # One that does nothing is no hindrance.
    assert np.isfinite(scene.run(t=1.0, method="taylor").position).all()
    copies = scene.ensemble(parameters={1: {"coefficient": [0.5, 0.25]}})
    with pytest.raises(vv.InvalidInput, match=message):
        copies.run(t=1.0, method="taylor")


@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize("softening", [0.0, 0.125])
def test_two_bodies_have_the_bits_they_have_among_copies(dimensions: int, softening: float) -> None:
    rng = np.random.default_rng(dimensions)
    position, velocity = rng.normal(size=(2, 9, 2, 3))
    position[..., dimensions:] = velocity[..., dimensions:] = 0.0
    scene = vv.Scene(vv.Particles([0.75, 0.5], position[0], 0.5 * velocity[0]), vv.Gravity(G=1.0, softening=softening))
    copies = scene.ensemble(position=position, velocity=0.5 * velocity)
    together = copies.run(t=3.0, method="taylor", rtol=1e-10)
    for copy, other in zip(copies, together, strict=True):
        alone = copy.run(t=3.0, method="taylor", rtol=1e-10)
        assert np.array_equal(alone.position, other.position)
        assert np.array_equal(alone.velocity, other.velocity)
        # And they go as another method says: errors grow at encounters, here by less than 1e3.
        reference = copy.run(t=3.0, method="verner98", rtol=1e-13)
        assert np.abs(alone.position[-1] - reference.position[-1]).max() < 1e-7
