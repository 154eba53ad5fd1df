"""Equilibria in coordinates that are no angles: the same in any unit of length, and wherever the system starts."""

from typing import Any

import numpy as np
import pytest
import sympy as sp

import visviva as vv

x, y, z = (vv.coordinate(name) for name in "xyz")


@pytest.mark.parametrize("length", [1.0, 2.8, 2.95, 5.0, 1e3])
def test_a_spring_pendulum_hangs(length: float) -> None:
    """At r = l + m g/k, and upright at l − m g/k."""
    system = vv.systems.spring_pendulum(m=1.0, k=40.0, l=length, g=9.81, position=[1.1 * length, 0.5])
    for each in (system, system.hamiltonian()):
        stable = [found.position for found in each.equilibria() if found.stable]
        np.testing.assert_allclose(stable, [[length + 9.81 / 40.0, 0.0]], rtol=1e-12, atol=1e-12)
        upright = [found.position for found in each.equilibria() if not found.stable]
        places = [[length - 9.81 / 40.0, sign * np.pi] for sign in (-1.0, 1.0)]
        np.testing.assert_allclose(upright, places, rtol=1e-12, atol=1e-12)


def test_angles_are_told_within_a_turn() -> None:
    """However far the system starts: 0, ±π, not once more for each turn."""
    for start in (0.5, 7.0, 100.0):
        places = [found.position[0] for found in vv.systems.pendulum(position=[start]).equilibria()]
        np.testing.assert_allclose(places, [-np.pi, 0.0, np.pi], rtol=1e-12, atol=1e-12)


def test_a_spring_is_no_angle() -> None:
    """Its stiffness is the same a turn farther, its force is not."""
    spring = vv.Lagrangian(lambda q, v, t: 0.5 * v[0] ** 2 - 20.0 * (q[0] - 5.0) ** 2, ["x"], position=[5.5])
    for each in (spring, spring.hamiltonian()):
        (found,) = each.equilibria()
        np.testing.assert_allclose(found.position, [5.0], rtol=1e-12, atol=0.0)


def both(potential: sp.Expr, *coordinates: Any) -> tuple[vv.Lagrangian, vv.Hamiltonian]:
    """Particles of unit mass in a potential, without a start that would tell its size."""
    kinetic = sum(q.diff(vv.time) ** 2 for q in coordinates) / 2
    names, momenta = ([sp.Symbol(f"{letter}{q.func}") for q in coordinates] for letter in "qp")
    energy = sum(p**2 for p in momenta) / 2 + potential.subs(dict(zip(coordinates, names, strict=True)))
    return vv.Lagrangian(kinetic - potential, coordinates), vv.Hamiltonian(energy, q=names, p=momenta)


def places(system: vv.Lagrangian | vv.Hamiltonian) -> list[list[float]]:
    """Where it stays, in an order that rounding does not change."""
    found = np.array([each.position for each in system.equilibria()]).reshape(-1, len(system.coordinates))
    size = np.abs(found).max(initial=1e-300)
    in_order = np.lexsort((found / size).round(6).T[::-1])
    told: list[list[float]] = found[in_order].tolist()
    return told


@pytest.mark.parametrize("size", [1e-10, 1e-3, 0.7, 10.0, 1e4, 1.5e11])
def test_two_wells_of_any_size(size: float) -> None:
    """At ± size, and a hill between; to rounding."""
    for system in both((x**2 / size**2 - 1) ** 2 * size**2, x):
        np.testing.assert_allclose(places(system), [[-size], [0.0], [size]], rtol=1e-13, atol=0)
        assert [found.stable for found in system.equilibria()] == [True, False, True]
    started = vv.Lagrangian(
        x.diff(vv.time) ** 2 / 2 - (x**2 / size**2 - 1) ** 2, [x], position=[0.3 * size], velocity=[0]
    )
    np.testing.assert_allclose(places(started), [[-size], [0.0], [size]], rtol=1e-13, atol=0)


