"""Steps that are equal in another time: conics to round-off, orders in time, no drift, and what is refused.

Bounds: energies of a conic that is exact but for its times, to some ten roundings of their terms.
"""

from __future__ import annotations

import numpy as np
import pytest

import visviva as vv

TRANSFORMING = [method for method in vv.methods() if method.time_transformation]
# What is composed of leapfrogs, which keep two bodies on their conic.
LEAPS = {"leapfrog", "leapfrog_dkd", "yoshida4", "yoshida6", "yoshida8", "kahan_li6", "kahan_li8"}
LEAPS |= {f"sofroniou_spaletta{order}" for order in (6, 8, 10)}
MONITORS = ["potential_energy", "distance"]


def kepler(eccentricity: float, *, second: float = 0.25) -> vv.Scene:
    """Two bodies of mass 1 and `second` at the far end of an orbit with semi-major axis 1."""
    mass = np.array([1.0, second])
    total = mass.sum()
    apart, speed = 1.0 + eccentricity, np.sqrt(total * (1.0 - eccentricity) / (1.0 + eccentricity))
    share = np.array([-second, 1.0]) / total
    position, velocity = np.zeros((2, 2, 3))
    position[:, 0], velocity[:, 1] = share * apart, share * speed
    return vv.Scene(vv.Particles(mass, position, velocity), vv.Gravity(1.0))


PERIOD = 2.0 * np.pi / np.sqrt(1.25)


def shape(out: vv.Trajectory) -> np.ndarray:
    """The eccentricity vector and the angular momentum of the relative orbit at every output."""
    x, v = (array[:, 1] - array[:, 0] for array in (out.position, out.velocity))
    spin = np.cross(x, v)
    return np.hstack([np.cross(v, spin) / 1.25 - x / np.linalg.norm(x, axis=1)[:, None], spin])


@pytest.mark.parametrize("monitor", MONITORS)
@pytest.mark.parametrize("eccentricity", [0.9, 0.99, 0.999])
@pytest.mark.parametrize("method", ["leapfrog", "leapfrog_dkd", "kahan_li8"])
def test_two_bodies_stay_on_their_conic(method: str, eccentricity: float, monitor: str) -> None:
    # The first step is of the slowest part of the orbit: about 80 steps an orbit, whatever the eccentricity.
    t = np.linspace(0.0, 50.0 * PERIOD, 501)
    out = kepler(eccentricity).run(t, method=method, dt=PERIOD / 40, time_transformation=monitor)
    # Round-off of 4000 steps, each of some ulps, adds up like a random walk: 64 steps' worth, measured 7e-14.
    assert np.abs(shape(out) - shape(out)[0]).max() < 2e-13
    assert out.stats.steps < 50 * 90


@pytest.mark.parametrize("monitor", MONITORS)
@pytest.mark.parametrize("method", TRANSFORMING, ids=lambda method: method.name)
def test_the_time_has_the_order_of_the_method(method: vv.Method, monitor: str) -> None:
    # At the end of a part of an orbit, where the error is not small by symmetry.
    scene, end = kepler(0.5), 2.3
    exact = scene.run(end).final.particles.position
    fewest = {2: 60, 4: 40, 6: 30, 8: 16, 10: 12}[method.order]
    errors = [
        np.abs(
            scene.run(end, method=method, dt=2.3 / steps, time_transformation=monitor).final.particles.position - exact
        ).max()
        for steps in (fewest, 2 * fewest)
    ]
    order = np.log2(errors[0] / errors[1])
    # Two steps so far apart tell the order to about a tenth of it; round-off is 1e-15.
    assert errors[1] < 3e-15 or order > method.order - 0.1 * method.order - 0.3, (errors, order)


