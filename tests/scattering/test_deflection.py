"""The deflection function: against thirty digits, published digits, closed forms, limits, trajectories, and itself.

Bounds: published digits to their rounding; errors of differences with steps of 1e-5 b, which are those of angles over
the step and its square.
"""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from tests.scattering import deflection_oracle as oracle

import visviva as vv

s = vv.scattering
V = vv.potentials
LENNARD_JONES = V.LennardJones(epsilon=1.0, sigma=1.0)

# Of the research file, 13 digits: (E, b) → ψ for 4ε = 4, σ = 1.
PUBLISHED_LENNARD_JONES = {
    (0.5, 0.5): 2.2311499856722,
    (0.5, 1.0): 1.2075931311493,
    (0.5, 1.5): -0.2184475644080,
    (0.5, 2.0): -0.7654203465568,
    (0.5, 3.0): -0.0335980720127,
    (1.0, 0.5): 2.1506062279052,
    (1.0, 1.0): 0.9969315913520,
    (1.0, 1.5): -0.9563144760054,
    (1.0, 2.0): -0.2344871435029,
    (2.0, 1.5): -0.9993475898462,
    (10.0, 0.5): 1.8951791403549,
    (10.0, 1.0): 0.3333094954251,
    (10.0, 2.0): -0.0183935305696,
}
PUBLISHED_ZBL = {
    (1e-4, 0.1): 3.1260093028506,
    (1e-4, 1.0): 2.9857885403281,
    (1e-4, 5.0): 2.3663378189052,
    (1e-4, 10.0): 1.6198404131059,
    (1e-2, 0.1): 3.0871939212482,
    (1e-2, 1.0): 2.6027842868032,
    (1e-2, 5.0): 0.9353408261905,
    (1e-2, 10.0): 0.1816461200525,
    (1.0, 0.1): 2.5581738310336,
    (1.0, 1.0): 0.5055316208750,
    (1.0, 5.0): 0.0212334040460,
    (1.0, 10.0): 0.0021533810961,
    (100.0, 0.1): 0.0969643772086,
    (100.0, 1.0): 0.0060804540403,
    (100.0, 5.0): 2.154360890e-4,
    (100.0, 10.0): 2.15752832e-5,
}


@pytest.mark.parametrize(
    ("potential", "published"),
    [(LENNARD_JONES, PUBLISHED_LENNARD_JONES), (V.ScreenedCoulomb(1.0, 1.0, "zbl"), PUBLISHED_ZBL)],
)
def test_published_digits(potential: V.Potential, published: dict[tuple[float, float], float]) -> None:
    energy, b = np.array(list(published)).T
    found = s.deflect(potential, energy=energy, impact_parameter=b)
    # Half a unit of the thirteenth decimal.
    np.testing.assert_allclose(found.angle, list(published.values()), rtol=0.0, atol=6e-14)
    assert (found.error < 1e-12).all()


def test_robinsons_table_of_moliere() -> None:
    """M. T. Robinson, ORNL-4556 (1970), ε = 0.01, 8 digits."""
    b = np.array([0.0, 1.0, 2.0, 5.0, 10.0, 15.0, 20.0])
    found = s.deflect(V.ScreenedCoulomb(1.0, 1.0, "moliere"), energy=0.01, impact_parameter=b)
    apsis = [5.9381104, 5.9975794, 6.1734304, 7.3190089, 10.725471, 15.185037, 20.042870]
    degrees = [180.0, 153.18169, 127.69528, 67.093278, 18.101051, 3.9491627, 0.79435364]
    np.testing.assert_allclose(found.closest_approach, apsis, rtol=6e-8)
    np.testing.assert_allclose(np.degrees(found.angle), degrees, rtol=1.2e-7)
    # dσ/dΩ = b/sin ψ |db/dψ|; times 4π, as printed.
    inside = slice(1, None)
    sigma = 4.0 * np.pi * b[inside] / np.sin(found.angle[inside]) / np.abs(found.derivative[inside])
    printed = [60.549823, 74.447140, 248.34784, 4456.4034, 125419.73, 4054736.6]
    np.testing.assert_allclose(sigma, printed, rtol=3e-7)  # the last row is 2.4e-7 off


