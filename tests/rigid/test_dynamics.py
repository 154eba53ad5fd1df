"""Rigid bodies in a scene, stepped: what runs promise of points they promise of bodies that turn.

Numbers of the top: Brüls, Cardona & Arnold, Mech. Mach. Theory 48 (2012) 121, to 34 digits; of the free body:
Hairer & Vilmart, J. Phys. A 39 (2006) 13225, likewise.

Bounds: closed forms and what symmetries keep, to ten times what the roundings of a run come to in its time, 1e-15 to
3e-14 (of steps: a few of theirs); those of angular velocities of a fast top are amplified by its precession.
"""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import visviva as vv

TOP = {"inertia": np.diag([0.234375, 0.46875, 0.234375]), "angular_velocity": [0.0, 150.0, -4.61538]}
TOP_CENTER = np.array([-0.1504168227456418, -0.7241655916368957, -0.6730222695604441])  # at t = 2
TOP_SPIN = np.array([0.1222332194973942, 150.0, -5.855624589205458])
MOMENTS = np.array([0.6, 0.8, 1.0])
SPIN = np.array([1.8, 0.4, -0.9]) / MOMENTS
FREE_10 = np.array([-0.570786951240350733, -0.299388571830790094, -0.206839086104673192, -0.736061364160793936])
FREE_100 = np.array([-0.401161607031241803, 0.3660001367406887, 0.0508399529158700676, 0.838169770474586381])


def top() -> vv.Scene:
    return vv.Scene(vv.RigidBody(15.0, position=[0, 1, 0], pivot=[0, -1, 0], **TOP), vv.UniformField([0.0, 0.0, -9.81]))


def pair(scale: float = 1.0) -> list[vv.RigidBodies]:
    """Two bodies that turn each other."""
    return [
        vv.RigidBody(
            2.0,
            scale * np.array([0.06, 0.08, 0.1]),
            position=[1, 0, 0],
            velocity=[0, 1.0, 0],
            angular_velocity=[1, 2, 3],
            name="small",
        ),
        vv.RigidBody(
            3.0,
            scale * np.array([0.16, 0.18, 0.19]),
            position=[-1, 0, 0],
            velocity=[0, -0.7, 0],
            angular_velocity=[0.1, 2, -3],
            name="large",
        ),
    ]


def tied() -> vv.Scene:
    """Bodies tied to each other and to a particle by springs at their points, and a massless particle beside them."""
    return vv.Scene(
        vv.Particles([1.0, 0.0], [[3, 0, 0], [0, 4, 0]], [[0, 0.5, 0.1], [0.3, 0, 0]]),
        *pair(),
        vv.AttachedSpring("small", [0.3, 0, 0.1], 2.0, 0.3, to="large", to_point=[0, 0.2, 0]),
        vv.AttachedSpring("large", [0.3, 0, 0.1], 1.0, 0.3, particle=0),
    )


def held() -> vv.Scene:
    """A free body that is stepped all the same, since its center is held."""
    return vv.Scene(vv.RigidBody(1.0, MOMENTS, angular_velocity=SPIN, pivot=[0, 0, 0]))


SCENES = {"top": top, "tied": tied, "pulled": lambda: vv.Scene(*pair(), vv.Gravity(G=1.0)), "held": held}


def test_a_free_body_in_a_scene_is_the_exact_solution() -> None:
    out = vv.Scene(vv.RigidBody(1.0, MOMENTS, angular_velocity=SPIN)).run(t=[10.0, 100.0])
    np.testing.assert_allclose(out.orientation[:, 0], [FREE_10, FREE_100], rtol=0, atol=1e-14)
    assert "elliptic functions" in str(out.plan)
    np.testing.assert_allclose(out.energy, 3.205, rtol=2e-16 * 4)


# At 1e4 radians a step does what the series leave to elliptic functions; 4 ε for each radian.
@pytest.mark.parametrize("dt", [0.01, 0.1, 0.7, 10.0])
def test_any_step_of_a_free_body_is_exact(dt: float) -> None:
    out = held().run(t=[10.0, 100.0], method="leapfrog", dt=dt)
    np.testing.assert_allclose(out.orientation[:, 0], [FREE_10, FREE_100], rtol=0, atol=1e-13)
    assert np.ptp(out.angular_momentum[:, 0]) <= 1e-15


