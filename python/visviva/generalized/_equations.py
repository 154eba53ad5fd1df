"""Equations of motion to be read: Lagrange's of a Lagrangian, Hamilton's of a Hamiltonian.

The core has derived them; here its graph is put into words of SymPy, when it is asked for and not before.
H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., (1.70), (2.23) and (8.18).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from visviva._html import Sheet, Shown
from visviva._keywords import known_keywords
from visviva.generalized._calculus import Calculus
from visviva.generalized._symbolic import free_name, sympy, time

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    import sympy as sp

    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._lagrangian import Lagrangian

__all__ = ["EquationsOfMotion", "HamiltonsEquations", "euler_lagrange", "hamiltons_equations"]


@known_keywords
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class EquationsOfMotion(Shown):
    """Lagrange's equations as expressions of SymPy; ``print`` shows them as lines, a notebook as formulas.

    Made by `Lagrangian.equations`. A prime of a coordinate in print is its derivative by the time.

    Attributes
    ----------
    coordinates : tuple of str
    equations : list of sympy.Eq
        d/dt ∂L/∂q̇ − ∂L/∂q = Q of each coordinate: further forces, those of Rayleigh's function and the reactions
        Σ λ ∂g/∂q on the right. Accelerations are second derivatives, or symbols ``a_<name>``.
    constraints : list of sympy.Eq
        Those that multipliers ``lambda_1``, … belong to, in this order.
    momenta : list of sympy.Eq
        ``p_<name>`` = ∂L/∂q̇.
    jacobi_integral : sympy.Eq
        ``h`` = Σ q̇ ∂L/∂q̇ − L.
    conserved : list of str
        What of these is conserved, as in `Lagrangian.conserved`.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., (1.57), (1.70), (2.53).

    Examples
    --------
    >>> import visviva as vv
    >>> print(vv.systems.pendulum().equations)
    Lagrange's equations
      theta:  g*l*m*sin(theta) + l**2*m*theta'' = 0
    Momenta
      p_theta = l**2*m*theta'
    Jacobi's integral, conserved
      h = -g*l*m*cos(theta) + l**2*m*theta'**2/2
    """

    coordinates: tuple[str, ...]
    equations: list[sp.Eq]
    constraints: list[sp.Eq]
    momenta: list[sp.Eq]
    jacobi_integral: sp.Eq
    conserved: list[str]
    _written: Mapping[sp.Basic, sp.Basic]
    _latex: Mapping[sp.Basic, str]

    def __repr__(self) -> str:
        return f"EquationsOfMotion({', '.join(self.coordinates)})"

    def __str__(self) -> str:
        lines = ["Lagrange's equations"]
        lines += [
            f"  {name}:  {_text(e, self._written)}" for name, e in zip(self.coordinates, self.equations, strict=True)
        ]
        if self.constraints:
            lines += ["Constraints", *(f"  {_text(each, self._written)}" for each in self.constraints)]
        lines.append("Momenta")
        for name, each in zip(self.coordinates, self.momenta, strict=True):
            kept = ", conserved" if f"momentum of {name}" in self.conserved else ""
            lines.append(f"  {_text(each, self._written)}{kept}")
        lines.append("Jacobi's integral" + (", conserved" if "energy" in self.conserved else ""))
        return "\n".join([*lines, f"  {_text(self.jacobi_integral, self._written)}"])

    def _sheet(self) -> Sheet:
        rows = [
            *zip(self.coordinates, self.equations, strict=True),
            *(("constraint", each) for each in self.constraints),
            *(("momentum", each) for each in self.momenta),
            ("Jacobi's integral", self.jacobi_integral),
        ]
        texts = [(name, " = ".join(_sides(each, self._written, self._latex))) for name, each in rows]
        return Sheet("Lagrange's equations", [(name, f"${text}$") for name, text in texts])

    def _repr_latex_(self) -> str:
        rows = [*self.equations, *self.constraints, *self.momenta, self.jacobi_integral]
        return _formulas(rows, self._written, self._latex)


class HamiltonsEquations(tuple["list[sp.Expr]", "list[sp.Expr]"]):
    """q̇ and ṗ, two lists of expressions of SymPy; ``print`` shows equations as lines, a notebook as formulas.

    Made by `Hamiltonian.equations`. A prime in print is a derivative by the time.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., (8.18).

    Examples
    --------
    >>> import visviva as vv
    >>> print(vv.systems.pendulum().hamiltonian().equations)
    Hamilton's equations
      theta' = p_theta/(l**2*m)
      p_theta' = -g*l*m*sin(theta)
    """

    _symbols: tuple[tuple[Any, ...], tuple[Any, ...]]

    def _rows(self) -> tuple[list[Any], dict[Any, Any], dict[Any, str]]:
        sp = sympy("equations")
        written = {each: sp.Symbol(_name(each)) for group in self._symbols for each in group}
        rates = {each: sp.Symbol(f"{_name(each)}'") for each in written}
        latex = {rate: rf"\dot{{{sp.latex(written[each])}}}" for each, rate in rates.items()}
        pairs = [
            pair for group, found in zip(self._symbols, self, strict=True) for pair in zip(group, found, strict=True)
        ]
        return [sp.Eq(rates[each], rate, evaluate=False) for each, rate in pairs], written, latex

    def __str__(self) -> str:
        rows, written, _ = self._rows()
        return "\n".join(["Hamilton's equations", *(f"  {_text(each, written)}" for each in rows)])

    def _repr_latex_(self) -> str:
        return _formulas(*self._rows())

    def __reduce__(self) -> Any:
        return _remade, (tuple(self), self._symbols)


def _remade(
    found: tuple[list[sp.Expr], list[sp.Expr]], symbols: tuple[tuple[Any, ...], tuple[Any, ...]]
) -> HamiltonsEquations:
    made = HamiltonsEquations(found)
    made._symbols = symbols
    return made


def euler_lagrange(system: Lagrangian) -> EquationsOfMotion:
    """Give the equations of a Lagrangian."""
    sp, c, n = sympy("equations"), Calculus(system), len(system.coordinates)
    description = system._source.description
    names = system.coordinates
    q, v = system._symbols()
    # A coordinate that is a function of the time has a second derivative by it; a symbol has none.
    a = tuple(
        sp.Symbol(f"a_{name}") if isinstance(each, sp.Symbol) else each.diff(time._sympy_(), 2)
        for name, each in zip(names, q, strict=True)
    )
    p = [row[0] for row in c.with_derivatives(c.of_system("conjugates"))]
    function = c.of_system("function")[0]
    forces = c.adopted(description["nodes"], description["forces"])
    rates = c.velocities()
    energy = sum((rate * each for rate, each in zip(rates, p, strict=True)), c.constant(0.0)) - function

    def along(rows: list[list[Any]], first: int) -> list[list[Any]]:
        return [c.to_sympy(row[first : first + n]) for row in rows]

    momentum_rows = c.with_derivatives(p)
    by_place, by_speed = along(momentum_rows, 1), along(momentum_rows, 1 + n)
    by_time = c.to_sympy([row[1 + 2 * n] for row in momentum_rows])
    slopes = c.to_sympy(c.with_derivatives([function])[0][1 : 1 + n])
    acting = c.to_sympy(forces) if forces else [sp.S.Zero] * n
    if description["dissipation"] is not None:
        loss = c.with_derivatives(c.adopted(description["nodes"], [description["dissipation"]]))
        acting = [force - lost for force, lost in zip(acting, along(loss, 1 + n)[0], strict=True)]
    held, reactions = [], []
    for kind, first in (("holonomic", 1), ("nonholonomic", 1 + n)):
        rows = c.with_derivatives(c.adopted(description["nodes"], description[kind]))
        held += c.to_sympy([row[0] for row in rows])
        reactions += along(rows, first)
    taken = {*names, *system.parameters}
    for number, row in enumerate(reactions, start=1):
        multiplier = sp.Symbol(free_name(f"lambda_{number}", taken))
        acting = [force + multiplier * each for force, each in zip(acting, row, strict=True)]
    left = [
        sum(m * x for m, x in zip(by_speed[i], a, strict=True))
        + sum(m * x for m, x in zip(by_place[i], v, strict=True))
        + by_time[i]
        - slopes[i]
        for i in range(n)
    ]
    jacobi = _shorter(sp, c.to_sympy(c.with_derivatives([energy])[0][:1])[0])
    written, latex = _notation(sp, names, (q, v, a))
    return EquationsOfMotion(
        names,
        [sp.Eq(_shorter(sp, each), force, evaluate=False) for each, force in zip(left, acting, strict=True)],
        [sp.Eq(each, 0, evaluate=False) for each in held],
        [
            sp.Eq(sp.Symbol(free_name(f"p_{name}", taken)), each, evaluate=False)
            for name, each in zip(names, c.to_sympy(p), strict=True)
        ],
        sp.Eq(sp.Symbol("h"), jacobi, evaluate=False),
        system.conserved,
        written,
        latex,
    )


def hamiltons_equations(system: Hamiltonian) -> HamiltonsEquations:
    """Give the equations of a Hamiltonian, with its further forces."""
    description = system._source.description
    rates, slopes = system._shown("conjugates"), system._shown("slopes")
    if description["forces"]:
        forces = system._trees(description["nodes"], description["forces"])
        slopes = [slope + force for slope, force in zip(slopes, forces, strict=True)]
    return _remade((rates, slopes), system._symbols())


def _shorter(sp: Any, expression: Any) -> Any:
    """Give an expression multiplied out where that is shorter: Coriolis' terms of several derivatives cancel."""
    return min(expression, sp.expand(expression), key=sp.count_ops)


