"""Each row of the plan: what it promises, and that the work is really left out."""

import subprocess
import sys
import textwrap
import time
from typing import Any

import numpy as np
import pytest

import visviva as vv

DOP853_STAGES = 12
DENSE_STAGES = 3
# The steps of dop853 with which the multistep method starts.
STARTER_STEPS = 12


def some(count: int, seed: int = 1, masses: float = 0.0) -> vv.Particles:
    random = np.random.default_rng(seed)
    return vv.Particles(np.full(count, masses), random.uniform(-1, 1, (count, 3)), random.uniform(-1, 1, (count, 3)))


def join(*parts: vv.Particles) -> vv.Particles:
    return vv.Particles(
        *(np.concatenate([getattr(p, name) for p in parts]) for name in ("mass", "position", "velocity"))
    )


STARS = vv.Particles(
    [1.0, 0.8, 0.1],
    [[-1.0, 0.0, 0.0], [1.0, 0.2, 0.1], [6.0, 0.0, 1.0]],
    [[0.0, -0.5, 0.0], [0.0, 0.6, 0.1], [0.0, 0.5, 0.0]],
)
CLOSED = {
    "no force": vv.Scene(some(4)),
    "uniform field": vv.Scene(some(4, masses=1.0), vv.UniformField([0.0, 0.0, -9.81])),
    "two bodies": vv.problems.kepler(e=0.3).scene,
    "one massive body": vv.Scene(
        join(vv.Particles([1.0], np.zeros((1, 3)), np.zeros((1, 3))), some(20)), vv.Gravity(1.0)
    ),
    "fixed center": vv.Scene(some(4, masses=1.0), vv.CentralField(vv.potentials.Coulomb(k=1.0))),
    "linear drag": vv.Scene(some(4, masses=1.0), vv.LinearDrag(2.0)),
    "linear drag and a uniform field": vv.Scene(some(4), vv.LinearDrag(2.0), vv.UniformField([0.0, 0.0, -9.81])),
    "magnetic field": vv.Scene(some(4, masses=1.0), vv.UniformMagneticField([0.0, 1.0, 2.0])),
    "damped, driven oscillator": vv.Scene(
        some(4, masses=1.0), vv.Harmonic(3.0), vv.LinearDrag(2.0), vv.DrivenForce([1.0, 0.0, 0.0], 3.0**0.5)
    ),
    "rotating frame": vv.Scene(some(4), vv.RotatingFrame([0.5, 0.0, -1.0])),
    "quadratic drag": vv.Scene(some(4, masses=1.0), vv.QuadraticDrag(1.5), vv.LinearDrag(2.0)),
    "electric and magnetic field": vv.Scene(
        some(4, masses=1.0), vv.UniformElectricField([3.0, 0.0, -1.0]), vv.UniformMagneticField([0.0, 1.0, 2.0])
    ),
    "crossed fields": vv.Scene(
        some(4, masses=1.0), vv.UniformField([3.0, 0.0, -1.0]), vv.UniformMagneticField([0.0, 1.0, 2.0])
    ),
}


@pytest.mark.parametrize("name", CLOSED)
def test_a_closed_form_takes_no_step(name: str) -> None:
    scene = CLOSED[name]
    out = scene.run(t=np.linspace(0.0, 2.0, 7))
    assert out.plan.closed_form
    assert "stepping" in dict(out.plan.skipped)
    assert (out.stats.steps, out.stats.rejected, out.stats.evaluations) == (0, 0, 0)
    # And it is the same motion; a named method is the method that runs.
    named = scene.run(t=np.linspace(0.0, 2.0, 7), method="dop853", rtol=1e-13)
    assert named.stats.evaluations > 0
    assert np.abs(named.position - out.position).max() < 1e-9


