"""Scenes of some rigid bodies and particles and all that may act on them, drawn by a seed; as cases of ``World``."""

from typing import Any

import numpy as np
from dynamics_cases import tensor, turn

Case = dict[str, Any]


def moments(rng: np.random.Generator) -> list[float]:
    """Of a body of any shape: a sphere, a symmetric one, a plate, or none of these."""
    second = rng.uniform(0.02, 0.3, 3)
    kind = rng.integers(4)
    if kind < 2:
        second[:2] = second[2] if kind else second[0]
    found = second.sum() - second
    if kind == 2:
        found[2] = found[0] + found[1]
    return [float(moment) for moment in found]


def spring(rng: np.random.Generator, rigid: int, particles: int) -> Case:
    """From a point of a body to another body, a particle or a place."""
    body = int(rng.integers(rigid))
    drawn: Case = {"body": body, "point": rng.uniform(-0.4, 0.4, 3).tolist(), "stiffness": float(rng.uniform(0.5, 8.0))}
    if rng.random() < 0.6:
        drawn["length"] = float(rng.uniform(0.1, 1.0))
    if rng.random() < 0.3:
        drawn["damping"] = float(rng.uniform(0.1, 1.0))
    other = rng.integers(3)
    if other == 0 and rigid > 1:
        drawn["to"] = int((body + 1 + rng.integers(rigid - 1)) % rigid)
        drawn["to_point"] = rng.uniform(-0.4, 0.4, 3).tolist()
    elif other == 1 and particles:
        drawn["particle"] = int(rng.integers(particles))
    else:
        drawn["anchor"] = rng.uniform(-3.0, 3.0, 3).tolist()
    return drawn


def drawn_case(seed: int) -> tuple[Case, bool]:
    """A case, and whether something in it looks at velocities."""
    rng = np.random.default_rng(seed)
    rigid, particles = int(rng.integers(1, 4)), int(rng.integers(0, 3))
    cells = rng.permutation(12)[: rigid + particles]
    # Apart by 1.7 at least: what happens in a close encounter is a question to the step.
    places = 2.5 * np.stack([cells % 3, cells // 3 % 2, cells // 6], axis=-1) + rng.uniform(-0.4, 0.4, (len(cells), 3))
    speeds = rng.uniform(-0.5, 0.5, (len(cells), 3))
    bodies: Case = {
        "mass": rng.uniform(0.3, 2.0, rigid).tolist(),
        "position": places[particles:].tolist(),
        "velocity": speeds[particles:].tolist(),
        "orientation": [turn(*rng.normal(size=4)) for _ in range(rigid)],
        "angular_velocity": rng.uniform(-3.0, 3.0, (rigid, 3)).tolist(),
    }
    if rng.random() < 0.5:
        bodies["moments"] = [moments(rng) for _ in range(rigid)]
    else:
        bodies["inertia"] = [tensor(moments(rng), turn(*rng.normal(size=4))) for _ in range(rigid)]
    held = rng.random(rigid) < 0.3
    if held.any():
        bodies["pivot"] = [rng.uniform(-0.5, 0.5, 3).tolist() if each else None for each in held]
        bodies["velocity"] = np.where(held[:, None], 0.0, speeds[particles:]).tolist()
    one = [None, *range(rigid)]
    forces: list[Any] = [["AttachedSpring", spring(rng, rigid, particles)] for _ in range(rng.integers(0, 4))]
    for chance, kind, arguments in (
        (0.6, "UniformField", {"g": rng.uniform(-2.0, 2.0, 3).tolist()}),
        (0.6, "Gravity", {"G": float(rng.uniform(0.1, 0.5))}),
        (0.3, "AppliedTorque", {"torque": rng.uniform(-1.0, 1.0, 3).tolist(), "frame": "space"}),
        (0.3, "AppliedTorque", {"torque": rng.uniform(-1.0, 1.0, 3).tolist(), "frame": "body"}),
        (0.2, "RotationalDrag", {"coefficient": float(rng.uniform(0.01, 0.3))}),
        (0.2, "CompiledTorque", {"function": "motor"}),
    ):
        if rng.random() < chance:
            chosen = {} if kind in ("UniformField", "Gravity") else {"body": one[rng.integers(len(one))]}
            forces.append([kind, arguments | chosen])
    case: Case = {"bodies": bodies, "forces": forces, "times": [0.25, 0.5]}
    if particles:
        masses = rng.uniform(0.2, 1.5, particles).tolist()
        where = {"position": places[:particles].tolist(), "velocity": speeds[:particles].tolist()}
        case["particles"] = {"mass": masses, **where}
    looking = any(kind in ("RotationalDrag", "CompiledTorque") or of.get("damping") for kind, of in forces)
    return case, looking
