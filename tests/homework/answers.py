"""What each task of `docs/homework.md` must give: closed forms worked out to 30 digits by mpmath, none by visviva.

Numbers that the tasks print as decimals enter as exact decimals; angles in radians. A quadrature stands where there is
no closed form.
"""

from collections.abc import Callable
from typing import Any

from mpmath import (
    acos,
    atan,
    atan2,
    cos,
    cosh,
    diff,
    ellipfun,
    ellipk,
    exp,
    findroot,
    lambertw,
    log,
    mp,
    mpf,
    pi,
    polyroots,
    quad,
    sin,
    sqrt,
)

with mp.workdps(30):
    g = mpf("9.81")


def throw_from_balcony() -> list[Any]:
    angle = pi * 50 / 180
    t = (20 * sin(angle) + sqrt(400 * sin(angle) ** 2 + 2 * g * mpf("1.8"))) / g
    return [t, 20 * cos(angle) * t]


def about_a_point() -> list[Any]:
    """L = r × p with r = (0, 2, −2), p = (1, −2, 6); torque r × (0, 0, −2g)."""
    return [2 * 6 - (-2) * (-2), -2 * 1 - 0, 0 - 2 * 1, -4 * g, 0, 0]


def spring_pair() -> Any:
    """The reduced mass oscillates at √(8/3) about the length 1; the first is 3/4 of it from the center at 9/8."""
    return mpf(9) / 8 - mpf(3) / 4 * (1 + cos(2 * sqrt(mpf(8) / 3)) / 2)


def viscous_return() -> Any:
    s = 1 + 12 / (g * mpf("1.5"))
    return mpf("1.5") * (s + lambertw(-s * exp(-s)).real)


def both_laws() -> Any:
    b, k = mpf("0.5"), mpf("0.3")
    return log(1 + k * 4 / b * (1 - exp(-b * 2))) / k


def damped() -> Any:
    rate = mpf("0.3")
    w = sqrt(4 - rate**2)
    return exp(-5 * rate) * (cos(5 * w) + rate / w * sin(5 * w))


def hoop() -> list[Any]:
    rest = acos(g / 16)
    return [rest, 4 * sin(rest)]


def morse() -> Any:
    """E = 1/2 of a depth 1: ω = √(2 (1 − E))."""
    return 2 * pi / sqrt(2 * (1 - mpf("0.5")))


def ellipse() -> list[Any]:
    half = mpf("0.5")
    anomaly = findroot(lambda u: u - half * sin(u) - 2, 2)
    return [cos(anomaly) - half, sqrt(1 - half**2) * sin(anomaly)]


def oscillator_range() -> list[Any]:
    """r² + L²/2r² = 3."""
    root = sqrt(mpf(9) - 2 * mpf("1.5") ** 2)
    return [sqrt((3 - root) / 2), sqrt((3 + root) / 2)]


def laboratory_angles() -> list[Any]:
    psi = mpf("1.1")
    return [atan2(sin(psi), cos(psi) + mpf("0.25")), (pi - psi) / 2]


def decrement() -> Any:
    alpha = (mpf(11) / 13) ** 2
    return 1 + alpha / (1 - alpha) * log(alpha)


def bounce() -> list[Any]:
    """Along the line of centers the impulse is (1 + ε) μ times the speed of approach."""
    n = [cos(mpf("0.5")), sin(mpf("0.5"))]
    impulse = mpf("1.6") * (mpf("2.5") / mpf("3.5")) * 4 * n[0]
    return [4 - impulse * n[0], -impulse * n[1], impulse * n[0] / mpf("2.5"), impulse * n[1] / mpf("2.5")]


def rutherford() -> list[Any]:
    half, b = mpf("0.7") / (2 * mpf("1.3")), mpf("0.9")
    psi = 2 * atan(half / b)
    return [psi, half + sqrt(half**2 + b**2), (half / 2) ** 2 / sin(psi / 2) ** 4]


def screened() -> Any:
    """ψ = π − 2b ∫ dr / (r² √…) from r₀; with r = r₀/(1 − s²) no root is left at the turning point."""
    energy, b, tiny = mpf("0.8"), mpf("0.9"), mpf("1e-12")

    def left(r: Any) -> Any:
        return 1 - b**2 / r**2 - exp(-r / mpf("1.5")) / (r * energy)

    r0 = findroot(left, mpf("1.2"))
    near = 2 / sqrt(r0 * diff(left, r0))  # the integrand as s → 0
    return pi - 2 * b / r0 * (tiny * near + quad(lambda s: 2 * s / sqrt(left(r0 / (1 - s**2))), [tiny, 1]))


