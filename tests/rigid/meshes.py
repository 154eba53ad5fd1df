"""Closed meshes of triangles: boxes and spheres."""

import itertools

import numpy as np


def box_mesh(a, b, c):
    corners = np.array(list(itertools.product((0.0, a), (0.0, b), (0.0, c))))
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, np.array([triangle for p, q, r, s in quads for triangle in ((p, q, r), (p, r, s))])


def sphere_mesh(divisions):
    corners, faces = np.array([[1.0, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]), []
    for x, y, z in itertools.product((0, 1), (2, 3), (4, 5)):
        faces.append((x, y, z) if (x + y + z) % 2 == 0 else (x, z, y))
    faces = np.array(faces)
    for _ in range(divisions):
        edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        unique, inverse = np.unique(edges, axis=0, return_inverse=True)
        middles = corners[unique].mean(axis=1)
        middles /= np.linalg.norm(middles, axis=1)[:, None]
        m = len(corners) + inverse.reshape(-1, 3)
        corners = np.vstack([corners, middles])
        a, b, c = faces.T
        ab, bc, ca = m.T
        faces = np.vstack([np.array(t).T for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return corners, faces
