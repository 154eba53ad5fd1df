"""Slow small motions beside fast ones: each eigenvalue has its own digits.

Bounds: the matrices are known to a rounding, and the eigenvalues of these are conditioned as well as they are.
"""

import mpmath
import numpy as np
import pytest

import visviva as vv
from visviva.generalized._eigenvalues import eigenvalues

DIGITS = 1e-14


def overdamped(rate: float, copies: int) -> vv.Lagrangian:
    names = [f"x{i}" for i in range(copies)]
    return vv.Lagrangian(
        lambda q, v, t: sum(0.5 * v[i] ** 2 - 0.5 * q[i] ** 2 for i in range(copies)),
        names,
        dissipation=lambda q, v, t: sum(rate * v[i] ** 2 for i in range(copies)),
        position=[0.0] * copies,
    )


@pytest.mark.parametrize("copies", [1, 3])
@pytest.mark.parametrize("rate", [1e2, 1e4, 1e6, 1e8])
def test_what_creeps_back(rate: float, copies: int) -> None:
    """x'' + 2Γx' + x = 0: −1/(Γ + √(Γ² − 1)) and its inverse."""
    small = overdamped(rate, copies).linearize()
    slow = -1.0 / (rate + np.sqrt(rate**2 - 1.0))
    wanted = np.sort(np.repeat([slow, 1.0 / slow], copies))
    np.testing.assert_allclose(np.sort(small.eigenvalues.real), wanted, rtol=DIGITS, atol=0.0)
    assert (small.eigenvalues.imag == 0.0).all()
    assert small.stable
    assert f"decays at the rate {-slow:.9g}" in str(small)


@pytest.mark.parametrize("ratio", [1e3, 1e6, 1e12, 1e20, 1e40])
def test_a_light_body_beside_a_heavy_one(ratio: float) -> None:
    """M = diag(1, R), K = [[1, −½], [−½, 1]]."""
    system = vv.Lagrangian(
        lambda q, v, t: 0.5 * v[0] ** 2 + 0.5 * ratio * v[1] ** 2 - 0.5 * (q[0] ** 2 + q[1] ** 2 - q[0] * q[1]),
        ["x", "y"],
        position=[0.0, 0.0],
    )
    small = system.normal_modes()
    with mpmath.workdps(60):
        r = mpmath.mpf(ratio)
        root = mpmath.sqrt((1 + r) ** 2 - 3 * r)
        wanted = [mpmath.sqrt(2 * mpmath.mpf("0.75") / (1 + r + root)), mpmath.sqrt((1 + r + root) / (2 * r))]
        wanted = [float(each) for each in wanted]
    np.testing.assert_allclose(small.frequencies, wanted, rtol=DIGITS, atol=0.0)
    np.testing.assert_allclose(np.sort(np.abs(small.eigenvalues)), np.repeat(wanted, 2), rtol=DIGITS, atol=0.0)
    assert small.stable


def test_a_long_pendulum_with_a_short_one() -> None:
    small = vv.systems.double_pendulum(m1=1.0, m2=1.0, l1=1e6, l2=1.0, g=1.0, position=[0.0, 0.0]).normal_modes()
    with mpmath.workdps(60):
        l1, l2 = mpmath.mpf(10) ** 6, mpmath.mpf(1)
        # det([[2g l1, 0], [0, g l2]] − ω² [[2 l1², l1 l2], [l1 l2, l2²]]) = 0.
        b, c = 2 * (l1 + l2), mpmath.mpf(2)
        root = mpmath.sqrt(b * b - 4 * l1 * l2 * c)
        wanted = [float(mpmath.sqrt(2 * c / (b + root))), float(mpmath.sqrt((b + root) / (2 * l1 * l2)))]
    np.testing.assert_allclose(small.frequencies, wanted, rtol=DIGITS, atol=0.0)


