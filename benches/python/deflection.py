"""Full-quadrature deflection angles against a numba loop and SciPy, in one run and on one core.

Energies log-uniform in 1e-3 … 1e2 of the potential's unit, b² uniform up to ten of its lengths, as a Monte Carlo asks.
The peers: ten points of Gauss and Mehler with Newton's turning point, of the universal screened potential, compiled by
numba; and `scipy.optimize.brentq` with `scipy.integrate.quad` of the same integral. Errors are the largest against the
tightest tolerance, which is checked against forty digits in `tests/scattering`.

    python benches/python/deflection.py [pairs]
"""

from __future__ import annotations

import sys
from math import pi

import numba
import numpy as np
from _harness import Row, at_most, faster, minima, report
from scipy.integrate import quad
from scipy.optimize import brentq

import visviva as vv

p, s = vv.potentials, vv.scattering
AMPLITUDES, RATES = (0.18175, 0.50986, 0.28022, 0.02817), (3.1998, 0.94229, 0.40290, 0.20162)
ZBL = p.ScreenedCoulomb(1.0, 1.0, "zbl")
OTHERS = {
    "Molière": p.ScreenedCoulomb(1.0, 1.0, "moliere"),
    "Yukawa": p.Yukawa(1.0, 1.0),
    "Thomas–Fermi": p.ScreenedCoulomb(1.0, 1.0, "thomas_fermi"),
    "Lennard-Jones above orbiting": p.LennardJones(1e-3, 1.0),
}
POINTS = 10


@numba.njit(fastmath=True)
def value(r: float) -> float:
    total = 0.0
    for i in range(4):
        total += AMPLITUDES[i] * np.exp(-RATES[i] * r)
    return total / r


@numba.njit(fastmath=True)
def peer(energy: np.ndarray, b: np.ndarray) -> np.ndarray:
    angle = np.empty_like(energy)
    nodes = np.cos((2.0 * np.arange(1, POINTS + 1) - 1.0) * pi / (4.0 * POINTS))
    for k in range(len(energy)):
        e, impact = energy[k], b[k]
        # From outside Newton's steps come down on the root of a potential that repels.
        r = 0.5 / e + np.sqrt(0.25 / (e * e) + impact * impact)
        for _ in range(50):
            phi, slope = 0.0, 0.0
            for i in range(4):
                term = AMPLITUDES[i] * np.exp(-RATES[i] * r)
                phi += term
                slope -= RATES[i] * term
            step = (r * r - r * phi / e - impact * impact) / (2.0 * r - (phi + r * slope) / e)
            r -= step
            if abs(step) < 1e-9 * r:
                break
        total = 0.0
        for i in range(POINTS):
            u = nodes[i]
            total += np.sqrt((1.0 - u * u) / (1.0 - value(r / u) / e - (impact * u / r) ** 2))
        angle[k] = pi - impact / r * total * pi / POINTS
    return angle


def by_scipy(energy: np.ndarray, b: np.ndarray) -> np.ndarray:
    found = []
    for e, impact in zip(energy, b, strict=True):

        def phi(r: float) -> float:
            return float(sum(a * np.exp(-rate * r) for a, rate in zip(AMPLITUDES, RATES, strict=True)))

        r0 = brentq(lambda r: 1.0 - phi(r) / r / e - (impact / r) ** 2, 1e-9, 0.5 / e + impact + 1.0 / e, xtol=1e-14)  # noqa: B023

        def integrand(t: float) -> float:
            u = 1.0 - t * t
            return 2.0 * t / np.sqrt(1.0 - phi(r0 / u) * u / r0 / e - (impact * u / r0) ** 2) if 0.0 < u < 1.0 else 0.0  # noqa: B023

        found.append(pi - 2.0 * impact / r0 * quad(integrand, 0.0, 1.0, epsabs=1e-11, epsrel=1e-11)[0])
    return np.array(found)


def pairs(n: int) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(1)
    return 10.0 ** random.uniform(-3.0, 2.0, n), 10.0 * np.sqrt(random.uniform(0.0, 1.0, n))


def rows(n: int) -> list[Row]:
    energy, b = pairs(n)
    peer(energy[:10], b[:10])
    few = 200
    exact = s.deflect(ZBL, energy=energy, impact_parameter=b, tolerance=1e-13).angle
    off = np.abs(peer(energy, b) - exact).max()
    made = []
    for tolerance in (1e-10, 1e-12):

        def ours(potential: p.Potential = ZBL, tolerance: float = tolerance) -> np.ndarray:
            asked = {"energy": energy, "impact_parameter": b, "tolerance": tolerance, "threads": 1}
            return s.deflection_angle(potential, **asked)

        bar = tolerance == 1e-10
        slow, fast = minima(lambda: peer(energy, b), ours)
        per = [f"{seconds / n * 1e9:.0f} ns" for seconds in (fast, slow)]
        what = f"ZBL to {tolerance:g} against {POINTS} points of Gauss–Mehler in numba, {off:.0e} off"
        made.append(faster(what, *per, slow / fast, 4.0 if bar else None))
        (slow,) = minima(lambda: by_scipy(energy[:few], b[:few]), repeats=2)
        ratio = (slow / few) / (fast / n)
        per = [f"{fast / n * 1e9:.0f} ns", f"{slow / few * 1e6:.0f} µs"]
        made.append(
            faster(f"ZBL to {tolerance:g} against SciPy's brentq and quad", *per, ratio, 500.0 if bar else None)
        )
        made.append(at_most(f"ZBL to {tolerance:g}: largest error", np.abs(ours() - exact).max(), tolerance))
        for name, potential in OTHERS.items():
            (fast,) = minima(lambda: ours(potential))  # noqa: B023
            exactly = s.deflect(potential, energy=energy, impact_parameter=b, tolerance=1e-13)
            # What rounding of E and b makes of the angle is not the quadrature's.
            left = np.abs(ours(potential) - exactly.angle) - 1e-15 * exactly.conditioning
            what = f"{name} to {tolerance:g}: {fast / n * 1e9:.0f} ns; largest error"
            made.append(at_most(what, max(float(left.max()), 0.0), tolerance))
    return made


def main() -> None:
    n = int(float(sys.argv[1])) if len(sys.argv) > 1 else 100_000
    report("Deflection angles", rows(n), f"{n} pairs, one thread; least of several repeats in turns.")


if __name__ == "__main__":
    main()
