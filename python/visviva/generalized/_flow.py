"""What a system does with its flow: sections, derivatives, exponents, motions through two places."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

from visviva._arrays import number, whole_number
from visviva._event import checked_direction
from visviva._keywords import known_keywords
from visviva.errors import ConvergenceError, Interrupted, InvalidInput

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._legendre import LegendreTransform
    from visviva.generalized._nodes import Node
    from visviva.generalized._section import PoincareSection
    from visviva.integrators import Method
    from visviva.typing import EventDirection, Formula, GeneralizedMethodName

__all__ = ["Flow"]


@known_keywords
class Flow:
    """Base of `GeneralizedSystem`: the methods that ask for more than a run."""

    __slots__ = ()

    def poincare(
        self: Any,
        section: str | Formula,
        t: float,
        *,
        direction: EventDirection = 1,
        method: GeneralizedMethodName | Method = "auto",
        rtol: float = 1e-12,
        dt: float | None = None,
    ) -> PoincareSection:
        """Where the motion passes through a section, to round-off; also where it does so twice within one step.

        Units: those of the system.

        Parameters
        ----------
        section : str, sympy.Expr or callable
            A coordinate that passes 0, or an expression of the state and time that does.
        t : float
            The end.
        direction : {1, -1, 0}
            Upwards in time (also in a run backwards), downwards, or both.
        method, rtol, dt
            As in `run`.

        Returns
        -------
        PoincareSection

        Raises
        ------
        InvalidInput
            For what cannot be run.
        ConvergenceError
            At a singularity.

        References
        ----------
        M. Hénon, Physica D 5 (1982) 412: points on the section itself, not interpolated.

        Examples
        --------
        >>> import visviva as vv
        >>> points = vv.systems.henon_heiles().poincare("x", t=200.0)
        >>> bool(abs(points.position[:, 0]).max() < 1e-13)
        True
        """
        from visviva.generalized._section import PoincareSection

        way = checked_direction(direction)
        if isinstance(section, str):
            if section not in self.coordinates:
                raise InvalidInput("section", f"there is no coordinate {section!r}; there are {list(self.coordinates)}")
            nodes: list[Node] = [("variable", [], float(self.coordinates.index(section)))]
            root = 0
        else:
            nodes, roots = self._source.nodes("section", [section])
            root = roots[0]
            if nodes[root][0] == "constant":
                raise InvalidInput("section", f"expected a function of the state, got {section!r}, which is one number")
        asked, _ = self._asked(number("t", t), method, rtol, dt, None)
        passed = {"nodes": nodes, "root": root, "energy": None, "function": None}
        asked["events"] = [passed | {"direction": float(way), "last": None}]
        self._check_start()
        result = self._run(asked, self._start()[None, :], self._values[None, :], 1, progress=False)
        times, states = result["found_t"], result["found_y"]
        if result["failures"][0] is not None:
            raise ConvergenceError(result["failures"][0], result["reached"][0])
        n = len(self.coordinates)
        momentum = states[:, n:]
        if self._source.kind == "lagrangian" and len(times):
            momentum = self._model.columns(times, states, self._values[None, :])[:, :n]
        found = PoincareSection(times, states[:, :n], momentum, self.coordinates)
        if result["interrupted"]:
            raise Interrupted("the section was interrupted", result=found)
        return found

    def plot_phase_portrait(
        self: Any,
        position: tuple[float, float],
        momentum: tuple[float, float],
        *,
        points: int = 300,
        ax: Axes | None = None,
    ) -> Axes:
        """Draw the lines of constant energy of a system of one degree of freedom that conserves it.

        Lines through unstable equilibria, the separatrices, are drawn stronger; stable equilibria are dots.

        Units: those of the system.

        Parameters
        ----------
        position, momentum : (float, float)
            What is shown of either; of a Lagrangian ``momentum`` is that of the velocity.
        points : int
            Points of the grid along each side.
        ax : matplotlib.axes.Axes, optional
            Where; a new one if not given.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        InvalidInput
            For several coordinates (`Lagrangian.routhian` takes away cyclic ones), an energy that is not conserved,
            ends that are not in order, or if matplotlib is not installed.

        References
        ----------
        L. D. Landau & E. M. Lifshitz, *Mechanics*, 3rd ed., § 11; H. Goldstein, C. Poole & J. Safko, *Classical
        Mechanics*, 3rd ed., § 8.1.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.pendulum().plot_phase_portrait((-6.0, 6.0), (-8.0, 8.0)).get_xlabel()
        'theta'
        """
        from visviva.generalized._portrait import plot_phase_portrait

        return plot_phase_portrait(self, position, momentum, whole_number("points", points, low=8), ax)

    #: The name that it had first.
    phase_portrait = plot_phase_portrait

    def plot_effective_potential(
        self: Any, position: tuple[float, float], *, points: int = 600, ax: Axes | None = None
    ) -> Axes:
        """Draw the potential in which the one coordinate of a system moves, and the energy of the start.

        It is the energy at rest (Jacobi's integral at a velocity of 0, or H where the velocity is 0): V(q) of a
        particle on a line, with the centrifugal term of what `Lagrangian.routhian` has reduced. The motion goes where
        the line of the energy is above it, and turns at the dots.

        Units: those of the system.

        Parameters
        ----------
        position : (float, float)
            What is shown of the coordinate, the smaller end first.
        points : int
            Places at which the potential is computed.
        ax : matplotlib.axes.Axes, optional
            Where; a new one if not given.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        InvalidInput
            For several coordinates (`Lagrangian.routhian` takes away cyclic ones), an energy that is not conserved, a
            Hamiltonian that is not quadratic in the momentum, ends that are not in order, places at none of which there
            is a potential, or if matplotlib is not installed.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 3.3 and § 8.3; L. D. Landau & E. M.
        Lifshitz, *Mechanics*, 3rd ed., § 11.

        Examples
        --------
        >>> import visviva as vv
        >>> nods = vv.systems.spherical_pendulum(position=[1.0, 0.0], velocity=[0.0, 2.0]).routhian()
        >>> nods.plot_effective_potential((0.1, 3.0)).get_xlabel()
        'theta'
        """
        from visviva.generalized._portrait import plot_effective_potential

        return plot_effective_potential(self, position, whole_number("points", points, low=8), ax)

    def flow_jacobian(self: Any, t: float, *, rtol: float = 1e-12) -> NDArray[np.float64]:
        """Derivatives of the state at a time with respect to the state at the start, by the variational equations.

        Units: those of the system, a row those of a number of the state over those of each.

        Parameters
        ----------
        t : float
            The time.
        rtol : float
            As in `run`.

        Returns
        -------
        ndarray, shape (2n, 2n)
            Of a Hamiltonian it is symplectic; its determinant is 1 (Liouville). With constraints it is that of starts
            on them: of rank 2d for d degrees of freedom, and 0 for places, and for velocities, that are across them at
            the start.

        Raises
        ------
        InvalidInput
            With more than 16 coordinates, where the variational equations are made of very many operations; for
            absolute values.
        ConvergenceError
            At a singularity.

        References
        ----------
        E. Hairer, S. P. Nørsett & G. Wanner, *Solving Ordinary Differential Equations I*, 2nd ed., section I.14.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> flow = vv.systems.henon_heiles().flow_jacobian(10.0)
        >>> bool(abs(np.linalg.det(flow) - 1.0) < 1e-12)
        True
        """
        from visviva.generalized._neighbors import flow_jacobian

        return flow_jacobian(self, number("t", t), rtol=rtol)[1]

    def lyapunov_exponents(
        self: Any, t: float, *, interval: float | None = None, rtol: float = 1e-12
    ) -> NDArray[np.float64]:
        """Lyapunov's exponents over a time, the largest first.

        Units: one over the time of the system, in its units.

        Parameters
        ----------
        t : float
            The end.
        interval : float, optional
            The longest time after which small differences are made orthonormal again, by default about a thirtieth of
            the whole; sooner where they grow apart.
        rtol : float
            As in `run`.

        Returns
        -------
        ndarray, shape (2n,)
            With constraints as many as a state on them has free numbers: 2n less two for each holonomic one, and one
            for each nonholonomic one.

        Raises
        ------
        InvalidInput
            As `flow_jacobian`.

        Notes
        -----
        Lengths of small differences are √Σδ² of the numbers of the state as they are: places and velocities (momenta of
        a Hamiltonian), in their units, whatever the mass matrix; where these are so unlike that rates depend on each
        other by factors beyond 2¹⁰, in multiples of them by powers of 2²⁰. Another norm, other units, or momenta for
        velocities change an exponent over a time T by at most the logarithm of the ratios of the norms at both ends
        over T: not what it tends to while the motion keeps to where those are bounded. Exponents of a Hamiltonian
        without further forces add up to 0; those of a Lagrangian to ln(det M(start) / det M(end)) / T of the mass
        matrix M, which tends to it.

        References
        ----------
        G. Benettin, L. Galgani, A. Giorgilli & J.-M. Strelcyn, Meccanica 15 (1980) 9.

        Examples
        --------
        >>> import visviva as vv
        >>> exponents = vv.systems.henon_heiles().lyapunov_exponents(50.0)
        >>> bool(abs(exponents.sum()) < 1e-12)
        True
        """
        from visviva.generalized._neighbors import lyapunov_exponents

        interval, t = None if interval is None else number("interval", interval), number("t", t)
        if interval is not None and interval <= 0.0:
            raise InvalidInput("interval", f"expected a positive number, got {interval!r}")
        if t == self.t0:
            raise InvalidInput("t", f"expected another time than the start, {self.t0:g}")
        return lyapunov_exponents(self, t, interval=interval, rtol=rtol)

    def boundary_value(self, t: float, position: ArrayLike, *, rtol: float = 1e-12) -> Self:
        """The system with the velocities (or momenta) at the start that lead to a place at a time.

        There may be several: a pendulum may swing or turn over first, a planet go round once or often. What is given is
        the motion that Newton's method, its steps halved until they lead nearer, comes to from the present velocity.
        Where it comes to none, the place of arrival is moved from where the present motion goes, and the motion
        followed to the first that arrives; and if that leads nowhere, a straight line in a short time is, as the time
        grows. Start with another velocity for another motion. At a conjugate point, as of an oscillator after half a
        period, all motions meet, and to other places there are none.

        Units: those of the system.

        Parameters
        ----------
        t : float
            The time of arrival.
        position : array_like, shape (n,)
            The place.
        rtol : float
            As in `run`.

        Returns
        -------
        Lagrangian or Hamiltonian
            What `self` is, with another velocity or momentum at the start.

        Raises
        ------
        InvalidInput
            For constraints, absolute values, variational equations of very many operations (of more than 16
            coordinates), or the time of the start.
        ConvergenceError
            If no such motion is found; its message tells how near the nearest came, and whether the places are
            conjugate to each other.

        References
        ----------
        Shooting: W. H. Press, S. A. Teukolsky, W. T. Vetterling & B. P. Flannery, *Numerical Recipes*, 3rd ed. (2007),
        § 18.1. Continuation by the length of arc: E. L. Allgower & K. Georg, *Numerical Continuation Methods* (1990),
        chapter 6.

        Examples
        --------
        >>> import visviva as vv
        >>> thrown = vv.systems.pendulum(position=[0.0], velocity=[1.0]).boundary_value(0.5, [0.4])
        >>> thrown.run(0.5).position[-1].round(12)
        array([0.4])
        """
        from visviva.generalized._boundary import boundary_value

        system: Any = self
        found: Any = boundary_value(system, number("t", t), position, rtol=rtol)
        same: Self = found
        return same

    def legendre_transform(self: Any) -> LegendreTransform:
        """The Hamiltonian of any Lagrangian that is convex in the velocities, or the reverse, evaluated by numbers.

        Where the function is quadratic, `Lagrangian.hamiltonian` and `Hamiltonian.lagrangian` give it as an expression.

        Returns
        -------
        LegendreTransform
            To be called with places and momenta (or velocities).

        Examples
        --------
        >>> import visviva as vv
        >>> quartic = vv.Lagrangian(lambda q, v, t: v[0] ** 4 / 4, ["x"])
        >>> quartic.legendre_transform()([0.0], [8.0]).round(12)
        np.float64(12.0)
        """
        from visviva.generalized._legendre import LegendreTransform

        return LegendreTransform(self)
