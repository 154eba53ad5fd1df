"""Particles in fields: central ones, electric and magnetic ones, and that of Hénon and Heiles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from visviva._arrays import float_array
from visviva._keywords import check_call, known_keywords
from visviva.errors import InvalidInput
from visviva.generalized import Hamiltonian, Lagrangian
from visviva.generalized._points import with_points
from visviva.systems import _points
from visviva.systems._values import checked

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from visviva.typing import SymbolicExpression

__all__ = ["central_force", "charged_particle", "henon_heiles"]


@known_keywords
def charged_particle(
    *,
    m: float = 1.0,
    charge: float = 1.0,
    E: ArrayLike = (0.5, 0.0, 0.0),
    B: ArrayLike = (0.0, 0.0, 1.0),
    position: ArrayLike = (0.0, 0.0, 0.0),
    velocity: ArrayLike = (1.0, 0.0, 0.0),
) -> Lagrangian:
    """Charge in constant fields: L = m ṙ²/2 + e E·r + e ṙ·A with A = B × r/2.

    It circles at e B/m and drifts with E × B/B². Momenta are m ṙ + e A. The fields are six parameters,
    ``Ex`` to ``Bz``.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    m, charge : float
        Mass m and charge e.
    E, B : array_like, shape (3,)
        Electric and magnetic field.
    position, velocity : array_like, shape (3,)
        Cartesian coordinates, and their rates.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass that is not positive.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., (1.63).

    Examples
    --------
    Carried along by the drift after each turn:

    >>> import numpy as np, visviva as vv
    >>> out = vv.systems.charged_particle().run(t=2 * np.pi)
    >>> (out.position[-1] / np.pi).round(12) + 0.0
    array([ 0., -1.,  0.])
    """
    electric, magnetic = float_array("E", E, (3,)), float_array("B", B, (3,))

    def function(q: Any, v: Any, _: Any, m: Any, charge: Any, **fields: Any) -> Any:
        Ex, Ey, Ez, Bx, By, Bz = fields.values()
        # ṙ·(B × r) = B·(r × ṙ)
        turning = Bx * (q[1] * v[2] - q[2] * v[1]) + By * (q[2] * v[0] - q[0] * v[2]) + Bz * (q[0] * v[1] - q[1] * v[0])
        kinetic = m * (v[0] ** 2 + v[1] ** 2 + v[2] ** 2) / 2
        return kinetic + charge * (Ex * q[0] + Ey * q[1] + Ez * q[2]) + charge * turning / 2

    names = ("Ex", "Ey", "Ez", "Bx", "By", "Bz")
    values = checked(m=m, charge=charge) | dict(zip(names, [*electric.tolist(), *magnetic.tolist()], strict=True))
    return with_points(
        Lagrangian(function, ["x", "y", "z"], parameters=values, position=position, velocity=velocity),
        _points.cartesian,
    )


@known_keywords
def central_force(
    potential: Callable[..., SymbolicExpression] | None = None,
    *,
    m: float = 1.0,
    parameters: Mapping[str, float] | None = None,
    position: ArrayLike = (1.0, 0.0),
    velocity: ArrayLike = (0.0, 1.2),
) -> Lagrangian:
    """Motion in the plane under a central force: L = m (ṙ² + r² φ̇²)/2 − V(r).

    The momentum of φ is conserved.

    Units: those of the caller, one consistent system; angles in radians.

    Parameters
    ----------
    potential : callable, optional
        ``V(r, **parameters)``, of arithmetic and NumPy's functions; −k/r with k = 1 if not given.
    m : float
        Mass.
    parameters : dict of str to float, optional
        Parameters of the potential.
    position, velocity : array_like, shape (2,)
        Polar coordinates r and φ, and their rates.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass that is not positive.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., (3.6).

    Examples
    --------
    In −k/r orbits are closed, in other potentials hardly ever:

    >>> import numpy as np, visviva as vv
    >>> a = 1 / (2 - 1.2**2)
    >>> kepler = vv.systems.central_force()
    >>> bool(abs(kepler.run(t=2 * np.pi * a**1.5).position[-1] - [1.0, 2 * np.pi]).max() < 1e-11)
    True
    >>> harder = vv.systems.central_force(lambda r, k, b: -k / r + b / r**3, parameters={"k": 1.0, "b": 0.01})
    >>> harder.cyclic
    ['phi']
    """
    if parameters is not None and not isinstance(parameters, Mapping):
        raise InvalidInput("parameters", f"expected values by name, got {type(parameters).__name__}")
    if potential is None:
        potential, parameters = _kepler, {"k": 1.0, **(parameters or {})}
    if not callable(potential):
        raise InvalidInput("potential", f"expected a function of r, got {type(potential).__name__}")
    if parameters is not None and "m" in parameters:
        raise InvalidInput("parameters", "m is the mass; give it as m, and the potential another name for its own")
    check_call("potential", potential, ["r"], parameters or {})
    energy = potential

    def function(q: Any, v: Any, _: Any, m: Any, **others: Any) -> Any:
        return m * (v[0] ** 2 + q[0] ** 2 * v[1] ** 2) / 2 - energy(q[0], **others)

    values = checked(m=m) | dict(parameters or {})
    return with_points(
        Lagrangian(function, ["r", "phi"], parameters=values, position=position, velocity=velocity), _points.polar
    )


def _kepler(r: Any, k: Any) -> Any:
    return -k / r


@known_keywords
def henon_heiles(
    *,
    position: ArrayLike = (0.1, 0.0),
    momentum: ArrayLike = (0.0, 0.5),
) -> Hamiltonian:
    """System of Hénon and Heiles: H = (p_x² + p_y²)/2 + (x² + y²)/2 + x² y − y³/3.

    Bound below H = 1/6, where most of its motions are chaotic; regular below about 1/12.

    Units: none: it is written without dimension.

    Parameters
    ----------
    position, momentum : array_like, shape (2,)
        x and y, and their momenta.

    Returns
    -------
    Hamiltonian
        Of the coordinates x and y.

    Raises
    ------
    InvalidInput
        For positions or momenta of another shape, NaN or infinity.

    References
    ----------
    M. Hénon & C. Heiles, Astron. J. **69**, 73 (1964).

    Examples
    --------
    >>> import visviva as vv
    >>> vv.systems.henon_heiles().run(t=100.0).position[-1].round(12)
    array([-0.04019424,  0.67901692])
    """
    return with_points(
        Hamiltonian(
            lambda q, p, _: (
                (p[0] ** 2 + p[1] ** 2) / 2 + (q[0] ** 2 + q[1] ** 2) / 2 + q[0] ** 2 * q[1] - q[1] ** 3 / 3
            ),
            ["x", "y"],
            position=position,
            momentum=momentum,
        ),
        _points.cartesian,
    )
