"""Rigid bodies in a scene against motions that were found without the package (``reference_dynamics``)."""

import ctypes
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import reference_dynamics as reference
from drawn_bodies import drawn_case
from high_order import angle_between

import visviva as vv

KEPT: dict[str, Any] = json.loads((Path(__file__).parent / "dynamics_reference.json").read_text(encoding="utf-8"))
EPSILON = np.finfo(float).eps
NUMBERS = ctypes.POINTER(ctypes.c_double)


@ctypes.CFUNCTYPE(None, ctypes.c_double, NUMBERS, NUMBERS, NUMBERS)
def motor(t, orientation, angular_velocity, torque):
    torque[0] = 0.25 - 0.125 * angular_velocity[0]
    torque[1] = 0.5 * t * orientation[3]
    torque[2] = 0.5 * orientation[0] - 0.0625 * t * angular_velocity[2]


def scene_of(name: str) -> vv.Scene:
    return made(KEPT[name]["case"])


def made(case: dict[str, Any]) -> vv.Scene:
    """The scene of a case."""
    bodies = dict(case["bodies"])
    if "pivot" in bodies:
        bodies["pivot"] = [[np.nan] * 3 if point is None else point for point in bodies["pivot"]]
    parts: list[Any] = [vv.Particles(**case["particles"])] if "particles" in case else []
    for kind, arguments in case["forces"]:
        given = arguments | {"function": motor} if kind == "CompiledTorque" else arguments
        parts.append(getattr(vv, kind)(**given))
    return vv.Scene(vv.RigidBodies(**bodies), *parts)


def states(name: str) -> dict[str, np.ndarray]:
    return {column: np.array(values) for column, values in KEPT[name]["states"].items()}


def errors(out: vv.Trajectory, known: dict[str, np.ndarray]) -> dict[str, float]:
    """The largest error of each column, of angular velocities and velocities relative to the largest."""
    found = {"orientation": float(angle_between(out.orientation, known["orientation"]).max())}
    for column in ("position", "velocity", "angular_velocity"):
        size = max(1.0, np.abs(known[column]).max())
        found[column] = float(np.abs(getattr(out, column) - known[column]).max() / size)
    return found


# For each case a method and a step with which the error of the method is below what rounding leaves of some thousand
# steps. The top turns by 300 rad, with some ε of each; where forces look at velocities there is rk4 alone.
STEPS = {
    "free_asymmetric": ("kahan_li8", 0.05, 4e-15),
    "bruls_cardona_top": ("kahan_li8", 0.01, 5e-13),
    "asymmetric_top": ("kahan_li8", 0.005, 1e-14),
    "physical_pendulum": ("kahan_li8", 0.01, 2e-15),
    "gravity_gradient": ("kahan_li8", 0.02, 5e-15),
    "binary": ("kahan_li8", 0.01, 2e-15),
    "spring_to_a_place": ("kahan_li8", 0.0025, 2e-14),
    "damped_springs_between_bodies": ("rk4", 0.0001, 4e-14),
    "rotational_drag": ("rk4", 0.00025, 2e-14),
    "torque_along_body_axes": ("kahan_li8", 0.01, 4e-15),
    "torque_along_axes_of_space": ("kahan_li8", 0.01, 5e-15),
    "compiled_torque": ("rk4", 0.00025, 2e-14),
    "particles_about_a_body": ("kahan_li8", 0.01, 2e-15),
    "spring_to_a_particle": ("kahan_li8", 0.01, 1e-14),
    "everything": ("rk4", 0.0001, 2e-14),
}


def test_every_case_is_run() -> None:
    assert STEPS.keys() == KEPT.keys()


@pytest.mark.parametrize("name", KEPT)
def test_motions_found_elsewhere(name: str) -> None:
    method, dt, bound = STEPS[name]
    out = scene_of(name).run(t=KEPT[name]["case"]["times"], method=method, dt=dt)
    assert max(errors(out, states(name)).values()) <= bound, errors(out, states(name))
    # To two roundings of the division by the length.
    np.testing.assert_allclose(np.linalg.norm(out.orientation, axis=-1), 1.0, rtol=0, atol=4 * EPSILON)


