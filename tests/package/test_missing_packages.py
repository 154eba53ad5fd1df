"""What needs a package that is not there says so in one way, wherever it is called, and how to get it."""

import ast
import re
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import sympy

import visviva as vv

ROOT = Path(__file__).parent.parent.parent
PACKAGE = ROOT / "python" / "visviva"
EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
OF_OTHERS = {re.split("[<>=]", each)[0] for extra in EXTRAS.values() for each in extra} | {"cycler", "dask", "IPython"}

RUN = vv.problems.figure_eight().scene.run([0.0, 0.5])
COPIES = vv.problems.figure_eight().scene.ensemble(mass=[[1.0, 1.0, 1.0]] * 2)
SWING = vv.systems.pendulum(position=[0.5])
COUNTED = vv.scattering.monte_carlo(vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0,
                                    n_events=10, seed=1, tally=["cm_angle", ("lab_angle", "energy")])  # fmt: skip
FOIL = vv.scattering.Foil("gold", 0.1).run("alpha", beam_energy=5e6, n_events=5, seed=1)
SQUARE = sympy.Symbol("r") ** 2
JOINT = COUNTED["lab_angle", "energy"]

# By the package and the extra that brings it: what was called or given, and the call.
CALLS: dict[tuple[str, str], list[tuple[str, Callable[[Path], Any]]]] = {
    ("matplotlib", "plot"): [
        ("plot", lambda _: RUN.plot()),
        ("plot", lambda _: COUNTED.plot()),
        ("plot", lambda _: COUNTED["cm_angle"].plot()),
        ("plot", lambda _: JOINT.plot()),
        ("plot", lambda _: FOIL.plot()),
        ("plot", lambda _: FOIL["transmitted_angle"].plot()),
        ("plot", lambda _: COPIES.run(t=[0.0, 0.5]).plot(body=0)),
        ("plot", lambda _: SWING.run(t=[0.0, 0.5]).plot()),
        ("plot", lambda _: SWING.normal_modes().plot()),
        ("plot", lambda _: vv.rigid.free_rotation([1.0, 2.0, 3.0], [0.1, 1.0, 0.0], [0.0, 1.0]).plot()),
        ("plot", lambda _: vv.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0]).plot()),
        ("plot", lambda _: RUN.animate()),
        ("plot", lambda folder: RUN.animate(folder / "eight.gif")),
        ("plot", lambda folder: SWING.run(t=[0.0, 0.5]).animate(folder / "swing.gif")),
    ],
    ("cycler", "plot"): [("plot", lambda _: vv.plot_style())],
    ("imageio_ffmpeg", "video"): [
        ("path", lambda folder: RUN.animate(folder / "eight.mp4")),
        ("path", lambda folder: SWING.run(t=[0.0, 0.5]).animate(folder / "swing.mp4")),
    ],
    ("sympy", "symbolic"): [
        ("L", lambda _: SWING.momenta),
        ("names", lambda _: vv.coordinate("x").diff(vv.time)),
        ("function", lambda _: vv.potentials.Custom(SQUARE)),
    ],
    ("pyarrow", "parquet"): [
        ("to_parquet", lambda folder: RUN.to_parquet(folder / "a")),
        ("to_parquet", lambda folder: SWING.run(t=[0.0, 0.5]).to_parquet(folder / "a")),
        ("run_to_parquet", lambda folder: COPIES.run_to_parquet(1.0, to=folder / "a")),
        ("to", lambda folder: vv.scattering.scattering_events(
            vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=10, seed=1,
            to=folder / "a")),
    ],
    ("pandas", "pandas"): [
        ("to_pandas", lambda _: RUN.to_pandas()),
        ("to_pandas", lambda _: COUNTED["cm_angle"].to_pandas()),
        ("to_pandas", lambda _: JOINT.to_pandas()),
        ("to_pandas", lambda _: FOIL["transmitted_angle"].to_pandas()),
    ],
    ("xarray", "xarray"): [
        ("to_xarray", lambda _: RUN.to_xarray()),
        ("to_xarray", lambda _: COUNTED["cm_angle"].to_xarray()),
        ("to_xarray", lambda _: JOINT.to_xarray()),
        ("to_xarray", lambda _: FOIL["transmitted_angle"].to_xarray()),
    ],
    ("hist", "hist"): [
        ("to_hist", lambda _: COUNTED["cm_angle"].to_hist()),
        ("to_hist", lambda _: JOINT.to_hist()),
        ("to_hist", lambda _: FOIL["transmitted_angle"].to_hist()),
    ],
    ("trimesh", "mesh"): [("load_mesh", lambda folder: vv.rigid.load_mesh(folder / "box.stl"))],
    ("scipy", "scipy"): [("to_scipy", lambda _: vv.rigid.to_scipy([0.0, 0.0, 0.0, 1.0]))],
}  # fmt: skip


@pytest.mark.parametrize(("package", "extra"), CALLS)
def test_it_is_one_error_with_one_wording(
    package: str, extra: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in [name for name in sys.modules if name.split(".")[0] == package]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, package, None)
    # Of programs there are none either: ffmpeg takes the place of the package that brings it.
    monkeypatch.setenv("PATH", str(tmp_path))
    for argument, call in CALLS[package, extra]:
        with pytest.raises(vv.MissingPackage) as caught:
            call(tmp_path)
        assert isinstance(caught.value, vv.InvalidInput)
        assert isinstance(caught.value, ImportError)
        assert caught.value.argument == argument
        told = f"{argument}: the package {package} is not installed: pip install 'visviva[{extra}]'"
        assert re.fullmatch(re.escape(told) + "(, or .+)?", str(caught.value)), str(caught.value)
    assert not list(tmp_path.iterdir())
    # matplotlib comes with its cycles of colors.
    assert any(each.startswith("matplotlib" if package == "cycler" else package) for each in EXTRAS[extra])


def test_every_package_is_asked_for_in_one_way() -> None:
    """Walks over the sources: what is no package of Python's or of every run comes by `needed`."""
    allowed = {
        ("_progress.py", "tqdm"),  # without it there is a plain line
        ("_animation.py", "matplotlib"),  # beside a figure, which is matplotlib's
    }
    found, asked = set(), set()
    for path in sorted(PACKAGE.rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for_types = {
            id(each)
            for node in ast.walk(tree)
            if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)
            for each in ast.walk(node)
        }
        for node in ast.walk(tree):
            names = []
            if isinstance(node, ast.Import) and id(node) not in for_types:
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and id(node) not in for_types:
                names = [node.module or ""]
            found |= {(path.name, name.split(".")[0]) for name in names if name.split(".")[0] in OF_OTHERS}
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "needed":
                first = node.args[0]
                asked |= {first.value.split(".")[0]} if isinstance(first, ast.Constant) else set()
    assert found == allowed
    # The two modules of pyarrow are asked for by names in a loop.
    assert asked | {"pyarrow"} == {package for package, _ in CALLS}
