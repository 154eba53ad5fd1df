"""Linear equations with constant coefficients: found, solved at once, exact at any time.

Bounds: solutions at once are rounded once, at most two spacings of numbers of size 1; energies have two squares of
these.
"""

import mpmath
import numpy as np
import pytest
import sympy as sp

import visviva as vv

x, y, vx, vy = sp.symbols("x y vx vy", real=True)
k, m = sp.symbols("k m", positive=True)

OSCILLATOR = vv.Lagrangian(
    m * vx**2 / 2 - k * x**2 / 2,
    [x],
    velocities=[vx],
    parameters={k: 2.0, m: 3.0},
    position=[1.0],
    velocity=[0.5],
)


def exactly(matrix: list[list[float]], start: list[float], t: float) -> list[float]:
    """exp(A t) y to 40 digits."""
    with mpmath.workdps(60):
        flow = mpmath.expm(mpmath.matrix(matrix) * mpmath.mpf(t))
        return [float(value) for value in flow * mpmath.matrix(start)]


@pytest.mark.parametrize("end", [1e-9, 1.0, -3.7, 1e3, 1e6, -1e9])
def test_an_oscillator_is_exact_however_long(end: float) -> None:
    out = OSCILLATOR.run(end)
    assert out.method == "matrix_exponential"
    with mpmath.workdps(60):
        frequency = mpmath.sqrt(mpmath.mpf(2) / 3)
        wanted = mpmath.cos(frequency * end) + mpmath.mpf("0.5") / frequency * mpmath.sin(frequency * end)
    assert abs(out.position[-1, 0] - float(wanted)) < 5e-16
    assert abs(out.energy[-1] - out.energy[0]) < 1e-15


def test_outputs_do_not_add_errors() -> None:
    times = np.linspace(0.0, 1e4, 1001)
    out = OSCILLATOR.run(times)
    assert np.array_equal(out.position[-1], OSCILLATOR.run(1e4).position[-1])
    assert np.ptp(out.energy) < 2e-15 * out.energy[0] + 1e-15
    assert out.steps == 0


def test_coupled_damped_and_turning_ones_are_those_of_the_exponential() -> None:
    # Two coordinates, coupled in their masses and springs, damped, in a magnetic field, pulled by a constant force.
    lagrangian = vx**2 + vx * vy / 2 + vy**2 * 3 / 4 - (3 * x**2 + x * y + 2 * y**2) / 2 + (x * vy - y * vx) + 2 * x
    system = vv.Lagrangian(
        lagrangian,
        [x, y],
        velocities=[vx, vy],
        dissipation=vx**2 / 32 + vy**2 / 16,
        position=[0.5, -0.25],
        velocity=[0.0, 1.0],
    )
    mass = np.array([[2.0, 0.5], [0.5, 1.5]])
    stiffness = np.array([[3.0, 0.5], [0.5, 2.0]])
    damping = np.array([[1 / 16, -2.0], [2.0, 1 / 8]])
    with mpmath.workdps(60):
        inverse = mpmath.matrix(mass.tolist()) ** -1
        blocks = [inverse * mpmath.matrix((-each).tolist()) for each in (stiffness, damping)]
        drive = inverse * mpmath.matrix([2.0, 0.0])
        rows = [[0, 0, 1, 0, 0], [0, 0, 0, 1, 0]]
        rows += [[blocks[0][i, 0], blocks[0][i, 1], blocks[1][i, 0], blocks[1][i, 1], drive[i]] for i in (0, 1)]
        rows += [[0] * 5]
        for end in (0.25, 10.0, 200.0, -1.0):
            wanted = exactly(rows, [0.5, -0.25, 0.0, 1.0, 1.0], end)
            out = system.run(end)
            assert out.method == "matrix_exponential"
            assert np.abs(out.position[-1] - wanted[:2]).max() < 5e-16
            assert np.abs(out.velocity[-1] - wanted[2:4]).max() < 5e-16


def test_hamiltonians_and_free_particles() -> None:
    p = sp.symbols("p")
    system = vv.Hamiltonian(p**2 / 2 + 3 * x, [x], p=[p], position=[1.0], momentum=[2.0])
    out = system.run(1e5)
    # x = 1 + 2t - 3t²/2, exact in doubles.
    assert out.method == "matrix_exponential"
    assert out.position[-1, 0] == 1 + 2e5 - 1.5e10
    assert out.momentum[-1, 0] == 2 - 3e5


def test_copies_have_the_bits_that_they_have_alone() -> None:
    lengths = np.linspace(0.5, 3.0, 13)
    many = OSCILLATOR.ensemble(parameters={"k": lengths})
    for threads in (1, 3):
        out = many.run([1.0, 2.5], threads=threads)
        for member, stiffness in enumerate(lengths):
            alone = OSCILLATOR.at(parameters={"k": stiffness}).run([1.0, 2.5])
            assert np.array_equal(out.position[member], alone.position)


@pytest.mark.parametrize(
    "lagrangian",
    [
        vx**2 / 2 - x**4,
        vx**2 / 2 - vv.time * x,
        vx**2 * (1 + x**2) / 2,
        vx**2 / 2 + sp.cos(x) - x**4,
    ],
    ids=str,
)
def test_what_is_not_linear_takes_steps(lagrangian: sp.Expr) -> None:
    system = vv.Lagrangian(lagrangian, [x], velocities=[vx], position=[0.5], velocity=[0.25])
    assert system.run(0.5).method == "gauss16"
    with pytest.raises(vv.InvalidInput, match="needs linear equations with constant coefficients"):
        system.run(0.5, method="matrix_exponential")


def test_it_agrees_with_steps_and_is_said_by_the_plan() -> None:
    system = vv.systems.coupled_oscillators()
    plan = system.plan(10.0)
    assert plan.method == "matrix_exponential"
    assert "linear" in str(plan)
    at_once, stepped = system.run(10.0), system.run(10.0, method="gauss16")
    assert np.abs(at_once.position[-1] - stepped.position[-1]).max() < 1e-14
    # A step that is asked for is taken.
    assert system.run(10.0, dt=0.125).method == "gauss16"


def test_what_grows_beyond_all_numbers_is_told() -> None:
    system = vv.Lagrangian(vx**2 / 2 + x**2 / 2, [x], velocities=[vx], position=[1.0], velocity=[0.0])
    assert abs(system.run(10.0).position[-1, 0] / float(mpmath.cosh(10)) - 1) < 4e-16
    with pytest.raises(vv.ConvergenceError) as caught:
        system.run([1.0, 1e4])
    assert len(caught.value.trajectory.t) == 1


@pytest.mark.parametrize("coordinates", [1, 3, 4, 8])
def test_a_unit_of_mass_changes_no_small_motion(coordinates: int) -> None:
    """m times a Lagrangian without units, m down to 1e-120: the determinant of M vanishes, but not its inverse."""
    masses = 1e-120, 1e-91, 1.0, 1e80
    for mass in masses:
        system = vv.Lagrangian(
            lambda q, v, t, m=mass: m * sum(v[i] ** 2 - q[i] ** 2 for i in range(coordinates)) / 2 - m * q[0] ** 4 / 4,
            [f"q{i}" for i in range(coordinates)],
            position=np.zeros(coordinates),
        )
        assert len(system.equilibria(near=[np.zeros(coordinates)])) == 1
        # One square root each, of numbers that are exact.
        assert system.linearize(at=np.zeros(coordinates)).frequencies == pytest.approx(
            [1.0] * coordinates, rel=1e-15, abs=0
        )
