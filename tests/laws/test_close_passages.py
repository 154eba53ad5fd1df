"""What close passages make of a tolerance is told: each multiplies the error of its steps by its speed.

Bodies on an orbit of 1 - e = 1e-6 pass their pericenter a thousand times as fast as they move in the mean.
"""

import warnings

import numpy as np
import pytest

import visviva as vv


def narrow(short: float, *, about: float = 0.0) -> vv.Scene:
    """A light body beside a star, at the far end of an orbit of half an axis 1 and 1 - e = short."""
    speed = np.sqrt(1.001 * short / (2.0 - short))
    place = [[about, 0.0, 0.0], [about + 2.0 - short, 0.0, 0.0]]
    return vv.Scene(vv.Particles([1.0, 1e-3], place, [[0.0, 0.0, 0.0], [0.0, speed, 0.0]]), vv.Gravity(1.0))


@pytest.mark.parametrize("rtol", [1e-9, 1e-12])
def test_an_energy_that_close_passages_lost_is_told(rtol: float) -> None:
    with pytest.warns(vv.AccuracyWarning, match=rf"times rtol = {rtol:g}, .*close passages.*try a smaller rtol"):
        out = narrow(1e-6).run([0.0, 120.0], method="dop853", rtol=rtol, record=("energy",))
    # The record has it, too, beside E itself.
    assert abs(out.energy[-1] / out.energy[0] - 1.0) > 1e4 * rtol
    members = narrow(1e-6).ensemble(velocity=np.stack([narrow(x).particles.velocity for x in (0.5, 1e-6, 0.3)]))
    with pytest.warns(vv.AccuracyWarning, match=r"^in copy 1, the energy at the end .* times rtol"):
        members.run(120.0, method="dop853", rtol=rtol)


@pytest.mark.parametrize("method", ["dop853", "verner98", "taylor"])
@pytest.mark.parametrize("about", [0.0, 1e9])
def test_what_keeps_its_tolerance_is_not_blamed(method: str, about: float) -> None:
    """Nor are energies that only have the last digits of where the bodies are: 1e-7, at 1e9."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        narrow(0.4, about=about).run(120.0, method=method, rtol=1e-12)
        narrow(0.01, about=about).run(60.0, method=method, rtol=1e-10)


def test_who_names_an_absolute_tolerance_has_chosen() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        narrow(1e-4).run(60.0, method="dop853", rtol=1e-9, atol=1e-6)
