"""Promises that were broken where two features meet, each with the plainest scene that showed it.

Every test is named after the promise and stands alone; `test_laws.py` states the same promises for scenes at random.

Bounds: sums of a few forces are the same but for the order of some ten additions, 1e-14; a distance of 1e-3 at places
of 1e9 is what their spacing of 1e-7 still tells.
"""

from typing import Any

import numpy as np
import pytest

import visviva as vv

METHODS = vv.methods()


def scattered(count: int, *, massless: int = 0, seed: int = 0) -> vv.Particles:
    """Bodies in a cube, the last ones without mass; softened gravity keeps them apart enough."""
    rng = np.random.default_rng(seed)
    mass = rng.uniform(0.5, 1.5, count) / count
    mass[count - massless :] = 0.0
    return vv.Particles(mass, rng.uniform(-1.0, 1.0, (count, 3)), rng.uniform(-0.3, 0.3, (count, 3)))


SOFT = vv.Gravity(1.0, softening=0.2)
FIELD = vv.UniformField([0.1, 0.2, -1.0])
PAIR = vv.Particles([1.0, 1.0], [[0.5, 0.0, 0.0], [-0.5, 0.0, 0.0]], [[0.0, 0.7, 0.0], [0.0, -0.7, 0.0]])


def assert_members_as_alone(members: vv.EnsembleScene, **run: Any) -> None:
    together = members.run(**run)
    for index, scene in enumerate(members):
        alone = scene.run(**{key: value for key, value in run.items() if key != "threads"})
        assert together.status[index] == alone.status
        assert np.array_equal(together.position[index], alone.position), f"member {index}"
        assert np.array_equal(together.velocity[index], alone.velocity), f"member {index}"


# Members of an ensemble.


@pytest.mark.parametrize("threads", [1, 2, 3])
@pytest.mark.parametrize(("bodies", "members"), [(9, 12), (16, 5), (20, 33)])
def test_each_member_of_more_than_eight_bodies_has_its_own_masses(bodies: int, members: int, threads: int) -> None:
    start = vv.Scene(scattered(bodies), SOFT)
    mass = start.particles.mass * (1.0 + np.arange(members)[:, None] / members)
    assert_members_as_alone(start.ensemble(mass=mass), t=0.5, method="dop853", threads=threads)


def test_members_that_differ_in_what_is_massless_have_the_bits_they_have_alone() -> None:
    start = vv.Scene(scattered(12), SOFT)
    mass = np.where(np.random.default_rng(1).random((9, 12)) < 0.4, 0.0, start.particles.mass)
    assert_members_as_alone(start.ensemble(mass=mass), t=0.5, method="dop853")


def test_members_in_gravity_and_a_uniform_field_have_the_bits_they_have_alone() -> None:
    start = vv.Scene(PAIR, vv.Gravity(1.0), FIELD)
    position = PAIR.position * (1.0 + 1e-2 * np.random.default_rng(2).uniform(-1, 1, (100, 1, 1)))
    assert_members_as_alone(start.ensemble(position=position), t=3.0, method="dop853")


@pytest.mark.parametrize("field", [FIELD, vv.CentralField(vv.potentials.Yukawa(k=-1.0, length=1.0), [2.0, 0.0, 0.0])])
def test_a_body_at_rest_at_the_origin_has_the_bits_it_has_alone(field: Any) -> None:
    bodies = vv.Particles([1.0, 1.0], [[0.0, 0.0, 0.0], [700.0, 3.0, 0.0]], [[0.0, 0.0, 0.0], [30.0, 0.0, 0.0]])
    both = vv.Scene(bodies, field).run(t=2.7, method="dop853")
    alone = vv.Scene(vv.Particles([1.0], np.zeros((1, 3))), field).run(t=2.7, method="dop853")
    assert np.array_equal(both.position[:, :1], alone.position)


def test_bodies_at_rest_in_a_uniform_field_have_the_bits_they_have_alone() -> None:
    rng = np.random.default_rng(3)
    start = vv.Scene(vv.Particles(np.ones(9), rng.uniform(-1, 1, (9, 3))), FIELD)
    position = start.particles.position * (1.0 + 2.0 * np.arange(23)[:, None, None])
    assert_members_as_alone(start.ensemble(position=position), t=5.0, method="dop853")


@pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")  # of the wild one
@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.name)
@pytest.mark.parametrize("wild", [1e100, 1e120])
def test_one_wild_member_spoils_no_other(method: vv.Method, wild: float) -> None:
    start = vv.problems.figure_eight().scene
    position = np.repeat(start.particles.position[None], 9, axis=0)
    position *= 1.0 + np.arange(9)[:, None, None] / 1024.0
    tame = start.ensemble(position=position)
    position[4, 0, 0] = wild
    run: dict[str, Any] = {"t": 1.0, "method": method.name} | ({} if method.adaptive else {"dt": 1 / 64})
    among, without = start.ensemble(position=position).run(**run), tame.run(**run)
    others = np.arange(9) != 4
    assert not among.status[others].any()
    assert np.array_equal(among.position[others], without.position[others])


def test_the_plan_of_members_of_several_make_ups_says_what_runs() -> None:
    """One massive body and massless ones is a closed form; two massive bodies among three are not."""
    start = vv.Scene(scattered(3), vv.Gravity(1.0))
    members = start.ensemble(mass=[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    out = members.run(t=0.1)
    told = members.plan(t=0.1)
    assert told.closed_form == (out.stats.evaluations == 0)
    assert out.stats.method == told.method
    mixed = start.ensemble(mass=[[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]])
    calls: list[tuple[int, int]] = []
    mixed.run(t=0.1, method="leapfrog", dt=1e-4, progress=lambda done, total: calls.append((done, total)))
    assert all(done <= total for done, total in calls)


# Massless bodies.


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("massless", [200, 600])
def test_any_number_of_massless_bodies_runs_on_any_number_of_threads(massless: int, threads: int) -> None:
    bodies = scattered(3 + massless, massless=massless)
    out = vv.Scene(bodies, SOFT).run(t=0.2, method="dop853", threads=threads)
    alone = vv.Scene(vv.Particles(bodies.mass[:3], bodies.position[:3], bodies.velocity[:3]), SOFT)
    assert np.array_equal(out.position[:, :3], alone.run(t=0.2, method="dop853").position)


def test_a_massless_body_does_not_depend_on_other_massless_bodies() -> None:
    bodies = scattered(23, massless=20)
    every = vv.Scene(bodies, SOFT).run(t=0.5, method="dop853")
    for index in (3, 11, 22):
        keep = [0, 1, 2, index]
        few = vv.Scene(vv.Particles(bodies.mass[keep], bodies.position[keep], bodies.velocity[keep]), SOFT)
        assert np.array_equal(few.run(t=0.5, method="dop853").position[:, 3], every.position[:, index])


@pytest.mark.parametrize("softening", [0.0, 0.5])
def test_one_massive_body_and_a_massless_one_fall_in_a_uniform_field(softening: float) -> None:
    """Their relative motion is the one without the field."""
    bodies = vv.Particles([1.0, 0.0], [[3.0, 0.0, 0.0], [-3.0, 0.0, 0.0]])
    gravity = vv.Gravity(0.3, softening=softening)
    fallen = vv.Scene(bodies, gravity, FIELD).run(t=0.25)
    still = vv.Scene(bodies, gravity).run(t=0.25)
    apart = fallen.position[:, 1] - fallen.position[:, 0] - (still.position[:, 1] - still.position[:, 0])
    assert np.abs(apart).max() < 1e-9  # the default tolerance


def test_after_a_massless_body_collides_everything_final_is_of_one_time() -> None:
    mass, x = [1.0, 1e-3, 0.0], [[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [1.0, 0.0, 0.0]]
    scene = vv.Scene(vv.Particles(mass, x, [[0.0, 0.0, 0.0], [0.0, 0.45, 0.0], [0.0, 0.0, 0.0]]), vv.Gravity(1.0))
    with pytest.raises(vv.CloseEncounter) as caught:
        scene.run(t=3.0, method="dop853")
    final = caught.value.trajectory.final
    planets = vv.Scene(vv.Particles(mass[:2], x[:2], [[0.0, 0.0, 0.0], [0.0, 0.45, 0.0]]), vv.Gravity(1.0))
    # To the tolerance of the run: the last state reached need not be one of the planets' own steps.
    expected = planets.run(t=final.t0).position[-1]
    assert np.abs(final.particles.position[:2] - expected).max() < 1e-8


# Forces together.


@pytest.mark.parametrize(
    "forces",
    [
        (vv.Gravity(1.0), vv.Gravity(2.0)),
        (vv.Gravity(1.0), vv.Gravity(-1.0)),
        (vv.Gravity(1.0, softening=0.5), vv.Gravity(0.25, softening=0.1), vv.Gravity(2.0)),
        (FIELD, FIELD),
        (vv.CentralField(vv.potentials.Coulomb(k=1.0), [2.0, 0, 0]), vv.CentralField(vv.potentials.Coulomb(k=2.0))),
    ],
)
@pytest.mark.parametrize("count", [2, 5, 20])
def test_forces_of_one_kind_add(forces: tuple[Any, ...], count: int) -> None:
    bodies = scattered(count)
    together = vv.Scene(bodies, *forces)
    apart = [vv.Scene(bodies, force) for force in forces]
    accelerations = np.stack([scene.acceleration() for scene in apart])
    size = np.abs(accelerations).sum(axis=0).max()
    assert np.abs(together.acceleration() - accelerations.sum(axis=0)).max() < 8 * np.finfo(float).eps * size
    kinetic = vv.Scene(bodies).invariants().energy
    energy = sum(scene.invariants().energy - kinetic for scene in apart) + kinetic
    assert together.invariants().energy == pytest.approx(energy, rel=1e-14, abs=0)


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.name)
@pytest.mark.parametrize("count", [2, 3, 5])
def test_repulsion_by_a_negative_constant_is_integrated_alike_by_every_method(method: vv.Method, count: int) -> None:
    scene = vv.Scene(scattered(count), vv.Gravity(-0.3, softening=0.5))
    step = 1 / 4096
    run: dict[str, Any] = {"rtol": 1e-12} if method.adaptive else {"dt": step}
    reference = scene.run(t=0.25, method="kahan_li8", dt=1 / 256).position
    # Accelerations and rates are below 1: an error of order p is below hᵖ, and round-off.
    allowed = 1e-10 if method.adaptive else step**method.order + 1e-13
    assert np.abs(scene.run(t=0.25, method=method.name, **run).position - reference).max() < allowed


@pytest.mark.parametrize("g", [1.0, 100.0])
def test_relative_motion_does_not_feel_a_uniform_field(g: float) -> None:
    run: dict[str, Any] = {"t": 100.0, "method": "dop853", "rtol": 1e-9}
    free, fallen = (
        vv.Scene(PAIR, vv.Gravity(1.0), vv.UniformField([0.0, 0.0, -pull])).run(**run).position[-1] for pull in (0.0, g)
    )
    # Alone 1.9e-7 from the truth at this tolerance.
    assert np.abs((fallen[1] - fallen[0]) - (free[1] - free[0])).max() < 1e-6


# Far away, and in any units.


@pytest.mark.parametrize("count", [64, 65, 100])
def test_the_energy_of_bodies_far_away_does_not_drift_by_their_rounding(count: int) -> None:
    bodies = scattered(count)
    here = vv.Scene(bodies, SOFT)
    there = vv.Scene(vv.Particles(bodies.mass, bodies.position + 1e9, bodies.velocity), SOFT)
    run: dict[str, Any] = {"t": np.arange(11) / 64.0, "method": "kahan_li8", "dt": 1 / 64, "record": ("energy",)}
    drift = [np.abs(scene.run(**run).energy / scene.run(**run).energy[0] - 1.0).max() for scene in (here, there)]
    assert drift[1] <= drift[0] + 1e-14


PUSHES: dict[str, tuple[Any, ...]] = {
    "drive": (vv.DrivenForce([1.0, 0.5, -0.25], frequency=3.0),),
    "drag": (vv.LinearDrag(tau=0.5),),
    "magnetic field": (vv.UniformMagneticField([0.5, -1.0, 3.0], charge=1.0),),
    "drive, drag and field": (vv.DrivenForce([1.0, 0.0, 0.0], frequency=3.0), vv.LinearDrag(tau=2.0), FIELD),
    "gravity and a drive": (SOFT, vv.DrivenForce([1.0, 0.5, -0.25], frequency=3.0)),
    "gravity and drag": (SOFT, vv.LinearDrag(tau=0.5)),
    "springs and a field": (vv.Spring(0, 1, k=2.0, length=0.5), vv.UniformMagneticField([0.0, 0.0, 3.0], charge=1.0)),
}


@pytest.mark.parametrize("forces", PUSHES.values(), ids=PUSHES)
@pytest.mark.parametrize("method", ["dop853", "dormand_prince54", "rk4"])
def test_forces_that_depend_on_no_place_act_alike_far_away(method: str, forces: tuple[Any, ...]) -> None:
    """The origin goes with the bodies: as many steps, and what they moved by, to a rounding of where they are."""
    there = vv.Scene(vv.Particles(*(getattr(scattered(4), name) for name in ("mass", "position", "velocity"))), *forces)
    there = there.shifted(position=[1e9, -2e9, 5e8])
    # Where they are after a rounding, brought back without one.
    here = there.shifted(position=[-1e9, 2e9, -5e8])
    run: dict[str, Any] = {"t": 2.0, "method": method} | ({"rtol": 1e-12} if method != "rk4" else {"dt": 1 / 512})
    far, near = there.run(**run), here.run(**run)
    moved = [out.position[-1] - out.position[0] for out in (far, near)]
    # A tolerance of 1e-12 of lengths about 1 kept in some hundred steps, the fourth order of 1/512, and one rounding.
    assert np.abs(moved[0] - moved[1]).max() <= 1e-9 + 4e-16 * 2e9
    assert np.abs(far.velocity - near.velocity).max() <= 1e-9
    assert abs(far.stats.steps - near.stats.steps) <= 0.1 * near.stats.steps + 2


@pytest.mark.parametrize("rate", [1.0, 50.0])
def test_the_steps_of_a_gyrating_charge_do_not_grow_with_the_length_of_the_run(rate: float) -> None:
    """Its size is the radius of its path, not the way that it goes: ten times the time, ten times the steps."""
    body = vv.Particles([1.0], [[7e8, 0.0, 0.0]], [[rate, 0.0, 0.0]])
    charge = vv.Scene(body, vv.UniformMagneticField([0.0, 0.0, rate], charge=1.0))
    short, long = (charge.run(t=time / rate, method="dop853", rtol=1e-9).stats.steps for time in (20.0, 200.0))
    assert 9 * short <= long <= 11 * short


@pytest.mark.parametrize("far", [0.0, 1e9])
def test_a_driven_body_swings_as_it_should_however_far(far: float) -> None:
    """x = x0 + (v0 - F/mω sin φ) t + F/mω² (cos φ - cos(ωt + φ)) under the force F cos(ωt + φ)."""
    force, frequency, phase, end = 2.0, 3.0, 0.5, 40.0
    body = vv.Particles([4.0], [[far, 0.0, 0.0]], [[0.25, 0.0, 0.0]])
    out = vv.Scene(body, vv.DrivenForce([force, 0.0, 0.0], frequency=frequency, phase=phase)).run(
        t=end, method="dop853", rtol=1e-12, max_steps=2000
    )
    swing = force / 4.0 / frequency**2
    drift = 0.25 - swing * frequency * np.sin(phase)
    expected = drift * end + swing * (np.cos(phase) - np.cos(frequency * end + phase))
    # Some hundred steps, each to 1e-12 of the swing, and one rounding of the place.
    assert abs(out.position[-1, 0, 0] - out.position[0, 0, 0] - expected) < 1e-10 + 3e-16 * far


@pytest.mark.parametrize("powers", [(-332, 332, -166), (-332, 332, -332), (330, -330, 330), (0, -540, 0), (0, 500, 0)])
def test_energies_are_right_in_any_units_in_which_they_are_numbers(powers: tuple[int, int, int]) -> None:
    length, mass, time = (2.0**power for power in powers)
    start = vv.problems.figure_eight().scene
    unit = powers[1] + 2 * (powers[0] - powers[2])
    scaled = start.rescaled(length=length, mass=mass, time=time)
    energy = scaled.run(t=time, method="leapfrog", dt=time / 64, record=("energy",)).energy
    expected = start.run(t=1.0, method="leapfrog", dt=1 / 64, record=("energy",)).energy
    assert np.array_equal(np.ldexp(energy, -unit), expected)


def test_free_motion_is_a_number_wherever_it_is_one() -> None:
    out = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1e301, 1e-5, 0.0]])).run(t=[0.0, 1.0])
    assert out.position[-1, 0].tolist() == [1e301, 1e-5, 0.0]