@pytest.mark.parametrize("case", oracle.CASES, ids=str)
def test_thirty_digits(case: tuple[object, ...]) -> None:
    """Eight decades of energy, from head-on to far: 1e-12, and 1e-10 relative, but for what rounding of b makes."""
    random = np.random.default_rng([ord(c) for c in str(case)])
    energy, b = 10.0 ** random.uniform(-4.0, 4.0, 6), 10.0 ** random.uniform(-2.0, 0.9, 6)
    potential = getattr(V, str(case[0]))(*case[1:])
    found = s.deflect(potential, energy=energy, impact_parameter=b)
    formula = oracle.potential(*case)  # type: ignore[arg-type]
    edges = (1.0,) if case[0] == "SoftSphere" else ()
    for i in np.nonzero(found.status != s.DeflectionStatus.CAPTURED)[0]:
        expected = oracle.angle(formula, energy[i], b[i], found.closest_approach[i], edges)
        off = abs(float(expected - mp.mpf(found.angle[i])))
        allowed = 8.0 * np.finfo(float).eps * (found.conditioning[i] + abs(found.angle[i]))
        assert off <= 1e-12 + allowed, (energy[i], b[i])
        if abs(found.angle[i]) > 1e-12:
            assert off <= 1e-10 * abs(found.angle[i]) + allowed, (energy[i], b[i])
        rest = mp.pi - abs(expected)
        off = abs(float(rest - mp.mpf(found.complement[i])))
        assert off <= (1e-12 * float(rest) if expected > 1.0 else 1e-12) + allowed, (energy[i], b[i])


def test_small_angles_and_head_on_keep_their_digits() -> None:
    """V = k/r³: ψ → 2k/(E b³), exactly in the limit; π − ψ is linear in b."""
    far = s.deflect(V.PowerLaw(1.0, 3), energy=1.0, impact_parameter=[1e4, 1e6])
    np.testing.assert_allclose(far.angle, 2.0 / np.array([1e4, 1e6]) ** 3, rtol=1e-11)  # next term k²/(E b³)²
    near = s.deflect(LENNARD_JONES, energy=3.0, impact_parameter=[1e-12, 1e-20, 1e-100])
    ratio = near.complement / near.impact_parameter
    np.testing.assert_allclose(ratio, -near.derivative, rtol=1e-13)
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-14)


def test_near_orbiting_the_slope_is_twice_as_steep_inside() -> None:
    """ψ → −∞ as ln |b/b₀ − 1| from either side, twice as steep from inside: 2 to 1e-3."""
    x = (16.0 - np.sqrt(256.0 - 320.0 * 0.5)) / 80.0
    radius = x ** (-1.0 / 6.0)
    barrier = radius * np.sqrt(1.0 - (4.0 * x * x - 4.0 * x) / 0.5)
    slope = [
        np.diff(s.deflection_angle(LENNARD_JONES, energy=0.5, impact_parameter=barrier * (1.0 + side * offsets)))
        for side in (-1.0, 1.0)
        for offsets in [np.array([1e-6, 1e-8])]
    ]
    assert slope[0] / slope[1] == pytest.approx(2.0, abs=1e-3)
    status = s.deflect(
        LENNARD_JONES, energy=0.5, impact_parameter=barrier * (1.0 + np.array([-1e-6, 1e-6, 1e-2]))
    ).status
    assert status.tolist() == [2, 2, 0]


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_closed_forms_and_quadrature_are_one(sign: float) -> None:
    """±C/r⁴ by Maxwell's integral; the derivative and the rest come by quadrature and must go with it."""
    c = np.array([0.1, 0.5, 0.9] if sign > 0.0 else [0.1, 0.5, 0.9, 0.99])
    b = np.sqrt((1.0 - sign * c) / np.sqrt(c))  # at C/E = 1
    expected = (
        [0.231804865445095, 1.13943789267758, 2.30083018519502]
        if sign > 0.0
        else [-0.240692853796565, -1.39994425081395, -3.96571682196431, -7.28508345766757]
    )
    found = s.deflect(V.PowerLaw(sign, 4), energy=1.0, impact_parameter=b)
    np.testing.assert_allclose(
        found.angle, expected, rtol=2e-14 if sign > 0.0 else 2e-12
    )  # b is rounded, near orbiting
    h = 1e-6
    ends = [s.deflection_angle(V.PowerLaw(sign, 4), energy=1.0, impact_parameter=b * (1.0 + d)) for d in (h, -h)]
    differences = (ends[0] - ends[1]) / (2.0 * h * b)
    np.testing.assert_allclose(found.derivative[:2], differences[:2], rtol=2e-7)  # the others bend too much
    near = s.deflection_angle(V.PowerLaw(sign, 4.0 + 1e-9), energy=1.0, impact_parameter=b[:3])
    np.testing.assert_allclose(near, found.angle[:3], rtol=2e-7)


