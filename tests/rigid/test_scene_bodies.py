"""Rigid bodies in a scene against motions that were found without the package (``reference_dynamics``)."""

import ctypes
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import reference_dynamics as reference
from high_order import angle_between

import visviva as vv

KEPT = json.loads((Path(__file__).parent / "dynamics_reference.json").read_text(encoding="utf-8"))
EPSILON = np.finfo(float).eps
NUMBERS = ctypes.POINTER(ctypes.c_double)


@ctypes.CFUNCTYPE(None, ctypes.c_double, NUMBERS, NUMBERS, NUMBERS)
def motor(t, orientation, angular_velocity, torque):
    torque[0] = 0.25 - 0.125 * angular_velocity[0]
    torque[1] = 0.5 * t * orientation[3]
    torque[2] = 0.5 * orientation[0] - 0.0625 * t * angular_velocity[2]


def scene_of(name: str) -> vv.Scene:
    """The scene of a case."""
    case = KEPT[name]["case"]
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


def errors(out: vv.Trajectory, name: str) -> dict[str, float]:
    """The largest error of each column, of angular velocities and velocities relative to the largest."""
    known = states(name)
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
    assert max(errors(out, name).values()) <= bound, errors(out, name)
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
        errors(scene.run(t=times, method=method, dt=times[0] / n), name)["orientation"] for n in (steps, 2 * steps)
    ]
    assert found[0] < 0.1
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
