"""The conservation table against states made to order, and the moments about moving points.

Bounds: sums of a few numbers of size 1 in another order, and roots of these.
"""

import numpy as np
import pytest

import visviva as vv

ORBIT = vv.problems.kepler(e=0.5, mass_ratio=0.5)


def made(scene: vv.Scene, t: np.ndarray, position: np.ndarray, velocity: np.ndarray) -> vv.Trajectory:
    """A trajectory with these rows instead of the ones that were computed."""
    out = scene.run(t=t)
    out._result["columns"] = {"position": position[None], "velocity": velocity[None]}
    out._columns.clear()
    return out


def test_drift_of_a_made_up_motion() -> None:
    """One free body that speeds up from 1 to 3: momentum +2, energy × 9, both relative to what they were."""
    scene = vv.Scene(vv.Particles([2.0], [[0.0, 3.0, 0.0]], [[1.0, 0.0, 0.0]]))
    t = np.array([0.0, 1.0, 2.0])
    speed = np.array([1.0, 3.0, 2.0])
    velocity = speed[:, None, None] * np.array([[[1.0, 0.0, 0.0]]])
    position = np.array([[[0.0, 3.0, 0.0]], [[2.0, 3.0, 0.0]], [[2.5, 3.0, 0.0]]])
    table = made(scene, t, position, velocity).conservation()
    assert (table.energy.scale, table.energy.max, table.energy.end) == (1.0, 8.0, 3.0)
    assert table.energy.rms == pytest.approx(np.sqrt((0 + 64 + 9) / 3), rel=1e-14, abs=0)
    assert (table.momentum.scale, table.momentum.max, table.momentum.end) == (2.0, 2.0, 1.0)
    assert (table.angular_momentum.scale, table.angular_momentum.max) == (6.0, 2.0)
    # Uniform motion would be at x = 1 and 2.
    assert (table.center_of_mass.max, table.center_of_mass.end) == (1.0, 0.5)
    # Distances 0, 2, 1 against t − 1 = −1, 0, 1.
    assert table.momentum.slope == pytest.approx((0 * -1 + 2 * 0 + 1 * 1) / 2, rel=1e-6, abs=0)
    # 0, 8, 3 likewise.
    assert table.energy.slope == pytest.approx(3 / 2, rel=1e-14, abs=0)
    assert all(row.conserved for row in table.rows)


@pytest.mark.parametrize("mass", [1.0, 0.125, 2.0**-700])
@pytest.mark.parametrize("span", [2.0, 0.5])
def test_drifts_are_parts_of_what_there_is_however_little_that_is(mass: float, span: float) -> None:
    """A momentum of m that becomes 3 m and 2 m; the last row is of a run that did not come so far."""
    scene = vv.Scene(vv.Particles([mass], [[0.0, 3.0, 0.0]], [[1.0, 0.0, 0.0]]))
    t = np.array([0.0, 0.25, 0.5, 1.0]) * span
    velocity = np.array([1.0, 3.0, 2.0, np.nan])[:, None, None] * np.array([[[1.0, 0.0, 0.0]]])
    table = made(scene, t, np.zeros((4, 1, 3)) + velocity * 0.0, velocity).conservation()
    # All but the slope and the root of the mean square are exact: powers of two and small whole numbers.
    assert (table.momentum.scale, table.momentum.max, table.momentum.end) == (mass, 2.0, 1.0)
    assert (table.energy.scale, table.energy.max, table.energy.end) == (mass / 2.0, 8.0, 3.0)
    assert table.momentum.rms == pytest.approx(np.sqrt(5 / 3), rel=1e-15, abs=0)
    # Distances 0, 2, 1 at −1/4, 0, 1/4 of the span from their middle.
    assert table.momentum.slope == pytest.approx(1 / (0.5 * span), rel=1e-14, abs=0)
    at_once = scene.run(t=[0.0]).conservation().momentum
    assert (at_once.max, at_once.slope) == (0.0, 0.0)


