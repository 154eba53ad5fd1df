"""Write tests/reference/kepler.json: Kepler's problem to at least 60 of 180 digits, inputs as exact binary64.

The method is deliberately not the library's: classical eccentric, hyperbolic and parabolic anomalies with 180
digits, so that their cancellations (near-parabolic, near-circular, radial) cost nothing that matters.
Each expected number is a pair (high, low) of binary64 whose sum carries 31 digits. `condition` is the sum over
the inputs of |relative change of the answer| / |relative change of the input|: how many ulps the rounding of
the inputs alone is worth.

Run: python tools/kepler_reference.py (needs mpmath; a few minutes).
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from mpmath import asinh, atan2, cbrt, cos, cosh, floor, mp, mpf, pi, sin, sinh, sqrt

mp.dps = 180
ROOT = Path(__file__).resolve().parent.parent
Vector = list[Any]


def dot(a: Vector, b: Vector) -> Any:
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a: Vector, b: Vector) -> Vector:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def root(function: Any, low: Any, high: Any) -> Any:
    """The root of an increasing function with derivative: bisection to 12 bits, then guarded Newton."""
    for step in range(4000):
        middle = (low + high) / 2
        value, slope = function(middle)
        if value > 0:
            high = middle
        else:
            low = middle
        if step < 12 or slope == 0:
            continue
        s = middle
        for _ in range(60):
            value, slope = function(s)
            if slope == 0:
                break
            change = value / slope
            if not low <= s - change <= high:
                break
            s -= change
            if abs(change) <= abs(s) * mpf(10) ** -70:
                return s
    raise ArithmeticError("no root")


def state(mu: Any, r: Vector, v: Vector, t: Any) -> tuple[Vector, Vector]:
    """Position and velocity at t of the orbit through (r, v) at 0."""
    if mu == 0:
        return [x + u * t for x, u in zip(r, v, strict=True)], list(v)
    distance = sqrt(dot(r, r))
    eta, normal = dot(r, v), cross(r, v)
    h = sqrt(dot(normal, normal))
    beta = 2 * mu / distance - dot(v, v)
    lrl = [a - mu * b / distance for a, b in zip(cross(v, normal), r, strict=True)]
    zeta = sqrt(dot(lrl, lrl))
    towards = [x / (zeta or 1) for x in lrl]
    if zeta < abs(mu) * mpf(10) ** -100:
        zeta, towards = mpf(0), [x / distance for x in r]
    along = [x / h for x in cross(normal, towards)] if h else [mpf(0)] * 3
    if beta > 0:
        e, w = zeta / mu, sqrt(beta)
        a, n = mu / beta, w**3 / mu
        start = atan2(eta * w, mu - beta * distance) if zeta else mpf(0)
        mean = start - e * sin(start) + n * t
        mean -= 2 * pi * floor(mean / (2 * pi) + mpf(1) / 2)
        sign = -1 if mean < 0 else 1
        target = abs(mean)
        anomaly = (
            sign * root(lambda E: (E - e * sin(E) - target, 1 - e * cos(E)), mpf(0), pi * (1 + mpf(10) ** -20))
            if mean
            else mpf(0)
        )
        radius = a * (1 - e * cos(anomaly))
        x, y = a * (cos(anomaly) - e), h * sin(anomaly) / w
        u, z = -mu * sin(anomaly) / w / radius, h * cos(anomaly) / radius
    elif beta < 0:
        w = sqrt(-beta)
        q = (zeta - mu) / w**2
        start = asinh(eta * w / zeta)
        flight = zeta * sinh(start) - mu * start + w**3 * t
        sign = -1 if flight < 0 else 1
        target = abs(flight)
        top = asinh(target / zeta) + 2 + cbrt(6 * target / zeta) + (target / zeta)
        top = min(top, asinh(2 * target / zeta) + 60)
        anomaly = (
            sign * root(lambda H: (zeta * sinh(H) - mu * H - target, zeta * cosh(H) - mu), mpf(0), top)
            if flight
            else mpf(0)
        )
        radius = q + zeta * (cosh(anomaly) - 1) / w**2
        x, y = q - mu * (cosh(anomaly) - 1) / w**2, h * sinh(anomaly) / w
        u, z = -mu * sinh(anomaly) / w / radius, h * cosh(anomaly) / radius
    else:
        q = h**2 / (2 * mu)
        start = eta / mu
        flight = q * start + mu * start**3 / 6 + t
        sign = -1 if flight < 0 else 1
        target = abs(flight)
        top = cbrt(6 * target / mu) * 2 + 1
        s = (
            sign * root(lambda s: (q * s + mu * s**3 / 6 - target, q + mu * s**2 / 2), mpf(0), top)
            if flight
            else mpf(0)
        )
        radius = q + mu * s**2 / 2
        x, y, u, z = q - mu * s**2 / 2, h * s, -mu * s / radius, h / radius
    position = [x * p + y * q for p, q in zip(towards, along, strict=True)]
    return position, [u * p + z * q for p, q in zip(towards, along, strict=True)]


def pair(value: Any) -> list[float]:
    high = float(value)
    return [high, float(value - mpf(high))]


def size(a: Vector) -> Any:
    return sqrt(dot(a, a))


def case(kind: str, mu: float, r: list[float], v: list[float], t: float) -> dict[str, Any]:
    """One case; `condition` by one-sided differences of relative size 1e-30."""
    inputs = [mpf(mu), *map(mpf, r), *map(mpf, v), mpf(t)]

    def answer(values: Vector) -> tuple[Vector, Vector]:
        return state(values[0], values[1:4], values[4:7], values[7])

    position, velocity = answer(inputs)
    conditions = [mpf(0), mpf(0)]
    for i in range(8):
        if inputs[i] == 0:
            continue
        moved = list(inputs)
        moved[i] *= 1 + mpf(10) ** -30
        for k, (new, old) in enumerate(zip(answer(moved), (position, velocity), strict=True)):
            difference = size([a - b for a, b in zip(new, old, strict=True)])
            conditions[k] += difference / size(old) * mpf(10) ** 30
    return {
        "class": kind,
        "mu": mu,
        "position": r,
        "velocity": v,
        "time": t,
        "expected_position": [pair(x) for x in position],
        "expected_velocity": [pair(x) for x in velocity],
        "condition": [float(c) for c in conditions],
    }


# An orthonormal pair in a general direction (3-4-5 and 5-12-13 rotations).
FIRST = (0.6 * 12 / 13, 0.8 * 12 / 13, 5 / 13)
SECOND = (-0.8, 0.6, 0.0)


def start(mu: float, e: float, q: float, anomaly: float) -> tuple[list[float], list[float]]:
    """A binary64 state near true anomaly `anomaly` of the conic (mu > 0) with pericenter distance q."""
    p = q * (1 + e)
    radius = p / (1 + e * math.cos(anomaly)) if anomaly != math.pi else q * (1 + e) / (1 - e)
    speed = math.sqrt(mu / p)
    c, s = math.cos(anomaly), math.sin(anomaly) if anomaly != math.pi else 0.0
    r = [radius * (c * a + s * b) for a, b in zip(FIRST, SECOND, strict=True)]
    v = [speed * (-s * a + (e + c) * b) for a, b in zip(FIRST, SECOND, strict=True)]
    return r, v


def grid() -> list[dict[str, Any]]:
    cases = []
    fractions = [1e-20, 1e-6, 0.003, 0.1, 0.37, 0.5, 0.73, 1.0, -0.25, -1.3, 1000.3, 1e6 + 0.2, 1e9 + 0.7]
    for label, e in [
        ("0", 0.0),
        ("1e-8", 1e-8),
        ("0.1", 0.1),
        ("0.5", 0.5),
        ("0.9", 0.9),
        ("0.99", 0.99),
        ("0.999999", 0.999999),
        ("1-1e-12", 1 - 1e-12),
        ("1-1e-15", 1 - 1e-15),
    ]:
        mu, a = 1.3, 1.7
        period = 2 * math.pi * math.sqrt(a**3 / mu)
        for k, anomaly in enumerate([0.0, 1.0, -2.5, math.pi]):
            r, v = start(mu, e, a * (1 - e), anomaly)
            chosen = fractions if e in (0.5, 0.999999, 1 - 1e-12) else fractions[k % 2 :: 2]
            cases.extend(case(f"ellipse e={label}", mu, r, v, fraction * period) for fraction in chosen)
    spans = [1e-20, 1e-6, 0.01, 0.3, 1.0, 10.0, -3.0, 1e3, -1e6, 1e12]
    for label, e in [("1+1e-12", 1 + 1e-12), ("1.5", 1.5), ("10", 10.0), ("1e6", 1e6)]:
        mu, q = 0.7, 1.1
        unit = math.sqrt(q**3 / mu / (1 + e))
        for anomaly in [0.0, 1.0, -1.5 if e > 1.2 else -3.0]:
            r, v = start(mu, e, q, anomaly)
            cases += [case(f"hyperbola e={label}", mu, r, v, span * unit) for span in spans]
    # r = (2, 1, 2)·k has |r| = 3k and v² = 2 mu/r is a binary64 number: beta is exactly 0.
    for v in ([0.0, 0.0, 1.0], [0.6875, -0.5, 0.25], [2.0, 1.0, 2.0], [-1.0, 0.5, 0.25]):
        speed2 = sum(x * x for x in v)
        cases += [case("parabola exact", 1.5 * speed2, [2.0, 1.0, 2.0], v, span) for span in [*spans, -0.4, 1e15]]
    for v in ([0.0, 0.0, 0.0], [0.25, 0.5, 0.5], [-0.25, -0.5, -0.5]):
        cases += [case("radial bound", 1.0, [0.5, 1.0, 1.0], v, span) for span in [*spans[:8], 0.7, 1.6, -2.2, 1e6]]
    for v in ([1.0, 2.0, 2.0], [-1.0, -2.0, -2.0]):
        cases += [case("radial unbound", 1.0, [0.5, 1.0, 1.0], v, span) for span in [*spans, 0.4, -0.4, -0.6]]
    for mu, r, v in [
        (-1.0, [0.5, 1.0, 1.0], [0.0, 0.0, 0.0]),
        (-1.0, [3.0, 0.1, -0.2], [-1.0, 0.25, 0.5]),
        (-2.5, [3.0, 6.0, 6.0], [-1.0, -2.0, -2.0]),
        (-1e-6, [1.0, 0.3, 0.2], [-1.0, 0.1, 0.7]),
        (-1.0, [30.0, 1e-9, 0.0], [-0.5, 0.0, 0.0]),
    ]:
        cases += [case("repulsive", mu, r, v, span) for span in [*spans, 70.0, 60.0]]
    for mu, r, v, t in [
        (1.5, [1.25, 0.0, 0.0], [0.25, 0.875, 0.0], 3.0),
        (1.0, [1.0, 0.0, 0.0], [0.25, 1.75, 0.0], 2.0),
        (1.0, [0.5, 0.0, 0.0], [0.0, 2.0, 0.0], 1.0),
        (4.0, [1.0, 0.0, 0.0], [0.0, 1.5, 0.5], 2.0),
    ]:
        cases.append(case("golden", mu, r, v, t))
    for v in ([0.2, -0.3, 0.9], [-1.0, 0.0, 0.0]):
        cases += [case("free", 0.0, [1.0, 0.0, -2.0], v, span) for span in (1e-20, 1.0, -1e6)]
    # Near-radial: the pericenter is 1e-12 … 1e-24 of the distance.
    for transverse in (1e-6, 1e-9, 1e-12):
        cases += [
            case("near-radial", 1.0, [2.0, 0.0, 0.0], [0.0, transverse, 0.0], t)
            for t in (0.1, 1.0, 2.0, 3.0, 3.14, 3.1415926, 3.141592653589793, 3.5, 6.0, 6.283185307179586, 1e5)
        ]
    return cases


if __name__ == "__main__":
    document = {
        "about": "Kepler's problem, binary64 inputs taken as exact; written by tools/kepler_reference.py",
        "digits": mp.dps,
        "cases": grid(),
    }
    path = ROOT / "tests" / "reference" / "kepler.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    head = {key: value for key, value in document.items() if key != "cases"}
    lines = ",\n".join(json.dumps(entry) for entry in document["cases"])
    path.write_text(json.dumps(head)[:-1] + ', "cases": [\n' + lines + "\n]}\n")
    print(len(document["cases"]), "cases")
