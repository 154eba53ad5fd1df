"""A potential of one's own; see `visviva.potentials`.

The one idea: the core runs it, and calls nothing of Python. A formula becomes a table of its steps, any other function
polynomials in pieces, each checked where it was not made.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from visviva import _core
from visviva._arrays import number
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput, MissingPackage

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import sympy
    from numpy.typing import ArrayLike

    from visviva.generalized import Expression
    from visviva.potentials import Potential
    from visviva.typing import CompiledFunction, ParameterValues

__all__ = ["Custom", "formula_of"]


@known_keywords
def Custom(  # noqa: N802
    function: sympy.Expr | Callable[..., ArrayLike | Expression] | CompiledFunction,
    r_min: float | None = None,
    r_max: float | None = None,
    *,
    tolerance: float | None = None,
    parameters: ParameterValues | None = None,
) -> Potential:
    """A custom potential: a formula, compiled once and run by the core, or any function, sampled in a range.

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
        octave at most. In case something hides between, it is then looked at in 4096 places to each factor of e, down
        to a millionth of r_max, and met to ten times as much there: what is narrower than a 4096th of its distance may
        still be passed over.
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
    from visviva._compiled import function_of_distance as compiled
    from visviva._compiled import sampler
    from visviva.potentials import PiecewisePolynomial

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
    breaks, coefficients, error = _core.fitted(sampler(function, "r"), (low, high), met, drag=False)
    return PiecewisePolynomial(breaks, coefficients, error)


def _formula(function: Any, tolerance: float | None, parameters: Mapping[Any, float] | None) -> Potential:
    from visviva._expression_table import distance_table
    from visviva.generalized._switches import tells_of_switches
    from visviva.potentials import Expressed

    if tolerance is not None:
        raise InvalidInput(
            "tolerance", "expected none of a formula, which is exact; it is of a function that is sampled"
        )
    if not hasattr(function, "free_symbols") and not callable(function):
        raise InvalidInput("function", f"expected a formula or a function of r, got {type(function).__name__}")
    try:
        nodes, values = distance_table(function, parameters)
    except InvalidInput as error:
        if isinstance(error, MissingPackage) or error.argument.startswith("parameters"):
            raise
        if tells_of_switches(error.message) and "truth value" not in error.message:
            raise  # what is sampled may have branches, but no corners and no jumps
        cure = "with r_min and r_max any smooth function of arrays is sampled"
        if "is called with" in error.message:
            cure = "what else it takes are parameters="
        elif "free symbol" in error.message:
            raise
        raise InvalidInput("function", f"{error.message}; {cure}") from error
    return Expressed(nodes, values)


def formula_of(potential: Any) -> str:
    """The formula of an `Expressed`, the values of its parameters, and its units where they are of its own."""
    from visviva._expression_table import formulas, parameter_values

    values = parameter_values(potential.nodes, potential.values.tolist())
    units = {name: getattr(potential, name) for name in ("length", "energy") if getattr(potential, name) != 1.0}
    (written,) = formulas(potential.nodes, ("r",), tuple(values))
    return f"Expressed({', '.join([written, *(f'{name}={value!r}' for name, value in (values | units).items())])})"
