"""Springs and dampers at points of rigid bodies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np

from visviva._body_force import BodyForce, Vector, body_of, not_negative, set_frozen, vector
from visviva._keywords import known_keywords
from visviva._moves import displacement, orthogonal
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["AttachedSpring"]


@known_keywords
@dataclass(frozen=True, slots=True, init=False)
class AttachedSpring(BodyForce):
    """A spring, and a damper beside it, from a point of a rigid body to another body, a particle or a place.

    With d from the other end to the point and its length ``|d|``, the force on the point is
    ``−(stiffness (|d| − length) + damping d|d|/dt) d/|d|``; the other end has the opposite one.

    Units: those of the scene; `stiffness` is mass / time², `damping` mass / time.

    Parameters
    ----------
    body : int or str
        The rigid body.
    point : array_like, shape (3,)
        Where in it the spring is attached: from the center of mass, along the body's axes.
    stiffness : float
        Force over extension, not negative.
    length : float, optional
        The length at rest, not negative. Where it is not 0, or there is damping, the ends must not coincide: the
        direction would not be known.
    damping : float, optional
        The force over the rate of the length, not negative.
    to : int or str, optional
        Another rigid body.
    to_point : array_like, shape (3,), optional
        Where in that, likewise; its center of mass if not given.
    particle : int or str, optional
        A particle of the scene.
    anchor : array_like, shape (3,), optional
        A place that is fixed in space. Exactly one of `to`, `particle` and `anchor` has to be given.

    Raises
    ------
    visviva.InvalidInput
        For a negative number, NaN or infinity, not exactly one other end, a `to_point` without `to`, or a spring
        between points of the same body.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.2 and § 1.5.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.AttachedSpring(0, [0.0, 0.0, 0.5], stiffness=4.0, length=1.0, anchor=[0.0, 0.0, 3.0]).anchor
    (0.0, 0.0, 3.0)
    """

    kind: ClassVar[str] = "attached_spring"
    _bodies = {"body": "bodies", "to": "bodies", "particle": "particles"}  # noqa: RUF012
    _dimensions = {  # noqa: RUF012
        "point": (1, 0, 0),
        "stiffness": (0, 1, -2),
        "length": (1, 0, 0),
        "damping": (0, 1, -1),
        "to_point": (1, 0, 0),
        "anchor": (1, 0, 0),
    }

    body: int | str
    point: Vector
    stiffness: float
    length: float
    damping: float
    to: int | str | None
    to_point: Vector
    particle: int | str | None
    anchor: Vector | None

    def __init__(
        self,
        body: int | str,
        point: ArrayLike,
        stiffness: float,
        length: float = 0.0,
        damping: float = 0.0,
        to: int | str | None = None,
        to_point: ArrayLike = (0.0, 0.0, 0.0),
        particle: int | str | None = None,
        anchor: ArrayLike | None = None,
    ) -> None:
        if body is None:
            raise InvalidInput("body", "expected the index or the name of a rigid body, got None")
        ends = [name for name, end in (("to", to), ("particle", particle), ("anchor", anchor)) if end is not None]
        if len(ends) != 1:
            raise InvalidInput("to", f"expected one of to, particle and anchor, got {' and '.join(ends) or 'none'}")
        set_frozen(
            self,
            body=body_of("body", body),
            point=vector("point", point),
            stiffness=not_negative("stiffness", stiffness),
            length=not_negative("length", length),
            damping=not_negative("damping", damping),
            to=body_of("to", to),
            to_point=vector("to_point", to_point),
            particle=body_of("particle", particle),
            anchor=None if anchor is None else vector("anchor", anchor),
        )
        if self.to is None and any(self.to_point):
            raise InvalidInput("to_point", f"expected none with {ends[0]}: it is a point of the rigid body to")
        if self.to == self.body:
            raise InvalidInput("to", f"expected another rigid body, got {self.to!r} at both ends")

    def shifted(self, position: ArrayLike, velocity: ArrayLike) -> Self:
        """The spring with its anchor displaced.

        Units: those of the scene.

        Parameters
        ----------
        position, velocity : array_like, shape (3,)
            By what is displaced, and boosted.

        Returns
        -------
        AttachedSpring

        Raises
        ------
        visviva.InvalidInput
            For what are not three numbers each; for a boost, if there is an anchor.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> spring = vv.AttachedSpring("door", [1.0, 0, 0], stiffness=2.0, anchor=[3.0, 0, 0])
        >>> spring.shifted(np.array([1.0, 0.0, 0.0]), np.zeros(3)).anchor
        (4.0, 0.0, 0.0)
        """
        moved_by, boost = displacement(position, velocity)
        if self.anchor is None:
            return self
        if boost.any():
            advice = "shift the position only, or let a heavy body be the anchor"
            raise InvalidInput(
                "velocity", f"AttachedSpring has a fixed anchor, which would move in the boosted frame; {advice}"
            )
        return self._with(anchor=np.add(self.anchor, moved_by))

    def rotated(self, rotation: ArrayLike) -> Self:
        """The spring with its anchor turned; of a mirrored body, points change sign.

        Units: the matrix is without dimension.

        Parameters
        ----------
        rotation : array_like, shape (3, 3)
            An orthogonal matrix; of determinant −1 a reflection.

        Returns
        -------
        AttachedSpring

        Raises
        ------
        visviva.InvalidInput
            For a matrix that is not orthogonal.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> spring = vv.AttachedSpring("door", [1.0, 0, 0], stiffness=2.0, anchor=[3.0, 0, 0])
        >>> spring.rotated(np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])).anchor
        (0.0, 3.0, 0.0)
        """
        matrix = orthogonal(rotation)
        anchor = None if self.anchor is None else matrix @ np.array(self.anchor)
        sign = np.sign(np.linalg.det(matrix))
        return self._with(anchor=anchor, point=np.multiply(sign, self.point), to_point=np.multiply(sign, self.to_point))

    def reversed(self) -> Self:
        """The same, without damping.

        Returns
        -------
        AttachedSpring
            The same object: a spring alone pushes alike in both directions of time.

        Raises
        ------
        visviva.InvalidInput
            If there is damping.

        Examples
        --------
        >>> import visviva as vv
        >>> spring = vv.AttachedSpring("door", [1.0, 0, 0], stiffness=2.0, anchor=[3.0, 0, 0])
        >>> spring.reversed() == spring
        True
        """
        if self.damping:
            raise InvalidInput("forces", "AttachedSpring cannot be reversed: damping takes energy away")
        return self


def __dir__() -> list[str]:
    return list(__all__)
