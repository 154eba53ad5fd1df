"""`vv.audit` of forces on some of a scene's bodies, on copies with masses of their own, and where bodies merge.

Works are those by which kinetic energies grow. Bounds: constant forces and linear fields are integrated exactly by the
rule, to some roundings of their terms; differences lose 1e-12 twice to rounding.
"""

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv

BODIES = vv.Particles([1.0, 2.0, 4.0], np.eye(3), np.eye(3)[::-1] / 2.0, names=["a", "b", "c"])
TIMES = np.linspace(0.0, 2.0, 9)


def fall(bodies: Any = None, size: float = 1.0) -> vv.forces.ExpressedForce:
    return vv.ExpressionForce(force=lambda r, v, t: [0, 0, -size], bodies=bodies)


def turning(bodies: Any) -> vv.forces.ExpressedForce:
    return vv.ExpressionForce(force=lambda r, v, t: [-r[1], r[0], 0 * r[2]], bodies=bodies)


def gain(out: vv.Trajectory) -> Any:
    kinetic = 0.5 * out.scene.particles.mass * (out.velocity**2).sum(axis=-1)
    return kinetic - kinetic[0]


@pytest.mark.parametrize("bodies", [None, 0, [0], [1], 2, [2, 0], [0, 0], "b", ["c", "a"], ["b", 0]])
def test_work_is_done_on_the_bodies_on_which_the_force_acts(bodies: Any) -> None:
    for force in (fall(bodies), vv.ExpressionForce(acceleration=lambda r, v, t: [0, v[0], -1.0], bodies=bodies)):
        out = vv.Scene(BODIES, force).run(t=TIMES, method="dop853", rtol=1e-13)
        # The cubic between times is that of a motion of third degree at most.
        np.testing.assert_allclose(vv.audit.work_along(out, force), gain(out), rtol=0, atol=2e-13)


def test_works_of_several_forces_on_several_bodies_add_up() -> None:
    """Constant ones on some and on all, one that looks at the time, drag of all, and one that is between bodies."""
    pulse = vv.ExpressionForce(force=lambda r, v, t: [np.sin(t), 0, 0], bodies=[1, 2])
    drag = vv.ExpressionForce(acceleration=lambda r, v, t: [-0.1 * each for each in v], bodies="c")
    forces = (fall([1]), fall("a", 2.0), pulse, drag, vv.LinearDrag(tau=5.0))
    errors = []
    for times in (41, 81):
        out = vv.Scene(BODIES, *forces).run(t=np.linspace(0, 2, times), method="dop853", rtol=1e-13)
        works = [vv.audit.work_along(out, force) for force in forces]
        errors.append(np.abs(sum(works) - gain(out)).max())
        on = [np.flatnonzero(np.abs(work).max(axis=0)).tolist() for work in works]
        assert on == [[1], [0], [1, 2], [2], [0, 1, 2]]
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.2, abs=0)  # fourth order
    assert errors[1] < 1e-8


def test_a_force_that_looks_at_the_time_is_taken_at_each() -> None:
    force = vv.ExpressionForce(force=lambda r, v, t: [t, 0, 0], bodies=[1])
    out = vv.Scene(BODIES, force).run(t=TIMES, method="dop853", rtol=1e-13)
    # The middle of a cubic motion, and a power of third degree, are exact.
    np.testing.assert_allclose(vv.audit.work_along(out, force), gain(out), rtol=0, atol=2e-13)


def test_copies_of_an_ensemble_have_their_own_masses_and_bodies() -> None:
    force = fall("b")
    copies = vv.Scene(BODIES, force).ensemble(
        mass=[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], parameters={force: {"bodies": [["b"], ["a", "c"]]}}
    )
    out = copies.run(t=TIMES)
    for copy, on in ((0, [1]), (1, [0, 2])):
        own = out[copy]
        work = vv.audit.work_along(own, own.scene.forces[0])
        np.testing.assert_allclose(work, gain(own), rtol=0, atol=1e-13)
        assert np.flatnonzero(work[-1]).tolist() == on
    with pytest.raises(vv.InvalidInput, match=r"trajectory.*out\[i\]"):
        vv.audit.work_along(out, force)  # type: ignore[arg-type]