def test_an_electron_in_a_trap() -> None:
    """L. S. Brown & G. Gabrielse, Rev. Mod. Phys. 58 (1986) 233: 164 GHz, 62 MHz, and 11.7 kHz of the magnetron."""
    cyclotron, axial = 2 * np.pi * 164e9, 2 * np.pi * 62e6
    trap = vv.Lagrangian(
        lambda q, v, t: (
            0.5 * (v @ v)
            + 0.5 * cyclotron * (q[0] * v[1] - q[1] * v[0])
            + 0.25 * axial**2 * (q[0] ** 2 + q[1] ** 2)
            - 0.5 * axial**2 * q[2] ** 2
        ),
        ["x", "y", "z"],
        position=[0.0, 0.0, 0.0],
    )
    with mpmath.workdps(60):
        c, z = mpmath.mpf(cyclotron), mpmath.mpf(axial)
        root = mpmath.sqrt(c * c - 2 * z * z)
        wanted = [float(z * z / (c + root)), float(z), float((c + root) / 2)]
    small = trap.linearize()
    np.testing.assert_allclose(small.frequencies, wanted, rtol=DIGITS, atol=0.0)
    assert small.stable
    assert "moves on" not in str(small)
    (told,) = trap.equilibria()
    np.testing.assert_allclose(told.frequencies, wanted, rtol=DIGITS, atol=0.0)


@pytest.mark.parametrize("rate", [1e-6, 1e-12, 1e-15, 1e-18, -1e-8, -1e-12])
def test_what_hardly_decays_or_grows(rate: float) -> None:
    small = overdamped(rate, 1).linearize()
    np.testing.assert_allclose(small.eigenvalues.real, -rate, rtol=DIGITS, atol=0.0)
    assert small.stable == (rate > 0.0)


def test_what_is_free_has_exact_zeros() -> None:
    """Three bodies on two springs, damped: the whole moves on, or creeps to rest where it is."""
    system = vv.Lagrangian(
        lambda q, v, t: 0.5 * (v @ v) - 0.5 * (q[1] - q[0]) ** 2 - 0.5 * (q[2] - q[1]) ** 2,
        ["x", "y", "z"],
        position=[0.0, 0.0, 0.0],
    )
    assert (np.sort(np.abs(system.linearize().eigenvalues))[:2] == 0.0).all()
    np.testing.assert_allclose(system.linearize().frequencies, [1.0, np.sqrt(3.0)], rtol=DIGITS, atol=0.0)
    between = vv.Lagrangian(
        lambda q, v, t: 0.5 * (v @ v) - 0.5 * (q[1] - q[0]) ** 2,
        ["x", "y"],
        dissipation=lambda q, v, t: 0.05 * (v[1] - v[0]) ** 2,
        position=[0.0, 0.0],
    ).linearize()
    assert (np.sort(np.abs(between.eigenvalues))[:2] == 0.0).all()
    np.testing.assert_allclose(np.abs(between.eigenvalues).max(), np.sqrt(2.0), rtol=DIGITS, atol=0.0)
    assert between.stable


def test_critical_damping_keeps_its_double_eigenvalue() -> None:
    np.testing.assert_array_equal(overdamped(1.0, 1).linearize().eigenvalues, [-1.0, -1.0])


@pytest.mark.parametrize("seed", range(8))
def test_random_matrices_of_many_scales(seed: int) -> None:
    """Against eigenvalues in 60 digits. Rows and columns of M and C over twelve decades, K of one size."""
    rng = np.random.default_rng(seed)
    n = 4
    scale = 10.0 ** rng.uniform(-3, 3, n)
    a, b, x = rng.normal(size=(3, n, n))
    mass = (a @ a.T + np.eye(n)) * np.outer(scale, scale)
    damping = (b @ b.T) * np.outer(scale, scale) * 10.0 ** rng.uniform(-3, 3)
    stiffness = x @ x.T + 0.1 * np.eye(n)
    found, _ = eigenvalues(mass, damping, stiffness, np.zeros((n, n)))
    with mpmath.workdps(60):
        inverse = mpmath.inverse(mpmath.matrix(mass.tolist()))
        whole = mpmath.zeros(2 * n)
        whole[:n, n:] = mpmath.eye(n)
        whole[n:, :n] = -inverse * mpmath.matrix(stiffness.tolist())
        whole[n:, n:] = -inverse * mpmath.matrix(damping.tolist())
        exact = list(mpmath.eig(whole, left=False, right=False))
        for value in found:
            nearest = min(exact, key=lambda each: abs(each - mpmath.mpc(value)))
            exact.remove(nearest)
            # Conditions of these matrices are some tens to hundreds.
            assert abs(nearest - mpmath.mpc(value)) <= 1e-12 * abs(nearest)


