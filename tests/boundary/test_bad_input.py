"""The table of bad input: what was written, the argument that is refused, and what the message says.

Each line is typed as a user would type it. The laws over random input are in `tests/laws/test_refusals.py`; unknown
keywords in `test_keywords.py`.
"""

import os
import re
from dataclasses import FrozenInstanceError

import numpy as np
import pytest

import visviva as vv

COULOMB = vv.potentials.Coulomb(1.0)
BEAM = {"beam_energy": 1.0, "masses": (1, 4), "b_max": 1.0, "n_events": 10, "seed": 1}
APART = [[0, 0, 0], [1, 0, 0]]
NAMES = {
    "np": np,
    "vv": vv,
    "P": vv.Particles,
    "apart": APART,
    "coulomb": COULOMB,
    "scene": vv.Scene(vv.Particles([1, 1], APART), vv.Gravity(1.0)),
    "center": vv.Scene(vv.Particles([1], [[1, 0, 0]]), vv.CentralField(vv.potentials.Coulomb(-1.0))),
    "copies": vv.Scene(vv.Particles([1, 1], APART), vv.Gravity(1.0)).ensemble(mass=[[1, 1], [1, 2]]),
    "mc": lambda potential=COULOMB, **given: vv.scattering.monte_carlo(potential, **(BEAM | given)),
}

