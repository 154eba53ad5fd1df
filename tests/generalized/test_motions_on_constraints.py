"""Small motions on constraints: the same as in coordinates that are free, whatever holds them."""

from __future__ import annotations

import numpy as np
import pytest
from rolling import MASS, STIFFNESS, cylinder_on_a_spring

import visviva as vv

G = 9.81


def pendulum(length: float, weight: float = 1.0) -> vv.Lagrangian:
    """One in x and y, its circle multiplied by a weight."""
    return vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - G * q[1],
        ["x", "y"],
        constraints=[lambda q, v, t: weight * (q[0] ** 2 + q[1] ** 2 - length**2)],
        position=[0.0, -length],
    )


def chain(links: int) -> vv.Lagrangian:
    """Masses of 1 on rods of 1, in x and y."""

    def lagrangian(q, v, t):
        return sum(each**2 for each in v) / 2 - G * sum(q[2 * i + 1] for i in range(links))

    def rod(i: int):
        def length(q, v, t):
            x, y = (q[2 * i - 2], q[2 * i - 1]) if i else (0.0, 0.0)
            return (q[2 * i] - x) ** 2 + (q[2 * i + 1] - y) ** 2 - 1.0

        return length

    names = [f"{axis}{i}" for i in range(links) for axis in "xy"]
    start = np.ravel([[0.0, -1.0 - i] for i in range(links)])
    return vv.Lagrangian(lagrangian, names, constraints=[rod(i) for i in range(links)], position=start)


def bead(height) -> vv.Lagrangian:
    """One that slides on y = height(x)."""
    return vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - G * q[1],
        ["x", "y"],
        constraints=[lambda q, v, t: q[1] - height(q[0])],
    )


@pytest.mark.parametrize("length", [1e-3, 1.0, 5.0, 1e3])
@pytest.mark.parametrize("weight", [1e-6, 1.0, 1e6])
def test_a_pendulum_in_a_plane(length, weight):
    hanging, standing = pendulum(length, weight).equilibria()
    np.testing.assert_allclose(
        [hanging.position, standing.position], [[0, -length], [0, length]], rtol=0.0, atol=1e-12 * length
    )
    assert (hanging.stable, standing.stable) == (True, False)
    # A few roundings of λ = g / 2 l, and of its square root.
    np.testing.assert_allclose(hanging.frequencies, [np.sqrt(G / length)], rtol=1e-14, atol=0.0)
    assert standing.frequencies.size == 0


@pytest.mark.parametrize("links", [2, 3, 4])
def test_a_chain_of_rods_is_the_chain_of_angles(links):
    by_angles, by_places = vv.systems.chain(links).normal_modes(), chain(links).normal_modes()
    # Some tens of roundings of a generalized eigenvalue problem of few coordinates.
    np.testing.assert_allclose(by_places.frequencies, by_angles.frequencies, rtol=1e-13, atol=0.0)
    assert by_places.modes is not None
    np.testing.assert_allclose(
        by_places.modes @ by_places.mass @ by_places.modes.T, np.eye(links), rtol=0.0, atol=1e-13
    )
    # Heights do not change to first order.
    np.testing.assert_allclose(by_places.modes[:, 1::2], 0.0, rtol=0.0, atol=1e-13)


def test_all_positions_of_a_chain_are_found_and_one_is_stable():
    found = chain(3).equilibria()
    heights = {tuple(np.diff([0.0, *e.position[1::2]]).round(9)) for e in found}
    assert len(found) == len(heights) == 8
    assert [e.stable for e in found].count(True) == 1
    assert next(e for e in found if e.stable).position[-1] == pytest.approx(-3.0, rel=1e-12, abs=0.0)


def test_a_surface_is_its_second_derivatives():
    a, b, c = 0.8, 1.9, 0.6
    ball = vv.Lagrangian(
        lambda q, v, t: 1.7 * sum(each**2 for each in v) / 2 - 1.7 * G * q[2],
        ["x", "y", "z"],
        constraints=[
            lambda q, v, t: q[2] - (a * q[0] ** 2 / 2 + b * q[1] ** 2 / 2 + c * q[0] * q[1] + q[0] ** 3 - q[1] ** 4)
        ],
        position=[0.0, 0.0, 0.0],
    )
    squares, _ = np.linalg.eigh(G * np.array([[a, c], [c, b]]))
    np.testing.assert_allclose(ball.normal_modes().frequencies ** 2, squares, rtol=1e-13, atol=0.0)