def test_thirty_damped_coordinates_take_no_time() -> None:
    n = 30
    chain = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    found, _ = eigenvalues(np.eye(n), 1e-3 * chain, chain, np.zeros((n, n)))
    squares = 4.0 * np.sin(np.arange(1, n + 1) * np.pi / (2.0 * (n + 1))) ** 2
    np.testing.assert_allclose(np.sort(-found.real), np.sort(np.repeat(5e-4 * squares, 2)), rtol=1e-12, atol=0.0)


def test_equal_sizes_are_told_once_each() -> None:
    """Beyond Routh's ratio the eigenvalues at L4 are ±a ± ib, all of one size: none is fast, and none slow."""

    def restricted(ratio: float) -> vv.Lagrangian:
        def function(q: np.ndarray, v: np.ndarray, t: float) -> float:
            x, y = q
            far, near = np.sqrt((x + ratio) ** 2 + y**2), np.sqrt((x - 1 + ratio) ** 2 + y**2)
            kinetic = 0.5 * (v[0] ** 2 + v[1] ** 2) + x * v[1] - y * v[0] + 0.5 * (x * x + y * y)
            return kinetic + (1 - ratio) / far + ratio / near

        return vv.Lagrangian(function, ["x", "y"])

    for ratio in np.linspace(0.0386, 0.5, 60):
        system, place = restricted(ratio), [0.5 - ratio, np.sqrt(0.75)]
        small = system.linearize(place)
        assert abs(small.eigenvalues.sum()) < 1e-12
        assert (small.eigenvalues.real > 1e-3).sum() == 2
        assert not small.stable
        assert not system.equilibria(near=place)[0].stable  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", ["gyroscopic", "damped", "anything"])
def test_spectra_of_one_size_are_those_of_whole_matrices(kind: str) -> None:
    rng = np.random.default_rng(3)
    for _ in range(200):
        n = int(rng.integers(1, 5))
        a, b = rng.normal(size=(2, n, n))
        damping, stiffness = {
            "gyroscopic": (3.0 * (a - a.T), -np.eye(n)),
            "damped": (a @ a.T, 2.0 * np.eye(n)),
            "anything": (a, b + b.T),
        }[kind]
        whole = np.block([[np.zeros((n, n)), np.eye(n)], [-stiffness, -damping]])
        exact = list(np.linalg.eigvals(whole))
        for value in eigenvalues(np.eye(n), damping, stiffness, np.zeros((n, n)))[0]:
            nearest = min(range(len(exact)), key=lambda at: abs(exact[at] - value))
            # Next to a double eigenvalue both have half of their digits.
            assert abs(exact.pop(nearest) - value) < 1e-6 * max(1.0, abs(value))


@pytest.mark.parametrize("growth", [-1e-5, 1e-5])
def test_many_coordinates_are_judged_as_whole_matrices_tell(growth: float) -> None:
    """Forty oscillators, one of which is pushed: LAPACK tells that from rounding of the largest."""
    n = 40
    damping = np.zeros((n, n))
    damping[0, 0] = -2.0 * growth
    damping[1, 2], damping[2, 1] = 0.1, -0.1
    found, unsure = eigenvalues(np.eye(n), damping, np.diag(np.linspace(1.0, 4.0, n)), np.zeros((n, n)))
    assert bool((found.real > 16.0 * unsure).any()) == (growth > 0.0)
