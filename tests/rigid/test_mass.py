"""Mass properties: against integrals by quadrature, against each other, far from the origin, and what is refused.

Bounds: sums of a few products of lengths of size 1, 1e-15 to 1e-14 of them; thin and hollow bodies as exact as solid
ones.
"""

import sys
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from meshes import box_mesh
from scipy.integrate import quad

import visviva as vv

EPSILON = np.finfo(float).eps
RADIUS, HEIGHT, INNER = 0.7, 1.3, 0.4


def revolved(weight, across, along, center=0.0):
    """Moments (transverse, axial) about the center of mass, per mass, of ∫ weight ds with such second moments."""
    mass, first = quad(weight, 0, 1)[0], quad(lambda s: weight(s) * along(s), 0, 1)[0]
    middle = first / mass
    assert middle == pytest.approx(center, abs=4e-15)
    x = quad(lambda s: weight(s) * across(s), 0, 1)[0] / mass
    z = quad(lambda s: weight(s) * (along(s) - middle) ** 2, 0, 1)[0] / mass
    return x + z, 2 * x


def stacked(radius, low, high, hole=lambda z: 0.0, center=0.0):
    """Of discs (with holes) from low to high."""

    def place(s):
        return low + (high - low) * s

    def area(s):
        return radius(place(s)) ** 2 - hole(place(s)) ** 2

    return revolved(area, lambda s: (radius(place(s)) ** 2 + hole(place(s)) ** 2) / 4, place, center)


def capsule_radius(z):
    past = max(abs(z) - HEIGHT / 2, 0.0)
    return np.sqrt(max(RADIUS**2 - past**2, 0.0))


def ring(sign):
    return lambda z: RADIUS + sign * np.sqrt(max(INNER**2 - z * z, 0.0))