@pytest.mark.parametrize("size", [3.4e-10, 1.0, 50.0])
def test_atoms_rest_where_they_neither_push_nor_pull(size: float) -> None:
    """At 2^(1/6) of the size of Lennard-Jones, on either side."""
    for system in both(4e-21 * ((size / x) ** 12 - (size / x) ** 6), x):
        minimum = 2 ** (1 / 6) * size
        np.testing.assert_allclose(places(system), [[-minimum], [minimum]], rtol=1e-13, atol=0)


def test_a_bond_far_from_the_origin() -> None:
    """Morse's, whose force is nothing that a number holds on one side, and too much for one on the other."""
    for system in both((1 - sp.exp(50 - x)) ** 2, x):
        np.testing.assert_allclose(places(system), [[50.0]], rtol=1e-13, atol=0)


def test_wells_of_several_sizes_in_a_system() -> None:
    wells = [(q, size) for q, size in zip((x, y, z), (10.0, 20.0, 30.0), strict=True)]
    for system in both(sum((q**2 - size**2) ** 2 for q, size in wells), x, y, z):
        wanted = sorted([a, b, c] for a in (-10.0, 0.0, 10.0) for b in (-20.0, 0.0, 20.0) for c in (-30.0, 0.0, 30.0))
        np.testing.assert_allclose(places(system), wanted, rtol=1e-12, atol=0)


@pytest.mark.parametrize("distance", [1.0, 10.0, 1.496e8])
def test_the_points_of_lagrange_at_any_distance(distance: float) -> None:
    """Two on the circle, at 60 degrees, and three on the line, which are those of the distance 1 but for the unit."""

    def potential(unit: float) -> sp.Expr:
        first, second = (sp.sqrt((x - at * unit) ** 2 + y**2) for at in (-0.1, 0.9))
        return -sp.Float(0.9) / first - sp.Float(0.1) / second - (x**2 + y**2) / (2 * unit**3)

    for system, of_one in zip(both(potential(distance), x, y), both(potential(1.0), x, y), strict=True):
        found = np.array(places(system)) / distance
        assert found.shape == (5, 2)
        np.testing.assert_allclose(found, places(of_one), rtol=1e-10, atol=1e-12)
        off_the_line = found[np.abs(found[:, 1]) > 0.1]
        np.testing.assert_allclose(off_the_line, [[0.4, -np.sqrt(0.75)], [0.4, np.sqrt(0.75)]], rtol=1e-10, atol=0)


def test_what_goes_on_and_on_is_told_as_far_as_a_turn() -> None:
    """As cos(1.7 x) does; in a trap all of its places are found but those a search misses, and none is told twice."""
    for system in both(-sp.cos(sp.Float(1.7) * x), x):
        np.testing.assert_allclose(places(system), [[-np.pi / 1.7], [0.0], [np.pi / 1.7]], rtol=1e-14, atol=0)
    in_a_trap = both(-sp.cos(sp.Float(1.7) * x) + x**2 / 100, x)[0]
    found = np.array(places(in_a_trap))[:, 0]
    # 1.7 sin(1.7 x) = −x/50 has roots up to |x| = 85.
    assert np.abs(1.7 * np.sin(1.7 * found) + found / 50).max() < 1e-12
    assert 80 < len(found) <= 93
    assert np.diff(found).min() > 0.1


@pytest.mark.parametrize(
    ("potential", "wanted"),
    [
        (sp.exp(-(x**2)), [0.0]),
        (sp.exp(-x) / x, [-1.0]),
        (1 / x**2, []),
        # Forces that vanish far off by cancellation, and but for rounding sooner.
        (sp.sqrt(1 + x**2) - x, []),
        (sp.log(sp.cosh(x)) - x, []),
        (sp.sqrt(x**2 + 1) - sp.sqrt(x**2 + 4), [0.0]),
        # No numbers far off.
        (sp.cosh(x), [0.0]),
        (sp.cosh(x / 5) - x, [5 * float(np.arcsinh(5.0))]),
        (x**2 / 2 - sp.sqrt(9 - x**2), [0.0]),
        (sp.asin(x), []),
        (sp.exp(x**2), [0.0]),
    ],
    ids=str,
)
def test_what_is_nothing_far_off_is_no_equilibrium(potential: sp.Expr, wanted: list[float]) -> None:
    for system in both(potential, x):
        np.testing.assert_allclose(np.ravel(places(system)), wanted, rtol=1e-13, atol=1e-14)


