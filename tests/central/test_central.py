"""Motion in central potentials: closed forms, quadratures of 30 digits, trajectories, limits, and what is refused.

Integrals are asked for at 1e-13 and hold it; the oracle is `mpmath` at 30 digits. Where a tolerance is larger, the
rounding of E or l is amplified by that much, as the line says.

Bounds: places and velocities of conics go through Kepler's equation and an ellipse's turns, some ten roundings, and
ten times that is allowed; 8e-10 is where `_central_orbit` takes an epicycle for a conic.
"""

from typing import Any

import mpmath
import numpy as np
import pytest
from golden_cases import CASES
from nearness import close

import visviva as vv
from visviva.potentials import (
    Buckingham,
    Coulomb,
    Custom,
    HardSphere,
    LennardJones,
    Mie,
    Morse,
    Plummer,
    Potential,
    PowerLaw,
    ScreenedCoulomb,
    SquareWell,
    Tabulated,
    Yukawa,
)

mpmath.mp.dps = 30


def oracle(value: Any, energy: float, momentum: float, mass: float, ends: tuple[float, float]) -> tuple[Any, Any, Any]:
    """Turning points, radial period and apsidal angle to 30 digits, from turning points that are about right."""
    e, half = mpmath.mpf(energy), mpmath.mpf(momentum) ** 2 / (2 * mpmath.mpf(mass))

    def kinetic(r: Any) -> Any:
        return e - value(r) - half / r**2

    low, high = (
        mpmath.findroot(kinetic, (mpmath.mpf(end) * (1 - 1e-9), mpmath.mpf(end) * (1 + 1e-9)), solver="anderson")
        for end in ends
    )
    middle, wide = (low + high) / 2, (high - low) / 2

    # r = middle − wide cos φ leaves no singularity.
    def weight(angle: Any) -> Any:
        r = middle - wide * mpmath.cos(angle)
        return mpmath.re(wide * mpmath.sin(angle) / mpmath.sqrt(kinetic(r))), r

    places = mpmath.linspace(0, mpmath.pi, 9)
    time = mpmath.quad(lambda a: weight(a)[0], places)
    angle = mpmath.quad(lambda a: weight(a)[0] / weight(a)[1] ** 2, places)
    return (low, high), mpmath.sqrt(2 * mpmath.mpf(mass)) * time, mpmath.sqrt(half) * angle


def zbl(k: float, length: float) -> Any:
    terms = [(0.18175, 3.1998), (0.50986, 0.94229), (0.28022, 0.40290), (0.02817, 0.20162)]
    return lambda r: k / r * sum(mpmath.mpf(a) * mpmath.exp(-mpmath.mpf(b) * r / length) for a, b in terms)


FIELDS: dict[str, tuple[Any, Any, float, float, float]] = {
    "yukawa": (Yukawa(-1.0, length=5.0), lambda r: -mpmath.exp(-r / 5) / r, -0.2, 0.8, 1.0),
    "plummer": (Plummer(-2.0, 0.5), lambda r: -2 / mpmath.sqrt(r * r + mpmath.mpf(0.25)), -0.9, 0.3, 1.7),
    "lennard_jones": (LennardJones(1.0, 1.0), lambda r: 4 * (r**-12 - r**-6), -0.4, 0.9, 1.0),
    "deep_morse": (Morse(1.0, 60.0, 1.0), lambda r: (1 - mpmath.exp(-60 * (r - 1))) ** 2 - 1, -0.5, 0.01, 2.0),
    "power": (PowerLaw(-1.0, 1.5), lambda r: -(r ** mpmath.mpf(-1.5)), -0.3, 0.9, 1.0),
    "zbl_well": (
        [ScreenedCoulomb(-3.0, 0.4), Coulomb(-0.5)],
        lambda r: zbl(-3.0, 0.4)(r) - mpmath.mpf(0.5) / r,
        -0.3,
        0.5,
        1.0,
    ),
    "eccentric": (Yukawa(-1.0, length=5.0), lambda r: -mpmath.exp(-r / 5) / r, -0.01, 1e-2, 1.0),
    "nearly_round": (Yukawa(-1.0, length=5.0), lambda r: -mpmath.exp(-r / 5) / r, -0.399, 0.86, 1.0),
}


