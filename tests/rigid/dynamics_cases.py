"""Scenes with rigid bodies whose motion ``dynamics_reference.json`` keeps; ``tools/rigid_dynamics.py`` writes it."""

from typing import Any

import numpy as np

IDENTITY = [0.0, 0.0, 0.0, 1.0]
DOWN = ["UniformField", {"g": [0.0, 0.0, -9.81]}]


def turn(*vector: float) -> list[float]:
    """A quaternion of length 1 along this one."""
    q = np.array(vector)
    unit: list[float] = (q / np.sqrt(q @ q)).tolist()
    return unit


def tensor(moments: list[float], q: list[float]) -> list[list[float]]:
    """A tensor of these principal moments, along other axes; symmetric to the last bit."""
    x, y, z, w = q
    matrix = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    whole = matrix @ np.diag(moments) @ matrix.T
    rows: list[list[float]] = ((whole + whole.T) / 2).tolist()
    return rows


# Two bodies that turn each other: no sphere, no plane, and masses of the same order.
_BINARY = {
    "mass": [1.0, 0.6],
    "moments": [[0.05, 0.07, 0.09], [0.02, 0.03, 0.04]],
    "position": [[-0.75, 0.0, 0.0], [1.25, 0.0, 0.0]],
    "velocity": [[0.0, -0.3375, 0.05], [0.0, 0.5625, -0.0833]],
    "orientation": [turn(0.1, 0.3, -0.2, 1.0), turn(-0.4, 0.2, 0.3, 0.8)],
    "angular_velocity": [[0.3, 0.2, 0.7], [-0.5, 0.4, 0.2]],
}

