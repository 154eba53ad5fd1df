"""The rigid bodies of a scene: masses, moments, states and fixed points, checked once and never changed.

The one idea: the body frame is the caller's own. What the core works in, the principal axes about the center of mass or
about the fixed point, is found here once and kept beside what was given.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import float_array, mass_array, read_only
from visviva._attributes_elsewhere import OF_BODIES, no_attribute
from visviva._html import Sheet, Shown, first_rows
from visviva._keywords import known_keywords
from visviva._names import body_index, body_indices, body_label, checked_names
from visviva._rigid_arguments import IDENTITY, body_suffix, pivots, principal, unit_quaternions
from visviva._rigid_frames import FramedBodies
from visviva._text import count
from visviva.errors import InvalidInput
from visviva.rigid._arguments import checked_rows
from visviva.rigid._orientation import rotate, rotate_back

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from typing import NoReturn

    from numpy.typing import ArrayLike, NDArray

    from visviva._arrays import Sizes

__all__ = ["RigidBodies"]

# How exactly the velocity of a body with a fixed point follows from its spin, where it is given all the same; and how
# exactly if it stays as it is: what a run gives has the roundings of a rotation.
_AGREES = 1e-9
IS_ROUNDED = 16 * np.finfo(np.float64).eps


@known_keywords
@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class RigidBodies(FramedBodies, Shown):
    """Rigid bodies, free or turning about a fixed point.

    Parameters
    ----------
    mass : array_like, shape (K,)
        Masses, positive.
    moments : array_like, shape (K, 3), optional
        Principal moments of inertia about the center of mass, in any order; the body's axes are then its principal
        ones. One may be 0 (a rod), about whose axis the body must not spin, and does not turn whatever acts on it.
    inertia : array_like, shape (K, 3, 3), optional
        Inertia tensors about the center of mass, along the body's axes, in place of `moments`: as of the solids and
        meshes of `visviva.rigid`.
    position : array_like, shape (K, 3), optional
        Positions of the centers of mass; the origin if not given.
    velocity : array_like, shape (K, 3), optional
        Velocities of the centers of mass; 0 if not given. That of a body with a fixed point follows from its spin: 0
        stands for it, and another is refused.
    orientation : array_like, shape (K, 4), optional
        Quaternions (x, y, z, w) from the body to space, or a ``scipy.spatial.transform.Rotation``; if not given, the
        body's axes are those of space.
    angular_velocity : array_like, shape (K, 3), optional
        Along the body's axes; 0 if not given.
    pivot : array_like, shape (K, 3), optional
        Where in each body the point is that is fixed in space: from its center of mass, along the body's axes. A row of
        NaN is a free body; all are if it is not given.
    names : sequence of str, optional
        A name for each body, all different.

    Attributes
    ----------
    principal_moments : ndarray, shape (K, 3)
        About the center of mass, or of a body with a fixed point about that.
    axes : ndarray, shape (K, 4)
        The rotation from the principal axes to those of the body; the identity where the tensor is diagonal.
    center : ndarray, shape (K, 3)
        The center of mass, from the fixed point, along the principal axes; 0 of a free body.
    pivoted : ndarray of bool, shape (K,)
        Which bodies have a fixed point.

    The arrays are copied and the copies are read-only. Units are the caller's own. Indexing with names, indices, a
    slice or a mask gives some of the bodies.

    Raises
    ------
    visviva.InvalidInput
        For a mass that is not positive, not exactly one of `moments` and `inertia`, a tensor that is not symmetric,
        moments that are those of no body (negative, all zero, or one larger than the other two together by more than
        rounding, 1e-12), quaternions whose length is not 1 within 1e-6, a velocity that does not follow from the spin
        about a fixed point, spin about the axis of a rod, NaN or infinity, a wrong shape, or names that are not one
        for each body.

    See Also
    --------
    RigidBody : one of them.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 5.3–5.5.

    Examples
    --------
    A brick that flies, and a top that stands on a fixed point 1 below its center of mass:

    >>> import numpy as np, visviva as vv
    >>> free = [np.nan, np.nan, np.nan]
    >>> bodies = vv.RigidBodies(
    ...     mass=[1.0, 15.0], moments=[[1.0, 2.0, 2.5], [0.25, 0.25, 0.5]], position=[[0, 0, 9], [0, 0, 1]],
    ...     angular_velocity=[[0.1, 5.0, 0.1], [0, 0, 150.0]], pivot=[free, [0, 0, -1]], names=["brick", "top"])
    >>> bodies
    RigidBodies(2 bodies, 1 of them about a fixed point: brick, top)
    >>> bodies["top"].principal_moments
    array([[15.25, 15.25,  0.5 ]])
    """

    mass: NDArray[np.float64]
    moments: NDArray[np.float64] | None
    inertia: NDArray[np.float64] | None
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    orientation: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]
    pivot: NDArray[np.float64] | None
    names: tuple[str, ...]
    principal_moments: NDArray[np.float64] = field(init=False)
    axes: NDArray[np.float64] = field(init=False)
    center: NDArray[np.float64] = field(init=False)
    pivoted: NDArray[np.bool_] = field(init=False)

    if not TYPE_CHECKING:
        __getattr__ = no_attribute(OF_BODIES)

    def __init__(
        self,
        mass: ArrayLike,
        moments: ArrayLike | None = None,
        inertia: ArrayLike | None = None,
        position: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
        pivot: ArrayLike | None = None,
        names: Sequence[str] | None = None,
    ) -> None:
        sizes: Sizes = {}
        masses = mass_array(mass, ("K",), sizes)
        if not masses.all():
            which = int(np.flatnonzero(masses == 0.0)[0])
            raise InvalidInput("mass", f"expected positive masses, but mass[{which}] is 0.0; Particles may be massless")
        if (moments is None) == (inertia is None):
            came = "neither" if moments is None else "both"
            raise InvalidInput("moments", f"expected one of moments and inertia, got {came}")
        number = len(masses)
        self._keep("mass", masses, mass)
        self._keep("names", checked_names(names, number))
        self._keep("moments", None if moments is None else float_array("moments", moments, ("K", 3), sizes), moments)
        self._keep("inertia", None if inertia is None else float_array("inertia", inertia, ("K", 3, 3), sizes), inertia)
        for name, given in (("position", position), ("velocity", velocity), ("angular_velocity", angular_velocity)):
            self._keep(
                name, np.zeros((number, 3)) if given is None else float_array(name, given, ("K", 3), sizes), given
            )
        turns = (
            np.tile(IDENTITY, (number, 1)) if orientation is None else checked_rows("orientation", orientation, (4,))
        )
        self._keep("orientation", unit_quaternions(float_array("orientation", turns, ("K", 4), sizes), self.names))
        self._keep("pivot", None if pivot is None else pivots(pivot, sizes))
        self._find_axes()
        self._follow_spin()

    def _keep(self, name: str, value: Any, given: object = None) -> None:
        object.__setattr__(self, name, read_only(value, given) if isinstance(value, np.ndarray) else value)

    def _find_axes(self) -> None:
        """Find the principal moments and axes about what each body turns about, and where its center is from there."""
        fixed = np.full((len(self), 3), np.nan) if self.pivot is None else self.pivot
        pivoted = ~np.isnan(fixed[:, 0])
        argument = "moments" if self.inertia is None else "inertia"
        found = []
        for body, given in enumerate(getattr(self, argument)):
            point, of = fixed[body] if pivoted[body] else None, body_suffix(body, len(self), self.names)
            found.append(principal(argument, given, float(self.mass[body]), point, of))
        axes = np.array([turn for _, turn in found]).reshape(-1, 4)
        center = rotate_back(axes, np.where(pivoted[:, None], -fixed, 0.0)) + 0.0
        self._keep("principal_moments", np.array([moments for moments, _ in found]).reshape(-1, 3))
        self._keep("axes", axes)
        self._keep("center", center)
        self._keep("pivoted", pivoted)
        spin = rotate_back(axes, self.angular_velocity)
        size = np.abs(spin).max(axis=-1, keepdims=True)
        wrong = (self.principal_moments == 0.0) & (np.abs(spin) > 1e-12 * size)
        if wrong.any():
            body, axis = np.argwhere(wrong)[0]
            raise InvalidInput(
                "angular_velocity",
                f"expected no spin about the axis of a rod, whose moment is 0, but that of "
                f"{body_label(int(body), self.names)} is {spin[body, axis]}",
            )

    def _follow_spin(self) -> None:
        """Put the velocity that follows from the spin about a fixed point in the place of the 0 that was given."""
        if self.pivot is None:
            return
        arm = np.where(self.pivoted[:, None], -self.pivot, 0.0)
        with np.errstate(over="ignore", invalid="ignore"):
            follows = np.cross(self.angular_velocity, arm)
            if not np.isfinite(follows).all():
                of = body_suffix(int(np.argwhere(~np.isfinite(follows))[0, 0]), len(self), self.names)
                raise InvalidInput("pivot", f"expected a center whose speed is within float64{of}; choose other units")
            follows = rotate(self.orientation, follows) + 0.0
            size = np.abs(self.angular_velocity).max(axis=-1) * np.abs(arm).max(axis=-1)
            apart = np.abs(self.velocity - follows).max(axis=-1)
        wrong = self.pivoted & self.velocity.any(axis=-1) & (apart > _AGREES * size)
        if wrong.any():
            body = int(np.flatnonzero(wrong)[0])
            raise InvalidInput(
                "velocity",
                f"expected 0 for a body with a fixed point, or what follows from its spin, {follows[body].tolist()}, "
                f"but that of {body_label(body, self.names)} is {self.velocity[body].tolist()}",
            )
        other = self.pivoted & ~(apart <= IS_ROUNDED * size)
        self._keep("velocity", np.where(other[:, None], follows, self.velocity))

    def __len__(self) -> int:
        return len(self.mass)

    def __getitem__(self, bodies: str | int | slice | Sequence[str | int] | ArrayLike) -> RigidBodies:
        chosen = body_indices("bodies", bodies, self.names, len(self))
        given: dict[str, Any] = {n: None if array is None else array[chosen] for n, array in self._arrays().items()}
        return RigidBodies(**given, names=[self.names[body] for body in chosen] if self.names else None)

    def __iter__(self) -> Iterator[RigidBodies]:
        return (self[body] for body in range(len(self)))

    if not TYPE_CHECKING:  # to which there is no sum of them

        def __add__(self, other: object) -> NoReturn:
            raise TypeError("RigidBodies are not added; give a scene a list of them, as Scene([a, b])")

        __radd__ = __add__

    def __repr__(self) -> str:
        fixed = int(np.count_nonzero(self.pivoted))
        note = f", {fixed} of them about a fixed point" if fixed else ""
        named = f": {', '.join(self.names[:12])}{', …' if len(self.names) > 12 else ''}" if self.names else ""
        return f"RigidBodies({count(len(self), 'body', 'bodies')}{note}{named})"

    def _sheet(self) -> Sheet:
        def row(body: int) -> tuple[str, ...]:
            inertia = self.inertia[body].ravel() if self.inertia is not None else np.zeros(0)
            moments = self.moments[body] if self.moments is not None else inertia
            vectors = (moments, self.position[body], self.velocity[body], self.angular_velocity[body])
            texts = (", ".join(f"{number:.6g}" for number in vector) for vector in vectors)
            return (self.names[body] if self.names else str(body), f"{self.mass[body]:.6g}", *texts)

        rows, note = first_rows(len(self), row)
        header = (
            "",
            "mass",
            "moments" if self.moments is not None else "inertia",
            "position",
            "velocity",
            "angular velocity (body)",
        )
        return Sheet(f"Rigid bodies: {len(self)}", rows, header, note)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, RigidBodies):
            return NotImplemented
        theirs = other._arrays()
        return self.names == other.names and all(
            mine is theirs[name]  # None
            if mine is None or theirs[name] is None
            else np.array_equal(mine, theirs[name], equal_nan=True)
            for name, mine in self._arrays().items()
        )

    def __hash__(self) -> int:
        # Adding 0.0 turns -0.0, which compares equal to 0.0, into 0.0.
        arrays = (None if value is None else (value + 0.0).tobytes() for value in self._arrays().values())
        return hash((self.names, *arrays))

    def __reduce__(self) -> tuple[type[RigidBodies], tuple[Any, ...]]:
        return RigidBodies, (*self._arrays().values(), self.names)

    def _arrays(self) -> dict[str, Any]:
        """What it was made with, in the order of the arguments."""
        names = ("mass", "moments", "inertia", "position", "velocity", "orientation", "angular_velocity", "pivot")
        return {name: getattr(self, name) for name in names}

    def _changed(self, **changes: ArrayLike | None) -> RigidBodies:
        """The same bodies with other numbers; velocities of those with a fixed point follow from the spin."""
        kept = self._arrays() | {"velocity": np.where(self.pivoted[:, None], 0.0, self.velocity)}
        return RigidBodies(**(kept | changes), names=self.names)

    @property
    def fixed_point(self) -> NDArray[np.float64]:
        """Where in space the fixed points are, shape (K, 3), in the units of the scene; NaN of free bodies.

        Examples
        --------
        >>> import visviva as vv
        >>> top = vv.RigidBody(15.0, [0.25, 0.25, 0.5], position=[0.0, 0.0, 1.0], pivot=[0.0, 0.0, -1.0])
        >>> top.fixed_point
        array([[0., 0., 0.]])
        """
        if self.pivot is None:
            return np.full((len(self), 3), np.nan)
        arm = rotate(self.orientation, np.where(self.pivoted[:, None], self.pivot, 0.0))
        return np.where(self.pivoted[:, None], self.position + arm, np.nan)

    def index(self, name: str | int) -> int:
        """The index of a body by its name, from 0 among the rigid bodies.

        Parameters
        ----------
        name : str or int
            The name, or the index itself.

        Returns
        -------
        int

        Raises
        ------
        visviva.InvalidInput
            If there is none of that name; the message has the nearest.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.RigidBody(1.0, [1.0, 1.0, 1.0], name="ball").index("ball")
        0
        """
        return body_index("name", name, self.names, len(self))

    def _core_arguments(self) -> dict[str, NDArray[Any]]:
        """What the core takes: C-contiguous arrays of shape (K, …), float64 but for `pivoted`.

        Orientations and angular velocities are those of the body's axes; moments and centers belong to the principal
        ones, which `axes` brings to the body's.

        Units: those of the scene.

        Examples
        --------
        >>> import visviva as vv
        >>> sorted(vv.RigidBody(1.0, [1.0, 1.0, 1.0])._core_arguments())  # doctest: +NORMALIZE_WHITESPACE
        ['angular_velocity', 'axes', 'center', 'mass', 'moments', 'orientation', 'pivoted', 'position', 'velocity']
        """
        names = ("mass", "position", "velocity", "axes", "center", "pivoted", "orientation", "angular_velocity")
        return {name: getattr(self, name) for name in names} | {"moments": self.principal_moments}


def __dir__() -> list[str]:
    return list(__all__)
