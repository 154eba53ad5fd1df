"""Deflections to thirty digits without the package: potentials written out again, and the textbook's integral.

ψ = π − 2b ∫₀^{u₀} du/√(1 − b²u² − V/E), u = 1/r, with u = u₀(1 − s²) to take the root out: nothing is shared with the
core but the definitions of the potentials.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import mpmath as mp

if TYPE_CHECKING:
    from collections.abc import Callable

EXPONENTIALS = {
    "zbl": [("0.18175", "3.1998"), ("0.50986", "0.94229"), ("0.28022", "0.40290"), ("0.02817", "0.20162")],
    "moliere": [("0.35", "0.3"), ("0.55", "1.2"), ("0.10", "6.0")],
    "kr_c": [("0.190945", "0.278544"), ("0.473674", "0.637174"), ("0.335381", "1.919249")],
}

#: Potentials that are compared: the name of the class and its parameters.
CASES: list[tuple[object, ...]] = [
    ("ScreenedCoulomb", 1.0, 1.0, "zbl"),
    ("ScreenedCoulomb", 1.0, 1.0, "moliere"),
    ("ScreenedCoulomb", 1.0, 1.0, "kr_c"),
    ("ScreenedCoulomb", 1.0, 1.0, "lenz_jensen"),
    ("LennardJones", 1.0, 1.0),
    ("Mie", 1.0, 1.0, 9.0, 6.0),
    ("Morse", 1.0, 1.3, 1.5),
    ("Yukawa", 1.0, 1.0),
    ("Yukawa", -1.0, 1.0),
    ("PowerLaw", 1.0, 3.0),
    ("PowerLaw", -1.0, 1.5),
    ("PowerLaw", -1.0, 6.0),
    ("Plummer", 1.0, 1.0),
    ("Plummer", -1.0, 1.0),
    ("Buckingham", 1000.0, 3.0, 5.0),
    ("SoftSphere", 3.0, 1.0, 2.5),
]


def number(x: object) -> mp.mpf:
    """A float is itself."""
    return mp.mpf(x)


def screening(name: str) -> Callable[[mp.mpf], mp.mpf]:
    if name == "lenz_jensen":

        def lenz_jensen(x: mp.mpf) -> mp.mpf:
            y = mp.sqrt(mp.mpf("9.67") * x)
            return mp.exp(-y) * (1 + y + mp.mpf("0.3344") * y**2 + mp.mpf("0.0485") * y**3 + mp.mpf("0.002647") * y**4)

        return lenz_jensen
    # The core's amplitudes and rates are the nearest float64.
    terms = [(mp.mpf(float(a)), mp.mpf(float(rate))) for a, rate in EXPONENTIALS[name]]
    return lambda x: sum(a * mp.exp(-rate * x) for a, rate in terms)


def potential(kind: str, *parameters: object) -> Callable[[mp.mpf], mp.mpf]:
    """V(r) of a potential by the name of its class."""
    if kind == "ScreenedCoulomb":
        k, length, name = number(parameters[0]), number(parameters[1]), str(parameters[2])
        phi = screening(name)
        return lambda r: k * phi(r / length) / r
    p = [number(x) for x in parameters]
    formulas: dict[str, Callable[[mp.mpf], mp.mpf]] = {
        "LennardJones": lambda r: 4 * p[0] * ((p[1] / r) ** 12 - (p[1] / r) ** 6),
        "Morse": lambda r: p[0] * ((1 - mp.exp(-p[1] * (r - p[2]))) ** 2 - 1),
        "Yukawa": lambda r: p[0] * mp.exp(-r / p[1]) / r,
        "PowerLaw": lambda r: p[0] / r ** p[1],
        "Plummer": lambda r: p[0] / mp.sqrt(r * r + p[1] * p[1]),
        "Buckingham": lambda r: p[0] * mp.exp(-p[1] * r) - p[2] / r**6,
        "SoftSphere": lambda r: p[0] * (1 - r / p[1]) ** p[2] if r < p[1] else mp.mpf(0),
        "Mie": lambda r: _mie(p, r),
    }
    return formulas[kind]


def _mie(p: list[mp.mpf], r: mp.mpf) -> mp.mpf:
    epsilon, sigma, n, m = p
    front = n / (n - m) * (n / m) ** (m / (n - m))
    return front * epsilon * ((sigma / r) ** n - (sigma / r) ** m)


def angle(V: Callable[[mp.mpf], mp.mpf], energy: float, b: float, near: float, edges: tuple[float, ...] = ()) -> mp.mpf:
    """ψ with the turning point that is near a distance; ``edges`` are where V is not smooth."""
    with mp.workdps(40):
        E, B = mp.mpf(energy), mp.mpf(b)

        def h(r: mp.mpf) -> mp.mpf:
            return r * r * (1 - V(r) / E) - B * B

        r0 = mp.findroot(
            h, (mp.mpf(near) * (1 - mp.mpf("1e-9")), mp.mpf(near) * (1 + mp.mpf("1e-9"))), tol=mp.mpf("1e-70")
        )
        u0 = 1 / r0

        def integrand(s: mp.mpf) -> mp.mpf:
            if s == 0:
                s = mp.mpf("1e-15")
            u = u0 * (1 - s * s)
            if u <= 0:
                return 2 * u0 * s
            rest = 1 - (B * u) ** 2 - V(1 / u) / E
            return 2 * u0 * s / mp.sqrt(rest)

        # Towards u = 0 exponentials are gone, but not analytic: by decades.
        marks = [
            mp.mpf(0),
            mp.mpf("0.3"),
            mp.mpf("0.7"),
            mp.mpf("0.9"),
            mp.mpf("0.97"),
            mp.mpf("0.99"),
            mp.mpf("0.999"),
            mp.mpf(1),
        ]
        marks += [mp.sqrt(1 - r0 / mp.mpf(edge)) for edge in edges if edge > r0]
        value = mp.quad(integrand, sorted(marks))
        return mp.re(mp.pi - 2 * B * value)