def test_the_top_of_bruels_and_cardona() -> None:
    out = top().run(t=2.0, method="kahan_li8", dt=0.02)
    assert np.abs(out.position[-1, 0] - TOP_CENTER).max() <= 1e-13
    assert np.abs(out.angular_velocity[-1, 0] - TOP_SPIN).max() <= 1e-11
    np.testing.assert_allclose(out.velocity[-1, 0], np.cross(_space_spin(out), out.position[-1, 0]), rtol=0, atol=1e-13)


def _space_spin(out: vv.Trajectory) -> np.ndarray:
    return vv.rigid.rotate(out.orientation[-1, 0], out.angular_velocity[-1, 0])


@pytest.mark.parametrize(
    ("method", "order"),
    [
        ("euler", 1),
        ("symplectic_euler", 1),
        ("leapfrog", 2),
        ("leapfrog_dkd", 2),
        ("heun", 2),
        ("midpoint", 2),
        ("yoshida4", 4),
        ("pefrl4", 4),
        ("rk4", 4),
        ("kahan_li6", 6),
        ("blanes_moan_rkn6_14", 6),
        ("kahan_li8", 8),
    ],
)
@pytest.mark.parametrize("scene", ["tied", "pulled"])
def test_methods_have_their_orders_in_attitude(scene: str, method: str, order: int) -> None:
    made = SCENES[scene]()
    reference = made.run(t=1.0, method="kahan_li8", dt=1 / 400).orientation[-1]
    steps = {1: 400, 2: 100}.get(order, 25)
    errors = [
        np.abs(made.run(t=1.0, method=method, dt=1.0 / n).orientation[-1] - reference).max() for n in (steps, 2 * steps)
    ]
    assert errors[0] < 0.1
    if errors[1] > 2e-14:  # what is left is rounding
        # A few steps in, 0.3 is what the next power of the step may take; finer ones meet rounding.
        assert abs(np.log2(errors[0] / errors[1]) - order) <= 0.3


@pytest.mark.parametrize("name", SCENES)
def test_what_should_be_kept_is_kept(name: str) -> None:
    out = SCENES[name]().run(t=np.linspace(0.0, 1.0, 9), method="kahan_li8", dt=0.01)
    table = out.conservation()
    for drift in table.rows:
        if drift.conserved:
            # Round-off of some hundred steps, relative to the scale of the row.
            assert drift.max <= 4e-14, f"{name}\n{table}"
    assert table.energy.conserved
    np.testing.assert_allclose(np.linalg.norm(out.orientation, axis=-1), 1.0, rtol=0, atol=4 * np.finfo(float).eps)


@pytest.mark.parametrize("name", SCENES)
def test_outputs_do_not_steer(name: str) -> None:
    scene = SCENES[name]()
    few = scene.run(t=1.0, method="kahan_li6", dt=0.02)
    many = scene.run(
        t=np.linspace(0.0, 1.0, 38), method="kahan_li6", dt=0.02, record=("orientation", "position", "energy")
    )
    assert (few.orientation[-1] == many.orientation[-1]).all()
    assert (few.position[-1] == many.position[-1]).all()
    # Computed afterwards it lacks the digits that the record leaves out.
    assert abs(many.energy[-1] / few.energy[-1] - 1.0) <= 1e-15
    between = scene.run(t=[0.033], method="kahan_li8", dt=0.0033)
    apart = scene.run(t=[0.033], method="kahan_li8", dt=0.02)
    np.testing.assert_allclose(between.orientation, apart.orientation, rtol=0, atol=1e-12)


@pytest.mark.filterwarnings("ignore:.*the energy at the end:visviva.AccuracyWarning")  # bits are asked for, not digits
@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("method", ["yoshida4", "rk4"])
def test_a_member_is_as_if_alone(name: str, method: str) -> None:
    scene = SCENES[name]()
    spins = scene.rigid_bodies.angular_velocity * np.linspace(1.0, 1.5, 19)[:, None, None]
    copies = scene.ensemble(angular_velocity=spins)
    columns = ("position", "velocity", "orientation", "angular_velocity", "energy")
    how = {"t": [0.0, 0.3, 0.7], "method": method, "dt": 0.02, "record": columns}
    one, three = copies.run(**how, threads=1), copies.run(**how, threads=3)
    for column in columns:
        assert np.array_equal(getattr(one, column), getattr(three, column))
        for member in (0, 7, 8, 18):
            alone = copies[member].run(**how)
            assert np.array_equal(getattr(alone, column), getattr(one[member], column)), (column, member)


