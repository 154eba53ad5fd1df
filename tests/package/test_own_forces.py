"""Ensembles over the parameters of forces: each copy is the scene that has them alone.

Bounds: a product, 1e-15, and a circle by its closed form, 1e-14.
"""

import dataclasses
import inspect
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv

PULL = vv.Gravity(1.0)
DRAG = vv.LinearDrag(tau=1.0)
PARAMETERS: dict[Any, dict[str, Any]] = {DRAG: {"tau": [1.0, 2.0, 4.0, 2.0]}, "Gravity": {"G": [1.0, 1.0, 2.0, 1.0]}}


PAIR = vv.Particles([1.0, 2.0], [[0, 0, 0], [2.0, 0, 0]], [[0, 0.3, 0], [0, -0.3, 0.1]])


def with_strength(potential: Any, factor: float) -> Any:
    """It with its first parameter times a factor; a power law's exponent of two is in no lane."""
    name = next(iter(inspect.signature(type(potential)).parameters))
    return dataclasses.replace(potential, **{name: getattr(potential, name) * float(factor)})


def ensemble(parameters: dict[Any, dict[str, Any]] = PARAMETERS) -> vv.EnsembleScene:
    bodies = vv.problems.figure_eight().scene.particles
    return vv.Scene(bodies, PULL, DRAG).ensemble(parameters=parameters)


@pytest.mark.parametrize("method", ["rk4", "dop853", "auto"])
def test_copies_have_the_bits_that_they_have_alone(method: str) -> None:
    how: dict[str, Any] = {"dt": 0.001} if method == "rk4" else {}
    columns = ("position", "energy", "angular_momentum")
    copies = ensemble()
    out = copies.run(t=[0.5, 1.0], method=method, record=columns, **how)
    for copy, scene in enumerate(copies):
        assert scene.forces == copies.forces[copy] == out[copy].final.forces
        assert scene.forces[1] == vv.LinearDrag(tau=[1.0, 2.0, 4.0, 2.0][copy])
        alone = scene.run(t=[0.5, 1.0], method=method, record=columns, **how)
        for name in columns:
            assert np.array_equal(getattr(out, name)[copy], getattr(alone, name))
    # It goes on with those forces, to the bit where steps are fixed.
    further, whole = out.final.run(t=1.5, method=method, **how), copies.run(t=1.5, method=method, **how)
    np.testing.assert_allclose(further.position[:, -1], whole.position[:, -1], rtol=0.0 if how else 1e-7)


MEMBERS = 11
EACH = 1.0 + np.arange(MEMBERS) / 64.0
V = vv.potentials
POTENTIALS = [
    V.Coulomb(1.0), V.Yukawa(1.0, 2.0), V.LennardJones(1.0, 1.5), V.Morse(1.0, 1.0, 1.5), V.Plummer(-1.0, 0.5),
    V.Mie(1.0, 1.5, 9.0, 5.0), V.PowerLaw(1.0, 2.5), V.SoftSphere(1.0, 3.0, 2.5), V.Buckingham(1.0, 1.0, 0.5),
    V.ScreenedCoulomb(1.0, 2.0), V.ScreenedCoulomb(1.0, 2.0, "thomas_fermi"),
]  # fmt: skip
FORCES: list[tuple[vv.forces.Force, dict[str, Any]]] = [
    (vv.Gravity(1.0, softening=0.1), {"G": EACH}),
    (vv.Coulomb([1.0, -1.0, 0.0, 2.0], k=1.0), {"k": EACH, "charge": np.multiply.outer(EACH, [1.0, -1.0, 0.0, 2.0])}),
    (vv.Spring([0, 1, 2], [1, 2, 3], k=1.0, length=1.0), {"k": EACH, "length": EACH}),
    (vv.Damper([0, 1], [1, 2], c=1.0), {"c": EACH}),
    (vv.LinearDrag(1.0), {"tau": EACH}),
    (vv.QuadraticDrag(1.0), {"coefficient": EACH}),
    (
        vv.Drag(density=1.0, viscosity=0.5, radius=[0.1, 0.0, 0.2, 0.1]),
        {"density": EACH, "viscosity": EACH, "radius": np.multiply.outer(EACH, [0.1, 0.0, 0.2, 0.1])},
    ),
    (vv.UniformField([0.0, 1.0, -1.0]), {"g": np.multiply.outer(EACH, [0.0, 1.0, -1.0])}),
    (vv.UniformElectricField([0.0, 1.0, -1.0]), {"E": np.multiply.outer(EACH, [0.0, 1.0, -1.0]), "charge": EACH}),
    (vv.UniformMagneticField([1.0, 0.0, 2.0]), {"B": np.multiply.outer(EACH, [1.0, 0.0, 2.0]), "charge": EACH}),
    (vv.RotatingFrame([1.0, 0.0, 2.0]), {"omega": np.multiply.outer(EACH, [1.0, 0.0, 2.0])}),
    (vv.RotatingFrame([0.0, 0.0, 2.0]), {"center": np.multiply.outer(EACH, [1.0, 0.0, 2.0])}),
    (
        vv.DrivenForce([1.0, 0.0, 2.0], 3.0),
        {"amplitude": np.multiply.outer(EACH, [1.0, 0.0, 2.0]), "frequency": EACH, "phase": EACH},
    ),
    (vv.Harmonic(1.0), {"k": EACH, "center": np.multiply.outer(EACH, [1.0, 0.0, 2.0])}),
    *[
        (
            vv.CentralField(potential),
            {
                "potential": [with_strength(potential, x) for x in EACH],
                "center": np.multiply.outer(EACH, [0.0, 0.1, 9.0]),
            },
        )
        for potential in POTENTIALS
    ],
    *[
        (vv.PairPotential(potential), {"potential": [with_strength(potential, x) for x in EACH]})
        for potential in POTENTIALS
    ],
]


