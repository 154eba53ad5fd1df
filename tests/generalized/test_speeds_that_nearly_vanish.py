"""A root that turns within a step, as a speed that nearly vanishes, is seen by the polynomial of the step: its terms do
not fall as those of a smooth motion."""

import numpy as np
import pytest
import sympy as sp

import visviva as vv

x, y, vx, vy, drag = sp.symbols("x y vx vy drag", real=True)

ACROSS = (1e-1, 1e-2, 1e-3, 1e-4)


def dragged(across: float, coefficient: float) -> vv.Lagrangian:
    """Give a body that turns in x while it passes slowly in y: drag by the square of its speed turns sharply there."""
    return vv.Lagrangian(
        (vx**2 + vy**2) / 2 - (x**2 + 2 * y**2) / 2 - sp.sin(x) / 3,
        [x, y],
        velocities=[vx, vy],
        position=[1.0, 0.0],
        velocity=[0.0, across],
        dissipation=drag * (vx**2 + vy**2) ** sp.Rational(3, 2) / 3,
        parameters={drag: coefficient},
    )


@pytest.mark.parametrize("coefficient", [0.05, 0.5])
@pytest.mark.parametrize("across", ACROSS)
def test_auto_is_as_close_as_it_was_asked_to_be(across: float, coefficient: float) -> None:
    system = dragged(across, coefficient)
    out = system.run(15.0)
    assert out.stats.method == "gauss16"
    wanted, by_another = (system.run(15.0, method=method, rtol=1e-14) for method in ("verner98", "dop853"))
    # Both are explicit, in many short steps about the turn, and agree to rounding.
    assert np.abs(wanted.position - by_another.position).max() < 1e-14
    # Ten times the tolerance of a step (1e-12), of a dozen turns; before, it was up to 1e-9.
    assert np.abs(out.position - wanted.position).max() < 1e-11


def test_copies_take_the_steps_that_each_takes_alone() -> None:
    copies = dragged(0.1, 0.5).ensemble(velocity=[[0.0, across] for across in ACROSS])
    out = copies.run(15.0)
    for index, across in enumerate(ACROSS):
        alone = dragged(across, 0.5).run(15.0)
        assert np.array_equal(out.position[index], np.broadcast_to(alone.position, out.position[index].shape))
