"""Rigid bodies: mass properties, orientation, and the motions that are known at every time.

Conventions: quaternions are (x, y, z, w), the scalar last, as SciPy has them; they rotate from the body to space. Euler
angles are z–x–z (φ, θ, ψ) about axes that move with the body (``"ZXZ"``) unless another convention is named. Angles are
in radians, the vector axis is the last, and any leading axes broadcast. Wherever a quaternion is taken, so is a
``scipy.spatial.transform.Rotation``. Units are yours, one consistent system.

Source: Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. ch. 4–5; Landau & Lifshitz, *Mechanics* 3rd ed. ch. VI.
"""

from typing import TYPE_CHECKING

from visviva._body_force import BodyForce
from visviva._keywords import unknown_name
from visviva.rigid._cones import ConeAngles, cone_angles
from visviva.rigid._euler import angular_velocity_from_euler, euler_angles, euler_rates, quaternion_from_euler
from visviva.rigid._free import FreeRotation, free_rotation
from visviva.rigid._heavy_top import HeavyTop
from visviva.rigid._inertia import PrincipalAxes, inertia_tensor, parallel_axis, principal_axes, rotate_tensor
from visviva.rigid._mass import MassProperties, composite, particles
from visviva.rigid._mesh import load_mesh, mesh
from visviva.rigid._methods import methods
from visviva.rigid._nutation import Nutation, SteadyPrecession
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
from visviva.rigid._slerp import slerp
from visviva.rigid._solids import (
    box,
    capsule,
    cone,
    cylinder,
    ellipsoid,
    hemisphere,
    sphere,
    tetrahedron,
    torus,
)
from visviva.rigid._thin import disc, plate, rod
from visviva.rigid._top_motion import TopMotion
from visviva.rigid._top_potential import TopMomenta
from visviva.rigid._velocity import ScrewAxis, screw_axis, velocity_at

__all__ = [
    "BodyForce",
    "ConeAngles",
    "FreeRotation",
    "HeavyTop",
    "MassProperties",
    "Nutation",
    "Polhode",
    "PrincipalAxes",
    "ScrewAxis",
    "SteadyPrecession",
    "TopMomenta",
    "TopMotion",
    "angular_velocity_from_euler",
    "box",
    "capsule",
    "composite",
    "cone",
    "cone_angles",
    "cylinder",
    "disc",
    "ellipsoid",
    "euler_angles",
    "euler_rates",
    "flip_time",
    "free_rotation",
    "from_scipy",
    "hemisphere",
    "inertia_tensor",
    "load_mesh",
    "matrix",
    "mesh",
    "methods",
    "parallel_axis",
    "particles",
    "period",
    "plate",
    "polhode",
    "precession_rate",
    "principal_axes",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_from_rotation_vector",
    "quaternion_product",
    "rod",
    "rotate",
    "rotate_back",
    "rotate_tensor",
    "rotation_vector",
    "screw_axis",
    "slerp",
    "sphere",
    "tetrahedron",
    "to_scipy",
    "torus",
    "velocity_at",
]


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
