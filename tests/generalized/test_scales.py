"""Answers that depend on no unit: symmetries, equilibria, periods and starts of systems of any size."""

from typing import Any

import numpy as np
import pytest

import visviva as vv


def trap(width: float, ratio: float, *, position: Any = None) -> vv.Lagrangian:
    """A Gaussian trap of a width, wider in one direction."""

    def L(q: Any, v: Any, t: Any, s: Any) -> Any:
        return (v[0] ** 2 + v[1] ** 2) / 2 + np.exp(-(q[0] ** 2 + ratio * q[1] ** 2) / (2 * s * s))

    place = [width, 0.0] if position is None else position
    return vv.Lagrangian(L, ["x", "y"], parameters={"s": width}, position=place, velocity=[0.0, 0.1])


def turn(q: Any, v: Any, t: Any, **parameters: Any) -> list[Any]:
    return [-q[1], q[0]]


@pytest.mark.parametrize("width", [1e-12, 1e-3, 1.0, 1e6, 1e11])
def test_a_broken_symmetry_is_broken_in_all_units(width: float) -> None:
    """Angular momentum of an anisotropic trap changes, whatever its width; of an isotropic one it does not."""
    assert not trap(width, 1.5).noether(turn).holds
    assert not trap(width, 1.0 + 1e-6).noether(turn).holds
    assert trap(width, 1.0).noether(turn).holds
    # The start need not be in the trap: parameters are lengths too.
    assert not trap(width, 1.5, position=[0.0, 0.0]).noether(turn).holds


def test_the_oblate_earth_turns_about_one_axis_only() -> None:
    """J₂ in SI units, from 7000 km: a thousandth of the attraction, which is 1e-6 of what random metres would see."""
    GM, radius = 3.986e14, 6.378e6
    J = 1.08e-3 * GM * radius**2

    def L(q: Any, v: Any, t: Any) -> Any:
        r2 = q[0] ** 2 + q[1] ** 2 + q[2] ** 2
        attraction = GM / np.sqrt(r2) + J / 2 * (r2 - 3 * q[2] ** 2) / r2**2.5
        return (v[0] ** 2 + v[1] ** 2 + v[2] ** 2) / 2 + attraction

    earth = vv.Lagrangian(L, ["x", "y", "z"], position=[7e6, 0, 0], velocity=[0, 5e3, 5e3])
    assert earth.noether(lambda q, v, t: [-q[1], q[0], 0.0]).holds
    about_x = earth.noether(lambda q, v, t: [0.0, -q[2], q[1]])
    assert not about_x.holds
    assert np.ptp(about_x.conserved(earth.run(np.linspace(0.0, 6e3, 4)))) > 1e8


def test_a_small_term_that_breaks_a_symmetry_is_not_drowned() -> None:
    """A pull of 1e-14 beside an attraction of 1: seen where it is as large as what it adds to."""

    def pulled(pull: float) -> vv.Lagrangian:
        return vv.Lagrangian(
            lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - (q[0] ** 2 + q[1] ** 2) - pull * q[0],
            ["x", "y"],
            position=[1.0, 0.2],
            velocity=[0.3, 0.8],
        )

    assert not pulled(1e-14).noether(turn).holds
    assert pulled(0.0).noether(turn).holds


def test_what_cannot_be_seen_is_not_called_a_symmetry() -> None:
    """A trap of a width that nothing tells: no state of a size at hand sees its slope."""
    hidden = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 + np.exp(-((q[0] - 0.5) ** 2) / 1e-40),
        ["x", "y"],
        position=[1.0, 0.2],
        velocity=[0.3, 0.8],
    )
    with pytest.raises(vv.InvalidInput, match="not decided"):
        hidden.noether(turn)
    H = vv.Hamiltonian(lambda q, p, t: (p[0] ** 2 + q[0] ** 2) / 2, ["x"], position=[1.0])
    with pytest.raises(vv.InvalidInput, match="not decided"):
        H.is_canonical(lambda q, p, t: [q[0] + 1e-20 * np.exp(-((q[0] - 0.5) ** 2) / 1e-40), p[0]])


@pytest.mark.parametrize("width", [1e-9, 1.0, 1e9])
def test_a_transformation_is_judged_at_its_own_size(width: float) -> None:
    """Q = x (1 + exp(−x²/a²)): dQ/dx is 1 far away only, and at x = a it is 1 − 1/e."""
    H = vv.Hamiltonian(lambda q, p, t: (p[0] ** 2 + q[0] ** 2) / 2, ["x"], position=[width], momentum=[0.0])
    assert not H.is_canonical(lambda q, p, t: [q[0] * (1 + np.exp(-((q[0] / width) ** 2))), p[0]])
    assert H.is_canonical(lambda q, p, t: [q[0] * 3.0 * width, p[0] / (3.0 * width)])
