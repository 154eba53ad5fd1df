"""The asteroid 4179 Toutatis, which tumbles: its spin state, and the attitudes that radar saw in December 1992.

Digits: Y. Takahashi, M. W. Busch, D. J. Scheeres, *Spin state and moment of inertia characterization of 4179 Toutatis*,
Astron. J. 146 (2013) 95: the ratios of the moments and the state at the epoch, which they fitted, and the attitudes of
1992, which go back to the radar images of R. S. Hudson, S. J. Ostro, *Shape and non-principal axis spin state of
asteroid 4179 Toutatis*, Science 270 (1995) 84. They are taken from the paper as the tests of Principia quote it
(`physics/euler_solver_test.cpp` of mockingbirdnest/Principia), not from the page itself. The attitude of 2008 is left
out: it came after years of torques that a free rotation leaves out.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import TYPE_CHECKING

import numpy as np

from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.datasets._bodies import read_only
from visviva.rigid import FreeRotation, free_rotation, quaternion_from_euler, quaternion_product, rotation_vector

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

__all__ = ["RadarAttitudes", "Toutatis", "ToutatisComparison", "toutatis"]

_EPOCH = "1992-11-09T17:49:47"
# Along the axes x, y, z of the paper: of the middle, the largest and the smallest moment.
_MOMENTS = (3.0836, 3.235, 1.0)
_SPIN = (14.51, 33.529, -98.709)
_ANGLES = (145.498, 65.865, 241.524)

# UTC, the angles φ, θ, ψ in degrees, the angular velocity along the body's axes in degrees per day.
_RADAR = (
    ("1992-12-02T21:40", (122.2, 86.5, 107.0), (-35.6, 7.2, -97.0)),
    ("1992-12-03T19:30", (86.3, 81.8, 24.5), (-16.4, -29.1, -91.9)),
    ("1992-12-04T18:10", (47.8, 60.7, 284.0), (29.1, -23.2, -97.8)),
    ("1992-12-05T18:50", (14.6, 39.4, 207.1), (33.3, 8.2, -92.2)),
    ("1992-12-06T17:30", (331.3, 23.7, 151.6), (6.6, 34.5, -95.8)),
    ("1992-12-07T17:20", (222.5, 25.4, 143.9), (12.8, 25.4, -104.1)),
    ("1992-12-08T16:40", (169.8, 45.5, 106.9), (-31.1, -21.9, -97.7)),
    ("1992-12-09T17:50", (137.3, 71.3, 22.3), (11.8, -36.9, -94.9)),
    ("1992-12-10T17:20", (103.1, 85.2, 292.6), (35.8, -8.9, -97.9)),
    ("1992-12-11T09:40", (77.0, 85.7, 225.5), (31.0, 17.0, -96.3)),
    ("1992-12-12T09:20", (42.8, 70.2, 133.2), (-1.3, 37.0, -95.9)),
    ("1992-12-13T08:10", (13.7, 44.4, 51.9), (-38.3, 17.9, -97.3)),
    ("1992-12-14T07:50", (323.7, 14.0, 0.0), (-70.5, -30.6, -91.1)),
    ("1992-12-15T07:50", (193.2, 24.4, 21.4), (22.1, -26.6, -96.6)),
    ("1992-12-16T07:10", (165.1, 46.4, 310.6), (33.4, -3.4, -93.7)),
    ("1992-12-17T06:49", (130.6, 76.1, 234.9), (12.6, 33.9, -94.0)),
    ("1992-12-18T07:09", (91.6, 81.6, 142.4), (-24.3, 29.6, -102.0)),
)


@known_keywords
@dataclass(frozen=True, eq=False, repr=False)
class RadarAttitudes(Record):
    """How Toutatis stood and turned on seventeen days of December 1992, by radar.

    Attributes
    ----------
    date : tuple of str
        UTC.
    t : ndarray, shape (17,)
        Days since the epoch of the spin state.
    euler_angles : ndarray, shape (17, 3)
        φ, θ, ψ (z–x–z) in radians, from the body to the ecliptic of J2000.
    angular_velocity : ndarray, shape (17, 3)
        Along the body's axes, in radians per day.

    References
    ----------
    Takahashi, Busch & Scheeres, Astron. J. 146 (2013) 95; Hudson & Ostro, Science 270 (1995) 84.

    Examples
    --------
    >>> import visviva as vv
    >>> radar = vv.datasets.toutatis().radar
    >>> len(radar.date), radar.euler_angles.shape
    (17, (17, 3))
    """

    date: tuple[str, ...]
    t: NDArray[np.float64]
    euler_angles: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]

    @property
    def orientation(self) -> NDArray[np.float64]:
        """Quaternions (x, y, z, w), from the body to space, shape (17, 4), without dimension.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.datasets.toutatis().radar.orientation.shape
        (17, 4)
        """
        return quaternion_from_euler(self.euler_angles)


@known_keywords
@dataclass(frozen=True, eq=False, repr=False)
class ToutatisComparison(Record):
    """The free rotation from the spin state against what radar saw.

    Attributes
    ----------
    date : tuple of str
        UTC.
    attitude : ndarray, shape (17,)
        The angle of the rotation between the two, in degrees.
    long_axis : ndarray, shape (17,)
        The angle between the two directions of the long axis, in degrees.
    spin_direction : ndarray, shape (17,)
        The angle between the two angular velocities, as the body has them, in degrees.
    spin_ratio : ndarray, shape (17,)
        The angular velocity of the free rotation over that of radar.
    spin_state : Toutatis
        What was compared.

    References
    ----------
    Takahashi, Busch & Scheeres, Astron. J. 146 (2013) 95; Hudson & Ostro, Science 270 (1995) 84.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.datasets.toutatis().compare()
    >>> round(found.attitude.min(), 1), round(found.attitude.max(), 1)
    (np.float64(1.3), np.float64(15.9))
    """

    date: tuple[str, ...]
    attitude: NDArray[np.float64]
    long_axis: NDArray[np.float64]
    spin_direction: NDArray[np.float64]
    spin_ratio: NDArray[np.float64]
    spin_state: Toutatis = field(repr=False)

    def __str__(self) -> str:
        rows = [f"{'UTC':<18}{'attitude off':>14}{'long axis off':>15}{'spin off':>10}{'|ω| ratio':>11}"]
        for date, *angles, ratio in zip(
            self.date, self.attitude, self.long_axis, self.spin_direction, self.spin_ratio, strict=True
        ):
            turned, axis, spin = (f"{angle:.1f}°" for angle in angles)
            rows.append(f"{date:<18}{turned:>14}{axis:>15}{spin:>10}{ratio:>11.3f}")
        return "\n".join(rows)

    def plot(self, *, ax: Axes | None = None, residuals: Axes | None = None) -> Axes:
        """Draw the angular velocities along the body's axes, computed and seen, and below by which angles they differ.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw the angular velocities; by default in a new figure, ``.figure`` of what is returned, whose
            ``.figure.axes[1]`` is the panel below.
        residuals : matplotlib.axes.Axes, optional
            With `ax`, where `attitude`, `long_axis` and `spin_direction` go; without it, they are not drawn.

        Returns
        -------
        matplotlib.axes.Axes
            Of the angular velocities.

        Raises
        ------
        visviva.InvalidInput
            If matplotlib is not installed; for `residuals` without `ax`.

        Examples
        --------
        >>> import visviva as vv
        >>> ax = vv.datasets.toutatis().compare().plot()
        >>> [axes.get_ylabel() for axes in ax.figure.axes]
        ['ω in the body [degrees per day]', 'apart [degrees]']
        """
        from visviva.datasets._pictures import plot_toutatis

        return plot_toutatis(self, ax, residuals)


@known_keywords
@dataclass(frozen=True, eq=False, repr=False)
class Toutatis(Record):
    """The spin state of 4179 Toutatis; times in days, angles in radians.

    The body's axes x, y, z are those of the middle, the largest and the smallest moment: z is the long axis.

    Attributes
    ----------
    moments : ndarray, shape (3,)
        Over the smallest.
    angular_velocity : ndarray, shape (3,)
        At the epoch, along the body's axes, in radians per day.
    euler_angles : ndarray, shape (3,)
        φ, θ, ψ (z–x–z) at the epoch, from the body to the ecliptic of J2000.
    epoch : str
        UTC.
    radar : RadarAttitudes
        What was seen in December 1992.
    source : str
        Who published the numbers.

    References
    ----------
    Takahashi, Busch & Scheeres, Astron. J. 146 (2013) 95; Hudson & Ostro, Science 270 (1995) 84.

    Examples
    --------
    >>> import visviva as vv
    >>> spin = vv.datasets.toutatis()
    >>> spin.moments.round(2), spin.radar.t.shape
    (array([3.08, 3.24, 1.  ]), (17,))
    """

    moments: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]
    euler_angles: NDArray[np.float64]
    epoch: str
    radar: RadarAttitudes
    source: str

    @property
    def orientation(self) -> NDArray[np.float64]:
        """The quaternion (x, y, z, w) at the epoch, from the body to space, shape (4,), without dimension.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.datasets.toutatis().orientation.shape
        (4,)
        """
        return quaternion_from_euler(self.euler_angles)

    def motion(self, t: ArrayLike) -> FreeRotation:
        """Give the free rotation, in closed form.

        Parameters
        ----------
        t : float or array_like, shape (T,)
            Days since the epoch. Any other shape takes the place of (T,) in all that is given.

        Returns
        -------
        FreeRotation
            See `visviva.rigid.free_rotation`. Times are in days, angles in radians.

        Raises
        ------
        visviva.InvalidInput
            For NaN or infinity.

        Examples
        --------
        Its long axis goes round an angular momentum that points far south of the ecliptic:

        >>> import numpy as np, visviva as vv
        >>> along = vv.datasets.toutatis().motion(0.0).angular_momentum
        >>> (along / np.linalg.norm(along)).round(3)
        array([-0.593, -0.011, -0.805])
        """
        return free_rotation(self.moments, self.angular_velocity, t, self.orientation)

    def compare(self) -> ToutatisComparison:
        """Compare the free rotation with the attitudes that radar saw.

        Returns
        -------
        ToutatisComparison
            Attitudes differ by 1.3° to 16°: errors of the images and of the fit, and what the torques of the Sun and
            the Earth did, which a free rotation leaves out. Arrays have shape (17,), angles are in degrees.

        Examples
        --------
        >>> import visviva as vv
        >>> found = vv.datasets.toutatis().compare()
        >>> found.attitude.round(1)
        array([ 8. ,  7.9, 15.9,  9.4,  2.1, 15.3,  3.3,  3.5,  3.4,  3. ,  3.2,
                5.6,  5.1,  8.4,  8.7,  1.3,  6.6])
        """
        seen, out = self.radar, self.motion(self.radar.t)
        between = quaternion_product(out.orientation * [-1.0, -1.0, -1.0, 1.0], seen.orientation)
        turned = rotation_vector(between)
        sizes = np.linalg.norm(out.angular_velocity, axis=-1), np.linalg.norm(seen.angular_velocity, axis=-1)
        cosine = (out.angular_velocity * seen.angular_velocity).sum(axis=-1) / (sizes[0] * sizes[1])
        # The long axis of the body is z: of the rotation between the two, cos = 1 − 2(x² + y²).
        tilt = 2.0 * np.arcsin(np.hypot(between[:, 0], between[:, 1]))
        return ToutatisComparison(
            date=seen.date,
            attitude=np.degrees(np.linalg.norm(turned, axis=-1)),
            long_axis=np.degrees(tilt),
            spin_direction=np.degrees(np.arccos(cosine)),
            spin_ratio=sizes[0] / sizes[1],
            spin_state=self,
        )


@known_keywords
def toutatis() -> Toutatis:
    """Give the spin state of the asteroid 4179 Toutatis, and what radar saw of it in December 1992.

    Returns
    -------
    Toutatis
        Ratios of its moments, angular velocity and orientation at the epoch, the seventeen attitudes and the source.

    Notes
    -----
    Moments, angular velocity and orientation at the epoch are the fit of Takahashi, Busch & Scheeres, Astron. J. 146
    (2013) 95; the attitudes are those of the radar images of Hudson & Ostro, Science 270 (1995) 84, as that paper lists
    them. Angles are from the ecliptic of J2000.

    Examples
    --------
    Around its long axis in 5.4 days, while that goes round in 7.4 days on average:

    >>> import numpy as np, visviva as vv
    >>> data = vv.datasets.toutatis()
    >>> path = vv.rigid.polhode(data.moments, data.angular_velocity)
    >>> path.kind, round(path.period, 10), round(2 * np.pi / path.precession_rate, 10)
    ('about_smallest', 5.3685303135, 7.4116522679)
    """
    epoch = datetime.fromisoformat(_EPOCH)
    dates, angles, spins = zip(*_RADAR, strict=True)
    days = [(datetime.fromisoformat(date) - epoch) / timedelta(days=1) for date in dates]
    radar = RadarAttitudes(dates, read_only(days), read_only(np.radians(angles)), read_only(np.radians(spins)))
    return Toutatis(
        moments=read_only(_MOMENTS),
        angular_velocity=read_only(np.radians(_SPIN)),
        euler_angles=read_only(np.radians(_ANGLES)),
        epoch=_EPOCH,
        radar=radar,
        source="Takahashi, Busch & Scheeres, Astron. J. 146 (2013) 95; radar: Hudson & Ostro, Science 270 (1995) 84",
    )


def __dir__() -> list[str]:
    return list(__all__)
