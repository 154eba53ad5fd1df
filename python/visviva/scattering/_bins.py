"""Bins, by name or by edges, and what a Monte Carlo is asked to tally in them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from visviva._arrays import float_array, number, whole_number
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

__all__ = ["Axes", "Bins", "asked_for"]

# How many, by name, or edges: what the core takes.
Told: TypeAlias = int | tuple[str, int, float | None, float | None] | NDArray[np.float64]
# Names of quantities, each with its bins.
Axes: TypeAlias = list[tuple[str, Told]]

_MOST = 2**16


@known_keywords
@dataclass(frozen=True, init=False, repr=False)
class Bins(Record):
    """Bins by name, for any quantity of a Monte Carlo or of a foil.

    Edges follow from the name by arithmetic that is the same on every machine; the first and the last are exactly those
    given. What lies outside is counted as ``underflow`` and ``overflow``.

    Units: those of the quantity: angles in radians, energies and lengths as those of the potential, of a foil eV and
    µm.

    Attributes
    ----------
    spacing : {"linear", "logarithmic", "solid_angle"}
        What neighboring bins have in common: width, ratio of the ends, or solid angle.
    n : int
        How many, 1 to 65536; edges have shape (n + 1,).
    low, high : float or None
        From where to where; None is 0, or the greatest value that the quantity can have.

    Examples
    --------
    >>> import visviva as vv
    >>> Bins = vv.scattering.Bins
    >>> result = vv.scattering.monte_carlo(
    ...     vv.potentials.Coulomb(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=2.0, n_events=1000, seed=1,
    ...     tally={"cm_angle": Bins.solid_angle(4), "recoil_energy": Bins.logarithmic(2, 0.01, 0.64)})
    >>> result["recoil_energy"].edges.round(12)
    array([0.01, 0.08, 0.64])
    >>> (result["cm_angle"].edges / 3.141592653589793).round(4)
    array([0.    , 0.3333, 0.5   , 0.6667, 1.    ])
    """

    spacing: str
    n: int
    low: float | None
    high: float | None

    def __init__(self) -> None:
        raise InvalidInput("bins", "expected Bins.linear, Bins.logarithmic or Bins.solid_angle, got Bins itself")

    @staticmethod
    @known_keywords
    def linear(n: int, low: float | None = None, high: float | None = None) -> Bins:
        """Make bins of equal width.

        Units: those of the quantity: angles in radians, energies and lengths as those of the potential, of a foil eV
        and µm.

        Parameters
        ----------
        n : int
            How many, 1 to 65536.
        low, high : float, optional
            From where to where, in the unit of the quantity; by default 0 and the greatest value.

        Returns
        -------
        Bins

        Raises
        ------
        InvalidInput
            For what are no such numbers, or ends that are not in order.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.scattering.Bins.linear(10, 0.0, 5.0)
        Bins(spacing='linear', n=10, low=0.0, high=5.0)
        """
        return _made("linear", n, low, high)

    @staticmethod
    @known_keywords
    def logarithmic(n: int, low: float, high: float | None = None) -> Bins:
        """Make bins of which each ends at the same multiple of where it begins.

        Units: those of the quantity: angles in radians, energies and lengths as those of the potential, of a foil eV
        and µm.

        Parameters
        ----------
        n : int
            How many, 1 to 65536.
        low : float
            Where the first begins, more than 0.
        high : float, optional
            Where the last ends; by default the greatest value of the quantity.

        Returns
        -------
        Bins

        Raises
        ------
        InvalidInput
            As `linear`, and for a beginning that is not positive.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.scattering.Bins.logarithmic(60, 1e-3)
        Bins(spacing='logarithmic', n=60, low=0.001, high=None)
        """
        bins = _made("logarithmic", n, low, high)
        if bins.low is None or bins.low <= 0.0:
            raise InvalidInput("low", f"expected a number above 0, got {low!r}; what is below is the underflow")
        return bins

    @staticmethod
    @known_keywords
    def solid_angle(n: int, low: float | None = None, high: float | None = None) -> Bins:
        """Make rings of equal solid angle: isotropic scattering fills them alike.

        Parameters
        ----------
        n : int
            How many, 1 to 65536.
        low, high : float, optional
            From where to where, in radians; by default 0 and the greatest angle.

        Returns
        -------
        Bins

        Raises
        ------
        InvalidInput
            As `linear`. A quantity that is no angle has no such bins: `monte_carlo` refuses them by its name.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.scattering.Bins.solid_angle(50)
        Bins(spacing='solid_angle', n=50, low=None, high=None)
        """
        return _made("solid_angle", n, low, high)


def _made(spacing: str, n: object, low: object, high: object) -> Bins:
    bins = object.__new__(Bins)
    object.__setattr__(bins, "spacing", spacing)
    object.__setattr__(bins, "n", whole_number("n", n, 1, _MOST))
    for name, end in (("low", low), ("high", high)):
        object.__setattr__(bins, name, None if end is None else number(name, end))
    if bins.high is not None and bins.high <= (bins.low or 0.0):
        raise InvalidInput("high", f"expected more than low = {bins.low or 0.0}, got {bins.high}")
    return bins


def asked_for(tally: object, bins: Any) -> list[Axes]:
    """What is asked for: of each tally its quantities and their bins."""
    if isinstance(tally, str):
        tally = (tally,)
    pairs: list[tuple[Any, Any]]
    if isinstance(tally, Mapping):
        pairs = list(tally.items())
    elif isinstance(tally, Iterable):
        # A set has no order of its own that would be the same in the next process.
        pairs = [(name, None) for name in (sorted(tally, key=str) if isinstance(tally, Set) else tally)]
    else:
        raise InvalidInput("tally", f"expected a name, several names or a mapping to edges, got {tally!r}")
    names = [name for name, _ in pairs]
    if not names or not all(_named(name) for name in names) or len(set(names)) < len(names):
        raise InvalidInput("tally", f"expected one or more different names, got {names!r}")
    if isinstance(bins, Mapping):
        tallied = {one for name in names for one in ((name,) if isinstance(name, str) else name)}
        if unknown := [name for name in bins if name not in tallied]:
            raise InvalidInput(
                "bins", f"expected bins of what is tallied, {sorted(tallied)}, got some of {unknown[0]!r}"
            )
    elif not isinstance(bins, Bins) and np.ndim(bins) == 0:
        bins = whole_number("bins", bins, 1, _MOST)
    return [_axes(name, given, bins) for name, given in pairs]


def _named(name: object) -> bool:
    """Whether it is the name of a quantity, or of two together."""
    if isinstance(name, tuple):
        return len(name) == 2 and all(isinstance(one, str) for one in name) and name[0] != name[1]
    return isinstance(name, str)


def _axes(name: str | tuple[str, str], given: Any, bins: Any) -> Axes:
    names = (name,) if isinstance(name, str) else name
    each: tuple[Any, ...]
    if given is None:
        each = tuple(bins.get(one, 180) if isinstance(bins, Mapping) else bins for one in names)
    elif isinstance(name, str):
        each = (given,)
    elif not isinstance(given, tuple | list) or len(given) != len(names):
        raise InvalidInput("tally", f"expected edges or a number of bins for each of {name}, got {given!r}")
    else:
        each = tuple(given)
    # Half a surrogate pair is no text to the core; what remains is refused there as an unknown name.
    told = [one.encode(errors="replace").decode() for one in names]
    return [(one, _told(one, edges)) for one, edges in zip(told, each, strict=True)]


def _told(name: str, given: Any) -> Told:
    if isinstance(given, Bins):
        return (given.spacing, given.n, given.low, given.high)
    if isinstance(given, int | np.integer) and not isinstance(given, bool):
        return whole_number(name, given, 1, _MOST)
    if np.ndim(given) == 0:
        raise InvalidInput(
            name,
            f"expected edges, a number of bins or Bins, got {given!r}; pass a list of edges, an int, or Bins.linear",
        )
    return float_array(name, given, (None,))
