"""What methods declare, seen by `vv.audit` on a scene, and what it refuses.

Bounds: quadratures and sums to some ten roundings, and times those of a motion there and back: e = 0.9 amplifies a
phase a hundred times; a collinear motion is unstable, to 3e-14 at its end.
"""

import numpy as np
import pytest

import visviva as vv

METHODS = vv.methods()
FIXED = [method for method in METHODS if not method.adaptive]
BODIES = vv.Particles(
    [1.0, 0.5, 0.25],
    [[0.0, 0.0, 0.0], [1.0, 0.25, 0.0], [0.0, -1.0, 0.5]],
    [[0.0, 0.0, 0.25], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
)
SCENE = vv.Scene(BODIES, vv.Gravity(1.0, softening=0.5), t0=0.25)
END = 1.25
LINES = [method for method in FIXED if method.name != "stormer13"]


@pytest.mark.parametrize("method", [method for method in LINES if method.order <= 4], ids=lambda method: method.name)
def test_the_order_is_what_is_declared(method: vv.Method) -> None:
    """Where the steps are short enough; of orders above, whole tables are proved in the core."""
    # The leading error of this one is so small that short steps show rounding.
    dt = 1 / 16 if method.name == "blanes_moan_rkn4" else 1 / 64
    assert vv.audit.order(SCENE, END, method=method, dt=dt) == pytest.approx(method.order, abs=0.2)


def test_an_order_is_seen_where_it_is_more_than_rounding() -> None:
    with pytest.raises(vv.ConvergenceError, match="which is rounding; give a longer dt"):
        vv.audit.order(SCENE, END, method="yoshida8", dt=1 / 512)
    with pytest.raises(vv.InvalidInput, match="dop853"):
        vv.audit.order(SCENE, END, method="dop853", dt=1 / 64)


@pytest.mark.parametrize("method", LINES, ids=lambda method: method.name)
def test_a_map_is_as_symplectic_and_as_reversible_as_is_declared(method: vv.Method) -> None:
    """Of steps so long that what is not, is seen: an error of the step, against differences that see 1e-10."""
    dt = {1: 1 / 64, 8: 1 / 2, 10: 1 / 2}.get(method.order, 1 / 4)
    away = vv.audit.symplecticity(SCENE, END, method=method, dt=dt)
    # Boris' method turns nothing here, and is the leapfrog.
    assert (away < 1e-9) == method.symplectic or method.name.startswith("boris")
    back = vv.audit.reversal(SCENE, END, method=method, dt=dt)
    assert (back < 1e-14) == method.reversible


def test_a_closed_form_comes_back_and_drag_has_no_way_back() -> None:
    assert vv.audit.reversal(vv.problems.kepler(e=0.9).scene, 20.0) < 1e-11
    with pytest.raises(vv.InvalidInput, match="cannot be reversed"):
        vv.audit.reversal(vv.Scene(BODIES, vv.LinearDrag(1.0)), 1.0)


def test_what_has_other_momenta_is_refused() -> None:
    with pytest.raises(vv.InvalidInput, match="do not look at velocities") as caught:
        vv.audit.symplecticity(vv.Scene(BODIES, vv.UniformMagneticField([0, 0, 1.0])), 1.0, method="boris", dt=0.25)
    assert caught.value.argument == "forces"
    massless = vv.Scene(vv.Particles([1.0, 0.0], np.eye(3)[:2]), vv.Gravity(1.0))
    with pytest.raises(vv.InvalidInput, match="all have mass"):
        vv.audit.symplecticity(massless, 1.0, method="leapfrog", dt=0.25)


def test_the_impulse_is_the_momentum_that_a_drive_gives() -> None:
    """Half a sine, and a pulse that has no name."""
    drive = vv.DrivenForce([3.0, -1.0, 0.5], frequency=2.0, phase=0.3)
    span = (0.25, 2.0)
    given = vv.audit.impulse(lambda t: np.cos(2.0 * t + 0.3)[:, None] * np.array(drive.amplitude), span)
    scene = vv.Scene(BODIES[[0]], drive, t0=span[0])
    gained = scene.run(t=span[1]).final.invariants().momentum - scene.invariants().momentum
    np.testing.assert_allclose(given, gained, rtol=0, atol=1e-13)
    pulse = vv.audit.impulse(lambda t: np.exp(-(t**2))[:, None] * [1.0, 0.0, -2.0], (-8.0, 8.0))
    np.testing.assert_allclose(pulse, np.sqrt(np.pi) * np.array([1.0, 0.0, -2.0]), rtol=0, atol=1e-12)
    np.testing.assert_allclose(vv.audit.impulse(lambda t: np.ones((len(t), 3)), (2.0, -1.0)), -3.0, rtol=1e-14)
    for jump in (0.123, 0.5003, 0.25, 0.9):
        with pytest.raises(vv.ConvergenceError, match=r"the impulse does not settle .*: the force jumps"):
            vv.audit.impulse(lambda t, jump=jump: np.sign(t - jump)[:, None] * np.ones(3), (0.0, 1.0))
    with pytest.raises(vv.InvalidInput, match="force"):
        vv.audit.impulse(lambda t: np.ones(len(t)), (0.0, 1.0))


@pytest.mark.parametrize("width", [1e-2, 1e-3, 3e-4, 1e-4, 3e-5])
@pytest.mark.parametrize("start", [0.0, 1e5])
def test_a_short_blow_is_found(width: float, start: float) -> None:
    for middle in np.linspace(0.1, 0.9, 9) + 0.0333:

        def blow(t: np.ndarray, middle: float = middle) -> np.ndarray:
            return np.outer(np.exp(-(((t - start - middle) / width) ** 2)), [1.0, 0.0, -2.0])

        found = vv.audit.impulse(blow, (start, start + 1.0), rtol=1e-12 if start == 0.0 else 1e-6)
        wanted = np.sqrt(np.pi) * width * np.array([1.0, 0.0, -2.0])
        # The times themselves are rounded, far from 0.
        np.testing.assert_allclose(found, wanted, rtol=1e-11 if start == 0.0 else 1e-5)


@pytest.mark.parametrize(
    "force",
    [
        vv.Gravity(2.0),
        vv.Coulomb([1.0, -3.0], k=0.5),
        vv.Spring(0, 1, k=4.0, length=0.3),
        vv.PairPotential(vv.potentials.Yukawa(k=-1.0, length=2.0)),
    ],
)
def test_masses_are_told_by_their_accelerations(force: vv.forces.Force) -> None:
    """At every time of a run, whatever the two do to each other; and from all the times together."""
    pair = vv.Particles([0.5, 1.75], BODIES.position[:2], BODIES.velocity[:2])
    out = vv.Scene(pair, force).run(t=np.linspace(0.0, 0.5, 6), method="dop853")
    states = zip(out.position, out.velocity, strict=True)
    a = np.array([vv.Scene(vv.Particles(pair.mass, *state), force).acceleration() for state in states])
    for one in a:
        assert vv.audit.mass_ratio(*one) == pytest.approx(3.5, rel=1e-14, abs=0)
    assert vv.audit.mass_ratio(a[:, 0], a[:, 1]) == pytest.approx(3.5, rel=1e-14, abs=0)
    assert vv.audit.mass_ratio(1e200 * a[:, 0], 1e200 * a[:, 1]) == pytest.approx(3.5, rel=1e-14, abs=0)


def test_accelerations_that_are_no_action_and_reaction_are_refused() -> None:
    for second in ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0]):
        with pytest.raises(vv.InvalidInput, match="action and reaction") as caught:
            vv.audit.mass_ratio([1.0, 0.0, 0.0], second)
        assert caught.value.argument == "second"
    with pytest.raises(vv.InvalidInput, match="as many of both"):
        vv.audit.mass_ratio(np.ones((2, 3)), np.ones((3, 3)))


