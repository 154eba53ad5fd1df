"""The potential in which a heavy top nods, and the momenta that it is made of."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from visviva._html import brief_tuple
from visviva._keywords import known_keywords

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.rigid._heavy_top import HeavyTop

__all__ = ["TopMomenta", "effective_potential", "weight"]


@known_keywords
class TopMomenta(NamedTuple):
    """The two momenta of a top that stay what they are.

    Units: those of the caller, one consistent system; angles in radians.

    Attributes
    ----------
    p_phi : float
        About the vertical.
    p_psi : float
        About the top's axis, C ω₃.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.7.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
    >>> top.momenta(np.pi / 2, psi_dot=50.0).p_psi
    50.0
    """

    p_phi: float
    p_psi: float

    def __repr__(self) -> str:
        return brief_tuple(self)


def weight(top: HeavyTop) -> float:
    """M g R, the largest torque of gravity; tops for which it leaves the range of float64 are refused when made."""
    return top.mass * top.g * top.R


def effective_potential(top: HeavyTop, theta: NDArray[np.float64], p_phi: float, p_psi: float) -> NDArray[np.float64]:
    """(p_φ − p_ψ cos θ)²/(2A sin²θ) + M g R cos θ.

    The numerator is taken from the nearer end, p_φ − p_ψ + 2 p_ψ sin²(θ/2) or p_φ + p_ψ − 2 p_ψ cos²(θ/2), so that it
    keeps its digits where the axis is upright or hangs.
    """
    sine, cosine = np.sin(0.5 * theta), np.cos(0.5 * theta)
    upper = theta <= 0.5 * np.pi
    near, far = np.where(upper, sine, cosine), np.where(upper, cosine, sine)
    apart = np.where(upper, p_phi - p_psi, p_phi + p_psi)
    # Over sin θ = 2 sin(θ/2) cos(θ/2), term by term: the first is there only if the momenta differ.
    with np.errstate(divide="ignore", invalid="ignore"):
        barrier = np.where(apart == 0.0, 0.0, apart / (2.0 * near * far))
    rate = barrier + np.where(upper, 1.0, -1.0) * p_psi * (near / far)
    potential: NDArray[np.float64] = 0.5 * rate * rate / top.A + weight(top) * np.cos(theta)
    return potential
