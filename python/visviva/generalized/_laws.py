"""What a Lagrangian says of its symmetries and reactions: `Laws`, a part of `Lagrangian`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from visviva._keywords import known_keywords

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import numpy as np
    import sympy
    from numpy.typing import NDArray

    from visviva.generalized._noether import NoetherSymmetry
    from visviva.generalized._trajectory import GeneralizedTrajectory
    from visviva.typing import Formula, SymbolicExpression

    Generator: TypeAlias = (
        Sequence[SymbolicExpression]
        | Mapping[str, Formula]
        | Mapping[sympy.Expr, Formula]
        | Callable[..., Sequence[SymbolicExpression]]
    )

__all__ = ["Laws"]


@known_keywords
class Laws:
    """Base of `Lagrangian`: symmetries and what they conserve, and d'Alembert's principle."""

    __slots__ = ()

    def noether(
        self: Any,
        generator: Generator,
        *,
        time_shift: Formula = 0,
        gauge: Formula | None = None,
    ) -> NoetherSymmetry:
        """Whether q → q + ε ξ(q, t), t → t + ε τ(q, t) is a symmetry, and the momentum that it conserves.

        It is one if L dt changes by the differential of a function F(q, t), further forces do no work along it, and it
        leads along the constraints.

        Parameters
        ----------
        generator : sequence, dict or callable
            ξ: an expression for each coordinate (by coordinate, the others 0), or a function
            ``(q, v, t, **parameters)`` that gives all of them.
        time_shift : sympy.Expr, callable or float
            τ.
        gauge : sympy.Expr or callable, optional
            F, where it is known; else it is found by quadrature, and 0 at the start.

        Returns
        -------
        NoetherSymmetry

        Raises
        ------
        InvalidInput
            For expressions that the core does not know, or that depend on velocities.

        References
        ----------
        E. Noether, Nachr. Ges. Wiss. Göttingen (1918) 235; H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*,
        3rd ed., section 13.7.

        Examples
        --------
        Two bodies that push each other, seen from a moving frame: the center of mass goes on evenly.

        >>> import numpy as np, visviva as vv
        >>> def L(q, v, t):
        ...     return v[0] ** 2 + v[1] ** 2 / 2 - (q[0] - q[1]) ** 2
        >>> pair = vv.Lagrangian(L, ["a", "b"], position=[0.0, 1.0], velocity=[1.0, -0.5])
        >>> boost = pair.noether(lambda q, v, t: [t, t])
        >>> boost.holds, bool(np.ptp(boost.conserved(pair.run(t=np.linspace(0.0, 9.0, 10)))) < 1e-13)
        (True, True)
        """
        from visviva.generalized._noether import noether

        return noether(self, generator, time_shift, gauge)

    def dalembert(self: Any, trajectory: GeneralizedTrajectory) -> NDArray[np.float64]:
        """How far d'Alembert's principle fails along a run: the virtual work of the reactions.

        The reactions are d/dt ∂L/∂q̇ − ∂L/∂q − Q; displacements δq of length 1 with ∂g/∂q δq = 0 (and a δq = 0 of
        nonholonomic constraints) are virtual. Without constraints every displacement is, and there are no reactions.

        Units: none: what is told is relative, without dimension.

        Parameters
        ----------
        trajectory : GeneralizedTrajectory
            A run of this Lagrangian.

        Returns
        -------
        ndarray, shape (T,)
            The largest virtual work at each time, relative to what it is made of: round-off.

        Raises
        ------
        InvalidInput
            For a run of something else.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., section 1.4.

        Examples
        --------
        >>> import visviva as vv
        >>> machine = vv.systems.atwood()
        >>> bool(machine.dalembert(machine.run(t=0.3)).max() < 1e-15)
        True
        """
        from visviva.generalized._dalembert import dalembert

        return dalembert(self, trajectory)