def test_rigid_bodies_by_their_names() -> None:
    box = vv.RigidBody(2.0, [1.0, 2.0, 3.0], velocity=[1.0, 0, 0], angular_velocity=[0.1, 1.0, 0.2], name="box")
    force = fall("box")
    out = vv.Scene(BODIES, box, force).run(t=TIMES)
    work = vv.audit.work_along(out, force)
    np.testing.assert_allclose(work, gain(out), rtol=0, atol=1e-13)
    assert np.flatnonzero(work[-1]).tolist() == [3]


@pytest.mark.parametrize("bodies", [3, [0, 7], "d"])
def test_bodies_that_the_run_does_not_have_are_refused(bodies: Any) -> None:
    out = vv.Scene(BODIES).run(t=TIMES)
    with pytest.raises(vv.InvalidInput, match=r"bodies: expected (indices of the 3|one of the) bodies"):
        vv.audit.work_along(out, fall(bodies))


@pytest.mark.parametrize("bodies", [[0], [1], [7], "unknown", None])
def test_the_field_is_what_a_body_feels_on_which_the_force_acts(bodies: Any) -> None:
    """(-y, x): curl 2 everywhere, and the work 2π around the unit circle."""
    force = turning(bodies)
    places = np.array([[1.0, 2.0, 0.0], [3.0, 4.0, 0.0]])
    assert vv.audit.field(force)(places).tolist() == [[-2.0, 1.0, 0.0], [-4.0, 3.0, 0.0]]
    assert vv.audit.field(force)(places[1:]).tolist() == [[-4.0, 3.0, 0.0]]
    for some in (places, places[:1]):
        np.testing.assert_allclose(vv.audit.curl(force, some).value, [[0, 0, 2.0]] * len(some), rtol=0, atol=1e-10)
    around = vv.audit.work(force, lambda s: np.stack([np.cos(2 * np.pi * s), np.sin(2 * np.pi * s), 0 * s], axis=-1))
    assert around == pytest.approx(2.0 * np.pi, rel=4e-14, abs=0)


@pytest.mark.parametrize(
    "force",
    [
        vv.UniformElectricField([1.0, 0, 0], charge=[1.0, 2.0]),
        vv.Drag(density=1.0, viscosity=1.0, radius=[0.1, 0.2]),
        vv.QuadraticDrag([0.5, 0.2]),
    ],
    ids=lambda force: type(force).__name__,
)
def test_a_number_for_each_body_makes_no_field_of_places(force: vv.forces.Force) -> None:
    """Places are no bodies: two of them were once given the charges of two bodies."""
    for count in (1, 2, 3):
        with pytest.raises(vv.InvalidInput, match=r"expected one (charge|radius|coefficient) .*got 2"):
            vv.audit.field(force)(np.zeros((count, 3)))


def test_one_number_is_that_of_the_body() -> None:
    for charge in (2.0, [2.0]):
        force = vv.UniformElectricField([1.0, 0, 0], charge=charge)
        assert vv.audit.field(force)(np.zeros((2, 3))).tolist() == [[2.0, 0, 0], [2.0, 0, 0]]