@pytest.mark.parametrize(
    ("height", "stable"),
    [
        (lambda x: x**4, True),
        (lambda x: -(x**4), False),
        (lambda x: x**3, False),
        (lambda x: x**2, True),
        (lambda x: x**2 - x**4, True),
        (lambda x: -(x**2) + x**4, False),
        (lambda x: 0.0 * x, True),
    ],
)
@pytest.mark.parametrize("at", [0.0, 0.7])
def test_a_bead_stays_at_minima_of_any_order(height, stable, at):
    on_wire = bead(lambda x: height(x - at) + 0.3 * at)
    found = on_wire.equilibria(near=[[at + 1e-3, 0.3 * at + 0.02]])
    assert len(found) == 1
    assert found[0].stable == stable
    if height(1.0) != 0.0:
        # Where forces vanish as (x − 0.7)³ they tell a place to a third of its digits.
        assert found[0].position[0] == pytest.approx(at, rel=0.0, abs=1e-12 if at == 0.0 else 1e-5)


def test_small_motions_are_those_of_a_run():
    system = chain(2)
    small = system.normal_modes()
    assert small.modes is not None
    way = 1e-5 * (small.modes[0] + 0.5 * small.modes[1])
    moved = vv.Lagrangian(
        lambda q, v, t: sum(each**2 for each in v) / 2 - G * (q[1] + q[3]),
        list(system.coordinates),
        constraints=[
            lambda q, v, t: q[0] ** 2 + q[1] ** 2 - 1.0,
            lambda q, v, t: (q[2] - q[0]) ** 2 + (q[3] - q[1]) ** 2 - 1.0,
        ],
        position=small.position + way,
        consistent="project",
    )
    t = np.linspace(0.0, 10.0, 11)
    run = moved.run(t).position[:, ::2]
    # Amplitudes of 1e-5 change periods by 1e-10.
    np.testing.assert_allclose(run, small.at(t, way, np.zeros(4))[:, ::2], rtol=0.0, atol=1e-13)


def test_a_cylinder_rolls_as_if_it_were_heavier():
    rolling = cylinder_on_a_spring()
    small = rolling.normal_modes()
    np.testing.assert_allclose(small.frequencies, [np.sqrt(STIFFNESS / (1.5 * MASS))], rtol=1e-14, atol=0.0)
    np.testing.assert_allclose(small.modes, [[3.0**-0.5, 2.0 * 3.0**-0.5]], rtol=1e-14, atol=0.0)
    with pytest.raises(vv.InvalidInput, match="along the constraints"):
        small.at(0.3, [0.1, 0.1], [0.0, 0.0])


def test_a_reaction_turns_with_a_knife_edge():
    # Where a reaction holds −k y, a turn of the edge lets a part k y of it act along: K is triangular.
    k, stiffness, m, inertia, y = 2.0, 3.0, 1.3, 0.7, 0.4
    edge = vv.Lagrangian(
        lambda q, v, t: (
            m * (v[0] ** 2 + v[1] ** 2) / 2
            + inertia * v[2] ** 2 / 2
            - k * (q[0] ** 2 + q[1] ** 2) / 2
            - stiffness * q[2] ** 2 / 2
        ),
        ["x", "y", "theta"],
        nonholonomic=[lambda q, v, t: np.sin(q[2]) * v[0] - np.cos(q[2]) * v[1]],
        position=[0.0, y, 0.0],
    )
    small = edge.linearize()
    np.testing.assert_allclose(
        small.frequencies, np.sort([np.sqrt(k / m), np.sqrt(stiffness / inertia)]), rtol=1e-13, atol=0.0
    )
    along = np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 1.0]])
    np.testing.assert_allclose(along.T @ small.stiffness @ along, [[k, k * y], [0.0, stiffness]], rtol=0.0, atol=1e-14)
    # Without starts one of the surface is told: next to the start.
    (found,) = edge.equilibria()
    np.testing.assert_allclose(found.position, [0.0, y, 0.0], rtol=0.0, atol=1e-14)


