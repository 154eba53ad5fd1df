"""Potentials V(r), one class for each that the core has registered.

The classes are made from the core's registry, so a potential that is added there (one file, one line)
appears here with its parameters, its documentation and its tests. `potentials.pyi` spells them out for
editors and type checkers; `tools/write_stubs.py` writes it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Self

from visviva import _core
from visviva._arrays import float_array, number, positive
from visviva._declared import Declared, make
from visviva._keywords import did_you_mean, known_keywords, refuse_subclass, unknown_name
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import numpy as np
    import sympy
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized import Expression
    from visviva.typing import CompiledFunction, ParameterValues, ScreeningName


# What a parameter of the wrong sign was meant for.
_CURES = {
    ("power_law", "n"): "a potential that grows with distance is Custom(lambda r, k: k * r**2, parameters={'k': 1.0}), "
    "and k r² / 2 about a point the force Harmonic(k)"
}


@known_keywords
class Potential(Declared):
    """A potential energy V(r) of the distance between two bodies, or from a fixed centre.

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


@known_keywords
def Custom(  # noqa: N802
    function: sympy.Expr | Callable[..., ArrayLike | Expression] | CompiledFunction,
    r_min: float | None = None,
    r_max: float | None = None,
    *,
    tolerance: float | None = None,
    parameters: ParameterValues | None = None,
) -> Potential:
    """A potential of one's own: a formula, compiled once and run by the core, or any function, sampled in a range.

    Parameters
    ----------
    function : sympy.Expr, callable, int, numba CFunc, ctypes function or scipy.LowLevelCallable
        Without a range a formula: an expression of SymPy of the symbol ``r``, or a function that is called once with
        ``(r, **parameters)``, an expression in the place of r: arithmetic and NumPy's functions, and no branches. With
        a range any V(r) of an array of distances of any shape, elementwise; or a compiled ``double f(double r)``, or
        its address.
    r_min, r_max : float, optional
        Distances between which a function is sampled. Beyond them there is no value: asking for one is refused, and a
        run that comes there ends with `Status.OUTSIDE_DOMAIN`. A formula has no such range, and takes none.
    tolerance : float, optional
        Of a function that is sampled: largest error of V allowed, from 1e-12, which it is if not given, to 1e-4,
        relative to abs(V) + r abs(dV/dr). The second is taken between a
        hundredth and a hundred times the largest abs(V) of the piece, so that no jump passes, and the sum as no less
        than 1e-16 of the largest abs(V) within the octave, as a cutoff comes to zero. It is met at each of 28 places of
        every piece where its polynomial of degree 13 was not made; pieces are cut in two until it is, and reach over an
        octave at most.
    parameters : mapping of symbol or str to float, optional
        The values of what else than r stands in a formula.

    Returns
    -------
    Expressed or PiecewisePolynomial
        Of a formula itself, with its exact derivatives, in units of its own that `rescaled` changes. Of what is
        sampled polynomials in pieces that were checked where they were not made, with continuous force and curvature,
        the derivatives of its V(r), and in `error` the largest error found; the function is not kept. Either is
        compared, hashed, pickled and written to files as what it is.

    Raises
    ------
    visviva.InvalidInput
        For a formula with a branch, a symbol without a value, or what the core does not know, with what it knows; for a
        range or tolerance that is none, values that are not finite numbers of the shape of r, and a function that
        is not smooth enough: the message says how near it came, and where.

    References
    ----------
    A. Griewank & A. Walther, Evaluating Derivatives (2008), for the derivatives of formulas; L. N. Trefethen,
    Approximation Theory and Approximation Practice (2013), chapters 3 to 8, for what is sampled.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> soft = vv.potentials.Custom(lambda r, k: k / np.sqrt(1.0 + r**4), parameters={"k": 1.0})
    >>> round(float(soft.force(1.0)), 9)
    0.707106781
    >>> sampled = vv.potentials.Custom(lambda r: 1.0 / np.sqrt(1.0 + r**4), r_min=0.0, r_max=50.0)
    >>> bool(sampled.error <= 1e-12), round(float(sampled.force(1.0)), 9)
    (True, 0.707106781)
    """
    from visviva._compiled import of_distance as compiled
    from visviva._compiled import sampled

    if r_min is None and r_max is None and (hasattr(function, "free_symbols") or compiled(function) is None):
        return _formula(function, tolerance, parameters)
    if hasattr(function, "free_symbols"):
        raise InvalidInput("r_min", "expected no range beside an expression, which is taken at every distance")
    if parameters is not None:
        raise InvalidInput("parameters", "expected none beside a range: they belong to a formula, which has none")
    for name, given in (("r_min", r_min), ("r_max", r_max)):
        if given is None:
            raise InvalidInput(name, "expected the end of the range in which the function is sampled, got None")
    low, high = number("r_min", r_min), number("r_max", r_max)
    met = 1e-12 if tolerance is None else number("tolerance", tolerance)
    breaks, coefficients, error = _core.fitted(sampled(function, "r"), (low, high), met, drag=False)
    made: Potential = _BY_NAME["piecewise_polynomial"](breaks, coefficients, error)
    return made


def _formula(function: Any, tolerance: float | None, parameters: Mapping[Any, float] | None) -> Potential:
    from visviva._expression_table import of_distance

    if tolerance is not None:
        raise InvalidInput(
            "tolerance", "expected none of a formula, which is exact; it is of a function that is sampled"
        )
    if not hasattr(function, "free_symbols") and not callable(function):
        raise InvalidInput("function", f"expected a formula or a function of r, got {type(function).__name__}")
    try:
        nodes, values = of_distance(function, parameters)
    except InvalidInput as error:
        if error.argument.startswith("parameters"):
            raise
        cure = "with r_min and r_max any function of arrays is sampled"
        if "is called with" in error.message:
            cure = "what else it takes are parameters="
        elif "free symbol" in error.message:
            raise
        raise InvalidInput("function", f"{error.message}; {cure}") from error
    made: Potential = _BY_NAME["expressed"](nodes, values)
    return made


def _written(made: Any) -> str:
    """The formula of an `Expressed`, the values of its parameters, and its units where they are of its own."""
    from visviva._expression_table import formula, parameter_names

    # A table that was written by hand may do without names.
    names = parameter_names(made.nodes)
    names += tuple(f"values[{index}]" for index in range(len(names), len(made.values)))
    values = dict(zip(names, made.values.tolist(), strict=False))
    units = {name: getattr(made, name) for name in ("length", "energy") if getattr(made, name) != 1.0}
    told = [formula(made.nodes, ("r",), names), *(f"{name}={value!r}" for name, value in (values | units).items())]
    return f"Expressed({', '.join(told)})"


# What a class has beside what is declared.
_FURTHER: dict[str, dict[str, Any]] = {
    "screened_coulomb": {"between": classmethod(_between)},
    "expressed": {"__repr__": _written},
}
_SHAPES = "Distances may have any shape; values, forces and curvatures have the same."
_BY_NAME = {
    entry["name"]: make(
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
