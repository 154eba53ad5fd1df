"""Numbers that hardly move beside others: what rounding gives to them chooses no steps.

Bounds: ten times what the two methods part by, of coordinates of ten links.
"""

from __future__ import annotations

import numpy as np
import pytest

import visviva as vv

#: Links in one line fall as one pendulum at first: further down they turn with higher powers of the time.
LINE = [0.5] * 10


def test_equal_steps_of_links_in_one_line_converge() -> None:
    """Steps of 0.05, and chosen ones, against dop853; they were refused as steps whose stages do not converge."""
    chain = vv.systems.chain(10, position=LINE)
    by_dop853 = chain.run(1.0, method="dop853", rtol=1e-14)._states[-1]
    for dt in (0.02, 0.05, None):
        assert np.abs(chain.run(1.0, dt=dt)._states[-1] - by_dop853).max() <= 1e-13


@pytest.mark.parametrize("method", ["gauss16", "gauss8"])
def test_copies_of_links_in_one_line_have_the_bits_that_they_have_alone(method: str) -> None:
    """Rounding is judged lane by lane."""
    positions = np.array([LINE, [0.1] * 10, [0.5 + 0.0625 * k for k in range(10)], [1.5] * 10, LINE])
    chain = vv.systems.chain(10, position=LINE)
    together = chain.ensemble(position=positions).run(0.5, method=method)
    for index, position in enumerate(positions):
        alone = chain.at(position=position).run(0.5, method=method)
        assert alone._states[-1].tobytes() == together._states[index, -1].tobytes()
        assert alone.steps == together.steps[index]