TABLE = r"""
P([1, 1], [[0, 0], [1, 0]])                         | position    | expected shape \(N, 3\) with N = 2 as in mass, got \(2, 2\)
P([1, 1], np.zeros((3, 3)))                         | position    | with N = 2 as in mass, got \(3, 3\)
P([1, 1], np.zeros((3, 2)))                         | position    | pass x.T
P([1, 1], apart, np.zeros((2, 2)))                  | velocity    | got \(2, 2\)
P(1.0, [0, 0, 0])                                   | mass        | expected shape \(N,\), got \(\)
P([1, np.nan], apart)                               | mass        | mass\[1\] is nan
P([1, 1], [[0, 0, 0], [1, -np.inf, 0]])             | position    | position\[1, 1\] is -inf
P([1, -2], apart)                                   | mass        | mass\[1\] is -2.0
P([1 + 1j, 1], apart)                               | mass        | complex
P(np.array([1, None]), apart)                       | mass        | object
scene.ensemble()                                    | position    | leading axis
scene.ensemble(position=np.zeros((2, 3)))           | position    | got \(2, 3\)
scene.ensemble(mass=[[1, 1], [1, -1]])              | mass        | mass\[1, 1\] is -1.0
scene.ensemble(mass=[1, 1])                         | mass        | expected shape \(B, 2\), got \(2,\)
scene.ensemble(position=np.zeros((3, 2, 3)), velocity=np.zeros((2, 2, 3))) | velocity | expected 3 copies like position, got 2
scene.ensemble(position=np.zeros((0, 2, 3)))        | position    | at least one copy
scene.ensemble(position=np.zeros((3, 2, 3))).run(1) | position    | position\[0, 0\] = position\[0, 1\]
vv.Scene(P([1, 1], [[2, 0, 0], [2, 0, 0]]), vv.Gravity(1.0)).plan(1) | position | position\[0\] = position\[1\]
vv.Scene()                                          | parts       | got 0; the forces need bodies
vv.Scene(P([1], [[0, 0, 0]]), P([1], [[1, 0, 0]]))  | parts       | got 2; join
vv.Scene(vv.Gravity)                                | parts       | the class Gravity
vv.Gravity(1.0, softening=-0.5)                     | softening   | at least 0, got -0.5
vv.UniformField(9.81)                               | g           | expected shape \(3,\), got \(\)
vv.CentralField(vv.potentials.Coulomb)              | potential   | for example
vv.potentials.Yukawa(1.0, length=-1.0)              | length      | positive number, got -1.0
vv.potentials.potential_by_name("colomb", [1])      | potential   | did you mean 'coulomb'
vv.potentials.potential_by_name(["coulomb"], [1])   | potential   | expected one of
vv.potentials.potential_by_name("yukawa", [1])      | parameters  | 2 \(k, length\) for yukawa, got 1
scene.run([])                                       | t           | got none
scene.run([1.0, 0.5])                               | t           | t\[1\] = 0.5 after 1
scene.run([-1.0, 0.5])                              | t           | two directions
scene.run(np.nan)                                   | t           | t is nan
scene.run(1, method="leap_frog", dt=0.1)            | method      | got 'leap_frog'; did you mean 'leapfrog'\?
scene.run(1, method=None)                           | method      | expected a name, got NoneType
scene.run(1, method="rk4")                          | dt          | got None
scene.run(1, method="rk4", dt=0)                    | dt          | other than 0, got 0
scene.run(1, method="rk4", dt=-0.1)                 | dt          | run forward in time, from t0 = 0.0 to 1.0, got -0.1
scene.plan(1, method="rk4", dt=-1e-15)              | dt          | got -1e-15
scene.run([0, 1], method="rk4", dt=-1)              | dt          | from t0 = 0.0 to 1.0, got -1.0
scene.run(1, method="RK4", dt=0.1)                  | method      | got 'RK4'; did you mean 'rk4'\?
scene.run(1, method="Kahan-Li 8", dt=0.1)           | method      | did you mean 'kahan_li8'\?
scene.run(1, method="\ud800")                       | method      | got '\?'$
scene.run(1, record="\ud800")                       | record      | got '\?'$
scene.run(1, method="rk4", dt=0.1, rtol=1e-3)       | rtol        | an adaptive method such as verner98$
scene.run(1, method="leapfrog", dt=[0.1, 0.2])      | dt          | an adaptive method such as verner98$
scene.run(1, record="Angular-Momentum")             | record      | did you mean 'angular_momentum'\?
scene.run(1, **{"Max Step": 1})                     | Max Step    | did you mean 'max_step'\?
scene.run(1, method="rk4", dt=0.1, max_step=0.5)    | max_step    | rk4 has a fixed step.*got 0.5; leave max_step out
scene.run(1, method="leapfrog", dt=0.1, atol=0)     | atol        | leapfrog has a fixed step.*got 0.0; leave atol out.*verner98
scene.plan(1, method="rk4", dt=0.1, max_step=0.5)   | max_step    | rk4 has a fixed step
scene.plan(1, method="rk4", dt=0.1, atol=1e-9)      | atol        | got 1e-09
copies.run(1, method="rk4", dt=0.1, max_step=0.5)   | max_step    | rk4 has a fixed step
copies.plan(1, method="rk4", dt=0.1, atol=1e-9)     | atol        | rk4 has a fixed step
copies.run(1, method="rk4", dt=-0.1)                | dt          | from t0 = 0.0 to 1.0, got -0.1
scene.run([1.0, 0.0])                               | t           | lead away from t0 = 0.0 in order, got t\[1\] = 0.0 after 1.0
scene.run([4.0, 1.0, -2.0])                         | t           | lead away from t0 = 0.0 in order, got t\[1\] = 1.0 after 4.0
scene.run(1, rtol=-1)                               | rtol        | 2.3e-14 .* to 1, got -1.0$
scene.run(1, method="rk4", dt=np.nan)               | dt          | dt is nan
scene.run(1, method="dop853", dt=0.1)               | dt          | leave dt out
scene.run(1, rtol=1e-15)                            | rtol        | 2.3e-14 .* got 1e-15.* such as kahan_li8$
scene.run(1, atol=-1)                               | atol        | at least 0 or None, got -1
scene.run(1, max_step=0)                            | max_step    | positive time or None, got 0
scene.run(1, max_steps=0)                           | max_steps   | at least 1 or None, got 0
scene.run(1, max_steps=1e6)                         | max_steps   | whole number, got 1000000.0; pass int\(1000000.0\)
scene.run(1, max_steps=10**30)                      | max_steps   | whole number from
scene.run(1, threads=0)                             | threads     | from 1 to 1024, got 0
scene.run(1, threads=True)                          | threads     | got True
scene.run(1, record="postion")                      | record      | got 'postion'; did you mean 'position'\?
scene.run(1, record=None)                           | record      | a name or several names, got None
scene.run(1, record=["position", 4])                | record      | expected a name, got int
scene.run(1, progress=3)                            | progress    | callable
scene.run(1, progress=dict)                         | progress    | got the class dict; True shows a tqdm bar
scene.run(1, dense_output=True)                     | dense_output | give as t the times you want
scene.run(1, t_eval=[1])                            | t_eval      | ; the output times are t$
scene.plan(1, t_eval=[1])                           | t_eval      | ; the output times are t$
scene.run([[1.0]])                                  | t           | expected an array with one axis, got shape \(1, 1\)
P([1e308, 1e308], apart)                            | mass        | total is within the range of float64, but the largest is 1e\+308
vv.Scene(P([1e300, 1e300], apart), vv.Gravity(1e10)).run(1) | mass | G = 10000000000.0 and a mass of 1e\+300
setattr(vv.Gravity(1.0), "soft", 5)                 | soft        | a Gravity is frozen; .* did you mean 'softening'\?
setattr(vv.Gravity(1.0), "softening", 5)            | softening   | dataclasses.replace\(gravity, softening=…\)
setattr(scene, "t0", 5)                             | t0          | a Scene is frozen; .*dataclasses.replace\(scene, t0=…\)
setattr(vv.potentials.Yukawa(1, 1), "k", 2)         | k           | a Yukawa is frozen
setattr(copies, "mass", 1)                          | mass        | an EnsembleScene is frozen
setattr(copies.run(1), "t", 1)                      | t           | an EnsembleTrajectory is frozen
setattr(scene.run(1), "t", 1)                       | t           | a Trajectory is frozen
delattr(scene, "t0")                                | t0          | a Scene is frozen
type("Drag", (vv.forces.Force,), {})                | Force       | got Drag: the core knows its own only
type("Well", (vv.potentials.Potential,), {})        | Potential   | got Well: the core knows its own only; .*CentralField
type("Mine", (vv.potentials.Yukawa,), {})           | Yukawa      | got Mine
vv.Scene(particles=P([1], [[0, 0, 0]]), forces=[3]) | forces      | got an int
copies["first"]                                     | index       | expected a whole number, a slice, a list or array of whole numbers, or a mask, got 'first'
copies.run(1)[1.0]                                  | index       | expected a whole number, a slice, a list or array of whole numbers, or a mask, got 1.0
copies[2:2]                                         | index       | at least one of 2 copies
scene.run(1).save(None)                             | path        | expected the path of a file, got NoneType
vv.load(None)                                       | path        | expected the path of a file, got NoneType
vv.orbits.state(1, semi_major_axis=1, eccentricity=0) | semi_major_axis | give pericenter = a\|1 − e\|
vv.orbits.state(1, pericenter=1, eccentricity=0, inclination=45) | inclination | from 0 to π, got 45.0
vv.orbits.state(1, pericenter=1, eccentricity=0, inclination=-0.1) | inclination | from 0 to π, got -0.1
vv.orbits.state(1, pericenter=1, eccentricity=0, mean_anomaly=1, true_anomaly=1) | mean_anomaly | one anomaly, got true_anomaly and mean_anomaly
vv.orbits.state(1, pericenter=1, eccentricity=2, eccentric_anomaly=1e3) | eccentric_anomaly | range of float64
scene.run(1, record="energy").position              | record      | 'position' in record
scene.run(1).conservation(about="com")              | about       | 'center_of_mass', got 'com'
scene.particles.rescaled(length=0)                  | length      | positive number of new units
scene.particles.rescaled(time="day")                | time        | expected real numbers
scene.rescaled(length=1e200)                        | G           | 1.0 becomes inf; choose them nearer
scene.rescaled(length=1e-300, mass=1e-300)          | G           | 1.0 becomes 0.0
vv.problems.kepler().scene.particles.rescaled(length=1e-200, time=1e200) | velocity    | becomes -?0.0
vv.Gravity(1.0).rescaled(length=0, mass=1, time=1)  | length      | positive number of new units
scene.rescaled(mass=-1)                             | mass        | positive number of new units per old one, got -1
center.shifted(velocity=[1, 0, 0])                  | velocity    | fixed center
vv.problems.kepler(e="round")                       | e           | expected real numbers
vv.problems.kepler(e=1.0)                           | e           | 0 ≤ e < 1, got 1.0
vv.problems.kepler(mass_ratio="one")                | mass_ratio  | expected real numbers
vv.problems.kepler(periods=np.nan)                  | periods     | whole number, got nan
vv.problems.figure_eight(periods="two")             | periods     | whole number, got 'two'
vv.problems.lagrange_triangle(3)                    | masses      | expected shape \(3,\)
vv.problems.lagrange_triangle([1, -2, 3])           | masses      | at least 0
vv.problems.lagrange_triangle(side=-1)              | side        | positive length, got -1
vv.problems.lagrange_triangle(turn="once")          | turn        | expected real numbers
vv.problems.kepler().error(3)                       | final       | expected a Scene or a Trajectory, got int
vv.load(__file__)                                   | path        | expected a run that visviva saved
vv.CentralField(lambda r: -1 / r)                   | potential   | got function; wrap it: vv.potentials.Custom\(function\)
vv.PairPotential(lambda r: -1 / r)                  | potential   | wrap it: vv.potentials.Custom\(function\)
vv.PairPotential(vv.potentials.Coulomb)             | potential   | got type$
mc(lambda r: 1 / r)                                 | potential   | wrap it: vv.potentials.Custom\(function\)
vv.scattering.deflect(abs, energy=1, impact_parameter=1) | potential | wrap it: vv.potentials.Custom\(function\)
vv.scattering.rainbows(abs, energy=1)               | potential   | wrap it: vv.potentials.Custom\(function\)
vv.scattering.Foil("gold", 1.0, potential=abs)      | potential   | wrap it: vv.potentials.Custom\(function\)
vv.orbits.central_orbit(abs, position=[1, 0, 0], velocity=[0, 1, 0]) | potential | wrap it: vv.potentials.Custom\(function\)
vv.orbits.central_orbit([coulomb, abs], position=[1, 0, 0], velocity=[0, 1, 0]) | potential | wrap it: vv.potentials.Custom
mc(vv.Gravity(1.0))                  | potential   | expected one of visviva.potentials
mc(beam_energy=-1)                                  | beam_energy | positive finite number, got -1
mc(masses=(1, 1, 1))                                | masses      | expected shape \(2,\), got \(3,\)
mc(masses=(1, -1))                                  | masses      | masses\[1\] is -1
mc(n_events=1e6)                                    | n_events    | pass int\(1000000.0\)
mc(n_events=0)                                      | n_events    | from 1 to
mc(seed=-1)                                         | seed        | from 0 to 18446744073709551615, got -1
mc(bins=0)                                          | bins        | from 1 to 65536, got 0
mc(tally="angle")                                   | tally       | got 'angle'; did you mean 'cm_angle'\?
mc(tally=["energy", "Recoil Angle"])                | tally       | got 'Recoil Angle'; did you mean 'recoil_angle'\?
mc(tally={"impact": [0, 1]})                        | tally       | did you mean 'impact_parameter'\?
mc(tally="\ud800")                                  | tally       | got '\?'$
mc(tally={"cm_angle", 3})                           | tally       | different names, got
mc(tally=iter([]))                                  | tally       | different names, got \[\]
mc(b_max=1e300)                                     | b_max       | = 0.625, E .* got 1e\+300
mc(tally={"cm_angle": [1, 0]})                      | cm_angle    | strictly increasing
vv.scattering.lab_angle(1.0, mass_ratio=0)          | mass_ratio  | positive number, got 0
vv.scattering.lab_angle(1.0, mass_ratio=0.25, q_value=-1, beam_energy=1.2) | beam_energy | the threshold, 1.25, .*got 1.2
vv.scattering.kinematic_factor(1.0, mass_ratio=2.0) | lab_angle   | in \[0, 0.5235987755982989\], got 1.0
vv.collisions.elastic(1, -2, [1, 0, 0], [0, 0, 0], normal=[1, 0, 0]) | mass2 | positive number, got -2.0
vv.collisions.restitution(1, 2, [1, 0, 0], [0, 0, 0], coefficient=2, normal=[1, 0, 0]) | coefficient | from 0 to 1, got 2.0
vv.collisions.inelastic(1, 1, [1, 0, 0], [0, 0, 0], q_value=-1, direction=[1, 0, 0]) | q_value | the threshold, -0.25, .*got -1.0
vv.scattering.rutherford_cross_section(coulomb, energy=1, angle=1, frame="LAB") | frame | did you mean 'lab'
vv.scattering.rutherford_angle(coulomb, energy=0, impact_parameter=1) | energy | positive number, got 0
vv.orbits.elements(0.0, [1, 0, 0], [0, 1, 0])       | mu          | mu = 0
"""  # noqa: E501
ROWS = [tuple(part.strip() for part in line.split("|", 2)) for line in TABLE.strip().splitlines()]