@pytest.mark.parametrize("name", FIELDS)
def test_periods_and_angles_have_thirteen_digits(name: str) -> None:
    potential, value, energy, momentum, mass = FIELDS[name]
    terms = [potential] if isinstance(potential, Potential) else potential
    # An energy that there is, whatever the case says.
    circles = vv.orbits.circular_orbits(terms, angular_momentum=momentum, mass=mass)
    energy = max(energy, float(circles.energy[0]) * (1 - 1e-4))
    found = vv.orbits.radial_motion(terms, energy=energy, angular_momentum=momentum, mass=mass, near=circles.radius[0])
    assert found.kind == "bound"
    ends, period, angle = oracle(value, energy, momentum, mass, (float(found.r_min), float(found.r_max)))
    close(found.r_min, float(ends[0]), 2e-16)
    close(found.r_max, float(ends[1]), 2e-16)
    close(found.radial_period, float(period))
    close(found.apsidal_angle, float(angle))
    assert found.period_error <= 1e-12 * found.radial_period
    assert abs(found.radial_period - period) <= 2 * found.period_error + 4e-16 * period


def test_golden_numbers() -> None:
    case = CASES["G7.17-precessing-ellipse"]
    given, out = case["inputs"], case["outputs"]
    field = [Coulomb(-given["gamma"]), PowerLaw(-given["kappa"] / 2, 2.0)]
    near = out["r_min"]
    orbit = vv.orbits.central_orbit(field, position=[near, 0, 0], velocity=[0, given["l"] / near, 0])
    close(orbit.radial_period, out["radial_period"], 4e-15)
    close(orbit.precession, out["advance_per_radial_period"], 4e-14)
    close(2 * orbit.apsidal_angle, out["apsidal_angle_full"], 4e-15)

    case = CASES["G7.14-isotropic-oscillator"]
    given, out = case["inputs"], case["outputs"]
    well = Custom(lambda r: 0.5 * given["k"] * r * r, r_min=0.0, r_max=10.0)
    found = vv.orbits.radial_motion(well, energy=given["E"], angular_momentum=given["l"])
    for name in ("r_min", "r_max", "radial_period", "apsidal_angle"):
        close(getattr(found, name), out[name], 1e-12)  # the tolerance of the fit

    case = CASES["G7.13-circular"]
    given, out = case["inputs"], case["outputs"]
    circle = vv.orbits.circular_orbits(Coulomb(-given["gamma"]), angular_momentum=given["l"], mass=given["m"])
    close(circle.radius, [out["r0"]], 4e-16)
    close(circle.energy, [out["E"]], 4e-16)
    close(circle.angular_velocity, [out["theta_dot"]], 4e-16)
    close(circle.radial_frequency, [out["radial_omega"]], 4e-16)

    case = CASES["G7.11-radial-infall"]
    given, out = case["inputs"], case["outputs"]
    times = vv.orbits.time_of_flight(
        Coulomb(-given["gamma"]), given["R"], [0.0, given["R"] / 2], energy=-0.5, angular_momentum=0.0
    )
    close(times, [out["t_fall"], out["t_half_radius"]], 1e-14)


def test_golden_conics() -> None:
    for name in ("G7.20-kepler-ellipse", "G7.20-kepler-hyperbola"):
        given, out = CASES[name]["inputs"], CASES[name]["outputs"]
        orbit = vv.orbits.central_orbit(
            Coulomb(-given["gamma"]), mass=given["m"], position=[*given["r"], 0.0], velocity=[*given["v"], 0.0]
        )
        close(orbit.energy, out["E"], 4e-16)
        close(orbit.angular_momentum, out["l"], 4e-16)
        place = orbit.position(given["t"])
        assert np.abs(place[:2] - [out["x_t"], out["y_t"]]).max() < 2e-14