def test_square_well_and_hard_sphere() -> None:
    b = np.array([0.2, 0.5, 0.9, 1.0])
    well = s.deflect(V.SquareWell(depth=1.0, radius=1.0), energy=1.0, impact_parameter=b)
    np.testing.assert_allclose(-well.angle[:3], [0.118921732372334, 0.324463303383182, 0.859904849733431], rtol=3e-15)
    sphere = s.deflect(V.HardSphere(2.0), energy=1.0, impact_parameter=[0.0, 1.0, 2.0, 3.0])
    np.testing.assert_allclose(sphere.angle, [np.pi, 2.0 * np.pi / 3.0, 0.0, 0.0], rtol=1e-15)
    assert sphere.closest_approach.tolist() == [2.0, 2.0, 2.0, 3.0]


def test_capture_and_what_comes_back() -> None:
    """−C/rⁿ captures below b_c: 1.37472963699860 (C/E)^(1/6) for n = 6, √(C/E) for n = 2, √2 (C/E)^(1/4) for n = 4."""
    for n, edge in ((6, 1.37472963699860), (2, 1.0), (4, np.sqrt(2.0)), (3, np.sqrt(3.0) * 2.0 ** (-1.0 / 3.0))):
        around = edge * (1.0 + np.array([-1e-12, 1e-12]))
        found = s.deflect(V.PowerLaw(-1.0, n), energy=1.0, impact_parameter=[0.0, 0.5 * edge, *around])
        assert found.status[:3].tolist() == [1, 1, 1], n
        assert found.status[3] != s.DeflectionStatus.CAPTURED
        assert np.isnan(found.angle[:3]).all()
        assert found.angle[3] < -1.0
    assert not np.isnan(s.deflection_angle(V.PowerLaw(-1.0, 1.5), energy=1.0, impact_parameter=[0.0, 1e-30, 1.0])).any()


@pytest.mark.parametrize(
    "potential",
    [LENNARD_JONES, V.Yukawa(-1.0, 1.0), V.Plummer(-1.0, 1.0), V.Morse(1.0, 1.3, 1.5), V.SoftSphere(3.0, 1.0, 2.5)],
    ids=repr,
)
def test_derivative_is_that_of_the_angle_and_delay_that_of_time(potential: V.Potential) -> None:
    """dψ/db by differences; and −∂ψ/∂E at constant L is what the delay does with L: one action makes both."""
    energy, b = np.array([0.3, 1.1, 4.0])[:, None], np.array([0.2, 0.7, 1.3, 2.4])
    found = s.deflect(potential, energy=energy, impact_parameter=b, reduced_mass=1.0)
    h = 1e-5 * b
    ends = [s.deflection_angle(potential, energy=energy, impact_parameter=b + d) for d in (h, -h)]
    np.testing.assert_allclose(found.derivative, (ends[0] - ends[1]) / (2.0 * h), rtol=1e-6, atol=1e-8)
    if isinstance(potential, V.Plummer):
        assert (found.path_delay == -np.inf).all()  # as 1/r, won where V attracts
        return
    # With S(E, L) the radial action: ψ = π-part −∂S/∂L and delay = ∂S/∂E, so ∂ψ/∂E|_L = −∂(delay)/∂L.
    momentum = b * np.sqrt(2.0 * energy)

    def at(e: np.ndarray, angular: np.ndarray) -> vv.scattering.Deflection:
        return s.deflect(potential, energy=e, impact_parameter=angular / np.sqrt(2.0 * e), reduced_mass=1.0)

    de, dl = 1e-5 * energy, 1e-5 * momentum
    left = (at(energy + de, momentum).angle - at(energy - de, momentum).angle) / (2.0 * de)
    right = (at(energy, momentum + dl).time_delay - at(energy, momentum - dl).time_delay) / (2.0 * dl)
    # Differences with relative steps of 1e-5: rounding over the step, and its square; measured 9.5e-9.
    np.testing.assert_allclose(left, right, rtol=5e-8, atol=1e-8)