# Stopping and going on.


# What went wrong is said as it is.


@pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")
@pytest.mark.parametrize("why", [{"max_step": 5e-324}, {"atol": 1e308}])
def test_a_step_that_falls_to_zero_far_from_any_encounter_is_not_called_one(why: dict[str, float]) -> None:
    scene = vv.Scene(scattered(3), SOFT)
    try:
        assert np.isfinite(scene.run(t=1.0, method="dop853", max_steps=10**5, **why).position).all()  # type: ignore[arg-type]
    except vv.CloseEncounter as error:
        pytest.fail(str(error))
    except vv.Error:
        pass


# Not taylor, which takes no step over which its coefficients are no numbers: 22 powers of 1e50 are none.
@pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")  # none is asked for
@pytest.mark.parametrize("method", [method.name for method in METHODS if method.adaptive and method.name != "taylor"])
@pytest.mark.parametrize("end", [1.0, 1e8, -1e50, 1e70])
def test_where_any_error_is_allowed_the_run_is_one_step(method: str, end: float) -> None:
    out = vv.Scene(scattered(12), vv.Gravity(1.0)).run(t=end, method=method, atol=1e308)
    assert (out.status, out.stats.steps) == (vv.Status.OK, 1)
    assert np.isfinite(out.position).all()
    halved = vv.Scene(scattered(12), vv.Gravity(1.0)).run(t=end, method=method, atol=1e308, max_step=abs(end) / 2)
    assert (halved.status, halved.stats.steps) == (vv.Status.OK, 2)