def test_softening_and_other_forces_are_not_closed_forms() -> None:
    pair = vv.problems.kepler(e=0.3).scene.particles
    assert not vv.Scene(pair, vv.Gravity(1.0, softening=0.1)).plan(t=1.0).closed_form
    assert not vv.Scene(pair, vv.Gravity(1.0), vv.UniformField([0, 0, 1.0])).plan(t=1.0).closed_form
    assert not vv.Scene(pair, vv.CentralField(vv.potentials.Yukawa(k=1.0, length=1.0))).plan(t=1.0).closed_form
    assert not vv.Scene(pair, vv.QuadraticDrag(1.0), vv.UniformMagneticField([1.0, 0.0, 0.0])).plan(t=1.0).closed_form
    assert not vv.Scene(pair, vv.LinearDrag(1.0), vv.Gravity(1.0)).plan(t=1.0).closed_form


METHODS: list[tuple[vv.Method, dict[str, Any]]] = [
    (method, {"rtol": 10.0 ** -min(10, 2 * method.order)} if method.adaptive else {"dt": 0.01})
    for method in vv.methods()
]
NAMES = [method.name for method, _ in METHODS]


def multistep(method: vv.Method) -> bool:
    """One evaluation per step and an order above 2: no explicit one-step method can do that."""
    return method.stages == 1 and method.order > 2 and not method.adaptive


@pytest.mark.parametrize(("method", "step"), METHODS, ids=NAMES)
@pytest.mark.parametrize("passives", [1, 5, 64, 65, 200])
@pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")  # some come too near to a star for the step
def test_massless_bodies_never_touch_the_massive(method: vv.Method, step: dict[str, Any], passives: int) -> None:
    alone = vv.Scene(STARS, vv.Gravity(1.0)).run(t=[0.5, 1.0], method=method.name, **step)
    out = vv.Scene(join(STARS, some(passives)), vv.Gravity(1.0)).run(t=[0.5, 1.0], method=method.name, **step)
    assert np.array_equal(out.position[:, :3], alone.position)
    assert np.array_equal(out.velocity[:, :3], alone.velocity)
    assert out.plan.pairs_per_evaluation == 3 + 3 * passives
    # The others integrate the massless bodies apart.
    if not method.adaptive and not multistep(method):
        assert out.stats.evaluations == alone.stats.evaluations


@pytest.mark.parametrize(("method", "step"), METHODS, ids=NAMES)
@pytest.mark.parametrize("far", [40.0, 1e6])
def test_not_even_one_far_away(method: vv.Method, step: dict[str, Any], far: float) -> None:
    """The plan's units are then others; nothing but powers of two may come of that."""
    alone = vv.Scene(STARS, vv.Gravity(1.0)).run(t=[0.5, 1.0], method=method.name, **step)
    comet = vv.Particles([0.0], [[far, 1.0, 2.0]], [[0.0, 0.1, 0.0]])
    out = vv.Scene(join(STARS, comet), vv.Gravity(1.0)).run(t=[0.5, 1.0], method=method.name, **step)
    assert np.array_equal(out.position[:, :3], alone.position)
    assert np.array_equal(out.velocity[:, :3], alone.velocity)


@pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")  # some come too near to a star for the step
def test_time_grows_linearly_with_massless_bodies() -> None:
    """Sixteen times the massless bodies: sixteen times the time if no pair of them is formed, 256 times if one were.

    The bound is the geometric mean of both. A machine that is busy with other things takes its time from both in turn,
    and of many turns the least counts, so it does not reach a factor of four.
    """

    def seconds(passives: int) -> float:
        return scenes[passives].run(t=0.5, method="leapfrog", dt=0.01, threads=1).stats.seconds

    scenes = {passives: vv.Scene(join(STARS, some(passives)), vv.Gravity(1.0)) for passives in (500, 8_000)}
    turns = [(seconds(500), seconds(8_000)) for _ in range(12)]
    few, many = (min(turn[i] for turn in turns) for i in range(2))
    assert many < 64 * few


