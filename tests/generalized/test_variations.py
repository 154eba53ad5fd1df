"""The action and its variations: closed forms, expansions in ε, conjugate points, and what is refused.

Bounds: eigenvalues and conjugate points to some ten roundings of (π/T)² and of the times; along a path of
polynomials, ten times what their error in acceleration moves a conjugate point by.
"""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import visviva as vv

Array = NDArray[np.float64]


def oscillator(omega: float, mass: float = 1.3) -> vv.Lagrangian:
    return vv.systems.oscillator(k=mass * omega**2, m=mass, position=[0.4], velocity=[-0.9])


@pytest.mark.parametrize("ends", [(0.0, 1.7), (1.7, 0.0)])
def test_the_action_of_an_oscillator(ends: tuple[float, float]) -> None:
    """S = m (x v at the end − x v at the start) / 2, as L is half the rate of m x v; forwards and backwards."""
    system = oscillator(0.9).at(t0=ends[0])
    for count in (5, 41):
        out = system.run(t=np.linspace(*ends, count))
        wanted = 0.65 * (out.position[-1, 0] * out.velocity[-1, 0] - out.position[0, 0] * out.velocity[0, 0])
        found = system.action(out)
        assert abs(found.value - wanted) <= found.error
        # S is stationary: polynomials that are h⁶ off have an action h¹⁰ off. A run is exact to some ε.
        assert abs(found.value - wanted) <= 2e-15 + 1e-3 * (1.7 / (count - 1)) ** 10
        assert found.quadrature <= 1e-14


def test_a_way_back_has_the_other_sign() -> None:
    """The action and its variations are integrals from the first time of a run to its last."""
    system = oscillator(0.9)
    times = np.linspace(0.0, 1.7, 41)
    ahead = system.run(t=times)
    back = system.at(position=ahead.position[-1], velocity=ahead.velocity[-1], t0=1.7).run(t=times[::-1])

    def curve(t: Array) -> Array:
        return np.asarray(np.cos(t) + t**2)

    eta = curve(times)

    def values(out: Any, eta: Array) -> Array:
        found = [system.action(out), system.first_variation(out, eta), system.second_variation(out, eta)]
        found += [which(out, curve) for which in (system.first_variation, system.second_variation)]
        return np.array([float(one) for one in found])

    # The values at times belong to the times of the run, in its order. 1e-11: two runs, and polynomials through η.
    assert values(back, eta[::-1]) == pytest.approx(-values(ahead, eta), rel=1e-11, abs=0)
    # p η at the last time less that at the first.
    wanted = 1.3 * (back.velocity[-1, 0] * eta[0] - back.velocity[0, 0] * eta[-1])
    assert values(back, eta[::-1])[3] == pytest.approx(wanted, rel=1e-12, abs=0)
    # What is least has no direction. 1e-9: two runs.
    least = [system.accessory_problem(out).eigenvalue for out in (back, ahead)]
    assert least[0] == pytest.approx(least[1], rel=1e-9, abs=0)


def test_places_alone_make_a_path() -> None:
    """Random times: polynomials are met exactly, and of what is none the error is told."""
    rng = np.random.default_rng(7)
    free = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - t * q[0] ** 3, ["x"])
    t = np.cumsum(rng.uniform(0.5, 1.5, 9)) / 9.0
    curve = np.polynomial.Polynomial(rng.normal(size=6))
    whole = (curve.deriv() ** 2 / 2 - np.polynomial.Polynomial([0.0, 1.0]) * curve**3).integ()
    found = free.action((t, curve(t)))
    wanted = whole(t[-1]) - whole(t[0])
    assert found.value == pytest.approx(wanted, rel=1e-13, abs=0)
    waves = free.action((t, np.sin(4 * t)))
    dense = np.linspace(t[0], t[-1], 2001)
    best = free.action((dense, np.sin(4 * dense)[:, None]))
    assert abs(waves.value - best.value) <= waves.error
    assert best.error < 1e-11 < 1e-4 < waves.error
    # Straight lines are what they are: ∫ (Δx/Δt)² / 2 between two places, and t x³ in closed form.
    line = free.action(([0.0, 2.0], [1.0, 3.0]), degree=1)
    assert line.value == pytest.approx(1.0 - _cubic(), rel=1e-15, abs=0)
    assert line.interpolation == 0.0


