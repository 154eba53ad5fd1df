"""Small motions on constraints: places where reactions balance the forces, and what is free to move there.

The one idea: near a place a system on constraints is one with fewer coordinates, those along its tangent directions.
Its K is that of the forces, less what each reaction λ does where the direction of its constraint turns.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from visviva.errors import InvalidInput
from visviva.generalized._calculus import Calculus
from visviva.generalized._higher_orders import Energy
from visviva.generalized._matrices import LAST_DIGITS, Sizes, matrices, matrices_along, rounding
from visviva.generalized._multiple_zeros import left_open, units

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._lagrangian import Lagrangian
    from visviva.generalized._matrices import Matrices

__all__ = ["BALANCED", "Balance", "Constrained"]

#: Forces below this part of what they are made of are round-off, or that of the place.
BALANCED = 1e-8
#: Residuals of constraints above this part of what they are made of are no round-off.
_CONSISTENT = 1e-10
#: Newton's steps to a constraint, and to a balance of forces on it.
_TO_CONSTRAINTS = 40
_TO_BALANCE = 60
#: The least part that Newton's steps leave of the way to a zero that is not simple, and how often it is looked for.
_OF_A_DOUBLE_ZERO = 0.4
_SOMETIMES = 4
#: Places so many times farther than what is looked at are none that were looked for.
_FAR = 1e6
#: A step that is below this part of the place is round-off.
_FOUND = 1e-13
#: Singular values below this part of the largest are zero: of derivatives …
_SINGULAR = 1e-10
#: Directions of constraints are: of those that depend on each other a place is found to half of its digits.
_DEPENDENT = 1e-6
#: Slopes of a constraint that are this part of how they change on the way to the origin are the rounding of the place.
_NO_DIRECTION = 1e-7
#: An equation that is this part of others has nothing but rounding.
_NOTHING = 1e-20


class _Told(NamedTuple):
    """Of constraints at places: residuals (S, h), directions A (S, m, n), and ∂A/∂q (S, m, n, n).

    Of nonholonomic ones a·q̇ + b what is left at rest, b (S, k) and ∂b/∂q (S, k, n).
    """

    residuals: NDArray[np.float64]
    rates: NDArray[np.float64]
    slopes_of_rates: NDArray[np.float64]
    directions: NDArray[np.float64]
    turning: NDArray[np.float64]


class Balance(NamedTuple):
    """A place at rest: M, C and K (n, n) with F + Aᵀλ for F, free directions (n, d), and what forces leave open.

    That is how far (n) it may be moved until they are seen, and whether beside the constraint that holds it on what it
    may roll away from it is none.
    """

    matrices: Matrices
    rounding: NDArray[np.float64]
    tangent: NDArray[np.float64]
    left_open: NDArray[np.float64]
    drifts: bool


class Constrained:
    """A Lagrangian with constraints, at rest."""

    def __init__(self, system: Lagrangian) -> None:
        from visviva.generalized._lagrangian import Lagrangian

        source, n = system._source, len(system.coordinates)
        self.free: Lagrangian = object.__new__(Lagrangian)
        without = source.description | {"holonomic": [], "nonholonomic": []}
        state = (system.position, system._second, system.t0)
        self.free._prepare(
            type(source)(source.kind, source.names, source.groups, source.parameters, without),
            list(system.parameters.values()),
            state,
        )
        self.sizes = Sizes(self.free)
        self._system, self._n = system, n
        self._calculus = c = Calculus(self.free)
        holonomic = c.with_derivatives(c.adopted(source.description["nodes"], source.description["holonomic"]))
        others = c.with_derivatives(c.adopted(source.description["nodes"], source.description["nonholonomic"]))
        if any(not c.is_zero(row[-1]) for row in (*holonomic, *others)):
            raise InvalidInput("constraints", "small motions are those about a place at rest, and a constraint moves")
        self.holonomic, self.all = len(holonomic), len(holonomic) + len(others)
        if self.all >= n:
            raise InvalidInput("constraints", f"{self.all} of them leave none of {n} coordinates free to move")
        known = [
            [not (c.is_zero(row[1 + i]) and c.is_zero(row[1 + n + i])) for i in range(n)]
            for row in (*holonomic, *others)
        ]
        #: Which coordinates have a constraint in common, and which none at all.
        self._together = _connected(np.array(known, dtype=bool))
        self.without_any: NDArray[np.bool_] = np.all(~np.array(known, dtype=bool), axis=0)
        directions = [each for row in holonomic for each in row[1 : 1 + n]]
        directions += [each for row in others for each in row[1 + n : 1 + 2 * n]]
        turning = [each for row in c.with_derivatives(directions) for each in row[1 : 1 + n]]
        slopes = [each for row in others for each in row[1 : 1 + n]]
        self._expressions = [*(row[0] for row in (*holonomic, *others)), *slopes, *directions, *turning]

    def told(self, places: NDArray[np.float64]) -> _Told:
        """Give what constraints are at places (S, n)."""
        states = np.concatenate([places, np.zeros_like(places)], axis=1)
        times = np.full(len(places), self.free.t0)
        with np.errstate(all="ignore"):
            found = self._calculus.values(self._expressions, times, states, self.free._values)
        h, m, n = self.holonomic, self.all, self._n
        ends = np.cumsum([h, m - h, (m - h) * n, m * n])
        residuals, rates, slopes, directions, turning = np.split(found, ends, axis=1)
        shapes = ((m - h, n), (m, n), (m, n, n))
        of_rates, across, turned = (
            part.reshape(len(places), *shape) for part, shape in zip((slopes, directions, turning), shapes, strict=True)
        )
        return _Told(residuals, rates, of_rates, across, turned)

    @np.errstate(all="ignore")
    def reached(self, starts: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Give places (R, n) in balance that Newton's method comes to, and how far (n) starts reach on constraints."""
        on = self._put_on(starts)
        on = on[np.isfinite(on).all(axis=1)]
        far = np.abs(on).max(axis=0, initial=0.0)
        scale = np.fmax(np.abs(starts).max(axis=0, initial=0.0), far)
        largest = float(scale.max(initial=0.0)) or 1.0
        n, m = self._n, self.all
        places, reactions, before = on, np.zeros((len(on), m)), np.full(len(on), np.nan)
        done: list[NDArray[np.float64]] = []
        for step in range(_TO_BALANCE):
            if not len(places):
                break
            forces, stiffness = matrices_along(self.free, places)
            told = self.told(places)
            if step == 0:
                reactions = -_solved(told.directions.transpose(0, 2, 1), forces, rows_alike=False)
            bent = -stiffness + np.einsum("sk,skij->sij", reactions, told.turning)
            # Constraints are weighed to be as stiff as forces, whatever they are multiplied by.
            stiff = np.abs(bent).max(axis=(1, 2), initial=0.0) + np.abs(forces).max(axis=1) / largest
            steep = np.abs(told.directions).max(axis=2, initial=0.0)
            weights = np.where((steep > 0.0) & (stiff > 0.0)[:, None], stiff[:, None] / steep, 1.0)
            weighed, own = told.directions * weights[:, :, None], weights[:, : self.holonomic]
            top = np.concatenate([bent, weighed.transpose(0, 2, 1)], axis=2)
            none = np.zeros((len(places), self.holonomic, m))
            bottom = np.concatenate([weighed[:, : self.holonomic], none], axis=2)
            balance = forces + np.einsum("sk,ski->si", reactions, told.directions)
            off = np.concatenate([balance, told.residuals * own], axis=1)
            moved = -_solved(np.concatenate([top, bottom], axis=1), off, forces=n)
            moved[:, n:] *= weights
            size = np.abs(places).max(axis=1, initial=0.0, keepdims=True)
            small = (np.abs(moved[:, :n]) <= _FOUND * size).all(axis=1)
            long = np.linalg.norm(moved[:, :n], axis=1)
            with np.errstate(all="ignore"):
                shorter = long / before
            # To a zero of higher order each step takes the same part of the way.
            linear = (shorter > _OF_A_DOUBLE_ZERO) & (shorter < 1.0) & (step % _SOMETIMES == 0)
            factor = np.where(linear, 1.0 / (1.0 - np.where(linear, shorter, 0.0)), 1.0)[:, None]
            places, reactions = places + factor * moved[:, :n], reactions + factor * moved[:, n:]
            going = ~small & np.isfinite(places).all(axis=1) & np.isfinite(reactions).all(axis=1)
            done += list(places[small & np.isfinite(places).all(axis=1)])
            places, reactions, before = places[going], reactions[going], np.where(linear, np.nan, long)[going]
        # What does not come to rest may be a place that forces tell to some of its digits only.
        done += list(places)
        # Far away, where forces have become zero, nothing is an equilibrium.
        near = [place for place in done if np.abs(place).max(initial=0.0) <= _FAR * largest]
        balanced = [place for place in near if self.off_balance(place) is None]
        return np.array(balanced).reshape(-1, n), far

    def _put_on(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Give the nearest places on the holonomic constraints, or nearly so."""
        for _ in range(_TO_CONSTRAINTS if self.holonomic else 0):
            told = self.told(places)
            moved = _solved(told.directions[:, : self.holonomic], told.residuals, columns_alike=False)
            places = places - moved
            if not (np.abs(moved) > _FOUND * np.abs(places).max(axis=1, keepdims=True)).any():
                break
        return places

    def _sizes(self, place: NDArray[np.float64], unit: NDArray[np.float64]) -> NDArray[np.float64]:
        """Sizes (n) of what a constraint has together, in units of masses: what is 0 by symmetry is so to rounding."""
        sizes: NDArray[np.float64] = unit * (self._together * np.abs(place / unit)).max(axis=1, initial=0.0)
        return sizes

    def reactions(self, place: NDArray[np.float64], forces: NDArray[np.float64], told: _Told) -> NDArray[np.float64]:
        """Give those (m) that come nearest to the balance of forces."""
        unit = units(self.free, place)
        across, against = (told.directions[0] * unit).T, forces * unit
        found: NDArray[np.float64] = -_solved(across[None], against[None], rows_alike=False)[0]
        return found

    @np.errstate(all="ignore")
    def off_balance(self, place: NDArray[np.float64]) -> str | None:
        """Say what is not at rest at a place, if anything is."""
        forces, stiffness = (part[0] for part in matrices_along(self.free, place[None]))
        told = self.told(place[None])
        if not all(np.isfinite(part).all() for part in (forces, stiffness, *told)):
            return "forces or constraints have no value there"
        unit = units(self.free, place)
        size = self._sizes(place, unit)
        for index, residual in enumerate(np.concatenate([told.residuals[0], told.rates[0]])):
            if abs(residual) > _CONSISTENT * (np.abs(told.directions[0, index]) @ size):
                return f"constraint {index} is {residual:.3g} and not 0"
        reactions = self.reactions(place, forces, told)
        held = np.abs(reactions) @ np.abs(told.directions[0])
        scale = (np.abs(stiffness) + np.einsum("k,kij->ij", np.abs(reactions), np.abs(told.turning[0]))) @ size + held
        # Reactions are known to the rounding of the forces that they balance.
        unsure = np.abs(np.linalg.pinv((told.directions[0] * unit).T)) @ (scale * unit)
        scale = scale + unsure @ np.abs(told.directions[0])
        left = np.abs(forces + reactions @ told.directions[0])
        if (left <= BALANCED * scale).all() or (left <= BALANCED * (scale + self.sizes.forces(place[None])[0])).all():
            return None
        worst = int(np.argmax(left))
        return f"a force of {left[worst]:.3g}, which no reaction balances, acts on {self.free.coordinates[worst]!r}"

    def balance(self, place: NDArray[np.float64], looked_at: NDArray[np.float64] | None = None) -> Balance:
        """Give matrices and free directions at a place at rest, among places of a size (n) that are looked at.

        Raises
        ------
        InvalidInput
            Where forces are left, or constraints depend on each other.
        """
        wrong = self.off_balance(place)
        if wrong is not None:
            raise InvalidInput("at", f"expected an equilibrium, but {wrong}; see equilibria()")
        found, told = matrices(self.free, place), self.told(place[None])
        directions, turning = told.directions[0], told.turning[0]
        if told.slopes_of_rates.any():
            raise InvalidInput(
                "nonholonomic",
                "small motions are those under constraints a(q)·q̇ = 0; one with a further term b(q) has motions of "
                "another kind: run the system from beside the equilibrium",
            )
        unit = units(self.free, place)
        # Rows alike, whatever a constraint is multiplied by.
        rows = directions * unit
        rows = rows / np.linalg.norm(rows, axis=1, keepdims=True).clip(min=np.finfo(float).tiny)
        _, singular, across = np.linalg.svd(rows)
        if singular.size and singular[-1] <= _DEPENDENT * singular[0]:
            raise InvalidInput("at", "the constraints depend on each other there: leave one out")
        size = self._sizes(place, unit)
        bends = np.einsum("kij,i,j->k", np.abs(turning), size, size)
        if (vanishing := np.abs(directions) @ size < _NO_DIRECTION * bends).any():
            raise InvalidInput(
                "at",
                f"constraint {int(np.argmax(vanishing))} has no direction there, as that of a square has none where it "
                "is 0: write it so that its derivatives do not vanish",
            )
        reactions = self.reactions(place, found.forces, told)
        stiffness = found.stiffness - np.einsum("k,kij->ij", reactions, turning)
        off = rounding(self.free, place, found.stiffness, self.sizes)
        off = off + 4.0 * LAST_DIGITS * np.einsum("k,kij->ij", np.abs(reactions), np.abs(turning))
        tangent = (across[len(rows) :] * unit).T
        free = tangent.T @ stiffness @ tangent
        if self.all > self.holonomic:
            drifts = _drifts(free, tangent.T @ stiffness @ (across[: len(rows)] * unit).T)
            return Balance(found._replace(stiffness=stiffness), off, tangent, np.zeros(self._n), drifts)
        energy, here = self.along(place, tangent), np.zeros(tangent.shape[1])
        far = np.abs(place) if looked_at is None else np.fmax(np.abs(place), looked_at)
        alike = np.full(tangent.shape[1], (far / unit).max(initial=0.0))
        left = left_open(energy, here, alike, np.ones_like(here)) if far.any() and here.size else None
        if left is not None:
            # A zero of higher order is told by forces to some of its digits only, and so is K there.
            beside = np.abs(energy.slopes(np.stack([left, -left]))[1] - free).max(axis=0)
            back = np.abs(np.linalg.pinv(tangent))
            off = off + back.T @ beside @ back
        unseen = np.zeros(self._n) if left is None else np.abs(tangent) @ np.abs(left)
        return Balance(found._replace(stiffness=stiffness), off, tangent, unseen, drifts=False)

    def along(self, place: NDArray[np.float64], tangent: NDArray[np.float64]) -> Energy:
        """Give the potential of the forces on the holonomic constraints, by distances η along free directions."""
        across = np.linalg.svd(self.told(place[None]).directions[0, : self.holonomic])[2][: self.holonomic].T

        def at(distances: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
            places = place + distances @ tangent.T
            for _ in range(_TO_CONSTRAINTS):
                told = self.told(places)
                steep = told.directions[:, : self.holonomic] @ across
                moved = _solved(steep, told.residuals) @ across.T
                places = places - moved
                # Next to the place what is left of a constraint may be as small as the distance.
                if not moved.any():
                    break
            told = self.told(places)
            directions = told.directions[:, : self.holonomic]
            steep = np.linalg.pinv(_finite(directions @ across))
            bent = tangent - across @ (steep @ (directions @ tangent))
            forces, stiffness = matrices_along(self.free, places)
            reactions = -np.einsum("si,ik,skh->sh", forces, across, steep)
            full = stiffness - np.einsum("sk,skij->sij", reactions, told.turning[:, : self.holonomic])
            size = np.abs(places)
            made_of = np.einsum("shi,si->sh", np.abs(directions), size)
            # Of a sum of squares more than its slopes tell.
            made_of += np.einsum("shij,si,sj->sh", np.abs(told.turning[:, : self.holonomic]), size, size)
            forces[(np.abs(told.residuals) > _CONSISTENT * made_of).any(axis=1)] = np.nan
            return places, bent, forces, full

        def slopes(distances: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
            _, bent, forces, full = at(distances)
            return -np.einsum("si,sid->sd", forces, bent), np.einsum("sid,sij,sje->sde", bent, full, bent)

        def sizes(distances: NDArray[np.float64]) -> NDArray[np.float64]:
            places, bent, forces, full = at(distances)
            made_of = np.abs(forces) + self.sizes.forces(places) + np.einsum("sij,sj->si", np.abs(full), np.abs(places))
            of_slopes: NDArray[np.float64] = np.einsum("si,sid->sd", made_of, np.abs(bent))
            return of_slopes

        return Energy(slopes, sizes)


def _connected(has: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether coordinates (n, n) have constraints (m, n) in common, or are connected by others."""
    reached = (has.T.astype(int) @ has > 0) | np.eye(has.shape[1], dtype=bool)
    for _ in range(has.shape[1].bit_length()):
        reached = reached.astype(int) @ reached > 0
    return reached


def _drifts(free: NDArray[np.float64], across: NDArray[np.float64]) -> bool:
    """Whether forces along level directions of K (d, d) come of displacements (k) across constraints of velocities.

    These stay, and so do the forces.
    """
    if not free.size:
        return False
    left, sizes, _ = np.linalg.svd(free)
    whole = max(float(sizes[0]), float(np.abs(across).max(initial=0.0)))
    forces = left.T[sizes <= _SINGULAR * whole] @ across
    return bool((np.abs(forces) > _SINGULAR * whole).any())


def _solved(
    matrix: NDArray[np.float64],
    right: NDArray[np.float64],
    *,
    rows_alike: bool = True,
    columns_alike: bool = True,
    forces: int | None = None,
) -> NDArray[np.float64]:
    """Give the least solutions (S, j) of many equations (S, i, j), of which columns, and rows, may have own units.

    Weighed by their sizes, more rows than columns must be consistent, and more columns than rows give another solution.
    The first rows may be those of forces, the others those of constraints.
    """
    bad = ~(np.isfinite(matrix).all(axis=(1, 2)) & np.isfinite(right).all(axis=1))
    matrix, right = _finite(matrix), _finite(right)
    rows = np.ones((*right.shape, 1))
    if rows_alike:
        rows = np.abs(matrix).max(axis=2, initial=0.0, keepdims=True)
        for kind in (rows[:, :forces], rows[:, forces:] if forces is not None else rows[:, :0]):
            # What is next to nothing beside others of its kind is the rounding of 0.
            kind[...] = np.fmax(kind, _NOTHING * kind.max(axis=1, initial=0.0, keepdims=True))
        rows[rows == 0.0] = 1.0
    columns = np.ones((len(matrix), 1, matrix.shape[2]))
    if columns_alike:
        columns = np.abs(matrix / rows).max(axis=1, initial=0.0, keepdims=True)
        columns[columns == 0.0] = 1.0
    solved = np.linalg.pinv(matrix / rows / columns, rcond=_SINGULAR) @ (right[:, :, None] / rows)
    found: NDArray[np.float64] = solved[:, :, 0] / columns[:, 0]
    found[bad] = np.nan
    return found


def _finite(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.where(np.isfinite(matrix), matrix, 0.0)


def __dir__() -> list[str]:
    return list(__all__)
