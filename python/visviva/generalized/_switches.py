"""What to write in an expression for what switches, leaps or is bent, which no table of operations has.

The one idea: a cure depends on what the expression is for. In equations of motion it says what steps make of it, and
that a run can end where laws change; a question, as whether a transformation is canonical, has neither.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

if TYPE_CHECKING:
    #: Equations of motion; functions of a state that are asked for something, or looked at; a potential of a distance.
    Purpose: TypeAlias = Literal["motion", "question", "distance"]

__all__ = ["SWITCH", "WIDTH", "instead", "switches", "tells_of_switches"]

#: Of a smooth step in the place of a leap: one that is narrower than a step is found by methods that choose theirs.
WIDTH = "which steps follow; what sticks costs time as 1/width, so take a thousandth of the usual values for it"
#: Where two laws meet.
SWITCH = "end the run by an event where it switches, and go on from out.final with the other law"
#: Of dop853 at 1e-12, and rk4 at 100 steps to a unit of time, past a corner of a force and one of a potential.
_CORNER = "whose corner takes ten to forty steps of dop853 at each passage, and from a given dt its order"
_PARTS = "ask of each part by itself, on its own side"
_LARGER = "write (x + y + abs(x - y)) / 2, of more than two one after the other"
_SMALLER = "write (x + y - abs(x - y)) / 2, of more than two one after the other"
#: What is the same as it, where there is such a thing, by the name in NumPy.
_EXACT = {
    "floor_divide": "x // y leaps; write x / y where that is meant",
    "remainder": "x % y leaps; where it is to wrap an angle, leave it: sines and cosines do so themselves",
    "divmod": "divmod leaps; write x / y where that is meant",
    "sign": "write x / abs(x), which has no value at 0",
    "heaviside": "write (1 + x / abs(x)) / 2, which has no value at 0",
    "maximum": _LARGER,
    "fmax": _LARGER,
    "minimum": _SMALLER,
    "fmin": _SMALLER,
} | {
    name: f"{name} is the same between leaps: put a number in its place"
    for name in ("floor", "ceil", "trunc", "rint", "round")
}
#: What comes near to it with a width.
_SMOOTH = {"sign": "np.tanh(x / width)", "heaviside": "(1 + np.tanh(x / width)) / 2"}
#: What SymPy and Python call otherwise.
_NAMES = {"Max": "maximum", "Min": "minimum", "Heaviside": "heaviside", "Piecewise": "where", "ceiling": "ceil"}


def switches(name: str) -> bool:
    """Whether a function of NumPy is one of these."""
    return name in _EXACT


def tells_of_switches(message: str) -> bool:
    """Whether a refusal is of one of these."""
    return any(word in message for word in (" switches", " leaps", " is bent", "truth value"))


def instead(name: str, purpose: Purpose, *, symbols: bool = False) -> str:
    """What to write for a function of NumPy or Python, or of SymPy, by its name."""
    name = _NAMES.get(name, name)
    if purpose == "distance":
        of_two = f"{_EXACT[name]}; or, " if _EXACT.get(name) in (_LARGER, _SMALLER) else ""
        cure = f"{of_two}{_two_laws('r')}; blend what jumps: {_blend('r')}"
    elif name == "where":
        blend = f"or blend them, {_blend('x')}"
        rest = f"{_CORNER}, {blend}, {WIDTH}, or {SWITCH}" if purpose == "motion" else f"or {_PARTS}"
        cure = f"{_two_laws('x')}, {rest}"
    elif purpose == "question":
        cure = f"{_EXACT[name]}, or {_PARTS}"
    else:
        near = f", or {_SMOOTH[name]}, {WIDTH}" if name in _SMOOTH else ""
        corner = f", {_CORNER}" if _EXACT[name] in (_LARGER, _SMALLER) else ""
        cure = f"{_EXACT[name]}{corner}{near}, or {SWITCH}"
    # As SymPy has it, and prints it.
    return cure.replace("np.", "").replace("abs(", "Abs(").replace(" / ", "/") if symbols else cure


def _two_laws(x: str) -> str:
    """Exactly that of two laws on both sides of a place a, where they have one value there."""
    return (
        f"where f below a goes on as g above it without a jump, write f(s) + g(l) - g(a), s being the smaller of {x} "
        f"and a, ({x} + a - abs({x} - a)) / 2, and l the larger, ({x} + a + abs({x} - a)) / 2"
    )


def _blend(x: str) -> str:
    return f"f + (g - f) * (1 + np.tanh(({x} - a) / width)) / 2"