def test_table_prints_every_row() -> None:
    text = str(ORBIT.scene.run(t=[0.0, 1.0, 2.0]).conservation(about="center_of_mass"))
    for word in ("energy", "momentum", "angular momentum (center of mass)", "center of mass", "virial", "max", "rms"):
        assert word in text


def test_what_the_forces_do_not_conserve_is_marked() -> None:
    body = vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    field = vv.CentralField(vv.potentials.Coulomb(-1.0), center=[0.0, 0.0, 0.0])
    out = vv.Scene(body, field).run(t=[0.0, 0.5, 1.0])
    about_center, elsewhere = out.conservation(), out.conservation(about=[0.5, 0.0, 0.0])
    assert about_center.angular_momentum.conserved
    assert about_center.angular_momentum.max < 1e-14
    assert not elsewhere.angular_momentum.conserved
    assert elsewhere.angular_momentum.max > 1e-2
    assert not about_center.momentum.conserved
    assert "not conserved by these forces" in str(about_center)
    falling = vv.Scene(body, vv.UniformField([0.0, 0.0, -1.0])).run(t=[0.0, 0.5, 1.0])
    assert falling.conservation(about="center_of_mass").angular_momentum.conserved
    assert not falling.conservation().angular_momentum.conserved


@pytest.mark.parametrize("record", [("position",), ("velocity",), ("momentum",)])
def test_what_was_not_recorded_is_asked_for_by_name(record: tuple[str, ...]) -> None:
    out = ORBIT.scene.run(t=1.0, record=record)
    with pytest.raises(vv.InvalidInput, match="'energy'") as caught:
        _ = out.energy
    assert caught.value.argument == "record"
    with pytest.raises(vv.InvalidInput) as caught:
        out.conservation()
    assert caught.value.argument == "record"
    missing = {"position", "velocity"} - set(record)
    with pytest.raises(vv.InvalidInput) as caught:
        getattr(out, missing.pop())
    assert caught.value.argument == "record"


def test_recorded_columns_equal_the_ones_computed_on_first_use() -> None:
    """Up to one rounding: what is recorded on the way is summed from the unrounded state."""
    names = ("energy", "momentum", "angular_momentum", "center_of_mass")
    t = np.linspace(0.0, 3.0, 7)
    recorded = ORBIT.scene.run(t=t, method="leapfrog", dt=0.01, record=names)
    computed = ORBIT.scene.run(t=t, method="leapfrog", dt=0.01)
    assert recorded.recorded == names
    for name in names:
        assert np.allclose(getattr(recorded, name), getattr(computed, name), rtol=4e-16, atol=4e-16), name
    # The table needs nothing else, except for the virial.
    table = recorded.conservation()
    assert table.energy.max == pytest.approx(computed.conservation().energy.max, abs=4e-15)
    assert np.isnan(table.virial)


def test_angular_momentum_about_moving_and_fixed_points() -> None:
    """L_O = L_G + R × P and L_A = L_O − a × P (König), row by row."""
    scene = vv.problems.pleiades().scene.shifted(position=[1.0, -2.0, 0.5], velocity=[0.3, 0.1, -0.7])
    out = scene.run(t=np.linspace(0.0, 1.0, 5))
    a = np.array([2.0, -1.0, 3.0])
    origin, spin = out.angular_momentum, out.angular_momentum_about("center_of_mass")
    # |L| is about 200 here.
    assert np.allclose(origin, spin + np.cross(out.center_of_mass, out.momentum), rtol=0, atol=2e-13)
    assert np.allclose(out.angular_momentum_about(a), origin - np.cross(a, out.momentum), rtol=0, atol=2e-13)