def test_a_trajectory_of_the_scene_turns_as_far() -> None:
    """A particle sent past a fixed center from r = 60, where LJ is 1e-10 of the energy."""
    for energy, b in ((1.0, 1.5), (3.0, 0.4)):
        speed = np.sqrt(2.0 * energy)
        scene = vv.Scene(
            vv.Particles(mass=[1.0], position=[[-60.0, b, 0.0]], velocity=[[speed, 0.0, 0.0]]),
            vv.CentralField(LENNARD_JONES),
        )
        velocity = scene.run(t=125.0 / speed, method="dop853", rtol=1e-13).velocity[-1, 0]
        turned = np.arctan2(velocity[1], velocity[0])
        expected = s.deflection_angle(LENNARD_JONES, energy=energy, impact_parameter=b)
        assert turned == pytest.approx(float(expected), abs=3e-9)


def test_no_bit_depends_on_neighbors_threads_or_units() -> None:
    random = np.random.default_rng(3)
    energy, b = 10.0 ** random.uniform(-2.0, 2.0, 300), random.uniform(0.0, 3.0, 300)
    for potential in (LENNARD_JONES, V.ScreenedCoulomb(1.0, 1.0, "zbl"), V.Morse(1.0, 1.3, 1.5)):
        whole = s.deflect(potential, energy=energy, impact_parameter=b, threads=1)
        for threads in (2, 3):
            again = s.deflect(potential, energy=energy, impact_parameter=b, threads=threads)
            assert np.array_equal(whole.angle, again.angle, equal_nan=True)
        alone = [s.deflection_angle(potential, energy=e, impact_parameter=x) for e, x in zip(energy, b, strict=True)]
        other = s.deflection_angle(potential, energy=energy[::-1], impact_parameter=b[::-1])[::-1]
        assert np.array_equal(other, alone, equal_nan=True)
    small = s.deflect(V.LennardJones(2.0**-300, 2.0**-200), energy=energy * 2.0**-300, impact_parameter=b * 2.0**-200)
    usual = s.deflect(LENNARD_JONES, energy=energy, impact_parameter=b)
    assert np.array_equal(small.angle, usual.angle, equal_nan=True)
    assert np.array_equal(small.closest_approach * 2.0**200, usual.closest_approach)


def test_tables_and_functions_are_as_what_they_are_of() -> None:
    r = np.geomspace(0.5, 12.0, 4000)
    values = V.Yukawa(1.0, 1.0).value(r)
    table = V.Tabulated(r, values - values[-1])
    b = np.array([0.5, 1.0, 3.0])
    expected = s.deflection_angle(V.Yukawa(1.0, 1.0), energy=1.0, impact_parameter=b)
    found = s.deflection_angle(table, energy=1.0, impact_parameter=b)
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-6)  # the tail that is not there, e^-12/12
    with pytest.raises(vv.InvalidInput, match="come to 0 where it ends"):
        s.deflect(V.Tabulated(r, values), energy=1.0, impact_parameter=b)
    with pytest.raises(vv.InvalidInput, match="begins before the turning point"):
        s.deflect(table, energy=100.0, impact_parameter=0.01)
    custom = V.Custom(lambda x: np.exp(-x) / x, r_min=0.05, r_max=40.0)
    np.testing.assert_allclose(s.deflection_angle(custom, energy=1.0, impact_parameter=b), expected, rtol=1e-10)