def test_particles_that_do_not_interact_run_as_if_alone() -> None:
    field = vv.CentralField(vv.potentials.Yukawa(k=1.0, length=1.0))
    bodies = some(19, masses=1.0)
    out = vv.Scene(bodies, field).run(t=[0.3, 2.0], method="dop853", rtol=1e-10)
    evaluations = steps = 0
    for i in range(19):
        one = vv.Particles(bodies.mass[i : i + 1], bodies.position[i : i + 1], bodies.velocity[i : i + 1])
        alone = vv.Scene(one, field).run(t=[0.3, 2.0], method="dop853", rtol=1e-10)
        assert np.array_equal(out.position[:, i : i + 1], alone.position)
        assert np.array_equal(out.velocity[:, i : i + 1], alone.velocity)
        evaluations += alone.stats.evaluations
        steps += alone.stats.steps
    assert (out.stats.evaluations, out.stats.steps) == (evaluations, steps)
    assert out.plan.pairs_per_evaluation == 0


@pytest.mark.parametrize("count", [3, 8, 9, 40])
@pytest.mark.parametrize(("method", "step"), [("kahan_li8", {"dt": 0.01}), ("dop853", {"rtol": 1e-10})])
def test_a_plane_has_the_bits_of_space(count: int, method: str, step: dict[str, Any]) -> None:
    bodies = some(count, masses=1.0)
    position, velocity = bodies.position * [1, 1, 0], bodies.velocity * [1, 1, 0]
    flat = vv.Particles(bodies.mass, position, velocity)
    gravity = vv.Gravity(0.1, softening=0.3)
    plane = vv.Scene(flat, gravity).run(t=[0.1, 0.5], method=method, **step)
    assert "the z components" in dict(plane.plan.skipped)
    # A massless body above the plane: now all three components are computed.
    above = vv.Particles([0.0], [[0.0, 0.0, 1.0]], [[0.0, 0.0, 0.0]])
    space = vv.Scene(join(flat, above), gravity).run(t=[0.1, 0.5], method=method, **step)
    assert "the z components" not in dict(space.plan.skipped)
    assert np.array_equal(plane.position, space.position[:, :count])
    assert np.array_equal(plane.velocity, space.velocity[:, :count])
    assert not plane.position[..., 2].any()


def test_columns_that_are_not_asked_for_are_not_there() -> None:
    scene = vv.Scene(STARS, vv.Gravity(1.0))
    run: dict[str, Any] = {"t": np.linspace(0.0, 1.0, 5), "method": "leapfrog", "dt": 0.01}
    full = scene.run(**run, record=("position", "velocity", "energy", "momentum"))
    for record in [("position",), ("velocity",), ("energy",), ("position", "energy")]:
        out = scene.run(**run, record=record)
        assert set(out.recorded) == set(record)
        for name in record:
            assert np.array_equal(getattr(out, name), getattr(full, name))
        for name in {"position", "velocity"} - set(record):
            assert f"the {name} column" in dict(out.plan.skipped)
            with pytest.raises(vv.InvalidInput):
                getattr(out, name)


def test_evaluations_of_an_adaptive_run_are_counted_to_the_last_one() -> None:
    """Two to start; eleven for a step tried and one more if it is kept; three more
    only for steps with an output inside."""
    scene = vv.Scene(STARS, vv.Gravity(1.0))
    end_only = scene.run(t=5.0, method="dop853", rtol=1e-10)
    steps, rejected = end_only.stats.steps, end_only.stats.rejected
    plain = 2 + (DOP853_STAGES - 1) * (steps + rejected) + steps
    assert end_only.stats.evaluations == plain
    assert "dense output" in dict(end_only.plan.skipped)
    one = scene.run(t=[2.5, 5.0], method="dop853", rtol=1e-10)
    assert one.stats.evaluations == plain + DENSE_STAGES
    twice_in_a_step = scene.run(t=[2.5, 2.5 + 1e-9, 5.0], method="dop853", rtol=1e-10)
    assert twice_in_a_step.stats.evaluations == plain + DENSE_STAGES
    crowded = scene.run(t=np.linspace(0.0, 5.0, 5001), method="dop853", rtol=1e-10)
    assert crowded.stats.evaluations == plain + DENSE_STAGES * steps
    assert np.array_equal(crowded.position[-1], end_only.position[-1])
    assert np.array_equal(crowded.velocity[-1], end_only.velocity[-1])


