"""Collisions in ensembles, some copies of which see several and others none: every copy is what it is alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv

COPIES = 23
#: A star and three planetesimals: in some copies two of them meet, in others all or none; and dust without a radius.
MASS = [1.0, 1e-3, 2e-3, 1e-3, 0.0]
RADIUS = [0.05, 0.03, 0.04, 0.03, 0.0]
POSITION = np.array([[0, 0, 0], [1.0, 0, 0], [1.3, 0.4, 0], [-1.0, 0.2, 0], [0.0, 1.5, 0]])
VELOCITY = np.array([[0, 0, 0], [0, 1.0, 0], [-0.9, 0.2, 0], [0, -1.0, 0], [-0.8, 0, 0.1]])


def copies(*forces: vv.forces.Force, **particles: Any) -> vv.Ensemble:
    rng = np.random.default_rng(7)
    velocity = VELOCITY + 0.4 * rng.normal(size=(COPIES, 5, 3)) * (np.arange(5) > 0)[:, None]
    bodies = vv.Particles(MASS, POSITION, VELOCITY, radius=RADIUS)
    return vv.Scene(bodies, vv.Gravity(1.0, softening=0.1), *forces).ensemble(velocity=velocity, **particles)


def check(ensemble: vv.Ensemble, **how: Any) -> int:
    """Compare every copy with the same alone; how many of them had contacts."""
    with_contacts = 0
    for threads in (1, 3):
        together = ensemble.run(threads=threads, **how)
        with_contacts = 0
        for copy in range(len(ensemble)):
            single = ensemble[copy].run(threads=1, **how)
            own = together[copy]
            assert own.status == single.status == together.status[copy]
            for column in how.get("record", ("position", "velocity")):
                rows = getattr(together, column)[copy]
                np.testing.assert_array_equal(rows[: len(single.t)], getattr(single, column))
                assert np.isnan(rows[len(single.t) :]).all()
            for kind in ("mass", "radius", "position", "velocity"):
                np.testing.assert_array_equal(getattr(own.final.particles, kind), getattr(single.final.particles, kind))
            assert own.final.t0 == single.final.t0
            assert own.collisions.t.tolist() == single.collisions.t.tolist()
            for kind in ("first", "second", "survivor"):
                assert getattr(own.collisions, kind).tolist() == getattr(single.collisions, kind).tolist()
            if how.get("events"):
                assert own.events.t.tolist() == single.events.t.tolist()
                assert own.events.which.tolist() == single.events.which.tolist()
            with_contacts += len(single.collisions) > 0
        assert len(together.collisions.t) == sum(len(together[copy].collisions) for copy in range(len(ensemble)))
    return with_contacts


TIMES = np.linspace(0.0, 6.0, 13)
METHODS: list[dict[str, Any]] = [
    {"method": "leapfrog", "dt": 0.01},
    {"method": "dop853"},
    {"method": "taylor"},
    {"method": "auto"},
]
each_method = pytest.mark.parametrize("method", METHODS, ids=lambda method: method["method"])


@each_method
@pytest.mark.parametrize("rule", ["merge", "bounce", "stop"])
def test_every_copy_is_as_alone(rule: str, method: dict[str, Any]) -> None:
    found = check(copies(), t=TIMES, collisions=rule, record=("position", "velocity", "energy"), **method)
    # Or the test would compare nothing.
    assert 3 <= found <= COPIES - 3


@each_method
def test_beside_events_that_end_runs(method: dict[str, Any]) -> None:
    events = [
        vv.events.plane(point=(0, 0, 0), normal=(1, 0, 0), body=1),
        vv.events.distance(0, 2, below=0.4, terminal=True),
        vv.events.apsis(3, 0),
    ]
    assert check(copies(), t=TIMES, collisions="bounce", events=events, **method) >= 3


def test_beside_own_masses_and_forces() -> None:
    masses = np.array(MASS) * np.linspace(0.5, 1.5, COPIES)[:, None]
    ensemble = copies(vv.Oblate(0, 1.0, J2=0.01, radius=0.05, axis=[0.0, 0.0, 1.0]), mass=masses)
    assert check(ensemble, t=TIMES, collisions="merge", method="dop853") >= 3


def test_beside_radii_of_their_own() -> None:
    radii = np.array(RADIUS) * np.linspace(0.5, 1.5, COPIES)[:, None]
    assert check(copies(radius=radii), t=TIMES, collisions="merge", method="dop853") >= 3


def test_looking_for_contacts_changes_nothing_where_there_are_none() -> None:
    far = np.array([[0, 0, 0], [1.0, 0, 0], [2.0, 0, 0], [-3.0, 0, 0], [0.0, 4.0, 0]])
    bodies = vv.Particles(MASS, far, VELOCITY * [[0], [1], [0], [0.5], [0.5]], radius=RADIUS)
    ensemble = vv.Scene(bodies, vv.Gravity(1.0)).ensemble(mass=np.array(MASS) * np.linspace(0.5, 1.5, 64)[:, None])
    run = ensemble.run(t=1.0, method="leapfrog", dt=0.01, collisions="bounce")
    assert len(run.collisions.t) == 0
    assert (run.status == vv.Status.OK).all()
    np.testing.assert_array_equal(run.position, ensemble.run(t=1.0, method="leapfrog", dt=0.01).position)


@pytest.mark.parametrize("first", ["free", "bound"])
def test_copies_in_which_nothing_acts_meet_as_alone(first: str) -> None:
    """They fly straight, in closed form: beside others under forces their contacts were not seen, with status OK."""
    bodies = vv.Particles([1.0, 1e-3], [[0, 0, 0], [1.0, 0, 0]], [[0, 0, 0], [-1.0, 0, 0]], radius=[0.1, 0.1])
    scene = vv.Scene(bodies, vv.Gravity(1.0))
    free, bound = [0.0, 0.0], [1.0, 1e-3]
    masses = [free, bound, bound] if first == "free" else [bound, free, bound]
    for ensemble in (
        scene.ensemble(mass=masses),
        scene.ensemble(parameters={"Gravity": {"G": [sum(mass) for mass in masses]}}),
    ):
        run = ensemble.run(t=2.0, collisions="stop")
        assert (run.status == vv.Status.STOPPED).all()
        for copy, mass in enumerate(masses):
            assert run[copy].collisions.t.tolist() == ensemble[copy].run(t=2.0, collisions="stop").collisions.t.tolist()
            if mass == free:
                # The distance is 1 − t, to the sum of the radii.
                assert run[copy].collisions.t == pytest.approx([0.8], rel=1e-15, abs=0)


@pytest.mark.parametrize("method", [{"method": "leapfrog", "dt": 0.01}, {"method": "dop853"}])
@pytest.mark.parametrize(("massive", "massless", "copies"), [(10, 0, 9), (30, 0, 4), (3, 300, 3)])
def test_more_bodies_than_share_lanes(massive: int, massless: int, copies: int, method: dict[str, Any]) -> None:
    """Ten are looked at in lanes over steps, thirty and hundreds of massless ones by a sweep; masses are their own."""
    rng = np.random.default_rng(massive)
    count = massive + massless
    mass = np.r_[rng.uniform(0.5, 1.0, massive) / massive, np.zeros(massless)]
    radius = np.r_[np.full(massive, 0.04), np.zeros(massless)]
    place, velocity = rng.normal(size=(count, 3)), 0.3 * rng.normal(size=(count, 3))
    scene = vv.Scene(vv.Particles(mass, place, velocity, radius=radius), vv.Gravity(1.0, softening=0.05))
    own = {"mass": mass * np.linspace(0.8, 1.2, copies)[:, None]}
    ensemble = scene.ensemble(velocity=velocity + 0.05 * rng.normal(size=(copies, count, 3)), **own)
    # Or the test would compare nothing.
    assert check(ensemble, t=np.linspace(0.0, 2.0, 5), collisions="merge", **method) >= 2