def _cubic() -> float:
    """Give ∫ t (1 + t)³ dt from 0 to 2."""
    return float((np.polynomial.Polynomial([0, 1]) * np.polynomial.Polynomial([1, 1]) ** 3).integ()(2.0))


def test_variations_are_the_expansion_of_the_action() -> None:
    """Of a quartic L on polynomial paths S[q + ε η] is a quartic in ε, whose coefficients five values give."""
    rng = np.random.default_rng(3)
    a = rng.normal(size=8)

    def L(q: Any, v: Any, t: Any) -> Any:
        kinetic = v[0] ** 2 + v[0] * v[1] * q[0] + v[1] ** 2 * (1 + q[1] ** 2) + a[0] * t * v[0] * q[1] ** 2
        return kinetic + a[1] * q[0] ** 4 + a[2] * q[0] * q[1] * t + a[3] * v[0] ** 3 + a[4] * v[1] * q[0] ** 2

    system = vv.Lagrangian(L, ["x", "y"])
    t = np.linspace(-0.4, 0.9, 8)
    q = np.stack([np.polyval(rng.normal(size=4), t), np.polyval(rng.normal(size=4), t)], axis=1)
    eta = np.stack([np.polyval(rng.normal(size=4), t), np.polyval(rng.normal(size=4), t)], axis=1)
    eps = np.arange(-2, 3) / 2.0
    series = np.polynomial.polynomial.polyfit(eps, [float(system.action((t, q + e * eta))) for e in eps], 4)
    first, second = system.first_variation((t, q), eta), system.second_variation((t, q), eta)
    scale = np.abs(series).max()
    # Five values of some 10 scale, combined with weights of some 10.
    assert first.value == pytest.approx(series[1], abs=1e-13 * scale)
    assert second.value == pytest.approx(2 * series[2], abs=1e-13 * scale)
    # The same variation as a function.
    lines = [np.polynomial.Polynomial.fit(t, each, 3) for each in eta.T]
    as_function = system.second_variation((t, q), lambda s: np.stack([line(s) for line in lines], axis=1))
    assert as_function.value == pytest.approx(second.value, abs=1e-13 * scale)


def test_the_first_variation_of_a_motion_is_that_of_its_ends() -> None:
    double = vv.systems.double_pendulum(position=[1.0, 0.4], velocity=[0.3, -0.8])
    out = double.run(t=np.linspace(0.0, 2.0, 201))

    def bump(t: Array) -> Array:
        return np.stack([np.sin(np.pi * t) * t, np.sin(np.pi * t / 2.0)], axis=1)

    def moved(t: Array) -> Array:
        return bump(t) + np.stack([np.cos(t), np.ones_like(t)], axis=1)

    at_rest = double.first_variation(out, bump)
    # Quintics of steps of 1/100 miss accelerations by some h⁴ ∂⁶q / 2000, which the least polynomials judge.
    assert abs(at_rest.value) <= 1e-9
    assert abs(at_rest.value) <= at_rest.error
    ends = out.momentum[-1] @ moved(out.t[-1:])[0] - out.momentum[0] @ moved(out.t[:1])[0]
    assert double.first_variation(out, moved).value == pytest.approx(ends, abs=1e-9)
    # A path that is no motion is no stationary one.
    bent = (out.t, out.position + 1e-3 * bump(out.t))
    assert abs(double.first_variation(bent, bump).value) > 1e-4


def test_with_friction_the_first_variation_is_less_the_work_along_it() -> None:
    rubbed = vv.Lagrangian(
        lambda q, v, t: v[0] ** 2 / 2 - 2 * q[0] ** 2,
        ["x"],
        dissipation=lambda q, v, t: 0.15 * v[0] ** 2,
        position=[1.0],
    )
    out = rubbed.run(t=np.linspace(0.0, 1.0, 101))
    work = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 + q[0], ["x"])  # only to integrate: δS of x is ∫ η
    eta = np.sin(np.pi * out.t)
    lost = work.first_variation((out.t, 0.0 * out.t), -0.3 * out.velocity[:, 0] * eta).value
    assert rubbed.first_variation(out, lambda t: np.sin(np.pi * t)).value == pytest.approx(-lost, abs=1e-10)


