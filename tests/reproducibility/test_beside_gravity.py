"""Forces that few bodies feel in one kernel with gravity: what both give is the sum of what each gives, to the bit."""

import numpy as np
import pytest

import visviva as vv

FORCES = {
    "J2": lambda n, source: vv.Oblate(source, 1.0, 0.02, 0.3, [0.0, 0.0, 1.0]),
    "J2 and J4": lambda n, source: vv.Oblate(source, 1.0, 0.02, 0.3, [0.0, 0.0, 2.0], -0.01),
    "two sources": lambda n, source: vv.Oblate([source, (source + 1) % n], 1.0, 0.02, 0.3, [0.0, 0.0, 1.0]),
    "1PN": lambda n, source: vv.PostNewtonian(source, 1.0, 40.0),
    "oscillator": lambda n, source: vv.Harmonic(0.3 + source),
    "electric field": lambda n, source: vv.UniformElectricField([0.3, -0.1, 0.0], np.arange(n) - float(source)),
    "frame": lambda n, source: vv.RotatingFrame([0.0, 0.0, 0.3], [0.1, source, 0.0]),
    "charges": lambda n, source: vv.Coulomb(np.arange(n) - float(source), k=0.3),
    "drag": lambda n, source: vv.LinearDrag(7.0 + source),
    "quadratic drag": lambda n, source: vv.QuadraticDrag(0.01 * np.arange(n)),
}
# Not those of more than one term, nor of places from a fixed point: alone they are told from another origin.
SUMS = [name for name in FORCES if name not in ("two sources", "frame", "oscillator")]


def bodies(n: int, *, plane: bool, seed: int, speed: float = 0.3) -> vv.Particles:
    rng = np.random.default_rng(seed)
    position, velocity = 2.0 * rng.normal(size=(n, 3)), speed * rng.normal(size=(n, 3))
    if plane:
        position[:, 2] = velocity[:, 2] = 0.0
    return vv.Particles(rng.uniform(0.1, 2.0, n), position, velocity)


@pytest.mark.parametrize("softening", [0.0, 0.2])
@pytest.mark.parametrize("plane", [False, True])
@pytest.mark.parametrize("name", SUMS)
def test_both_give_the_sum_of_what_each_gives(name: str, plane: bool, softening: float) -> None:
    """For every number of bodies and every source. From rest, a step of Euler's method is h a: all bits of it."""
    h = 2.0**-10
    for n in range(2, 10):
        for source in range(n):
            force, gravity = FORCES[name](n, source), vv.Gravity(0.7, softening)
            start = bodies(n, plane=plane, speed=0.0, seed=n)
            gravity_alone, alone, both, turned = (
                vv.Scene(start, *forces).run(t=h, method="euler", dt=h).velocity[-1]
                for forces in ([gravity], [force], [gravity, force], [force, gravity])
            )
            np.testing.assert_array_equal(both, gravity_alone + alone)
            np.testing.assert_array_equal(both, turned)


# Bits are looked at, not places.
@pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")
@pytest.mark.parametrize("softening", [0.0, 0.2])
@pytest.mark.parametrize("plane", [False, True])
@pytest.mark.parametrize("name", FORCES)
def test_a_copy_has_the_bits_it_has_alone(name: str, plane: bool, softening: float) -> None:
    """Copies in lanes have kernels of their own for each force."""
    for n in range(2, 9):
        start = bodies(n, plane=plane, seed=10 + n)
        scene = vv.Scene(start, vv.Gravity(0.7, softening), FORCES[name](n, n // 2))
        places = np.stack([start.position * scale for scale in (1.0, 1.1, 0.9)])
        for method in ("leapfrog", "rk4"):
            try:
                scene.plan(t=0.5, method=method, dt=1 / 64)
            except vv.InvalidInput:  # a force that looks at velocities
                continue
            together = scene.ensemble(position=places).run(t=0.5, method=method, dt=1 / 64)
            for copy, place in enumerate(places):
                one = scene.with_state(place, start.velocity, 0.0).run(t=0.5, method=method, dt=1 / 64)
                np.testing.assert_array_equal(together[copy].position[-1], one.position[-1])
                np.testing.assert_array_equal(together[copy].velocity[-1], one.velocity[-1])
