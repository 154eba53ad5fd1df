"""Legendre's transformation by numbers: closed forms, involution, Hamilton's equations, and what has no transform.

Bounds: a transform is found to some roundings of its largest term, 1e-14, over sixty powers of ten 1e-13; the
transform of a transform has that twice, conditioned by the masses; a difference of order 8 with steps of 0.01 is off
by 5e-15.
"""

from typing import Any

import numpy as np
import pytest

import visviva as vv

ONE = ["x"]


def quartic(a: float = 1.7) -> vv.Lagrangian:
    return vv.Lagrangian(lambda q, v, t, a: a * v[0] ** 4 / 4, ONE, parameters={"a": a})


def test_quartic_at_any_size() -> None:
    """H = (3/4) a^(−1/3) p^(4/3) over sixty powers of ten, and 0 at rest, where the mass matrix is singular."""
    p = np.concatenate([-np.logspace(-30, 30, 61), np.logspace(-30, 30, 61)])[:, None]
    H = quartic().legendre_transform()
    q = np.zeros_like(p)
    assert H(q, p) == pytest.approx(0.75 * 1.7 ** (-1 / 3) * np.abs(p[:, 0]) ** (4 / 3), rel=1e-13, abs=0)
    assert H.conjugate(q, p)[:, 0] == pytest.approx(np.cbrt(p[:, 0] / 1.7), rel=1e-14, abs=0)
    assert H([0.0], [0.0]) == 0.0


def test_relativity() -> None:
    """L = −m √(1 − v²) − V and H = √(m² + p²) + V, whose velocities end at 1: steps that leave are cut."""
    light = vv.Lagrangian(
        lambda q, v, t: -2 * np.sqrt(1 - v[0] ** 2 - v[1] ** 2) - q[0] * q[1] ** 2, ["x", "y"]
    ).legendre_transform()
    rng = np.random.default_rng(11)
    q, p = rng.normal(size=(200, 2)), rng.normal(size=(200, 2)) * 10.0 ** rng.uniform(-3, 1.5, (200, 1))
    energy = np.sqrt(4 + (p**2).sum(axis=1))
    # Near the speed of light 1 − v² has lost (p/m)² of its digits.
    lost = 1.0 + (p**2).sum(axis=1, keepdims=True) / 4
    assert np.all(np.abs(light.conjugate(q, p) - p / energy[:, None]) <= 1e-14 * lost)
    assert light(q, p) == pytest.approx(energy + q[:, 0] * q[:, 1] ** 2, rel=1e-12, abs=0)
    slopes, rates = light.gradient(q, p)
    assert slopes == pytest.approx(np.stack([q[:, 1] ** 2, 2 * q[:, 0] * q[:, 1]], axis=1), rel=1e-13, abs=0)
    assert np.array_equal(rates, light.conjugate(q, p))
    back = vv.Hamiltonian(
        lambda q, p, t: np.sqrt(4 + p[0] ** 2 + p[1] ** 2) + q[0] * q[1] ** 2, ["x", "y"]
    ).legendre_transform()
    small = np.abs(p).max(axis=1) < 3.0
    q, p, v = q[small], p[small], rates[small]
    assert back.conjugate(q, v) == pytest.approx(p, rel=1e-12, abs=1e-13)
    root = 2 * np.sqrt(1 - (v**2).sum(axis=1))
    assert back(q, v) == pytest.approx(-root - q[:, 0] * q[:, 1] ** 2, abs=1e-12)
    with pytest.raises(vv.errors.ConvergenceError, match=r"no momenta were found that have the velocity \[1.0, 0.5\]"):
        back([0.0, 0.0], [1.0, 0.5])


@pytest.mark.parametrize("energy", [lambda p: np.sqrt(1 + p**2), lambda p: np.log(np.cosh(p))])
def test_a_limit_of_velocities_is_no_velocity(energy: Any) -> None:
    """√(1 + p²) and ln cosh p: rounded velocities are 1 from p = 1e8 and 20 on, where L was told as -7e-9 and ln 2."""
    transform = vv.Hamiltonian(lambda q, p, t: energy(p[0]), ["x"]).legendre_transform()
    for velocity in (1.0, -1.0):
        with pytest.raises(vv.errors.ConvergenceError, match=rf"have the velocity \[{velocity}\] .* grow without end"):
            transform([0.0], [velocity])
    # What is below it by more than its last digits is told: half of 1e-12 is lost from 1 − v.
    p = transform.conjugate([0.0], [1.0 - 1e-12])[0]
    slope = p / np.sqrt(1 + p**2) if energy(10.0) > 9.9 else np.tanh(p)
    assert 1.0 - slope == pytest.approx(1e-12, rel=1e-3, abs=0)
    # A velocity that no momentum changes is reached by all of them.
    drift = vv.Hamiltonian(lambda q, p, t: 2.0 * p[0], ["x"]).legendre_transform()
    assert drift([0.0], [2.0]) == 0.0