@pytest.mark.parametrize("time", [0.5, 1.5, 1.6, 5.0])
def test_the_accessory_problem_of_an_oscillator(time: float) -> None:
    """λ = (π/T)² − ω², and conjugate points at every half turn, along whatever path."""
    system = oscillator(2.0)
    for path in (([0.0, time], [0.0, 0.0]), system.run(t=np.linspace(0.0, time, 21))):
        found = system.accessory_problem(path)
        assert found.eigenvalue == pytest.approx((np.pi / time) ** 2 - 4.0, abs=4e-14 * (np.pi / time) ** 2 + 4e-14)
        wanted = np.arange(1, int(2.0 * time / np.pi) + 1) * np.pi / 2.0
        assert found.conjugate_points == pytest.approx(wanted, rel=1e-14, abs=0)
        assert found.index == len(wanted)
        assert found.minimum == (time < np.pi / 2.0)


def test_the_sign_changes_at_half_a_turn() -> None:
    system = oscillator(2.0)
    for share, sign in ((1 - 1e-12, 1.0), (1 + 1e-12, -1.0)):
        time = share * np.pi / 2.0
        path = np.linspace(0.0, time, 33), np.zeros(33)
        value = system.second_variation(path, lambda t, time=time: np.sin(np.pi * t / time))
        # (m/2T) (π² − ω²T²), of two terms of 4.1 each; slopes of functions lose a digit.
        assert value.value == pytest.approx(1.3 / (2 * time) * (np.pi**2 - (2 * time) ** 2), abs=2e-13)
        assert sign * system.accessory_problem(path).eigenvalue > 0.0


def test_conjugate_points_that_are_double() -> None:
    """All directions return at once: of a flat oscillator after half a turn, of a charge after a whole one."""
    flat = vv.Lagrangian(lambda q, v, t: (v[0] ** 2 + v[1] ** 2 - q[0] ** 2 - q[1] ** 2) / 2, ["x", "y"])
    found = flat.accessory_problem(([0.0, 4.0], [[0.0, 0.0], [0.0, 0.0]]))
    assert found.conjugate_points == pytest.approx([np.pi, np.pi], rel=1e-14, abs=0)
    assert found.eigenvalue == pytest.approx((np.pi / 4) ** 2 - 1, abs=1e-13)
    charge = vv.systems.charged_particle(m=2.0, charge=1.0, B=[0.0, 0.0, 3.0], velocity=[0.4, 0.3, 0.1])
    out = charge.run(t=np.linspace(0.0, 5.0, 51))
    found = charge.accessory_problem(out)
    assert found.conjugate_points == pytest.approx([2 * np.pi / 1.5] * 2, rel=1e-14, abs=0)
    # The same in another gauge: L differs by the rate of a function.
    gauge = vv.Lagrangian(lambda q, v, t: v[0] ** 2 + v[1] ** 2 + v[2] ** 2 + 3 * q[0] * v[1], ["x", "y", "z"])
    other = gauge.accessory_problem((out.t, out.position))
    assert other.conjugate_points == pytest.approx(found.conjugate_points, rel=1e-12, abs=0)
    assert other.eigenvalue == pytest.approx(found.eigenvalue, rel=1e-11, abs=0)


def test_geodesics_of_a_sphere_meet_at_the_antipodes() -> None:
    sphere = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + (np.sin(q[0]) * v[1]) ** 2) / 2,
        ["theta", "phi"],
        position=[1.2, 0.0],
        velocity=[0.6, 0.8 / np.sin(1.2)],
    )
    out = sphere.run(t=np.linspace(0.0, 7.0, 141))
    found = sphere.accessory_problem(out)
    # The path is known to h⁶ of polynomials between its times.
    assert found.conjugate_points == pytest.approx([np.pi, 2 * np.pi], abs=1e-8)
    # Along the path −η̈ = λ η, across it −η̈ − η = λ η.
    assert found.eigenvalue == pytest.approx((np.pi / 7) ** 2 - 1, abs=1e-8)


