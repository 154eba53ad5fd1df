"""Euler angles in the 24 conventions, and their rates."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Literal

from visviva import _core
from visviva._keywords import known_keywords, one_of
from visviva.errors import InvalidInput
from visviva.rigid._arguments import map_rows

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from visviva.typing import EulerConvention


@known_keywords
def euler_angles(quaternion: ArrayLike, convention: EulerConvention = "ZXZ") -> NDArray[np.float64]:
    """Give the Euler angles of rotations.

    Units: angles in radians; quaternions are without dimension.

    Parameters
    ----------
    quaternion : array_like, shape (…, 4)
        (x, y, z, w).
    convention : str
        The axes of the three turns, in order: capitals (``"ZXZ"``) for axes that move with the body, small letters
        (``"zxz"``) for axes that stay.

    Returns
    -------
    ndarray, shape (…, 3)
        The outer angles in (−π, π]; the middle one in [0, π], or in [−π/2, π/2] where the three axes differ. At a
        pole, where only the sum or the difference of the outer ones means something, the last is 0. Everywhere they
        give the rotation back to 4 ε.

    Raises
    ------
    InvalidInput
        For an unknown convention, or a quaternion whose length is not 1 within 1e-6.

    Notes
    -----
    Bernardes & Viollet, PLoS ONE 17 (2022) e0276302.

    Examples
    --------
    >>> import visviva as vv
    >>> q = vv.rigid.quaternion_from_euler([0.7, 1.1, -0.4])
    >>> vv.rigid.euler_angles(q).round(12)
    array([ 0.7,  1.1, -0.4])
    >>> vv.rigid.euler_angles(vv.rigid.quaternion_from_euler([0.7, 0.0, -0.4])).round(12)
    array([0.3, 0. , 0. ])
    """
    function = partial(_core.rotation_euler, _name(convention), to_angles=True)
    return map_rows(function, (3,), ("quaternion", quaternion, (4,)))


@known_keywords
def quaternion_from_euler(angles: ArrayLike, convention: EulerConvention = "ZXZ") -> NDArray[np.float64]:
    """Give the quaternions of Euler angles.

    Units: angles in radians; quaternions are without dimension.

    Parameters
    ----------
    angles : array_like, shape (…, 3)
        The three angles in the order of the convention.
    convention : str
        As in `euler_angles`.

    Returns
    -------
    ndarray, shape (…, 4)
        (x, y, z, w).

    Raises
    ------
    InvalidInput
        For an unknown convention.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 4.5 (the parameters of Euler).

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.quaternion_from_euler([0.7, 1.1, -0.4])
    array([0.44560368, 0.27320194, 0.12739967, 0.84295159])
    """
    function = partial(_core.rotation_euler, _name(convention), to_angles=False)
    return map_rows(function, (4,), ("angles", angles, (3,)))


@known_keywords
def angular_velocity_from_euler(
    angles: ArrayLike,
    rates: ArrayLike,
    *,
    frame: Literal["body", "space"] = "body",
    convention: EulerConvention = "ZXZ",
) -> NDArray[np.float64]:
    """Give the angular velocity of Euler angles that change at such rates.

    Units: angles in radians, rates in radians per time.

    Parameters
    ----------
    angles, rates : array_like, shape (…, 3)
        The three angles and their rates, in the order of the convention.
    frame : {"body", "space"}
        Along whose axes.
    convention : str
        As in `euler_angles`.

    Returns
    -------
    ndarray, shape (…, 3)
        The angular velocity.

    Raises
    ------
    InvalidInput
        For an unknown convention or frame, or axes that do not broadcast.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 4.9; Landau & Lifshitz, *Mechanics*, 3rd ed., § 35.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.angular_velocity_from_euler([0.7, 1.1, -0.4], [0.3, -0.2, 1.5])
    array([-0.28832795,  0.16837323,  1.63607884])
    """
    function = partial(_core.rotation_rates, _name(convention), in_body=_in_body(frame), to_rates=False)
    return map_rows(function, (3,), ("angles", angles, (3,)), ("rates", rates, (3,)))


@known_keywords
def euler_rates(
    angles: ArrayLike,
    angular_velocity: ArrayLike,
    *,
    frame: Literal["body", "space"] = "body",
    convention: EulerConvention = "ZXZ",
) -> NDArray[np.float64]:
    """Give the rates of Euler angles under an angular velocity.

    Units: angles in radians, rates in radians per time.

    Parameters
    ----------
    angles, angular_velocity : array_like, shape (…, 3)
        The three angles, in the order of the convention, and the angular velocity.
    frame : {"body", "space"}
        Along whose axes the angular velocity is given.
    convention : str
        As in `euler_angles`.

    Returns
    -------
    ndarray, shape (…, 3)
        The rates; large near a pole, as they are.

    Raises
    ------
    InvalidInput
        At a pole, where the rates of the outer angles cannot be told apart; else as `angular_velocity_from_euler`.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 4.9; Landau & Lifshitz, *Mechanics*, 3rd ed., § 35.

    Examples
    --------
    >>> import visviva as vv
    >>> omega = vv.rigid.angular_velocity_from_euler([0.7, 1.1, -0.4], [0.3, -0.2, 1.5])
    >>> vv.rigid.euler_rates([0.7, 1.1, -0.4], omega).round(12)
    array([ 0.3, -0.2,  1.5])
    """
    function = partial(_core.rotation_rates, _name(convention), in_body=_in_body(frame), to_rates=True)
    return map_rows(function, (3,), ("angles", angles, (3,)), ("angular_velocity", angular_velocity, (3,)))


def _name(convention: object) -> str:
    if not isinstance(convention, str):
        raise InvalidInput("convention", f"expected three letters such as 'ZXZ', got {convention!r}")
    return convention.encode(errors="replace").decode()


def _in_body(frame: object) -> bool:
    return one_of("frame", frame, ("body", "space")) == "body"
