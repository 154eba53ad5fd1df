"""A gas of spheres that fly freely between their collisions, against the next collision of every pair, foretold."""

import numpy as np
import pytest
from numpy.typing import NDArray

import visviva as vv

Array = NDArray[np.float64]


def gas(n: int, radius: float) -> tuple[Array, Array]:
    rng = np.random.default_rng(1)
    side = int(np.ceil(n ** (1 / 3) - 1e-9))
    grid = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), -1).reshape(-1, 3)[:n]
    return grid + (0.5 - radius) * 0.4 * rng.normal(size=(n, 3)).clip(-1, 1), rng.normal(size=(n, 3))


def foretold(x: Array, v: Array, radius: float, end: float) -> tuple[Array, int]:
    """Where elastic spheres of equal mass are at the end, and how often they have met: from one contact to the next."""
    x, v, t, met = x.copy(), v.copy(), 0.0, 0

    def contacts(i: int) -> Array:
        d, w = x - x[i], v - v[i]
        b, square = (d * w).sum(axis=1), (w * w).sum(axis=1)
        c = (d * d).sum(axis=1) - (2 * radius) ** 2
        root = b * b - square * c
        comes = (b < 0) & (root > 0)
        comes[i] = False
        when = np.full(len(x), np.inf)
        when[comes] = c[comes] / (-b[comes] + np.sqrt(root[comes]))
        return when

    table = np.stack([contacts(i) for i in range(len(x))])
    while True:
        i, j = np.unravel_index(table.argmin(), table.shape)
        at = table[i, j]
        if at > end:
            return x + v * (end - t), met
        x, t, met = x + v * (at - t), at, met + 1
        along = (x[j] - x[i]) / np.linalg.norm(x[j] - x[i])
        impulse = ((v[j] - v[i]) @ along) * along
        v[i], v[j] = v[i] + impulse, v[j] - impulse
        for one in (i, j):
            table[one] = t + contacts(int(one))
            table[:, one] = table[one]


@pytest.mark.parametrize("method", ["auto", "verner98"])
@pytest.mark.parametrize(("n", "radius"), [(64, 0.3), (216, 0.2), (216, 0.3)])
def test_every_collision_is_met(n: int, radius: float, method: vv.typing.MethodName) -> None:
    """Legs begin with steps of some times between two collisions: none is missed that another comes before.

    Roundings of places grow as spheres scatter each other, tenfold in a collision of each: 1e-9 after some of them.
    """
    x, v = gas(n, radius)
    expected, met = foretold(x, v, radius, 1.0)
    scene = vv.Scene(vv.Particles(np.ones(n), x, v, radius=radius))
    out = scene.run(t=1.0, collisions="bounce", method=method)
    assert (out.stats.steps == 0) == (method == "auto")
    assert len(out.collisions) == met > 20
    np.testing.assert_allclose(out.position[-1], expected, rtol=0, atol=1e-9)
    # Other outputs change no bit, of a chain of legs either.
    many = scene.run(t=np.linspace(0.0, 1.0, 33), collisions="bounce", method=method)
    np.testing.assert_array_equal(many.position[-1], out.position[-1])
    np.testing.assert_array_equal(many.collisions.t, out.collisions.t)


def test_a_quiet_time_after_many_collisions_is_passed_in_few_steps() -> None:
    """Steps grow: the time without collisions is some hundred times as long as that with them."""
    x, v = gas(64, 0.3)
    scene = vv.Scene(vv.Particles(np.ones(64), x, v, radius=0.3))
    early = scene.run(t=10.0, collisions="bounce", method="verner98")
    late = scene.run(t=1000.0, collisions="bounce", method="verner98")
    assert len(early.collisions) == len(late.collisions)
    assert late.stats.steps < early.stats.steps + 64 * 10