def test_charges_that_cancel_far_off() -> None:
    """A linear quadrupole: of the field that falls with the fourth power of the distance rounding is left."""
    squares = (x - 3) ** 2 + y**2, (x + 3) ** 2 + y**2, x**2 + y**2 + 1
    for system in both(1 / sp.sqrt(squares[0]) + 1 / sp.sqrt(squares[1]) - 2 / sp.sqrt(squares[2]), x, y):
        assert places(system) == [[0.0, 0.0]]


@pytest.mark.parametrize("mu", [0.01, 3e-6])
@pytest.mark.parametrize("distance", [1.0, 10.0])
def test_points_beside_a_planet_in_a_turning_frame(mu: float, distance: float) -> None:
    """The Earth's are a hundredth aside, and along its orbit there is a valley without any."""
    qx, qy, px, py = sp.symbols("qx qy px py")
    first, second = (sp.sqrt((qx - at * distance) ** 2 + qy**2) for at in (-mu, 1 - mu))
    rate = sp.Float(distance**-1.5)
    function = (px**2 + py**2) / 2 - rate * (qx * py - qy * px) - (1 - mu) / first - mu / second
    found = np.array(places(vv.Hamiltonian(function, q=[qx, qy], p=[px, py]))) / distance
    assert found.shape == (5, 2)
    off_the_line = found[np.abs(found[:, 1]) > 0.1]
    np.testing.assert_allclose(
        off_the_line, [[0.5 - mu, -np.sqrt(0.75)], [0.5 - mu, np.sqrt(0.75)]], rtol=1e-10, atol=0
    )
    on_the_line = np.sort(found[np.abs(found[:, 1]) <= 0.1][:, 0])
    pulls = (1 - mu) * (on_the_line + mu) / np.abs(on_the_line + mu) ** 3
    pulls += mu * (on_the_line - 1 + mu) / np.abs(on_the_line - 1 + mu) ** 3
    np.testing.assert_allclose(pulls, on_the_line, rtol=1e-9, atol=0)
    assert on_the_line[0] < -mu < on_the_line[1] < 1 - mu < on_the_line[2]


def test_bonds_far_off_in_two_coordinates() -> None:
    bonds = (1 - sp.exp((40 - x) / 2)) ** 2 + (1 - sp.exp((30 - y) / 2)) ** 2
    for system in both(bonds, x, y):
        np.testing.assert_allclose(places(system), [[40.0, 30.0]], rtol=1e-12, atol=0)


@pytest.mark.parametrize("length", [1e-3, 1.0, 30.0, 1e3])
def test_a_pendulum_on_a_circle_of_any_size(length: float) -> None:
    """Without a start: it hangs, and stands."""
    kinetic = (x.diff(vv.time) ** 2 + y.diff(vv.time) ** 2) / 2
    system = vv.Lagrangian(kinetic - 9.8 * y, [x, y], constraints=[x**2 + y**2 - length**2])
    np.testing.assert_allclose(places(system), [[0.0, -length], [0.0, length]], rtol=1e-13, atol=1e-13 * length)
    assert [found.stable for found in system.equilibria()] == [True, False]


@pytest.mark.parametrize("size", [30.0, 100.0, 1e4, 1e8])
def test_a_hill_whose_zero_is_made_by_rounding_is_told_once(size: float) -> None:
    """Multiplied out, the hill is at what rounding leaves of size⁴ − size⁴: a 1e-16th of the size, and one place."""
    for potential in ((x - size) ** 2 * (x + size) ** 2 / 2, (x / size - 1) ** 2 * (x / size + 1) ** 2):
        for system in both(potential, x):
            np.testing.assert_allclose(places(system), [[-size], [0.0], [size]], rtol=1e-12, atol=1e-14 * size)
    for system in both((x - size) * (x + size) * x, x):
        np.testing.assert_allclose(places(system), [[-size / np.sqrt(3)], [size / np.sqrt(3)]], rtol=1e-12, atol=0)


