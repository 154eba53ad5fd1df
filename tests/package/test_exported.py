"""What goes to xarray and pandas is what the result has, under the names that it has there."""

import dataclasses
import pickle
import sys

import numpy as np
import pytest

import visviva as vv

pandas = pytest.importorskip("pandas")
xarray = pytest.importorskip("xarray")

TIMES = np.linspace(0.0, 100.0, 5)


@pytest.fixture(scope="module")
def planets() -> vv.Trajectory:
    return vv.datasets.outer_solar_system().scene.run(t=TIMES, record=["position", "velocity", "energy", "momentum"])


@pytest.fixture(scope="module")
def copies() -> vv.EnsembleTrajectory:
    scene = vv.problems.figure_eight().scene
    starts = scene.particles.position * np.array([1.0, 0.999, 1.001])[:, None, None]
    return scene.ensemble(position=starts).run(t=[0.0, 1.0], record=["position", "energy"])


def test_a_trajectory_has_names_and_the_very_numbers(planets: vv.Trajectory) -> None:
    data = planets.to_xarray()
    assert set(data.data_vars) == set(planets.recorded)
    assert dict(data.sizes) == {"time": 5, "body": 6, "component": 3}
    np.testing.assert_array_equal(data["position"].sel(body="Saturn", component="y"), planets["Saturn"].position[:, 1])
    np.testing.assert_array_equal(data["energy"], planets.energy)
    assert data.attrs == {"method": planets.stats.method, "status": "OK"}
    assert np.shares_memory(data["position"].values, planets.position)
    with pytest.raises(ValueError, match="read-only"):
        data["position"].values[0] = 0.0


def test_a_frame_has_a_row_for_each_time(planets: vv.Trajectory) -> None:
    frame = planets.to_pandas()
    np.testing.assert_array_equal(frame.index, TIMES)
    assert frame.index.name == "time"
    np.testing.assert_array_equal(frame["position"]["Saturn"]["y"], planets["Saturn"].position[:, 1])
    np.testing.assert_array_equal(frame["energy"].squeeze(), planets.energy)
    np.testing.assert_array_equal(frame["momentum"]["z"].squeeze(), planets.momentum[:, 2])


def test_one_column_has_plain_labels(planets: vv.Trajectory) -> None:
    frame = planets.to_pandas(["energy", "kinetic_energy"])  # one recorded, one computed
    assert list(frame.columns) == ["energy", "kinetic_energy"]
    np.testing.assert_array_equal(frame["kinetic_energy"], planets.kinetic_energy)


@pytest.mark.parametrize("form", ["to_xarray", "to_pandas"])
def test_unknown_and_lacking_columns_are_refused(planets: vv.Trajectory, form: str) -> None:
    with pytest.raises(vv.InvalidInput, match="columns: there is no column 'speed'; there are angular_momentum"):
        getattr(planets, form)("speed")
    with pytest.raises(vv.InvalidInput, match="orientation was not recorded"):
        getattr(planets, form)("orientation")


def test_copies_are_an_axis_and_rows(copies: vv.EnsembleTrajectory) -> None:
    data, frame = copies.to_xarray(), copies.to_pandas()
    assert data["position"].dims == ("copy", "time", "body", "component")
    np.testing.assert_array_equal(data["status"], copies.status)
    assert frame.index.names == ["copy", "time"]
    assert "status" not in frame.columns.get_level_values(0)
    np.testing.assert_array_equal(frame.loc[2]["position"][1]["x"], copies.position[2, :, 1, 0])
    np.testing.assert_array_equal(frame["energy"].squeeze(), copies.energy.reshape(-1))


def test_rigid_bodies_have_quaternions() -> None:
    body = vv.RigidBodies([1.0], moments=[[1.0, 2.0, 3.0]], angular_velocity=[[0.1, 1.0, 0.1]], names=["handle"])
    out = vv.Scene(body).run(t=[0.0, 1.0, 2.0])
    data = out.to_xarray()
    assert data["orientation"].dims == ("time", "rigid_body", "quaternion")
    np.testing.assert_array_equal(
        data["orientation"].sel(rigid_body="handle", quaternion="w"), out.orientation[:, 0, 3]
    )
    np.testing.assert_array_equal(
        out.to_pandas()["angular_velocity"]["handle"]["z"].squeeze(), out.angular_velocity[:, 0, 2]
    )


def test_generalized_runs_have_their_coordinates() -> None:
    system = vv.systems.double_pendulum()
    out = system.run(t=[0.0, 1.0, 2.0])
    names = list(system.coordinates)
    data = out.to_xarray()
    assert data["coordinate"].values.tolist() == names
    np.testing.assert_array_equal(data["momentum"].sel(coordinate=names[1]), out.momentum[:, 1])
    np.testing.assert_array_equal(out.to_pandas()["position"][names[0]], out[names[0]])
    assert "reactions" not in data
    many = system.ensemble(position=[[0.1, 0.2], [0.3, 0.4]]).run(t=[0.0, 1.0])
    np.testing.assert_array_equal(many.to_pandas().loc[1]["position"][names[1]], many.position[1, :, 1])
    np.testing.assert_array_equal(many.to_xarray()["energy"], many.energy)


