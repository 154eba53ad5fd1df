"""What changes nothing of a closed scene: another frame, other units, mirrors, time reversed, company, outputs."""

import numpy as np
import pytest
from closed_scenes import END, METHODS, NAMES, arguments, arrays, closed_scenes, distance, run, state_error
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import visviva as vv


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes(), velocity=arrays((3,), -2.0, 2.0), origin=arrays((3,), -2.0, 2.0))
@settings(max_examples=25)
def test_galilean_invariance(
    method: vv.Method, scene: vv.Scene, velocity: NDArray[np.float64], origin: NDArray[np.float64]
) -> None:
    here, there = run(scene, method), run(scene.in_frame(velocity=velocity, origin=origin), method)
    back = there.position + origin + np.multiply.outer(there.t, velocity)[:, None]
    # An adaptive method chooses other steps in another frame: then its tolerance, not the rounding, tells.
    # Worst: 3.1e-15, dop853 1.2e-11.
    bound = 2.0 * state_error(scene, method) if method.adaptive else 1.2e-14
    assert distance(back, here.position) < bound
    assert distance(there.velocity + velocity, here.velocity) < bound


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes(), axis=arrays((3,), -1.0, 1.0), angle=st.floats(-3.0, 3.0))
@settings(max_examples=25)
def test_rotational_invariance(method: vv.Method, scene: vv.Scene, axis: NDArray[np.float64], angle: float) -> None:
    axis = axis / size if (size := float(np.linalg.norm(axis))) > 1e-3 else np.array([0.0, 0.0, 1.0])
    cross = np.cross(np.eye(3), axis)
    matrix = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    here, there = run(scene, method), run(scene.rotated(matrix), method)
    # Worst: 9e-16; adaptive 4e-15, but a step at the brink of rejection may tip, and then the tolerance tells.
    bound = 2.0 * state_error(scene, method) if method.adaptive else 4e-15
    assert distance(here.position @ matrix.T, there.position) < bound


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes(), signs=st.tuples(*[st.sampled_from([-1.0, 1.0])] * 3))
@settings(max_examples=25)
def test_reflections_change_no_bit(method: vv.Method, scene: vv.Scene, signs: tuple[float, ...]) -> None:
    """Rounding is symmetric about zero, so a mirror image has the mirrored bits."""
    here, there = run(scene, method), run(scene.rotated(np.diag(signs)), method)
    assert np.array_equal(here.position * signs, there.position)
    assert np.array_equal(here.velocity * signs, there.velocity)


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes(), powers=st.tuples(*[st.integers(-40, 40)] * 3))
@settings(max_examples=25)
def test_units_of_powers_of_two_change_no_bit(method: vv.Method, scene: vv.Scene, powers: tuple[int, int, int]) -> None:
    length, mass, time = (2.0**power for power in powers)
    scaled = scene.rescaled(length=length, mass=mass, time=time)
    here = run(scene, method)
    there = scaled.run(t=here.t * time, **arguments(method, time))  # type: ignore[arg-type]
    assert np.array_equal(here.position * length, there.position)
    assert np.array_equal(here.velocity * (length / time), there.velocity)


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes(), scales=st.tuples(*[st.floats(1e-3, 1e3)] * 3))
@settings(max_examples=25)
def test_any_units_will_do(method: vv.Method, scene: vv.Scene, scales: tuple[float, float, float]) -> None:
    """Units that are no powers of two round every coordinate and constant once."""
    length, mass, time = scales
    at_zero = vv.Scene(scene.particles, *scene.forces)
    scaled = at_zero.rescaled(length=length, mass=mass, time=time)
    here = run(at_zero, method)
    there = scaled.run(t=here.t * time, **arguments(method, time))  # type: ignore[arg-type]
    # Worst: 7e-16; adaptive 6e-15, or the tolerance where a step tips.
    bound = 2.0 * state_error(scene, method) if method.adaptive else 4e-15
    assert distance(here.position, there.position / length) < bound


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes())
@settings(max_examples=25)
def test_motion_reversed_retraces_its_path(method: vv.Method, scene: vv.Scene) -> None:
    there = run(scene, method).final.reversed()
    back = run(there, method).final
    # Worst of the reversible: 3.9e-16. The others err on the way there and on the way back, and the motion carries
    # the first error on: by e to these scenes' largest rate, some 3.
    bound = 2e-15 if method.reversible else 20.0 * state_error(scene, method)
    assert distance(back.particles.position, scene.particles.position) < bound
    assert distance(-back.particles.velocity, scene.particles.velocity) < bound


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes())
@settings(max_examples=25)
def test_time_runs_both_ways(method: vv.Method, scene: vv.Scene) -> None:
    """Backwards in time is the same as forwards with the velocities reversed, to the bit."""
    times = np.linspace(0.0, END, 5)
    still = vv.Scene(scene.particles, *scene.forces)
    back = still.run(t=-times, **arguments(method, -1.0))  # type: ignore[arg-type]
    mirrored = still.reversed().run(t=times, **arguments(method))  # type: ignore[arg-type]
    assert np.array_equal(back.position, mirrored.position)
    assert np.array_equal(back.velocity, -mirrored.velocity)


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes(), data=st.data())
@settings(max_examples=15)
def test_an_ensemble_has_the_bits_of_single_runs(method: vv.Method, scene: vv.Scene, data: st.DataObject) -> None:
    copies = data.draw(st.integers(1, 11))
    shape = (copies, *scene.particles.position.shape)
    position = scene.particles.position + data.draw(arrays(shape, -0.5, 0.5))
    velocity = scene.particles.velocity + data.draw(arrays(shape, -0.5, 0.5))
    times = scene.t0 + np.array([0.0, 0.3, END])
    together = scene.ensemble(position=position, velocity=velocity).run(t=times, **arguments(method))  # type: ignore[arg-type]
    for index in range(copies):
        alone = scene.with_state(position[index], velocity[index]).run(t=times, **arguments(method))  # type: ignore[arg-type]
        assert np.array_equal(together.position[index], alone.position)
        assert np.array_equal(together.velocity[index], alone.velocity)


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
def test_a_lone_massive_body_does_not_depend_on_the_other_copies(method: vv.Method) -> None:
    """It has no size of its own; that of another copy must not enter its steps, nor the states between them."""
    bodies = vv.Particles(
        mass=[1.0, 0.0, 0.0],
        position=[[0.0, 0.0, 2.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        velocity=[[0.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 1.0]],
    )
    scene = vv.Scene(bodies, vv.Gravity(G=1.0, softening=1.0))
    position = np.array([bodies.position, 0.75 * bodies.position, 1e-3 * bodies.position])
    times = np.linspace(0.0, END, 9)
    together = scene.ensemble(position=position).run(t=times, **arguments(method))  # type: ignore[arg-type]
    for index in range(len(position)):
        alone = scene.with_state(position[index], bodies.velocity).run(t=times, **arguments(method))  # type: ignore[arg-type]
        assert np.array_equal(together.position[index], alone.position)
    # Uniform motion, whatever the method. The weights of dop853's continuous extension are some ten times what they
    # add up to: 1.9e-15 seen.
    straight = bodies.position[0] + times[:, None] * bodies.velocity[0]
    assert np.abs(together.position[0, :, 0] - straight).max() < 4e-15


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes(), times=st.lists(st.floats(0.0, END), min_size=1, max_size=6, unique=True))
@settings(max_examples=25)
def test_outputs_never_steer(method: vv.Method, scene: vv.Scene, times: list[float]) -> None:
    """Whatever is asked for on the way, the end has the same bits."""
    still = vv.Scene(scene.particles, *scene.forces)
    only_end = still.run(t=END, **arguments(method))  # type: ignore[arg-type]
    busy = still.run(t=[*sorted(set(times) - {END}), END], **arguments(method))  # type: ignore[arg-type]
    assert np.array_equal(only_end.position[-1], busy.position[-1])
    assert np.array_equal(only_end.velocity[-1], busy.velocity[-1])