SOLIDS = {
    "sphere": (
        vv.rigid.sphere(1.0, RADIUS, inner_radius=INNER),
        stacked(lambda z: np.sqrt(RADIUS**2 - z * z), -RADIUS, RADIUS, lambda z: np.sqrt(max(INNER**2 - z * z, 0.0))),
    ),
    "hemisphere": (
        vv.rigid.hemisphere(1.0, RADIUS),
        stacked(lambda z: np.sqrt(RADIUS**2 - z * z), 0.0, RADIUS, center=0.375 * RADIUS),
    ),
    "hemisphere shell": (
        vv.rigid.hemisphere(1.0, RADIUS, shell=True),
        revolved(lambda s: 1.0, lambda s: RADIUS**2 * (1 - s * s) / 2, lambda s: RADIUS * s, center=RADIUS / 2),
    ),
    "ellipsoid": (
        vv.rigid.ellipsoid(1.0, RADIUS, RADIUS, HEIGHT),
        stacked(lambda z: RADIUS * np.sqrt(max(1 - (z / HEIGHT) ** 2, 0.0)), -HEIGHT, HEIGHT),
    ),
    "ellipsoid shell": (
        vv.rigid.ellipsoid(1.0, RADIUS, RADIUS, HEIGHT, shell=True),
        revolved(
            lambda s: np.sin(np.pi * s) * np.hypot(HEIGHT * np.sin(np.pi * s), RADIUS * np.cos(np.pi * s)),
            lambda s: (RADIUS * np.sin(np.pi * s)) ** 2 / 2,
            lambda s: HEIGHT * np.cos(np.pi * s),
        ),
    ),
    "pipe": (
        vv.rigid.cylinder(1.0, RADIUS, HEIGHT, inner_radius=INNER),
        stacked(lambda z: RADIUS, -HEIGHT / 2, HEIGHT / 2, lambda z: INNER),
    ),
    "cone": (
        vv.rigid.cone(1.0, RADIUS, HEIGHT),
        stacked(lambda z: RADIUS * (HEIGHT - z) / HEIGHT, 0.0, HEIGHT, center=HEIGHT / 4),
    ),
    "cone shell": (
        vv.rigid.cone(1.0, RADIUS, HEIGHT, shell=True),
        revolved(lambda s: s, lambda s: (RADIUS * s) ** 2 / 2, lambda s: HEIGHT * (1 - s), HEIGHT / 3),
    ),
    "capsule": (
        vv.rigid.capsule(1.0, RADIUS, HEIGHT),
        stacked(capsule_radius, -HEIGHT / 2 - RADIUS, HEIGHT / 2 + RADIUS),
    ),
    "torus": (vv.rigid.torus(1.0, RADIUS, INNER), stacked(ring(1), -INNER, INNER, ring(-1))),
    "torus shell": (
        vv.rigid.torus(1.0, RADIUS, INNER, shell=True),
        revolved(
            lambda s: RADIUS + INNER * np.cos(2 * np.pi * s),
            lambda s: (RADIUS + INNER * np.cos(2 * np.pi * s)) ** 2 / 2,
            lambda s: INNER * np.sin(2 * np.pi * s),
        ),
    ),
    "disc": (
        vv.rigid.disc(1.0, RADIUS, inner_radius=INNER),
        revolved(
            lambda s: INNER + (RADIUS - INNER) * s, lambda s: (INNER + (RADIUS - INNER) * s) ** 2 / 2, lambda s: 0.0
        ),
    ),
    "rod": (vv.rigid.rod(1.0, HEIGHT), revolved(lambda s: 1.0, lambda s: 0.0, lambda s: HEIGHT * (s - 0.5))),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_solids_are_their_integrals(name):
    body, (transverse, axial) = SOLIDS[name]
    # The quadrature meets kinks: 1.3e-8 at those of a hollow sphere.
    assert body.tensor == pytest.approx(np.diag([transverse, transverse, axial]), rel=3e-8, abs=1e-12)


def test_shells_are_their_parts():
    wall = vv.rigid.cylinder(HEIGHT, RADIUS, HEIGHT, inner_radius=RADIUS)
    disc = vv.rigid.disc(RADIUS / 2, RADIUS)
    parts = [wall, disc.moved([0, 0, HEIGHT / 2]), disc.moved([0, 0, -HEIGHT / 2])]
    whole = vv.rigid.cylinder(HEIGHT + RADIUS, RADIUS, HEIGHT, shell=True)
    assert vv.rigid.composite(parts).tensor == pytest.approx(whole.tensor, rel=1e-14, abs=1e-16)
    # A capsule: the wall and a sphere cut in two, each half moved by half the height.
    ball = vv.rigid.sphere(2 * RADIUS, RADIUS, inner_radius=RADIUS)
    half = vv.rigid.MassProperties(RADIUS, [0, 0, RADIUS / 2], ball.tensor / 2 - np.diag([1, 1, 0]) * RADIUS**3 / 4)
    other = half.rotated([1, 0, 0, 0])
    assert (half + other).tensor == pytest.approx(ball.tensor, rel=1e-14, abs=1e-16)
    whole = wall + half.moved([0, 0, HEIGHT / 2]) + other.moved([0, 0, -HEIGHT / 2])
    capsule = vv.rigid.capsule(HEIGHT + 2 * RADIUS, RADIUS, HEIGHT, shell=True)
    assert whole.tensor == pytest.approx(capsule.tensor, rel=1e-13, abs=1e-15)
    a, b, c = 0.3, 0.5, 0.8
    faces = []
    for axes, sides in (((0, 1, 2), (a, b, c)), ((1, 2, 0), (b, c, a)), ((2, 0, 1), (c, a, b))):
        tensor = np.zeros((3, 3))
        plate = vv.rigid.plate(sides[0] * sides[1], sides[0], sides[1]).tensor
        tensor[np.ix_(axes, axes)] = plate
        face = vv.rigid.MassProperties(sides[0] * sides[1], [0, 0, 0], tensor)
        faces += [face.moved(sign * sides[2] / 2 * np.eye(3)[axes[2]]) for sign in (1, -1)]
    shell = vv.rigid.composite(faces)
    assert vv.rigid.box(shell.mass, a, b, c, shell=True).tensor == pytest.approx(shell.tensor, rel=1e-14, abs=1e-16)


def surface_moments(half):
    """Mean squares of the coordinates over the surface of an ellipsoid, by Gauss–Legendre points on an eighth of it."""
    nodes, weights = np.polynomial.legendre.leggauss(80)
    angle, weight = np.pi / 4 * (nodes + 1.0), weights
    sine, cosine = np.sin(angle)[:, None], np.cos(angle)[:, None]
    normal = [sine * np.cos(angle), sine * np.sin(angle), cosine * np.ones(80)]
    area = sum((part / a) ** 2 for part, a in zip(normal, half, strict=True)) ** 0.5 * sine * weight[:, None] * weight
    return np.array([(area * (a * part) ** 2).sum() / area.sum() for part, a in zip(normal, half, strict=True)])


@pytest.mark.parametrize("half", [(1.0, 2.0, 3.0), (3.0, 1.0, 2.0), (1.0, 1.0, 2.5), (2.0, 0.8, 0.8), (1.3, 1.3, 1.3)])
def test_the_surface_of_an_ellipsoid(half):
    moments = surface_moments(half)
    shell = vv.rigid.ellipsoid(1.0, *half, shell=True)
    # Eighty points each way are exact at these shapes; 6400 terms are summed in float64.
    assert shell.tensor == pytest.approx(np.diag(moments.sum() - moments), rel=2e-14, abs=1e-16)


def test_the_surface_of_an_ellipsoid_at_its_limits():
    """A sphere, an ellipse with two sides, a needle (mass as √(1 − x²)); continuous, however flat or thin."""
    sphere = vv.rigid.ellipsoid(1.0, 2.0, 2.0, 2.0, shell=True).tensor
    assert sphere == pytest.approx(vv.rigid.sphere(1.0, 2.0, inner_radius=2.0).tensor, rel=1e-15, abs=0)
    for small in (1e-9, 1e-30, 1e-59, 1e-61, 1e-150, 1e-300):
        flat = vv.rigid.ellipsoid(1.0, 3.0, 2.0, small, shell=True).tensor.diagonal()
        assert flat == pytest.approx([1.0, 2.25, 3.25], rel=1e-14, abs=0)
        across, _, along = vv.rigid.ellipsoid(1.0, small, small, 2.0, shell=True).tensor.diagonal()
        assert across == pytest.approx(1.0, rel=1e-14, abs=0)
        assert along == pytest.approx(0.75 * small * small, rel=1e-14, abs=0.0)
    almost = [vv.rigid.ellipsoid(1.0, 1.0, 1.0 + step, 2.0, shell=True).tensor for step in (0.0, 1e-15)]
    assert almost[0] == pytest.approx(almost[1], rel=4e-15, abs=0)
    # The moments of a body whatever the shape: the triangle inequality, and less than the box about it.
    for shape in np.exp(np.random.default_rng(2).normal(size=(50, 3)) * 4):
        moments = vv.rigid.ellipsoid(1.0, *shape, shell=True).principal_axes().moments
        assert moments[2] <= (moments[0] + moments[1]) * (1 + 1e-15)


def test_a_part_taken_out():
    """Hollows, wherever they are: against the mesh with a cavity, the hollow sphere, and the way back."""
    whole, hole = vv.rigid.box(8.0, 2.0, 2.0, 2.0), vv.rigid.box(1.0, 1.0, 1.0, 1.0).moved([0.25, -0.5, 0.125])
    left = whole - hole
    outer, faces = box_mesh(2.0, 2.0, 2.0)
    inner = (outer - 1.0) / 2 + [0.25, -0.5, 0.125]
    mesh = vv.rigid.mesh(np.vstack([outer - 1.0, inner]), np.vstack([faces, faces[:, ::-1] + 8]))
    assert left.mass == pytest.approx(mesh.mass, rel=1e-14, abs=0)
    assert left.center == pytest.approx(mesh.center, rel=1e-14, abs=0)
    assert left.tensor == pytest.approx(mesh.tensor, rel=1e-14, abs=1e-14)
    assert (left + hole).tensor == pytest.approx(whole.tensor, rel=1e-14, abs=1e-14)
    hollow = vv.rigid.sphere(8.0, 2.0) - vv.rigid.sphere(1.0, 1.0)
    assert hollow.tensor == pytest.approx(vv.rigid.sphere(7.0, 2.0, inner_radius=1.0).tensor, rel=1e-14, abs=1e-15)


def test_tetrahedra():
    rng = np.random.default_rng(5)
    for _ in range(20):
        corners = rng.normal(size=(4, 3))
        solid = vv.rigid.tetrahedron(2.0, corners)
        meshed = vv.rigid.mesh(corners, [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]], mass=2.0)
        assert solid.center == pytest.approx(meshed.center, rel=4e-14, abs=1e-15)
        assert solid.tensor == pytest.approx(meshed.tensor, rel=1e-14, abs=1e-14)


