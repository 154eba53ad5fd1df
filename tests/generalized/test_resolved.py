"""Runs in equal steps that resolve nothing say so, as scenes do."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import visviva as vv

SAYS = r"the energy at the end is off by .* of kinetic \+ \|potential\|: a step of dt"


@pytest.mark.parametrize("hamiltonian", [False, True])
def test_a_step_beyond_the_limit_of_stability(hamiltonian: bool) -> None:
    """ωh = 3: Runge-Kutta's fourth order multiplies an oscillation by 1.5 each step; leapfrog by 7 (ωh > 2)."""
    oscillator: Any = vv.systems.oscillator(k=100.0, m=1.0, position=[1.0])
    oscillator = oscillator.hamiltonian() if hamiltonian else oscillator
    # The momenta of this Hamiltonian are divided by a mass, which splittings refuse.
    for method in ("rk4",) if hamiltonian else ("rk4", "leapfrog"):
        with pytest.warns(vv.AccuracyWarning, match=SAYS):
            oscillator.run(t=30.0, method=method, dt=0.3)


def test_copies_are_named() -> None:
    pendulums = vv.systems.double_pendulum().ensemble(position=[[0.1, 0.1], [2.0, 2.5]])
    with pytest.warns(vv.AccuracyWarning, match="in copy 1, " + SAYS):
        pendulums.run(t=5.0, method="rk4", dt=0.2)


@pytest.mark.parametrize("how", [{"method": "rk4", "dt": 0.01}, {"method": "gauss4", "dt": 0.05}, {}])
def test_what_resolves_it_is_not_blamed(how: dict[str, Any]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        pendulum = vv.systems.double_pendulum(position=[2.0, 2.5])
        pendulum.run(t=5.0, **how)
        # At rest nothing is there to be compared with.
        pendulum.at(position=[0.0, 0.0], velocity=[0.0, 0.0]).run(t=5.0, **how)
        driven = vv.systems.pendulum(position=[np.pi], velocity=[0.0])
        driven.run(t=5.0, **how)
