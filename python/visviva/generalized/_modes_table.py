"""How small motions about a place are told: a row for each, its frequency first.

The one idea: what is asked for are frequencies; the matrices that they come from are attributes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva._html import Sheet, first_rows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._analysis import Linearization

__all__ = ["modes_table"]

#: Numbers of a shape that are shown; the rest are counted.
_NUMBERS = 8


def modes_table(small: Linearization, axis: float) -> Sheet:
    """A row for each motion; parts below `axis` times an eigenvalue are those of round-off."""
    motions = _motions(small, axis)
    rates = [rate for _, rate in motions]
    columns = ["angular frequency", "period"]
    amplitudes = any(rate != 0.0 for rate in rates) or any(frequency == 0.0 for frequency, _ in motions)
    if amplitudes:
        columns.append("amplitude")
    if small.modes is not None:
        few = len(small.coordinates) <= _NUMBERS
        columns.append(f"shape ({', '.join(small.coordinates)})" if few else "shape")

    def row(index: int) -> tuple[str, ...]:
        frequency, rate = motions[index]
        texts = [f"{frequency:.9g}" if frequency else "0", f"{2.0 * np.pi / frequency:.9g}" if frequency else "none"]
        if amplitudes:
            texts.append(_amplitude(frequency, rate))
        if small.modes is not None:
            texts.append(_shape(small.modes[index]))
        return f"{index + 1}", *texts

    rows, rest = first_rows(len(motions), row)
    place = _shape(small.position)
    notes = [rest, "angular frequencies in radians per unit of time, periods in units of time"]
    notes.append(
        "shapes with ξᵀMξ = 1" if small.modes is not None else "no real shapes with damping or gyroscopic terms"
    )
    notes.append("M, C, K: mass, damping, stiffness")
    caption = f"Small motions about {place}: {'stable' if small.stable else 'unstable'}"
    return Sheet(caption, rows, ("", *columns), "; ".join(note for note in notes if note))


def _motions(small: Linearization, axis: float) -> list[tuple[float, float]]:
    """Of each motion its angular frequency and by which rate its amplitude grows."""
    if small.squares is not None:
        return [(float(np.sqrt(max(s, 0.0))), float(np.sqrt(max(-s, 0.0)))) for s in small.squares]
    found = []
    for value in small.eigenvalues:
        least = axis * abs(value)
        if value.imag < -least:
            # The other one of a pair.
            continue
        frequency, rate = (part if abs(part) > least else 0.0 for part in (float(value.imag), float(value.real)))
        found.append((frequency, rate))
    return sorted(found)


def _amplitude(frequency: float, rate: float) -> str:
    if rate != 0.0:
        return f"{'grows' if rate > 0.0 else 'decays'} at the rate {abs(rate):.9g}"
    return "stays" if frequency else "moves on, neither grows nor returns"


def _shape(numbers: NDArray[np.float64]) -> str:
    texts = [f"{number + 0.0:.6g}" for number in numbers[:_NUMBERS]]
    rest = len(numbers) - len(texts)
    return f"({', '.join(texts)}{f', … {rest} more' if rest else ''})"


def __dir__() -> list[str]:
    return list(__all__)
