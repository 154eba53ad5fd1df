"""Eigenvalues λ of λ²M + λC + K, slow ones beside fast ones.

The one idea: methods for whole matrices err by a rounding of the largest eigenvalue in all of them. Slow ones are the
fast ones of the equations in 1/λ; and each is then led by Newton's method to where its own matrix is singular, in whose
entries nothing larger than itself is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["are_simple", "eigenvalues"]

#: Newton's steps to an eigenvalue, and how small the last of them are: to a multiple one they do not become so.
_STEPS = 12
_SETTLED = 16.0 * np.finfo(np.float64).eps
#: Eigenvalues below this part of the largest are slow.
_SLOW = 1e-2
#: Partners in two lists that agree alike are those of the same rank.
_BY_RANK = 1e-6
#: Of more coordinates than this, eigenvalues are those of methods for whole matrices, to this part of the largest.
_MOST = 32
_OF_THE_LARGEST = 1e-7
_OF_ROUNDING = 1.0 / 16.0
#: An eigenvalue moves by at most this part of itself, and no two come nearer to each other than that of what they were.
_MOVES = 0.1
#: Roundings of the entries of M, C and K.
_ROUNDINGS = 4.0
#: Singular values above this part of the largest entry are those of no vector: of a multiple eigenvalue half of the
#: digits are left.
_NO_VECTOR = 1e-6


def eigenvalues(
    mass: NDArray[np.float64],
    damping: NDArray[np.float64],
    stiffness: NDArray[np.float64],
    rounding: NDArray[np.float64],
) -> tuple[NDArray[np.complex128], NDArray[np.float64]]:
    """Give them (2n), 0 where they are but what K is rounded by, and by how much they may be off.

    They are not finite where they leave the range of numbers.
    """
    if len(mass) > _MOST:
        found = _of_first_order(mass, damping, stiffness)
        least = _OF_THE_LARGEST * np.abs(found).max()
        return np.where(np.abs(found) > least, found, 0.0), np.full(len(found), _OF_ROUNDING * least)
    found = _of_matrices(mass, damping, stiffness)
    if not np.isfinite(found).all():
        return found, np.abs(found)
    led = np.array([_led(mass, damping, stiffness, value) if value.imag >= 0.0 else value for value in found])
    for index, value in enumerate(found):
        if value.imag < 0.0:
            # The other one of a pair.
            partner = np.flatnonzero(found == value.conjugate())
            led[index] = led[partner[0]].conjugate() if partner.size else value
    # Two that are led to one were two: both stay where they were.
    apart, left = (np.abs(each[:, None] - each) for each in (found, led))
    led = np.where((left < _MOVES * apart).any(axis=1), found, led)
    unsure = np.array([_unsure(mass, damping, stiffness, rounding, value) for value in led])
    return np.where(np.abs(led) > unsure, led, 0.0), unsure


def are_simple(
    matrices: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    rounding: NDArray[np.float64],
    values: NDArray[np.complex128],
    unsure: NDArray[np.float64],
) -> bool:
    """Whether eigenvalues (V) of M, C and K that are off by so much have as many vectors as they are equal ones.

    Else motions t exp(λ t) grow. Equal ones with vectors of their own, as of equal springs, do not.
    """
    mass, damping, stiffness = matrices
    if len(mass) > _MOST:
        return True
    for value, off in zip(values, unsure, strict=True):
        equal = int((np.abs(values - value) <= off + unsure).sum())
        if equal == 1:
            continue
        at = (value * mass + damping) * value + stiffness
        size = abs(value)
        entries = size * (size * np.abs(mass) + np.abs(damping)) + np.abs(stiffness)
        # In units of coordinates in which the largest entry of each is 1.
        unit = 1.0 / np.sqrt(np.maximum(entries.max(axis=0), entries.max(axis=1)))
        moves = (2.0 * size * np.abs(mass) + np.abs(damping)) * off + rounding
        zero = _NO_VECTOR + np.linalg.norm(unit[:, None] * moves * unit)
        # Of fewer vectors than eigenvalues the last that is looked at leads elsewhere.
        if np.linalg.svd(unit[:, None] * at * unit, compute_uv=False)[-equal] > zero:
            return False
    return True


def _of_matrices(
    mass: NDArray[np.float64], damping: NDArray[np.float64], stiffness: NDArray[np.float64]
) -> NDArray[np.complex128]:
    """Of the equations of the first order, and slow ones of the same equations in 1/λ, if there are any."""
    fast = _of_first_order(mass, damping, stiffness)
    if np.isfinite(fast).all() and np.abs(fast).min() > _SLOW * np.abs(fast).max():
        return fast
    try:
        slow = _of_first_order(stiffness, damping, mass)
    except np.linalg.LinAlgError:
        return fast
    if not np.isfinite(slow).all() or not slow.any():
        return fast
    with np.errstate(all="ignore"):
        slow = np.where(slow == 0.0, np.inf, 1.0 / slow)
    return _fast_or_slow(fast, slow)


def _fast_or_slow(fast: NDArray[np.complex128], slow: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Give those of the one list that are fast, and of the other that are slow: each has a partner in the other."""
    sizes = np.abs(fast)
    middle = np.sqrt(sizes.max()) * np.sqrt(np.abs(slow).min())
    with np.errstate(all="ignore"):
        apart = np.abs(fast[:, None] - slow) / (sizes[:, None] + np.abs(slow))
    # What rounding has made of slow ones in the first list, and of fast ones in the other, has its place by its size.
    ranks = [np.argsort(np.argsort(each)) for each in (sizes, np.abs(slow))]
    apart = np.where(np.isnan(apart), 1.0, apart) + _BY_RANK * np.abs(ranks[0][:, None] - ranks[1])
    found = fast.copy()
    left, right = np.ones(len(fast), dtype=bool), np.ones(len(slow), dtype=bool)
    # Partners that agree best first.
    for one, other in zip(*np.unravel_index(np.argsort(apart, axis=None), apart.shape), strict=True):
        if left[one] and right[other]:
            left[one] = right[other] = False
            if np.abs(slow[other]) < middle:
                found[one] = slow[other]
    return found


