"""MEGNO where it is known: 2 of regular motions, 0 of isochronous ones, λt/2 of chaotic ones.

Bounds: ⟨Y⟩ comes to 2 as ln(t)/t over periods, and neighbors are seen at 2048 instants.
"""

import os
import signal
import sys
import threading
import time
import warnings

import numpy as np
import pytest

import visviva as vv

KEPLER = vv.problems.kepler(e=0.5).scene
PLANETS = vv.datasets.outer_solar_system().scene
SADDLE = vv.Scene(
    vv.Particles([2.0], [[0.3, 0.0, 0.0]], [[0.0, 0.1, 0.0]]),
    vv.ExpressionForce(potential=lambda r, v, t, k: 0.5 * k * (r @ r), parameters={"k": -2.0}),
)
HENON_HEILES = vv.ExpressionForce(
    potential=lambda r, v, t: 0.5 * (r[0] ** 2 + r[1] ** 2) + r[0] ** 2 * r[1] - r[1] ** 3 / 3
)


def henon_heiles(y: float) -> vv.Scene:
    """At E = 1/8, from x = 0."""
    speed = np.sqrt(0.25 - y**2 + 2 * y**3 / 3)
    return vv.Scene(vv.Particles([1.0], [[0.0, y, 0.0]], [[speed, 0.0, 0.0]]), HENON_HEILES)


@pytest.mark.parametrize(
    "how",
    [{}, {"method": "dop853"}, {"method": "kahan_li8", "dt": 0.02}, {"method": "leapfrog", "dt": 0.005}],
    ids=["auto", "dop853", "kahan_li8", "leapfrog"],
)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_regular_motion_has_two(how: dict[str, object], sign: float) -> None:
    if "dt" in how:
        how = how | {"dt": sign * float(str(how["dt"]))}
    for seed in (0, 1):
        found = KEPLER.megno(t=sign * 2000.0 * np.pi, seed=seed, **how)  # type: ignore[arg-type]
        assert found.mean_megno == pytest.approx(2.0, rel=0.0, abs=0.05)
        # Neighbors part in proportion to the time.
        assert 0.0 < found.lyapunov_exponent < 2.0 * np.log(2000.0 * np.pi) / (2000.0 * np.pi)


def test_planets_are_regular_by_every_kind_of_method() -> None:
    years = 365.25 * 3000.0
    found = [PLANETS.megno(t=years, **how).mean_megno for how in ({}, {"method": "stormer13", "dt": 20.0})]  # type: ignore[arg-type]
    assert found == pytest.approx([2.0, 2.0], rel=0.0, abs=0.05)
    assert found[0] == pytest.approx(found[1], rel=0.0, abs=2e-3)


def test_an_isochronous_motion_has_none() -> None:
    scene = vv.Scene(vv.Particles([1.0], [[1.0, 0, 0]], [[0, 0.5, 0]]), vv.Harmonic(k=1.0))
    found = scene.megno(t=1000.0)
    assert found.mean_megno == pytest.approx(0.0, rel=0.0, abs=1e-3)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_saddle_has_its_exponent_and_y_is_that_of_an_exponential(sign: float) -> None:
    """δ̈ = δ: λ = 1 but for the first turn of the direction, Y = λt, ⟨Y⟩ = λt/2; over 200
    e-foldings, set back on the way.
    """
    found = SADDLE.megno(t=sign * np.array([150.0, 200.0]))
    assert isinstance(found.megno, np.ndarray)
    growth = found.lyapunov_exponent * np.array([150.0, 200.0])
    assert growth[1] - growth[0] == pytest.approx(50.0, rel=1e-9, abs=0.0)
    assert found.megno[1] - found.megno[0] == pytest.approx(50.0, rel=0.0, abs=0.05)
    assert found.mean_megno[1] - found.mean_megno[0] == pytest.approx(25.0, rel=0.0, abs=0.05)  # type: ignore[index]


def test_what_falls_toward_a_center_shrinks_with_its_neighbors() -> None:
    """In a damped well as exp(−t/2τ)."""
    well = vv.Scene(vv.Particles([1.0], [[1.0, 0, 0]], [[0, 0.5, 0]]), vv.Harmonic(k=1.0), vv.LinearDrag(tau=1.0))
    found = well.megno(t=60.0)
    assert found.lyapunov_exponent == pytest.approx(-0.5, rel=0.0, abs=0.02)