@pytest.mark.parametrize("method", [m for m in vv.methods() if not m.adaptive], ids=lambda m: m.name)
def test_evaluations_of_a_fixed_step_run(method: vv.Method) -> None:
    """One per stage; a method that uses the end of a step again at the next start needs one more in all, a multistep
    method one more and its start. Outputs on nodes are free."""
    scene = vv.Scene(STARS, vv.Gravity(1.0))
    out = scene.run(t=1.0, method=method.name, dt=1 / 64)
    more = out.stats.evaluations - 64 * method.stages
    if multistep(method):
        assert more == 1 + STARTER_STEPS * (DOP853_STAGES - 1)
    else:
        assert more in (0, 1)
    nodes = scene.run(t=np.arange(65) / 64, method=method.name, dt=1 / 64)
    assert nodes.stats.evaluations == out.stats.evaluations
    between = scene.run(t=[0.3, 1.0], method=method.name, dt=1 / 64)
    substep = DOP853_STAGES if multistep(method) else method.stages + 1
    assert 0 < between.stats.evaluations - out.stats.evaluations <= substep
    for busy in (nodes, between):
        assert np.array_equal(busy.position[-1], out.position[-1])
        assert np.array_equal(busy.velocity[-1], out.velocity[-1])
    # A time on a node gives the node's bits, whatever the end of the run.
    assert np.array_equal(nodes.position[20], scene.run(t=20 / 64, method=method.name, dt=1 / 64).position[-1])


def test_dense_output_reads_the_same_whoever_else_is_read() -> None:
    scene = vv.Scene(STARS, vv.Gravity(1.0))
    many = scene.run(t=np.linspace(0.0, 5.0, 501), method="dop853", rtol=1e-10)
    few = scene.run(t=np.array([many.t[123], many.t[124], many.t[400], 5.0]), method="dop853", rtol=1e-10)
    assert np.array_equal(few.position[:3], many.position[[123, 124, 400]])


def test_ten_million_steps_do_not_grow_in_memory() -> None:
    """Beyond the two recorded states: a byte per step would be 10 MB.

    In a process of its own: the peak of this one may be anything by now, and nothing below it would show.
    """
    code = """
        import resource, visviva as vv
        scene = vv.problems.kepler(e=0.3).scene
        scene.run(t=1.0, method="leapfrog", dt=1e-3)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        out = scene.run(t=[50.0, 100.0], method="leapfrog", dt=1e-5)
        print(out.stats.steps, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
    """
    command = [sys.executable, "-c", textwrap.dedent(code)]
    began = time.perf_counter()
    steps, grown = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    assert int(steps) == 10_000_000
    assert int(grown) < 2048  # kB
    assert time.perf_counter() - began < 60


@pytest.mark.parametrize("count", [2, 3])
def test_of_few_bodies_a_multistep_method_skips_the_first(count: int) -> None:
    """Relative to it, the center of mass moving uniformly: the same motion as with all steps, to round-off; the same
    bits whatever the massless bodies beside it."""
    gravity = vv.Gravity(1.0, softening=0.1)
    stars = vv.Particles(STARS.mass[:count], STARS.position[:count], STARS.velocity[:count])
    run: dict[str, Any] = {"t": [0.5, 1.0, 2.015], "method": "stormer13", "dt": 0.01}
    few = vv.Scene(stars, gravity).run(**run)
    assert "steps of the first massive body" in dict(few.plan.skipped)
    # What accelerates all alike moves the origin, and the bodies relative to it as before.
    falling = vv.Scene(stars, gravity, vv.UniformField([1e-300, 0.0, 0.0]))
    assert "steps of the first massive body" in dict(falling.plan(**run).skipped)
    # A field that differs from place to place, and does nothing to speak of: now nothing is closed.
    whole = vv.Scene(stars, gravity, vv.CentralField(vv.potentials.Coulomb(k=1e-300), [50.0, 0.0, 0.0])).run(**run)
    assert "steps of the first massive body" not in dict(whole.plan.skipped)
    np.testing.assert_allclose(few.position, whole.position, rtol=0, atol=1e-14)
    np.testing.assert_allclose(few.velocity, whole.velocity, rtol=0, atol=1e-14)
