"""Tables and expressions are prepared once: what a scene runs again is there, and every other potential is another."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

import numpy as np

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable


def scene(potential: vv.potentials.Potential) -> vv.Scene:
    return vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]), vv.CentralField(potential))


def fastest(action: Callable[[], object]) -> float:
    """Of several runs, in which nobody else had the processor."""

    def once() -> float:
        begun = time.perf_counter()
        for _ in range(20):
            action()
        return time.perf_counter() - begun

    return min(once() for _ in range(7))


def test_asking_again_costs_about_what_a_formula_costs() -> None:
    """A table of ten numbers and an expression took twenty and forty times a formula's time, at every call."""
    r = np.linspace(0.2, 5.0, 10)
    plummer = scene(vv.potentials.Plummer(-1.0, 1.0))
    others = [vv.potentials.Custom(lambda r: -np.exp(-r * r)), vv.potentials.Tabulated(r, 1.0 / r)]
    of_formula = fastest(plummer.acceleration)
    for other in others:
        # 1.3 here; the rest is for a busy machine.
        assert fastest(scene(other).acceleration) < 6.0 * of_formula


def test_potentials_that_differ_by_a_few_digits_are_told_apart() -> None:
    """Hundreds of them, more than are kept, asked for in turns: each has the force of its own table."""
    r = np.linspace(0.2, 5.0, 40)
    strengths = 1.0 + np.arange(150) * 1e-13
    scenes = [scene(vv.potentials.Tabulated(r, strength / r)) for strength in strengths]
    customs = [
        scene(vv.potentials.Custom(lambda r, k: -k / (1.0 + r * r), parameters={"k": float(k)})) for k in strengths
    ]
    for _ in range(2):
        for strength, table, custom in zip(strengths, scenes, customs, strict=True):
            # The force is proportional to the strength, but for the rounding of its table.
            at_one = table.acceleration()[0, 0] / scenes[0].acceleration()[0, 0]
            np.testing.assert_allclose(at_one, strength, rtol=2e-14, atol=0)
            np.testing.assert_allclose(custom.acceleration()[0, 0], -strength / 2.0, rtol=4e-16, atol=0)


def test_a_table_in_other_units_is_the_same_table() -> None:
    """Powers of two: the bits of the motion stay."""
    r = np.array([0.0, 0.5, 1.0, 1.25, 1.5, 2.5, 4.0, 8.0])
    v = np.array([3.0, 1.0, 1e-3, 0.7, 0.9, 2.0, 2.5, 9.0])
    bodies = vv.Particles([1.0, 0.5], [[1.0, 0.1, 0.0], [-1.0, 0.2, 0.3]], [[0.0, 0.5, 0.0], [0.1, 0.0, -0.4]])
    here = vv.Scene(bodies, vv.CentralField(vv.potentials.Tabulated(r, v)))
    for exponents in ((40, 3, -20), (-100, 10, 80)):
        length, mass, duration = (2.0**n for n in exponents)
        there = here.rescaled(length=length, mass=mass, time=duration)
        out = here.run(t=4.0, rtol=1e-9), there.run(t=4.0 * duration, rtol=1e-9)
        np.testing.assert_array_equal(out[0].position[-1] * length, out[1].position[-1])


def test_threads_that_prepare_at_once_get_what_they_asked_for() -> None:
    r = np.linspace(0.2, 5.0, 200)
    found: dict[int, float] = {}

    def work(number: int) -> None:
        for _ in range(50):
            found[number] = float(scene(vv.potentials.Tabulated(r, (1.0 + number) / r)).acceleration()[0, 0])

    workers = [threading.Thread(target=work, args=(number,)) for number in range(8)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    # 1/r through 200 points, 0.024 apart, is known to 1e-6 of its force.
    np.testing.assert_allclose([found[number] for number in range(8)], 1.0 + np.arange(8), rtol=1e-5, atol=0)
