"""Cross sections of any central potential: differential, total, of capture, of transport; stopping."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Literal

import numpy as np

from visviva import _core
from visviva._arrays import float_array, number, positive, whole_number
from visviva._keywords import known_keywords, one_of
from visviva.errors import InvalidInput
from visviva.scattering._arguments import angles as checked_angles
from visviva.scattering._structure import described, orbits

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.potentials import Potential

__all__ = [
    "capture_cross_section",
    "collision_integral",
    "cross_section",
    "nuclear_stopping",
    "total_cross_section",
    "transport_cross_section",
]

_FRAMES = ("cm", "lab", "recoil")


@known_keywords
def cross_section(
    potential: Potential,
    *,
    energy: float,
    angle: ArrayLike,
    frame: Literal["cm", "lab", "recoil"] = "cm",
    mass_ratio: float | None = None,
) -> NDArray[np.float64]:
    """Differential cross section dσ/dΩ, all branches together.

    Units: energies and lengths are those of the potential, angles in radians.

    Parameters
    ----------
    potential : Potential
        Any that goes to 0 far out.
    energy : float
        Of relative motion, ½μu² = beam energy · m₂/(m₁ + m₂).
    angle : array_like
        In [0, π]; in [0, π/2] for recoils.
    frame : {"cm", "lab", "recoil"}
        What the angle is: of the center-of-mass frame, of the projectile in the laboratory, or of the target there.
    mass_ratio : float, optional
        m₁/m₂; needed for ``"lab"``.

    Returns
    -------
    ndarray
        Area per steradian. Infinite at rainbows and glories and, for a potential that ends nowhere or goes to 0 where
        it ends, at angle 0; 0 where nothing goes. What is captured goes nowhere. Of the shape of the arguments,
        broadcast.

    Raises
    ------
    InvalidInput
        For an energy or ratio that is not positive, or an angle out of range.

    References
    ----------
    H. Goldstein, C. Poole, J. Safko, *Classical Mechanics*, 3rd ed., §3.10–3.11.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.scattering.cross_section(vv.potentials.HardSphere(2.0), energy=1.0, angle=[0.5, 2.0, np.pi])
    array([1., 1., 1.])
    """
    one_of("frame", frame, _FRAMES)
    if frame == "lab" and mass_ratio is None:
        raise InvalidInput("mass_ratio", "expected m1/m2, which the laboratory frame needs, got None")
    angles = checked_angles("angle", angle, np.pi / 2.0 if frame == "recoil" else np.pi)
    ratio = 1.0 if mass_ratio is None else positive("mass_ratio", mass_ratio)
    found = _core.differential_cross_section(
        described(potential), positive("energy", energy), angles.ravel(), frame, ratio
    )
    return found.reshape(angles.shape)[()]


@known_keywords
def total_cross_section(
    potential: Potential, *, energy: float, theta_min: float | None = None, b_max: float | None = None
) -> float:
    """Total cross section, of a potential that ends somewhere or with a cut.

    Units: those of the potential: energies, and areas of its lengths; angles in radians.

    Parameters
    ----------
    potential : Potential
        Any that goes to 0 far out.
    energy : float
        Of relative motion, positive.
    theta_min : float, optional
        The area of all impact parameters with an angle of at least this from the beam; captured ones are among them.
    b_max : float, optional
        Or the area of a disc, π b_max².

    Returns
    -------
    float
        An area.

    Raises
    ------
    InvalidInput
        If both cuts are given; or none, and the potential ends nowhere, so that the area is infinite.

    References
    ----------
    L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §18.

    Examples
    --------
    >>> import visviva as vv
    >>> across = 3.141592653589793 / 2
    >>> round(vv.scattering.total_cross_section(vv.potentials.Coulomb(1.0), energy=0.5, theta_min=across), 12)
    3.14159265359
    """
    description, e = described(potential), positive("energy", energy)
    if theta_min is not None and b_max is not None:
        raise InvalidInput("b_max", "expected one cut, got theta_min and b_max; leave one out")
    if b_max is not None:
        return float(np.pi * positive("b_max", b_max) ** 2)
    if theta_min is not None:
        least = checked_angles("theta_min", number("theta_min", theta_min))
        return float(_core.beyond_angle(description, e, least.ravel())[0])
    area = float(_core.beyond_angle(description, e, np.zeros(1))[0])
    radius = _core.scattering_range(description)
    if not np.isfinite(radius):
        raise InvalidInput(
            "theta_min",
            "expected a cut, got None: the total cross section of a potential that ends nowhere is infinite; give the "
            "smallest angle that counts, theta_min, or the largest impact parameter, b_max",
        )
    return max(area, float(np.pi * radius**2))


@known_keywords
def capture_cross_section(potential: Potential, *, energy: ArrayLike) -> NDArray[np.float64]:
    """Area of all impact parameters that fall into the center, π b_c².

    Units: those of the potential: energies, and areas of its lengths; angles in radians.

    Parameters
    ----------
    potential : Potential
        Any that goes to 0 far out.
    energy : array_like
        Of relative motion, positive.

    Returns
    -------
    ndarray
        0 where nothing is captured. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        As `deflect`.

    References
    ----------
    P. Langevin, Ann. Chim. Phys. 5 (1905) 245; L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §18 (fall to the
    center).

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> area = vv.scattering.capture_cross_section(vv.potentials.PowerLaw(-1.0, 4), energy=[1.0, 4.0])
    >>> area / (2.0 * np.pi)  # Langevin: 2π √(C/E)
    array([1. , 0.5])
    """
    energies = float_array("energy", energy, None)
    if (wrong := energies <= 0.0).any():
        raise InvalidInput("energy", f"expected positive numbers, got {energies[wrong][0]}")
    found = orbits(potential, energies.ravel())
    edges = [max((b for b, _, captures in some if captures), default=0.0) for some in found]
    areas: NDArray[np.float64] = np.pi * np.square(np.array(edges))
    return areas.reshape(energies.shape)[()]


@known_keywords
def transport_cross_section(
    potential: Potential, *, energy: ArrayLike, order: int = 1, threads: int | None = None
) -> NDArray[np.float64]:
    """Transport cross section Q^(l)(E) = 2π ∫ (1 − cos^l ψ) b db: of momentum for l = 1, of viscosity for l = 2.

    Units: those of the potential: energies, and areas of its lengths; angles in radians.

    Parameters
    ----------
    potential : Potential
        One that falls faster than 1/r and captures nothing.
    energy : array_like
        Of relative motion, positive.
    order : int
        l, at least 1.
    threads : int, optional
        By default ``VISVIVA_THREADS``, else all cores.

    Returns
    -------
    ndarray
        Areas, to about ten digits. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For a potential with an infinite one or with capture; as `deflect`.

    References
    ----------
    J. O. Hirschfelder, C. F. Curtiss, R. B. Bird, *Molecular Theory of Gases and Liquids* (1954), §8.2.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> (vv.scattering.transport_cross_section(vv.potentials.HardSphere(1.0), energy=1.0) / np.pi).round(12)
    np.float64(1.0)
    """
    energies = float_array("energy", energy, None)
    if (wrong := energies <= 0.0).any():
        raise InvalidInput("energy", f"expected positive numbers, got {energies[wrong][0]}")
    found = _core.transport_cross_sections(
        described(potential), energies.ravel(), whole_number("order", order, 1, 100), _threads(threads)
    )
    return found.reshape(energies.shape)[()]


@known_keywords
def collision_integral(
    potential: Potential,
    *,
    temperature: ArrayLike,
    orders: tuple[int, int] = (1, 1),
    diameter: float,
    threads: int | None = None,
) -> NDArray[np.float64]:
    """Reduced collision integral Ω^(l,s)*, the kinetic theory's mean of a transport cross section.

    Units: `temperature` and `diameter` in those of the potential.

    Parameters
    ----------
    potential : Potential
        One that falls faster than 1/r and captures nothing.
    temperature : array_like
        k_B T, an energy.
    orders : tuple of int
        l and s: (1, 1) for diffusion, (2, 2) for viscosity and heat conduction.
    diameter : float
        Of the hard spheres that it is relative to: σ of a Lennard-Jones potential.
    threads : int, optional
        By default ``VISVIVA_THREADS``, else all cores.

    Returns
    -------
    ndarray
        Without dimension; 1 for hard spheres of that diameter. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        As `transport_cross_section`.

    References
    ----------
    J. O. Hirschfelder, C. F. Curtiss, R. B. Bird, *Molecular Theory of Gases and Liquids* (1954), §8.2; Monchick and
    Mason's tables, which are widely used, are 0.6 % off at the highest temperatures.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.collision_integral(vv.potentials.HardSphere(2.0), temperature=0.3, diameter=2.0).round(8)
    np.float64(1.0)
    """
    temperatures = float_array("temperature", temperature, None)
    if (wrong := temperatures <= 0.0).any():
        raise InvalidInput("temperature", f"expected positive numbers, got {temperatures[wrong][0]}")
    listed = orders if isinstance(orders, Iterable) else [orders]
    pair = tuple(whole_number("orders", order, 1, 20) for order in listed)
    if len(pair) != 2:
        raise InvalidInput("orders", f"expected two numbers, l and s, got {orders!r}")
    found = _core.collision_integrals(
        described(potential),
        temperatures.ravel(),
        (pair[0], pair[1]),
        positive("diameter", diameter),
        _threads(threads),
    )
    return found.reshape(temperatures.shape)[()]


@known_keywords
def nuclear_stopping(
    potential: Potential, *, beam_energy: ArrayLike, masses: tuple[float, float], threads: int | None = None
) -> NDArray[np.float64]:
    """Nuclear stopping S_n = ∫ T dσ: what elastic collisions with resting targets cost, per target and area.

    Units: those of the potential, energy times its length²; masses in one unit, any.

    Parameters
    ----------
    potential : Potential
        One that falls faster than 1/r and captures nothing.
    beam_energy : array_like
        Of the projectile in the laboratory.
    masses : tuple of float
        Projectile and target.
    threads : int, optional
        By default ``VISVIVA_THREADS``, else all cores.

    Returns
    -------
    ndarray
        Energy times area: 2 m₁m₂/(m₁+m₂)² E Q^(1). Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        As `transport_cross_section`.

    References
    ----------
    J. F. Ziegler, J. P. Biersack, U. Littmark, *The Stopping and Range of Ions in Solids* (1985).

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> stopping = vv.scattering.nuclear_stopping(vv.potentials.HardSphere(1.0), beam_energy=2.0, masses=(1.0, 1.0))
    >>> (stopping / np.pi).round(12)
    np.float64(1.0)
    """
    pair = float_array("masses", masses, (2,))
    if (wrong := pair <= 0.0).any():
        raise InvalidInput("masses", f"expected two positive numbers, got {pair[wrong][0]}")
    beam = float_array("beam_energy", beam_energy, None)
    if (wrong := beam <= 0.0).any():
        raise InvalidInput("beam_energy", f"expected positive numbers, got {beam[wrong][0]}")
    share = pair / pair.sum()
    momentum = transport_cross_section(potential, energy=beam * share[1], threads=threads)
    stopping: NDArray[np.float64] = 2.0 * share[0] * share[1] * beam * momentum
    return stopping


def _threads(threads: object) -> int | None:
    return None if threads is None else whole_number("threads", threads, 1, 1024)