@pytest.mark.parametrize("monitor", MONITORS)
def test_the_energy_does_not_drift(monitor: str) -> None:
    # What is no composition of leapfrogs leaves the conic by its order and comes back.
    t = np.linspace(0.0, 400.0 * PERIOD, 801)
    out = kepler(0.9).run(t, method="mclachlan4", dt=PERIOD / 40, time_transformation=monitor, record="energy")
    error = out.energy / out.energy[0] - 1.0
    early, late = (np.abs(part).max() for part in np.split(error, [400])[:2])
    assert late < 1.05 * early
    # There is an error of fourth order to see (2.9e-5 at 40 steps to a turn), which does not grow.
    assert 1e-6 < early < 1e-4


def test_two_close_passages_of_the_pythagorean_problem() -> None:
    problem = vv.problems.pythagorean()
    t = np.linspace(0.0, 10.0, 41)
    reference = problem.scene.run(t, method="dop853", rtol=1e-13)
    for monitor in MONITORS:
        out = problem.scene.run(
            t, method="kahan_li8", dt=0.03, time_transformation=monitor, record=("position", "energy")
        )
        # Equal steps in time of the same number lose all digits at the passages (0.01 apart at t = 1.88 and others).
        assert np.abs(out.position - reference.position).max() < 1e-6
        assert np.abs(out.energy / out.energy[0] - 1.0).max() < 1e-9


@pytest.mark.parametrize("monitor", MONITORS)
def test_the_figure_of_eight_is_what_equal_steps_in_time_make_of_it(monitor: str) -> None:
    scene, t = vv.problems.figure_eight().scene, np.linspace(0.0, 7.0, 8)
    plain = scene.run(t, method="kahan_li8", dt=0.01)
    other = scene.run(t, method="kahan_li8", dt=0.01, time_transformation=monitor)
    # The truncation error of order 8 at that step is below 1e-13 for both.
    assert np.abs(other.position - plain.position).max() < 1e-12


def test_a_massless_body_is_as_if_alone_and_its_encounters_are_resolved() -> None:
    pair = kepler(0.6)
    mass = np.append(pair.particles.mass, [0.0, 0.0])
    # The second one falls past the lighter body at a hundredth of its distance from it.
    position = np.vstack([pair.particles.position, [[0.0, 5.0, 1.0], [1.38, 0.3, 0.0]]])
    velocity = np.vstack([pair.particles.velocity, [[0.4, 0.0, 0.0], [0.0, -0.2, 0.01]]])
    how = {"method": "kahan_li8", "dt": 0.01, "time_transformation": "distance"}
    t = np.linspace(0.0, 3.0, 13)

    def run(bodies: list[int]) -> vv.Trajectory:
        chosen = vv.Particles(mass[bodies], position[bodies], velocity[bodies])
        return vv.Scene(chosen, vv.Gravity(1.0)).run(t, **how)

    four, massive = run([0, 1, 2, 3]), run([0, 1])
    assert np.array_equal(four.position[:, :2], massive.position)
    for body in (2, 3):
        assert np.array_equal(four.position[:, body], run([0, 1, body]).position[:, 2])
    everything = vv.Scene(vv.Particles(mass, position, velocity), vv.Gravity(1.0))
    reference = everything.run(t, method="dop853", rtol=1e-13)
    # Past a body at a hundredth of the distance an error of 1e-11 grows a hundredfold; measured 9e-10.
    assert np.abs(four.position - reference.position).max() < 1e-8


def test_a_fixed_center_and_other_forces() -> None:
    start = vv.Particles([2.0], [[1.9, 0.0, 0.1]], [[0.0, 0.2, 0.0]])
    t = np.linspace(0.0, 12.0, 25)
    field = vv.CentralField(vv.potentials.Coulomb(k=-2.0))
    for monitor in MONITORS:
        out = vv.Scene(start, field).run(t, method="leapfrog", dt=0.05, time_transformation=monitor, record="energy")
        assert np.abs(out.energy / out.energy[0] - 1.0).max() < 1e-14
    scene = vv.Scene(start, field, vv.DrivenForce([0.01, 0.02, 0.0], frequency=0.7))
    out = scene.run(t, method="kahan_li8", dt=0.02, time_transformation="distance")
    reference = scene.run(t, method="dop853", rtol=1e-13)
    # Both errors, of order 8 and of rtol; measured 4e-12.
    assert np.abs(out.position - reference.position).max() < 2e-11