def thinned(corners, inside, t):
    """What a tetrahedron is beyond another, by t smaller towards a point: of mass 2, and its center."""
    volume = abs(np.linalg.det(corners[1:] - corners[0])) / 6
    inner = vv.rigid.tetrahedron(volume * (1 - t) ** 3, inside + (1 - t) * (corners - inside))
    left = vv.rigid.tetrahedron(volume, corners) - inner
    return 2.0 / left.mass * left.tensor, left.center


def test_the_faces_of_a_tetrahedron():
    """Against thin walls of one thickness, two of which tell the limit to the square of the thickness."""
    rng = np.random.default_rng(6)
    for _ in range(10):
        corners = rng.normal(size=(4, 3))
        faces = [np.delete(corners, at, axis=0) for at in range(4)]
        areas = np.array([np.linalg.norm(np.cross(face[1] - face[0], face[2] - face[0])) for face in faces])
        # The center of the sphere inside, as far from each face, is the mean of the corners by the areas across.
        inside = areas @ corners / areas.sum()
        (one, place), (two, other) = (thinned(corners, inside, t) for t in (1e-4, 2e-4))
        shell = vv.rigid.tetrahedron(2.0, corners, shell=True)
        assert shell.tensor == pytest.approx(2 * one - two, rel=1e-6, abs=1e-7)
        assert shell.center == pytest.approx(2 * place - other, rel=1e-6, abs=1e-7)
        assert shell.mass == pytest.approx(2.0, rel=1e-15, abs=0)


