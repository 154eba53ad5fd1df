"""Particles, forces and scenes as values: checked, frozen, equal, picklable."""

import pickle
from dataclasses import FrozenInstanceError

import numpy as np
import pytest

import visviva as vv


def pair(**changes: object) -> vv.Particles:
    state = {"mass": [1.0, 2.0], "position": [[0, 0, 0], [1, 0, 0]], "velocity": [[0, 0, 0], [0, 1, 0]]}
    return vv.Particles(**(state | changes))  # type: ignore[arg-type]


def test_particles_are_read_only_copies() -> None:
    mass = np.array([1.0, 2.0])
    particles = pair(mass=mass)
    mass[0] = 7.0
    assert particles.mass[0] == 1.0
    for array in (particles.mass, particles.position, particles.velocity):
        assert array.dtype == np.float64
        assert array.flags.c_contiguous
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0
    with pytest.raises(FrozenInstanceError):
        particles.mass = mass  # type: ignore[misc]


def test_a_read_only_view_of_a_writeable_array_is_copied() -> None:
    mass = np.array([1.0, 2.0])
    view = mass.view()
    view.flags.writeable = False
    particles = pair(mass=view)
    mass[0] = 7.0
    assert particles.mass[0] == 1.0


def test_velocity_defaults_to_rest() -> None:
    assert not vv.Particles([1.0], [[1.0, 2.0, 3.0]]).velocity.any()


@pytest.mark.parametrize(
    ("changes", "argument"),
    [
        ({"mass": [[1.0, 2.0]]}, "mass"),
        ({"mass": 1.0}, "mass"),
        ({"mass": [1.0, np.nan]}, "mass"),
        ({"mass": [1.0, -1.0]}, "mass"),
        ({"mass": [1.0 + 0j, 2.0]}, "mass"),
        ({"position": [[0, 0, 0]]}, "position"),
        ({"position": [[0, 0], [1, 0]]}, "position"),
        ({"position": [[0, 0, 0], [np.inf, 0, 0]]}, "position"),
        ({"velocity": [[0, 0, 0]]}, "velocity"),
        ({"velocity": np.zeros((3, 2))}, "velocity"),
        ({"velocity": [["a", "b", "c"]] * 2}, "velocity"),
    ],
)
def test_particles_refuse_by_name(changes: dict[str, object], argument: str) -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        pair(**changes)
    assert caught.value.argument == argument
    assert "expected" in str(caught.value)


FORCES = [
    vv.Gravity(G=1.0),
    vv.Gravity(G=6.6743e-11, softening=0.5),
    vv.UniformField([0.0, 0.0, -9.80665]),
    vv.CentralField(vv.potentials.Coulomb(k=-1.0)),
    vv.CentralField(vv.potentials.Yukawa(k=2.0, length=0.5), center=[1.0, 2.0, 3.0]),
    vv.CentralField(vv.potentials.LennardJones(epsilon=1.0, sigma=1.5)),
    vv.LinearDrag(tau=3.0),
    vv.UniformMagneticField([0.0, 1.0, -2.0], charge=[1.0, -3.0]),
    vv.UniformMagneticField([0.0, 1.0, 2.0]),
    vv.DrivenForce([1.0, 0.0, -2.0], frequency=3.0, phase=0.5),
    vv.Spring(0, 1, k=2.0, length=0.5),
    vv.Spring([0, 1], [1, 0], k=[1.0, 2.0]),
    vv.Harmonic(k=2.0, center=[1.0, 2.0, 3.0]),
    vv.QuadraticDrag([0.5, 0.25]),
    vv.Drag(density=1.5, viscosity=0.25, radius=[0.5, 0.0]),
    vv.Drag(1.5, 0.25, 0.5, law="turton_levenspiel"),
    vv.drag.custom(lambda R: 20.0 / R + 1.0, 0.5, 64.0, density=1.5, viscosity=0.25, radius=0.5),
    vv.ExpressionForce(potential=lambda r, v, t, k: k * r[0] ** 2 * np.cos(r[1] + t), parameters={"k": 2.0}),
    vv.UniformElectricField([0.0, 1.0, -2.0], charge=[1.0, -3.0]),
    vv.RotatingFrame([0.0, 1.0, -2.0], center=[1.0, 0.0, 0.5]),
    vv.Damper([0, 1], [1, 0], c=[1.0, 2.0]),
    vv.Coulomb([1.0, -2.0], k=3.0),
    vv.Coulomb(1.0, k=3.0, softening=0.5),
    vv.Oblate(0, G=1.0, J2=1e-3, radius=0.5, axis=[0.0, 0.6, 0.8]),
    vv.Oblate([0, 1], G=1.0, J2=[1e-3, 2e-3], radius=0.5, axis=[0.0, 0.0, 2.0], J4=-1e-5),
    vv.PostNewtonian(0, G=1.0, c=1e4),
    vv.PairPotential(vv.potentials.Yukawa(k=2.0, length=0.5)),
]