CASES: dict[str, dict[str, Any]] = {
    # Hairer and Vilmart's free body: m0 = (1.8, 0.4, −0.9).
    "free_asymmetric": {
        "bodies": {"mass": [1.0], "moments": [[0.6, 0.8, 1.0]], "angular_velocity": [[3.0, 0.5, -0.9]]},
        "forces": [],
        "times": [1.0, 10.0],
    },
    # Brüls and Cardona's top: Mech. Mach. Theory 48 (2012) 121.
    "bruls_cardona_top": {
        "bodies": {
            "mass": [15.0],
            "moments": [[0.234375, 0.46875, 0.234375]],
            "position": [[0.0, 1.0, 0.0]],
            "angular_velocity": [[0.0, 150.0, -4.61538]],
            "pivot": [[0.0, -1.0, 0.0]],
        },
        "forces": [DOWN],
        "times": [0.2, 1.0, 2.0],
    },
    "asymmetric_top": {
        "bodies": {
            "mass": [2.0],
            "inertia": [tensor([0.3, 0.5, 0.7], turn(0.2, -0.5, 0.3, 0.9))],
            "position": [[0.5, -0.25, 2.0]],
            "orientation": [turn(0.3, 0.1, -0.2, 0.7)],
            "angular_velocity": [[1.0, -2.0, 9.0]],
            "pivot": [[0.1, 0.2, -0.4]],
        },
        "forces": [DOWN],
        "times": [0.5, 1.0, 2.0],
    },
    # About its long principal axis through the fixed point, from the horizontal: a plane motion.
    "physical_pendulum": {
        "bodies": {
            "mass": [1.5],
            "moments": [[0.3, 0.25, 0.1]],
            "position": [[0.0, 0.6, 0.0]],
            "orientation": [turn(0.5, 0.0, 0.0, 0.5)],
            "pivot": [[0.0, 0.0, 0.6]],
        },
        "forces": [DOWN],
        "times": [0.5, 1.0, 2.0],
    },
    # A long body on a circle about a mass 1e6 times its own, its axis off the vertical: it librates.
    "gravity_gradient": {
        "particles": {"mass": [1.0], "position": [[0.0, 0.0, 0.0]]},
        "bodies": {
            "mass": [1e-6],
            "moments": [[2e-9, 1.1e-8, 1.2e-8]],
            "position": [[1.0, 0.0, 0.0]],
            "velocity": [[0.0, 1.0, 0.0]],
            "orientation": [turn(0.05, -0.1, 0.2, 1.0)],
            "angular_velocity": [[0.1, 0.0, 1.0]],
        },
        "forces": [["Gravity", {"G": 1.0}]],
        "times": [1.0, 5.0],
    },
    "binary": {"bodies": _BINARY, "forces": [["Gravity", {"G": 1.0}]], "times": [1.0, 4.0]},
    # Attached off the center, to a place above.
    "spring_to_a_place": {
        "bodies": {
            "mass": [0.8],
            "moments": [[0.04, 0.06, 0.09]],
            "position": [[0.3, -0.2, 0.1]],
            "velocity": [[0.2, 0.5, -0.1]],
            "orientation": [turn(0.4, -0.3, 0.1, 0.6)],
            "angular_velocity": [[2.0, -1.0, 0.5]],
        },
        "forces": [
            DOWN,
            ["AttachedSpring", {"body": 0, "point": [0.1, 0.2, 0.3], "stiffness": 20.0, "anchor": [0.0, 0.1, 1.0]}],
            [
                "AttachedSpring",
                {"body": 0, "point": [-0.3, 0.0, 0.1], "stiffness": 30.0, "length": 0.7, "anchor": [-1.0, 0.0, 1.0]},
            ],
        ],
        "times": [0.5, 1.0, 3.0],
    },
    "damped_springs_between_bodies": {
        "bodies": {
            "mass": [1.0, 2.0],
            "inertia": [
                tensor([0.1, 0.2, 0.25], turn(0.1, 0.2, 0.3, 0.9)),
                tensor([0.4, 0.5, 0.6], turn(-0.3, 0.5, 0.1, 0.6)),
            ],
            "position": [[0.0, 0.0, 0.0], [2.0, 0.5, -0.3]],
            "velocity": [[0.1, 0.4, 0.0], [-0.2, 0.0, 0.3]],
            "orientation": [turn(0.0, 0.3, 0.0, 1.0), turn(0.6, 0.0, -0.2, 0.4)],
            "angular_velocity": [[0.5, -1.5, 1.0], [0.2, 0.8, -0.4]],
        },
        "forces": [
            [
                "AttachedSpring",
                {
                    "body": 0,
                    "point": [0.3, 0.2, 0.0],
                    "stiffness": 5.0,
                    "length": 1.0,
                    "damping": 0.5,
                    "to": 1,
                    "to_point": [-0.4, 0.0, 0.2],
                },
            ],
            ["AttachedSpring", {"body": 1, "point": [0.0, 0.5, 0.1], "stiffness": 3.0, "to": 0}],
        ],
        "times": [0.5, 1.0, 4.0],
    },
    # A sphere, whose spin decays as exp(−t c/I), and a body that also tumbles.
    "rotational_drag": {
        "bodies": {
            "mass": [1.0, 1.0],
            "moments": [[0.4, 0.4, 0.4], [0.2, 0.3, 0.45]],
            "position": [[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]],
            "velocity": [[0.0, 0.0, 0.0], [0.1, 0.2, 0.3]],
            "orientation": [IDENTITY, turn(0.2, 0.1, 0.4, 0.9)],
            "angular_velocity": [[1.0, -2.0, 3.0], [0.3, 4.0, -0.5]],
        },
        "forces": [["RotationalDrag", {"coefficient": 0.1}], ["RotationalDrag", {"coefficient": 0.05, "body": 1}]],
        "times": [1.0, 5.0],
    },
    # A symmetric body and one that is not, each with a motor on board.
    "torque_along_body_axes": {
        "bodies": {
            "mass": [1.0, 1.0],
            "moments": [[0.5, 0.5, 0.8], [0.5, 0.6, 0.8]],
            "position": [[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]],
            "orientation": [turn(0.1, 0.0, 0.2, 1.0), IDENTITY],
            "angular_velocity": [[0.7, -0.2, 1.5], [0.4, 0.1, -0.3]],
        },
        "forces": [["AppliedTorque", {"torque": [0.3, 0.1, -0.4], "frame": "body"}]],
        "times": [1.0, 4.0],
    },
    "torque_along_axes_of_space": {
        "bodies": {
            "mass": [3.0],
            "inertia": [tensor([0.3, 0.6, 0.8], turn(0.3, -0.1, 0.2, 0.7))],
            "velocity": [[1.0, -2.0, 0.5]],
            "orientation": [turn(0.5, 0.2, -0.1, 0.8)],
            "angular_velocity": [[0.0, 0.1, 0.0]],
        },
        "forces": [["AppliedTorque", {"torque": [0.2, -0.5, 1.0], "body": 0, "frame": "space"}]],
        "times": [1.0, 3.0],
    },
    "compiled_torque": {
        "bodies": {
            "mass": [1.0, 1.0],
            "inertia": [
                tensor([0.3, 0.6, 0.8], turn(0.1, 0.4, -0.3, 0.8)),
                tensor([0.5, 0.6, 0.7], turn(0.0, 0.0, 0.2, 0.8)),
            ],
            "position": [[0.0, 0.0, 0.0], [4.0, 1.0, 0.0]],
            "orientation": [turn(0.5, 0.2, -0.1, 0.8), turn(0.2, -0.2, 0.3, 0.5)],
            "angular_velocity": [[1.0, 0.5, -0.7], [-0.3, 0.2, 1.0]],
        },
        "forces": [["CompiledTorque", {"function": "motor", "body": 0}]],
        "times": [1.0, 3.0],
    },
    # A rigid body among particles of which one is massless.
    "particles_about_a_body": {
        "particles": {
            "mass": [0.3, 0.0],
            "position": [[1.5, 0.0, 0.2], [0.0, 2.0, -0.5]],
            "velocity": [[0.0, 0.9, 0.1], [-0.75, 0.0, 0.1]],
        },
        "bodies": {
            "mass": [1.0],
            "moments": [[0.1, 0.2, 0.25]],
            "velocity": [[0.0, -0.27, -0.03]],
            "orientation": [turn(0.1, 0.5, -0.2, 0.7)],
            "angular_velocity": [[0.2, -0.3, 0.5]],
        },
        "forces": [["Gravity", {"G": 1.0}]],
        "times": [1.0, 5.0],
    },
    "spring_to_a_particle": {
        "particles": {"mass": [0.5, 0.25], "position": [[1.0, 0.0, 0.0], [0.0, -1.5, 0.5]]},
        "bodies": {
            "mass": [1.0],
            "inertia": [tensor([0.2, 0.3, 0.4], turn(0.3, 0.1, 0.2, 0.8))],
            "angular_velocity": [[0.5, 1.0, -1.5]],
        },
        "forces": [
            ["AttachedSpring", {"body": 0, "point": [0.3, 0.1, 0.0], "stiffness": 4.0, "length": 0.5, "particle": 0}],
            ["AttachedSpring", {"body": 0, "point": [0.0, -0.4, 0.1], "stiffness": 2.0, "particle": 1}],
        ],
        "times": [1.0, 4.0],
    },
    # Everything: a held body that pulls and is pulled, a free one beside it, particles, springs, torques and drag.
    "everything": {
        "particles": {
            "mass": [0.4, 0.0],
            "position": [[2.0, 1.0, 0.5], [-2.0, 2.0, 0.0]],
            "velocity": [[-0.2, 0.3, 0.0], [0.3, 0.0, 0.2]],
        },
        "bodies": {
            "mass": [1.5, 0.7],
            "inertia": [
                tensor([0.2, 0.3, 0.45], turn(0.2, 0.2, -0.4, 0.9)),
                tensor([0.1, 0.15, 0.2], turn(-0.2, 0.6, 0.1, 0.5)),
            ],
            "position": [[0.2, 0.1, -0.3], [-1.0, -1.5, 0.4]],
            "velocity": [[0.0, 0.0, 0.0], [0.4, -0.1, 0.2]],
            "orientation": [turn(0.4, 0.1, 0.3, 0.8), turn(-0.1, 0.2, 0.2, 0.9)],
            "angular_velocity": [[0.6, -0.8, 1.2], [1.0, 0.5, -0.5]],
            "pivot": [[0.3, -0.1, 0.4], None],
        },
        "forces": [
            ["UniformField", {"g": [0.1, 0.0, -0.5]}],
            ["Gravity", {"G": 0.8}],
            [
                "AttachedSpring",
                {
                    "body": 0,
                    "point": [-0.3, 0.2, 0.1],
                    "stiffness": 2.0,
                    "length": 1.2,
                    "damping": 0.2,
                    "to": 1,
                    "to_point": [0.2, 0.1, 0.0],
                },
            ],
            ["AttachedSpring", {"body": 1, "point": [0.0, 0.0, 0.3], "stiffness": 1.0, "length": 0.5, "particle": 0}],
            ["AttachedSpring", {"body": 0, "point": [0.1, 0.0, -0.5], "stiffness": 1.5, "anchor": [0.0, 1.0, 1.0]}],
            ["AppliedTorque", {"torque": [0.1, -0.2, 0.15], "body": 0, "frame": "space"}],
            ["AppliedTorque", {"torque": [0.05, 0.1, -0.1], "body": 1, "frame": "body"}],
            ["RotationalDrag", {"coefficient": 0.05}],
        ],
        "times": [0.5, 1.0, 2.0],
    },
}
