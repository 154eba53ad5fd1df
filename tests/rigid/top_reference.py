"""A heavy top by Taylor series in 40 digits, which knows the equations of motion of the body alone.

The axes of the body are integrated, not angles, so that the poles are places as others are.
"""

from collections.abc import Sequence

import mpmath

import visviva as vv

ORDER = 40


def taylor(
    top: vv.rigid.HeavyTop, angles: Sequence[float], rates: Sequence[float], times: Sequence[float]
) -> list[list[mpmath.mpf]]:
    """Quaternions (x, y, z, w) at rising times from (θ, φ, ψ) and their rates, the binary64 numbers themselves."""
    with mpmath.workdps(40):
        a, c = mpmath.mpf(top.A), mpmath.mpf(top.C)
        torque = mpmath.mpf(top.mass * top.g * top.R)
        theta, phi, psi = map(mpmath.mpf, angles)
        theta_dot, phi_dot, psi_dot = map(mpmath.mpf, rates)
        up, down = (phi + psi) / 2, (phi - psi) / 2
        cosine, sine = mpmath.cos(theta / 2), mpmath.sin(theta / 2)
        turn = [sine * mpmath.cos(down), sine * mpmath.sin(down), cosine * mpmath.sin(up), cosine * mpmath.cos(up)]
        whole_sine, whole_cosine = mpmath.sin(theta), mpmath.cos(theta)
        spin = [
            phi_dot * whole_sine * mpmath.sin(psi) + theta_dot * mpmath.cos(psi),
            phi_dot * whole_sine * mpmath.cos(psi) - theta_dot * mpmath.sin(psi),
            psi_dot + phi_dot * whole_cosine,
        ]
        state, now, results = [*turn, *spin], mpmath.mpf(0), []
        fastest = mpmath.norm(spin) + mpmath.sqrt(4 * torque / a)
        for time in map(mpmath.mpf, times):
            steps = max(1, int(abs(time - now) * fastest * 1.2) + 1)
            h = (time - now) / steps
            for _ in range(steps):
                state = _step(state, a, c, torque, h)
            now = time
            results.append(state[:4])
        return results


def _step(state: list[mpmath.mpf], a: mpmath.mpf, c: mpmath.mpf, torque: mpmath.mpf, h: mpmath.mpf) -> list[mpmath.mpf]:
    series = [[part] for part in state]
    x, y, z, w, one, two, three = series

    def times(p: list[mpmath.mpf], q: list[mpmath.mpf], n: int) -> mpmath.mpf:
        return mpmath.fdot(p[: n + 1], q[n::-1])

    for n in range(ORDER):
        # The vertical in the body: the third row of the rotation matrix. The torque is M g R e₃ × vertical, times −1.
        first = 2 * (times(x, z, n) - times(y, w, n))
        second = 2 * (times(y, z, n) + times(x, w, n))
        rates = [
            (times(w, one, n) + times(y, three, n) - times(z, two, n)) / 2,
            (times(w, two, n) + times(z, one, n) - times(x, three, n)) / 2,
            (times(w, three, n) + times(x, two, n) - times(y, one, n)) / 2,
            -(times(x, one, n) + times(y, two, n) + times(z, three, n)) / 2,
            ((a - c) * times(two, three, n) + torque * second) / a,
            ((c - a) * times(one, three, n) - torque * first) / a,
            mpmath.mpf(0),
        ]
        for part, rate in zip(series, rates, strict=True):
            part.append(rate / (n + 1))
    return [sum(term * h**order for order, term in enumerate(part)) for part in series]
