"""Formulas of which Taylor series tell all, polynomials and waves of places and times: `auto` takes series there.

References: closed forms, and Mathieu's equation to 30 digits. Bounds: a run held to 1e-12 has been seen at a tenth
each; copies have the bits that they have alone.
"""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

import visviva as vv

ION = vv.Particles([1.0], [[0.3, 0.1, 0.2]], [[0.1, -0.2, 0.3]])


def penning(field: float = 10.0) -> vv.Scene:
    trap = vv.ExpressionForce(potential=lambda r, v, t: 0.5 * (r[2] ** 2 - (r[0] ** 2 + r[1] ** 2) / 2))
    return vv.Scene(ION, vv.UniformMagneticField([0.0, 0.0, field], charge=1.0), trap)


def paul(q: float) -> vv.ExpressionForce:
    return vv.ExpressionForce(
        potential=lambda r, v, t, q: (0.01 + q * np.cos(2.0 * t)) * (r[0] ** 2 - r[1] ** 2), parameters={"q": q}
    )


def mathieu(t: float, q: float) -> float:
    """x″ = −2 (0.01 + q cos 2t) x from x = 0.3, x′ = 0.1, by a series of 30 digits from step to step."""
    with mpmath.workdps(30):
        state = [mpmath.mpf(0.3), mpmath.mpf(0.1)]
        steps = 400
        h = mpmath.mpf(t) / steps
        for step in range(steps):
            begin, series = step * h, [state[0], state[1]]
            quarter = mpmath.pi / 2
            wave = [2**n * mpmath.cos(2 * begin + n * quarter) / mpmath.factorial(n) for n in range(40)]
            drive = [mpmath.mpf(q) * coefficient for coefficient in wave]
            drive[0] += mpmath.mpf(0.01)
            for n in range(38):
                force = -2 * mpmath.fsum(drive[k] * series[n - k] for k in range(n + 1))
                series.append(force / ((n + 1) * (n + 2)))
            state = [
                mpmath.fsum(c * h**n for n, c in enumerate(series)),
                mpmath.fsum(n * c * h ** (n - 1) for n, c in enumerate(series) if n > 0),
            ]
        return float(state[0])


def test_a_penning_trap_is_its_closed_form() -> None:
    """Two circles, of the modified cyclotron and the magnetron, and an oscillation along the axis."""
    out = penning().run(t=100.0)
    assert out.plan.method == "taylor"
    root = np.sqrt(10.0**2 / 4 - 0.5)
    fast, slow = -(5.0 + root), -(5.0 - root)
    place, speed = 0.3 + 0.1j, 0.1 - 0.2j
    # w = A e^{i fast t} + B e^{i slow t}
    a = (speed - 1j * slow * place) / (1j * (fast - slow))
    w = a * np.exp(1j * fast * 100.0) + (place - a) * np.exp(1j * slow * 100.0)
    z = 0.2 * np.cos(100.0) + 0.3 * np.sin(100.0)
    np.testing.assert_allclose(out.position[-1, 0], [w.real, w.imag, z], rtol=0, atol=1e-11)


def test_a_trap_that_the_time_drives_is_mathieus_equation() -> None:
    scene = vv.Scene(ION, paul(0.2))
    out = scene.run(t=20.0)
    assert out.plan.method == "taylor"
    assert out.position[-1, 0, 0] == pytest.approx(mathieu(20.0, 0.2), rel=0, abs=1e-11)


@pytest.mark.parametrize("t0", [0.0, 1e4])
def test_a_drive_as_a_formula_is_the_driven_force(t0: float) -> None:
    """Also of a time that is counted from long ago, and one as weak as 1e-6 that is faster than everything else."""
    for frequency, amplitude in ((0.7, 0.3), (300.0, 1e-6)):
        wave = vv.ExpressionForce(
            force=lambda r, v, t, a, w: (a * np.cos(w * t), 0, 0), parameters={"a": amplitude, "w": frequency}
        )
        made = vv.DrivenForce([amplitude, 0.0, 0.0], frequency)
        ours, known = (
            vv.Scene(ION, force, vv.UniformField([0.0, 0.0, -0.1]), t0=t0).run(t=t0 + 10.0, method=method)
            for force, method in ((wave, "taylor"), (made, "auto"))
        )
        np.testing.assert_allclose(ours.position[-1], known.position[-1], rtol=0, atol=1e-11)


