"""Write the polynomials of the Thomas-Fermi function, rust/core/src/potentials/thomas_fermi_table.rs, with mpmath.

    python tools/thomas_fermi.py

φ'' = φ^(3/2)/√x, φ(0) = 1, φ(∞) = 0. Its initial slope comes from Majorana's series (S. Esposito, Am. J. Phys. 70
(2002) 852), to 90 digits; then Taylor steps in y = √x, in which φ is analytic at 0. In each piece in y the polynomial
through Chebyshev points. Beyond the last piece 144/x³ Σ aₖ (F x^−λ)ᵏ with λ = (√73 − 7)/2 (Coulson & March, Proc. Phys.
Soc. A 63 (1950) 367), whose F comes from φ there.
"""

from itertools import pairwise
from pathlib import Path

from mpmath import cos, findroot, lu_solve, matrix, mp, mpf, nstr, pi, sqrt

mp.dps = 110
TARGET = Path(__file__).parents[1] / "rust/core/src/potentials/thomas_fermi_table.rs"
DEGREE = 13
EDGES = [mpf(i) / 4 for i in range(6)]
while EDGES[-1] < 32:
    EDGES.append(min(mpf(32), mp.ceil(EDGES[-1] * mpf("1.11") * 16) / 16))


def slope() -> mpf:
    """φ'(0), by Majorana's series about t = 1 summed at t = 0."""
    count = 1300
    a = [mpf(1), 9 - sqrt(mpf(73))]
    # With τ = 1 − t: u' (1 − (1 − τ)² u) = 8 (1 − (1 − τ) u²).
    square = [mpf(1), 2 * a[1]]  # of u
    for m in range(2, count):
        # Coefficient of τ^m on both sides, with what is in it of a[m] apart.
        def bracket(k: int) -> mpf:
            value = -a[k] + (2 * a[k - 1] if k >= 1 else 0) - (a[k - 2] if k >= 2 else 0)
            return value + (1 if k == 0 else 0)

        known_square = sum(a[i] * a[m - i] for i in range(1, m))
        # Left: Σ_j (j + 1) a[j+1] bracket(m − j); bracket(0) = 0, so a[m+1] does not enter.
        left = sum((j + 1) * a[j + 1] * bracket(m - j) for j in range(1, m - 1)) if m > 2 else mpf(0)
        b1 = 2 * a[0] - a[1]
        partial = 2 * a[m - 1] - a[m - 2]  # bracket(m) without −a[m]
        # j = m − 1: m a[m] b1; j = 0: a[1] (partial − a[m]).
        right = -8 * (known_square - square[m - 1])
        # left + m a[m] b1 + a[1] (partial − a[m]) = right − 16 a[m]
        a_m = (right - left - a[1] * partial) / (m * b1 - a[1] + 16)
        a.append(a_m)
        square.append(known_square + 2 * a_m)
    return -((mpf(3) / 16) ** (mpf(1) / 3)) * sum(a)


def series(y0: mpf, value: mpf, rate: mpf, order: int) -> list[mpf]:
    """Taylor coefficients of φ about y0: y φ_yy = φ_y + 4 y² φ^(3/2)."""
    c = [value, rate]
    power = [value ** (mpf(3) / 2)]  # of φ^(3/2)
    for k in range(2, order):
        # Coefficient of h^(k−2) of y φ_yy = φ_y + 4 y² φ^(3/2), y = y0 + h.
        n = k - 2
        while len(power) <= n:
            j = len(power)
            power.append(sum((mpf(3) / 2 * i - (j - i)) * c[i] * power[j - i] for i in range(1, j + 1)) / (j * c[0]))
        force = y0 * y0 * power[n] + (2 * y0 * power[n - 1] if n >= 1 else 0) + (power[n - 2] if n >= 2 else 0)
        c.append(((n + 1) * c[n + 1] - n * (n + 1) * c[n + 1] + 4 * force) / (y0 * k * (k - 1)))
    return c


def start(b: mpf, order: int) -> list[mpf]:
    """Taylor coefficients about y = 0: k (k − 2) c[k] = 4 [φ^(3/2)] at k − 3."""
    c, power = [mpf(1), mpf(0), b], [mpf(1)]
    for k in range(3, order):
        while len(power) <= k - 3:
            j = len(power)
            power.append(sum((mpf(3) / 2 * i - (j - i)) * c[i] * power[j - i] for i in range(1, j + 1)) / j)
        c.append(4 * power[k - 3] / (k * (k - 2)))
    return c


def horner(c: list[mpf], h: mpf) -> tuple[mpf, mpf]:
    value = rate = mpf(0)
    for coefficient in reversed(c):
        rate = rate * h + value
        value = value * h + coefficient
    return value, rate