positions = st.lists(st.tuples(*[st.floats(-2, 2)] * 3), min_size=2, max_size=8)


@settings(max_examples=100, deadline=None)
@given(positions, st.tuples(*[st.floats(-3, 3)] * 3), st.tuples(*[st.floats(-1, 1)] * 4))
def test_particles_and_what_is_done_with_them(places, point, turn):
    places, point = np.array(places), np.array(point)
    masses = 1.0 + np.arange(len(places))
    body = vv.rigid.particles(masses, places)
    # 1e-14 of the size of what is summed, 36 masses at 4 lengths.
    close = {"rtol": 1e-13, "atol": 1e-11}
    np.testing.assert_allclose(body.about([0, 0, 0]), vv.rigid.inertia_tensor(masses, places), **close)
    np.testing.assert_allclose(body.about(point), vv.rigid.inertia_tensor(masses, places - point), **close)
    if np.linalg.norm(turn) > 1e-2:
        q = np.array(turn) / np.linalg.norm(turn)
        turned = vv.rigid.particles(masses, vv.rigid.rotate(q, places))
        np.testing.assert_allclose(body.rotated(q).tensor, turned.tensor, **close)
        np.testing.assert_allclose(body.rotated(q).center, turned.center, **close)
    split = vv.rigid.particles(masses[:1], places[:1]) + vv.rigid.particles(masses[1:], places[1:])
    np.testing.assert_allclose(split.tensor, body.tensor, **close)
    moments, axes = body.principal_axes()
    assert np.all(np.diff(moments) >= 0)
    np.testing.assert_allclose(axes @ np.diag(moments) @ axes.T, body.tensor, **close)
    assert np.linalg.det(axes) == pytest.approx(1.0, rel=1e-14, abs=0)
    assert moments[2] <= (moments[0] + moments[1]) * (1 + 1e-12)


def test_degenerate_bodies():
    point = vv.rigid.particles([2.0], [[1.0, 2.0, 3.0]])
    assert np.array_equal(point.tensor, np.zeros((3, 3)))
    assert np.array_equal(point.principal_axes().axes, np.eye(3))
    line = vv.rigid.particles([1.0, 1.0], [[0, 0, 0], [1.0, 1.0, 1.0]])
    moments, axes = line.principal_axes()
    assert moments == pytest.approx([0.0, 1.5, 1.5], abs=1e-15)
    assert moments[0] >= 0.0
    assert axes[:, 0] == pytest.approx(np.full(3, np.sqrt(1 / 3)), rel=1e-15, abs=0)
    plane = vv.rigid.principal_axes(vv.rigid.plate(1.0, 1.0, 2.0).tensor)
    assert plane.moments[2] == pytest.approx(plane.moments[0] + plane.moments[1], rel=1e-15, abs=0)
    moments, axes = vv.rigid.principal_axes(np.diag([3.0, 2.0, 3.0]))
    assert np.array_equal(moments, [2.0, 3.0, 3.0])
    assert np.array_equal(np.abs(axes), np.eye(3)[:, [1, 0, 2]])
    far = vv.rigid.particles([1.0, 1.0], [[1e12, 0, 0], [1e12 + 2, 0, 0]])
    assert np.array_equal(far.tensor, np.diag([0.0, 2.0, 2.0]))
    large = vv.rigid.principal_axes(np.diag([1e300, 1.5e300, 2e300]))
    assert np.array_equal(large.moments, [1e300, 1.5e300, 2e300])


