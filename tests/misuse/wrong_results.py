"""Calls of results and of parts of scenes that run, and for each argument what nobody may give it.

Nobody needs to make a result, but its class is public: what it cannot be made of is told, too.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from wrong_calls import NAN, PENDULUM, SCENE, VECTOR

import visviva as vv

NO_RUN = (3, "run", None, object())
NO_ARRAY = (3, "counts", None)
NO_MATRIX = (3, "x", None, np.eye(2), np.full((3, 3), NAN), np.diag([1.0, 2.0, 1.0]))
NO_PATH = (3, None, object(), [])

RUN = SCENE.run(t=[0.0, 0.5, 1.0])
COPIES = SCENE.ensemble(velocity=np.zeros((2, 2, 3)))
RUNS = COPIES.run(t=1.0)
SWINGING = PENDULUM.run(t=1.0)
SWINGS = PENDULUM.ensemble(position=[[0.1], [0.2]])
COUNTED = vv.scattering.monte_carlo(
    vv.potentials.HardSphere(1.0),
    beam_energy=1.0,
    masses=(1.0, 4.0),
    b_max=1.0,
    n_events=10,
    seed=1,
    tally=["cm_angle", ("lab_angle", "energy")],
)
TALLY, JOINT = COUNTED["cm_angle"], COUNTED["lab_angle", "energy"]
FOIL = vv.scattering.Foil("gold", 0.1)
CAME = FOIL.run("alpha", beam_energy=1e6, n_events=10, seed=1)
WHEEL = vv.Scene(vv.RigidBody(1.0, [1.0, 1.0, 2.0], name="wheel"))
TURNED = WHEEL.run(t=1.0)
SPRING = vv.AttachedSpring("wheel", [1.0, 0, 0], stiffness=2.0, anchor=[3.0, 0, 0])
SHIFT = {"position": [1.0, 0.0, 0.0], "velocity": [0.0, 0.0, 0.0]}
TURN = {"rotation": [[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]}
SOLVED = vv.solve_ivp(lambda t, y: -y, (0, 1), [1.0], dense_output=True).sol
SWEEP = vv.WorkPrecision("one", (vv.Point("a", 0.1, 1.0, 1e-3, 1e-4),))
FALL = vv.Particles([1.0], [[0.0, 0.0, 1.0]])


def fields(result: Any) -> dict[str, Any]:
    """What a dataclass was made of."""
    return {name: getattr(result, name) for name in result.__dataclass_fields__}


def plain(system: Callable[..., Any]) -> vv.Lagrangian:
    """A Lagrangian of a function, whose arguments are what is wrong."""
    return vv.Lagrangian(system, ["x"], position=[1.0])


CALLS: list[tuple[Callable[..., Any], dict[str, Any], dict[str, tuple[Any, ...]]]] = [
    (vv.Trajectory, {"scene": SCENE, "result": RUN._result}, {"scene": NO_RUN, "result": (3, {}, None)}),
    (vv.EnsembleTrajectory, {"ensemble": COPIES, "result": RUNS._result}, {"ensemble": NO_RUN, "result": (3, {})}),
    (vv.EnsembleScene, {"scene": SCENE, "velocity": np.zeros((2, 2, 3))}, {"scene": NO_RUN}),
    (vv.BodyMotion, {"run": RUN, "index": 1}, {"run": NO_RUN, "index": (2, -1, 0.5, "x", 10**30)}),
    (vv.BodyTurning, {"motion": TURNED["wheel"]}, {"motion": NO_RUN}),
    (vv.OdeSolution, fields(SOLVED), {"ts": NO_ARRAY}),
    (
        vv.generalized.GeneralizedTrajectory,
        {
            "system": PENDULUM,
            "result": SWINGS.run(t=1.0)._result,
            "asked": SWINGS.run(t=1.0)._asked,
        },
        {"system": NO_RUN, "result": (3, {}), "asked": (3, {}, None), "member": (2, -1, "x", None)},
    ),
    (vv.generalized.GeneralizedEnsemble, {"system": PENDULUM, "position": [[0.1]]}, {"system": NO_RUN}),
    (
        vv.generalized.GeneralizedEnsembleTrajectory,
        {"ensemble": SWINGS, "result": SWINGS.run(t=1.0)._result, "asked": SWINGS.run(t=1.0)._asked},
        {"ensemble": NO_RUN, "result": (3, {}), "asked": (3, {})},
    ),
    (vv.generalized.LegendreTransform, {"system": PENDULUM}, {"system": NO_RUN}),
    (
        vv.scattering.Tally,
        fields(TALLY),
        {"edges": NO_ARRAY, "counts": NO_ARRAY, "reachable": NO_ARRAY, "by_stratum": (3, "x")},
    ),
    (vv.scattering.JointTally, fields(JOINT), {"edges": NO_ARRAY, "flow": NO_ARRAY, "by_stratum": (3, "x")}),
    (vv.scattering.FoilTally, fields(CAME["stopped_depth"]), {"edges": NO_ARRAY, "sums": NO_ARRAY}),
    (vv.scattering.FoilResult, fields(CAME), {"sums": NO_ARRAY}),
    (CAME.fraction, {"fate": "stopped"}, {"fate": (3, "lost", None, np.zeros(2))}),
    (vv.Gravity(1.0).rotated, TURN, {"rotation": NO_MATRIX}),
    (vv.UniformField([0, 0, 1]).rotated, TURN, {"rotation": NO_MATRIX}),
    (WHEEL.rigid_bodies.rotated, TURN, {"rotation": NO_MATRIX}),
    (SPRING.rotated, TURN, {"rotation": NO_MATRIX}),
    (vv.AppliedTorque([1.0, 0, 0]).rotated, TURN, {"rotation": NO_MATRIX}),
    (vv.Harmonic(1.0).shifted, SHIFT, {"position": (3, *VECTOR), "velocity": (3, *VECTOR)}),
    (WHEEL.rigid_bodies.shifted, SHIFT, {"position": (3, *VECTOR), "velocity": (3, *VECTOR)}),
    (SPRING.shifted, SHIFT, {"position": (3, *VECTOR), "velocity": (3, *VECTOR)}),
    (vv.AppliedTorque([1.0, 0, 0]).shifted, SHIFT, {"position": (3, *VECTOR), "velocity": (3, *VECTOR)}),
    (SCENE.with_state, {}, {"position": (3, np.zeros((3, 3)), "x"), "velocity": ([1.0], "x"), "t0": ("now", NAN)}),
    (SWEEP.best, {"error": 1e-3}, {"error": ("small", None, NAN, [1.0, 2.0])}),
    (SWEEP.joined, {"points": []}, {"points": (3, None, ["a"], [SWEEP])}),
    (SWEEP.only, {"series": ["a"]}, {"series": (3, None, ["b"], [["a"]])}),
    (RUN.to_pandas, {"columns": "position"}, {"columns": (3, [], "speed", [["position"]], [None])}),
    (RUNS.to_pandas, {"columns": "position"}, {"columns": (3, [], {}, "speed")}),
    (SWINGING.to_xarray, {"columns": "position"}, {"columns": (3, [], "speed", [["position"]])}),
    (vv.Spring, {"i": [0, 1], "j": [1, 2], "k": 1.0}, {"j": ([0, 2], [1, 1])}),
    (vv.Damper, {"i": 0, "j": 1, "c": 1.0}, {"j": (0,)}),
    (vv.potentials.PowerLaw, {"k": 1.0, "n": 2}, {"n": (-2, 0, "x", NAN)}),
    (
        vv.ExpressionForce,
        {"potential": lambda r, v, t: r[0] ** 2},
        {
            "potential": (
                lambda r, v, t: v[0] ** 2,
                lambda r, v, t: r[3],
                lambda r, v, t: np.floor(r[0]),
                lambda r, v, t: np.where(r[0] > 0, 1, 2),
                lambda r, v, t: np.maximum(r[0], 0.0),
                lambda r, v, t: r[0] % 1,
                lambda r, v, t: r[0] * "x",
                lambda r, v, t: float(r[0]),
            )
        },
    ),
    (
        vv.scattering.total_cross_section,
        {"potential": vv.potentials.Coulomb(1.0), "energy": 1.0, "theta_min": 1.0},
        {"theta_min": ([], [0.1, 0.2], NAN, "x", -1.0, 4.0)},
    ),
    (
        vv.scattering.collision_integral,
        {"potential": vv.potentials.LennardJones(1.0, 1.0), "temperature": 1.0, "diameter": 1.0},
        {"orders": (3, None, (1,), "ab")},
    ),
    (vv.scattering.Foil, {"material": "gold", "thickness": 0.1}, {"material": (np.zeros(3), ["gold"])}),
    (
        plain,
        {"system": lambda q, v, t: v[0] ** 2},
        {"L": ()},
    ),
    (SCENE.run, {"t": 0.1, "method": "leapfrog", "dt": 0.01}, {"rtol": (1e-6, 1e-12, "x", NAN)}),
    (PENDULUM.run, {"t": 0.1, "method": "rk4", "dt": 0.01}, {"rtol": (1e-6, "x", NAN), "atol": (1e-6,)}),
    (SCENE.run, {"t": 0.1}, {"progress": (lambda done: None, 3, "bar"), "events": (lambda t: t,)}),
    (PENDULUM.run, {"t": 0.1}, {"save_every": (0.1, None), "save_to": ("runs",), "events": (lambda q: q[0],)}),
    (SWINGS.run, {"t": 0.1}, {"save_every": (0.1,), "save_to": ("runs",)}),
    (
        FOIL.run,
        {"ion": "alpha", "beam_energy": 1e6, "n_events": 10, "seed": 1},
        {"save_every": (5,), "collisions": ("many", 3, None, np.zeros(2)), "tally": ("angle", 3)},
    ),
    (
        vv.solve_ivp,
        {"fun": lambda t, y: -y, "t_span": (0, 1), "y0": [1.0]},
        {
            "fun": (lambda y: -y, lambda t, y: None, lambda t, y, k: -y, 3, 0, -1, 10**30),
            "events": (lambda y: y[0], lambda t, y: None, 3),
            "args": (3,),
            "max_step": (-1.0, -np.inf, "x", np.zeros(2)),
            "dense_output": (np.zeros(2),),
            "vectorized": (np.zeros(2),),
        },
    ),
]

# What has no right call that does not write: a path that is none.
PATHS: list[tuple[Callable[..., Any], tuple[Any, ...]]] = [
    (RUN.save, NO_PATH),
    (RUNS.save, NO_PATH),
    (SWINGING.save, NO_PATH),
    (SWINGS.run(t=1.0).save, NO_PATH),
    (COUNTED.save, NO_PATH),
    (vv.scattering.MonteCarlo.load, NO_PATH),
    (CAME.save, NO_PATH),
    (vv.scattering.FoilResult.load, NO_PATH),
    (vv.load, NO_PATH),
    (vv.resume, NO_PATH),
]