@pytest.mark.parametrize(("typed", "argument", "message"), ROWS, ids=[row[0] for row in ROWS])
def test_bad_input_is_refused_by_name(typed: str, argument: str, message: str) -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        eval(typed, NAMES | {"__file__": __file__})
    assert caught.value.argument == argument
    assert re.search(message, caught.value.message), caught.value.message


def test_a_folder_that_is_not_there_is_named(tmp_path: object) -> None:
    with pytest.raises(FileNotFoundError, match=r"no such folder.*nowhere'$"):
        vv.problems.kepler().scene.run(1.0).save(f"{tmp_path}/nowhere/run.npz")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("gravity", "did you mean 'Gravity'?"),
        ("Partcles", "did you mean 'Particles'?"),
        ("simulate", "a scene runs itself: visviva.Scene(…).run(t=…)"),
        ("Friction", "a Lagrangian takes dissipation=…"),
        ("Entropy", "has no attribute 'Entropy'"),
        ("Yukawa", "it is visviva.potentials.Yukawa"),
        ("_hidden", "has no attribute '_hidden'"),
    ],
)
def test_a_name_that_is_not_there_is_told_from_the_nearest(name: str, message: str) -> None:
    with pytest.raises(AttributeError) as caught:
        getattr(vv, name)
    assert str(caught.value).endswith(message)


