"""Systems as expressions of SymPy, written as in a textbook: what those of `visviva.systems` must agree with."""

from collections.abc import Callable
from typing import Any

import sympy as sp

import visviva as vv

t = sp.Symbol("t")


def coordinates(names: str) -> tuple[list[Any], list[Any]]:
    """Coordinates and their velocities."""
    found = vv.coordinate(names)
    listed = list(found) if isinstance(found, tuple) else [found]
    return listed, [each.diff(vv.time) for each in listed]


def chain(n: int, **start: Any) -> vv.Lagrangian:
    """A chain of n unit links, by the places of its masses, which SymPy differentiates."""
    q, _ = coordinates(" ".join(f"theta{i + 1}" for i in range(n)))
    g = sp.Symbol("g")
    x, y, total = sp.Integer(0), sp.Integer(0), sp.Integer(0)
    for angle in q:
        x, y = x + sp.sin(angle), y - sp.cos(angle)
        total += (x.diff(t) ** 2 + y.diff(t) ** 2) / 2 - g * y
    return vv.Lagrangian(total, q, parameters={g: 9.81}, **start)


def spherical_pendulum(**start: Any) -> vv.Lagrangian:
    (theta, phi), (rate, turning) = coordinates("theta phi")
    L = (rate**2 + (turning * sp.sin(theta)) ** 2) / 2 + 9.81 * sp.cos(theta)
    return vv.Lagrangian(L, [theta, phi], **start)


def hoop(**start: Any) -> vv.Lagrangian:
    theta, rate = sp.symbols("theta theta_dot")
    R, W, g = sp.symbols("R Omega g", positive=True)
    L = R**2 * rate**2 / 2 + (R * W * sp.sin(theta)) ** 2 / 2 + g * R * sp.cos(theta)
    return vv.Lagrangian(L, [theta], velocities=[rate], parameters={R: 1.0, W: 4.0, g: 9.81}, **start)


def henon_heiles(position: Any, velocity: Any) -> vv.Hamiltonian:
    x, y, px, py = sp.symbols("x y px py")
    H = (px**2 + py**2) / 2 + (x**2 + y**2) / 2 + x**2 * y - y**3 / 3
    return vv.Hamiltonian(H, q=[x, y], p=[px, py], position=position, momentum=velocity)


Make = Callable[..., vv.Lagrangian | vv.Hamiltonian]

BY_SYMBOLS: dict[str, Make] = {
    "henon_heiles": henon_heiles,
    "double_pendulum": lambda **start: chain(2, **start),
    "spherical_pendulum": spherical_pendulum,
    "bead_on_hoop": hoop,
    "chain_10": lambda **start: chain(10, **start),
}

BY_FUNCTIONS: dict[str, Make] = {
    "henon_heiles": lambda position, velocity: vv.systems.henon_heiles(position=position, momentum=velocity),
    "double_pendulum": vv.systems.double_pendulum,
    "spherical_pendulum": vv.systems.spherical_pendulum,
    "bead_on_hoop": vv.systems.hoop,
    "chain_10": vv.systems.chain,
}
