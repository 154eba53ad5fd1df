"""Meshes: boxes and spheres anywhere, and what is closed, which a sum of random areas tells as counting edges does.

Bounds: volumes are sums of products over the faces, 1e-15 to 1e-14 of them.
"""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from meshes import box_mesh, sphere_mesh

import visviva as vv

CUBE = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])


def left_over(corners, faces):
    """How many edges are not run through as often one way as the other, by counting."""
    places = {}
    numbers = [places.setdefault(tuple(corner + 0.0), len(places)) for corner in corners]
    net = Counter()
    for face in faces:
        for a, b in ((0, 1), (1, 2), (2, 0)):
            p, q = numbers[face[a]], numbers[face[b]]
            net[min(p, q), max(p, q)] += (p < q) - (q < p)
    return sum(count != 0 for count in net.values())


def is_closed(corners, faces):
    """What the library says; flat meshes, and such as no body fills, are told apart from open ones by the message."""
    try:
        vv.rigid.mesh(corners, faces)
    except vv.InvalidInput as error:
        return "encloses a volume" in error.message or "which no body has" in error.message
    return True


faces_of_cube = st.lists(st.tuples(*[st.integers(0, 7)] * 3), min_size=0, max_size=14)


@settings(max_examples=300, deadline=None)
@given(faces_of_cube, st.booleans())
def test_random_triangles(faces, doubled):
    """Any triangles of eight corners, degenerate ones too; with all of them both ways round they are always closed."""
    faces = np.array(faces + [face[::-1] for face in faces] * doubled, dtype=int).reshape(-1, 3)
    assert is_closed(CUBE, faces) == (left_over(CUBE, faces) == 0)
    assert is_closed(CUBE, faces) or not doubled


@settings(max_examples=100, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(["nothing", "gone", "twice", "turned", "moved"]))
def test_one_triangle_among_many(seed, change):
    """Of a closed surface of 512 triangles, numbered at random, one is gone, there twice, turned over or moved."""
    rng = np.random.default_rng(seed)
    corners, faces = sphere_mesh(3)
    order = rng.permutation(len(corners))
    corners, faces = corners[order], np.argsort(order)[faces]
    faces = rng.permutation(np.array([np.roll(face, rng.integers(3)) for face in faces]))
    at = rng.integers(len(faces))
    if change == "gone":
        faces = np.delete(faces, at, axis=0)
    elif change == "twice":
        faces = np.vstack([faces, faces[at]])
    elif change == "turned":
        faces[at] = faces[at, ::-1]
    elif change == "moved":
        faces[at, 0] = rng.choice(np.setdiff1d(np.arange(len(corners)), faces[at]))
    assert is_closed(corners, faces) == (change == "nothing")
    assert (left_over(corners, faces) == 0) == (change == "nothing")


def test_places_with_few_digits():
    """Corners on a grid of small whole numbers, alike in all but some bits: voxels, each a closed box."""
    corners, faces = [], []
    box, sides = box_mesh(1.0, 1.0, 1.0)
    for x in range(6):
        for y in range(6):
            for z in range(6):
                faces.append(sides + len(corners) * 8)
                corners.append(box + np.array([x, y, z]))
    corners, faces = np.vstack(corners), np.vstack(faces)
    # Neighbors share corners that have several numbers; faces between them cancel.
    body = vv.rigid.mesh(corners, faces)
    assert body.mass == pytest.approx(216.0, rel=1e-13)
    assert body.tensor == pytest.approx(vv.rigid.box(216.0, 6.0, 6.0, 6.0).tensor, rel=1e-12, abs=1e-9)
    for at in range(0, len(faces), 37):
        assert not is_closed(corners, np.delete(faces, at, axis=0))


@pytest.mark.parametrize("offset", [0.0, 2.0**10, 2.0**20, 1e6])
@pytest.mark.parametrize("inside_out", [False, True])
def test_a_box_anywhere(offset, inside_out):
    """Sides that are exact so far away: the error is that of the sums alone, 1e-15."""
    corners, faces = box_mesh(0.5, 0.75, 1.25)
    if inside_out:
        faces = faces[:, ::-1]
    move = offset * np.array([1.0, -2.0, 3.0])
    body = vv.rigid.mesh(corners + move, faces, density=2.0)
    exact = vv.rigid.box(2 * 0.5 * 0.75 * 1.25, 0.5, 0.75, 1.25)
    assert body.mass == pytest.approx(exact.mass, rel=1e-14, abs=0)
    assert body.tensor == pytest.approx(exact.tensor, rel=1e-14, abs=1e-15)
    assert body.center - move == pytest.approx([0.25, 0.375, 0.625], rel=1e-9 if offset else 1e-15, abs=0)


