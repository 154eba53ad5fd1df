"""The laws of mechanics over random closed scenes, for every method there is.

Scenes are softened, so that every method resolves them with the same step and a law is not drowned by a close
encounter. Tolerances are about four times the worst of 500 examples, which is noted beside them.
"""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.typing import NDArray

import visviva as vv

METHODS = vv.methods()
NAMES = [method.name for method in METHODS]
STEP = 1 / 64
END = 1.0


def arrays(shape: tuple[int, ...], low: float, high: float) -> st.SearchStrategy[NDArray[np.float64]]:
    return hnp.arrays(np.float64, shape, elements=st.floats(low, high, width=32))


@st.composite
def closed_scenes(draw: st.DrawFn) -> vv.Scene:
    """Two to five softened bodies; the first has mass, the others may have none."""
    count = draw(st.integers(2, 5))
    masses = np.concatenate([[1.0], draw(arrays((count - 1,), 0.0, 2.0))])
    masses[masses < 1e-3] = 0.0
    bodies = vv.Particles(masses, draw(arrays((count, 3), -2.0, 2.0)), draw(arrays((count, 3), -1.0, 1.0)))
    softening = draw(st.floats(0.5, 1.0))
    return vv.Scene(bodies, vv.Gravity(draw(st.floats(0.25, 1.0)), softening=softening), t0=draw(st.floats(-4.0, 4.0)))


def step(method: vv.Method) -> float:
    """A multistep method wants a hundred steps and more to the shortest period, which is 0.7 here."""
    return STEP / 4 if method.name == "stormer13" else STEP


def rtol(method: vv.Method) -> float:
    """Two and a half powers of ten for each order, which is 10^2.5 times as many steps; 1e-12 at most."""
    return max(1e-12, 10.0 ** (-2.5 * method.order))


def within(method: vv.Method, bound: float) -> float:
    """The bound of a method of order 8 at 1e-12, as it is for another: low orders take some ten times the steps for the
    same tolerance, and the errors of steps add.
    """
    return bound * rtol(method) / 1e-12 * (1 if method.order >= 8 else 10)


def arguments(method: vv.Method, scale: float = 1.0) -> dict[str, object]:
    """A step for a fixed-step method, a tolerance for an adaptive one."""
    tight: dict[str, object] = {"rtol": rtol(method)} if method.adaptive else {"dt": step(method) * scale}
    return {"method": method.name} | tight


def run(scene: vv.Scene, method: vv.Method, end: float = END, **more: object) -> vv.Trajectory:
    return scene.run(t=scene.t0 + np.linspace(0.0, end, 5), **(arguments(method) | more))  # type: ignore[arg-type]