@pytest.mark.filterwarnings("ignore::visviva.errors.AccuracyWarning")  # bits are asked for, and steps are long
@pytest.mark.parametrize(
    ("force", "own"), FORCES, ids=lambda of: str(of)[:40] if isinstance(of, vv.forces.Force) else ""
)
@pytest.mark.parametrize(
    ("others", "bodies"),
    [((), 4), ((), 10), ((vv.Gravity(0.1, softening=0.5),), 4)],
    ids=["alone", "many", "attracting"],
)
def test_numbers_of_any_force_are_lane_by_lane(
    force: vv.forces.Force, own: dict[str, Any], others: tuple[vv.forces.Force, ...], bodies: int
) -> None:
    """One plan for all copies, and in their lanes the bits that they have alone, whichever falls free when."""
    rng = np.random.default_rng(3)
    if bodies > 4 and isinstance(force, vv.Coulomb | vv.Drag):
        pytest.skip("as many numbers as bodies")
    place = 2.0 * np.stack(np.unravel_index(np.arange(bodies), (3, 3, 3)), axis=-1) + rng.uniform(
        -0.2, 0.2, (bodies, 3)
    )
    start = vv.Scene(
        vv.Particles(rng.uniform(1.0, 2.0, bodies), place, rng.uniform(-0.5, 0.5, (bodies, 3))), *others, force
    )
    copies = start.ensemble(parameters={len(others): own})
    for how in (
        {"method": "dop853", "rtol": 1e-7},
        {"method": "rk4", "dt": 1 / 16},
        {"method": "leapfrog", "dt": 1 / 16},
    ):
        how |= {"t": [0.4, 1.5], "record": ("position", "velocity", "energy")}
        try:
            assert "kinds" not in str(copies.plan(**how))
        except vv.InvalidInput:  # a method that takes no velocities
            assert how["method"] == "leapfrog"
            continue
        out = copies.run(**how, threads=2)
        for copy, scene in enumerate(copies):
            alone = scene.run(**how)
            assert out.status[copy] == alone.status
            for name in ("position", "velocity", "energy"):
                assert np.array_equal(getattr(out, name)[copy], getattr(alone, name), equal_nan=True), (name, copy)