@pytest.mark.parametrize("name", [name for name, (method, _, _) in STEPS.items() if method != "rk4"])
def test_runs_lead_back(name: str) -> None:
    """From the last state that was found elsewhere back to the start, made anew of its numbers."""
    case, known, (method, dt, bound) = KEPT[name]["case"], states(name), STEPS[name]
    scene, count = scene_of(name), len(case["bodies"]["mass"])
    bodies = scene.rigid_bodies
    assert bodies is not None
    last = {column: known[column][-1, -count:] for column in known}
    there = vv.RigidBodies(
        **{argument: getattr(bodies, argument) for argument in ("mass", "moments", "inertia", "pivot")}, **last
    )
    points = {column: known[column][-1, :-count] for column in ("position", "velocity")}
    particles = [vv.Particles(case["particles"]["mass"], **points)] if "particles" in case else []
    back = vv.Scene(there, *particles, *scene.forces, *scene.body_forces, t0=case["times"][-1])
    out = back.run(t=0.0, method=method, dt=dt)
    # The rounding of the state to floats is amplified, too.
    bound *= 20
    assert float(angle_between(out.orientation[-1], bodies.orientation).max()) <= bound
    np.testing.assert_allclose(out.position[-1], scene.particles.position, rtol=0, atol=bound)
    size = max(1.0, np.abs(bodies.angular_velocity).max())
    np.testing.assert_allclose(out.angular_velocity[-1], bodies.angular_velocity, rtol=0, atol=bound * size)


# Steps of the first span with which errors are those of the order, clear of rounding: on attitude, against the motion
# found elsewhere.
@pytest.mark.parametrize(
    ("name", "method", "order", "steps"),
    [
        ("asymmetric_top", "leapfrog", 2, 400),
        ("asymmetric_top", "leapfrog_dkd", 2, 400),
        ("asymmetric_top", "yoshida4", 4, 100),
        ("asymmetric_top", "mclachlan4", 4, 50),
        ("asymmetric_top", "kahan_li6", 6, 30),
        ("asymmetric_top", "kahan_li8", 8, 10),
        ("asymmetric_top", "rk4", 4, 200),
        ("binary", "leapfrog", 2, 200),
        ("binary", "yoshida4", 4, 100),
        ("binary", "mclachlan4", 4, 50),
        ("binary", "kahan_li6", 6, 10),
        ("binary", "kahan_li8", 8, 3),
        ("binary", "rk4", 4, 100),
        ("spring_to_a_place", "leapfrog", 2, 400),
        ("spring_to_a_place", "yoshida4", 4, 200),
        ("spring_to_a_place", "mclachlan4", 4, 100),
        ("spring_to_a_place", "kahan_li6", 6, 60),
        ("spring_to_a_place", "kahan_li8", 8, 40),
        ("spring_to_a_place", "rk4", 4, 1600),
        ("bruls_cardona_top", "leapfrog", 2, 400),
        ("bruls_cardona_top", "yoshida4", 4, 100),
        ("torque_along_axes_of_space", "kahan_li6", 6, 5),
        ("everything", "rk4", 4, 200),
        ("compiled_torque", "rk4", 4, 100),
        ("rotational_drag", "rk4", 4, 100),
    ],
)
def test_orders_on_attitude(name: str, method: str, order: int, steps: int) -> None:
    scene, times = scene_of(name), KEPT[name]["case"]["times"]
    found = [
        errors(scene.run(t=times, method=method, dt=times[0] / n), states(name))["orientation"]
        for n in (steps, 2 * steps)
    ]
    # Small enough for the next order not to show: the worst is 1.1e-3, and the order then off by 0.13.
    assert found[0] < 4e-3
    assert np.log2(found[0] / found[1]) == pytest.approx(order, abs=0.15), found


