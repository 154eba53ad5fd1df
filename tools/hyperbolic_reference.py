"""Write tests/reference/hyperbolic.json: hyperbolic anomalies from their mean anomaly, to 420 digits with mpmath.

python tools/hyperbolic_reference.py
"""

import json
from pathlib import Path

from mpmath import asinh, cosh, mp, mpf, sinh

TARGET = Path(__file__).parents[1] / "tests" / "reference" / "hyperbolic.json"
ATTRACTIVE = (1.0 + 1e-15, 1.0 + 1e-9, 1.001, 1.5, 30.0, 1e10)
REPULSIVE = (1.0 + 1e-15, 1.5, 1e10)
MEANS = (1e-300, 1e-160, 1e-47, 1e-20, 3e-8, 0.7, 12.0, 1e5, 1e30, 7e99, 1e155, 1e160, 3e200, 1e300)


def anomaly(mean: float, eccentricity: float, sign: int) -> float:
    """H of M = e sinh H + sign · H: bisection to a part in 2⁶⁰, then Newton's iteration."""
    m, e = mpf(mean), mpf(eccentricity)
    high = asinh(m / e) + 1
    while e * sinh(high) + sign * high < m:
        high *= 2
    low = high
    while e * sinh(low) + sign * low > m:
        high, low = low, low / 2
    for _ in range(60):
        middle = (low + high) / 2
        if e * sinh(middle) + sign * middle > m:
            high = middle
        else:
            low = middle
    h = (low + high) / 2
    for _ in range(9):
        h -= (e * sinh(h) + sign * h - m) / (e * cosh(h) + sign)
    return float(h)


def main() -> None:
    # M = 1e-300 and e = 1 + 1e-15: sinh H - H loses 190 digits.
    mp.dps = 420
    cases = [
        {"mean": mean, "eccentricity": e, "repulsive": sign > 0, "hyperbolic": anomaly(mean, e, sign)}
        for sign, eccentricities in ((-1, ATTRACTIVE), (1, REPULSIVE))
        for e in eccentricities
        for mean in MEANS
    ]
    lines = ",\n ".join(json.dumps(case) for case in cases)
    TARGET.write_text(f'{{"cases": [\n {lines}\n]}}\n', encoding="utf-8")


if __name__ == "__main__":
    main()
