"""The deflection function of any central potential: what becomes of an energy and an impact parameter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from visviva import _core
from visviva._arrays import float_array, number, positive, whole_number
from visviva._attributes_elsewhere import OF_DEFLECTIONS, no_attribute
from visviva._html import Sheet, Shown, first_rows
from visviva._keywords import known_keywords
from visviva._made_by import NamedCode
from visviva._parameter import checked_potential
from visviva._text import count
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from visviva.potentials import Potential

__all__ = ["Deflection", "DeflectionStatus", "deflect", "deflection_angle"]


class DeflectionStatus(NamedCode):
    """What became of a projectile.

    `CAPTURED`: it fell into the center, and has no angle. `NEAR_ORBITING`: it left, but its impact parameter is within
    1e-4 of the one with which it would orbit forever, so that the angle has four digits less, or more, than that has.

    Examples
    --------
    >>> import visviva as vv
    >>> langevin = vv.potentials.PowerLaw(-1.0, 4)
    >>> vv.scattering.deflect(langevin, energy=1.0, impact_parameter=[1.0, 2.0]).status.tolist()
    [1, 0]
    """

    SCATTERED = 0
    CAPTURED = 1
    NEAR_ORBITING = 2


@known_keywords
@dataclass(frozen=True, eq=False, repr=False)
class Deflection(Shown):
    """Deflections of pairs of an energy and an impact parameter, as arrays of their common shape.

    Units: those of the potential, energies and lengths; angles in radians.

    Attributes
    ----------
    energy, impact_parameter : ndarray
        What was asked for.
    angle : ndarray
        ψ: positive for repulsion, negative for attraction, not folded into [0, π]; NaN where captured.
    complement : ndarray
        π − |ψ|, with its own digits where ψ is near π.
    closest_approach : ndarray
        The outermost turning point; 0 where captured.
    derivative : ndarray
        dψ/db.
    path_delay : ndarray
        The time lost against free motion, times the speed far out: a length. Infinite where V falls no faster than 1/r.
    error : ndarray
        An estimate of how far the angle may be off, but for what the rounding of energy and impact parameter makes of
        it: of the latter that is `conditioning` times 1e-16. It is that of the potential as it is: a `Tabulated` or a
        `Custom` may be farther from what it stands for, a `Custom` by its ``tolerance``.
    turning_points : ndarray of int
        How many turning points radial motion with this energy and angular momentum has, inner ones too.
    status : ndarray of int
        `DeflectionStatus`.
    reduced_mass : float or None
        As given.
    potential : Potential
        As given.

    References
    ----------
    L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §18.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.scattering.deflect(vv.potentials.Coulomb(1.0), energy=0.5, impact_parameter=[0.0, 1.0])
    >>> found.angle, found.closest_approach
    (array([3.14159265, 1.57079633]), array([2.        , 2.41421356]))
    """

    energy: NDArray[np.float64]
    impact_parameter: NDArray[np.float64]
    angle: NDArray[np.float64]
    complement: NDArray[np.float64]
    closest_approach: NDArray[np.float64]
    derivative: NDArray[np.float64]
    path_delay: NDArray[np.float64]
    error: NDArray[np.float64]
    turning_points: NDArray[np.int64]
    status: NDArray[np.int64]
    potential: Potential
    reduced_mass: float | None = None

    if not TYPE_CHECKING:
        __getattr__ = no_attribute(OF_DEFLECTIONS)

    def __repr__(self) -> str:
        captured = int((self.status == DeflectionStatus.CAPTURED).sum())
        note = f", {captured} captured" if captured else ""
        shape = np.shape(self.angle)
        what = count(int(np.size(self.angle)), "motion")
        return f"Deflection({what} of shape {shape}{note}, {self.potential!r})"

    def _sheet(self) -> Sheet:
        columns = [np.ravel(each) for each in (self.energy, self.impact_parameter, self.angle, self.closest_approach)]
        words = [DeflectionStatus(each).name.lower().replace("_", " ") for each in np.ravel(self.status).tolist()]
        rows, note = first_rows(len(words), lambda at: (*(f"{column[at]:.6g}" for column in columns), words[at]))
        return Sheet(repr(self), rows, ("energy", "impact parameter", "angle", "closest approach", ""), note)

    @property
    def conditioning(self) -> NDArray[np.float64]:
        """|b dψ/db|, of the common shape, in radians.

        The change of the angle for a relative change of the impact parameter.

        Examples
        --------
        >>> import visviva as vv
        >>> found = vv.scattering.deflect(vv.potentials.Coulomb(1.0), energy=0.5, impact_parameter=[0.5, 1.0])
        >>> found.conditioning.round(9)
        array([0.8, 1. ])
        """
        return np.abs(self.impact_parameter * self.derivative)

    @property
    def time_delay(self) -> NDArray[np.float64]:
        """The time lost against free motion with the same energy and impact parameter; negative where it is won.

        Of the common shape, in the caller's units.

        Raises
        ------
        InvalidInput
            If `deflect` was not given a ``reduced_mass``, on which the speed depends.

        Examples
        --------
        >>> import visviva as vv
        >>> ball = vv.potentials.HardSphere(1.0)
        >>> vv.scattering.deflect(ball, energy=0.5, impact_parameter=[0.0, 0.6], reduced_mass=1.0).time_delay.round(9)
        array([-2. , -1.6])
        """
        if self.reduced_mass is None:
            raise InvalidInput("reduced_mass", "expected a number, as times depend on it, got None; pass it to deflect")
        return self.path_delay / np.sqrt(2.0 * self.energy / self.reduced_mass)

    def plot(
        self, kind: Literal["angle", "closest_approach", "cross_section"] = "angle", *, ax: Axes | None = None
    ) -> Figure:
        """Draw what depends on the impact parameter, or the cross section that it makes: a line for each energy.

        Parameters
        ----------
        kind : {"angle", "closest_approach", "cross_section"}
            ψ(b) with its rainbows, glories and orbits, toward which it grows without bound; the outermost turning
            point, beside that of a straight line; or dσ/dΩ at each energy from 1° on, with its rainbows. Of what is
            captured nothing is drawn.
        ax : matplotlib.axes.Axes, optional
            Where; a figure of its own if not given.

        Returns
        -------
        matplotlib.figure.Figure
            The caller's; pyplot's state is not touched.

        Raises
        ------
        InvalidInput
            If matplotlib is not installed; for another kind, no energy at all, or more than 28 of them.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> pair = vv.potentials.LennardJones(epsilon=1.0, sigma=1.0)
        >>> found = vv.scattering.deflect(pair, energy=[[0.5], [2.0]], impact_parameter=np.linspace(0.0, 3.0, 301))
        >>> found.plot().axes[0].get_ylabel()
        'deflection ψ [degrees]'
        >>> figure = found.plot("cross_section")
        """
        from visviva.scattering._pictures import plot_deflection

        return plot_deflection(self, kind, ax)


@known_keywords
def deflect(
    potential: Potential,
    *,
    energy: ArrayLike,
    impact_parameter: ArrayLike,
    tolerance: float = 1e-12,
    reduced_mass: float | None = None,
    threads: int | None = None,
) -> Deflection:
    """Deflection of a projectile by a central potential: its angle, and what comes with it.

    Units: those of the potential, energies and lengths; angles in radians.

    Parameters
    ----------
    potential : Potential
        Any of `visviva.potentials` that goes to 0 far out.
    energy : array_like
        Of relative motion, ½μu², positive.
    impact_parameter : array_like
        Not negative; broadcast against ``energy``.
    tolerance : float
        Of the angle, relative to what was added up to it, from 1e-16 to 1e-3. Sums in float64 come to about 1e-14: for
        less than that one gets what there is, and `Deflection.error` says how far it may be off.
    reduced_mass : float, optional
        μ, for `Deflection.time_delay`.
    threads : int, optional
        By default ``VISVIVA_THREADS``, else all cores. No bit depends on it.

    Returns
    -------
    Deflection
        Arrays of the common shape.

    Raises
    ------
    InvalidInput
        For an energy that is not positive, a negative impact parameter, a tolerance out of range, a potential that does
        not vanish far out, or a table that ends before the motion does.

    Notes
    -----
    The outermost turning point is found by a bracketed method and divided out of the integrand; small angles keep their
    relative precision, as does the complement head-on. Where the angle has a closed form, that is taken.

    References
    ----------
    L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §18.

    Examples
    --------
    >>> import visviva as vv
    >>> pair = vv.potentials.LennardJones(epsilon=1.0, sigma=1.0)
    >>> found = vv.scattering.deflect(pair, energy=1.0, impact_parameter=[0.5, 1.5, 2.0])
    >>> found.angle
    array([ 2.15060623, -0.95631448, -0.23448714])
    """
    mass = None if reduced_mass is None else positive("reduced_mass", reduced_mass)
    pairs, columns, counts = _deflections(potential, energy, impact_parameter, tolerance, threads, everything=True)
    shape = pairs[0].shape
    angle, complement, closest_approach, derivative, delay, error = (column.reshape(shape)[()] for column in columns)
    turning_points, status = (count.reshape(shape)[()] for count in counts)
    return Deflection(
        *pairs,
        angle,
        complement,
        closest_approach,
        derivative,
        delay,
        error,
        turning_points,
        status,
        potential,
        reduced_mass=mass,
    )


@known_keywords
def deflection_angle(
    potential: Potential,
    *,
    energy: ArrayLike,
    impact_parameter: ArrayLike,
    tolerance: float = 1e-12,
    threads: int | None = None,
) -> NDArray[np.float64]:
    """Angle of deflection by a central potential, as `deflect` finds it, and nothing else.

    Units: those of the potential, energies and lengths; angles in radians.

    Parameters
    ----------
    potential : Potential
        Any of `visviva.potentials` that goes to 0 far out.
    energy, impact_parameter : array_like
        Positive, and not negative; broadcast against each other.
    tolerance : float
        As of `deflect`.
    threads : int, optional
        By default ``VISVIVA_THREADS``, else all cores.

    Returns
    -------
    ndarray
        ψ: positive for repulsion, not folded; NaN where captured. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        As `deflect`.

    References
    ----------
    L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §18.

    Examples
    --------
    >>> import visviva as vv
    >>> zbl = vv.potentials.ScreenedCoulomb(1.0, 1.0, "zbl")
    >>> vv.scattering.deflection_angle(zbl, energy=1.0, impact_parameter=[0.0, 1.0, 10.0])
    array([3.14159265e+00, 5.05531621e-01, 2.15338110e-03])
    """
    pairs, columns, _ = _deflections(potential, energy, impact_parameter, tolerance, threads, everything=False)
    return columns[0].reshape(pairs[0].shape)[()]


def _deflections(
    potential: object,
    energy: object,
    impact_parameter: object,
    tolerance: object,
    threads: object,
    *,
    everything: bool,
) -> tuple[tuple[NDArray[np.float64], NDArray[np.float64]], list[NDArray[np.float64]], list[NDArray[np.int64]]]:
    """Check what was asked for, and ask the core."""
    known = checked_potential("potential", potential)
    energies, parameters = float_array("energy", energy, None), float_array("impact_parameter", impact_parameter, None)
    if (wrong := energies <= 0.0).any():
        raise InvalidInput("energy", f"expected positive numbers, got {energies[wrong][0]}")
    if (wrong := parameters < 0.0).any():
        raise InvalidInput("impact_parameter", f"expected numbers that are not negative, got {parameters[wrong][0]}")
    try:
        shape = np.broadcast_shapes(energies.shape, parameters.shape)
    except ValueError:
        came = f"{energies.shape} and {parameters.shape}"
        message = f"expected a shape that goes with that of energy, got {came}; see NumPy's rules of broadcasting"
        raise InvalidInput("impact_parameter", message) from None
    pairs = np.broadcast_to(energies, shape), np.broadcast_to(parameters, shape)
    columns, counts = _core.deflections(
        known._to_core(),
        pairs[0].ravel(),
        pairs[1].ravel(),
        number("tolerance", tolerance),
        everything,
        None if threads is None else whole_number("threads", threads, 1, 1024),
    )
    return pairs, columns, counts
