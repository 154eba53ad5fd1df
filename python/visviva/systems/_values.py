"""Parameters of ready-made systems, checked under the names that their functions have."""

from __future__ import annotations

from visviva._arrays import number, positive

__all__ = ["checked"]

#: Masses and lengths: without them there is no motion, or none that has a name.
_POSITIVE = ("m", "m1", "m2", "cart", "counterweight", "l", "l1", "l2", "length", "R")


def checked(**values: object) -> dict[str, float]:
    """Give parameters as numbers, masses and lengths positive."""
    return {name: positive(name, value) if name in _POSITIVE else number(name, value) for name, value in values.items()}