def test_a_line_that_turns_is_rigid_and_a_spring_is_not() -> None:
    problem = vv.problems.euler_collinear()
    out = problem.scene.run(t=np.linspace(0.0, problem.t_end, 5), method="dop853", rtol=1e-13)
    changes = vv.audit.rigidity(out)
    assert changes.shape == (5, 3)
    assert not changes[0].any()
    assert np.abs(changes).max() < 4e-13
    spring = vv.Scene(BODIES[:2], vv.Spring(0, 1, k=4.0, length=0.5)).run(t=np.linspace(0.0, 1.0, 5))
    apart = np.linalg.norm(spring.position[:, 0] - spring.position[:, 1], axis=1)
    np.testing.assert_allclose(vv.audit.rigidity(spring, [(1, 0)])[:, 0], apart / apart[0] - 1.0, rtol=0, atol=1e-15)
    for pairs in ([(0, 0)], [(0, 2)], [(-1, 0)]):
        with pytest.raises(vv.InvalidInput, match="two of the bodies 0 to 1"):
            vv.audit.rigidity(spring, pairs)


def test_methods_are_judged_by_bodies() -> None:
    nobody = vv.Scene(vv.Particles(np.zeros(0), np.zeros((0, 3))), vv.Gravity(1.0))
    for asked in (vv.audit.symplecticity, vv.audit.reversal, vv.audit.order):
        with pytest.raises(vv.InvalidInput, match=r"^scene: expected bodies"):
            asked(nobody, 1.0, method="leapfrog", dt=0.1)  # type: ignore[operator]


class TestRigidBodies:
    """A body with three moments, which a torque turns, and whose center goes straight on: methods do nothing else."""

    BODY = vv.RigidBody(2.0, [1.0, 2.0, 2.5], velocity=[0.1, 0, 0], angular_velocity=[0.1, 1.0, 0.2])
    SCENE = vv.Scene(BODY, vv.AppliedTorque([0.3, 0.1, -0.2]))

    @pytest.mark.parametrize(("method", "order"), [("leapfrog", 2), ("yoshida4", 4), ("rk4", 4)])
    def test_the_order_is_that_of_orientations(self, method: str, order: int) -> None:
        assert vv.audit.order(self.SCENE, 4.0, method=method, dt=1 / 8) == pytest.approx(order, abs=0.1, rel=0)

    @pytest.mark.parametrize("method", ["leapfrog", "yoshida4"])
    def test_a_reversible_method_turns_back(self, method: str) -> None:
        # Some hundred turns of quaternions, each rounded to 1e-16.
        assert vv.audit.reversal(self.SCENE, 4.0, method=method, dt=1 / 8) < 2e-14

    def test_the_angle_by_which_another_does_not(self) -> None:
        end = self.SCENE.run(t=4.0, method="rk4", dt=1 / 8).final
        back = end.reversed().run(t=8.0, method="rk4", dt=1 / 8).final
        assert back.rigid_bodies is not None
        start = np.linalg.inv(vv.rigid.matrix(self.BODY.orientation[0]))
        turned = vv.rigid.matrix(back.rigid_bodies.orientation[0]) @ start
        # sin θ from the antisymmetric part of a rotation, which keeps the digits of a small angle.
        sine = np.linalg.norm((turned - turned.T)[[2, 0, 1], [1, 2, 0]]) / 2.0
        assert sine > 1e-8
        told = vv.audit.reversal(self.SCENE, 4.0, method="rk4", dt=1 / 8)
        assert told == pytest.approx(np.arcsin(sine), rel=1e-7, abs=0)
