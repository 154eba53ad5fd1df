"""Small motions about a place: what the linear equations tell of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._arrays import float_array
from visviva._html import Sheet, Shown, as_text, briefly
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.generalized._constrained_motions import BALANCED, Constrained
from visviva.generalized._eigenvalues import eigenvalues
from visviva.generalized._matrices import Sizes, matrices, matrices_along, rounding
from visviva.generalized._multiple_zeros import at_rest, is_simple, left_open, units

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._constrained_motions import Balance
    from visviva.generalized._lagrangian import Lagrangian
    from visviva.generalized._matrices import Matrices

    _Modes = tuple[NDArray[np.float64], NDArray[np.float64]]

__all__ = [
    "Linearization",
    "along",
    "eigenmodes",
    "free_matrices",
    "linearization",
    "linearization_of",
    "of_matrices",
]

#: Eigenvalues whose real or imaginary part is below this part of them have none, but for round-off: of a double one
#: half the digits are known.
_ON_THE_AXIS = 1e-7
#: Displacements are along constraints to this part of themselves.
_ALONG = 1e-8


@known_keywords
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Linearization(Shown):
    """Small motions ξ about a place: M ξ̈ + C ξ̇ + K ξ = 0; on constraints along their d free directions.

    Units: those of the system; frequencies in radians per time.

    Attributes
    ----------
    position : ndarray, shape (n,)
    mass, damping, stiffness : ndarray, shape (n, n)
        M, C (with gyroscopic terms) and K, which has what reactions of constraints do where these bend.
    eigenvalues : ndarray of complex, shape (2d,)
        λ of motions as exp(λ t); d is n where there are no constraints.
    frequencies : ndarray, shape (at most d,)
        Angular frequencies of what oscillates, ascending.
    modes : ndarray, shape (d, n), or None
        Rows with ξᵀ M ξ = 1, in the order of the squared frequencies; None with damping or gyroscopic terms.
    squares : ndarray, shape (d,), or None
        Squared frequencies, those of unstable modes negative, and 0 where they are but round-off.
    rounding : ndarray, shape (n, n)
        By how much K may be off: what it changes by where place and parameters change in their last digits.
    coordinates : tuple of str
        What the numbers of places and modes are of.
    tangent : ndarray, shape (n, d), or None
        With constraints the free directions, in columns.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 6.1–6.3.

    Examples
    --------
    >>> import visviva as vv
    >>> small = vv.systems.pendulum(g=9.81, l=2.0).linearize(at=[0.0])
    >>> bool(abs(small.frequencies[0] - (9.81 / 2.0) ** 0.5) < 1e-15), small.stable
    (True, True)
    >>> print(small)  # doctest: +ELLIPSIS
    Small motions about (0): stable
       angular frequency  period      shape (theta)
    1  2.21472346         2.83700671  (0.5)
    angular frequencies in radians per unit of time, periods in units of time; ...
    """

    position: NDArray[np.float64]
    mass: NDArray[np.float64]
    damping: NDArray[np.float64]
    stiffness: NDArray[np.float64]
    eigenvalues: NDArray[np.complex128]
    modes: NDArray[np.float64] | None
    squares: NDArray[np.float64] | None
    rounding: NDArray[np.float64]
    coordinates: tuple[str, ...]
    tangent: NDArray[np.float64] | None = None

    def __repr__(self) -> str:
        return f"Linearization(frequencies={briefly(self.frequencies)}, stable={self.stable})"

    def __str__(self) -> str:
        return as_text(self._sheet())

    def _sheet(self) -> Sheet:
        from visviva.generalized._modes_table import modes_table

        return modes_table(self, _ON_THE_AXIS)

    @property
    def frequencies(self) -> NDArray[np.float64]:
        """Angular frequencies of what oscillates, ascending, shape (at most d,), in radians per time."""
        if self.squares is not None:
            real: NDArray[np.float64] = np.sqrt(self.squares[self.squares > 0.0])
            return real
        oscillates = self.eigenvalues.imag > _ON_THE_AXIS * np.abs(self.eigenvalues)
        found: NDArray[np.float64] = np.sort(self.eigenvalues.imag[oscillates])
        return found

    @property
    def stable(self) -> bool:
        """Whether no small motion grows, as the linear equations tell; one that neither grows nor returns counts."""
        from visviva.generalized._stability import is_stable

        return is_stable(*free_matrices(self))

    def at(self, t: ArrayLike, displacement: ArrayLike, velocity: ArrayLike) -> NDArray[np.float64]:
        """Small motions at any time, exactly.

        Units: those of the system; frequencies in radians per time.

        Parameters
        ----------
        t : float or array_like, shape (T,)
            Times.
        displacement, velocity : array_like, shape (n,)
            ξ and ξ̇ at t = 0.

        Returns
        -------
        ndarray, shape (T, n) or (n,)

        Raises
        ------
        InvalidInput
            With damping or gyroscopic terms; for ξ or ξ̇ across constraints.

        Examples
        --------
        >>> import visviva as vv
        >>> small = vv.systems.coupled_oscillators().linearize(at=[0.0, 0.0])
        >>> small.at(0.0, [1.0, 0.0], [0.0, 0.0]).round(12) + 0.0
        array([1., 0.])
        """
        if self.modes is None or self.squares is None:
            raise InvalidInput(
                "t", "modes move by themselves only without damping and gyroscopic terms; run the system"
            )
        n = len(self.position)
        start, rate = float_array("displacement", displacement, (n,)), float_array("velocity", velocity, (n,))
        for name, given in (("displacement", start), ("velocity", rate)):
            self._check_along(name, given)
        weights = self.modes @ self.mass
        times = np.asarray(float_array("t", t, None))[..., None]
        root = np.sqrt(np.abs(self.squares))
        still = root == 0.0
        safe = np.where(still, 1.0, root)
        grows = self.squares < 0.0
        even = np.where(grows, np.cosh(np.where(grows, root, 0.0) * times), np.cos(np.where(grows, 0.0, root) * times))
        odd = np.where(grows, np.sinh(np.where(grows, root, 0.0) * times), np.sin(np.where(grows, 0.0, root) * times))
        amplitudes = even * (weights @ start) + np.where(still, times, odd / safe) * (weights @ rate)
        moved: NDArray[np.float64] = amplitudes @ self.modes
        return moved

    def _check_along(self, name: str, given: NDArray[np.float64]) -> None:
        """Refuse what is not along the constraints."""
        if self.tangent is None or not given.any():
            return
        across = np.abs(given - self.tangent @ (np.linalg.pinv(self.tangent) @ given))
        if (across > _ALONG * np.abs(given).max()).any():
            worst = self.coordinates[int(np.argmax(across))]
            raise InvalidInput(
                name, f"expected numbers along the constraints, and that of {worst!r} is off by {across.max():.3g}"
            )

    def plot(self, *, ax: Axes | None = None) -> Axes:
        """Draw the modes: how far each coordinate goes, in the order of the coordinates, a line for each mode.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; a new one if not given.

        Returns
        -------
        matplotlib.axes.Axes
            Modes are named by their angular frequencies ω, those that grow by their rates.

        Raises
        ------
        InvalidInput
            With damping or gyroscopic terms, which leave no such modes; if matplotlib is not installed.

        Examples
        --------
        >>> import visviva as vv
        >>> ax = vv.systems.coupled_oscillators().normal_modes().plot()
        >>> [line.get_label() for line in ax.lines][:2]
        ['ω = 1', 'ω = 1.095']
        """
        from visviva._style import FRAME, legend_beside
        from visviva.plot import LEGEND, axes_or_new

        if self.modes is None or self.squares is None:
            raise InvalidInput("plot", "expected modes, and with damping or gyroscopic terms there are none: see at")
        ax = axes_or_new(ax)
        numbers = np.arange(1, len(self.position) + 1)
        for mode, square in zip(self.modes, self.squares, strict=True):
            rate = float(np.sqrt(abs(square)))
            name = f"ω = {rate:.4g}" if square >= 0.0 else f"grows at {rate:.4g}"
            ax.plot(numbers, mode, marker="o", markersize=4, linewidth=0.8, label=name)
        ax.axhline(0.0, color=FRAME, linewidth=0.6, linestyle="-", zorder=0)
        ax.set(xlabel="coordinate", ylabel="displacement, ξᵀMξ = 1", title="modes")
        ax.locator_params(axis="x", integer=True)
        if len(numbers) <= LEGEND:
            legend_beside(ax)
        return ax


def linearization(system: Lagrangian, at: ArrayLike | None, sizes: Sizes | None = None) -> Linearization:
    """Small motions of a Lagrangian about a place."""
    n = len(system.coordinates)
    place = system._start()[:n] if at is None else float_array("at", at, (n,))
    if system._constraints():
        return linearization_of(Constrained(system), place)
    sizes = Sizes(system) if sizes is None else sizes
    found = matrices(system, place)
    # Which refuses what has no derivatives.
    small = eigenmodes(found, None)
    # What rounding of the place, and of what a force is the sum of, makes of it: in any units, and next to zero too.
    scale = np.abs(found.stiffness) @ np.abs(place)
    off = ~(np.abs(found.forces) <= BALANCED * scale)
    if off.any():
        off = ~(np.abs(found.forces) <= BALANCED * (scale + sizes.forces(place[None])[0]))
    if off.any():
        worst = int(np.argmax(np.where(off, np.abs(found.forces), 0.0)))
        raise InvalidInput(
            "at",
            f"expected an equilibrium, but a force of {found.forces[worst]:.3g} acts on "
            f"{system.coordinates[worst]!r} there; see equilibria()",
        )
    off_by = rounding(system, place, found.stiffness, sizes)
    # Places have one size, in units of masses.
    unit = units(system, place)
    size = unit * np.abs(place / unit).max(initial=0.0)
    energy = at_rest(system, sizes)
    left = left_open(energy, place, size, unit) if n > 1 and place.any() else None
    if left is not None and not is_simple(energy, np.stack([place, place + left, place - left]), unit):
        further = left_open(energy, place, size, unit, curved=True)
        left = left if further is None else further
        # A zero of higher order is told by forces to some of its digits only, and so is K there.
        _, beside = matrices_along(system, np.stack([place + left, place - left]))
        off_by = np.fmax(off_by, np.abs(beside - found.stiffness).max(axis=0))
    return of_matrices(place, (found, off_by, None), small, system.coordinates)


def linearization_of(
    constrained: Constrained, place: NDArray[np.float64], balance: Balance | None = None
) -> Linearization:
    """Small motions of a Lagrangian on its constraints about a place."""
    balance = constrained.balance(place) if balance is None else balance
    small = eigenmodes(balance.matrices, balance.tangent)
    known = (balance.matrices, balance.rounding, balance.tangent)
    return of_matrices(place, known, small, constrained.free.coordinates)


def along(tangent: NDArray[np.float64] | None, matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give a matrix along free directions."""
    reduced: NDArray[np.float64] = matrix if tangent is None else tangent.T @ matrix @ tangent
    return reduced