def test_events_and_collisions_are_tables() -> None:
    out = vv.problems.kepler(e=0.5).scene.run(t=20.0, events=[vv.events.apsis(1, 0)])
    frame = out.events.to_pandas(["t", "which", "member"])
    np.testing.assert_array_equal(frame["t"], out.events.t)
    np.testing.assert_array_equal(out.events.to_pandas()["position"][1]["y"], out.events.position[:, 1, 1])
    balls = vv.Particles([1.0, 1.0], [[-2.0, 0, 0], [2.0, 0, 0]], [[1.0, 0, 0], [-1.0, 0, 0]], radius=0.5)
    table = vv.Scene(balls).run(t=4.0, collisions="bounce").collisions
    assert table.to_pandas("speed")["speed"].tolist() == [2.0]
    assert table.to_xarray()["position"].dims == ("collision", "component")
    none = vv.Scene(balls).run(t=0.5, collisions="bounce").collisions
    assert none.to_pandas().shape[0] == 0
    assert none.to_xarray().sizes["collision"] == 0


def test_tallies_keep_every_count() -> None:
    run = vv.scattering.monte_carlo(
        vv.potentials.Coulomb(1.0),
        beam_energy=1.0,
        masses=(1.0, 4.0),
        b_max=2.0,
        n_events=10_000,
        seed=1,
        tally={"cm_angle": np.linspace(0.5, 2.0, 7), ("lab_angle", "energy"): (4, 5)},
    )
    tally, joint = run["cm_angle"], run["lab_angle", "energy"]
    frame, data = tally.to_pandas(), tally.to_xarray()
    assert int(frame["counts"].sum()) + sum(frame.attrs[n] for n in ("underflow", "overflow", "captured")) == 10_000
    np.testing.assert_array_equal(frame.index.left, tally.edges[:-1])
    np.testing.assert_array_equal(data["counts"], tally.counts)
    np.testing.assert_array_equal(data["cm_angle_high"], tally.edges[1:])
    np.testing.assert_array_equal(joint.to_pandas(), joint.counts)
    np.testing.assert_array_equal(joint.to_xarray()["counts"], joint.counts)


@pytest.mark.parametrize(("form", "package"), [("to_xarray", "xarray"), ("to_pandas", "pandas")])
def test_what_is_missing_is_named(
    planets: vv.Trajectory, form: str, package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(
        ImportError, match=rf"^{form}: the package {package} is not installed: pip install 'visviva\[{package}\]'$"
    ):
        getattr(planets, form)()


def test_elements_of_a_run_stand_under_its_times_and_bodies(planets: vv.Trajectory) -> None:
    found = planets.elements(["Saturn", "Jupiter"], about="Sun")
    data, frame = found.to_xarray(), found.to_pandas()
    assert data["energy"].dims == ("time", "body")
    assert data["laplace_runge_lenz"].dims == ("time", "body", "component")
    assert data["inclination"].attrs == {"units": "rad"}
    np.testing.assert_array_equal(data["time"], TIMES)
    np.testing.assert_array_equal(data["eccentricity"].sel(body="Jupiter"), found.eccentricity[:, 1])
    assert frame.index.names == ["time", "body"]
    assert len(frame) == len(TIMES) * 2
    np.testing.assert_array_equal(frame["period"].xs("Saturn", level="body"), found.period[:, 0])
    np.testing.assert_array_equal(frame["angular_momentum"]["z"], found.angular_momentum[..., 2].reshape(-1))
    alone = planets.elements("Saturn", about="Sun").to_pandas(["mean_longitude", "node"])
    assert alone.index.name == "time"
    np.testing.assert_array_equal(alone["mean_longitude"], found.mean_longitude[:, 0])


def test_elements_of_copies_have_their_number(copies: vv.EnsembleTrajectory) -> None:
    scene = copies.ensemble.scene
    starts = copies.ensemble[1:]
    out = starts.run(t=[0.0, 0.1])
    found = out.elements(about=2, G=1.0)
    data = found.to_xarray("semi_major_axis")
    assert dict(data.sizes) == {"copy": 2, "time": 2, "body": len(scene.particles) - 1}
    np.testing.assert_array_equal(data["semi_major_axis"], found.semi_major_axis)


@pytest.mark.parametrize(("shape", "names"), [((), ["orbit"]), ((4,), ["orbit"]), ((2, 3), ["orbit_0", "orbit_1"])])
def test_elements_of_states_are_counted(shape: tuple[int, ...], names: list[str]) -> None:
    speed = np.zeros((*shape, 3))
    speed[..., 1] = 1.0 + 0.1 * np.arange(np.prod(shape, dtype=int)).reshape(shape)
    found = vv.orbits.elements(1.0, [1.0, 0.0, 0.0], speed)
    frame = found.to_pandas()
    assert frame.index.names == names
    np.testing.assert_array_equal(frame["energy"], found.energy.reshape(-1))
    assert set(found.to_xarray().data_vars) == set(vv.orbits.Elements.__slots__)
    with pytest.raises(vv.InvalidInput, match="columns: there is no column 'anomaly'"):
        found.to_pandas("anomaly")


def test_rows_of_elements_keep_their_names_on_a_journey(planets: vv.Trajectory) -> None:
    found = planets.elements(about="Sun")
    xarray.testing.assert_identical(pickle.loads(pickle.dumps(found)).to_xarray(), found.to_xarray())
    # What is made anew by hand may be of anything.
    other = dataclasses.replace(found, mu=found.mu)
    assert other.to_xarray()["mu"].dims == ("orbit_0", "orbit_1")
