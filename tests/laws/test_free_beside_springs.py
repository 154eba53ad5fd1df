"""Bodies that no spring joins, beside many springs: none of them is asked of what joins others."""

import time
from typing import Any

import numpy as np
import pytest

import visviva as vv

RNG = np.random.default_rng(5)
PLACES = np.stack([np.arange(60.0), np.zeros(60), np.zeros(60)], axis=1)
SPEEDS = 0.1 * RNG.normal(size=(60, 3))


@pytest.mark.parametrize(
    "how", [{"method": "leapfrog", "dt": 0.0625}, {"rtol": 1e-10}, {"method": "rk4", "dt": 0.0625}]
)
@pytest.mark.parametrize("beside", [[], [vv.Harmonic(0.3)], [vv.UniformField([0.0, 0.0, -1.0]), vv.Harmonic(0.1)]])
@pytest.mark.parametrize("dampers", [False, True])
def test_the_free_and_the_joined_move_as_they_do_alone(how: dict[str, Any], beside: list[Any], dampers: bool) -> None:
    if dampers and how.get("method") == "leapfrog":
        pytest.skip("leapfrog takes no velocities")
    chain = [vv.Spring(i, i + 1, 10.0, 1.0) for i in range(9)]
    apart = [vv.Spring(20, 21, 3.0, 0.9), *([vv.Damper(20, 21, 0.5)] if dampers else [])]

    def after(bodies: slice, forces: list[Any], threads: int = 1) -> Any:
        part = vv.Particles(np.ones(60)[bodies], PLACES[bodies], SPEEDS[bodies])
        return vv.Scene(part, *forces).run(t=2.0, threads=threads, **how).position[-1]

    everything = slice(0, 60)
    out = after(everything, [*chain, *beside, *apart])
    np.testing.assert_array_equal(after(everything, [*chain, *beside, *apart], threads=3), out)
    joined = vv.Spring(np.arange(9), np.arange(1, 10), 10.0, 1.0)
    np.testing.assert_array_equal(after(everything, [joined, *beside, *apart])[22:], out[22:])
    # Alone they have another origin, and their own tolerance: 1e-10 of places of up to 60.
    np.testing.assert_allclose(after(slice(0, 10), [*chain, *beside]), out[:10], rtol=0, atol=1e-8)
    np.testing.assert_allclose(after(slice(22, 60), beside), out[22:], rtol=0, atol=1e-8)


def test_two_hundred_springs_cost_bodies_nothing_that_they_do_not_join() -> None:
    """With a chain of 200 springs among them they cost what they do with one of eight, and the chain alone: 1.1 to 1.4.

    It would be about ten if all were asked of springs that join others: that was sixty times the cost of those that are
    joined and those that are not, each by themselves. With eight springs lanes are over the same as with 200.
    """

    def chain(bodies: int, springs: int) -> vv.Scene:
        rng = np.random.default_rng(1)
        places, speeds = np.zeros((bodies, 3)), 0.1 * rng.normal(size=(bodies, 3))
        places[:, 0] = np.arange(bodies)
        part = vv.Particles(np.ones(bodies), places, speeds)
        return vv.Scene(part, *[vv.Spring(i, i + 1, 10.0, 1.0) for i in range(springs)])

    def seconds(scene: vv.Scene) -> float:
        # Of this process alone: others that are busy do not count.
        begun = time.process_time()
        scene.run(t=1.0, method="leapfrog", dt=0.01, threads=1)
        return time.process_time() - begun

    scenes = chain(900, 200), chain(900, 8), chain(201, 200)
    turns = [[seconds(scene) for scene in scenes] for _ in range(9)]
    many, few, alone = (min(times) for times in zip(*turns, strict=True))
    assert many < 1.6 * (few + alone)