def tumbling() -> list[Any]:
    """From ω₂ = 0 with 2E = 3.25, L² = 9.25 and L² > 2E·B: ω₃ a dn, ω₁ a cn, ω₂ a sn."""
    a, b, c, w1, w3 = 1, 2, 3, mpf("0.5"), mpf(1)
    m = mpf((b - a) * (c * (a * w1**2 + c * w3**2) - (a**2 * w1**2 + c**2 * w3**2))) / (
        (c - b) * ((a**2 * w1**2 + c**2 * w3**2) - a * (a * w1**2 + c * w3**2))
    )
    u = sqrt(mpf(c - b) * ((a**2 * w1**2 + c**2 * w3**2) - a * (a * w1**2 + c * w3**2)) / (a * b * c)) * mpf("2.5")
    largest = sqrt((c * (a * w1**2 + c * w3**2) - (a**2 * w1**2 + c**2 * w3**2)) / (b * mpf(c - b)))
    # B ω₂′ = (C − A) ω₃ ω₁ > 0 at the start.
    return [w1 * ellipfun("cn", u, m=m), largest * ellipfun("sn", u, m=m), w3 * ellipfun("dn", u, m=m)]


def nodding() -> list[Any]:
    """Roots of u′² = (1 − u²)(α − βu) − (a − bu)², the energies without that of the spin."""
    u0, half = cos(mpf("0.5")), mpf("0.5")
    p_psi = half * (6 + mpf("0.6") * u0)
    p_phi = mpf("0.6") * (1 - u0**2) + p_psi * u0
    energy = mpf("0.2") ** 2 / 2 + (p_phi - p_psi * u0) ** 2 / (2 * (1 - u0**2)) + u0
    roots = polyroots(
        [2, -2 * energy - p_psi**2, 2 * p_phi * p_psi - 2, 2 * energy - p_phi**2], maxsteps=200, extraprec=60
    )
    low, high = sorted(r.real for r in roots)[:2]
    return [acos(high), acos(low)]


def precession() -> list[Any]:
    """A cos θ Ω² − C ω₃ Ω + MgR = 0, the slow rate first."""
    a, spin, torque = mpf("6e-4") * cos(mpf("0.6")), mpf("0.02"), mpf("0.5") * mpf("9.80665") * mpf("0.04")
    root = sqrt(spin**2 - 4 * a * torque)
    return [(spin - root) / (2 * a), (spin + root) / (2 * a)]


ANSWERS: tuple[Callable[[], Any], ...] = (
    lambda: [-6, -1],
    lambda: sqrt(mpf("1.3271244e20") / 149597870700),
    lambda: 2 * 3 * mpf("0.2") / pi,
    throw_from_balcony,
    lambda: mpf("0.6") / mpf("0.25"),
    about_a_point,
    lambda: 2 * pi * mpf("1.5") ** 2,
    spring_pair,
    lambda: mpf(3) / 8 * 9,
    lambda: sqrt(2 * g / mpf("1.5") * (1 - cos(2))),
    lambda: 3 * mpf("0.8") * (1 - exp(-mpf("2.5"))),
    viscous_return,
    lambda: [30 / sqrt(1 + mpf("2.25")), 400 / (2 * g) * log(1 + mpf("2.25"))],
    both_laws,
    lambda: mpf("0.3") * cos(10) - sin(10) / 4,
    damped,
    lambda: (cos(mpf("10.5")) - cos(14)) / (4 - mpf("2.25")),
    lambda: 4 / sqrt(g) * ellipk(sin(mpf("1.25")) ** 2),
    hoop,
    lambda: [1 + g / 5 * mpf("0.7") ** 2 / 2, 12 * g / 5],
    lambda: mpf("0.4") * cosh(3),
    lambda: [1, sqrt(mpf("1.2"))],
    lambda: 4 * pi * sqrt(mpf("0.3") / g),
    lambda: [sqrt(g * (2 - sqrt(2))), sqrt(g * (2 + sqrt(2)))],
    # q = sin u: 4 √2 ∫ du / √(1 + sin² u), a complete integral of the parameter −1.
    lambda: 4 * sqrt(2) * ellipk(-1),
    morse,
    # E/ω.
    lambda: (mpf(1) / 4 + mpf("1.5") / 4) / sqrt(mpf(3) / 2),
    ellipse,
    # r = 1 + cos η: t = η + sin η.
    lambda: [pi / 2 + 1, pi],
    lambda: 2 * pi / sqrt(1 - mpf("0.1")),
    oscillator_range,
    laboratory_angles,
    decrement,
    bounce,
    rutherford,
    screened,
    # M s² of (1/6, 11/12, 11/12).
    lambda: [mpf(1) / 12, mpf(11) / 24, mpf(11) / 24],
    tumbling,
    nodding,
    precession,
)
