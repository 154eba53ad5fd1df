"""Tables as potentials: through their points, monotone where they are, smooth, and nothing beyond them.

Bounds: the same cubics in other units, whose slopes are sums that nearly cancel: 5e-15.
"""

import pickle
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import visviva as vv
from visviva.potentials import LennardJones, Tabulated

WELL = LennardJones(epsilon=1.0, sigma=1.0)
PLACES = np.linspace(0.9, 3.0, 300)
TABLE = Tabulated(PLACES, WELL.value(PLACES))


def between(r: NDArray[np.float64], count: int = 200) -> NDArray[np.float64]:
    return np.concatenate([np.linspace(a, b, count) for a, b in pairwise(r)])


def test_it_goes_through_its_points() -> None:
    assert np.array_equal(TABLE.value(PLACES), WELL.value(PLACES))


def test_the_error_falls_as_the_fifth_power_of_the_spacing() -> None:
    r = np.linspace(0.9, 3.0, 20_001)
    exact = [WELL.value(r), WELL.force(r), WELL.curvature(r)]
    errors = []
    for count in (300, 600, 1200):
        places = np.linspace(0.9, 3.0, count)
        table = Tabulated(places, WELL.value(places))
        found = [table.value(r), table.force(r), table.curvature(r)]
        errors.append([float(np.abs(a - b).max()) for a, b in zip(found, exact, strict=True)])
    for coarse, fine in pairwise(errors):
        # Halved spacing: 2⁵, 2⁴ and 2³, within 20 % as the next power is not negligible.
        assert np.all(np.divide(coarse, fine) > np.array([32, 16, 8]) * 0.8), errors


def test_force_and_curvature_are_continuous_and_derivatives_of_the_value() -> None:
    rng = np.random.default_rng(5)
    r = np.cumsum(rng.uniform(0.1, 1.0, 30))
    table = Tabulated(r, rng.normal(size=30))
    after, before = r[1:-1], np.nextafter(r[1:-1], 0.0)
    size = np.abs(table.curvature(between(r))).max()
    for asked in (table.value, table.force, table.curvature):
        # Coefficients are of order ten times the largest derivative; each side rounds them.
        assert np.abs(asked(after) - asked(before)).max() < 1e-12 * size
    x = between(r, 20).reshape(-1, 20)[:, 2:-2].ravel()  # not across a point, where the third derivative jumps
    h = 1e-4
    v = [table.value(x + k * h) for k in (-2, -1, 1, 2)]
    slope = (v[0] - 8 * v[1] + 8 * v[2] - v[3]) / (12 * h)
    # Rounding 1e-16/h of the values, and h⁴/30 of the fifth derivative, which is up to 1e5 at intervals of 0.1.
    assert np.abs(slope + table.force(x)).max() < 1e-9 * size