def test_bodies_that_do_not_meet_are_as_if_alone() -> None:
    rng = np.random.default_rng(5)
    bodies = vv.RigidBodies(
        np.ones(21),
        rng.uniform(1.0, 1.9, (21, 3)),
        position=rng.normal(size=(21, 3)),
        angular_velocity=rng.normal(size=(21, 3)),
    )
    forces = (vv.AppliedTorque([0.1, 0.2, 0.3], frame="body"), vv.UniformField([0.0, 0.0, -1.0]))
    drag = vv.AttachedSpring(3, [0.1, 0.0, 0.2], 2.0, anchor=[0.0, 0.0, 1.0])
    out = vv.Scene(bodies, *forces, drag).run(t=[0.0, 0.5, 1.0], method="kahan_li6", dt=0.05)
    for body in (0, 2, 9, 20):
        alone = vv.Scene(bodies[body], *forces).run(t=[0.0, 0.5, 1.0], method="kahan_li6", dt=0.05)
        assert (alone.orientation[:, 0] == out.orientation[:, body]).all()
        assert (alone.position[:, 0] == out.position[:, body]).all()
    own = vv.AttachedSpring(0, [0.1, 0.0, 0.2], 2.0, anchor=[0.0, 0.0, 1.0])
    alone = vv.Scene(bodies[3], *forces, own).run(t=[0.0, 0.5, 1.0], method="kahan_li6", dt=0.05)
    assert (alone.orientation[:, 0] == out.orientation[:, 3]).all()


