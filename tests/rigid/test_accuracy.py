"""Fixed steps of scenes with rigid bodies that resolved nothing do not end without a word; others are not spoken to."""

import warnings
from pathlib import Path

import numpy as np
import pytest

import visviva as vv

BODY = vv.RigidBody(1.0, moments=[0.1, 0.2, 0.25])
SPRING = vv.AttachedSpring(0, [0.3, 0.1, 0.2], stiffness=5000.0, length=1.0, anchor=[1.5, 0.0, 0.3])
ON_A_SPRING = vv.Scene(BODY, SPRING)
PASSAGE = vv.Scene(
    vv.Particles([0.1], [[3.0, 0.3, 0.0]], [[-1.0, 0.0, 0.0]]),
    vv.RigidBody(10.0, moments=[2.0, 3.0, 4.0]),
    vv.Gravity(1.0),
)
SAYS = r"the energy at the end is off by .* of kinetic \+ \|potential\|: a step of dt = 0\.1 .* leaving dt out"


@pytest.mark.parametrize(("scene", "t"), [(ON_A_SPRING, 2.0), (PASSAGE, 10.0)])
def test_an_energy_that_is_off_by_orders_is_said(scene: vv.Scene, t: float) -> None:
    """It was 1e215 for 108, and 4e6 for -0.3, with status OK."""
    with pytest.warns(vv.AccuracyWarning, match=SAYS) as caught:
        out = scene.run(t=[0.0, t], dt=0.1)
    assert out.status is vv.Status.OK
    assert caught[0].filename == __file__


def test_backward_runs_are_looked_at() -> None:
    with pytest.warns(vv.AccuracyWarning, match=SAYS):
        ON_A_SPRING.run(t=[-2.0], dt=-0.1)


def test_the_step_that_is_named_resolves_it() -> None:
    with pytest.warns(vv.AccuracyWarning, match=SAYS) as caught:
        ON_A_SPRING.run(t=2.0, dt=0.1)
    better = float(str(caught[0].message).rsplit("dt = ", 1)[1])
    ON_A_SPRING.run(t=2.0, dt=better)


@pytest.mark.parametrize("own", ["position", "mass", "parameters"])
def test_the_copy_is_named(own: str, tmp_path: Path) -> None:
    """Bodies pass far apart but in copy 1; copies of other forces or masses are looked at after many evaluations."""
    places = np.array([[[3.0, 30.0, 0.0], [0.0, 0.0, 0.0]], PASSAGE.particles.position, [[3.0, 40.0, 0.0], [0.0] * 3]])
    more = {"mass": [[0.1, 10.0], [0.2, 10.0], [0.3, 10.0]]}, {"parameters": {"Gravity": {"G": [1.0, 1.01, 1.0]}}}
    given = {"position": {}, "mass": more[0], "parameters": more[1]}[own]
    copies = PASSAGE.ensemble(position=places, **given)
    how = {"t": 65.0, "dt": 0.1}
    with pytest.warns(vv.AccuracyWarning, match="in copy 1, " + SAYS):
        copies.run(**how)
    with pytest.warns(vv.AccuracyWarning, match="in copy 1, " + SAYS):
        copies.run_to_parquet(**how, to=tmp_path / "copies.parquet", copies_at_once=1)


@pytest.mark.parametrize("own", ["mass", "parameters"])
def test_a_short_run_of_copies_with_masses_or_forces_of_their_own_is_not_looked_at(own: str) -> None:
    """To look at each of many by itself would take longer than the run."""
    for copies, looked_at in ((2, True), (16, True), (17, False)):
        start = {"velocity": [PASSAGE.particles.velocity] * copies}
        masses = {"mass": [[0.1 + 0.1 * k, 10.0] for k in range(copies)]}
        constants = {"parameters": {"Gravity": {"G": 1.0 + 0.01 * np.arange(copies)}}}
        given = {"mass": masses, "parameters": constants}
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            out = PASSAGE.ensemble(**start, **given[own]).run(t=10.0, dt=0.1)
        assert np.abs(out.energy[:, -1] / out.energy[:, 0] - 1.0).max() > 1.0
        assert [each.category for each in caught] == [vv.AccuracyWarning] * looked_at


@pytest.mark.parametrize(("bodies", "t", "looked_at"), [(32, 10.0, True), (33, 10.0, False), (33, 30.0, True)])
def test_of_more_than_five_hundred_pairs_a_short_run_is_not_looked_at(bodies: int, t: float, looked_at: bool) -> None:
    """A sum over 528 pairs is something beside 1700 evaluations of the forces, over 496, or beside 5100, it is not."""
    apart = 1e3 * np.arange(bodies - 1)[:, None] * [1.0, 0.0, 0.0]
    rest = vv.RigidBodies(np.full(bodies - 1, 10.0), moments=[[2.0, 3.0, 4.0]] * (bodies - 1), position=apart)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        vv.Scene(PASSAGE.particles[[0]], rest, vv.Gravity(1.0)).run(t=[t], dt=0.1)
    assert [each.category for each in caught] == [vv.AccuracyWarning] * looked_at