@pytest.mark.parametrize("n", [-2.5, -2.0, -1.5, -2.9, -1.001])
def test_an_orbit_near_a_circle_has_the_angle_of_its_power(n: float) -> None:
    """F = −rⁿ, V = rⁿ⁺¹/(n + 1): the angle is π/√(3 + n), and differs in the second order of the eccentricity."""
    potential = PowerLaw(1.0 / (n + 1.0), -(n + 1.0))
    circle = vv.orbits.circular_orbit(potential, 1.0)
    close(circle.apsidal_angle, np.pi / np.sqrt(3.0 + n), 1e-13)
    for disturbed in (1e-3, 1e-5, 1e-7):
        orbit = vv.orbits.central_orbit(potential, position=[1.0, 0, 0], velocity=[0, 1.0 + disturbed, 0])
        amplified = disturbed**2 * 40 / (3 + n) ** 2
        close(orbit.apsidal_angle, np.pi / np.sqrt(3.0 + n), 2e-13 + amplified)


def test_bertrand() -> None:
    """Kepler's orbits and the oscillator's close; no other power of the force lets them, at any eccentricity."""
    energy = np.linspace(-0.49, -0.01, 9)
    found = vv.orbits.radial_motion(Coulomb(-1.0), energy=energy, angular_momentum=0.9)
    moving = found.kind == "bound"
    assert moving.sum() >= 7
    assert np.abs(found.precession[moving]).max() < 1e-14
    other = vv.orbits.radial_motion(PowerLaw(-1.0, 0.9), energy=[-0.3, -0.1], angular_momentum=0.7)
    assert np.all(np.abs(other.precession) > 0.1)
    assert np.ptp(other.apsidal_angle) > 1e-3


STATES = [
    (Yukawa(-1.0, 2.0), [1.1, 0.1, 0.0], [0.05, 0.6, 0.3]),
    (Plummer(-1.0, 0.5), [1.0, 0.0, -0.2], [0.0, 0.3, 0.1]),
    (Morse(1.0, 3.0, 1.0), [1.1, 0.1, 0.0], [0.3, 0.2, 0.3]),
    (LennardJones(1.0, 1.0), [1.5, 0.0, 0.0], [-0.9, 1.6, 0.0]),
    (LennardJones(1.0, 1.0), [3.0, 0.0, 0.0], [-0.9, 0.6, 0.0]),
    ([Coulomb(-1.0), PowerLaw(-0.3, 2.0)], [1.0, 0.0, 0.0], [0.0, 0.9, 0.1]),
    (Coulomb(1.0), [1.0, 0.5, 0.0], [-1.0, 0.0, 0.2]),
]


@pytest.mark.parametrize(("potential", "position", "velocity"), STATES)
def test_places_are_those_of_a_trajectory(potential: Any, position: list[float], velocity: list[float]) -> None:
    terms = [potential] if isinstance(potential, Potential) else potential
    orbit = vv.orbits.central_orbit(terms, mass=1.3, position=position, velocity=velocity)
    t = np.array([0.0, 1e-6, 0.4, 2.0, 5.0, 11.0])
    scene = vv.Scene(vv.Particles([1.3], [position], [velocity]), *(vv.CentralField(term) for term in terms))
    out = scene.run(t=t, method="dop853", rtol=1e-13)
    # The integrator lacks about 1e-11.
    assert np.abs(orbit.position(t) - out.position[:, 0]).max() < 1e-10
    assert np.abs(orbit.velocity(t) - out.velocity[:, 0]).max() < 1e-10
    assert np.abs(orbit.position(0.0) - position).max() < 4e-15
    assert np.abs(orbit.velocity(0.0) - velocity).max() < 2e-14
    # Energy and angular momentum of the places, and the path through them.
    r, v = orbit.position(t), orbit.velocity(t)
    kinetic = 0.65 * (v * v).sum(axis=-1)
    energy = kinetic + sum(term.value(np.linalg.norm(r, axis=-1)) for term in terms)
    assert np.abs(energy - orbit.energy).max() < 1e-13 * (1 + kinetic.max())
    close(orbit.radius(orbit.angle(t)), np.linalg.norm(r, axis=-1), 1e-12)