@pytest.mark.parametrize("room", vv._ROOMS)
def test_a_room_names_the_nearest_of_its_names(room: str) -> None:
    module = getattr(vv, room)
    name = module.__all__[-1]
    with pytest.raises(
        AttributeError, match=rf"module 'visviva\.{room}' has no attribute .*; did you mean '{name}'\?$"
    ):
        getattr(module, name + "x")
    for unknown in ("_hidden", "zzzzzzzz"):
        with pytest.raises(AttributeError, match=rf"module 'visviva\.{room}' has no attribute '{unknown}'$"):
            getattr(module, unknown)


def test_a_path_whose_text_is_none_is_refused() -> None:
    class Odd(os.PathLike[str]):
        def __fspath__(self) -> str:
            return 1  # type: ignore[return-value]

    with pytest.raises(vv.InvalidInput, match="path: expected the path of a file, got Odd"):
        vv.load(Odd())


@pytest.mark.parametrize(
    ("name", "message"),
    [("animate", r"out\[i\]\.animate"), ("y", "position and velocity")],
)
def test_what_an_ensemble_lacks_its_copies_have(name: str, message: str) -> None:
    copies: vv.EnsembleScene = NAMES["copies"]  # type: ignore[assignment]
    with pytest.raises(AttributeError, match=message):
        getattr(copies.run(1.0), name)
    with pytest.raises(AttributeError, match=r"ensemble\[i\]\.ensemble"):
        copies.ensemble  # type: ignore[attr-defined]  # noqa: B018
    with pytest.raises(AttributeError, match=r"status == vv\.Status\.OK"):
        copies[0].run(1.0).success  # type: ignore[attr-defined]  # noqa: B018
    assert not hasattr(copies, "_repr_svg_")


def test_a_frozen_attribute_is_the_error_that_programs_catch() -> None:
    for kind in (AttributeError, FrozenInstanceError, ValueError, vv.FrozenAttribute):
        with pytest.raises(kind):
            NAMES["scene"].t0 = 5.0  # type: ignore[attr-defined]
