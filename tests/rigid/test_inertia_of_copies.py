"""Ensembles whose rigid bodies have masses and moments of inertia of their own: each copy as it is alone."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from copies_elsewhere import COLUMNS, assert_same, assert_same_elsewhere

import visviva as vv

COPIES = 11
TIMES = [0.1, 0.515]
HOW: list[dict[str, Any]] = [
    {},
    {"method": "rk4", "dt": 0.01},
    {"method": "kahan_li8", "dt": 0.01},
    {"method": "moser_veselov10", "dt": 0.01},
    {"method": "verner98"},
]

PAIR = vv.RigidBodies(
    [1.0, 2.0],
    [[1.0, 2.0, 2.5], [1.0, 1.0, 1.5]],
    position=[[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]],
    angular_velocity=[[0.1, 2.0, 0.0], [0.3, 0.5, 0.0]],
)
POINTS = vv.Particles([0.5, 0.1], [[0.0, 3.0, 0.0], [1.0, -3.0, 0.0]], [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0]])
TOP = vv.RigidBody(1.0, [0.25, 0.25, 0.5], pivot=[0.1, 0.0, -1.0], angular_velocity=[0.2, 0.1, 0.0], name="top")
WEIGHT = vv.UniformField([0.0, 0.0, -1.0])
SCENES = {
    "free": vv.Scene(PAIR),
    "beside points": vv.Scene(POINTS, PAIR),
    "under gravity": vv.Scene(POINTS, PAIR, vv.Gravity(0.3)),
    "heavy top": vv.Scene(TOP, WEIGHT),
    "on a spring": vv.Scene(POINTS, PAIR, vv.AttachedSpring(0, [0.0, 0.0, 0.0], stiffness=2.0, anchor=[0.0, 0.0, 1.0])),
}


def moments(rng: np.random.Generator, number: int, *, symmetries: bool) -> np.ndarray:
    """Of bodies of three different moments, or of spheres, symmetric ones, rods and others by turns."""
    second = rng.uniform(0.02, 0.3, (COPIES, number, 3))
    kind = rng.integers(4, size=(COPIES, number)) if symmetries else np.full((COPIES, number), 2)
    second[kind == 0] = second[kind == 0][:, :1]
    second[kind == 1, 1] = second[kind == 1, 0]
    found = second.sum(axis=-1, keepdims=True) - second
    found[kind == 3] = [1.0, 1.0, 0.0]
    return found


def copies_of(name: str, *, symmetries: bool, tensors: bool = False) -> vv.EnsembleScene:
    rng = np.random.default_rng([len(name), symmetries, tensors])
    scene = SCENES[name]
    bodies = scene.rigid_bodies
    assert bodies is not None
    number = len(bodies)
    masses = np.tile(scene.particles.mass, (COPIES, 1))
    masses[:, -number:] *= rng.uniform(0.5, 2.0, (COPIES, number))
    own = moments(rng, number, symmetries=symmetries)
    if not tensors:
        return scene.ensemble(mass=masses, moments=own)
    turns = rng.normal(size=(COPIES, number, 4))
    axes = vv.rigid.matrix(turns / np.linalg.norm(turns, axis=-1, keepdims=True))
    tensors_of_copies = np.einsum("cbij,cbj,cbkj->cbik", axes, own, axes)
    return scene.ensemble(mass=masses, inertia=0.5 * (tensors_of_copies + np.swapaxes(tensors_of_copies, -1, -2)))


@pytest.mark.parametrize("how", HOW, ids=lambda how: how.get("method", "auto"))
@pytest.mark.parametrize("symmetries", [False, True], ids=["asymmetric", "all symmetries"])
@pytest.mark.parametrize("name", SCENES)
def test_members_are_as_if_alone(name: str, symmetries: bool, how: dict[str, Any]) -> None:
    copies = copies_of(name, symmetries=symmetries)
    for threads in (1, 3):
        out = copies.run(t=TIMES, record=COLUMNS, threads=threads, **how)
        for member in range(COPIES):
            assert_same(out[member], copies[member].run(t=TIMES, record=COLUMNS, **how))


@pytest.mark.parametrize("name", ["beside points", "heavy top"])
def test_tensors_of_copies(name: str) -> None:
    copies = copies_of(name, symmetries=False, tensors=True)
    out = copies.run(t=TIMES, record=COLUMNS)
    for member in range(COPIES):
        assert_same(out[member], copies[member].run(t=TIMES, record=COLUMNS))


def test_a_copy_is_the_scene_that_its_numbers_make() -> None:
    """Put together by hand, the moments about the point that is held among it."""
    own = [[0.25, 0.25, 0.5], [0.25, 0.3, 0.5], [0.25, 0.25, 0.25]]
    masses = [1.0, 2.0, 0.5]
    copies = SCENES["heavy top"].ensemble(mass=np.reshape(masses, (3, 1)), moments=np.reshape(own, (3, 1, 3)))
    out = copies.run(t=2.0)
    for member, (mass, of_one) in enumerate(zip(masses, own, strict=True)):
        body = vv.RigidBody(mass, of_one, pivot=[0.1, 0.0, -1.0], angular_velocity=[0.2, 0.1, 0.0], name="top")
        alone = vv.Scene(body, WEIGHT)
        assert copies[member] == alone
        assert_same(out[member], alone.run(t=2.0), COLUMNS[:4])


def test_a_torque_spins_up_what_has_less_inertia_faster() -> None:
    """ω = τ t / I about a principal axis, and exp(−c t / I) of a spin that drag takes."""
    inertia = np.geomspace(0.1, 10.0, 17)
    own = np.multiply.outer(inertia, [[1.0, 1.2, 1.0]])
    wheel = vv.RigidBody(1.0, [1.0, 1.2, 1.0])
    out = vv.Scene(wheel, vv.AppliedTorque([0.0, 0.0, 0.5])).ensemble(moments=own).run(t=2.0, rtol=1e-12)
    # Of the tolerance.
    assert out.angular_velocity[:, -1, 0, 2] == pytest.approx(1.0 / inertia, rel=1e-11, abs=0.0)
    spinning = vv.Scene(vv.RigidBody(1.0, [1.0, 1.2, 1.0], angular_velocity=[0, 0, 3.0]), vv.RotationalDrag(0.1))
    out = spinning.ensemble(moments=own).run(t=2.0, rtol=1e-12)
    assert out.angular_velocity[:, -1, 0, 2] == pytest.approx(3.0 * np.exp(-0.2 / inertia), rel=1e-11, abs=0.0)


def test_a_free_body_wobbles_at_the_rate_of_its_moments() -> None:
    """Ω = (I₃ − I₁) ω₃ / I₁ about the axis of a symmetric body (Goldstein, § 5.6)."""
    axial = np.linspace(0.5, 1.9, 15)
    own = np.stack([np.ones(15), np.ones(15), axial], axis=-1)[:, None]
    body = vv.RigidBody(1.0, [1.0, 1.0, 1.5], angular_velocity=[0.1, 0.0, 2.0])
    out = vv.Scene(body).ensemble(moments=own).run(t=5.0)
    turned = 10.0 * (axial - 1.0)
    spin = out.angular_velocity[:, -1, 0]
    # Roundings of an angle of up to nine radians.
    assert spin[:, 0] == pytest.approx(0.1 * np.cos(turned), rel=0.0, abs=1e-15)
    assert spin[:, 1] == pytest.approx(0.1 * np.sin(turned), rel=0.0, abs=1e-15)


@pytest.mark.parametrize("symmetries", [False, True], ids=["asymmetric", "all symmetries"])
@pytest.mark.parametrize("how", [HOW[0], HOW[2]], ids=["auto", "kahan_li8"])
def test_elsewhere(tmp_path: Path, how: dict[str, Any], symmetries: bool) -> None:
    """Saved, pickled, cut, sent to executors and run on: the same copies."""
    copies = copies_of("heavy top", symmetries=symmetries)
    assert_same_elsewhere(copies, TIMES, how, tmp_path)


def test_events_of_copies_that_run_apart() -> None:
    """Each has the table that it has alone, in the order of the copies."""
    copies = copies_of("heavy top", symmetries=True)
    falls = vv.events.plane([0.0, 0.0, -1.0], [0.0, 0.0, 1.0], body="top")
    out = copies.run(t=6.0, events=[falls])
    assert (np.diff(out.events.member) >= 0).all()
    assert len(out.events) > COPIES // 2
    for member in range(COPIES):
        alone = copies[member].run(t=6.0, events=[falls])
        assert np.array_equal(out[member].events.t, alone.events.t)
        assert np.array_equal(out[member].events.position, alone.events.position)


@pytest.mark.parametrize("how", HOW[:2], ids=["auto", "rk4"])
def test_forces_of_their_own_beside(how: dict[str, Any]) -> None:
    """Gravity in some copies and none in others, whatever their bodies are."""
    own = moments(np.random.default_rng(3), 2, symmetries=True)
    parameters = {"Gravity": {"G": np.where(np.arange(COPIES) % 4 == 0, 0.0, 0.3)}}
    copies = SCENES["under gravity"].ensemble(moments=own, parameters=parameters)
    out = copies.run(t=TIMES, **how)
    for member in range(COPIES):
        assert_same(out[member], copies[member].run(t=TIMES, **how), COLUMNS[:4])


def test_progress_of_copies_that_run_apart() -> None:
    shares: list[float] = []
    copies_of("heavy top", symmetries=True).run(t=1.0, progress=lambda done, total: shares.append(done / total))
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_stopped_by_the_keyboard() -> None:
    def stop(done: float, total: float) -> None:
        raise KeyboardInterrupt

    # Copies that take a second each, but for one that is done at once.
    copies = copies_of("heavy top", symmetries=True)
    with pytest.raises(vv.Interrupted) as stopped:
        copies.run(t=[0.0, 1.0, 1e6], progress=stop)
    kept = stopped.value.trajectory
    assert isinstance(kept, vv.EnsembleTrajectory)
    assert (kept.status == vv.Status.INTERRUPTED).any()
    # Those of the parts that had begun have come to their second row.
    begun = np.isfinite(kept.position[:, 1, 0, 0])
    assert begun.any()
    alone = [copies[copy].run(t=[0.0, 1.0]).position[1] for copy in np.flatnonzero(begun)]
    np.testing.assert_allclose(kept.position[begun, 1], alone, rtol=0.0, atol=1e-9)


ONE = np.ones((2, 1, 3))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"moments": np.ones((2, 1, 2))}, r"moments: expected shape \(B, 1, 3\), got \(2, 1, 2\)"),
        ({"inertia": ONE}, r"inertia: expected shape \(B, 1, 3, 3\), got \(2, 1, 3\)"),
        ({"moments": [[[1, 2, 2.0]], [[1, 2, 9.0]]]}, r"moments: expected moments of which none .*\(top of copy 1\)"),
        ({"moments": ONE, "inertia": np.ones((2, 1, 3, 3))}, "moments: expected moments or inertia .* got both"),
        ({"mass": [[2.0], [1.0]]}, "mass: expected the masses of rigid bodies as they are, or moments="),
        ({"mass": [[1.0], [0.0]], "moments": ONE}, "mass: expected positive masses .* that of top of copy 1 is 0.0"),
        ({"mass": np.ones((3, 1)), "moments": ONE}, "moments: expected 3 copies like mass, got 2"),
        ({"velocity": 0.1 * ONE * [[[0.0]], [[1.0]]]}, r"velocity: .* that of top of copy 1 is \[0\.1, 0\.1, 0\.1\]"),
        ({"moments": ONE, "velocity": 0.1 * ONE}, r"velocity: .* that of top of copy 0 is \[0\.1, 0\.1, 0\.1\]"),
        (
            {"moments": ONE, "angular_velocity": 1.7e308 * ONE * [[[0.0]], [[1.0]]]},
            r"pivot: expected a center whose speed is within float64 \(top of copy 1\)",
        ),
    ],
)
def test_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(vv.InvalidInput, match=message):
        SCENES["heavy top"].ensemble(**given)


def test_refused_without_bodies_and_on_rods() -> None:
    with pytest.raises(vv.InvalidInput, match="moments: expected None: the scene has no rigid bodies"):
        vv.problems.kepler(e=0.5).scene.ensemble(moments=ONE)
    with pytest.raises(vv.InvalidInput, match=r"no spin about the axis of a rod, .* that of body 0 of copy 1 is 2\.0"):
        vv.Scene(vv.RigidBody(1.0, [1, 1, 1], angular_velocity=[0, 1, 2])).ensemble(moments=[[[1, 1, 1]], [[1, 1, 0]]])
    driven = vv.Scene(vv.RigidBody(1.0, [1, 1, 1]), vv.AppliedTorque([0, 0, 1], body=0, frame="body"))
    with pytest.raises(vv.InvalidInput, match="torque: expected a torque across the axis of body 0 of copy 1, a rod"):
        driven.ensemble(moments=[[[1, 1, 1.0]], [[1, 1, 0.0]]])


@pytest.mark.parametrize("copy", [1, 3])
def test_a_warning_names_the_copy_by_its_place_among_all(copy: int) -> None:
    top = vv.RigidBody(
        1.0,
        moments=[2.0, 2.0, 3.0],
        angular_velocity=[0.3, 0.2, 1.0],
        pivot=[0.0, 0.0, -1.0],
        orientation=[0.6, 0, 0, 0.8],
    )
    # Symmetric and asymmetric tops run apart; rk4 with three radians a step loses the energy of an asymmetric one.
    kinds = np.array([[[2.0, 2.0, 3.0]], [[2.0, 2.5, 3.0]]] * 2)
    spins = np.tile([0.3, 0.2, 1.0], (4, 1, 1))
    spins[copy] = 10.0
    copies = vv.Scene(top, vv.UniformField((0.0, 0.0, -1.0))).ensemble(moments=kinds, angular_velocity=spins)
    with pytest.warns(vv.AccuracyWarning, match=f"in copy {copy}, the energy"):
        copies.run(20.0, method="rk4", dt=0.3)


def test_moments_whose_ratio_is_no_number_are_told_without_a_complaint_of_numpy() -> None:
    top = vv.Scene(vv.RigidBody(1.0, [1.0, 2.0, 2.5], pivot=[0.0, 0.0, -1.0]), WEIGHT)
    copies = top.ensemble(moments=[[[1.0, 2.0, 2.5]], [[5e-324, 5e-324, 5e-324]]])
    with pytest.warns(vv.AccuracyWarning, match="of copy 1 is inf times the least"):
        copies.run(1.0)


def test_copies_that_have_not_begun_are_where_the_scene_has_them() -> None:
    """Their first row had orientations and spins of zero, and so energies of another scene."""

    def stop(done: float, total: float) -> None:
        raise KeyboardInterrupt

    body = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 0.7, 0.3], pivot=[0.0, 0.0, -1.0])
    spins = np.random.default_rng(0).uniform(0.1, 1.0, (200, 1, 3))
    copies = vv.Scene(body, WEIGHT).ensemble(angular_velocity=spins)
    with pytest.raises(vv.Interrupted) as stopped:
        copies.run(t=[0.0, 1.0, 1e6], progress=stop)
    kept = stopped.value.trajectory
    assert np.isnan(kept.position[:, 2]).all(axis=(1, 2)).any()
    # What is recorded of a start is it, to the rounding of a turn of axes and back.
    np.testing.assert_allclose(kept.angular_velocity[:, 0], spins, rtol=1e-14, atol=0.0)
    np.testing.assert_array_equal(np.linalg.norm(kept.orientation[:, 0], axis=-1), 1.0)