def test_circles_and_what_is_nearly_one() -> None:
    """Through the width at which an epicycle takes over from quadrature, against the conic."""
    t = np.array([0.0, 0.3, 2.0, 11.0, -7.0])
    for disturbed in (0.0, 1e-14, 1e-11, 0.7e-9, 0.9e-9, 1.1e-9, 3e-9, 1e-8, 1e-6):
        start, velocity = [1.0, 0.0, 0.0], [0.3 * disturbed, 1.0 + disturbed, 0.0]
        orbit = vv.orbits.central_orbit(Coulomb(-1.0), position=start, velocity=velocity)
        assert orbit.motion.kind == ("circular" if disturbed < 0.8e-9 else "bound")
        position, rate = vv.orbits.propagate(1.0, start, velocity, t)
        assert np.abs(orbit.position(t) - position).max() < 4e-14
        assert np.abs(orbit.velocity(t) - rate).max() < 4e-14
        close(orbit.radius(orbit.angle(t)), np.linalg.norm(position, axis=-1), 4e-15)


def test_the_path_obeys_its_equation() -> None:
    orbit = vv.orbits.central_orbit(Yukawa(-1.0, 2.0), position=[1.0, 0, 0], velocity=[0.1, 0.7, 0])
    h = 1e-3
    angle = np.linspace(0.3, 9.0, 13)
    u = [1.0 / orbit.radius(angle + k * h) for k in (-2, -1, 0, 1, 2)]
    second = (-u[0] + 16 * u[1] - 30 * u[2] + 16 * u[3] - u[4]) / (12 * h * h)
    law = vv.orbits.path_equation(Yukawa(-1.0, 2.0), u[2], angular_momentum=orbit.angular_momentum)
    # Differences of 1e-15 over h².
    assert np.abs(second - law).max() < 1e-8


def test_scales_change_nothing() -> None:
    """In units of 2^±k every number is the same, to its bit."""
    base = vv.orbits.radial_motion(LennardJones(1.0, 1.5), energy=-0.25, angular_momentum=0.7, mass=1.25)
    length, time, mass = 2.0**-33, 2.0**-41, 2.0**-83
    energy = mass * length**2 / time**2
    far = vv.orbits.radial_motion(
        LennardJones(energy, 1.5 * length),
        energy=-0.25 * energy,
        angular_momentum=0.7 * mass * length**2 / time,
        mass=1.25 * mass,
    )
    assert far.r_min == base.r_min * length
    assert far.r_max == base.r_max * length
    assert far.radial_period == base.radial_period * time
    assert far.apsidal_angle == base.apsidal_angle


def test_all_ranges() -> None:
    lj = LennardJones(1.0, 1.0)
    kinds = [part.kind for part in vv.orbits.range_of_motion(lj, energy=0.1, angular_momentum=1.5)]
    assert kinds == ["bound", "escapes"]
    assert vv.orbits.range_of_motion(lj, energy=-1.1, angular_momentum=0.1) == ()
    assert [x.kind for x in vv.orbits.range_of_motion(Coulomb(-1.0), energy=0.0, angular_momentum=1.0)] == ["escapes"]
    falls = vv.orbits.range_of_motion(PowerLaw(-1.0, 4.0), energy=0.1, angular_momentum=1.5)
    assert [x.kind for x in falls] == ["reaches_the_center", "escapes"]
    (through,) = vv.orbits.range_of_motion(PowerLaw(-1.0, 4.0), energy=0.4, angular_momentum=1.0)
    assert through.kind == "reaches_the_center_or_escapes"
    (fallen,) = vv.orbits.range_of_motion(Coulomb(-1.0), energy=-0.5, angular_momentum=0.0)
    assert (fallen.kind, fallen.r_min, fallen.r_max) == ("reaches_the_center", 0.0, 2.0)
    barrier = vv.orbits.range_of_motion(Buckingham(100.0, 3.0, 1.0), energy=0.5, angular_momentum=0.5)
    assert [x.kind for x in barrier] == ["reaches_the_center", "escapes"]
    (outside,) = vv.orbits.range_of_motion(HardSphere(2.0), energy=1.0, angular_momentum=0.5)
    assert (outside.r_min, outside.kind) == (2.0, "escapes")