def test_a_sphere_mesh_far_away_is_the_one_here():
    """Corners on a grid of 2⁻³⁰, so that moving them rounds nothing: to 1e-12 (sums of 30 000 triangles)."""
    corners, faces = sphere_mesh(6)
    corners = np.round(corners * 2**30) / 2**30
    here = vv.rigid.mesh(corners, faces)
    there = vv.rigid.mesh(corners + 2.0**20 * np.array([1.0, -2.0, 1.0]), faces)
    assert there.mass == pytest.approx(here.mass, rel=1e-13, abs=0)
    assert there.tensor == pytest.approx(here.tensor, rel=1e-12, abs=1e-13)
    # The polyhedron is inside the sphere: 4³ more triangles, 4³ nearer.
    assert here.tensor == pytest.approx(vv.rigid.sphere(here.mass, 1.0).tensor, rel=1e-3, abs=1e-12)
    by_mass = vv.rigid.mesh(corners, faces, mass=3.0)
    assert by_mass.mass == 3.0
    assert by_mass.tensor == pytest.approx(here.tensor * 3.0 / here.mass, rel=1e-15, abs=0)
    # Each triangle with corners of its own, as an STL file has them.
    soup = vv.rigid.mesh(corners[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3))
    assert np.array_equal(soup.tensor, here.tensor)


def test_a_cavity():
    outer, faces = box_mesh(2.0, 2.0, 2.0)
    inner = outer / 2 + 0.5
    body = vv.rigid.mesh(np.vstack([outer, inner]), np.vstack([faces, faces[:, ::-1] + 8]))
    whole, hole = vv.rigid.box(8.0, 2.0, 2.0, 2.0), vv.rigid.box(1.0, 1.0, 1.0, 1.0)
    assert body.mass == pytest.approx(7.0, rel=1e-14, abs=0)
    assert body.tensor == pytest.approx(whole.tensor - hole.tensor, rel=1e-14, abs=1e-14)


def test_minus_zero_is_zero():
    corners, faces = box_mesh(1.0, 1.0, 1.0)
    soup, numbers = corners[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3)
    signs = np.where(np.random.default_rng(1).random(soup.shape) < 0.5, -1.0, 1.0)
    soup = np.where(soup == 0.0, signs * 0.0, soup)
    assert vv.rigid.mesh(soup, numbers).mass == pytest.approx(1.0, rel=1e-15, abs=0)
    with pytest.raises(vv.InvalidInput, match="3 of its 18 edges"):
        vv.rigid.mesh(soup, numbers[1:])


@pytest.mark.parametrize("divisions", [0, 4, 6])
def test_the_same_bits_for_any_number_of_threads(divisions, monkeypatch):
    corners, faces = sphere_mesh(divisions)
    found = []
    for threads in (1, 2, 3, 7):
        monkeypatch.setenv("VISVIVA_THREADS", str(threads))
        body = vv.rigid.mesh(corners * [1.0, 1.3, 0.7] + 100.0, faces)
        found.append(np.concatenate([[body.mass], body.center, body.tensor.ravel()]).tobytes())
    assert len(set(found)) == 1


def test_the_first_wrong_number_is_named_with_any_number_of_threads(monkeypatch):
    corners, faces = sphere_mesh(6)
    faces[20_000, 1] = faces[31_000, 0] = len(corners)
    faces[25_000, 2] = -1
    for threads in ("1", "3"):
        monkeypatch.setenv("VISVIVA_THREADS", threads)
        with pytest.raises(vv.InvalidInput, match=r"faces\[20000\] has another"):
            vv.rigid.mesh(corners, faces)


def test_other_layouts_and_widths():
    corners, faces = sphere_mesh(2)
    expected = vv.rigid.mesh(corners, faces)
    for other in (faces.astype(np.int32), faces.astype(np.uint16), np.asfortranarray(faces), faces.tolist()):
        assert np.array_equal(vv.rigid.mesh(np.asfortranarray(corners), other).tensor, expected.tensor)


def test_the_surface_of_an_ellipsoid_is_what_thin_meshes_have():
    """The difference of two solids one thickness apart, along the normal: to the square of the thickness."""
    half, thin = np.array([1.0, 1.5, 0.6]), 1e-3
    corners, faces = sphere_mesh(6)
    surface, normal = half * corners, corners / half
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    outer, inner = surface + thin * normal, surface - thin * normal
    sheet = vv.rigid.mesh(np.vstack([outer, inner]), np.vstack([faces, faces[:, ::-1] + len(corners)]), mass=3.0)
    # 5e-4: flat triangles of a side of 0.02.
    assert sheet.tensor == pytest.approx(vv.rigid.ellipsoid(3.0, *half, shell=True).tensor, rel=5e-4, abs=1e-5)


def test_a_cavity_outside_of_the_body_is_refused():
    """Two boxes that wind differently: mass 7 and a moment of −9.4 were told of them."""
    corners, faces = box_mesh(1.0, 1.0, 1.0)
    both = np.vstack([corners, 2.0 * corners + [3.0, 0, 0]])
    with pytest.raises(vv.InvalidInput, match="which no body has"):
        vv.rigid.mesh(both, np.vstack([faces, faces[:, ::-1] + len(corners)]))
    together = vv.rigid.mesh(both, np.vstack([faces, faces + len(corners)]))
    assert together.mass == pytest.approx(9.0)