def test_the_answers_do_not_depend_on_the_chart() -> None:
    flat = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - q[0] ** 2 - q[1] ** 2 / 2,
        ["x", "y"],
        position=[1.0, 0.0],
        velocity=[0.0, 0.7],
    )
    polar = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + (q[0] * v[1]) ** 2 - q[0] ** 2 * (1 + np.cos(q[1]) ** 2)) / 2,
        ["r", "phi"],
        position=[1.0, 0.0],
        velocity=[0.0, 0.7],
    )
    times = np.linspace(0.0, 3.5, 351)
    one, two = (system.accessory_problem(system.run(t=times)) for system in (flat, polar))
    assert two.conjugate_points == pytest.approx(one.conjugate_points, abs=2e-11)
    assert one.conjugate_points == pytest.approx([np.pi / np.sqrt(2), np.pi], rel=1e-14, abs=0)
    # Between its times the path of polynomials has accelerations that are some h⁴ ∂⁶q / 1000 off: no motion, quite.
    assert two.eigenvalue == pytest.approx(one.eigenvalue, abs=1e-8)
    assert float(polar.action(polar.run(t=times))) == pytest.approx(float(flat.action(flat.run(t=times))), abs=1e-12)


def test_the_index_is_the_number_of_negative_squares() -> None:
    """Morse's theorem, against the eigenvalues of the second variation on hat functions."""
    pendulum = vv.systems.pendulum(position=[2.0])
    out = pendulum.run(t=np.linspace(0.0, 3.7, 38))
    straight = out.t, out.position
    inner = np.eye(38)[1:-1]
    size = len(inner)
    form = np.zeros((size, size))
    for i in range(size):
        for j in range(max(0, i - 1), i + 1):
            own = pendulum.second_variation(straight, inner[i] + (i != j) * inner[j], degree=1).value
            form[i, j] = form[j, i] = own
    diagonal = np.diag(form).copy()
    for i in range(1, size):
        form[i, i - 1] = form[i - 1, i] = (form[i, i - 1] - diagonal[i] - diagonal[i - 1]) / 2
    found = pendulum.accessory_problem(out)
    assert found.index == int((np.linalg.eigvalsh(form) < 0.0).sum()) == 2


PENDULUM = vv.systems.pendulum()
REFUSED = [
    (lambda: PENDULUM.action(3.0), "path", "a trajectory of a Lagrangian, or times and places"),
    (lambda: PENDULUM.action(([0.0], [0.0])), "path", "at least two times, got 1"),
    (lambda: PENDULUM.action(([0.0, 0.0], [0.0, 1.0])), "path", "ascending times"),
    (lambda: PENDULUM.action(([0.0, 1.0], [0.0, np.nan])), r"path\[1\]", "finite"),
    (lambda: PENDULUM.action(([0.0, 1.0], [[0.0, 1.0], [0.0, 1.0]])), r"path\[1\]", "expected shape"),
    (lambda: PENDULUM.action(([0.0, 1.0], [0.0, 1.0]), degree=0), "degree", "1"),
    (lambda: PENDULUM.action(vv.systems.double_pendulum().run(1.0)), "path", "1 coordinates, got one of 2"),
    (lambda: PENDULUM.action(PENDULUM.hamiltonian().run(1.0)), "path", "a run of a Lagrangian"),
    (lambda: PENDULUM.first_variation(([0.0, 1.0], [0.0, 1.0]), [0.0]), "variation", "expected shape"),
    (lambda: PENDULUM.second_variation(([0.0, 1.0], [0.0, 1.0]), lambda t: t[:1]), "variation", "expected shape"),
    (lambda: vv.systems.atwood().accessory_problem(([0.0, 1.0], [[0.0, 0.0]] * 2)), "path", "eliminate"),
    (
        lambda: vv.Lagrangian(lambda q, v, t: -(v[0] ** 2), ["x"]).accessory_problem(([0.0, 1.0], [0.0, 0.0])),
        "path",
        "Legendre's condition",
    ),
    (
        lambda: vv.Lagrangian(lambda q, v, t: v[0] ** 2 + 1 / q[0], ["x"]).action(([0.0, 1.0], [0.0, 0.0])),
        "path",
        "no value at t = ",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("call", "argument", "words"), REFUSED)
def test_refused(call: Any, argument: str, words: str) -> None:
    with pytest.raises(vv.errors.InvalidInput, match=words) as caught:
        call()
    assert caught.match(argument)


def test_what_does_not_settle_is_said() -> None:
    kinks = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2, ["x"])
    with pytest.raises(vv.errors.ConvergenceError, match="does not settle"):
        kinks.second_variation(([0.0, 1.0], [0.0, 1.0]), lambda t: np.sqrt(np.abs(t - 0.3)))