def test_square_well() -> None:
    """Chords of a circle: in from the wall, by the nearest point and out, at constant speed."""
    found = vv.orbits.radial_motion(SquareWell(3.0, 1.0), energy=-1.0, angular_momentum=1.0)
    speed, near = 2.0, 0.5
    assert (float(found.r_min), float(found.r_max)) == (near, 1.0)
    close(found.radial_period, 2 * np.sqrt(1 - near**2) / speed)
    close(found.apsidal_angle, np.arccos(near))


def test_falls_and_walls() -> None:
    """Into a steep center, along a logarithmic spiral, and between an orbit's end and a hard wall."""
    # V = −1/r⁴, l = 0, from rest at 1 (E = −1): t = √(1/2) ∫ r² dr/√(1 − r⁴).
    fall = vv.orbits.radial_motion(PowerLaw(-1.0, 4.0), energy=-1.0, angular_momentum=0.0)
    time = mpmath.quad(lambda r: r**2 / mpmath.sqrt(1 - r**4), [0, 0.5, 1]) * mpmath.sqrt(mpmath.mpf(0.5))
    close(fall.radial_period, float(2 * time), 1e-14)
    # As l²/2m < 1: r² = (E − …) never turns inside; the angle has no end.
    spiral = vv.orbits.radial_motion(PowerLaw(-1.0, 2.0), energy=-1.0, angular_momentum=1.0)
    assert spiral.kind == "reaches_the_center"
    assert np.isinf(spiral.apsidal_angle)
    # r r' = −√(2 (C − r²)), C = 1/2: the time is √(C/2).
    close(spiral.radial_period, 1.0, 1e-14)
    # Kepler's ellipse with a hard core at its semi-latus rectum.
    half = vv.orbits.radial_motion([Coulomb(-1.0), HardSphere(0.75)], energy=-0.5, angular_momentum=0.75**0.5)
    assert (half.kind, float(half.r_min)) == ("bound", 0.75)
    close(half.apsidal_angle, np.pi / 2, 1e-14)
    straight = vv.orbits.radial_motion(HardSphere(2.0), energy=1.0, angular_momentum=1.0)
    close(straight.apsidal_angle, np.arcsin(1.0 / (2.0 * 2.0**0.5)), 1e-14)
    well = vv.orbits.radial_motion([SquareWell(5.0, 1.0), HardSphere(0.5)], energy=-1.0, angular_momentum=0.5)
    near = 0.5 / 8.0**0.5
    close(well.apsidal_angle, np.arccos(near) - np.arccos(near / 0.5), 1e-13)


def test_near_the_top_of_a_barrier() -> None:
    """The period grows as the logarithm of what is missing to the top; the slope is 1/λ of the unstable circle."""
    lj, momentum = LennardJones(1.0, 1.0), 1.5
    circles = vv.orbits.circular_orbits(lj, angular_momentum=momentum)
    top, rate = circles.energy[1], circles.growth_rate[1]
    missing = np.array([1e-4, 1e-6, 1e-8, 1e-10])
    periods = vv.orbits.radial_period(lj, energy=top - missing, angular_momentum=momentum, near=circles.radius[0])
    slopes = np.diff(periods) / np.log(100.0) * rate
    # Corrections are of the order of what is missing times its logarithm; at 1e-10, rounding of the top is 1e-6 of it.
    assert np.abs(slopes - 1.0).max() < 1e-2
    assert np.abs(slopes[1:] - 1.0).max() < 1e-4


def test_tables_and_fits() -> None:
    exact = vv.orbits.radial_motion(Plummer(-1.0, 0.5), energy=-0.7, angular_momentum=0.3)
    fit = Custom(lambda r: -1.0 / np.sqrt(r * r + 0.25), r_min=0.0, r_max=20.0)
    r = np.linspace(0.01, 3.0, 1500)
    table = Tabulated(r, Plummer(-1.0, 0.5).value(r))
    for potential, rel in ((fit, 1e-11), (table, 1e-8)):
        found = vv.orbits.radial_motion(potential, energy=-0.7, angular_momentum=0.3)
        for name in ("r_min", "r_max", "radial_period", "apsidal_angle"):
            close(getattr(found, name), getattr(exact, name), rel)
    (part,) = vv.orbits.range_of_motion(table, energy=0.5, angular_momentum=0.3)
    assert (part.kind, part.r_max) == ("leaves_the_table", 3.0)