@pytest.mark.parametrize("name", ["double_pendulum", "charged_particle", "hoop", "cart_pendulum"])
def test_of_quadratic_functions_it_is_the_expression(name: str) -> None:
    system = getattr(vv.systems, name)()
    hamiltonian = system.hamiltonian()
    rng = np.random.default_rng(5)
    q, p = rng.normal(size=(2, 50, len(system.coordinates)))
    transform = system.legendre_transform()
    states = np.concatenate([q, p], axis=1)
    columns = hamiltonian._model.columns(np.zeros(50), states, hamiltonian._values[None, :])
    n = q.shape[1]
    scale = np.abs(columns[:, n]).max()
    assert transform(q, p) == pytest.approx(columns[:, n], abs=1e-13 * scale)
    assert transform.conjugate(q, p) == pytest.approx(columns[:, :n], abs=4e-14 * np.abs(columns[:, :n]).max())
    # The transform of the transform is the function, and p is given back.
    v = transform.conjugate(q, p)
    again = hamiltonian.legendre_transform()
    assert again.conjugate(q, v) == pytest.approx(p, abs=1e-12 * np.abs(p).max())
    assert again(q, v) == pytest.approx((p * v).sum(axis=1) - columns[:, n], abs=1e-12 * scale)


def test_hamiltons_equations_of_a_motion() -> None:
    """Along a run of a Lagrangian that is not quadratic H is Jacobi's integral, and its slopes are the rates."""
    system = vv.Lagrangian(
        lambda q, v, t: (
            np.cosh(v[0]) + v[0] * v[1] / 3 + v[1] ** 2 / 2 + v[1] ** 4 / 12 - q[0] ** 2 - q[0] * q[1] ** 2 / 5
        ),
        ["x", "y"],
        position=[0.4, 0.3],
        velocity=[0.2, -0.6],
    )
    out = system.run(t=np.linspace(0.0, 2.0, 41))
    H = system.legendre_transform()
    assert H(out.position, out.momentum) == pytest.approx(out.energy, rel=1e-14, abs=0)
    slopes, rates = H.gradient(out.position, out.momentum)
    assert rates == pytest.approx(out.velocity, abs=1e-14)
    h = 1e-2
    around = system.run(t=1.0 + h * np.arange(-4, 5))
    weights = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])
    assert weights @ around.momentum / h == pytest.approx(
        -H.gradient(around.position[4], around.momentum[4])[0], abs=5e-14
    )
    assert slopes.shape == (41, 2)


def test_the_time_is_that_of_the_start_or_the_one_given() -> None:
    driven = vv.Lagrangian(lambda q, v, t: np.exp(t) * v[0] ** 4 / 4, ONE).legendre_transform()
    assert driven.conjugate([0.0], [8.0]) == pytest.approx([2.0], rel=1e-14, abs=0)
    assert driven.conjugate([0.0], [8.0], t=3.0) == pytest.approx([2.0 / np.e], rel=1e-14, abs=0)


BENT = vv.Lagrangian(lambda q, v, t: v[0] ** 4 / 4 - v[0] ** 2 / 2, ONE)
REFUSED = [
    (lambda: BENT.legendre_transform()([0.0], [0.1]), "L", "convex in the velocities"),
    (lambda: BENT.legendre_transform()([0.0], [6.0]), "L", "convex in the velocities"),
    (lambda: vv.Hamiltonian(lambda q, p, t: -(p[0] ** 2), ONE).legendre_transform()([0.0], [1.0]), "H", "convex"),
    (lambda: quartic().legendre_transform()([0.0, 1.0], [0.0, 1.0]), "position", r"expected shape \(\.\.\., 1\)"),
    (lambda: quartic().legendre_transform()([0.0], [[1.0]]), "momentum", "expected shape"),
    (BENT.hamiltonian, "L", r"legendre_transform\(\) evaluates it by numbers"),
    (
        lambda: vv.Lagrangian(lambda q, v, t: v[0] ** 2 / q[0], ONE).legendre_transform()([0.0], [1.0]),
        "position",
        "a singularity",
    ),
]


@pytest.mark.parametrize(("call", "argument", "words"), REFUSED)
def test_refused(call: Any, argument: str, words: str) -> None:
    with pytest.raises(vv.errors.InvalidInput, match=words) as caught:
        call()
    assert caught.value.argument == argument


def test_it_is_frozen_and_pickles() -> None:
    import pickle

    H = quartic().legendre_transform()
    assert pickle.loads(pickle.dumps(H))([0.0], [1.2393]) == H([0.0], [1.2393])
    with pytest.raises(vv.errors.FrozenAttribute, match="frozen"):
        H.system = quartic(2.0)


def test_starts_by_momenta_and_by_velocities() -> None:
    """A Lagrangian takes momenta, a Hamiltonian velocities, at the place, time and parameters of the new start."""
    system = vv.Lagrangian(
        lambda q, v, t, m: m * np.exp(t) * (v[0] ** 2 / 2 + v[0] ** 4 / 4) * (1 + q[0] ** 2), ONE, parameters={"m": 1.0}
    )
    moved = system.at(position=[2.0], momentum=[3.0], parameters={"m": 0.1}, t0=1.0)
    assert moved.momentum == pytest.approx([3.0], rel=1e-14, abs=0)
    assert (moved.t0, moved.parameters["m"], moved.position[0]) == (1.0, 0.1, 2.0)
    many = system.ensemble(position=[[0.0], [1.0]], momentum=[[1.0], [3.0]])
    assert [many[k].momentum[0] for k in range(2)] == pytest.approx([1.0, 3.0], rel=1e-14, abs=0)
    same = system.at(position=[0.5]).ensemble(momentum=[[1.0], [3.0]])
    assert [(same[k].position[0], round(same[k].momentum[0], 12)) for k in range(2)] == [(0.5, 1.0), (0.5, 3.0)]
    double = vv.systems.double_pendulum(position=[0.3, 0.9])
    hamiltonian = double.hamiltonian().at(velocity=[0.5, -0.2])
    assert hamiltonian.momentum == pytest.approx(double.at(velocity=[0.5, -0.2]).momentum, rel=1e-14, abs=0)
