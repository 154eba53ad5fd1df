"""What a Lagrangian says of whole paths: `Variations`, the part of `Lagrangian` that is about the action."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from visviva._keywords import known_keywords

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._accessory import AccessoryProblem
    from visviva.generalized._action import PathIntegral
    from visviva.generalized._discrete import DiscreteAction
    from visviva.typing import DiscreteMethodName, GeneralizedPath

    Variation: TypeAlias = ArrayLike | Callable[[NDArray[np.float64]], ArrayLike]

__all__ = ["Variations"]


@known_keywords
class Variations:
    """Base of `Lagrangian`: the action along a path and its variations."""

    __slots__ = ()

    def action(self: Any, path: GeneralizedPath, *, degree: int = 5) -> PathIntegral:
        """The action S = ∫ L dt along a path, from its first time to its last.

        Along a run backward in time it has the other sign: dt < 0 there, as in the principal function S(q₁, t₁; q₀, t₀)
        with dS = p₁ dq₁ − p₀ dq₀ − E₁ dt₁ + E₀ dt₀, for t₁ before t₀ too. So have the variations.

        Units: those of an action in the system, energy times time.

        Parameters
        ----------
        path : GeneralizedTrajectory or (array_like, array_like)
            A run of a Lagrangian, whose places, velocities and accelerations are joined by polynomials of degree five;
            or times, shape (T,), and places, shape (T, n) (of one coordinate (T,), too).
        degree : int
            Of the polynomials through places, each through the nearest ones, where no run tells velocities. 1 joins
            them by straight lines.

        Returns
        -------
        PathIntegral
            Its value, and how far it may be off.

        Raises
        ------
        InvalidInput
            For a path that is none, or that meets a singularity of L.
        ConvergenceError
            If finer and finer sums do not settle.

        References
        ----------
        L. D. Landau & E. M. Lifshitz, *Mechanics*, 3rd ed., (2.1).

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> oscillator = vv.systems.oscillator(k=1.0, m=1.0, position=[0.0], velocity=[1.0])
        >>> S = oscillator.action(oscillator.run(t=np.linspace(0.0, 1.0, 11)))
        >>> bool(abs(S.value - np.sin(2.0) / 4.0) < 1e-14)
        True
        """
        from visviva.generalized._action import action

        return action(self, path, degree)

    def first_variation(
        self: Any,
        path: GeneralizedPath,
        variation: Variation,
        *,
        degree: int = 5,
    ) -> PathIntegral:
        """What the action changes by to first order, δS[η] = ∫ (∂L/∂q η + ∂L/∂q̇ η̇) dt.

        It is p η at the last time less that at the first for a motion without further forces and constraints: 0 where η
        vanishes there (Hamilton's principle). Where they are, it is less their work along η.

        Units: those of an action in the system, with η in those of the coordinates.

        Parameters
        ----------
        path, degree
            As in `action`.
        variation : callable or array_like, shape (T, n)
            η, as a smooth function of times, shape (M,), with values of shape (M, n), or its values at the times of the
            path; of one coordinate (M,) and (T,), too.

        Returns
        -------
        PathIntegral

        Raises
        ------
        InvalidInput
            As `action`; for a variation of another shape.
        ConvergenceError
            If finer and finer sums do not settle.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> swing = vv.systems.pendulum(position=[3.0]).run(t=np.linspace(0.0, 1.0, 101))
        >>> abs(float(swing.system.first_variation(swing, lambda t: np.sin(np.pi * t)))) < 1e-9
        True
        """
        from visviva.generalized._action import first_variation

        return first_variation(self, path, variation, degree)

    def second_variation(
        self: Any,
        path: GeneralizedPath,
        variation: Variation,
        *,
        degree: int = 5,
    ) -> PathIntegral:
        """What the action changes by to second order: δ²S[η] = d²/dε² S[q + ε η] at ε = 0.

        Units: as of `first_variation`.

        Parameters
        ----------
        path, variation, degree
            As in `first_variation`.

        Returns
        -------
        PathIntegral

        Raises
        ------
        InvalidInput, ConvergenceError
            As `first_variation`.

        References
        ----------
        I. M. Gelfand & S. V. Fomin, *Calculus of Variations* (1963), section 24.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> rest = vv.systems.oscillator(k=4.0, m=1.0)
        >>> path = np.linspace(0.0, 2.0, 21), np.zeros(21)
        >>> round(float(rest.second_variation(path, lambda t: np.sin(np.pi * t / 2.0))), 12)
        -1.532598899728
        """
        from visviva.generalized._action import second_variation

        return second_variation(self, path, variation, degree)

    def discrete_action(
        self: Any, path: GeneralizedPath, *, method: DiscreteMethodName | None = None
    ) -> DiscreteAction:
        """The action of a path of places, segment by segment, as a variational integrator sums it, and its derivatives.

        Units: those of an action in the system, energy times time.

        Parameters
        ----------
        path : GeneralizedTrajectory or (array_like, array_like)
            A run whose output times are its steps; or times, shape (T,), and places, shape (T, n) (of one coordinate
            (T,), too).
        method : str, optional
            A variational integrator; that of the run, or ``variational_midpoint``, if not given.

        Returns
        -------
        DiscreteAction
            The action, and what the discrete Euler–Lagrange equations leave at the inner places.

        Raises
        ------
        InvalidInput
            For a path or a method that is none, or constraints.
        ConvergenceError
            For segments whose inner points are not found.

        References
        ----------
        J. E. Marsden & M. West, Acta Numerica 10 (2001) 357, section 1.3 and, with forces, part 3.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> steps = np.linspace(0.0, 1.0, 21)
        >>> swing = vv.systems.pendulum(position=[3.0]).run(steps, method="variational_midpoint", dt=0.05)
        >>> bool(swing.system.discrete_action(swing).relative_residual.max() < 1e-14)
        True
        """
        from visviva.generalized._discrete import discrete_action

        return discrete_action(self, path, method)

    def accessory_problem(self: Any, path: GeneralizedPath, *, degree: int = 5) -> AccessoryProblem:
        """Whether the action is least along a path among its neighbors between the same ends, or only stationary.

        Parameters
        ----------
        path, degree
            As in `action`. Between rows of a run that are far apart it is followed as the equations of motion lead on;
            places are to be at times that are close enough to tell the shape of their path.

        Returns
        -------
        AccessoryProblem
            The smallest eigenvalue of the second variation, and the points conjugate to the first.

        Raises
        ------
        InvalidInput
            As `action`; with constraints, or where ∂²L/∂q̇∂q̇ is not positive.
        ConvergenceError
            For a path that is too long for its fastest motion.

        References
        ----------
        I. M. Gelfand & S. V. Fomin, *Calculus of Variations* (1963), sections 26 to 29.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> rest = vv.systems.oscillator(k=4.0, m=1.0)
        >>> [rest.accessory_problem(([0.0, T], [0.0, 0.0])).minimum for T in (1.5, 1.6)]  # π/2 lies between
        [True, False]
        """
        from visviva.generalized._accessory import accessory_problem

        return accessory_problem(self, path, degree)
