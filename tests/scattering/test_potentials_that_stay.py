"""Potentials that go to a constant far out: nothing scatters off them, and what is to be subtracted is told."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable

FORMULAS: dict[str, tuple[Callable[[Any], Any], float]] = {
    "Morse of the textbooks": (lambda r: (1 - np.exp(-2 * (r - 1.2))) ** 2, 1.0),
    "a hill on a plain": (lambda r: 0.3 + np.exp(-r * r), 0.3),
    "a low plain": (lambda r: -0.3 + np.exp(-r * r), -0.3),
    "hardly a plain": (lambda r: 1e-9 + np.exp(-r * r), 1e-9),
    "a charge on a plain": (lambda r: 1 / r + 0.3, 0.3),
    "a saturation": (lambda r: r / (1 + r), 1.0),
}
ASK: dict[str, Callable[[Any], Any]] = {
    "deflect": lambda p: vv.scattering.deflect(p, energy=2.0, impact_parameter=1.0),
    "cross_section": lambda p: vv.scattering.cross_section(p, energy=2.0, angle=1.0),
    "rainbows": lambda p: vv.scattering.rainbows(p, energy=2.0),
    "transport": lambda p: vv.scattering.transport_cross_section(p, energy=2.0),
}


@pytest.mark.parametrize("ask", ASK)
@pytest.mark.parametrize("name", FORMULAS)
def test_the_constant_is_told(name: str, ask: str) -> None:
    formula, constant = FORMULAS[name]
    with pytest.raises(vv.InvalidInput, match="goes to 0 as r goes to infinity") as refused:
        ASK[ask](vv.potentials.Custom(formula))
    told = float(str(refused.value).split("this one goes to ")[1].split(";")[0])
    assert told == pytest.approx(constant, rel=1e-12, abs=0)


@pytest.mark.parametrize("name", [name for name in FORMULAS if name != "a saturation"])
def test_without_the_constant_they_scatter(name: str) -> None:
    """The Morse potential is that of the package, to rounding of a difference of numbers of about 1."""
    formula, constant = FORMULAS[name]
    less = vv.potentials.Custom(lambda r: formula(r) - constant)
    found = vv.scattering.deflect(less, energy=2.0, impact_parameter=1.0)
    if name == "Morse of the textbooks":
        morse = vv.scattering.deflect(vv.potentials.Morse(1.0, 2.0, 1.2), energy=2.0, impact_parameter=1.0)
        assert found.angle == pytest.approx(float(morse.angle), rel=0, abs=1e-11)
    assert np.isfinite(found.angle)


@pytest.mark.parametrize("scale", [1.0, 1e-100, 1e100])
def test_what_falls_slowly_falls(scale: float) -> None:
    """One over a logarithm, small powers, oscillations that fade, and what is left of √(1 + r²) − r by rounding."""
    for formula in (
        lambda r: scale / np.log(2 + r),
        lambda r: scale * r**-0.01,
        lambda r: scale * r**-0.1,
        lambda r: scale / (1 + np.log(1 + r) ** 2),
        lambda r: scale / (1 + r**6) + scale * 1e-16,
        lambda r: scale * r**4 / (1 + r**10),
        lambda r: scale * (np.sqrt(1 + r * r) - r),
    ):
        found = vv.scattering.deflect(vv.potentials.Custom(formula), energy=2.0 * scale, impact_parameter=1.0)
        assert 0.0 < float(found.angle) < np.pi
