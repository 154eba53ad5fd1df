"""Calls that run, and for each argument what nobody may give it."""

from collections.abc import Callable
from typing import Any

import numpy as np

import visviva as vv

NAN = float("nan")
NUMBER = ("one", NAN, [1.0, 2.0, 3.0, 4.0], None, 1j)
POSITIVE = (*NUMBER, -1.0, 0.0)
VECTOR = ("x", [1.0, 2.0], [NAN, 0.0, 0.0], {"x": 1.0})
NAME = (7, "no such name", None)
POTENTIAL = ("coulomb", None, 1.0, vv.potentials.Coulomb)

ONE = vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
ATTRACTING = vv.potentials.Coulomb(-1.0)
TWO = vv.Particles([1.0, 2.0], [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
SCENE = vv.Scene(TWO, vv.Gravity(G=1.0))
PENDULUM = vv.systems.pendulum()
K = vv.potentials.Coulomb(1.0)
SIGMA = {"energy": 1.0, "angle": 1.0}
UNIT = {"velocity1": [1, 0, 0], "velocity2": [0, 0, 0], "mass1": 1.0, "mass2": 2.0}
Q = [0.0, 0.0, 0.0, 1.0]

# Name, the call, arguments with which it runs, and the wrong ones.
CALLS: list[tuple[Callable[..., Any], dict[str, Any], dict[str, tuple[Any, ...]]]] = [
    (
        vv.Particles,
        {"mass": [1.0, 1.0], "position": np.zeros((2, 3))},
        {
            "mass": ([-1.0, 1.0], [NAN, 1.0], "heavy", [[1.0, 1.0]], None),
            "position": (np.zeros((3, 3)), np.zeros((2, 2)), "here", None, [[NAN, 0, 0], [0, 0, 0]]),
            "velocity": (np.zeros((1, 3)), "fast", np.full((2, 3), np.inf)),
            "names": (["a"], ["a", "a"], [1, 2], 5),
            "radius": (-1.0, "wide", [1.0, 2.0, 3.0], NAN),
        },
    ),
    (vv.Scene, {"particles": TWO}, {"forces": (1.0, "gravity", vv.Gravity, [1]), "t0": ("now", NAN, [0, 1], None)}),
    (
        SCENE.run,
        {"t": 1.0},
        {
            "t": ("end", NAN, [1.0, 0.5, 2.0], [], [[0.0, 1.0]], None),
            "method": ("leap_frog", "RK45", 3, None),
            "rtol": (0.0, -1.0, 1e-18, NAN, "small"),
            "record": ("speed", ("position", "speed"), 3, None),
            "events": ("apsis", 1, [1]),
            "threads": (0, -2, 1.5, "two"),
            "max_steps": (0, -1, 1.5, "many"),
            "progress": (3, "yes"),
        },
    ),
    (SCENE.run, {"t": 0.3, "method": "leapfrog", "dt": 0.01}, {"dt": (0.0, NAN, "small", [0.1], -0.1)}),
    (SCENE.plan, {"t": 1.0}, {"t": ("end", NAN, None), "method": ("leep", 1)}),
    (SCENE.advise, {"t": 1.0, "accuracy": 1e-6}, {"accuracy": (0.0, -1.0, NAN, "good")}),
    (SCENE.ensemble, {"position": np.zeros((4, 2, 3)) + TWO.position}, {"position": (np.zeros((2, 2)), "x", None)}),
    (SCENE.in_frame, {"velocity": [1, 0, 0]}, {"velocity": VECTOR}),
    (SCENE.invariants, {"about": [0, 0, 0]}, {"about": VECTOR}),
    (vv.Gravity, {"G": 1.0}, {"G": NUMBER, "softening": (-1.0, NAN, "soft")}),
    (vv.Coulomb, {"charge": 1.0, "k": 1.0}, {"charge": ("plus", NAN, None), "k": NUMBER}),
    (vv.Harmonic, {"k": 1.0}, {"k": NUMBER, "center": VECTOR}),
    (vv.LinearDrag, {"tau": 1.0}, {"tau": POSITIVE}),
    (vv.QuadraticDrag, {"coefficient": 1.0}, {"coefficient": (-1.0, NAN, "c", None)}),
    (vv.UniformField, {"g": [0, 0, -1]}, {"g": VECTOR}),
    (vv.UniformMagneticField, {"B": [0, 0, 1]}, {"B": VECTOR, "charge": ("e", NAN)}),
    (vv.RotatingFrame, {"omega": [0, 0, 1]}, {"omega": VECTOR}),
    (vv.DrivenForce, {"amplitude": [1, 0, 0], "frequency": 1.0}, {"amplitude": VECTOR, "frequency": NUMBER}),
    (vv.CentralField, {"potential": K}, {"potential": POTENTIAL, "center": VECTOR}),
    (vv.Spring, {"i": 0, "j": 1, "k": 1.0}, {"k": ("k", NAN, None), "i": (-1, 0.5, None)}),
    (
        vv.RigidBody,
        {"mass": 1.0, "moments": [1, 2, 2.5]},
        {"mass": POSITIVE, "moments": ([1, 2], [1, 1, 3], "m", [-1, 1, 1])},
    ),
    (vv.potentials.Yukawa, {"k": 1.0, "length": 1.0}, {"k": NUMBER, "length": POSITIVE}),
    (vv.potentials.LennardJones, {"epsilon": 1.0, "sigma": 1.0}, {"epsilon": POSITIVE, "sigma": POSITIVE}),
    (
        vv.potentials.Custom,
        {"function": lambda r: 1 / r, "r_min": 0.5, "r_max": 2.0},
        {"function": (1.0, None), "r_max": (0.1, NAN, "far")},
    ),
    (
        vv.scattering.deflect,
        {"potential": K, "energy": 1.0, "impact_parameter": 1.0},
        {"potential": POTENTIAL, "energy": (-1.0, 0.0, NAN, "e", None), "impact_parameter": (-1.0, NAN, "b", None)},
    ),
    (
        vv.scattering.cross_section,
        {"potential": K, **SIGMA},
        {
            "potential": POTENTIAL,
            "energy": (-1.0, NAN, "e", None),
            "angle": ("a", NAN, None),
            "frame": ("laboratory", 1),
        },
    ),
    (
        vv.scattering.lab_angle,
        {"cm_angle": 1.0, "mass_ratio": 0.5},
        {"cm_angle": ("a", NAN, None), "mass_ratio": (None, -1.0, NAN, "m")},
    ),
    (
        vv.scattering.monte_carlo,
        {"potential": K, "beam_energy": 1.0, "masses": (1.0, 4.0), "b_max": 5.0, "n_events": 10, "seed": 1},
        {
            "potential": POTENTIAL,
            "beam_energy": (-1.0, NAN, "e", None),
            "masses": ((1.0,), (1.0, -1.0), "ab", None),
            "b_max": (0.0, NAN, "b", None),
            "n_events": (-1, 1.5, "n", None),
            "seed": (-1, 0.5, "s", None),
            "tally": ("angle", 3),
            "bins": (0, -1, 1.5),
        },
    ),
    (vv.scattering.moderation, {"mass_ratio": 0.5}, {"mass_ratio": (-1.0, NAN, "m", None)}),
    (
        vv.scattering.Foil,
        {"material": "gold", "thickness": 0.1},
        {"material": ("unobtainium", 3, None), "thickness": POSITIVE},
    ),
    (
        vv.collisions.elastic,
        {**UNIT, "normal": [1, 0, 0]},
        {"mass1": (-1.0, NAN, "m", None), "velocity1": ("v", NAN, None)},
    ),
    (
        vv.collisions.restitution,
        {**UNIT, "coefficient": 0.5, "normal": [1, 0, 0]},
        {"coefficient": (-0.5, 1.5, NAN, "c"), "normal": VECTOR},
    ),
    (
        vv.orbits.period,
        {"mu": 1.0, "semi_major_axis": 1.0},
        {"mu": ("m", NAN, None), "semi_major_axis": ("a", NAN, None)},
    ),
    (
        vv.orbits.state,
        {"mu": 1.0, "pericenter": 1.0, "eccentricity": 0.5},
        {"eccentricity": (-0.5, NAN, "e", None), "pericenter": (-1.0, NAN, "p", None)},
    ),
    (
        vv.orbits.propagate,
        {"mu": 1.0, "position": [1, 0, 0], "velocity": [0, 1, 0], "t": 1.0},
        {"position": VECTOR, "velocity": VECTOR, "t": ("t", NAN, None)},
    ),
    (
        vv.orbits.circular_orbit,
        {"potential": ATTRACTING, "radius": 1.0},
        {"potential": POTENTIAL, "radius": (-1.0, NAN, "r", None)},
    ),
    (vv.rigid.box, {"mass": 1.0, "a": 1.0, "b": 1.0, "c": 1.0}, {"mass": POSITIVE, "a": POSITIVE}),
    (vv.rigid.sphere, {"mass": 1.0, "radius": 1.0}, {"radius": POSITIVE, "inner_radius": (-1.0, 2.0, NAN, "i")}),
    (
        vv.rigid.free_rotation,
        {"moments": [1, 2, 2.5], "angular_velocity": [1, 0, 0], "t": 1.0},
        {"moments": ([1, 2], [1, 1, 3], "m", None), "angular_velocity": VECTOR, "t": ("t", NAN, None)},
    ),
    (
        vv.rigid.rotate,
        {"quaternion": Q, "vector": [1, 0, 0]},
        {"quaternion": ([1, 0, 0], "q", [NAN] * 4, [0] * 4), "vector": VECTOR},
    ),
    (
        vv.rigid.HeavyTop,
        {"A": 1.0, "C": 0.5, "mass": 1.0, "g": 1.0, "R": 1.0},
        {"A": POSITIVE, "C": POSITIVE, "mass": POSITIVE},
    ),
    (vv.rigid.principal_axes, {"tensor": np.eye(3)}, {"tensor": (np.eye(2), "t", np.full((3, 3), NAN), None)}),
    (
        vv.drag.throw,
        {"speed": 1.0, "g": 1.0, "tau": 1.0},
        {"speed": (NAN, "v", None), "g": POSITIVE, "tau": (-1.0, NAN, "t")},
    ),
    (vv.events.apsis, {"body": 0, "about": 1}, {"direction": (NAN, "up", None), "body": (0.5, None, [0])}),
    (vv.events.plane, {"point": [0, 0, 0], "normal": [0, 0, 1]}, {"point": VECTOR, "normal": (*VECTOR, [0, 0, 0])}),
    (PENDULUM.run, {"t": 1.0}, {"t": ("t", NAN, None), "method": ("gauss", 1), "rtol": (-1.0, NAN, "r")}),
    (
        PENDULUM.at,
        {"position": [1.0]},
        {"position": ([1.0, 2.0], "p", [NAN]), "parameters": ({"l0": 1.0}, {"l": "long"})},
    ),
    (
        PENDULUM.at,
        {"parameters": {"l": 2.0}},
        {"parameters": (1, "l", {"q": 1.0}, {"l": NAN}), "position": ([1, 2], "p")},
    ),
    (
        vv.ExpressionForce,
        {"potential": lambda r, v, t, k: k * r[0], "parameters": {"k": 1.0}},
        {"potential": (None, "x", lambda r: r, [1.0]), "parameters": (1, {"x": 1.0}, ["k"])},
    ),
    (vv.systems.pendulum, {"l": 1.0}, {"l": (NAN, "l", None), "position": ([1, 2], "p", [NAN])}),
    (vv.problems.kepler, {"e": 0.5}, {"e": (-0.1, 1.0, NAN, "e", None), "periods": (-1, 0.5, "p")}),
    (
        vv.solve_ivp,
        {"fun": lambda t, y: -y, "t_span": (0, 1), "y0": [1.0]},
        {
            "fun": ("f", None),
            "t_span": ((0,), "t", (0, NAN), None),
            "y0": ("y", [NAN], None),
            "method": ("rk", 7),
            "rtol": ("r",),
        },
    ),
    (vv.load, {"path": None}, {"path": (3, None, 1.5)}),
    (vv.audit.impulse, {"force": lambda t: np.ones((len(t), 3)), "span": [0.0, 1.0]}, {"force": ("x", 3, None)}),
    (vv.audit.rigidity, {"trajectory": SCENE.run(t=1.0)}, {"trajectory": (3, None, "run")}),
    (
        vv.work_precision,
        {"problem": vv.problems.kepler(e=0.3), "methods": ["dop853"], "seconds": 0.001, "repeats": 1},
        {"problem": ([], None), "methods": ([],)},
    ),
    (vv.events.function, {"call": lambda t, x, v: t - 1.0}, {"call": (3, None, lambda t, x: t)}),
    (vv.systems.henon_heiles().poincare, {"section": "x", "t": 1.0}, {"section": (3, "z"), "t": (NAN, "t")}),
]