@pytest.mark.parametrize(
    ("given", "argument", "message"),
    [
        ({"energy": 0.0}, "energy", "positive"),
        ({"energy": np.nan}, "energy", "finite"),
        ({"impact_parameter": -1.0}, "impact_parameter", "not negative"),
        ({"impact_parameter": [np.nan]}, "impact_parameter", "finite"),
        ({"impact_parameter": [1.0, 2.0], "energy": [1.0, 2.0, 3.0]}, "impact_parameter", "shape"),
        ({"tolerance": 1e-20}, "tolerance", "1e-16"),
        ({"potential": 3.0}, "potential", "visviva.potentials"),
        ({"threads": 0}, "threads", "1"),
        ({"reduced_mass": -1.0}, "reduced_mass", "positive"),
    ],
)
def test_bad_input_is_refused_by_name(given: dict[str, object], argument: str, message: str) -> None:
    asked = {"potential": LENNARD_JONES, "energy": 1.0, "impact_parameter": 1.0} | given
    with pytest.raises(vv.InvalidInput, match=message) as refused:
        s.deflect(asked.pop("potential"), **asked)
    assert refused.value.argument == argument
    with pytest.raises(vv.InvalidInput, match="pass it to deflect"):
        _ = s.deflect(LENNARD_JONES, energy=1.0, impact_parameter=1.0).time_delay


def test_just_inside_a_soft_sphere() -> None:
    """V = ε(1 − r/R)²: ψ → (ε/E)(4√2/3) d^(3/2) and dψ/db → −(ε/E) 2√2 d^(1/2)/R, d = 1 − b/R, relative to O(d).

    d is rounded by 2⁻⁵³/d.
    """
    exponents = np.arange(4, 14)
    b = 1.0 - 10.0**-exponents
    d = 1.0 - b
    found = s.deflect(V.SoftSphere(3.0, 1.0, 2), energy=2.0, impact_parameter=b)
    allowed = 5.0 * d + 8.0 * np.finfo(float).eps / d
    assert (np.abs(found.angle / (1.5 * 4.0 * np.sqrt(2.0) / 3.0 * d**1.5) - 1.0) < allowed).all()
    assert (np.abs(found.derivative / (-1.5 * 2.0 * np.sqrt(2.0) * np.sqrt(d)) - 1.0) < allowed).all()


@pytest.mark.parametrize("n", [0.5, 1.2, 1.5, 1.8, 1.9])
@pytest.mark.parametrize("energy", [1e-4, 1.0, 1e4])
def test_around_a_center_that_attracts(n: float, energy: float) -> None:
    """−C/rⁿ, n < 2, b → 0: ψ → −πn/(2 − n), and r₀ → (b²E/C)^(1/(2−n)), however small b is.

    In units of the distance where |V| = E both are off by a multiple of E/V at r₀, or of b.
    """
    scale = (1.0 / energy) ** (1.0 / n)
    b = 10.0 ** np.array(
        [-300.0, -100.0, -50.0, -30.0, -25.0, -22.0, -18.5, -18.0, -17.0, -15.0, -12.0, -9.0, -6.0, -4.0]
    )
    found = s.deflect(V.PowerLaw(-1.0, n), energy=energy, impact_parameter=b * scale)
    assert (found.status == s.DeflectionStatus.SCATTERED).all()
    limit = -np.pi * n / (2.0 - n)
    slope = 4.0 * max(1.0, np.abs(limit)) ** 2
    off = slope * b ** min(1.0, 2.0 * n / (2.0 - n))
    assert (np.abs(found.angle - limit) <= off + 2.0 * found.error).all()
    assert (found.error <= slope * b + 1e-9).all()
    nearest = (2.0 / (2.0 - n)) * np.log10(b)
    known = nearest > -290.0  # else it is below what float64 has
    r0 = found.closest_approach[known] / scale
    assert (np.abs(np.log10(r0) - nearest[known]) <= 1e-9 + off[known]).all()
    assert (found.closest_approach[~known] < 1e-280 * scale).all()
