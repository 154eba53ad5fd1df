"""Potentials V(r), one class for each that the core has registered.

The classes are made from the core's registry, so a potential that is added there (one file, one line)
appears here with its parameters, its documentation and its tests. `potentials.pyi` spells them out for
editors and type checkers; `tools/write_stubs.py` writes it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Self

from visviva import _core
from visviva._arrays import float_array, positive
from visviva._attributes_elsewhere import OF_POTENTIALS, no_attribute
from visviva._custom_potential import Custom, formula_of
from visviva._declared import Declared, class_from_entry
from visviva._keywords import did_you_mean, known_keywords, refuse_subclass, unknown_name
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from visviva.typing import ScreeningName


# What a parameter of the wrong sign was meant for.
_CURES = {
    ("power_law", "n"): "a potential that grows with distance is Custom(lambda r, k: k * r**2, parameters={'k': 1.0}), "
    "and k r² / 2 about a point the force Harmonic(k)"
}


@known_keywords
class Potential(Declared):
    """A potential energy V(r) of the distance between two bodies, or from a fixed center.

    Frozen, hashable and picklable. Every parameter is in the caller's own units.

    Attributes
    ----------
    kind, name : str
        What it is called in files.

    Examples
    --------
    >>> import visviva as vv
    >>> isinstance(vv.potentials.Coulomb(k=1.0), vv.potentials.Potential)
    True
    """

    __slots__ = ()

    name: ClassVar[str]
    _no_sum = (
        "potentials are not added; in a scene give each to a force, as PairPotential(a), PairPotential(b), which add "
        "up; elsewhere write the sum as one formula, Custom(lambda r, k: …, parameters={'k': 1.0}), or sample it in a "
        "range, Custom(lambda r: a.value(r) + b.value(r), r_min=0.1, r_max=10.0)"
    )

    if not TYPE_CHECKING:
        __getattr__ = no_attribute(OF_POTENTIALS)

    def __init__(self) -> None:
        """Refuse: kinds of it have a formula."""
        raise InvalidInput(
            "Potential",
            "expected one of its kinds, as Coulomb(k=1.0) or Yukawa(k=1.0, length=2.0), got Potential itself",
        )

    def __init_subclass__(cls, **arguments: Any) -> None:
        super().__init_subclass__(**arguments)
        if "_parameters" not in vars(cls):
            refuse_subclass(cls, "a force along the line to a fixed center is CentralField(one of visviva.potentials)")

    def __post_init__(self) -> None:
        try:
            super().__post_init__()
        except InvalidInput as error:
            cure = _CURES.get((self.kind, error.argument))
            if cure is None or "expected a positive number" not in error.message:
                raise
            raise InvalidInput(error.argument, f"{error.message}; {cure}") from None
        _core.check_potential(self._to_core())

    @property
    def parameters(self) -> tuple[object, ...]:
        """The parameters, in the order of the constructor.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.potentials.Yukawa(k=-1.0, length=2.0).parameters
        (-1.0, 2.0)
        """
        return tuple(self._values().values())

    def rescaled(self, *, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> Self:
        """The potential in units of which ``length``, ``mass`` and ``time`` make one old unit.

        Parameters
        ----------
        length, mass, time : float
            What one old unit is in new ones; positive.

        Returns
        -------
        Potential
            Of the same kind.

        Raises
        ------
        visviva.InvalidInput
            If a scale is not positive, or a number would leave the range of float64.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.potentials.Coulomb(k=2.0).rescaled(length=10.0)
        Coulomb(k=2000.0)
        """
        return self._rescaled(length, mass, time)

    def value(self, r: ArrayLike) -> NDArray[np.float64]:
        """V(r).

        Units: those of the parameters: r is a length, V an energy.

        Parameters
        ----------
        r : array_like
            Distances, of any shape.

        Returns
        -------
        ndarray
            Of the shape of ``r``.

        Raises
        ------
        visviva.InvalidInput
            If a distance is negative or no number, or one at which the potential is not known.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.potentials.Coulomb(k=2.0).value([1.0, 4.0])
        array([2. , 0.5])
        """
        return self._evaluate(r, 0)

    def force(self, r: ArrayLike) -> NDArray[np.float64]:
        """−dV/dr at the distances ``r``: positive where the force repels.

        Units: those of the parameters: r is a length, the force an energy over a length.

        Parameters
        ----------
        r : array_like
            Distances, of any shape.

        Returns
        -------
        ndarray
            Of the shape of ``r``.

        Raises
        ------
        visviva.InvalidInput
            As `value`, and for a potential that jumps: `SquareWell` and `HardSphere` have no finite force.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.potentials.Coulomb(k=2.0).force([1.0, 4.0])
        array([2.   , 0.125])
        """
        return self._evaluate(r, 1)

    def curvature(self, r: ArrayLike) -> NDArray[np.float64]:
        """d²V/dr² at the distances ``r``.

        Units: those of the parameters: r is a length, the curvature an energy over a length squared.

        Parameters
        ----------
        r : array_like
            Distances, of any shape.

        Returns
        -------
        ndarray
            Of the shape of ``r``.

        Raises
        ------
        visviva.InvalidInput
            As `force`.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.potentials.Coulomb(k=2.0).curvature([1.0, 4.0])
        array([4.    , 0.0625])
        """
        return self._evaluate(r, 2)

    def _evaluate(self, r: ArrayLike, which: int) -> NDArray[np.float64]:
        distances = float_array("r", r, None)
        if distances.size and not distances.min() >= 0.0:
            raise InvalidInput("r", f"expected distances, numbers of at least 0, got {float(distances.min())!r}")
        domain, jumps = _core.check_potential(self._to_core())
        if jumps and which > 0:
            name = type(self).__name__
            raise InvalidInput("potential", f"expected one with a finite force, and {name} jumps; ask for its value")
        if domain is not None and distances.size:
            first, last = domain
            beyond = distances[(distances < first) | (distances > last)]
            if beyond.size:
                known = f"from {first!r} to {last!r}, where the {type(self).__name__} is known"
                raise InvalidInput("r", f"expected distances {known}, got {float(beyond[0])!r}")
        results = _core.potential(self._to_core(), distances.ravel())
        return results[which].reshape(distances.shape)


def _between(
    cls: type[Potential],
    Z1: float,
    Z2: float,
    screening: ScreeningName = "zbl",
    e2: float = 14.399645478,
    bohr_radius: float = 0.529177210544,
) -> Potential:
    """The potential between two nuclei, with the screening length that goes with the function.

    Of ``"zbl"`` that is c a / (Z1^0.23 + Z2^0.23), of the others Firsov's, c a / (√Z1 + √Z2)^(2/3), with the Bohr
    radius a and c = (9 π² / 128)^(1/3) = 0.88534, for which some print 0.8854.

    Parameters
    ----------
    Z1, Z2 : float, positive
        Atomic numbers.
    screening : {"zbl", "moliere", "kr_c", "lenz_jensen", "thomas_fermi"}, optional
        Name of φ.
    e2 : float, positive, optional
        e²/(4 π ε₀). In eV·Å if not given.
    bohr_radius : float, positive, optional
        Bohr's radius in the same units. In Å if not given.

    Returns
    -------
    ScreenedCoulomb
        With k = Z1 Z2 e², in energy · length, and the length in the units of `bohr_radius`.

    Raises
    ------
    visviva.InvalidInput
        If a number is not positive, or for another name.

    References
    ----------
    J. F. Ziegler, J. P. Biersack, U. Littmark, The Stopping and Range of Ions in Solids (1985); O. B. Firsov,
    Sov. Phys. JETP 6 (1958) 534.

    Examples
    --------
    >>> import visviva as vv
    >>> helium_gold = vv.potentials.ScreenedCoulomb.between(2, 79)
    >>> round(helium_gold.length, 4)
    0.12
    """
    first, second = positive("Z1", Z1), positive("Z2", Z2)
    length = positive("bohr_radius", bohr_radius) * _core.screening_length(str(screening), first, second)
    made: Any = cls
    screened: Potential = made(positive("e2", e2) * first * second, length, screening)
    return screened


# What a class has beside what is declared.
_FURTHER: dict[str, dict[str, Any]] = {
    "screened_coulomb": {"between": classmethod(_between)},
    "expressed": {"__repr__": formula_of},
}
_SHAPES = "Distances may have any shape; values, forces and curvatures have the same."
_BY_NAME = {
    entry["name"]: class_from_entry(
        entry | {"notes": f"{entry['notes']} {_SHAPES}".strip()},
        Potential,
        __name__,
        {"name": entry["name"], **_FURTHER.get(entry["name"], {})},
    )
    for entry in _core.potentials()
}
_CLASSES = {made.__name__: made for made in _BY_NAME.values()}
globals().update(_CLASSES)
__all__ = ["Custom", "Potential", "potential_by_name"]
__all__ += list(_CLASSES)


@known_keywords
def potential_by_name(name: str, parameters: Sequence[object]) -> Potential:
    """The potential of a registry name, as files hold it.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    name : str
        As the core's registry has it.
    parameters : sequence of float
        In the order of the constructor.

    Returns
    -------
    Potential

    Raises
    ------
    visviva.InvalidInput
        For a name that there is not, or parameters that do not fit it.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.potentials.potential_by_name("coulomb", [-1.0])
    Coulomb(k=-1.0)
    """
    if not isinstance(name, str) or name not in _BY_NAME:
        hint = did_you_mean(str(name), _BY_NAME)
        raise InvalidInput("potential", f"expected one of {', '.join(_BY_NAME)}, got {name!r}{hint}")
    made = _BY_NAME[name]
    names = [parameter.name for parameter in made._parameters]
    came = len(parameters) if hasattr(parameters, "__len__") else repr(parameters)
    if came != len(names):
        expected = f"{len(names)} ({', '.join(names)})"
        raise InvalidInput("parameters", f"expected {expected} for {name}, got {came}")
    found: Potential = made(*parameters)
    return found


def potential_from_core(description: dict[str, Any]) -> Potential:
    """The potential of a dictionary made by ``_to_core``; used when a file is loaded."""
    kind = description["kind"]
    if kind not in _BY_NAME:
        raise InvalidInput(
            "path", f"the file holds a potential {kind!r} that this version does not know; use a newer visviva"
        )
    found: Potential = _BY_NAME[kind]._from_core(description)
    return found


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
