"""Smooth walls, bumps and pulses that are far narrower than a step, and nothing at the places where steps look.

Widths are 1e-2, 1e-3 and 1e-4 of the way. What is expected is a quadrature of the energy (mpmath's, with its nodes crowded
at the ends) or closed; bounds are by the method's order: gauss16 and taylor resolve a wall to their rtol of 1e-12 and 1e-10
over some hundred steps, of which the wall takes the digits that its steepness costs; the embedded ones to their rtol of 1e-9
at some thousand places, each of them off by the size of the motion; gauss8 and gauss4 are what `test_unfelt_forces` has.
"""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
import sympy as sp

import visviva as vv

x = vv.coordinate("x")
vx = x.diff(vv.time)
METHODS = ["auto", "gauss16", "gauss8", "gauss4", "taylor", "dop853", "verner98"]
WIDTHS = [1e-2, 1e-3, 1e-4]
HEIGHT = 50.0


def wall(width: float) -> sp.Expr:
    """Falls with g = 1 onto a wall at 0."""
    return vx**2 / 2 - x - HEIGHT * (1 - sp.tanh(x / sp.Float(width))) / 2


def period_on_wall(width: float) -> float:
    """2 ∫ dq/v from where the wall throws back to the height 1, in s = q/width near the wall."""
    mpmath.mp.dps = 30
    w, height = mpmath.mpf(width), mpmath.mpf(HEIGHT)

    def over(q: mpmath.mpf) -> mpmath.mpf:
        return 1 - q - height * (1 - mpmath.tanh(q / w)) / 2

    foot = mpmath.findroot(lambda s: over(s * w), 2) * w
    places = [foot, foot + w, foot + 4 * w, foot + 16 * w, foot + 64 * w, 1] if width < 5e-3 else [foot, foot + w, 0.1, 1]
    return float(2 * mpmath.quad(lambda q: 1 / mpmath.sqrt(2 * over(q)) if over(q) > 0 else 0, places))