def test_what_has_no_small_motions_is_refused_by_name():
    moving = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - G * q[1],
        ["x", "y"],
        constraints=[lambda q, v, t: q[0] ** 2 + q[1] ** 2 - 1.0 - 0.1 * np.sin(t)],
        position=[0.0, -1.0],
    )
    for ask in (moving.equilibria, moving.linearize, moving.normal_modes):
        with pytest.raises(vv.InvalidInput, match="a constraint moves"):
            ask()
    touching = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2 + v[2] ** 2) / 2 - G * q[2],
        ["x", "y", "z"],
        constraints=[lambda q, v, t: q[0] ** 2 + q[1] ** 2 + q[2] ** 2 - 4.0, lambda q, v, t: q[2] + 2.0],
        position=[0.0, 0.0, -2.0],
    )
    for ask in (touching.equilibria, touching.linearize, touching.normal_modes):
        with pytest.raises(vv.InvalidInput, match="depend on each other"):
            ask()
    with pytest.raises(vv.InvalidInput, match=r"constraint 0 is -0\.39"):
        pendulum(2.0).linearize(at=[0.0, -1.9])
    with pytest.raises(vv.InvalidInput, match="which no reaction balances, acts on 'x'"):
        pendulum(2.0).linearize(at=[1.2, -1.6])
    # ẏ = x: λ³ + λ + ½ = 0 is unstable, whatever moves along x alone.
    steered = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2 - q[0] ** 2 - q[0] * q[1] - q[1] ** 2) / 2,
        ["x", "y"],
        nonholonomic=[lambda q, v, t: v[1] - q[0]],
        position=[0.0, 0.0],
    )
    for ask in (steered.equilibria, steered.linearize, steered.normal_modes):
        with pytest.raises(vv.InvalidInput, match=r"a further term b\(q\)"):
            ask()
    sleigh = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2, ["x", "y"], nonholonomic=[lambda q, v, t: v[0] - q[0] * v[1]]
    )
    with pytest.raises(vv.InvalidInput, match="position"):
        sleigh.equilibria()


SURFACES = {
    "x² + y⁴": (lambda x, y: x**2 + y**4, True),
    "x² − y⁴": (lambda x, y: x**2 - y**4, False),
    "x² + y³": (lambda x, y: x**2 + y**3, False),
    "(y − x²)(y − 2x²)": (lambda x, y: (y - x**2) * (y - 2 * x**2), False),
    "(x + y/2)² + y⁴": (lambda x, y: (x + y / 2) ** 2 + y**4, True),
    "(x + y/2)² − y⁴": (lambda x, y: x**2 + x * y + y**2 / 4 - y**4, False),
    "(x + y/2)² + y³": (lambda x, y: x**2 + x * y + y**2 / 4 + y**3, False),
}


@pytest.mark.parametrize("surface", SURFACES)
def test_level_directions_are_told_however_they_lie(surface):
    """On a surface, on one that is turned, and in free coordinates with the origin elsewhere."""
    height, stable = SURFACES[surface]

    def turned(q):
        x, y, z = q
        return (x + 2 * y + 2 * z) / 3, (2 * x + y - 2 * z) / 3, (2 * x - 2 * y + z) / 3

    on_surface = vv.Lagrangian(
        lambda q, v, t: sum(each**2 for each in v) / 2 - G * q[2],
        ["x", "y", "z"],
        constraints=[lambda q, v, t: q[2] - height(q[0], q[1])],
    )
    on_turned = vv.Lagrangian(
        lambda q, v, t: sum(each**2 for each in v) / 2 - G * turned(q)[2],
        ["x", "y", "z"],
        constraints=[lambda q, v, t: 1e-7 * (turned(q)[2] - height(*turned(q)[:2]))],
    )
    free = vv.Lagrangian(
        lambda q, v, t: sum(each**2 for each in v) / 2 - height(q[0] - 1 / 3, q[1] - 2 / 7), ["x", "y"]
    )
    momenta = vv.Hamiltonian(
        lambda q, p, t: sum(each**2 for each in p) / 2 + height(q[0] - 1 / 3, q[1] - 2 / 7), ["x", "y"]
    )
    near = np.array([[0.3, 0.2, 0.0], [0.01, -0.02, 0.0], [0.0, 0.0, 0.0]])
    # Where slopes vanish as a cube a place is told to a hundredth of a thousandth.
    for system, at, starts in (
        (on_surface, np.zeros(3), near),
        (on_turned, np.zeros(3), near),
        (free, np.array([1 / 3, 2 / 7]), near[:, :2] + [1 / 3, 2 / 7]),
        (momenta, np.array([1 / 3, 2 / 7]), np.pad(near[:, :2] + [1 / 3, 2 / 7], ((0, 0), (0, 2)))),
    ):
        told = [each for each in system.equilibria(near=starts) if np.abs(each.position - at).max() < 1e-4]
        assert told
        assert {each.stable for each in told} == {stable}