def test_what_resolves_it_is_not_blamed() -> None:
    drag = vv.RotationalDrag(0.5)
    body = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[1.0, 2.0, 3.0])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ON_A_SPRING.run(t=2.0, dt=0.001)
        vv.Scene(body, drag).run(t=10.0, dt=0.1, method="rk4")
        vv.Scene(BODY, vv.AppliedTorque([0.0, 0.0, 5.0])).run(t=10.0, dt=0.1)
        # At rest nothing is there to be compared with.
        vv.Scene(vv.RigidBody(1.0, [1.0, 2.0, 2.5]), vv.AppliedTorque([0.0, 0.0, 0.0])).run(t=1.0, dt=0.1)


@pytest.mark.parametrize("method", ["kahan_li8", "leapfrog"])
def test_a_motion_that_comes_back_to_rest_is_not_blamed(method: vv.typing.MethodName) -> None:
    """At both ends all energies are zero but for the error of a step, of which every part was off by one."""
    spring = vv.AttachedSpring(0, [0.0, 0.0, 0.0], stiffness=4.0, length=0.0, anchor=[0.0, 0.0, 0.0])
    scene = vv.Scene(vv.RigidBody(1.0, [1.0, 2.0, 2.5]), spring, vv.UniformField([0.0, 0.0, -9.8]))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        out = scene.run(t=np.pi, method=method, dt=0.01)
    assert np.abs(out.velocity[-1]).max() < 1e-2


def test_copies_that_come_back_to_rest_are_not_blamed_beside_one_that_moves() -> None:
    spring = vv.AttachedSpring(0, [0.0, 0.0, 0.0], stiffness=4.0, length=0.0, anchor=[0.0, 0.0, 0.0])
    scene = vv.Scene(vv.RigidBody(1.0, [1.0, 2.0, 2.5]), spring, vv.UniformField([0.0, 0.0, -9.8]))
    velocity = np.zeros((3, 1, 3))
    velocity[2, 0, 0] = 1.0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene.ensemble(velocity=velocity).run(t=np.pi, method="leapfrog", dt=0.01)


@pytest.mark.parametrize("size", [1.0, 1e10])
def test_a_motion_from_rest_that_was_not_resolved_is_said(size: float) -> None:
    spring = vv.AttachedSpring(0, [0.0, 0.0, 0.0], stiffness=4.0 * size, length=0.0, anchor=[0.0, 0.0, 0.0])
    body = vv.RigidBody(size, [1.0 * size, 2.0 * size, 2.5 * size])
    with pytest.warns(vv.AccuracyWarning, match=r"off by 0\.025"):
        vv.Scene(body, spring, vv.UniformField([0.0, 0.0, -9.8])).run(t=[6.5], method="leapfrog", dt=0.9)


def test_an_error_of_a_hundredth_is_said() -> None:
    """It is of kinetic + |potential|, however fast the body was from the start."""
    scene = vv.Scene(vv.RigidBody(1.0, moments=[0.1, 0.2, 0.25], velocity=[0.0, 0.0, 40.0]), *ON_A_SPRING.body_forces)
    with pytest.warns(vv.AccuracyWarning, match=r"off by 0\.014"):
        scene.run(t=[2.0], method="rk4", dt=0.008)


def test_copies_with_forces_of_their_own_are_looked_at_by_these() -> None:
    """By those of another copy their energies would not stay."""
    velocity = np.array([[[0.0, 4.0, 0.0], [0.0, 0.0, 0.0]], [[0.0, 8.0, 0.0], [0.0, 0.0, 0.0]]])
    pair = vv.Particles([0.1], [[1.0, 0.0, 0.0]]), vv.RigidBody(10.0, [0.2, 0.3, 0.4])
    copies = vv.Scene(*pair, vv.Gravity(1.0)).ensemble(velocity=velocity, parameters={"Gravity": {"G": [1.0, 4.0]}})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        out = copies.run(t=5.0, dt=0.005)
    assert out.stats.evaluations > 2 * 10_000  # of both