def test_henon_and_heiles_have_an_island_and_a_sea() -> None:
    island, sea = henon_heiles(0.3).megno(t=3000.0), henon_heiles(-0.15).megno(t=3000.0)
    assert island.mean_megno == pytest.approx(2.0, rel=0.0, abs=0.1)
    assert 0.02 < sea.lyapunov_exponent < 0.08
    # ⟨Y⟩ → λt/2, and Y → λt.
    assert sea.mean_megno == pytest.approx(0.5 * sea.lyapunov_exponent * 3000.0, rel=0.35, abs=0.0)


def test_exponents_are_those_of_the_variational_equations() -> None:
    """One motion, by a Lagrangian's exponents too: norms and directions differ by a bounded logarithm over the time."""
    sea = henon_heiles(-0.15)
    flow = vv.systems.henon_heiles().at(position=[0.0, -0.15], momentum=sea.particles.velocity[0, :2])
    for t in (200.0, 400.0):
        assert sea.megno(t=t).lyapunov_exponent == pytest.approx(flow.lyapunov_exponents(t)[0], rel=0.0, abs=2.5 / t)


def test_copies_have_what_they_have_alone() -> None:
    """In lanes or alone: the same steps but for rounding, which chaos amplifies (copy 2)."""
    factors = np.array([1.0, 1.1, 0.8, 1.25, 0.6])
    copies = PLANETS.ensemble(
        velocity=PLANETS.particles.velocity * factors[:, None, None],
        mass=PLANETS.particles.mass * np.array([1.0, 1.0, 1.0, 1.0, 1.2])[:, None],
    )
    t = [1e5, 3e5]
    together = copies.megno(t=t, threads=1)
    for name in ("mean_megno", "megno", "lyapunov_exponent"):
        values = getattr(together, name)
        assert values.shape == (5, 2)
        alone = np.array([getattr(copies[copy].megno(t=t), name) for copy in range(5)])
        np.testing.assert_allclose(values, alone, rtol=1e-4, atol=1e-5)
        assert (getattr(copies.megno(t=t, threads=3), name) == values).all()
    assert together.status.tolist() == [0] * 5  # type: ignore[union-attr]


def test_parameters_of_copies() -> None:
    force = SADDLE.forces[0]
    found = SADDLE.ensemble(parameters={force: {"k": [-2.0, -8.0, 2.0]}}).megno(t=30.0)
    np.testing.assert_allclose(found.lyapunov_exponent, [1.0, 2.0, 0.0], rtol=0.0, atol=0.1)


def test_units_do_not_matter() -> None:
    p, length, unit = KEPLER.particles, 1e-9, 1e7
    mass = p.mass * 1e-20
    gravity = length**3 / unit**2 / 1e-20
    other = vv.Scene(vv.Particles(mass, p.position * length, p.velocity * length / unit), vv.Gravity(G=gravity))
    assert other.megno(t=600.0 * unit).mean_megno == pytest.approx(KEPLER.megno(t=600.0).mean_megno, rel=0.0, abs=1e-3)


def test_a_force_of_the_time_goes_on_with_the_time() -> None:
    """Duffing's oscillator in two wells, driven: chaotic."""
    drive = vv.ExpressionForce(acceleration=lambda r, v, t: (r[0] - r[0] ** 3 + 0.3 * np.cos(t), -r[1], -r[2]))
    drag = vv.LinearDrag(tau=4.0)
    driven = vv.Scene(vv.Particles([1.0], [[1.0, 0, 0]]), drive, drag)
    assert driven.megno(t=2000.0).lyapunov_exponent == pytest.approx(0.13, rel=0.0, abs=0.06)
    # With half the drive it stays in one well, and neighbors meet at the rate of the drag.
    drive = vv.ExpressionForce(acceleration=lambda r, v, t: (r[0] - r[0] ** 3 + 0.1 * np.cos(t), -r[1], -r[2]))
    tame = vv.Scene(vv.Particles([1.0], [[1.0, 0, 0]]), drive, drag)
    assert tame.megno(t=400.0).lyapunov_exponent == pytest.approx(-0.125, rel=0.0, abs=0.02)


def test_massless_bodies_are_neighbors_too() -> None:
    """A body beyond Hill's stability of a heavy planet is chaotic, one far outside is not."""

    def with_a_body_at(axis: float) -> vv.Scene:
        bodies = vv.Particles.from_elements(
            1.0, [1e-3, 0.0], G=1.0, semi_major_axis=[1.0, axis], mean_anomaly=[0.0, 2.0]
        )
        return vv.Scene(bodies, vv.Gravity(G=1.0))

    t = 2.0 * np.pi * 300.0
    assert with_a_body_at(2.2).megno(t=t).mean_megno == pytest.approx(2.0, rel=0.0, abs=0.1)
    assert with_a_body_at(1.15).megno(t=t).mean_megno > 4.0


