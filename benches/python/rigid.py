"""Rigid bodies: a million rotations and states against SciPy, and the mass of a mesh against trimesh.

Arrays in, arrays out, checks and all, one core. trimesh is left out where it is not installed.
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING

import numpy as np
from _harness import Row, at_most, faster, minima, report

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Iterator

COUNT = 1_000_000
DIVISIONS = 7
"""Of an icosahedron: 20 · 4⁷ = 327 680 triangles."""


def rows() -> Iterator[Row]:
    yield from rotations()
    yield from free_bodies()
    if find_spec("trimesh"):
        yield from meshes()


def rotations() -> Iterator[Row]:
    from scipy.spatial.transform import Rotation

    random = np.random.default_rng(1)
    q, v = random.normal(size=(COUNT, 4)), random.normal(size=(COUNT, 3))
    q /= np.linalg.norm(q, axis=1)[:, None]
    other = q[::-1].copy()
    first, second = Rotation.from_quat(q), Rotation.from_quat(other)
    product, theirs = minima(lambda: vv.rigid.quaternion_product(q, other), lambda: first * second)
    yield at_most("10⁶ products of quaternions", product * 1e3, 40.0, " ms", f"SciPy {theirs * 1e3:.0f} ms")
    turned, theirs = minima(lambda: vv.rigid.rotate(q, v), lambda: first.apply(v))
    yield at_most("10⁶ vectors rotated", turned * 1e3, 30.0, " ms", f"SciPy {theirs * 1e3:.0f} ms")
    angles, theirs = minima(lambda: vv.rigid.euler_angles(q), lambda: first.as_euler("ZXZ"))
    yield faster("10⁶ Euler angles", f"{angles * 1e3:.0f} ms", f"SciPy {theirs * 1e3:.0f} ms", theirs / angles, None)


def free_bodies() -> Iterator[Row]:
    times = np.linspace(0.0, 1e4, COUNT)
    cases = {"far from the separatrix": ([0.6, 0.8, 1.0], [3.0, 0.5, -0.9]), "near it": ([1, 2, 3], [1e-4, 1.0, 1e-4])}
    for name, (moments, spin) in cases.items():
        (seconds,) = minima(lambda moments=moments, spin=spin: vv.rigid.free_rotation(moments, spin, times))
        yield at_most(f"10⁶ states of a free body, {name}", seconds, 1.0, " s")


def meshes() -> Iterator[Row]:
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=DIVISIONS)
    corners, faces = np.array(ball.vertices), np.array(ball.faces)

    def theirs() -> object:
        return trimesh.triangles.mass_properties(corners[faces])

    ours, peer = minima(lambda: vv.rigid.mesh(corners, faces), theirs)
    yield faster(
        f"mass of {len(faces)} triangles", f"{ours * 1e3:.1f} ms", f"trimesh {peer * 1e3:.0f} ms", peer / ours, 15
    )


if __name__ == "__main__":
    report("Rigid bodies", rows(), "Orientation, free rotation in closed form, mass properties.")