@pytest.mark.parametrize("own", ["moments", "axes"])
def test_copies_with_bodies_of_their_own_are_looked_at_by_these(own: str) -> None:
    """With the moments of another copy, or its own about the axes of another, no tumbling body keeps its energy."""
    both = np.array([[1.5, 0.5, 0.0], [0.5, 1.5, 0.0], [0.0, 0.0, 2.5]])
    # Other moments about the same axes; or the same ones about others.
    more_alike = np.array([[1.5, 0.1, 0.0], [0.1, 1.5, 0.0], [0.0, 0.0, 2.9]])
    other = {"moments": more_alike, "axes": both * np.array([[1, -1, 1], [-1, 1, 1], [1, 1, 1]])}[own]
    anchored = vv.AttachedSpring(0, [0.0, 0.0, 0.0], stiffness=2.0, anchor=[0.0, 0.0, 1.0])
    scene = vv.Scene(vv.RigidBody(1.0, inertia=both, angular_velocity=[3.0, -2.0, 1.0]), anchored)
    copies = scene.ensemble(inertia=[[both], [other]])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        out = copies.run(t=[0.0, 1.0], method="rk4", dt=0.01)
    # rk4 with a hundred steps to a turn: at most (0.04)⁵/120 of the energy in each of 100.
    assert out.conservation().energy.max.max() < 1e-6
    # What the look would tell of the second copy if it took its body for the first: over 1 in 100.
    spin = out.angular_velocity[1, :, 0]
    taken_for_first = 0.5 * np.einsum("ti,ij,tj->t", spin, both, spin)
    assert abs(taken_for_first[-1] - taken_for_first[0]) > 0.05 * taken_for_first[0]


def test_bodies_that_end_in_one_place_are_no_error() -> None:
    """Of which no energy is told."""
    ball = vv.Particles([1.0], [[-1.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]])
    out = vv.Scene(ball, vv.RigidBody(1.0, [1.0, 2.0, 3.0]), vv.Gravity(1e-300)).run(
        t=1.0, dt=0.125, method="leapfrog_dkd"
    )
    assert not np.isfinite(out.energy[-1])
    assert out.status is vv.Status.OK


WEAK = {
    "torque": vv.AppliedTorque([0.0, 0.0, 1e-9]),
    "torque of the body": vv.AppliedTorque([0.0, 0.0, 1e-9], frame="body"),
    "drag of spins": vv.RotationalDrag(1e-9),
    "drag": vv.LinearDrag(tau=1e9),
    "drive": vv.DrivenForce([1e-9, 0.0, 0.0], frequency=1.0),
}


@pytest.mark.parametrize("weak", WEAK)
@pytest.mark.parametrize("method", ["leapfrog", "yoshida4", "rk4"])
def test_weak_forces_that_keep_no_energy_do_not_silence_it(method: str, weak: str) -> None:
    """Spins of 1e91 came with status OK and no word, as energies told nothing."""
    if method != "rk4" and "drag" in weak:
        pytest.skip("these methods take no drag")
    scene = vv.Scene(BODY, SPRING, WEAK[weak])
    with pytest.warns(
        vv.AccuracyWarning, match=r"after .* is off by .* of itself: a step of dt = 0\.04 .* dt out"
    ) as caught:
        out = scene.run(t=[0.0, 0.5], method=method, dt=0.04)
    assert out.status is vv.Status.OK
    assert len(caught) == 1
    scene.run(t=2.0, method=method, dt=0.002)
    copies = scene.ensemble(velocity=[[[0.0, 0.0, 0.0]], [[0.1, 0.0, 0.0]]])
    with pytest.warns(vv.AccuracyWarning, match=r"in copy [01], after") as caught:
        copies.run(t=0.5, method=method, dt=0.04, threads=3)
    assert len(caught) == 1


def test_steps_are_taken_again_where_that_takes_no_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of many copies with few steps it would take as long as the run; what goes on was looked at when it began."""
    from visviva import _rigid_steps

    taken = []

    def counted(*arguments):
        taken.append(len(arguments[0]["mass"]))
        return after_a_step(*arguments)

    after_a_step = _rigid_steps.after_a_step
    monkeypatch.setattr(_rigid_steps, "after_a_step", counted)
    scene = vv.Scene(BODY, vv.AppliedTorque([0.0, 0.0, 1.0]))
    how = {"method": "rk4", "dt": 0.01}
    for copies, t, looked_at in ((4096, 0.1, True), (4097, 0.1, False), (4097, 10.0, True)):
        taken.clear()
        scene.ensemble(velocity=np.zeros((copies, 1, 3))).run(t=t, **how)
        assert taken == [copies] * 4 * looked_at
    half = scene.run(t=1.0, **how)
    taken.clear()
    half.final.run(t=2.0, **how)
    assert taken == [1, 1]


def test_a_body_that_a_torque_turns_from_rest_is_not_blamed() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        vv.Scene(BODY, vv.AppliedTorque([0.0, 0.0, 1.0])).run(t=2.0, method="rk4", dt=0.1)
        vv.Scene(BODY, vv.RotationalDrag(0.1)).run(t=2.0, method="rk4", dt=0.1)
        vv.Scene(BODY, vv.UniformField([0.0, 0.0, -1.0]), vv.LinearDrag(tau=2.0)).run(t=2.0, method="rk4", dt=0.1)
