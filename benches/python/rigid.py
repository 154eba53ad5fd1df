"""Rigid bodies: rotations and states by the million, a free body by several codes, and the mass of a mesh.

Arrays in, arrays out, checks and all; one core, but for the mesh. Peers that are not installed are left out; what
heyoka compiles is compiled before it is timed. Errors are angles between attitudes at t = 100, against a reference of
34 digits.
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING

import numpy as np
from _harness import Row, at_most, faster, minima, report
from _rigid_peers import END, MOMENTS, MOMENTUM, free_bodies

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Iterator

COUNT = 1_000_000
DIVISIONS = 7
"""Of an icosahedron: 20 · 4⁷ = 327 680 triangles."""


def rows() -> Iterator[Row]:
    yield from rotations()
    yield from states()
    yield from one_free_body()
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


def states() -> Iterator[Row]:
    times = np.linspace(0.0, 1e4, COUNT)
    cases = {"far from the separatrix": ([0.6, 0.8, 1.0], [3.0, 0.5, -0.9]), "near it": ([1, 2, 3], [1e-4, 1.0, 1e-4])}
    for name, (moments, spin) in cases.items():
        (seconds,) = minima(lambda moments=moments, spin=spin: vv.rigid.free_rotation(moments, spin, times))
        yield at_most(f"10⁶ states of a free body, {name}", seconds, 1.0, " s")


# The attitude (x, y, z, w) of the free body of `_rigid_peers` at its end.
ATTITUDE = np.array([-0.401161607031241803, 0.3660001367406887, 0.0508399529158700676, 0.838169770474586381])


def off(q: np.ndarray) -> float:
    """The angle between an attitude and that of the reference."""
    between = vv.rigid.quaternion_product(ATTITUDE * [-1.0, -1.0, -1.0, 1.0], q / np.linalg.norm(q))
    return float(np.linalg.norm(vv.rigid.rotation_vector(between)))


def one_free_body() -> Iterator[Row]:
    """The attitude at one time, far on: in closed form by us, step by step by the others."""
    spin = MOMENTUM / MOMENTS
    for name, theirs in free_bodies():
        ours, peer = minima(lambda: vv.rigid.free_rotation(MOMENTS, spin, END), theirs)
        here = off(vv.rigid.free_rotation(MOMENTS, spin, END).orientation)
        what = f"attitude at t = {END:g}, against {name}"
        sides = (f"{ours * 1e6:.0f} µs, error {here:.0e}", f"{peer * 1e3:.2f} ms, error {off(theirs()):.0e}")
        yield faster(what, *sides, peer / ours, None)


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
    report(
        "Rigid bodies",
        rows(),
        "Orientation, free rotation in closed form, mass properties; a mesh on every core, with the same bits on one.",
    )
