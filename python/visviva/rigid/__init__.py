"""Rigid bodies: orientation, and the motions that are known at every time.

Conventions: quaternions are (x, y, z, w), the scalar last, as SciPy has them; they rotate from the body to space. Euler
angles are z–x–z (φ, θ, ψ) about axes that move with the body (``"ZXZ"``) unless another convention is named. Angles are
in radians, the vector axis is the last, and any leading axes broadcast. Wherever a quaternion is taken, so is a
``scipy.spatial.transform.Rotation``.
"""

from visviva.rigid._euler import angular_velocity_from_euler, euler_angles, euler_rates, quaternion_from_euler
from visviva.rigid._free import FreeRotation, free_rotation
from visviva.rigid._orientation import (
    from_scipy,
    matrix,
    quaternion_from_matrix,
    quaternion_from_rotation_vector,
    quaternion_product,
    rotate,
    rotate_back,
    rotation_vector,
    to_scipy,
)
from visviva.rigid._polhode import Polhode, flip_time, period, polhode, precession_rate

__all__ = [
    "FreeRotation",
    "Polhode",
    "angular_velocity_from_euler",
    "euler_angles",
    "euler_rates",
    "flip_time",
    "free_rotation",
    "from_scipy",
    "matrix",
    "period",
    "polhode",
    "precession_rate",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_from_rotation_vector",
    "quaternion_product",
    "rotate",
    "rotate_back",
    "rotation_vector",
    "to_scipy",
]


def __dir__() -> list[str]:
    return list(__all__)