@pytest.mark.parametrize("mass", [1e-27, 1e-12, 1e12])
@pytest.mark.parametrize("length", [1e-6, 1e3])
@pytest.mark.parametrize("weight", [1e-9, 1e9])
def test_masses_and_constraints_in_any_units(mass, length, weight):
    rod = vv.Lagrangian(
        lambda q, v, t: mass * (v[0] ** 2 + v[1] ** 2) / 2 - mass * G * q[1],
        ["x", "y"],
        constraints=[lambda q, v, t: weight * (q[0] ** 2 + q[1] ** 2 - length**2)],
    )
    found = rod.equilibria(near=[[0.1 * length, -0.9 * length], [0.1 * length, 0.9 * length]])
    assert [each.stable for each in found] == [True, False]
    np.testing.assert_allclose(found[0].frequencies, [np.sqrt(G / length)], rtol=1e-13, atol=0.0)


def test_what_velocities_hold_may_push():
    """A wheel stays where it is put, where nothing pushes it from there; else it is gone as t²."""
    pushed = vv.Lagrangian(
        lambda q, v, t: sum(each**2 for each in v) / 2 - q[0] * q[2],
        ["x", "y", "z"],
        nonholonomic=[lambda q, v, t: v[2] - q[1] * v[0]],
        position=[0.0, 0.0, 0.0],
    )
    assert not pushed.equilibria()[0].stable
    blade = vv.Lagrangian(
        lambda q, v, t: sum(each**2 for each in v) / 2 - G * q[1],
        ["x", "y", "theta"],
        nonholonomic=[lambda q, v, t: np.sin(q[2]) * v[0] - np.cos(q[2]) * v[1]],
        position=[0.0, 0.0, 0.0],
    )
    # Turned by 1e-6 it slides down as g 1e-6 t²/2.
    assert not blade.linearize().stable


def test_far_away_coordinates_weigh_no_force_of_others():
    """A trolley anywhere along its rail, with a pendulum that does not hang."""
    at = 1e9
    trolley = vv.Lagrangian(
        lambda q, v, t: (
            (2 * v[0] ** 2 + v[1] ** 2) / 2 + (v[2] ** 2 + 2 * v[0] * v[2] * np.cos(q[2])) / 2 + G * np.cos(q[2])
        ),
        ["x", "y", "phi"],
        constraints=[lambda q, v, t: q[1]],
        position=[at, 0.0, 0.0],
    )
    assert trolley.linearize().stable
    with pytest.raises(vv.InvalidInput, match="acts on 'phi'"):
        trolley.linearize(at=[at, 0.0, 0.01])
    # Places along the rail are alike.
    assert [each.position[0] for each in trolley.equilibria()] == [0.0] * 3


def test_reactions_that_are_rounding_balance():
    rolling = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + 0.3 * v[1] ** 2) / 2 + 0.02 * G * np.cos(q[1]),
        ["x", "phi"],
        nonholonomic=[lambda q, v, t: v[0] - 0.5 * v[1]],
        position=[0.0, 0.0],
    )
    above = rolling.linearize(at=[1.0, np.pi])
    assert not above.stable
    # (M + I/R²) x¨ = m g e x / R²
    np.testing.assert_allclose(above.squares, [-0.02 * G / 0.25 / (1.0 + 0.3 / 0.25)], rtol=1e-13, atol=0.0)


def test_nothing_rests_where_forces_have_become_zero():
    assert bead(lambda x: np.exp(-x)).equilibria(near=[[20.0, 0.0], [3.0, 0.1], [100.0, 0.0]]) == []


def test_what_nothing_is_free_to_move_in_is_named():
    held = vv.Lagrangian(
        lambda q, v, t: v[0] ** 2 / 2 - q[0], ["x"], constraints=[lambda q, v, t: q[0]], position=[0.0]
    )
    for ask in (held.equilibria, held.linearize, held.normal_modes):
        with pytest.raises(vv.InvalidInput, match="leave none of 1 coordinates free"):
            ask()


def test_a_constraint_without_a_direction_is_named():
    squared = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - G * q[1],
        ["x", "y"],
        constraints=[lambda q, v, t: (q[0] ** 2 + q[1] ** 2 - 1.0) ** 2],
    )
    with pytest.raises(vv.InvalidInput, match="constraint 0 has no direction there"):
        squared.equilibria()
