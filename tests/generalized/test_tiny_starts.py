"""Starts with a number that is next to nothing beside the others: what is of the size of round-off costs no steps.

cos(π/2) is 6e-17 in doubles, and copies are perturbed by 1e-8: a first step is short beside such a number, and none
that is held. Bounds of steps: some three for each time that a step grows fourfold from 1e-18, and those of the motion.
"""

import numpy as np
import pytest

import visviva as vv

TINY = [1e-300, 1e-18, 6e-17, 1e-12, 1e-8, -1e-8]
#: From 1e-300 a thousand octaves are passed.
MOST = {1e-300: 600}

SYSTEMS = {
    "cart, place": lambda x: vv.systems.cart_pendulum(position=[x, 1.0], velocity=[0.0, 0.0]),
    "cart, velocity": lambda x: vv.systems.cart_pendulum(position=[0.0, 1.0], velocity=[x, 0.0]),
    "double pendulum": lambda x: vv.systems.double_pendulum(position=[1.0, x]),
    "separable": lambda x: vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2.0 - 9.81 * q[1] - q[0] ** 4,
        ["x", "y"],
        position=[1.0, 0.0],
        velocity=[0.0, x],
    ),
    "rod": lambda x: vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2.0 - 9.81 * q[1],
        ["x", "y"],
        constraints=[lambda q, v, t: q[0] ** 2 + q[1] ** 2 - 1.0],
        position=[1.0, x],
        consistent="project",
    ),
}


@pytest.mark.parametrize("name", SYSTEMS)
@pytest.mark.parametrize("tiny", TINY)
@pytest.mark.parametrize("method", ["auto", "gauss8"])
def test_a_tiny_number_takes_few_steps(name: str, tiny: float, method: str) -> None:
    """And what comes of it is what comes of 0, but for what the number itself makes: at most a thousand times it."""
    out, plain = (SYSTEMS[name](x).run(1.0, method=method, max_steps=2000) for x in (tiny, 0.0))
    assert out.steps <= plain.steps + MOST.get(tiny, 100)
    within = 1e3 * abs(tiny) + (1e-12 if method == "auto" else 1e-7)
    assert out.position[-1] == pytest.approx(plain.position[-1], rel=0, abs=within)


@pytest.mark.parametrize("threads", [1, 3])
def test_copies_with_tiny_numbers_have_the_bits_that_they_have_alone(threads: int) -> None:
    starts = np.array([[1.0, x] for x in (0.0, *TINY, 0.5, 1e-10)])
    out = vv.systems.double_pendulum(position=[1.0, 0.0]).ensemble(position=starts).run(1.0, threads=threads)
    for k, start in enumerate(starts):
        alone = vv.systems.double_pendulum(position=start).run(1.0)
        assert np.array_equal(out.position[k], alone.position)


@pytest.mark.parametrize("off", [0.0, 1e-12, 1e-9])
def test_a_pendulum_that_begins_upright(off: float) -> None:
    """Its force is the rounding of its angle: a few thousand steps for a turn, and energy to the last digits."""
    upright = vv.systems.pendulum(position=[np.pi - off])
    out = upright.run(np.linspace(0.0, 60.0, 601), max_steps=5000)
    assert np.ptp(out.energy) <= 1e-12 * (1.0 + abs(out.energy[0]))
    copies = upright.ensemble(position=[[np.pi - off], [np.pi - off - 1e-7], [1.0]]).run(60.0, max_steps=5000)
    assert np.array_equal(copies.position[0, -1], upright.run(60.0).position[-1])


def test_exponents_beside_a_cyclic_coordinate() -> None:
    """The frame that derivatives are turned to has numbers of the size of round-off, of Kepler in polar coordinates.

    All four exponents of a regular motion are zero; what derivatives grow by in a time is a power of it. Of momenta
    they add up to nothing, to the rounding of a growth of 1e3.
    """
    system = vv.systems.central_force(velocity=[0.0, 1.2])
    for form in (system, system.hamiltonian()):
        assert np.abs(form.lyapunov_exponents(1000.0)).max() < 10.0 * np.log(1000.0) / 1000.0
    assert abs(system.hamiltonian().lyapunov_exponents(1000.0).sum()) < 1e-9