def test_backward_and_back() -> None:
    scene = kepler(0.9)
    how = {"method": "kahan_li8", "dt": 0.02, "time_transformation": "potential_energy"}
    there = scene.run(1.3 * PERIOD, **how).final
    back = there.run(0.0, **how).final
    # Each way errs in the time by its order; the steps are not those of the way there.
    assert np.abs(back.particles.position - scene.particles.position).max() < 1e-9
    flipped = vv.Scene(
        vv.Particles(scene.particles.mass, scene.particles.position, -scene.particles.velocity), vv.Gravity(1.0)
    )
    forward, backward = flipped.run(1.3, **how).final, scene.run(-1.3, **how).final
    assert np.array_equal(forward.particles.position, backward.particles.position)


def test_an_event_is_found_on_the_solution() -> None:
    event = vv.events.apsis(0, 1)
    out = kepler(0.9).run(
        3.2 * PERIOD, method="kahan_li8", dt=0.02, time_transformation="potential_energy", events=[event]
    )
    times = out.events.t
    # Rounding of times up to 17: two spacings of 3.6e-15.
    assert np.allclose(times, PERIOD * 0.5 * np.arange(len(times)) + times[0], rtol=0.0, atol=8e-15)
    assert len(times) in (6, 7)


def test_what_does_not_go_together_is_refused_by_name() -> None:
    scene = kepler(0.5)
    gravity = vv.Gravity(1.0)
    for method in vv.methods():
        if not method.time_transformation:
            how = {} if method.adaptive else {"dt": 0.01}
            with pytest.raises(vv.InvalidInput, match=r"expected one of .*leapfrog.*kahan_li8") as refused:
                scene.run(1.0, method=method, time_transformation="distance", **how)
            assert refused.value.argument == "time_transformation"
    with pytest.raises(vv.InvalidInput, match="time_transformation: auto chooses its steps"):
        scene.run(1.0, time_transformation="distance")
    with pytest.raises(vv.InvalidInput, match="potential_energy"):
        scene.run(1.0, method="leapfrog", dt=0.01, time_transformation="potential")  # type: ignore[arg-type]
    with pytest.raises(vv.InvalidInput, match="dt: leapfrog has a fixed step"):
        scene.run(1.0, method="leapfrog", time_transformation="distance")
    how = {"method": "leapfrog", "dt": 0.01, "time_transformation": "potential_energy"}
    spring = vv.Scene(scene.particles, gravity, vv.Spring([0], [1], k=[1.0], length=[1.0]))
    with pytest.raises(vv.InvalidInput, match="expected no Spring; use distance"):
        spring.run(1.0, **how)
    massless = vv.Scene(vv.Particles([1.0, 1.0, 0.0], np.eye(3)), gravity)
    with pytest.raises(vv.InvalidInput, match=r"does not see massless bodies.* use distance"):
        massless.plan(1.0, **how)
    with pytest.raises(vv.InvalidInput, match="massless bodies"):
        scene.ensemble(mass=[[1.0, 0.25], [1.0, 0.0]]).run(1.0, **how)
    with pytest.raises(vv.InvalidInput, match="watches bodies that all act on each other"):
        vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]]), vv.Harmonic(1.0)).run(1.0, **how)
    repelled = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]]), vv.CentralField(vv.potentials.Coulomb(k=1.0)))
    with pytest.raises(vv.InvalidInput, match="expected no CentralField"):
        repelled.run(1.0, **how)
    assert repelled.run(1.0, **how | {"time_transformation": "distance"}).status == 0


def test_collisions_are_refused() -> None:
    pair = kepler(0.5).particles
    spheres = vv.Scene(vv.Particles(pair.mass, pair.position, pair.velocity, radius=0.1), vv.Gravity(1.0))
    how = {"method": "leapfrog", "dt": 0.01, "time_transformation": "distance", "collisions": "bounce"}
    for asked in (spheres.plan, spheres.run, kepler(0.5).run):
        with pytest.raises(vv.InvalidInput, match="time_transformation: expected None beside collisions"):
            asked(1.0, **how)


