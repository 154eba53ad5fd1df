"""Names: public ones only in `dir`, and those that a type checker may know."""

import ast
import importlib
import re
import subprocess
import sys
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

import visviva as vv

ROOT = Path(__file__).parent.parent.parent


def test_names_are_all_there() -> None:
    for name in vv.__all__:
        assert getattr(vv, name) is not None
    assert set(dir(vv)) == {*vv.__all__, "__version__"}


@pytest.mark.parametrize("room", vv._ROOMS)
def test_a_room_shows_its_public_names(room: str) -> None:
    module = importlib.import_module(f"visviva.{room}")
    assert sorted(dir(module)) == sorted(module.__all__)


def test_type_checkers_see_every_public_name() -> None:
    """The imports under TYPE_CHECKING are the names of `__all__`, so that a typo is an error and not an Any."""
    tree = ast.parse((ROOT / "python" / "visviva" / "__init__.py").read_text(encoding="utf-8"))
    seen: set[str] = set()
    for node in tree.body:
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            for line in node.body:
                assert isinstance(line, ast.ImportFrom)
                seen |= {alias.asname or alias.name for alias in line.names}
    assert seen == set(vv.__all__)
    assert {*vv._HOME, *vv._ROOMS} == set(vv.__all__)


def test_the_literals_are_the_names_of_the_core() -> None:
    names = {method.name for method in (*vv.methods(), *vv.rigid.methods())}
    assert get_args(vv.typing.MethodName) == ("auto", *sorted(names))
    scene = vv.Scene(vv.RigidBody(1.0, [1.0, 1.0, 1.0]))
    columns = get_args(vv.typing.ColumnName)
    assert set(scene.run(1.0, record=columns).recorded) == set(columns)
    done = subprocess.run([sys.executable, ROOT / "tools" / "write_names.py", "--check"], check=False)
    assert done.returncode == 0


def test_a_method_may_be_given_as_what_methods_returns() -> None:
    scene = vv.problems.figure_eight().scene
    for method in vv.methods():
        how = {} if method.adaptive else {"dt": 0.01}
        given, named = scene.run(0.1, method=method, **how), scene.run(0.1, method=method.name, **how)
        assert given.stats.method == method.name
        assert np.array_equal(given.position, named.position)
        assert scene.plan(0.1, method=method, **how).method == method.name