@pytest.mark.parametrize("name", KEPT)
def test_columns_are_those_of_the_state(name: str) -> None:
    """Energy, momentum and angular momentum, as the reference has them of the same state."""
    case = KEPT[name]["case"]
    method, dt, bound = STEPS[name]
    out = scene_of(name).run(
        t=case["times"], method=method, dt=dt, record=("energy", "momentum", "angular_momentum", "kinetic_energy")
    )
    world = reference.World(case)
    world.start()
    start = world.energy(world.start())
    for at in range(len(case["times"])):
        x, v, turn, spin = (np.array(values[at]) for values in KEPT[name]["states"].values())
        y = [*x[world.free].ravel(), *v[world.free].ravel(), *turn.ravel(), *spin.ravel()]
        size = max(1.0, abs(start), float(out.kinetic_energy[at]))
        assert out.energy[at] == pytest.approx(world.energy(y), rel=0, abs=20 * bound * size)
        momenta, turning = world.momentum(y), world.angular_momentum(y)
        np.testing.assert_allclose(out.momentum[at], momenta, rtol=0, atol=20 * bound * max(1.0, np.abs(momenta).max()))
        size = max(1.0, np.abs(turning).max())
        np.testing.assert_allclose(out.angular_momentum[at], turning, rtol=0, atol=20 * bound * size)


@pytest.mark.parametrize("name", ["bruls_cardona_top", "spring_to_a_place", "spring_to_a_particle"])
def test_energy_does_not_drift(name: str) -> None:
    """Of a symplectic method with long steps: as far off in the second half of a long run as in the first."""
    first = KEPT[name]["case"]["times"][0]
    out = scene_of(name).run(t=np.linspace(0.0, 200 * first, 401), method="leapfrog", dt=first / 100, record="energy")
    off = np.abs(out.energy - out.energy[0])
    assert off[:200].max() > 0.0
    assert off[200:].max() < 1.5 * off[:200].max()


@pytest.mark.parametrize(
    ("method", "dt", "bound"),
    [("leapfrog", 0.2, 5e-15), ("moser_veselov8", 0.1, 2.5e-15), ("moser_veselov2", 0.1, 1.2e-14)],
)
def test_round_off_walks_at_random(method: str, dt: float, bound: float) -> None:
    """Of steps that keep the energy but for rounding: 200 000 of them, in 64 copies, by round numbers.

    Random walks of 7e-18 a step (longer ones, in parts) and of 3e-18 leave 3.1e-15 and 1.3e-15; roundings to one side
    left 1e-14 to 4e-14. Of order two 3e-20 a step are left, to one side, and twice that is allowed.
    """
    spins = np.array([3.0, 0.5, -0.9]) * (1.0 + 0.2 * np.random.default_rng(5).uniform(-1.0, 1.0, (64, 1, 3)))
    held = vv.Scene(vv.RigidBody(1.0, [0.6, 0.8, 1.0], angular_velocity=spins[0, 0], pivot=[0.0, 0.0, 0.0]))
    t = [0.0, 200_000 * dt]
    out = held.ensemble(angular_velocity=spins).run(t=t, method=method, dt=dt, record="energy")
    change = out.energy[:, 1] / out.energy[:, 0] - 1.0
    assert np.sqrt((change**2).mean()) <= bound


@pytest.mark.parametrize(
    "name", ["binary", "gravity_gradient", "spring_to_a_particle", "damped_springs_between_bodies"]
)
def test_what_bodies_do_to_each_other_adds_up_to_nothing(name: str) -> None:
    """Momentum and angular momentum by long steps: force and torque of each pair are opposite."""
    first, method = KEPT[name]["case"]["times"][0], STEPS[name][0]
    how = {"method": "leapfrog" if method != "rk4" else method, "dt": first / 100}
    out = scene_of(name).run(t=np.linspace(0.0, 100 * first, 101), **how, record=("momentum", "angular_momentum"))
    # A kick changes neither, but for rounding; of a Runge–Kutta method angular momentum has the error of the method.
    assert np.abs(out.momentum - out.momentum[0]).max() <= 4e-15
    bound = 4e-15 if method != "rk4" else 1e-6
    assert np.abs(out.angular_momentum - out.angular_momentum[0]).max() <= bound