@pytest.mark.parametrize(
    ("force", "method"),
    [
        (lambda r, v, t: r[0] ** 4 + r[1] ** 2 * np.sin(3.0 * r[0]), "taylor"),
        (lambda r, v, t: r[0] ** 2 * np.cos(5.0 * t + r[1]), "taylor"),
        (lambda r, v, t: r[0] ** 2 / 3.0, "taylor"),
        # In steep wells series choose their steps too late.
        (lambda r, v, t: r[0] ** 12, "dop853"),
        (lambda r, v, t: np.exp(-((r[0] - 3.0) ** 2)), "dop853"),
        (lambda r, v, t: 1.0 / (r[0] ** 2 + 1e-6), "dop853"),
        (lambda r, v, t: r[0] * np.exp(-((t - 5.0) ** 2)), "dop853"),
        (lambda r, v, t: np.tanh(r[0]), "dop853"),
        # Roots, quotients and logarithms of what vanishes nowhere, or at a pole alone.
        (lambda r, v, t: 0.5 * np.log(r @ r + 0.04), "taylor"),
        (lambda r, v, t: -1.0 / np.sqrt(r[0] ** 2 + r[1] ** 2 + (0.5 + np.sqrt(r[2] ** 2 + 0.01)) ** 2), "taylor"),
        (lambda r, v, t: -1.0 / np.sqrt(r @ r), "taylor"),
        # A disk without thickness, an absolute value, a cone, a pole on a plane, and roots of either sign.
        (lambda r, v, t: -1.0 / np.sqrt(r[0] ** 2 + r[1] ** 2 + (0.5 + np.abs(r[2])) ** 2), "dop853"),
        (lambda r, v, t: np.abs(r[0]) + r[1] ** 2, "dop853"),
        (lambda r, v, t: np.sqrt(r @ r), "dop853"),
        (lambda r, v, t: 1.0 / r[0] + r[1] ** 2, "dop853"),
        (lambda r, v, t: np.sqrt(1.0 + r[0] + r[1]), "dop853"),
    ],
)
def test_auto_takes_series_where_they_tell_all(force: object, method: str) -> None:
    scene = vv.Scene(ION, vv.ExpressionForce(potential=force), vv.UniformField([0.0, 0.0, -1.0]))
    assert scene.plan(t=1.0).method == method
    # Beside forces without series none are taken.
    assert vv.Scene(ION, vv.ExpressionForce(potential=force), vv.QuadraticDrag(0.1)).plan(t=1.0).method == "dop853"


def dipole(r: np.ndarray, v: np.ndarray, t: float) -> np.ndarray:
    """A charge beside a magnetic dipole along z."""
    square = r @ r
    field = (3.0 * r[2] * r - np.array([0.0, 0.0, 1.0]) * square) / square**2.5
    return np.array(
        [v[1] * field[2] - v[2] * field[1], v[2] * field[0] - v[0] * field[2], v[0] * field[1] - v[1] * field[0]]
    )


def test_a_charge_beside_a_dipole_keeps_what_it_has_to() -> None:
    """Its speed, and the angular momentum of its canonical momentum, x v_y - y v_x + ρ²/r³."""
    body = vv.Particles([1.0], [[1.0, 0.0, 0.1]], [[0.0, 0.2, 0.1]])
    out = vv.Scene(body, vv.ExpressionForce(force=dipole)).run(t=np.linspace(0.0, 100.0, 21))
    assert out.plan.method == "taylor"
    (x, y, z), v = out.position[:, 0].T, out.velocity[:, 0]
    canonical = x * v[:, 1] - y * v[:, 0] + (x**2 + y**2) / (x**2 + y**2 + z**2) ** 1.5
    # Some thousand steps, each held to 1e-12, of which the last coefficients leave a hundredth.
    assert np.abs(np.linalg.norm(v, axis=1) / np.linalg.norm(v[0]) - 1.0).max() < 1e-12
    assert np.abs(canonical / canonical[0] - 1.0).max() < 1e-12


@pytest.mark.parametrize(("thickness", "method"), [(0.1, "taylor"), (0.0, "dop853")])
def test_the_number_below_a_root_decides(thickness: float, method: str) -> None:
    def potential(r: np.ndarray, v: np.ndarray, t: float, b: float) -> np.ndarray:
        return -1.0 / np.sqrt(r[0] ** 2 + r[1] ** 2 + (0.5 + np.sqrt(r[2] ** 2 + b**2)) ** 2)

    assert (
        vv.Scene(ION, vv.ExpressionForce(potential=lambda r, v, t: potential(r, v, t, thickness))).plan(t=1.0).method
        == method
    )
    # As a parameter it may be zero in some copy, and each is to have the method that it has alone.
    disk = vv.ExpressionForce(potential=potential, parameters={"b": thickness})
    assert vv.Scene(ION, disk).plan(t=1.0).method == "dop853"
    b = [thickness, 0.2]
    copies = vv.Scene(ION, disk).ensemble(position=[ION.position] * 2, parameters={disk: {"b": np.array(b)}}).run(3.0)
    for index, own in enumerate(b):
        alone = vv.ExpressionForce(potential=potential, parameters={"b": own})
        np.testing.assert_array_equal(copies[index].position, vv.Scene(ION, alone).run(3.0).position)