def test_what_is_no_number_is_planned_apart() -> None:
    """A term that a value of 0 leaves out, a softening, an exponent, and tables: the very same one is no difference."""
    table = V.Tabulated(np.linspace(0.5, 9.0, 30), 1.0 / np.linspace(0.5, 9.0, 30))
    start = vv.Scene(PAIR, PULL, vv.Harmonic(0.1), vv.PairPotential(table))
    pull = {"G": [1.0, 2.0, 0.0, 3.0]}
    copies = start.ensemble(parameters={0: pull | {"softening": [0.0, 0.1, 0.0, 0.1]}, 1: {"k": [0.1, 0.1, 0.2, 0.0]}})
    assert "4 of 4 kinds" in str(copies.plan(t=1.0))
    assert "3 of 2 kinds" in str(start.ensemble(parameters={0: {"G": [1.0, 2.0, 0.0]}}).plan(t=1.0))
    powers = vv.Scene(PAIR, vv.PairPotential(V.PowerLaw(1.0, 2.0)))
    laws = [V.PowerLaw(1.0, 2.0), V.PowerLaw(1.5, 2.0), V.PowerLaw(1.0, 3.0), V.Coulomb(1.0)]
    laws_of_each = powers.ensemble(parameters={0: {"potential": laws}})
    assert "4 of 3 kinds" in str(laws_of_each.plan(t=1.0, method="dop853"))
    for ensemble_of in (copies, laws_of_each):
        out = ensemble_of.run(t=1.0, method="dop853")
        for copy, scene in enumerate(ensemble_of):
            assert np.array_equal(out.position[copy], scene.run(t=1.0, method="dop853").position)


def test_events_and_massless_bodies_of_copies_with_their_own() -> None:
    """Who follows massive bodies is pulled with the copy's own G; an event's energy is that in the copy's field."""
    ring = vv.Particles([1.0, 0.0, 0.0], [[0, 0, 0], [1.0, 0, 0], [0, 2.0, 0]], [[0, 0, 0], [0, 1.0, 0], [-0.7, 0, 0]])
    start = vv.Scene(ring, PULL, vv.UniformField([0.1, 0.0, 0.0]), vv.LinearDrag(9.0))
    copies = start.ensemble(parameters={0: {"G": EACH}, 1: {"g": np.multiply.outer(EACH, [0.1, 0.0, 0.0])}})
    events = (vv.events.apsis(1, 0), vv.events.energy(-0.01))
    hows: list[dict[str, Any]] = [{"method": "dop853"}, {"method": "rk4", "dt": 0.01}]
    for how in hows:
        out = copies.run(t=9.0, events=events, **how)
        assert set(out.events.which.tolist()) == {0, 1}
        for copy, scene in enumerate(copies):
            alone = scene.run(t=9.0, events=events, **how)
            assert np.array_equal(out.position[copy], alone.position)
            assert np.array_equal(out[copy].events.t, alone.events.t)


def test_a_center_of_another_copy_is_no_singularity() -> None:
    """A body where another copy has its center is refused by none, and by its copy with its name."""
    start = vv.Scene(vv.Particles([1.0], [[1.0, 0, 0]], [[0, 1.0, 0]]), vv.CentralField(V.Coulomb(-1.0)))
    centers = [[0, 0, 0], [0, 0.5, 0]]
    places = [[[0, 0.5, 0]], [[1.0, 0, 0]]]
    assert start.ensemble(position=places, parameters={0: {"center": centers}}).run(t=0.1).status.max() == 0
    with pytest.raises(vv.InvalidInput, match=r"position\[1, 0\]"):
        start.ensemble(position=places[::-1], parameters={0: {"center": centers}}).run(t=0.1)


def test_closed_forms_are_those_of_each_copy() -> None:
    """Terminal speeds g tau, and free motion where there is no field."""
    drop = vv.Scene(vv.Particles([1.0], [[0, 0, 0]], [[1.0, 0, 0]]), vv.UniformField((0, 0, -10.0)), DRAG)
    fields, times = np.array([[0, 0, -10.0], [0, 0, -5.0], [0, 0, 0]]), [0.5, 1.0, 2.0]
    out = drop.ensemble(parameters={0: {"g": fields}, DRAG: {"tau": times}}).run(t=200.0)
    assert out.stats.evaluations == 0
    np.testing.assert_allclose(out.velocity[:, -1, 0, 2], fields[:, 2] * times, rtol=1e-15)


def test_potentials_and_states_of_their_own() -> None:
    potentials = [vv.potentials.Coulomb(k) for k in (-1.0, -2.0, -3.0)]
    start = vv.Scene(vv.Particles([1.0], [[1.0, 0, 0]], [[0, 1.0, 0]]), vv.CentralField(potentials[0]))
    circles = [[[0, speed, 0]] for speed in np.sqrt([1.0, 2.0, 3.0])]
    copies = start.ensemble(velocity=circles, parameters={0: {"potential": potentials}})
    out = copies.run(t=np.linspace(0.0, 3.0, 7))
    np.testing.assert_allclose(np.linalg.norm(out.position[:, :, 0], axis=-1), 1.0, rtol=1e-14)
    assert len(copies[1:]) == 2
    assert copies[1:][0].forces == (vv.CentralField(potentials[1]),)