@pytest.mark.parametrize("seed", range(16))
def test_drawn_scenes_move_as_the_reference(seed: int) -> None:
    """Whatever acts on whatever: against DOP853, which is good to 1e-11 or so here."""
    case, looking = drawn_case(seed)
    world, found = reference.by_dop853(case)
    known = {column: np.array(values) for column, values in reference.by_columns(world, found).items()}
    method, dt = ("rk4", 2e-4) if looking else ("kahan_li8", 2.5e-3)
    out = made(case).run(
        t=case["times"],
        method=method,
        dt=dt,
        record=("position", "velocity", "orientation", "angular_velocity", "energy", "angular_momentum"),
    )
    # Steps of rk4 have errors of 1e-11 where a spring is short.
    assert max(errors(out, known).values()) <= 1e-10, errors(out, known)
    for at, y in enumerate(found):
        assert out.energy[at] == pytest.approx(world.energy(y), rel=1e-10, abs=1e-9)
        np.testing.assert_allclose(out.angular_momentum[at], world.angular_momentum(y), rtol=1e-10, atol=1e-9)


MIRROR = np.diag([1.0, -1.0, 1.0])


@pytest.mark.parametrize("seed", range(8))
def test_drawn_scenes_in_a_mirror_and_in_other_units(seed: int) -> None:
    case, looking = drawn_case(100 + seed)
    case["forces"] = [each for each in case["forces"] if each[0] != "CompiledTorque"]
    scene, method = made(case), "rk4" if looking else "kahan_li6"
    here = scene.run(t=0.5, method=method, dt=0.01)
    there = scene.rotated(MIRROR).run(t=0.5, method=method, dt=0.01)
    # The mirror changes the order of roundings: some ε of each of 50 steps, amplified.
    np.testing.assert_allclose(there.position, here.position @ MIRROR, rtol=0, atol=1e-12)
    np.testing.assert_allclose(there.velocity, here.velocity @ MIRROR, rtol=0, atol=1e-11)
    # A spin is axial, and the mirrored body has its axes turned round: along them it is the same.
    np.testing.assert_allclose(there.angular_velocity, here.angular_velocity, rtol=0, atol=1e-11)
    seen = [vv.rigid.matrix(out.orientation) for out in (here, there)]
    np.testing.assert_allclose(seen[1], -MIRROR @ seen[0], rtol=0, atol=1e-12)
    other = scene.rescaled(length=1e3, mass=0.1, time=60.0).run(t=30.0, method=method, dt=0.6)
    np.testing.assert_allclose(other.position / 1e3, here.position, rtol=0, atol=1e-12)
    np.testing.assert_allclose(other.angular_velocity * 60.0, here.angular_velocity, rtol=0, atol=1e-11)
    if not looking:
        back = scene.with_state(
            here.position[-1],
            here.velocity[-1],
            orientation=here.orientation[-1],
            angular_velocity=here.angular_velocity[-1],
        ).reversed()
        again = back.run(t=0.5, method=method, dt=0.01)
        np.testing.assert_allclose(again.position[-1], here.position[0], rtol=0, atol=1e-12)
        np.testing.assert_allclose(again.angular_velocity[-1], -here.angular_velocity[0], rtol=0, atol=1e-11)


ROD_TURN = np.array([0.3, -0.2, 0.5, 0.8]) / np.linalg.norm([0.3, -0.2, 0.5, 0.8])


def rod(moment: float = 0.0, axes: np.ndarray | None = None, point: float = 0.5) -> vv.Trajectory:
    """A rod on a spring at its end, along these axes of the body."""
    to = np.array([0.0, 0.0, 0.0, 1.0]) if axes is None else axes
    body = vv.RigidBody(
        1.0,
        inertia=vv.rigid.rotate_tensor(np.diag([moment, 1 / 12, 1 / 12]), to),
        orientation=to * [-1, -1, -1, 1],
        angular_velocity=vv.rigid.rotate(to, [0.0, 1.0, 0.3]),
    )
    spring = vv.AttachedSpring(0, vv.rigid.rotate(to, [point, 0.0, 0.0]), 3.0, anchor=[1.0, 0.2, 0.4])
    return vv.Scene(body, spring).run(t=2.0, method="kahan_li8", dt=0.01)