@pytest.mark.parametrize("force", FORCES, ids=repr)
def test_everything_pickles_compares_and_hashes(force: vv.forces.Force) -> None:
    scene = vv.Scene(pair(), force, t0=2.0)
    again = pickle.loads(pickle.dumps(scene))
    assert again == scene
    assert hash(again) == hash(scene)
    assert again.forces == (force,)
    assert again.t0 == 2.0
    assert not again.particles.mass.flags.writeable
    assert scene != vv.Scene(pair(), force)
    assert scene != vv.Scene(pair(mass=[1.0, 3.0]), force, t0=2.0)


def test_forces_are_those_of_the_registry() -> None:
    assert {type(force) for force in FORCES} == set(vv.forces._BY_NAME.values())
    with pytest.raises(vv.InvalidInput, match=r"add-a-force") as caught:

        class Mine(vv.forces.Force):
            pass

    assert caught.value.argument == "Force"


@pytest.mark.parametrize("force", FORCES, ids=repr)
def test_a_force_is_documented_by_its_declaration(force: vv.forces.Force) -> None:
    document = type(force).__doc__ or ""
    assert "centre" not in document
    for heading in ("Parameters", "Raises", "References", "Examples"):
        assert f"\n{heading}\n{'-' * len(heading)}\n" in document
    assert all(f"\n{name} : " in document for name in force._values())


@pytest.mark.parametrize(
    "force", [force for force in FORCES if type(force) not in (vv.SampledDrag, vv.ExpressedForce)], ids=repr
)
def test_repr_evaluates(force: vv.forces.Force) -> None:
    # Two classes are called Coulomb, a force and a potential.
    within, own = vars(vv.potentials), vars(vv.forces)
    names = within | own if isinstance(force, vv.Coulomb) else own | within
    assert eval(repr(force), names) == force


@pytest.mark.parametrize(
    ("make", "argument"),
    [
        (lambda: vv.Gravity(G=np.nan), "G"),
        (lambda: vv.Gravity(G="1"), "G"),  # type: ignore[arg-type]
        (lambda: vv.Gravity(G=1.0, softening=np.inf), "softening"),
        (lambda: vv.UniformField([0.0, 0.0]), "g"),
        (lambda: vv.CentralField("coulomb"), "potential"),  # type: ignore[arg-type]
        (lambda: vv.CentralField(vv.potentials.Coulomb(1.0), center=[0.0]), "center"),
        (lambda: vv.potentials.Yukawa(k=1.0, length=0.0), "length"),
        (lambda: vv.potentials.LennardJones(epsilon=1.0, sigma=-1.0), "sigma"),
        (lambda: vv.Scene(vv.Gravity(1.0)), "parts"),
        (lambda: vv.Scene(pair(), pair()), "parts"),
        (lambda: vv.Scene(pair(), 3.0), "parts"),  # type: ignore[arg-type]
        (lambda: vv.Scene(pair(), t0=np.nan), "t0"),
    ],
)
def test_parts_refuse_by_name(make: object, argument: str) -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        make()  # type: ignore[operator]
    assert caught.value.argument == argument


def test_events_are_refused_by_name() -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        vv.Scene(pair(), vv.Gravity(1.0)).run(t=1.0, events=[object()])
    assert caught.value.argument == "events"


@pytest.mark.parametrize(
    ("arguments", "argument"),
    [
        ({"t": None}, "t"),
        ({"t": "1"}, "t"),
        ({"t": 1j}, "t"),
        ({"t": [[1.0]]}, "t"),
        ({"t": [1.0, np.nan]}, "t"),
        ({"t": [1.0, [2.0]]}, "t"),
        ({"t": 1.0, "dt": "0.1"}, "dt"),
        ({"t": 1.0, "rtol": "1e-9"}, "rtol"),
        ({"t": 1.0, "atol": 1j}, "atol"),
        ({"t": 1.0, "max_step": [1.0, 2.0]}, "max_step"),
        ({"t": 1.0, "max_steps": 1.5}, "max_steps"),
        ({"t": 1.0, "max_steps": True}, "max_steps"),
        ({"t": 1.0, "method": 4}, "method"),
        ({"t": 1.0, "record": [4]}, "record"),
        ({"t": 1.0, "threads": 1.0}, "threads"),
        ({"t": 1.0, "progress": "yes"}, "progress"),
    ],
)
def test_run_refuses_the_wrong_type_by_name(arguments: dict[str, object], argument: str) -> None:
    scene = vv.Scene(pair(), vv.Gravity(1.0))
    with pytest.raises(vv.InvalidInput) as caught:
        scene.run(**arguments)  # type: ignore[arg-type]
    assert caught.value.argument == argument


def test_names_are_all_there() -> None:
    for name in vv.__all__:
        assert getattr(vv, name) is not None
    assert set(vv.__all__) <= set(dir(vv))
    with pytest.raises(AttributeError, match="no attribute 'Gravitation'"):
        vv.Gravitation  # type: ignore[attr-defined]  # noqa: B018