def test_narrow_and_deep_wells() -> None:
    for width in (1e2, 1e4):
        (part,) = vv.orbits.range_of_motion(Morse(1.0, width, 1.0), energy=-0.5, angular_momentum=1e-6)
        close(part.r_max - part.r_min, np.log((1 + np.sqrt(0.5)) / (1 - np.sqrt(0.5))) / width, 1e-9)
    found = vv.orbits.circular_orbit(Mie(1e20, 1.0, 40.0, 6.0), (40 / 6) ** (1 / 34) * 1.001)
    assert found.stable


@pytest.mark.parametrize("apart", [1e-3, 1e-7, 1e-10, 2.0**-52])
@pytest.mark.parametrize("start", [0.6, 1.0, 1.3, 0.5 + 1e-6])
def test_near_distances_keep_their_digits(start: float, apart: float) -> None:
    """The difference of two variables lost them: 1.8e-6 of the time between 1 and 1 + 1e-10."""
    eccentricity, momentum = 0.5, float(np.sqrt(0.75))
    end = start + apart * start
    with mpmath.workdps(50):
        # r = 1 - e cos E of the ellipse with a = 1 through pericenter 1/2; times and true anomalies of both.
        def at(r: float) -> tuple[mpmath.mpf, mpmath.mpf]:
            # Its angular momentum is that of floats, and with it its eccentricity.
            e = mpmath.sqrt(1 - mpmath.mpf(momentum) ** 2)
            anomaly = mpmath.acos((1 - mpmath.mpf(r)) / e)
            half = mpmath.sqrt((1 + e) / (1 - e)) * mpmath.tan(anomaly / 2)
            return anomaly - e * mpmath.sin(anomaly), 2 * mpmath.atan(half)

        exact = [float(b - a) for a, b in zip(at(start), at(end), strict=True)]
    assert eccentricity == pytest.approx(np.sqrt(1.0 - momentum**2), rel=1e-15, abs=0.0)
    kepler = vv.potentials.Coulomb(-1.0)
    for find, wanted in zip((vv.orbits.time_of_flight, vv.orbits.swept_angle), exact, strict=True):
        # At 1e-6 from the turning point K = (E - V)r² - l²/2m, of differences of floats, has ten digits.
        found = find(kepler, start, end, energy=-0.5, angular_momentum=momentum)
        assert found == pytest.approx(wanted, rel=4e-15 if start > 0.55 else 1e-9, abs=0.0)
        assert find(kepler, end, start, energy=-0.5, angular_momentum=momentum) == found


def test_near_distances_across_a_break_of_a_table() -> None:
    """The kinks of a table are ends of panels there, too."""
    r = np.linspace(0.5, 3.0, 26)
    table = vv.potentials.Tabulated(r, 1.0 / r)
    whole = vv.orbits.time_of_flight(table, 1.0, 1.2, energy=4.0, angular_momentum=0.3)
    ends = np.linspace(1.0, 1.2, 12)
    parts = vv.orbits.time_of_flight(table, ends[:-1], ends[1:], energy=4.0, angular_momentum=0.3)
    assert parts.sum() == pytest.approx(whole, rel=1e-13, abs=0.0)


@pytest.mark.parametrize(("mass", "k", "momentum"), [(1e100, -1e200, 4e199), (1e-100, -1e-200, 4e-201)])
def test_circles_whose_volume_leaves_the_range_of_numbers(mass: float, k: float, momentum: float) -> None:
    """About Coulomb's center r = l²/m|k|, and the radial frequency is that of the circle, l/mr², which are in range."""
    circles = vv.orbits.circular_orbits(Coulomb(k), angular_momentum=momentum, mass=mass)
    radius = momentum / abs(k) * (momentum / mass)
    frequency = momentum / mass / radius / radius
    # Some ten roundings each; of the radius those of its search.
    assert circles.radius == pytest.approx([radius], rel=1e-14, abs=0)
    assert circles.angular_velocity == pytest.approx([frequency], rel=1e-13, abs=0)
    assert circles.radial_frequency == pytest.approx([frequency], rel=1e-13, abs=0)
    assert circles.stable.all()