@pytest.mark.parametrize("asked", [{"dt": [0.1, 0.2]}, {"dt": 0.1, "max_step": 0.2}, {"dt": 0.1, "atol": 1e-9}])
def test_a_naive_change_of_steps_is_refused_with_an_explanation(asked: dict[str, object]) -> None:
    with pytest.raises(vv.InvalidInput, match=r"is no symplectic map, and .* energy drifts.*time_transformation"):
        kepler(0.5).run(1.0, method="leapfrog", **asked)  # type: ignore[arg-type]


def test_two_bodies_pass_through_a_collision_as_the_closed_form_does() -> None:
    # An orbit of eccentricity 1, which is on its conic like any other: nine collisions in that time.
    head_on = vv.Scene(vv.Particles([1.0, 1.0], [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]), vv.Gravity(1.0))
    t = np.linspace(0.0, 10.0, 11)
    exact = head_on.run(t)
    for monitor in MONITORS:
        out = head_on.run(t, method="kahan_li8", dt=0.01, time_transformation=monitor)
        # Velocities at the collision are infinite, and W with them: what its rounding leaves is lost to the time.
        assert np.abs(out.position - exact.position).max() < 1e-5


def test_steps_that_end_are_told() -> None:
    scene = kepler(0.999)
    with pytest.raises(vv.ConvergenceError, match="max_steps"):
        scene.run(10.0, method="leapfrog", dt=0.01, time_transformation="distance", max_steps=100)
    far = vv.Scene(scene.particles, vv.Gravity(1.0), t0=1e17)
    with pytest.raises(vv.InvalidInput, match="a step that changes the time"):
        far.run(2e17, method="leapfrog", dt=0.01, time_transformation="distance")


def test_the_plan_tells() -> None:
    plan = kepler(0.5).plan(1.0, method="leapfrog", dt=0.01, time_transformation="distance")
    assert any(row[:2] == ("time transformation", "distance") for row in plan.rows)
    assert "0.01 at the start" in str(plan)


@pytest.mark.parametrize("method", ["leapfrog", "kahan_li8"])
@pytest.mark.parametrize("potential", [vv.potentials.Plummer(-1.0, 1.0), vv.potentials.Plummer(-8.0, 2.0)], ids=repr)
def test_bodies_pass_through_the_center_of_a_smooth_well(method: str, potential: vv.potentials.Potential) -> None:
    """Where the potential is smooth, so are the steps: Ω is softened by its length, of a field and between bodies."""
    falling = vv.Particles([1.0], [[1.0, 0, 0]])
    pair = vv.Particles([1.0, 1.0], [[0.5, 0, 0], [-0.5, 0, 0]])
    for scene in (vv.Scene(falling, vv.CentralField(potential)), vv.Scene(pair, vv.PairPotential(potential))):
        right = scene.run(t=10.0, method="verner98", rtol=1e-13)
        out = scene.run(t=10.0, method=method, dt=0.005, time_transformation="distance")
        # Leapfrog errs by dt² times some of the ten oscillations.
        bound = 2e-4 if method == "leapfrog" else 1e-11
        np.testing.assert_allclose(out.position[-1], right.position[-1], rtol=0, atol=bound)


def test_the_harder_of_two_fields_about_one_point_is_watched() -> None:
    """A charge in a soft well: it is the charge that a body comes close to."""
    body = vv.Particles([1.0], [[1.0, 0, 0]], [[0, 0.05, 0]])
    fields = [vv.CentralField(vv.potentials.Plummer(-1.0, 1.0)), vv.CentralField(vv.potentials.Coulomb(-1.0))]
    right = vv.Scene(body, *fields).run(t=2.0, method="verner98", rtol=1e-13)
    for order in (fields, fields[::-1]):
        out = vv.Scene(body, *order).run(t=2.0, method="kahan_li8", dt=0.002, time_transformation="distance")
        np.testing.assert_allclose(out.position[-1], right.position[-1], rtol=0, atol=1e-9)