def free_matrices(
    small: Linearization,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Give M, C and K along the free directions, and the rounding of K."""
    mass, damping, stiffness = (along(small.tangent, each) for each in (small.mass, small.damping, small.stiffness))
    return mass, damping, stiffness, along(None if small.tangent is None else np.abs(small.tangent), small.rounding)


def eigenmodes(found: Matrices, tangent: NDArray[np.float64] | None) -> _Modes | None:
    """Give squares (d) and modes (d, d) where these are real, or refuse what has no derivatives."""
    mass, damping, stiffness = (along(tangent, matrix) for matrix in (found.mass, found.damping, found.stiffness))
    return _core.eigenmodes(mass, damping, stiffness)


def of_matrices(
    place: NDArray[np.float64],
    known: tuple[Matrices, NDArray[np.float64], NDArray[np.float64] | None],
    small: _Modes | None,
    coordinates: tuple[str, ...],
) -> Linearization:
    """Small motions of matrices at a place, known to a rounding of K, along free directions."""
    found, off_by, tangent = known
    squares, modes = (None, None) if small is None else small
    if modes is not None and tangent is not None:
        modes = modes @ tangent.T
    if squares is not None and modes is not None:
        # Of a level direction rounding makes a square of its own size, and a frequency of its root.
        least = ((np.abs(modes) @ off_by) * np.abs(modes)).sum(axis=1)
        squares = np.where(np.abs(squares) > least, squares, 0.0)
        roots = np.sqrt(-squares.astype(np.complex128))
        values = np.concatenate([roots, -roots])
    else:
        mass, damping, stiffness = (along(tangent, each) for each in (found.mass, found.damping, found.stiffness))
        unsure = along(None if tangent is None else np.abs(tangent), off_by)
        values, _ = eigenvalues(mass, damping, stiffness, unsure)
    if not np.isfinite(values).all():
        raise InvalidInput("at", "eigenvalues of small motions leave the range of numbers; take other units")
    return Linearization(
        place,
        found.mass,
        found.damping,
        found.stiffness,
        values,
        modes,
        squares,
        off_by,
        coordinates,
        tangent,
    )