class Function:
    """φ(y), by steps that are remembered."""

    def __init__(self, b: mpf) -> None:
        self.places, self.coefficients = [mpf(0)], [start(b, 110)]

    def __call__(self, y: mpf) -> tuple[mpf, mpf]:
        while y - self.places[-1] > self.step(self.places[-1]):
            y0 = self.places[-1]
            step = self.step(y0)
            value, rate = horner(self.coefficients[-1], step)
            self.places.append(y0 + step)
            self.coefficients.append(series(y0 + step, value, rate, 110))
        at = max(i for i, place in enumerate(self.places) if place <= y)
        return horner(self.coefficients[at], y - self.places[at])

    @staticmethod
    def step(y0: mpf) -> mpf:
        return mpf(1) / 16 if y0 == 0 else min(y0, 1 + y0 / 4) / 12


def through(function, low: mpf, high: mpf, count: int, middle: mpf, inverse: mpf) -> list[mpf]:  # type: ignore[no-untyped-def]
    """The polynomial in t = (y − middle) inverse through Chebyshev points of a piece."""
    system, right = matrix(count, count), matrix(count, 1)
    for i in range(count):
        y = (low + high + (high - low) * cos(pi * (2 * i + 1) / (2 * count))) / 2
        right[i] = function(y)
        for k in range(count):
            system[i, k] = ((y - middle) * inverse) ** k
    return list(lu_solve(system, right))


def polynomial(phi: Function, low: mpf, high: mpf) -> tuple[list[mpf], mpf, mpf]:
    """Coefficients in t = (y − middle) inverse, middle, inverse; of the first piece about 0, where φ = 1 + B y² + …."""
    if low == 0:
        first = through(lambda y: (phi(y)[0] - 1) / (y * y), low, high, DEGREE - 1, mpf(0), 1 / high)
        return [mpf(1), mpf(0), *(c * high * high for c in first)], mpf(0), 1 / high
    middle, inverse = (low + high) / 2, 2 / (high - low)
    return through(lambda y: phi(y)[0], low, high, DEGREE + 1, middle, inverse), middle, inverse


def tail(count: int) -> list[mpf]:
    """aₖ of 144/x³ Σ aₖ zᵏ, z = F x^−λ, a₁ = −1."""
    lam = (sqrt(mpf(73)) - 7) / 2
    a, power = [mpf(1), mpf(-1)], [mpf(1), mpf(-3) / 2]
    for k in range(2, count):
        rest = sum((mpf(3) / 2 * i - (k - i)) * a[i] * power[k - i] for i in range(1, k)) / k
        # (3 + λk)(4 + λk) aₖ = 12 [Σ]^(3/2)ₖ, in which aₖ enters with 3/2.
        a.append(12 * rest / ((3 + lam * k) * (4 + lam * k) - 18))
        power.append(rest + mpf(3) / 2 * a[k])
    return a


def main() -> None:
    b = slope()
    print("slope", nstr(b, 60))
    phi = Function(b)
    rows = []
    for low, high in pairwise(EDGES):
        solved, middle, inverse = polynomial(phi, low, high)
        places = [low + (high - low) * i / 40 for i in range(41)]
        worst = max(abs(horner(solved, (y - middle) * inverse)[0] / phi(y)[0] - 1) for y in places)
        print(nstr(low, 6), nstr(high, 6), nstr(worst, 3))
        rows.append([low, middle, inverse, *solved])
    lam = (sqrt(mpf(73)) - 7) / 2
    a = tail(40)
    far = EDGES[-1]
    exact = phi(far)[0]
    x = far * far

    def missing(f: mpf) -> mpf:
        z = f * x**-lam
        return 144 / x**3 * sum(c * z**k for k, c in enumerate(a)) / exact - 1

    strength = findroot(missing, mpf("13.27"))
    print("F", nstr(strength, 30), "z at the edge", nstr(strength * x**-lam, 5))
    kept = next(k for k in range(40) if abs(a[k] * (strength * x**-lam) ** k) < mpf(10) ** -19)
    scaled = [c * strength**k for k, c in enumerate(a[: kept + 1])]
    beyond = phi(far * 2)[0]
    z = (4 * x) ** -lam
    print("tail, off by", nstr(144 / (64 * x**3) * sum(c * z**k for k, c in enumerate(scaled)) / beyond - 1, 3))
    number = lambda value: repr(float(value))  # noqa: E731
    text = "//! The polynomials of the Thomas–Fermi function; written by tools/thomas_fermi.py.\n\n"
    text += "/// Where each piece begins in √x, its middle, one over half its length, and coefficients.\n"
    text += f"pub(super) static PIECES: [[f64; {DEGREE + 4}]; {len(rows)}] = [\n"
    text += "".join(f"    [{', '.join(map(number, row))}],\n" for row in rows) + "];\n"
    text += f"/// The end of the last.\npub(super) const END: f64 = {number(far)};\n"
    text += f"/// λ of x^−λ beyond it, …\npub(super) const LAMBDA: f64 = {number(lam)};\n"
    text += "/// … and the coefficients of its powers in x³ φ/144.\n"
    text += f"pub(super) static TAIL: [f64; {len(scaled)}] = [{', '.join(map(number, scaled))}];\n"
    TARGET.write_text(text)


if __name__ == "__main__":
    main()