class TestMergers:
    """A body of mass 2 at rest is hit by one of mass 1, at t = 0.8; what remains has the mass of both."""

    BODIES = vv.Particles([1.0, 2.0], [[0, 0, 0], [1.0, 0, 0]], [[1.0, 0, 0], [0, 0, 0]], radius=[0.1, 0.1])

    @pytest.mark.parametrize("on", [0, 1])
    def test_an_acceleration_of_some_acts_on_those_that_remain(self, on: int) -> None:
        """Of the lighter one, which is gone, nothing more is done; of the heavier one all is done on both."""
        force = vv.ExpressionForce(acceleration=lambda r, v, t: [0, 0.125, 0], bodies=[on])
        out = vv.Scene(self.BODIES, force).run(t=TIMES, collisions="merge")
        work = vv.audit.work_along(out, force)
        assert 0.75 < out.collisions.t[0] < 1.0
        # Times 3 and 4 are around the merger, and the rule is exact for constant accelerations.
        np.testing.assert_allclose(work[:4], gain(out)[:4], rtol=0, atol=1e-13)
        remains = 1.5 * (out.velocity[4:, 1] ** 2).sum(axis=1)
        np.testing.assert_allclose(work[4:, 1] - work[4, 1], remains - remains[0], rtol=0, atol=1e-13)
        np.testing.assert_array_equal(work[4:, 0], work[4, 0])

    def test_a_field_of_mass_does_the_work_on_both(self) -> None:
        force = vv.UniformField([0, 0, -1.0])
        out = vv.Scene(self.BODIES, force).run(t=TIMES, collisions="merge")
        work = vv.audit.work_along(out, force)
        # Both fall alike: 3 t²/2 in all, and after the merger none on what is gone.
        np.testing.assert_allclose(work.sum(axis=1), 1.5 * TIMES**2, rtol=0, atol=1e-13)
        assert work[-1, 0] == work[4, 0]

    def test_what_says_nothing_of_bodies_that_merge_is_refused(self) -> None:
        out = vv.Scene(self.BODIES).run(t=TIMES, collisions="merge")
        for force in (fall(), fall([0]), vv.QuadraticDrag([1.0, 2.0])):
            with pytest.raises(vv.InvalidInput, match=r"force: .* bodies of the run merge"):
                vv.audit.work_along(out, force)


class TestAllBodies:
    def test_are_none(self) -> None:
        force = fall()
        assert force.bodies is None
        assert fall(bodies=force.bodies) == force
        assert hash(fall(bodies=force.bodies)) == hash(force)
        assert fall(bodies=[0]) != force
        again = vv.ExpressionForce(force=lambda r, v, t: [0, 0, -1.0], bodies=fall([0, 1]).bodies)
        assert again == fall([0, 1])

    def test_pickles_and_files_keep_them(self, tmp_path: Path) -> None:
        for force in (fall(), fall([1]), fall([0, 2])):
            assert pickle.loads(pickle.dumps(force)) == force
            vv.Scene(BODIES, force).run(t=1.0).save(tmp_path / "run.npz")
            assert vv.load(tmp_path / "run.npz").scene.forces == (force,)

    def test_were_an_empty_array_in_earlier_pickles(self) -> None:
        """A pickle calls the class with all its values."""
        force = fall()
        build, values = force.__reduce__()[:2]  # type: ignore[misc]
        assert build(*values[:-1], np.array([], dtype=np.int64)) == force

    def test_none_of_them_is_refused(self) -> None:
        force = fall([0])
        for asked in (
            lambda: fall([]),
            lambda: vv.forces.ExpressedForce(**(force._values() | {"bodies": ()})),
            lambda: vv.Scene(BODIES, force).ensemble(parameters={force: {"bodies": [[0], []]}}),
            lambda: vv.Scene(BODIES, force).ensemble(parameters={force: {"bodies": [[0], np.array([], dtype=int)]}}),
        ):
            with pytest.raises(vv.InvalidInput, match="expected those on which it acts, got none of them"):
                asked()

    def test_may_be_those_of_one_copy(self) -> None:
        force = fall([0])
        copies = vv.Scene(BODIES, force).ensemble(parameters={force: {"bodies": [None, [1]]}})
        down = [[-1.0, -0.5, -0.25], [0.0, -0.5, 0.0]]
        speeds = copies.run(t=1.0).velocity[:, -1, :, 2] - BODIES.velocity[:, 2]
        np.testing.assert_allclose(speeds, down, rtol=0, atol=1e-13)