def test_free_rotation_of_a_body_made_of_parts():
    """From a T-handle's parts to its flips: the moments go in as they come out."""
    handle = vv.rigid.cylinder(0.2, 0.01, 0.1).rotated([0.5, 0.5, 0.5, 0.5])
    shaft = vv.rigid.cylinder(0.1, 0.01, 0.06).moved([0, 0, 0.04])
    moments, _ = (handle + shaft).principal_axes()
    path = vv.rigid.polhode(moments, [1e-3, 10.0, 1e-3])
    assert path.kind in ("about_largest", "about_smallest")
    assert 0.1 < path.flip_time < 10.0


BOX = box_mesh(1.0, 1.0, 1.0)
ONE = vv.rigid.sphere(1.0, 1.0)


@pytest.mark.parametrize(
    ("call", "argument", "words"),
    [
        (lambda: vv.rigid.inertia_tensor([-1.0], [[0, 0, 0]]), "mass", "at least 0"),
        (lambda: vv.rigid.inertia_tensor([1.0, 1.0], [[0, 0, 0]]), "position", "N = 2"),
        (lambda: vv.rigid.particles([0.0], [[0, 0, 0]]), "mass", "expected some mass"),
        (lambda: vv.rigid.principal_axes(np.diag([1, 1, 3])), "tensor", "larger by 1.0"),
        (lambda: vv.rigid.principal_axes(np.diag([1, 1, -1])), "tensor", "at least 0"),
        (lambda: vv.rigid.principal_axes([[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]), "tensor", "symmetric"),
        (lambda: vv.rigid.parallel_axis(np.eye(3), 0.0, [1, 0, 0]), "mass", "positive mass"),
        (lambda: vv.rigid.sphere(1.0, -1.0), "radius", "positive length"),
        (lambda: vv.rigid.sphere(0.0, 1.0), "mass", "positive mass"),
        (lambda: vv.rigid.sphere(1.0, 1.0, inner_radius=1.1), "inner_radius", "at most radius = 1.0"),
        (lambda: vv.rigid.torus(1.0, 1.0, 1.1), "minor_radius", "meets itself"),
        (lambda: vv.rigid.tetrahedron(1.0, np.zeros((4, 3)), shell=True), "vertices", "areas in the range"),
        (lambda: vv.rigid.tetrahedron(1.0, np.eye(4, 3), shell=1), "shell", "True or False"),
        (lambda: vv.rigid.cylinder(1.0, 1.0, 1.0, shell=0), "shell", "True or False"),
        (lambda: vv.rigid.box(1.0, 1.0, 1.0, 1.0, shell="no"), "shell", "True or False"),
        (lambda: vv.rigid.cylinder(1, 1, 1, inner_radius=0.5, shell=True), "inner_radius", "expected 0 of a shell"),
        (lambda: ONE - ONE, "mass", "expected some mass"),
        (lambda: ONE - vv.rigid.sphere(2.0, 0.1), "mass", "expected some mass"),
        (lambda: ONE - vv.rigid.sphere(0.5, 3.0), "other", "what is left has the tensor"),
        (lambda: ONE - ONE.moved([9.0, 0.0, 0.0]), "mass", "expected some mass"),
        (lambda: ONE - vv.rigid.sphere(0.1, 0.1).moved([9.0, 0.0, 0.0]), "other", "what is left has the tensor"),
        (lambda: vv.rigid.composite([]), "bodies", "list of MassProperties"),
        (lambda: vv.rigid.composite([ONE, 3]), "bodies", r"bodies\[1\] is 3"),
        (lambda: vv.rigid.mesh(BOX[0], BOX[1][:-1]), "faces", "3 of its 18 edges are on the border of a hole"),
        (lambda: vv.rigid.mesh(BOX[0], BOX[1][:0]), "faces", "encloses a volume"),
        (
            lambda: vv.rigid.mesh(BOX[0], np.vstack([BOX[1][:-1], BOX[1][-1:, ::-1]])),
            "faces",
            "on 3 of the 18 edges two neighbours run against each other",
        ),
        (lambda: vv.rigid.mesh(BOX[0], BOX[1] + 1), "faces", "numbers of the 8 vertices"),
        (lambda: vv.rigid.mesh(BOX[0], BOX[1] - 1), "faces", "numbers of the 8 vertices"),
        (lambda: vv.rigid.mesh(BOX[0] * [1, 1, 0], BOX[1]), "faces", "flat"),
        (lambda: vv.rigid.mesh(BOX[0], BOX[1] * 1.0), "faces", "whole numbers"),
        (lambda: vv.rigid.mesh(*BOX, mass=1.0, density=1.0), "density", "got both"),
        (lambda: vv.rigid.mesh(*BOX, density=-1.0), "density", "positive"),
    ],
)
def test_bad_input(call, argument, words):
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        call()
    assert caught.value.argument == argument


def test_files_are_read_by_trimesh(monkeypatch):
    corners, faces = BOX
    found = SimpleNamespace(vertices=corners, faces=faces)
    reader = SimpleNamespace(load_mesh=lambda path, process: found)
    monkeypatch.setitem(sys.modules, "trimesh", reader)
    assert vv.rigid.mesh(*vv.rigid.load_mesh("box.stl")).mass == pytest.approx(1.0, rel=1e-15, abs=0)
    monkeypatch.setitem(sys.modules, "trimesh", None)
    with pytest.raises(ImportError, match=r"the package trimesh is not installed: pip install 'visviva\[mesh\]'$"):
        vv.rigid.load_mesh("box.stl")


@pytest.mark.parametrize("unit", [1e-20, 1.0, 1e20])
def test_tensors_are_symmetric_but_for_rounding(unit):
    """What is off by rounding is made symmetric, what is off by more refused, whatever the unit."""
    tensor = unit * np.array([[3.0, 0.1, 0.2], [0.1, 4.0, 0.3], [0.2, 0.3, 5.0]])
    rounded = tensor.copy()
    rounded[0, 1] *= 1.0 + 1e-12
    kept = vv.rigid.MassProperties(1.0, [0.0, 0.0, 0.0], rounded).tensor
    assert (kept == kept.T).all()
    assert tensor[0, 1] < kept[0, 1] < rounded[0, 1]
    wrong = tensor.copy()
    wrong[0, 1] *= 1.0 + 1e-9
    for refused in (
        lambda: vv.rigid.MassProperties(1.0, [0.0, 0.0, 0.0], wrong),
        lambda: vv.rigid.rotate_tensor(wrong, [0.0, 0.0, 0.0, 1.0]),
        lambda: vv.rigid.parallel_axis(wrong, 1.0, [0.0, 0.0, 0.0]),
    ):
        with pytest.raises(vv.InvalidInput, match=r"tensor: expected a symmetric tensor, but tensor\[0, 1\] = "):
            refused()


@pytest.mark.parametrize("far", [1e6, 1e9, 1e12, 1e14])
def test_particles_far_from_the_origin_have_the_tensor_of_those_near_it(far: float) -> None:
    """The differences of these places are exact, and so is what they are about."""
    near = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.25, 2.0, 0.0]])
    place = near + far * np.array([1.0, -3.0, 2.0])
    mass = [1.3, 0.7, 2.1]
    away, here = vv.rigid.particles(mass, place), vv.rigid.particles(mass, place - place[0])
    np.testing.assert_allclose(away.tensor, here.tensor, rtol=1e-15, atol=1e-15)
    together = vv.rigid.composite([away, vv.rigid.particles([1.0], place[:1])])
    beside = vv.rigid.composite([here, vv.rigid.particles([1.0], [[0.0, 0.0, 0.0]])])
    # The center of the first is a place that is told in numbers, which are so far apart there.
    np.testing.assert_allclose(together.tensor, beside.tensor, rtol=0.0, atol=8.0 * np.spacing(3.0 * far) + 1e-14)