@pytest.mark.parametrize("name", SCENES)
def test_a_run_back_returns(name: str) -> None:
    scene = SCENES[name]()
    there = scene.run(t=1.0, method="kahan_li8", dt=0.01).final
    back = there.run(t=0.0, method="kahan_li8", dt=0.01)
    # Symmetric methods return to rounding, which the motion magnifies.
    np.testing.assert_allclose(back.position[-1], scene.particles.position, rtol=0, atol=1e-12)
    np.testing.assert_allclose(back.orientation[-1], scene.rigid_bodies.orientation, rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", SCENES)
def test_the_frame_does_not_matter(name: str) -> None:
    scene = SCENES[name]()
    turn = vv.rigid.matrix([0.1, -0.5, 0.3, 0.8] / np.linalg.norm([0.1, -0.5, 0.3, 0.8]))
    how = {"t": 0.5, "method": "kahan_li8", "dt": 0.01}
    here, there = scene.run(**how), scene.rotated(turn).run(**how)
    np.testing.assert_allclose(there.position[-1], here.position[-1] @ turn.T, rtol=0, atol=1e-14)
    np.testing.assert_allclose(there.angular_velocity, here.angular_velocity, rtol=0, atol=1e-11)
    moved = scene.shifted(position=[1.0, -2.0, 0.5]).run(**how)
    np.testing.assert_allclose(moved.orientation, here.orientation, rtol=0, atol=1e-13)
    units = scene.rescaled(length=2.0, mass=8.0, time=0.25)
    other = units.run(t=0.125, method="kahan_li8", dt=0.0025)
    # Powers of two change no bit.
    assert (other.orientation[-1] == here.orientation[-1]).all()
    assert (other.position[-1] == 2.0 * here.position[-1]).all()


def test_axes_of_a_tensor_do_not_matter() -> None:
    """A body described by its tensor along other axes is the same body."""
    turn = np.array([0.3, 0.1, -0.4, 0.85])
    turn /= np.linalg.norm(turn)
    axes = vv.rigid.matrix(turn)
    one, other = (
        vv.Scene(
            vv.RigidBody(2.0, position=[0, 0, 0.7], **given),
            vv.UniformField([0.0, 0.0, -3.0]),
            vv.AttachedSpring(0, point, 5.0, 0.2, anchor=[1.0, 0.0, 0.0]),
            vv.AppliedTorque(torque, frame="body"),
        ).run(t=1.0, method="kahan_li8", dt=0.01)
        for given, point, torque in [
            ({"moments": [0.5, 0.6, 0.7], "angular_velocity": [1.0, 2.0, 0.5]}, [0.1, 0.2, 0.3], [0.1, 0.0, 0.2]),
            (
                {
                    "inertia": axes @ np.diag([0.5, 0.6, 0.7]) @ axes.T,
                    "angular_velocity": axes @ [1.0, 2.0, 0.5],
                    "orientation": turn * [-1, -1, -1, 1],
                },
                axes @ [0.1, 0.2, 0.3],
                axes @ [0.1, 0.0, 0.2],
            ),
        ]
    )
    np.testing.assert_allclose(other.position, one.position, rtol=0, atol=1e-13)
    np.testing.assert_allclose(other.angular_velocity[-1, 0], axes @ one.angular_velocity[-1, 0], rtol=0, atol=4e-14)
    np.testing.assert_allclose(other.energy, one.energy, rtol=1e-14)


@pytest.mark.parametrize("name", SCENES)
def test_scenes_and_runs_are_kept_as_they_are(name: str, tmp_path: object) -> None:
    scene = SCENES[name]()
    assert pickle.loads(pickle.dumps(scene)) == scene
    out = scene.run(t=[0.0, 0.5], method="leapfrog", dt=0.05)
    out.save(f"{tmp_path}/run.npz")
    back = vv.load(f"{tmp_path}/run.npz")
    assert back.scene == scene
    for column in ("position", "orientation", "angular_velocity", "energy"):
        assert np.array_equal(getattr(back, column), getattr(out, column))
    assert back.final == out.final
    assert pickle.loads(pickle.dumps(out)).final == out.final
    copies = scene.ensemble(angular_velocity=scene.rigid_bodies.angular_velocity * np.array([1.0, 2.0])[:, None, None])
    both = copies.run(t=0.5, method="leapfrog", dt=0.05)
    both.save(f"{tmp_path}/copies.npz")
    loaded = vv.load(f"{tmp_path}/copies.npz")
    assert loaded.ensemble[1] == copies[1]
    assert loaded.final[1] == both.final[1]


def test_drag_on_a_sphere_is_an_exponential() -> None:
    ball = vv.RigidBody(1.0, [2.0, 2.0, 2.0], angular_velocity=[1.0, 2.0, 3.0])
    out = vv.Scene(ball, vv.RotationalDrag(0.5)).run(t=4.0, method="rk4", dt=0.01)
    # h⁴ t/120 of the rate 1/4, and rounding.
    np.testing.assert_allclose(out.angular_velocity[-1, 0] / [1.0, 2.0, 3.0], np.exp(-1.0), rtol=1e-12)


def test_a_torque_in_space_spins_up_a_ball() -> None:
    ball = vv.RigidBody(1.0, [2.0, 2.0, 2.0])
    out = vv.Scene(ball, vv.AppliedTorque([0.0, 0.0, 3.0])).run(t=2.0, method="leapfrog", dt=0.1)
    np.testing.assert_allclose(out.angular_velocity[-1, 0], [0.0, 0.0, 3.0], rtol=1e-15)
    # ½ (3/2) t² = 3 rad.
    np.testing.assert_allclose(out.orientation[-1, 0], [0.0, 0.0, np.sin(1.5), np.cos(1.5)], rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("change", "argument"),
    [
        ({"method": "auto", "dt": None, "time_transformation": "distance"}, "time_transformation"),
        ({"method": "boris"}, "method"),
        ({"method": "stormer13"}, "method"),
        ({"time_transformation": "distance"}, "time_transformation"),
        ({"collisions": "merge"}, "collisions"),
        ({"record": "virial"}, "record"),
    ],
)
def test_what_bodies_cannot_be_run_with_is_refused_by_name(change: dict[str, object], argument: str) -> None:
    with pytest.raises(vv.InvalidInput) as error:
        tied().run(**({"t": 1.0, "method": "leapfrog", "dt": 0.1} | change))
    assert error.value.argument == argument


def test_what_looks_at_velocities_is_refused_to_kicks() -> None:
    body = vv.RigidBody(1.0, MOMENTS)
    for force in (
        vv.RotationalDrag(0.1),
        vv.LinearDrag(tau=1.0),
        vv.AttachedSpring(0, [0.1, 0, 0], 1.0, damping=0.1, anchor=[1.0, 0, 0]),
    ):
        scene = vv.Scene(body, vv.AppliedTorque([0.1, 0, 0]), force)
        with pytest.raises(vv.InvalidInput, match=f"{type(force).__name__},?( which)? looks at velocities.*rk4"):
            scene.run(t=1.0, method="leapfrog", dt=0.1)
        assert scene.run(t=1.0, method="rk4", dt=0.1).status == vv.Status.OK


def test_where_an_event_ends_a_run_bodies_are_turned_as_then() -> None:
    """Inside a step, in every member: the center of a held body is where its orientation has it, going as it spins."""
    spins = np.array(TOP["angular_velocity"]) * np.linspace(1.0, 1.2, 11)[:, None, None]
    copies = top().ensemble(angular_velocity=spins)
    how = {"t": [0.0, 1.0, 2.0], "method": "kahan_li8", "dt": 0.02}
    events = [vv.events.plane([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], terminal=2)]
    out = copies.run(**how, events=events)
    assert (out.status == vv.Status.STOPPED).any()
    for member in range(11):
        assert np.array_equal(out[member].events.t, copies[member].run(**how, events=events).events.t)
        last = out[member].final
        arm = vv.rigid.rotate(last.rigid_bodies.orientation[0], [0.0, 1.0, 0.0])
        np.testing.assert_allclose(last.particles.position[0], arm, rtol=0, atol=1e-14)


def test_a_step_alone_chooses_the_method() -> None:
    out = top().run(t=1.0, dt=0.02)
    assert out.stats.method == "kahan_li8"
    assert (out.orientation == top().run(t=1.0, method="kahan_li8", dt=0.02).orientation).all()
    drag = vv.Scene(vv.RigidBody(1.0, MOMENTS), vv.RotationalDrag(0.1))
    assert drag.run(t=1.0, dt=0.1).stats.method == "rk4"


def test_softening_beside_shapes_is_refused() -> None:
    with pytest.raises(vv.InvalidInput, match="softening"):
        vv.Scene(*pair(), vv.Gravity(G=1.0, softening=0.1)).run(t=1.0, method="leapfrog", dt=0.1)


def test_ends_of_springs_at_one_place_are_refused() -> None:
    body = vv.RigidBody(1.0, MOMENTS, position=[1.0, 0, 0])
    for force in (
        vv.AttachedSpring(0, [0.5, 0, 0], 1.0, length=1.0, anchor=[1.5, 0, 0]),
        vv.AttachedSpring(0, [0.5, 0, 0], 1.0, damping=0.1, anchor=[1.5, 0, 0]),
    ):
        with pytest.raises(vv.InvalidInput, match="ends of AttachedSpring are at one place"):
            vv.Scene(body, force).run(t=1.0, method="rk4", dt=0.1)
    slack = vv.AttachedSpring(0, [0.5, 0, 0], 1.0, anchor=[1.5, 0, 0])
    assert vv.Scene(body, slack).run(t=1.0, method="rk4", dt=0.1).status == vv.Status.OK


def test_velocities_of_held_bodies_are_not_given_to_members() -> None:
    scene = top()
    with pytest.raises(vv.InvalidInput, match="velocity"):
        scene.ensemble(velocity=np.ones((2, 1, 3)))


def test_a_massless_end_of_a_spring_is_refused() -> None:
    particle = vv.Particles([0.0], [[3.0, 0.0, 0.0]])
    with pytest.raises(vv.InvalidInput, match="mass"):
        vv.Scene(particle, pair()[0], vv.AttachedSpring(0, [0, 0, 0], 1.0, particle=0)).run(
            t=1.0, method="leapfrog", dt=0.1
        )


def test_spheres_do_not_turn_each_other() -> None:
    """Bodies of which no axis differs move as points, by any method, and turn exactly."""
    balls = [vv.RigidBody(1.0, [0.1] * 3, position=[x, 0, 0], angular_velocity=[0, 1.0, 2.0]) for x in (-1.0, 1.0)]
    out = vv.Scene(*balls, vv.Gravity(G=1.0)).run(t=1.0, method="dop853")
    points = vv.Scene(vv.Particles([1.0, 1.0], [[-1.0, 0, 0], [1.0, 0, 0]]), vv.Gravity(G=1.0)).run(
        t=1.0, method="dop853"
    )
    assert (out.position == points.position).all()
    np.testing.assert_array_equal(out.angular_velocity[-1], [[0, 1.0, 2.0]] * 2)
    spin = 0.2 * 5.0 / 2 * 1.0
    np.testing.assert_allclose(out.kinetic_energy - points.kinetic_energy, spin, rtol=1e-14)