def test_a_start_among_the_times_has_grown_nothing() -> None:
    found = KEPLER.megno(t=[0.0, 50.0])
    for name in ("mean_megno", "megno", "lyapunov_exponent"):
        assert getattr(found, name)[0] == 0.0


def test_a_motion_that_ends() -> None:
    """Two bodies that fall straight into each other, alone and beside a copy that goes on."""
    falling = vv.Scene(vv.Particles([1.0, 1.0, 1e-3], [[-1, 0, 0], [1, 0, 0], [0, 40.0, 0]]), vv.Gravity(G=1.0))
    with pytest.raises(vv.CloseEncounter):
        falling.megno(t=100.0, method="dop853")
    speeds = np.zeros((2, 3, 3))
    speeds[1, :2, 1] = [-0.5, 0.5]
    found = falling.ensemble(velocity=speeds).megno(t=[0.5, 20.0], method="dop853")
    assert (found.status != 0).tolist() == [True, False]  # type: ignore[union-attr]
    assert np.isfinite(found.mean_megno[:, 0]).all()  # type: ignore[index]
    assert np.isnan(found.mean_megno[:, 1]).tolist() == [True, False]  # type: ignore[index]


def test_steps_that_resolve_nothing_are_told_under_the_number_of_the_copy() -> None:
    slow = KEPLER.ensemble(velocity=KEPLER.particles.velocity * np.array([1.1, 1.0, 0.3])[:, None, None])
    with pytest.warns(vv.AccuracyWarning, match="in copy 2"):
        slow.megno(t=300.0, method="leapfrog", dt=0.05)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        slow.megno(t=300.0)


@pytest.mark.parametrize(
    ("scene", "how", "argument"),
    [
        (KEPLER, {"t": 0.0}, "t"),
        (KEPLER, {"t": []}, "t"),
        (KEPLER, {"t": [3.0, 1.0]}, "t"),
        (KEPLER, {"t": 5.0, "method": "leapfrog"}, "dt"),
        (KEPLER, {"t": 5.0, "rtol": -1.0}, "rtol"),
        (KEPLER, {"t": 5.0, "seed": -1}, "seed"),
        (KEPLER, {"t": 5.0, "seed": 0.5}, "seed"),
        (KEPLER, {"t": 5.0, "threads": 0}, "threads"),
        (KEPLER, {"t": 5.0, "tolerance": 1.0}, "tolerance"),
        (vv.Scene(vv.RigidBody(1.0, [1.0, 2.0, 3.0])), {"t": 5.0}, "rigid_bodies"),
        (KEPLER, {"t": np.nan}, "t"),
    ],
)
def test_what_is_refused(scene: vv.Scene, how: dict[str, object], argument: str) -> None:
    with pytest.raises(vv.InvalidInput) as refused:
        scene.megno(**how)  # type: ignore[arg-type]
    assert refused.value.argument == argument


@pytest.mark.parametrize("method", ["taylor", "boris", "boris4"])
def test_methods_that_know_no_neighbors(method: str) -> None:
    with pytest.raises(vv.InvalidInput, match="follows no neighbors"):
        KEPLER.megno(t=10.0, method=method, dt=None if method == "taylor" else 0.01)  # type: ignore[arg-type]


@pytest.mark.parametrize("x", [0.0, 6e-17, 1e-9, 1e-3])
def test_starts_next_to_the_origin_are_starts_like_any(x: float) -> None:
    """A pendulum and a regular motion of Hénon and Heiles from the bottom: what is small at the start is no size."""
    bottom = vv.ExpressionForce(potential=lambda r, v, t: 0.5 * (r[1] ** 2 + r[2] ** 2) - np.cos(r[0]))
    swinging = vv.Scene(vv.Particles([1.0], [[x, 0, 0]], [[0.5, 0, 0]]), bottom)
    assert swinging.megno(t=3e4).mean_megno == pytest.approx(1.9, rel=0.0, abs=0.1)
    regular = vv.Scene(vv.Particles([1.0], [[x, 0, 0]], [[0.25, 0.2, 0.0]]), HENON_HEILES)
    assert regular.megno(t=3000.0).mean_megno == pytest.approx(1.8, rel=0.0, abs=0.3)


