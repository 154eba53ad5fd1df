"""What is recorded is the state, to the bit, however bodies lie in the lanes: the end of a run tells, read apart."""

import numpy as np
import pytest

import visviva as vv

STEP = 2.0**-6
TIMES = STEP * np.array([0.0, 1.0, 1.5, 4.0, 9.0, 12.0])


def cloud(massless: list[bool], *, planar: bool, offset: float = 0.0) -> vv.Scene:
    """Bodies without order, of which some are massless, in units that have to be scaled."""
    count = len(massless)
    random = np.random.default_rng(count)
    position, velocity = 700.0 * random.normal(size=(2, count, 3)) + offset
    if planar:
        position[:, 2] = velocity[:, 2] = 0.0
    mass = np.where(massless, 0.0, random.uniform(0.5, 1.5, count))
    return vv.Scene(vv.Particles(mass, position, velocity), vv.Gravity(G=1.0, softening=10.0))


@pytest.mark.parametrize("offset", [0.0, 1e6], ids=["here", "far"])
@pytest.mark.parametrize("planar", [False, True], ids=["space", "plane"])
@pytest.mark.parametrize(
    "massless",
    [
        *([False] * count for count in (2, 3, 5, 6, 8, 9, 16, 21)),
        [False] * 3 + [True] * 4,
        [False] * 6 + [True] * 19,
        [False] * 9 + [True] * 8,
        [True, False, True, False, False],
        [True] * 10 + [False] * 10,
    ],
    ids=lambda massless: "".join("om"[not is_massless] for is_massless in massless),
)
def test_the_last_record_is_the_end(massless: list[bool], planar: bool, offset: float) -> None:
    scene = cloud(massless, planar=planar, offset=0.0 if planar else offset)
    how = {"method": "leapfrog", "dt": STEP, "threads": 1}
    out = scene.run(t=TIMES, **how)
    for index, time in enumerate(TIMES):
        end = scene.run(t=float(time), **how).final.particles
        assert np.array_equal(out.position[index], end.position)
        assert np.array_equal(out.velocity[index], end.velocity)
    # One column alone, and with what the rounded values leave out.
    for record in ("position", "velocity"):
        alone = scene.run(t=TIMES, record=record, **how)
        assert np.array_equal(getattr(alone, record), getattr(out, record))
    precisely = scene.run(t=TIMES, record=("position", "velocity", "energy"), **how)
    assert np.array_equal(precisely.position, out.position)
    assert np.array_equal(precisely.velocity, out.velocity)


@pytest.mark.parametrize("massless", [[False] * 6, [True, False, False, True]], ids=["massive", "mixed"])
def test_adaptive_records_end_where_the_run_ends(massless: list[bool]) -> None:
    scene = cloud(massless, planar=False)
    out = scene.run(t=TIMES, method="dop853")
    assert np.array_equal(out.position[-1], out.final.particles.position)
    assert np.array_equal(out.velocity[-1], out.final.particles.velocity)
    assert np.array_equal(out.position[0], scene.particles.position)


@pytest.mark.parametrize("count", [6, 9])
def test_a_record_ends_where_a_body_is_not_finite_and_lanes_without_one_do_not_count(count: int) -> None:
    position = 1e300 * np.eye(count, 3)
    position[3:] += 1e299 * np.arange(1, count - 2)[:, None]
    huge = vv.Scene(vv.Particles(np.ones(count), position), vv.Gravity(G=1.0, softening=1.0))
    assert np.array_equal(huge.run(t=TIMES, method="leapfrog", dt=STEP).position[-1], position)

    velocity = np.zeros((count, 3))
    velocity[-1] = 1e157
    lost = vv.Scene(vv.Particles(np.full(count, 1e300), 1e-150 * position, velocity), vv.Gravity(G=1e164))
    with pytest.raises(vv.ConvergenceError) as caught:
        lost.run(t=1e150 * np.arange(9.0), method="leapfrog", dt=1e150)
    out = caught.value.trajectory
    assert isinstance(out, vv.Trajectory)
    assert out.t == [0.0]
    assert np.array_equal(out.position[0], lost.particles.position)