USER = """
import numpy as np
import visviva as vv

scene = vv.problems.kepler(e=0.5).scene
out: vv.Trajectory = scene.run(1.0, method="rk4", dt=0.1, record="energy")
stats: vv.Stats = out.stats
drift: vv.Drift = out.conservation().energy
copies: vv.EnsembleTrajectory = scene.ensemble(mass=np.ones((2, 2))).run([1.0, 2.0], threads=1)
some: vv.EnsembleTrajectory = copies[0:1]
one: vv.Trajectory = copies[0]
plan: vv.Plan = scene.plan(1.0, method=vv.methods()[0])
scene.run(1.0, method="rk5")  # wrong
scene.run(1.0, metod="rk4")  # wrong
scene.run(1.0, record=("energi",))  # wrong
scene.run(1.0, dt="0.1")  # wrong
scene.plan(1.0, threads=2)  # wrong
scene.run()  # wrong
vv.Drag(0.1)  # wrong
vv.orbits.stat  # wrong
copies.animate()  # wrong
copies.plot("energi")  # wrong
atom = vv.potentials.LennardJones(1.0, 1.0)
found: vv.scattering.Deflection = vv.scattering.deflect(atom, energy=1.0, impact_parameter=[1.0, 2.0])
found.plot("cross_section")
found.plot("crosssection")  # wrong
result = vv.scattering.monte_carlo(atom, beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=10, seed=1)
tally: vv.scattering.Tally = result["cm_angle"]
result["cm_angle"].couns  # wrong
result["cm_angel"]  # wrong
result["lab_angle", "enrgy"]  # wrong
result.resume(10, executor=3)  # wrong
for name in result:
    result[name]
lines, rings = vv.scattering.Spectrum([1.0, 2.0], [1.0, 1.0]), vv.scattering.Strata([0.0, 0.1, 1.0])
vv.scattering.Channel(-1.5, ([0.0, 1.0], [0.5, 0.1]), excitation_function=([1.0, 2.0], [0.0, 1.0]))
vv.scattering.Material(2.2, [14, 8], [28.085, 15.999], [1, 2], mean_excitation_energy=139.2)
foil = vv.scattering.Foil("gold", 0.4)
vv.scattering.Foil("unobtainium", 0.4)  # wrong
vv.scattering.Foil("gold", 0.4, potential="zbll")  # wrong
through = foil.run("alpha", beam_energy=1e6, n_events=1, seed=1, bins={"lab_angle": 4})
foil.run("alfa", beam_energy=1e6, n_events=1, seed=1)  # wrong
foil.run("alpha", beam_energy=1e6, n_events=1, seed=1, bins={"lab_angel": 4})  # wrong
through["stoped_depth"]  # wrong
part: float = through.fraction("transmitted").value
parts: np.typing.NDArray[np.float64] = through["lab_angle"].fraction().error
through.fraction("transmited")  # wrong
foil.history("alpha", beam_energy=1e6, seed=1)["dept"]  # wrong
advice = scene.advise(t=1.0, accuracy=1e-6)
scene.run(1.0, **advice.how)
settings: vv.typing.RunSettings = {"metod": "rk4"}  # wrong
vv.rigid.euler_angles([0, 0, 0, 1], "zxx")  # wrong
vv.systems.pendulum().run(1.0, events=["theta"], method="gauss15")  # wrong
vv.solve_ivp(lambda t, y: -y, (0, 1), [1.0])["yy"]  # wrong
state: np.typing.NDArray[np.float64] = vv.solve_ivp(lambda t, y: -y, (0, 1), [1.0])["y"]
vv.potentials.ScreenedCoulomb.between(2, 79, screening="zlb")  # wrong
vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2, ["x"], consistent="projet")  # wrong
vv.Lagrangian(lambda q, v, t, m: m * v[0] ** 2 / 2, ["x"], parameters={"m": 1.0}, position=[0.0])
vv.events.EventTable.off  # wrong
try:
    scene.run(1.0)
except vv.CloseEncounter as error:
    error.trajectory.t  # wrong
try:
    scene.run(1.0)
except vv.Interrupted as stopped:
    if stopped.trajectory is not None:
        stopped.trajectory.t
vv.stress.run(["dop835"])  # wrong
scene.particles + scene.particles  # wrong
orbits: vv.orbits.Elements = out.elements([1], about=0)
orbits.plot("eccentricity")
orbits.plot("ecc")  # wrong
orbits.to_pandas(["eccentricity", "mean_longitude"])
orbits.to_pandas(["ecc"])  # wrong
orbits.to_xarray("ecc")  # wrong
orbits.to_parquet("orbits.parquet", ["ecc"])  # wrong
out.events.to_pandas(["t", "position"])
out.events.to_pandas(["positon"])  # wrong
out.collisions.to_pandas(["energy_lost"])
out.collisions.to_pandas(["enrgy"])  # wrong
vv.systems.pendulum().run(1.0, events=["theta"]).events.to_pandas(["momentum"])
vv.systems.pendulum().run(1.0, events=["theta"]).events.to_pandas(["momentun"])  # wrong
events = vv.scattering.scattering_events(atom, beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=10, seed=1)
events["channel"]
events["chanel"]  # wrong
scene.run(1.0, events=[lambda t, r, v: r[0, 0], lambda t, r, v, q, w: q[0, 0]])
scene.run(1.0, events=[lambda t, y: y[0]])  # wrong
kept = scene.ensemble(radius=[[0.1, 0.1]]).run(1.0).conservation()
drifts: tuple[float, np.typing.NDArray[np.float64]] = kept[0]["energy"].max, kept["energy"].max
kept[0]["energy"].maximum  # wrong
vv.RotationalDrag(1.0) + vv.RotationalDrag(1.0)  # wrong
vv.events.plane([0, 0, 0], [0, 1, 0], direction=-1)
vv.events.plane([0, 0, 0], [0, 1, 0], direction=2)  # wrong
vv.systems.henon_heiles().poincare("x", t=1.0, direction=2)  # wrong
"""


def test_a_type_checker_finds_the_typos_of_a_user(tmp_path: Path) -> None:
    api = pytest.importorskip("mypy.api")
    (tmp_path / "user.py").write_text(USER)
    settings = tmp_path / "mypy.ini"
    settings.write_text(
        f"[mypy]\nstrict = True\nmypy_path = {ROOT / 'python'}\ncache_dir = {tmp_path}\n"
        "[mypy-tqdm.*,matplotlib.*]\nignore_missing_imports = True\n"
    )
    found, errors, _ = api.run(["--config-file", str(settings), str(tmp_path / "user.py")])
    assert errors == ""
    # What other packages have no types for is told of other files.
    lines = {int(line.split(":")[1]) for line in found.splitlines() if re.match(r"[^:]*user\.py:\d+: error: ", line)}
    wrong = {number for number, line in enumerate(USER.splitlines(), 1) if line.endswith("# wrong")}
    assert lines == wrong, found