def test_torque_balances_angular_momentum() -> None:
    """K about a point is the rate of L about it, and K about the center of mass the rate of the spin."""
    rng = np.random.default_rng(3)
    bodies = vv.Particles([1.0, 2.0, 0.5], rng.normal(size=(3, 3)), rng.normal(size=(3, 3)))
    scene = vv.Scene(bodies, vv.Gravity(1.0, softening=0.3), vv.UniformField([0.3, -0.2, -1.0]))
    for about in ([0.5, -1.0, 2.0], "center_of_mass"):
        h = 1e-3
        later, earlier = scene.run(t=h, rtol=1e-13), scene.run(t=-h, rtol=1e-13)
        change = later.angular_momentum_about(about)[-1] - earlier.angular_momentum_about(about)[-1]
        torque = scene.invariants(about=about).torque
        # Central difference: h²/6 of the third derivative, which is of the order of the torque here, ~10.
        assert change / (2 * h) == pytest.approx(torque, abs=5e-5)


def test_virial_of_bound_orbits() -> None:
    """⟨2T⟩ + ⟨Σ r·F⟩ = 0 over whole periods, in any inertial frame."""
    scene = ORBIT.scene.shifted(velocity=[3.0, 1.0, 0.0])
    table = scene.run(t=np.linspace(0.0, 2 * np.pi, 257)).conservation()
    # The trapezoidal rule converges exponentially on a periodic function: e^{-257·0.55} for e = 0.5.
    assert abs(table.virial) < 1e-12


def test_lagrange_jacobi() -> None:
    """I'' = 4T + 2V with I = Σ m r², for gravity without softening."""
    scene = vv.problems.pythagorean().scene
    h = 1e-3
    states = [scene.run(t=t, rtol=1e-13).final if t else scene for t in (-h, 0.0, h)]
    inertia = [float(np.sum(s.particles.mass[:, None] * s.particles.position**2)) for s in states]
    here = scene.invariants()
    second = (inertia[0] - 2 * inertia[1] + inertia[2]) / h**2
    # h²/12 of the fourth derivative (~10) and the rounding of 70 · 1e-16 / h².
    assert second == pytest.approx(4 * here.kinetic_energy + 2 * here.potential_energy, abs=2e-5)


def test_an_energy_that_cancels_is_judged_against_what_cancels() -> None:
    """A parabola has E = 0 up to rounding, which would make any drift look infinite."""
    body = vv.Particles([1.0], [[2.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    scene = vv.Scene(body, vv.CentralField(vv.potentials.Coulomb(-1.0)))
    table = scene.run(t=[0.0, 1.0]).conservation()
    assert table.energy.scale == 1.0
    assert table.energy.max < 1e-15


@pytest.mark.parametrize(("collisions", "restitution"), [("merge", 1.0), ("bounce", 0.5), ("bounce", 1.0)])
def test_what_collisions_take_is_not_an_error_of_the_run(collisions: str, restitution: float) -> None:
    bodies = vv.Particles([1.0, 1.0], [[-2.0, 0.3, 0], [0, 0, 0]], [[1.0, 0, 0], [0, 0, 0]], radius=0.5)
    how = {"restitution": restitution} if collisions == "bounce" else {}
    out = vv.Scene(bodies).run(np.linspace(0, 4, 9), collisions=collisions, **how)
    table = out.conservation()
    elastic = collisions == "bounce" and restitution == 1.0
    assert table.collisions == 1
    assert table.energy.conserved == elastic
    assert table.energy.max * table.energy.scale == pytest.approx(out.collisions.energy_lost.sum(), abs=1e-15)
    assert table.momentum.conserved
    assert table.momentum.max < 1e-15
    assert table.angular_momentum.conserved == (collisions == "bounce")
    assert ("energy" in str(table) and "not conserved by these forces and collisions" in str(table)) != elastic


@pytest.mark.parametrize("times", [0.0, [0.0, 0.0], [1.0, 1.0]])
def test_over_no_time_there_is_no_mean_of_the_virial(times: float | list[float]) -> None:
    scene = vv.problems.figure_eight().scene
    copies = scene.ensemble(position=scene.particles.position[None])
    for out in (scene.run(t=times), copies.run(t=times)[0]):
        kept = out.conservation()
        assert np.isnan(kept.virial)
        assert kept.energy.max < 1e-10
        assert "virial" in str(kept)
