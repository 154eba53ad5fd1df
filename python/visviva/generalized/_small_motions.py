"""What a Lagrangian's motions are near an equilibrium, and over a period of one degree of freedom."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import number
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.generalized._analysis import Linearization, linearization
from visviva.generalized._equilibria import Equilibrium, equilibria
from visviva.generalized._returns import (
    action_by_return,
    action_of_hamiltonian,
    action_of_lagrangian,
    gauge_part,
    period_by_return,
    period_of_hamiltonian,
    period_of_lagrangian,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["SmallMotions"]


@known_keywords
class SmallMotions:
    """Base of `Lagrangian` and `Hamiltonian`: equilibria, normal modes, periods."""

    __slots__ = ()

    def linearize(self: Any, at: ArrayLike | None = None) -> Linearization:
        """Small motions about an equilibrium.

        Units: those of the system.

        Parameters
        ----------
        at : array_like, shape (n,), optional
            The equilibrium; the start if not given.

        Returns
        -------
        Linearization
            Its frequencies, modes and matrices, at this place.

        Raises
        ------
        InvalidInput
            For a place that is none, or is off constraints; where constraints depend on each other there; where
            equations or constraints depend on the time.

        Notes
        -----
        With constraints, displacements ξ are along their free directions, and K is less the derivatives of the
        reactions Aᵀλ, which balance the forces. Nonholonomic ones hold displacements as well as velocities.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 6.1–6.3. Reactions: Ju. I. Neimark & N. A.
        Fufaev, *Dynamics of Nonholonomic Systems* (1972), chapter III.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.double_pendulum().linearize(at=[0.0, 0.0]).frequencies.round(6)
        array([2.397199, 5.787351])
        """
        of = self._by_velocities()
        if of is None:
            from visviva.generalized._motions_by_momenta import linearization_by_momenta

            return linearization_by_momenta(self, at)
        return linearization(of, at)

    def equilibria(self: Any, near: ArrayLike | None = None) -> list[Equilibrium]:
        """Places where the system stays, their stability and their frequencies.

        Each is told once: of places along a coordinate that nothing depends on, one. Of a curve of equilibria in
        others (the bottom of a Mexican hat) a dozen places stand for all, and ``continuum`` says that others go on.
        On constraints they are where reactions balance forces; with nonholonomic ones they fill surfaces, and without
        `near` one is told, next to the start.

        Units: those of the system.

        Parameters
        ----------
        near : array_like, shape (S, n), optional
            Where Newton's method starts. If not given, a grid over −π … π of some thousand places; for coordinates that
            are lengths also of other sizes, 1e-15 to 1e15, where a few starts find something. It may miss some. Where
            equilibria go on and on, as those of cos x (more than a hundred, or of more than four powers of ten), only
            those within −π … π are told, or up to four times the start.

        Returns
        -------
        list of Equilibrium
            In the order of their places; empty where none is found.

        Raises
        ------
        InvalidInput
            Where equations or constraints depend on the time; if the only ones are places where the mass matrix is
            singular, or constraints depend on each other.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 6.1–6.3.

        Examples
        --------
        >>> import visviva as vv
        >>> [e.stable for e in vv.systems.pendulum().equilibria()]
        [False, True, False]
        """
        return equilibria(self, near)

    def normal_modes(self: Any, near: ArrayLike | None = None) -> Linearization:
        """Normal modes about the equilibrium nearest to a place.

        Units: those of the system.

        Parameters
        ----------
        near : array_like, shape (n,), optional
            Where Newton's method starts; the start if not given, or rest at zero.

        Returns
        -------
        Linearization
            About the equilibrium that Newton's method comes to.

        Raises
        ------
        InvalidInput
            If it finds no equilibrium; where equations depend on the time.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 6.1–6.3.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.coupled_oscillators().normal_modes().frequencies.shape
        (2,)
        """
        place = (
            (self.position if self.position is not None else np.zeros(len(self.coordinates))) if near is None else near
        )
        of = self._by_velocities()
        if of is None:
            from visviva.generalized._motions_by_momenta import normal_modes_by_momenta

            return normal_modes_by_momenta(self, place)
        found = equilibria(of, place)
        if not found:
            raise InvalidInput("near", "Newton's method finds no equilibrium from there; start it elsewhere")
        return linearization(of, found[0].position)

    def period(self: Any, *, turn: float | None = None) -> float:
        """The period of a motion of one degree of freedom, by quadrature.

        Units: those of the time of the system.

        Parameters
        ----------
        turn : float, optional
            Of a motion that does not turn back: how far the coordinate goes in a period, as 2π.

        Returns
        -------
        float
            Positive, in the unit of time of the system.

        Raises
        ------
        InvalidInput
            For several coordinates, an equilibrium, a motion that does not turn back (with ``turn``: that does, or
            whose energy does not repeat after it), one on a separatrix, one that comes to a place where its force is
            infinite, or one followed along itself (see the notes) for more than 100000 steps.

        Notes
        -----
        By Gauss's quadrature of the slope of the energy, over panels in which bounds of all that the Lagrangian is made
        of let nothing narrow hide: a bump is seen however thin it is, and a kink (an absolute value) is integrated up
        to it. Where a steep wall leaves too little of the energy beside a kink for that, the motion is followed.
        Landau & Lifshitz, Mechanics, 3rd ed., (11.5).
        Of a Hamiltonian that is not quadratic in the momentum, or a Lagrangian that is not in the velocity, as a
        relativistic one, it is the time of return along the motion itself, to 1e-12 where the function is smooth.

        Examples
        --------
        >>> import math, visviva as vv
        >>> abs(vv.systems.oscillator(k=4.0, m=1.0, position=[1.0]).period() - math.pi) < 1e-14
        True
        """
        turn = self._checked_turn(turn)
        if self._source.kind == "hamiltonian":
            return period_of_hamiltonian(self, turn)
        if self._needs_return():
            return period_by_return(self, turn)
        return period_of_lagrangian(self, turn)

    def action_variable(self: Any, *, turn: float | None = None) -> float:
        """The action variable ∮ p dq / 2π of a motion of one degree of freedom.

        Units: those of an action, energy times time, in those of the system.

        Parameters
        ----------
        turn : float, optional
            As in `period`.

        Returns
        -------
        float
            Of a motion that turns back the area within its curve in phase space, over 2π.

        Raises
        ------
        InvalidInput
            As `period`.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 10.6.

        Examples
        --------
        >>> import visviva as vv
        >>> oscillator = vv.systems.oscillator(k=4.0, m=1.0, position=[1.0])
        >>> abs(oscillator.action_variable() - oscillator.energy / 2.0) < 1e-14
        True
        """
        turn = self._checked_turn(turn)
        if self._source.kind == "hamiltonian":
            return action_of_hamiltonian(self, turn)
        if self._needs_return():
            return action_by_return(self, turn)
        return action_of_lagrangian(self, turn)

    def _checked_turn(self: Any, turn: float | None) -> float | None:
        self._conserves()
        if turn is not None and not number("turn", turn):
            raise InvalidInput("turn", "expected how far the coordinate goes in a period, as 2π, got 0")
        return None if turn is None else number("turn", turn)

    def _needs_return(self: Any) -> bool:
        """Whether it is a Lagrangian of one coordinate that no quadrature of a slope knows."""
        return len(self.coordinates) == 1 and not self._structure["quadratic"] and not self._constraints()

    def _oscillation(self: Any, turn: float | None) -> tuple[float, float, float, float]:
        low, high, period, action = self._model.oscillation(self.t0, self._start(), self._values, turn)
        return low, high, period, action if turn is None else action + gauge_part(self, turn)

    def _by_velocities(self: Any) -> Any:
        """Give the Lagrangian, which small motions are those of; None where it is no expression."""
        if self._source.kind == "lagrangian":
            return self
        try:
            return self.lagrangian()
        except InvalidInput as error:
            if "quadratic" not in error.message:
                raise
            return None

    def _conserves(self: Any) -> None:
        if not self._structure["conserves_energy"]:
            function = "H" if self._source.kind == "hamiltonian" else "L"
            raise InvalidInput(
                function, "a period needs energy to be conserved: no time, no dissipation, no further forces"
            )