@pytest.mark.parametrize("force", [(0, 0, lambda x, t: t), (1, 0, lambda x, t: x), (1, 0, lambda x, t: x**2 + t**3)])
def test_a_motion_that_is_a_polynomial_of_time_is_exact(force: tuple[object, ...]) -> None:
    """Its last coefficient was taken for the error: 40 000 steps."""
    third = force[2]
    assert callable(third)
    ramp = vv.ExpressionForce(force=lambda r, v, t: (force[0], 0, third(r[0], t)))
    body = vv.Particles([1.0], [[0.5, 0.0, 0.0]], [[1.0, 0.0, 0.0]])
    for method in ("auto", "taylor"):
        out = vv.Scene(body, ramp).run(t=4.0, method=method)
        # No step is longer than 1/128 of a run in which something may hide.
        assert out.stats.steps <= 140
        t = 4.0
        if force[0] == 0:
            wanted = t**3 / 6
        else:
            x = np.polynomial.Polynomial([0.5, 1.0, 0.5])
            z = third(x, np.polynomial.Polynomial([0.0, 1.0])).integ(2)
            wanted = z(t)
        assert out.position[-1, 0, 2] == pytest.approx(wanted, rel=1e-14, abs=0)


@pytest.mark.parametrize("threads", [1, 3])
def test_copies_with_their_own_numbers_share_lanes_and_have_the_bits_of_each_alone(threads: int) -> None:
    fields = np.linspace(1.0, 10.0, 21)
    q = np.linspace(0.05, 0.3, 21)

    def scene(field: np.ndarray, q: float) -> vv.Scene:
        return vv.Scene(ION, paul(q), vv.UniformMagneticField(field, charge=1.0), vv.LinearDrag(50.0))

    field = fields[:, None] * np.array([0.0, 0.1, 1.0])
    copies = scene(field[0], 0.1).ensemble(parameters={0: {"q": q}, 1: {"B": field}})
    run = copies.run(t=5.0, threads=threads)
    assert run.plan.method == "taylor"
    for copy in range(len(q)):
        alone = scene(field[copy], q[copy]).run(t=5.0)
        assert np.array_equal(run.position[copy], alone.position)
        assert np.array_equal(run.velocity[copy], alone.velocity)


@pytest.mark.parametrize(("massive", "massless"), [(2, 0), (3, 40), (10, 0), (10, 200), (0, 12)])
def test_copies_beside_a_formula_have_the_bits_of_each_alone(massive: int, massless: int) -> None:
    """Few bodies and more than share a ring, massless ones, own masses, an event, one thread and three."""
    rng = np.random.default_rng(massive + massless)
    n = massive + massless
    wave = vv.ExpressionForce(
        acceleration=lambda r, v, t: [-r[0] + 0.1 * r[1] ** 2, -r[1], 0.1 * np.cos(3.0 * t) - r[2]]
    )
    masses = np.r_[rng.uniform(0.5, 1.0, (5, massive)).T, np.zeros((massless, 5))].T * 1e-3
    position, velocity = rng.normal(size=(5, n, 3)), rng.normal(size=(5, n, 3))
    forces = (wave, vv.Gravity(1.0, softening=0.1))
    event = [vv.events.plane((0, 0, 0), (0, 0, 1.0), body=n - 1)]
    scene = vv.Scene(vv.Particles(masses[0], position[0], velocity[0]), *forces)
    copies = scene.ensemble(position=position, velocity=velocity, mass=masses)
    runs = [copies.run(t=1.0, events=event, threads=threads) for threads in (1, 3)]
    assert np.array_equal(runs[0].position, runs[1].position)
    for copy in range(5):
        alone = vv.Scene(vv.Particles(masses[copy], position[copy], velocity[copy]), *forces)
        run = alone.run(t=1.0, events=event)
        assert run.plan.method == ("taylor" if massive <= 8 else "dop853")
        assert np.array_equal(runs[0].position[copy], run.position)
        assert np.array_equal(runs[0].events.t[runs[0].events.member == copy], run.events.t)