@pytest.mark.parametrize("t", [60.0, 1000.0])
def test_where_a_motion_comes_to_rest_its_neighbors_tell_the_steps(t: float) -> None:
    """At rest any step would do for the motion. A pendulum at its bottom, and one that comes to it: −Γ = −1/10."""
    at_rest = vv.ExpressionForce(potential=lambda r, v, t: 0.5 * (r[1] ** 2 + r[2] ** 2) - np.cos(r[0] - 1.0))
    still = vv.Scene(vv.Particles([1.0], [[1.0, 0, 0]]), at_rest).megno(t=t)
    assert abs(still.lyapunov_exponent) < 1.5 * np.log(t) / t
    slowed = vv.ExpressionForce(acceleration=lambda r, v, t: [-np.sin(r[0]) - 0.2 * v[0], *(-r[1:] - 0.2 * v[1:])])
    found = vv.Scene(vv.Particles([1.0], [[1.0, 0.3, 0]]), slowed).megno(t=t)
    assert found.lyapunov_exponent == pytest.approx(-0.1, rel=0.0, abs=1.0 / t)


def test_a_copy_at_rest_does_not_change_the_others() -> None:
    """They share lanes; each is measured by its own motion."""
    places = np.array([[[0.0, 0, 0]], [[0.0, 0.1, 0]]])
    speeds = np.array([[[0.0, 0, 0]], [[0.25, 0.2, 0]]])
    one = vv.Scene(vv.Particles([1.0], places[1], speeds[1]), HENON_HEILES)
    both = one.ensemble(position=places, velocity=speeds).megno(t=1000.0)
    assert both.mean_megno[1] == pytest.approx(one.megno(t=1000.0).mean_megno, rel=1e-6, abs=0.0)  # type: ignore[index]


def test_far_from_the_origin_as_near() -> None:
    """Places are counted from the center of mass. Of 1e6 sizes rounding leaves ten digits of the start."""
    p = KEPLER.particles
    far = vv.Scene(vv.Particles(p.mass, p.position + 1e6, p.velocity + 3.0), vv.Gravity(G=1.0))
    assert far.megno(t=600.0).mean_megno == pytest.approx(KEPLER.megno(t=600.0).mean_megno, rel=0.0, abs=1e-4)


def test_what_has_merged_is_one_body() -> None:
    bodies = vv.Particles(
        [1.0, 1e-3, 1e-3, 1e-3],
        [[0, 0, 0], [1.0, 0, 0], [1.0, 0.01, 0], [0, 3.0, 0]],
        [[0, 0, 0], [0, 1.0, 0], [0, 1.0, 0], [-0.57, 0, 0]],
        radius=[1e-3, 8e-3, 8e-3, 1e-3],
    )
    left = vv.Scene(bodies, vv.Gravity(G=1.0)).run(t=1.0, collisions="merge").final
    assert (left.particles.mass == 0.0).sum() == 1
    assert left.megno(t=600.0).mean_megno == pytest.approx(2.0, rel=0.0, abs=0.2)


def test_in_a_magnetic_field() -> None:
    """Velocities turn, and so do differences of them: places part for ever at no more than they started."""
    scene = vv.Scene(
        vv.Particles([1.0], [[1.0, 0, 0]], [[0, 0.5, 0.1]]), vv.UniformMagneticField([0, 0, 2.0], charge=[1.0])
    )
    with_trap = vv.Scene(scene.particles, *scene.forces, vv.Harmonic(k=1.0))
    assert with_trap.megno(t=1000.0).mean_megno == pytest.approx(0.0, rel=0.0, abs=0.02)
    # Free along the field: in proportion to the time.
    assert scene.megno(t=1000.0).mean_megno == pytest.approx(2.0, rel=0.0, abs=0.1)


def test_many_bodies_fill_lanes() -> None:
    """Of more bodies than share lanes as copies do; and neighbors of a cluster part exponentially."""
    rng = np.random.default_rng(7)
    cluster = vv.Particles(np.full(40, 1.0 / 40), rng.normal(size=(40, 3)), 0.3 * rng.normal(size=(40, 3)))
    scene = vv.Scene(cluster, vv.Gravity(G=1.0, softening=0.1))
    found = scene.megno(t=[10.0, 20.0])
    assert found.lyapunov_exponent[1] > 0.2  # type: ignore[index]
    other = scene.megno(t=[10.0, 20.0], threads=3)
    assert (other.mean_megno == found.mean_megno).all()  # type: ignore[union-attr]
    # The directions of several seeds come to the same.
    again = scene.megno(t=20.0, seed=5).lyapunov_exponent
    assert again == pytest.approx(found.lyapunov_exponent[1], rel=0.2, abs=0.0)  # type: ignore[index]


@pytest.mark.skipif(sys.platform == "win32", reason="no POSIX signals on this system")
def test_ctrl_c() -> None:
    begun = time.monotonic()
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    try:
        with pytest.raises(vv.Interrupted, match=r"."):
            PLANETS.megno(t=1e10)
    finally:
        timer.join()
    # It would go on for minutes.
    assert time.monotonic() - begun < 5.0