def test_a_rod_is_the_limit_of_thin_bodies() -> None:
    straight = rod()
    for moment in (1e-6, 1e-9):
        # A thin body moves as the rod does, and its ends with it.
        np.testing.assert_allclose(rod(moment).position, straight.position, rtol=0, atol=1e-15)
    # How the thinnest spins about itself rounding leaves open, which nothing of this hangs on.
    with pytest.warns(vv.AccuracyWarning, match=r"the largest moment of rigid body 0 is .* times the least"):
        thinnest = rod(1e-12)
    np.testing.assert_allclose(thinnest.position, straight.position, rtol=0, atol=1e-15)
    leaning = rod(axes=ROD_TURN)
    np.testing.assert_allclose(leaning.position, straight.position, rtol=0, atol=1e-15)
    ends = [
        vv.rigid.rotate(out.orientation[-1, 0], along)
        for out, along in ((straight, [1.0, 0, 0]), (leaning, vv.rigid.rotate(ROD_TURN, [1.0, 0, 0])))
    ]
    np.testing.assert_allclose(*ends, rtol=0, atol=4e-15)


def test_what_would_turn_a_rod_about_its_axis_is_refused() -> None:
    ball = vv.RigidBody(1.0, [1.0, 1.0, 1.0], position=[3.0, 0.0, 0.0], name="ball")
    tensor = vv.rigid.rotate_tensor(np.diag([0.0, 1.0, 1.0]), ROD_TURN)
    for straight, to in (({"moments": [0.0, 1.0, 1.0]}, [0, 0, 0, 1]), ({"inertia": tensor}, ROD_TURN)):
        body = vv.RigidBody(1.0, **straight, name="rod")
        across, along = vv.rigid.rotate(to, [0.0, 1.0, -2.0]), vv.rigid.rotate(to, [0.1, 1.0, -2.0])
        for good in (
            vv.AppliedTorque(across, frame="body"),
            vv.AppliedTorque(along),
            vv.AppliedTorque(along, body="ball", frame="body"),
            vv.AttachedSpring("ball", [0, 0, 1], 1.0, to="rod", to_point=vv.rigid.rotate(to, [0.7, 0, 0])),
        ):
            vv.Scene(ball, body, good)
        for bad, argument in (
            (vv.AppliedTorque(along, frame="body"), "torque"),
            (vv.AppliedTorque(along, body="rod", frame="body"), "torque"),
            (vv.AttachedSpring("rod", along, 1.0, to="ball"), "point"),
            (vv.AttachedSpring("ball", [0, 0, 1], 1.0, to="rod", to_point=along), "to_point"),
        ):
            with pytest.raises(vv.InvalidInput, match="the axis of rod, a rod") as caught:
                vv.Scene(ball, body, bad)
            assert caught.value.argument == argument


def test_a_frame_that_turns_is_refused() -> None:
    """It turns bodies, too, by torques that nobody computes: a rod stayed as it was, with status OK."""
    rod = vv.RigidBody(1.0, [0.25, 0.25, 0.0])
    turning = vv.RotatingFrame([0, 0, 1.0])
    with pytest.raises(vv.InvalidInput, match="how it turns rigid bodies is not computed"):
        vv.Scene(rod, turning).run(1.0)
    with pytest.raises(vv.InvalidInput, match="how it turns rigid bodies is not computed"):
        vv.Scene(rod, turning).invariants()
    still = vv.Scene(rod, vv.RotatingFrame([0, 0, 0.0]))
    with pytest.raises(vv.InvalidInput, match="how it turns rigid bodies is not computed"):
        still.ensemble(parameters={"RotatingFrame": {"omega": [[0, 0, 0.0], [0, 0, 1.0]]}}).run(1.0)
    assert still.run(1.0).status == vv.Status.OK