def distance(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    return float(np.abs(a - b).max())


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes())
@settings(max_examples=40)
def test_momentum_and_center_of_mass(method: vv.Method, scene: vv.Scene) -> None:
    """Linear invariants: every method keeps them to round-off."""
    table = run(scene, method).conservation()
    # Worst: 9e-16 and 1.9e-15.
    assert table.momentum.max * table.momentum.scale < 4e-15
    assert table.center_of_mass.max * table.center_of_mass.scale < 8e-15


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes(), about=arrays((3,), -2.0, 2.0))
@settings(max_examples=40)
def test_angular_momentum(method: vv.Method, scene: vv.Scene, about: NDArray[np.float64]) -> None:
    """A quadratic invariant: symplectic methods keep it to round-off, the others to their order."""
    drift = run(scene, method).conservation(about=about).angular_momentum
    # Worst: 2.0e-15 symplectic, 1.1e-11 adaptive, 3.5e-9 RK4.
    bound = 8e-15 if method.symplectic else within(method, 4e-11) if method.adaptive else 1.5e-8
    assert drift.max * drift.scale < bound


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes())
@settings(max_examples=40)
def test_energy_within_the_methods_own_bound(method: vv.Method, scene: vv.Scene) -> None:
    """Adaptive: a few tolerances. Fixed steps: C hᵖ, and a symplectic method's error falls by 2ᵖ when h is halved."""
    drift = run(scene, method).conservation().energy
    error = drift.max * drift.scale
    if method.adaptive:
        # Worst: 6.3e-12.
        assert error < within(method, 2.5e-11)
        return
    half = run(scene, method, dt=step(method) / 2).conservation().energy
    error_of_half = half.max * half.scale
    # Worst: 1.1e-3, 1.8e-7, 2.4e-6 and 4.9e-15, which is (2.2 h)², (1.3 h)⁴, (2.5 h)⁴ and round-off; the multistep
    # method's 3.1e-10 and 4e-14 are (48 h)¹³.
    rate = (60.0 if method.name == "stormer13" else 3.5) * step(method)
    assert error < rate**method.order + 1e-14
    assert error_of_half < (rate / 2) ** method.order + 1e-14
    if method.symplectic:
        # Worst: 1.01.
        assert error_of_half <= 1.05 * error / 2.0**method.order + 1e-14


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes(), velocity=arrays((3,), -2.0, 2.0), origin=arrays((3,), -2.0, 2.0))
@settings(max_examples=25)
def test_galilean_invariance(
    method: vv.Method, scene: vv.Scene, velocity: NDArray[np.float64], origin: NDArray[np.float64]
) -> None:
    here, there = run(scene, method), run(scene.in_frame(velocity=velocity, origin=origin), method)
    back = there.position + origin + np.multiply.outer(there.t, velocity)[:, None]
    # The adaptive method chooses other steps in another frame: then its tolerance, not the rounding, tells.
    # Worst: 3.1e-15, adaptive 1.2e-11.
    assert distance(back, here.position) < (within(method, 5e-11) if method.adaptive else 1.2e-14)
    assert distance(there.velocity + velocity, here.velocity) < (within(method, 5e-11) if method.adaptive else 1.2e-14)


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes(), axis=arrays((3,), -1.0, 1.0), angle=st.floats(-3.0, 3.0))
@settings(max_examples=25)
def test_rotational_invariance(method: vv.Method, scene: vv.Scene, axis: NDArray[np.float64], angle: float) -> None:
    axis = axis / size if (size := float(np.linalg.norm(axis))) > 1e-3 else np.array([0.0, 0.0, 1.0])
    cross = np.cross(np.eye(3), axis)
    matrix = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    here, there = run(scene, method), run(scene.rotated(matrix), method)
    # Worst: 9e-16; adaptive 4e-15, but a step at the brink of rejection may tip, and then the tolerance tells.
    assert distance(here.position @ matrix.T, there.position) < (within(method, 5e-11) if method.adaptive else 4e-15)


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
    assert distance(here.position, there.position / length) < (within(method, 5e-11) if method.adaptive else 4e-15)


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes())
@settings(max_examples=25)
def test_motion_reversed_retraces_its_path(method: vv.Method, scene: vv.Scene) -> None:
    there = run(scene, method).final.reversed()
    back = run(there, method).final
    # Worst: 3.9e-16 reversible, 1.0e-12 adaptive, 2.8e-8 RK4.
    bound = 2e-15 if method.reversible else within(method, 5e-12) if method.adaptive else 1.2e-7
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


@given(
    masses=st.tuples(st.floats(0.1, 2.0), st.floats(0.0, 2.0)),
    apart=arrays((3,), 0.5, 2.0),
    velocity=arrays((2, 3), -1.0, 1.0),
    end=st.floats(-2.0, 2.0).filter(lambda t: abs(t) > 1e-3),
)
@settings(max_examples=100)
def test_two_bodies_closed_form_and_integration(
    masses: tuple[float, float], apart: NDArray[np.float64], velocity: NDArray[np.float64], end: float
) -> None:
    """Kepler's solution against DOP853, over ellipses and hyperbolas that stay apart."""
    bodies = vv.Particles(masses, np.stack([np.zeros(3), apart]), velocity)
    scene = vv.Scene(bodies, vv.Gravity(0.25))
    closed = scene.run(t=end)
    assert closed.plan.closed_form
    assert closed.stats.steps == 0
    try:
        integrated = scene.run(t=end, method="dop853", rtol=1e-13)
    except vv.CloseEncounter:
        # Head-on: only the closed form passes.
        assume(False)
    # A grazing pericentre amplifies the tolerance; the energy says how close they came.
    relative = closed.velocity[:, 1] - closed.velocity[:, 0]
    amplification = 1.0 + float(np.abs(relative).max()) ** 4
    assert distance(closed.position, integrated.position) < 2e-10 * amplification