def test_steps_that_leave_the_range_of_numbers_are_told_of_as_such() -> None:
    """Allowed an error of 1e150, bodies move by 1e160 and more, and the square of that is no number."""
    with pytest.raises(vv.ConvergenceError, match=r"beyond float64 \(lower them, or set max_step\)") as caught:
        vv.Scene(scattered(12), vv.Gravity(1.0)).run(t=1e100, method="dop853", atol=1e150)
    # It did not fail before it began.
    assert caught.value.trajectory.final.t0 > 1e70


@pytest.mark.parametrize("mass", [[1e300, 1e300], [1e300, 0.0], [1e300, 0.0, 0.0], [0.0, 1e300]])
def test_a_product_beyond_numbers_is_refused_with_both_its_factors(mass: list[float]) -> None:
    scene = vv.Scene(vv.Particles(mass, np.eye(3)[: len(mass)]), vv.Gravity(1e10))
    with pytest.raises(vv.InvalidInput, match=r"^mass: .*G = 10000000000\.0 and a mass of 1e\+300") as caught:
        scene.run(t=1e-200)
    assert caught.value.argument == "mass"


def test_an_absolute_tolerance_of_zero_advances_with_a_body_at_the_center_of_mass() -> None:
    position = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]
    scene = vv.Scene(vv.Particles([1.0, 0.1, 0.1], position, [[0, 0, 0], [0, 1.0, 0], [0, -1.0, 0]]), SOFT)
    out = scene.run(t=1.0, method="dop853", rtol=1e-9, atol=0.0, max_steps=10_000)
    assert out.status == vv.Status.OK


def test_the_distance_of_a_close_encounter_is_told_also_far_from_the_origin() -> None:
    bodies = vv.Particles([1.0, 1.0, 1e-9], np.array([[-1.0, 0, 0], [1.0, 0, 0], [0, 50.0, 0]]) + 1e9)
    with pytest.raises(vv.CloseEncounter) as caught:
        vv.Scene(bodies, vv.Gravity(1.0)).run(t=5.0, method="dop853", rtol=1e-10)
    assert 0.0 < caught.value.distance < 1e-3