def _of_first_order(
    first: NDArray[np.float64], second: NDArray[np.float64], third: NDArray[np.float64]
) -> NDArray[np.complex128]:
    n = len(first)
    matrix = np.zeros((2 * n, 2 * n))
    matrix[:n, n:] = np.eye(n)
    with np.errstate(all="ignore"):
        matrix[n:] = -np.linalg.solve(first, np.hstack([third, second]))
    if not np.isfinite(matrix).all():
        return np.full(2 * n, np.nan, dtype=np.complex128)
    # LAPACK takes units for the numbers of a state first, so that rounding of the largest is not that of all.
    return np.linalg.eigvals(matrix).astype(np.complex128)


def _led(
    mass: NDArray[np.float64], damping: NDArray[np.float64], stiffness: NDArray[np.float64], start: np.complex128
) -> complex:
    """Give where Newton's method for the determinant leads, if it comes to one eigenvalue nearby; else the start."""
    value = complex(start)
    real = value.imag == 0.0
    for _ in range(_STEPS):
        if value == 0.0:
            break
        at = value.real if real else value
        slope = 2.0 * at * mass + damping
        try:
            with np.errstate(all="ignore"):
                step = complex(1.0 / np.trace(np.linalg.solve((at * mass + damping) * at + stiffness, slope)))
        except np.linalg.LinAlgError:
            return value
        if not np.isfinite(step) or abs(value - step - start) > _MOVES * abs(start):
            break
        value -= step
        # Of what hardly decays the real part has its own digits.
        settled = abs(step) <= _SETTLED * abs(value) and (real or abs(step.real) <= _SETTLED * abs(value.real))
        if settled:
            return value
    return complex(start)


def _unsure(
    mass: NDArray[np.float64],
    damping: NDArray[np.float64],
    stiffness: NDArray[np.float64],
    rounding: NDArray[np.float64],
    value: complex,
) -> float:
    """Give by how much it may be off, as the rounding of K and that of the entries make of it."""
    at = (value * mass + damping) * value + stiffness
    left, sizes, right = np.linalg.svd(at)
    y, x = np.abs(left[:, -1]), np.abs(right[-1])
    slope = abs(left[:, -1].conj() @ (2.0 * value * mass + damping) @ right[-1].conj())
    bend = abs(left[:, -1].conj() @ mass @ right[-1].conj())
    entries = abs(value) * (abs(value) * np.abs(mass) + np.abs(damping)) + np.abs(stiffness)
    # What is left where it is none counts, too.
    off_by = 2.0 * float(sizes[-1]) + float(y @ (rounding + _ROUNDINGS * np.finfo(np.float64).eps * entries) @ x)
    # Of a multiple one the slope vanishes, and it is off by a root.
    total = slope + np.sqrt(slope * slope + 4.0 * bend * off_by)
    return 2.0 * off_by / float(total) if total > 0.0 else 0.0


def __dir__() -> list[str]:
    return list(__all__)