@given(
    state=arrays((2, 4, 3), -10.0, 10.0),
    g=arrays((3,), -10.0, 10.0),
    end=st.floats(-10.0, 10.0).filter(lambda t: abs(t) > 1e-3),
    method=st.sampled_from(METHODS),
)
def test_uniform_field_closed_form_and_integration(
    state: NDArray[np.float64], g: NDArray[np.float64], end: float, method: vv.Method
) -> None:
    """Every method of order 2 and more is exact on a parabola, whatever its step."""
    scene = vv.Scene(vv.Particles(np.ones(4), *state), vv.UniformField(g))
    closed = scene.run(t=end)
    assert closed.plan.closed_form
    arguments: dict[str, object] = {"rtol": 1e-9} if method.adaptive else {"dt": end / 7}
    integrated = scene.run(t=end, method=method.name, **arguments)  # type: ignore[arg-type]
    # Positions reach 10 + 100 + 500: a few roundings of 600.
    assert distance(closed.position, integrated.position) < 2e-12
    assert distance(closed.velocity, integrated.velocity) < 2e-13


@given(velocity=arrays((3, 3), -10.0, 10.0), position=arrays((3, 3), -10.0, 10.0), end=st.floats(-100.0, 100.0))
def test_force_free_motion(velocity: NDArray[np.float64], position: NDArray[np.float64], end: float) -> None:
    """Momentum constant to the last bit; straight lines rounded once from the exact product and sum."""
    out = vv.Scene(vv.Particles([1.0, 0.0, 2.0], position, velocity)).run(t=[0.0, end] if end else 0.0)
    assert np.array_equal(out.velocity[-1], velocity)
    expected = position.astype(np.longdouble) + velocity.astype(np.longdouble) * np.longdouble(end)
    spacing = np.spacing(np.abs(position) + np.abs(velocity * end))
    assert np.all(np.abs(out.position[-1] - expected.astype(np.float64)) <= spacing)


@pytest.mark.parametrize(
    "potential",
    [vv.potentials.Coulomb(k=-1.0), vv.potentials.Yukawa(k=-1.0, length=2.0), vv.potentials.LennardJones(0.5, 1.0)],
    ids=repr,
)
@given(direction=arrays((3,), -1.0, 1.0), velocity=arrays((3,), -0.5, 0.5), distance=st.floats(1.0, 2.0))
@settings(max_examples=40)
def test_central_fields(
    potential: vv.potentials.Potential,
    direction: NDArray[np.float64],
    velocity: NDArray[np.float64],
    distance: float,
) -> None:
    """Energy and angular momentum about the centre, and a motion that stays in its plane."""
    direction = direction + np.array([2.0, 0.0, 0.0])
    position = distance * direction / np.linalg.norm(direction)
    # Enough sideways motion to keep away from the centre.
    velocity = velocity + 0.7 * np.cross([0.0, 0.0, 1.0], direction)
    scene = vv.Scene(vv.Particles([1.0], position[None], velocity[None]), vv.CentralField(potential))
    out = scene.run(t=np.linspace(0.0, 2.0, 5), method="dop853", rtol=1e-12)
    table = out.conservation()
    assert table.energy.max * table.energy.scale < 1e-9
    assert table.angular_momentum.max * table.angular_momentum.scale < 1e-9
    normal = scene.invariants().angular_momentum
    assert np.abs(out.position[:, 0] @ (normal / np.linalg.norm(normal))).max() < 1e-10