def test_ions_in_a_trap() -> None:
    """On a line, in any order: of three the outer ones at (5/4)^(1/3), and the middle one at rest between."""
    q, p = sp.symbols("q0:3"), sp.symbols("p0:3")
    repulsion = sum(1 / sp.sqrt((q[i] - q[j]) ** 2) for i in range(3) for j in range(i))
    trap = sum(each**2 for each in q) / 2
    found = vv.Hamiltonian(sum(each**2 for each in p) / 2 + trap + repulsion, q=list(q), p=list(p)).equilibria()
    outer = 1.25 ** (1 / 3)
    assert len(found) == 6
    for each in found:
        np.testing.assert_allclose(np.sort(each.position), [-outer, 0.0, outer], rtol=1e-10, atol=1e-10)
        assert each.stable


def test_beside_a_coordinate_that_nothing_depends_on() -> None:
    for system in both((x**2 - 100) ** 2, x, y):
        assert places(system) == [
            [pytest.approx(-10.0, rel=1e-13), 0.0],
            [0.0, 0.0],
            [pytest.approx(10.0, rel=1e-13), 0.0],
        ]


@pytest.mark.parametrize(("first", "second"), [(1e-8, 1.0), (1e4, 1e-4), (1e-3, 1e6)])
def test_lengths_of_different_sizes_in_one_place(first: float, second: float) -> None:
    """Each of nine places, by the size of each coordinate: two wells beside two others."""
    wells = (x**2 / first**2 - 1) ** 2 + (y**2 / second**2 - 1) ** 2
    wanted = sorted([a, b] for a in (-first, 0.0, first) for b in (-second, 0.0, second))
    for system in both(wells, x, y):
        found = np.array([each.position for each in system.equilibria()]) / [first, second]
        in_order = found[np.lexsort(found.round(6).T[::-1])]
        if len(found) == 9:
            np.testing.assert_allclose(in_order, np.array(wanted) / [first, second], rtol=1e-11, atol=1e-11)
        else:
            # A search that misses some tells none twice, and none that is not there.
            assert len(np.unique(found.round(6), axis=0)) == len(found)
            np.testing.assert_allclose(found, found.round(), rtol=0, atol=1e-9)


def test_a_small_length_beside_an_angle() -> None:
    """Wells 1e-8 to either side, and a pendulum: nine places."""
    for system in both((x**2 * 1e16 - 1) ** 2 - sp.cos(y), x, y):
        found = np.array(places(system)) / [1e-8, np.pi]
        assert found.shape == (9, 2)
        np.testing.assert_allclose(found, found.round(), rtol=0, atol=1e-10)


@pytest.mark.parametrize("k", [1, 3, 8, 60])
def test_angles_of_many_periods_are_angles(k: int) -> None:
    """Within a turn, whatever their start is: 2k + 1 places of cos kθ."""
    for start in (1.0, 50.0):
        system = vv.Lagrangian(x.diff(vv.time) ** 2 / 2 + sp.cos(k * x), [x], position=[start], velocity=[0.0])
        found = np.array(places(system))[:, 0]
        assert np.abs(found).max() <= np.pi + 1e-9
        np.testing.assert_allclose(found, np.arange(-k, k + 1) * np.pi / k, rtol=1e-11, atol=1e-11)


def test_beside_the_edge_of_a_domain() -> None:
    for system in both((x - 20) ** 2 + sp.sqrt(sp.Float(20.05) - x) / 1000, x):
        ((found,),) = places(system)
        assert 2 * (found - 20) == pytest.approx(1 / (2000 * np.sqrt(20.05 - found)), rel=1e-9, abs=0)


def test_hamiltonians_that_rest_with_momenta_of_their_own() -> None:
    """Where ∂H/∂p vanishes at p = ±1, beside p = 0: each with its own place."""
    q, p = sp.symbols("q p")
    function = (p**2 - 1) ** 2 * (1 + q**2) / 4 + (q - 1) ** 2
    found = sorted([*each.position, *each.momentum] for each in vv.Hamiltonian(function, q=[q], p=[p]).equilibria())
    np.testing.assert_allclose(found, [[0.8, 0.0], [1.0, -1.0], [1.0, 1.0]], rtol=1e-10, atol=1e-10)