@pytest.mark.parametrize("seed", range(40))
def test_it_is_monotone_where_the_table_is(seed: int) -> None:
    """Steps over eleven powers of ten, some of them zero, at distances over as many."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(4, 30))
    r = np.cumsum(rng.exponential(size=count) ** 3 + 1e-9)
    sign = 1.0 if seed % 2 else -1.0
    v = sign * np.cumsum(10.0 ** rng.uniform(-8, 3, count) * (rng.random(count) < 0.8))
    steps = sign * np.diff(Tabulated(r, v).value(np.clip(between(r), r[0], r[-1])))
    assert steps.min() > -2e-15 * np.abs(v).max()
    flat = np.flatnonzero(np.diff(v) == 0.0)
    for i in flat:
        assert np.all(Tabulated(r, v).value(np.linspace(r[i], r[i + 1], 50)[:-1]) == v[i])


def test_it_has_no_waves_beside_a_wall() -> None:
    """A spline through these would swing by thousands; the curve leaves the two values by half a difference at most."""
    r = np.arange(1.0, 9.0)
    v = np.array([1e6, 1.0, -1.0, -1.5, -1.2, -0.5, -0.1, 0.0])
    found = Tabulated(r, v).value(between(r)).reshape(7, -1)
    for i, piece in enumerate(found):
        low, high = sorted(v[i : i + 2])
        room = 0.0 if i not in (2, 3) else 0.25
        assert piece.min() >= low - room - 1e-9
        assert piece.max() <= high + room
    turns = np.diff(np.sign(np.diff(found.ravel()[np.r_[True, np.diff(found.ravel()) != 0]]))) != 0
    assert np.count_nonzero(turns) == 1


def test_a_minimum_between_two_points_is_found_there() -> None:
    r = np.linspace(0.5, 3.5, 31) + 0.03
    table = Tabulated(r, (r - 2.0) ** 2)
    # A quartic through five points of a parabola is the parabola.
    assert float(table.force(2.0)) == pytest.approx(0.0, abs=1e-14)
    assert float(table.value(2.0)) == pytest.approx(0.0, abs=1e-14)


@pytest.mark.parametrize("powers", [(70, -300, 0), (-300, 10, 40), (300, -900, 0)])
def test_units_of_powers_of_two_change_no_bit(powers: tuple[int, int, int]) -> None:
    length, mass, time = (2.0**power for power in powers)
    scaled = TABLE.rescaled(length=length, mass=mass, time=time)
    r = np.random.default_rng(1).uniform(0.9, 3.0, 1000)
    energy = mass * length * length / time / time
    assert np.array_equal(scaled.value(r * length), TABLE.value(r) * energy)
    assert np.array_equal(scaled.force(r * length), TABLE.force(r) * (energy / length))


def test_extreme_units_are_served() -> None:
    small = Tabulated(PLACES * 1e-120, WELL.value(PLACES) * 1e-150)
    assert small.value(PLACES[7] * 1e-120) == WELL.value(PLACES[7]) * 1e-150
    assert float(small.force(1.5e-120)) == pytest.approx(float(TABLE.force(1.5)) * 1e-30, rel=5e-14, abs=0)


@pytest.mark.parametrize(
    ("r", "v", "argument", "words"),
    [
        ([1, 2, 3], [1, 2, 3], "r", "at least 4 distances, got 3"),
        ([1, 2, 2, 3], [1, 2, 3, 4], "r", r"ascending distances, got r\[1\] = 2.0 and then r\[2\] = 2.0"),
        ([1, 2, 3, 4], [1, 2, 3], "V", "as many as in r, 4, got 3"),
        ([1, 2, 3, 4], [1, 2, np.nan, 3], "V", r"V\[2\] is nan"),
        ([-1, 2, 3, 4], [1, 2, 3, 4], "r", r"at least 0 .*r\[0\] = -1.0"),
        ([[1, 2], [3, 4]], [1, 2, 3, 4], "r", "shape"),
        (np.arange(2.0**20 + 1), np.zeros(2**20 + 1), "r", "at most 1048576 numbers"),
        ([0.0, 1e-320, 1.0, 2.0], [1, 2, 3, 4], "r", "ascending"),
    ],
)
def test_what_is_no_table_is_refused_by_name(r: object, v: object, argument: str, words: str) -> None:
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        Tabulated(r, v)  # type: ignore[arg-type]
    assert caught.value.argument == argument


def test_beyond_the_table_is_nothing() -> None:
    for r in (0.8999, 3.0001, [1.0, 4.0]):
        for asked in (TABLE.value, TABLE.force, TABLE.curvature):
            with pytest.raises(vv.InvalidInput, match=r"from 0\.9 to 3\.0") as caught:
                asked(r)
            assert caught.value.argument == "r"


def pair(distance: float, speed: float) -> vv.Scene:
    bodies = vv.Particles([1.0, 1.0], [[0, 0, 0], [distance, 0, 0]], [[0, 0, 0], [speed, 0, 0]])
    return vv.Scene(bodies, vv.PairPotential(TABLE))


FIELD = vv.CentralField(TABLE, [0.0, 1.0, 0.0])
ESCAPING = vv.Scene(vv.Particles([1.0], [[0, 2.2, 0]], [[0.0, 3.0, 0]]), FIELD)


@pytest.mark.parametrize("scene", [pair(1.2, 3.0), ESCAPING], ids=["pair", "center"])
@pytest.mark.parametrize("how", [{"method": "dop853"}, {"method": "leapfrog", "dt": 0.01}], ids=["dop853", "leapfrog"])
def test_a_run_that_leaves_the_table_ends_and_says_so(scene: vv.Scene, how: dict[str, object]) -> None:
    with pytest.raises(vv.ConvergenceError, match="not known") as caught:
        scene.run(t=np.linspace(0.0, 10.0, 101), **how)  # type: ignore[arg-type]
    trajectory = caught.value.trajectory
    assert trajectory.status is vv.Status.OUTSIDE_DOMAIN
    assert np.isfinite(trajectory.position).all()
    both = scene.ensemble(velocity=[scene.particles.velocity * 0.0, scene.particles.velocity]).run(t=1.0, **how)
    assert both.status.tolist() == [vv.Status.OK, vv.Status.OUTSIDE_DOMAIN]
    assert np.isnan(both.position[1, -1]).all()


def test_a_scene_beyond_the_table_is_refused() -> None:
    for scene in (pair(4.0, 0.0), vv.Scene(vv.Particles([1.0], [[0, 0, 0.1]]), vv.CentralField(TABLE))):
        for asked in (lambda s=scene: s.run(t=1.0), lambda s=scene: s.plan(t=1.0), scene.acceleration):
            with pytest.raises(vv.InvalidInput, match=r"from 0\.9 to 3\.0") as caught:
                asked()
            assert caught.value.argument == "position"


def test_energy_is_kept_and_tables_are_filed(tmp_path: Path) -> None:
    scene = pair(1.3, 0.5)
    out = scene.run(t=np.linspace(0.0, 20.0, 21), rtol=1e-12)
    # The force is the derivative of what the energy is made of, so the integrator's error is all there is. It is of
    # limited order at the points, where the third derivative of the curve jumps: 1e-8 is left of rtol = 1e-12.
    assert np.ptp(out.energy) < 1e-7
    out.save(tmp_path / "run.npz")
    again = vv.load(tmp_path / "run.npz")
    assert again.final.forces == scene.forces
    assert pickle.loads(pickle.dumps(TABLE)) == TABLE
    assert hash(Tabulated(PLACES, WELL.value(PLACES))) == hash(TABLE)
    assert repr(Tabulated([1, 2, 3, 4], [1, 2, 3, 4.5])) == "Tabulated(r=[1.0, 2.0, 3.0, 4.0], V=[1.0, 2.0, 3.0, 4.5])"
    assert len(repr(TABLE)) < 200