def test_files_and_pickles_keep_them(tmp_path: Path) -> None:
    copies = ensemble()
    assert pickle.loads(pickle.dumps(copies)).forces == copies.forces
    out = copies.run(t=1.0)
    out.save(tmp_path / "run.npz")
    loaded = vv.load(tmp_path / "run.npz")
    assert isinstance(loaded, vv.EnsembleTrajectory)
    assert loaded.ensemble.forces == loaded.final.forces == copies.forces
    assert np.array_equal(loaded.energy, out.energy)


def test_the_plan_says_so() -> None:
    plan = str(ensemble().plan(t=1.0))
    assert "sets of forces" in plan
    assert "3  (copies have parameters of their own" in plan
    with pytest.raises(vv.InvalidInput, match="leapfrog cannot take LinearDrag"):
        ensemble().plan(t=1.0, method="leapfrog", dt=0.1)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({DRAG: {"tau": [1.0, -1.0]}}, "LinearDrag of copy 1"),
        ({DRAG: {"tua": [1.0]}}, "did you mean 'tau'"),
        ({vv.Gravity(3.0): {"G": [1.0]}}, "it has none like that"),
        ({}, "expected a dictionary"),
        ({DRAG: {}}, "expected a dictionary"),
        ({0: {"G": 1.0}}, "leading axis over the copies"),
        ({5: {"G": [1.0]}}, "below 2"),
        ({DRAG: {"tau": [1.0, 2.0]}, PULL: {"G": [1.0, 2.0, 3.0]}}, "2 copies like tau"),
    ],
)
def test_what_makes_no_sense_is_refused(parameters: dict[Any, dict[str, Any]], message: str) -> None:
    with pytest.raises(vv.InvalidInput, match=message) as refused:
        ensemble(parameters)
    assert refused.value.argument == "parameters"


def test_a_force_that_names_its_bodies_is_known_as_itself() -> None:
    """The scene keeps it with indices."""
    bodies = vv.Particles([1.0, 1e-3], [[0, 0, 0], [1.0, 0, 0]], [[0, 0, 0], [0, 1.0, 0]], names=["S", "a"])
    for force, name in (
        (vv.Oblate("S", G=1.0, J2=1e-3, radius=0.1, axis=[0, 0, 1.0]), "J2"),
        (vv.PostNewtonian("S", G=1.0, c=10.0), "G"),
        (vv.Spring("S", "a", k=1e-3), "k"),
        (vv.Damper("S", "a", c=1e-3), "c"),
    ):
        scene = vv.Scene(bodies, vv.Gravity(1.0), vv.Spring("a", "S", k=3e-3), force)
        by_itself = scene.ensemble(parameters={force: {name: [1e-3, 2e-3]}}).run(1.0)
        by_place = scene.ensemble(parameters={2: {name: [1e-3, 2e-3]}}).run(1.0)
        assert not by_itself.status.any()
        assert np.array_equal(by_itself.position, by_place.position)
    with pytest.raises(vv.InvalidInput, match="'b'"):
        scene.ensemble(parameters={vv.Spring("S", "b", k=1.0): {"k": [1.0, 2.0]}})


def test_copies_that_lose_a_force_are_planned_apart_by_their_own_numbers() -> None:
    """Without the charge two of them are gravity alone, and series know one G: one moved with that of the other."""
    bodies = vv.Particles(
        [1.0, 1.0, 0.5], [[1.0, 0, 0], [-1.0, 0, 0], [0, 3.0, 0]], [[0, 0.4, 0], [0, -0.4, 0], [0.3, 0, 0]]
    )

    def scene(constant: float, charge: float) -> vv.Scene:
        return vv.Scene(bodies, vv.Gravity(constant), vv.UniformElectricField([0, 0, 1.0], charge=charge))

    constants, charges = [1.0, 1.0, 1.5, 1.0, 1.5], [1.0, 0.0, 0.0, 2.0, 0.0]
    copies = scene(1.0, 1.0).ensemble(parameters={0: {"G": constants}, 1: {"charge": charges}})
    run = copies.run(t=3.0)
    for copy, (constant, charge) in enumerate(zip(constants, charges, strict=True)):
        assert np.array_equal(run.position[copy], scene(constant, charge).run(t=3.0).position)