def _notation(
    sp: Any, names: Iterable[str], groups: tuple[tuple[Any, ...], ...]
) -> tuple[dict[Any, Any], dict[Any, str]]:
    """Give plain symbols for coordinates, velocities and accelerations, and how formulas have them."""
    written: dict[Any, Any] = {}
    latex: dict[Any, str] = {}
    for name, places in zip(names, zip(*groups, strict=True), strict=True):
        plain = sp.latex(sp.Symbol(name))
        for each, primes, dotted in zip(places, ("", "'", "''"), ("{}", r"\dot{{{}}}", r"\ddot{{{}}}"), strict=True):
            symbol = sp.Symbol(name + primes)
            written[each], latex[symbol] = symbol, dotted.format(plain)
    return written, latex


def _name(symbol: Any) -> str:
    """Give the name of a symbol, or of a function of the time."""
    return str(getattr(symbol, "name", None) or symbol.func.__name__)


def _text(equation: Any, written: Mapping[Any, Any]) -> str:
    left, right = (side.xreplace(dict(written)) for side in (equation.lhs, equation.rhs))
    return f"{left} = {right}"


def _sides(equation: Any, written: Mapping[Any, Any], latex: Mapping[Any, str]) -> tuple[str, str]:
    """Give both sides of an equation in LaTeX."""
    left, right = (
        sympy("equations").latex(side.xreplace(dict(written)), symbol_names=dict(latex))
        for side in (equation.lhs, equation.rhs)
    )
    return left, right


def _formulas(equations: Iterable[Any], written: Mapping[Any, Any], latex: Mapping[Any, str]) -> str:
    joined = " \\\\\n".join(" &= ".join(_sides(each, written, latex)) for each in equations)
    return f"$$\\begin{{aligned}}\n{joined}\n\\end{{aligned}}$$"
