"""Derived columns against sums of sixty digits, whatever the units, the number of bodies and their place.

Bounds: sums in the same order but of squares of half the numbers, a rounding of each.
"""

import subprocess
import sys
import textwrap

import numpy as np
import pytest
from mpmath import mp, mpf, sqrt
from numpy.typing import NDArray

import visviva as vv
from visviva import _core
from visviva.invariants import conserved

COLUMNS = ["kinetic_energy", "potential_energy", "energy", "virial", "momentum", "angular_momentum", "center_of_mass"]

Array = NDArray[np.float64]


def exact(scene: vv.Scene, softening: float, G: float, position: Array, velocity: Array) -> dict[str, list[mpf]]:
    """The columns of one state by their definitions."""
    with mp.workdps(60):
        mass = [mpf(m) for m in scene.particles.mass.tolist()]
        x = [[mpf(c) for c in row] for row in position.tolist()]
        v = [[mpf(c) for c in row] for row in velocity.tolist()]
        bodies = range(len(mass))
        kinetic = sum(mass[i] * sum(c * c for c in v[i]) for i in bodies) / 2
        potential = virial = mpf(0)
        for i in bodies:
            for j in range(i + 1, len(mass)):
                r2 = sum((a - b) ** 2 for a, b in zip(x[i], x[j], strict=True))
                root = sqrt(r2 + mpf(softening) ** 2)
                if mass[i] * mass[j]:
                    potential -= mpf(G) * mass[i] * mass[j] / root
                    virial -= mpf(G) * mass[i] * mass[j] * r2 / root**3
        cross = [[x[i][b] * v[i][c] - x[i][c] * v[i][b] for b, c in ((1, 2), (2, 0), (0, 1))] for i in bodies]
        return {
            "kinetic_energy": [kinetic],
            "potential_energy": [potential],
            "energy": [kinetic + potential],
            "virial": [virial],
            "momentum": [sum(mass[i] * v[i][c] for i in bodies) for c in range(3)],
            "angular_momentum": [sum(mass[i] * cross[i][c] for i in bodies) for c in range(3)],
            "center_of_mass": [sum(mass[i] * x[i][c] for i in bodies) / sum(mass) for c in range(3)],
        }


def half_ulps(found: Array, expected: list[mpf]) -> float:
    """The largest distance, in half units in the last place; that of infinities from what is beyond the range is 0."""
    worst = 0.0
    for value, right in zip(np.atleast_1d(found).tolist(), expected, strict=True):
        rounded = float(right)
        if np.isinf(rounded):
            worst = max(worst, 0.0 if value == rounded else np.inf)
        else:
            with mp.workdps(60):
                worst = max(worst, float(abs(mpf(value) - right) / (mpf(float(np.spacing(abs(rounded)))) / 2)))
    return worst


def random_scene(seed: int, N: int, units: tuple[float, float, float], offset: float, softening: float) -> vv.Scene:
    rng = np.random.default_rng(seed)
    mass_unit, length, speed = units
    mass = rng.random(N) * mass_unit
    mass[1:][rng.random(N - 1) < 0.2] = 0.0
    x, v = (rng.normal(size=(N, 3)) + offset) * length, rng.normal(size=(N, 3)) * speed
    return vv.Scene(vv.Particles(mass, x, v), vv.Gravity(1.5, softening=softening * length))


def judged(scene: vv.Scene, softening: float) -> None:
    position, velocity = scene.particles.position, scene.particles.velocity
    found = conserved(scene, position[None], velocity[None], np.zeros(3), COLUMNS)
    gravity = scene.forces[0]
    assert isinstance(gravity, vv.Gravity)
    for name, expected in exact(scene, softening, gravity.G, position, velocity).items():
        # Thirty digits, rounded once: half a unit in the last place, and what the thirtieth digit may turn over.
        assert half_ulps(found[name][0], expected) <= 1.0 + 1e-6, name


@pytest.mark.parametrize("N", [*range(1, 19), 64, 65, 100])
@pytest.mark.parametrize("softening", [0.0, 0.3])
@pytest.mark.parametrize("offset", [0.0, 1e9])
def test_every_column_is_rounded_once(N: int, softening: float, offset: float) -> None:
    judged(random_scene(N, N, (1.0, 1.0, 1.0), offset, softening), softening)


@pytest.mark.parametrize(
    "units", [(1e100, 1e-100, 1e-100), (1e-162, 1.0, 1.0), (1e200, 1e100, 1e-150), (1e-60, 1e90, 1e120)]
)
def test_every_column_is_rounded_once_in_any_units(units: tuple[float, float, float]) -> None:
    for softening in (0.0, 0.3):
        judged(random_scene(5, 9, units, 0.0, softening), softening * units[1])


def test_pairs_much_closer_than_the_rest_keep_their_digits() -> None:
    """Separations of 1e-200 and masses of 1e-200 beside others of 1: squares of both vanish."""
    x = [[0.0, 0.0, 0.0], [1e-200, 2e-200, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]
    for softening in (0.0, 1e-190):
        particles = vv.Particles([1.0, 1e-200, 1e-200, 1.0], x)
        judged(vv.Scene(particles, vv.Gravity(1.5, softening=softening)), softening)


def test_beyond_the_range_is_infinite_and_not_undefined() -> None:
    scene = vv.Scene(vv.Particles([1e200, 1e200], [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]), vv.Gravity(1.0))
    found = conserved(scene, scene.particles.position[None], np.zeros((1, 2, 3)), np.zeros(3), COLUMNS)
    assert found["potential_energy"][0] == found["energy"][0] == found["virial"][0] == -np.inf
    together = conserved(scene, np.zeros((1, 2, 3)), np.zeros((1, 2, 3)), np.zeros(3), COLUMNS)
    assert together["potential_energy"][0] == -np.inf


@pytest.mark.parametrize("N", [2, 64, 65, 100])
def test_energy_far_from_the_origin_does_not_drift_by_the_sum(N: int) -> None:
    """At 1e9 a rounded position is off by 1e-7: what the positions leave out belongs to the distances, for every N."""
    rng = np.random.default_rng(N)
    x = rng.normal(size=(N, 3)) + 1e9
    scene = vv.Scene(vv.Particles(np.full(N, 1.0 / N), x), vv.Gravity(1.0, softening=0.1))
    energy = scene.run(t=np.linspace(0.0, 0.1, 6), method="kahan_li8", dt=0.01, record=("energy",)).energy
    # Ten steps of order eight: round-off. Rounded positions gave 1e-8.
    assert np.abs(energy - energy[0]).max() < 1e-14 * abs(energy[0])


@pytest.mark.parametrize("potential", [vv.potentials.Coulomb(-1.0), vv.potentials.Yukawa(k=2.0, length=0.7)])
def test_the_virial_of_a_central_field_is_that_of_its_force(potential: vv.potentials.Coulomb) -> None:
    """Σ r·F by its definition, the center elsewhere; attraction pulls in: negative about the center itself."""
    rng = np.random.default_rng(4)
    center = np.array([0.3, -0.2, 0.5])
    particles = vv.Particles(rng.random(5) + 0.5, rng.normal(size=(5, 3)))
    scene = vv.Scene(particles, vv.CentralField(potential, center=center))
    force = particles.mass[:, None] * scene.acceleration()
    # Accelerations are rounded in a few operations.
    assert scene.invariants().virial == pytest.approx(float((particles.position * force).sum()), rel=1e-13, abs=0)
    about_center = vv.Scene(particles, vv.CentralField(vv.potentials.Coulomb(-1.0)))
    assert about_center.invariants().virial == pytest.approx(
        about_center.invariants().potential_energy, rel=1e-14, abs=0
    )


def test_recorded_columns_are_the_table() -> None:
    """What the core offers can be recorded, of a packed, a batched, a closed and a non-interacting scene."""
    rng = np.random.default_rng(7)
    names = [name for name, _, _, _ in _core.columns()]
    assert set(names) == set(COLUMNS)
    bodies = vv.Particles(rng.random(10) + 0.1, rng.normal(size=(10, 3)), rng.normal(size=(10, 3)))
    few = vv.Particles(bodies.mass[:3], bodies.position[:3], bodies.velocity[:3])
    mixed = vv.Particles([1.0, 0.0, 0.5, 0.0, 0.7], bodies.position[:5], bodies.velocity[:5])
    yukawa = vv.CentralField(vv.potentials.Yukawa(k=-1.0, length=3.0))
    gravity = vv.Gravity(1.0, softening=0.2)
    t = np.linspace(0.0, 0.5, 7)
    for scene in (
        vv.Scene(bodies, gravity),
        vv.Scene(few, gravity),
        vv.Scene(mixed, gravity),
        vv.Scene(bodies, vv.UniformField([0.0, 0.0, -1.0])),
        vv.Scene(few, yukawa),
    ):
        for method in ({"method": "auto"}, {"method": "leapfrog", "dt": 0.01}):
            out = scene.run(t=t, record=("position", "velocity", *names), **method)  # type: ignore[arg-type]
            alone = scene.run(t=t, record=names, **method)  # type: ignore[arg-type]
            again = conserved(scene, out.position, out.velocity, np.zeros(3), names)
            for name in names:
                recorded = out._result["columns"][name][0]
                assert np.array_equal(recorded, alone._result["columns"][name][0])
                # From the unrounded state against from the rounded one: round-off of terms of order ten.
                assert np.abs(recorded - again[name]).max() < 1e-13, name


def test_a_copy_records_what_it_records_alone() -> None:
    """Copies that differ in their massless bodies, on any number of threads."""
    rng = np.random.default_rng(8)
    names = [name for name, _, _, _ in _core.columns()]
    mass = rng.random((7, 4)) + 0.1
    mass[::2, 1] = 0.0
    particles = vv.Particles(mass[0], rng.normal(size=(4, 3)), rng.normal(size=(4, 3)))
    scene = vv.Scene(particles, vv.Gravity(1.0, softening=0.3))
    ensemble = scene.ensemble(mass=mass)
    for threads in (1, 3):
        out = ensemble.run(t=[0.1, 0.3], record=names, threads=threads)
        for copy in range(7):
            alone = ensemble[copy].run(t=[0.1, 0.3], record=names)
            for name in names:
                assert np.array_equal(out._result["columns"][name][copy], alone._result["columns"][name][0])


def test_pairs_are_summed_alike_on_any_number_of_threads() -> None:
    code = """
        import numpy as np, visviva as vv
        rng = np.random.default_rng(1)
        scene = vv.Scene(vv.Particles(rng.random(1500), rng.normal(size=(1500, 3))), vv.Gravity(1.0, softening=0.1))
        found = scene.invariants()
        print(found.potential_energy.hex(), found.virial.hex())
    """
    seen = {child(code, VISVIVA_THREADS=threads) for threads in ("1", "2", "3")}
    assert len(seen) == 1


def child(code: str, **environment: str) -> str:
    import os

    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(code)],
        capture_output=True,
        text=True,
        check=True,
        env=os.environ | environment,
    ).stdout


@pytest.mark.skipif(sys.platform != "linux", reason="reads the peak of the memory as Linux tells it")
def test_an_energy_column_takes_the_memory_of_an_energy_column() -> None:
    """At most twice the column, beyond what the same run takes without; it was 108 times."""
    code = """
        import sys, resource
        import numpy as np, visviva as vv
        rng = np.random.default_rng(2)
        particles = vv.Particles(np.full(9, 0.1), rng.normal(size=(9, 3)), rng.normal(size=(9, 3)))
        scene = vv.Scene(particles, vv.Gravity(1.0, softening=0.5))
        t = np.linspace(0.0, 10.0, 1_000_001)
        scene.run(t=t[:2], method="leapfrog", dt=1e-3)
        scene.run(t=t, method="leapfrog", dt=1e-3, record=sys.argv[1:])
        print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
    """

    def peak(*record: str) -> int:
        script = textwrap.dedent(code)
        run = [sys.executable, "-c", script, *record]
        return int(subprocess.run(run, capture_output=True, text=True, check=True).stdout)

    assert (peak("energy") - peak()) * 1024 < 2 * 8e6


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere nobody knows before how much memory there is")
@pytest.mark.parametrize(
    ("limit", "what"),
    [
        (0, "scene.run(t=np.linspace(0.0, 1.0, 10**6))"),
        (0, "scene.run(t=np.linspace(0.0, 1.0, 10**6), method='leapfrog', dt=0.1)"),
        (0, "scene.run(t=np.linspace(0.0, 1.0, 10**6), method='dop853', record='energy')"),
        (0, "vv.orbits.propagate(1.0, x, x + 1.0, np.linspace(0.0, 1.0, 10**6))"),
        # Less than the machine has, more than the process may.
        (2 * 10**9, "scene.run(t=np.linspace(0.0, 1.0, 10**4))"),
    ],
)
def test_what_does_not_fit_is_refused_by_name(limit: int, what: str) -> None:
    """In a child, which would be killed. 10⁶ times of 10⁵ bodies are 5 TB, 10⁴ times 48 GB."""
    code = f"""
        import resource
        import numpy as np, visviva as vv
        x = np.random.default_rng(0).normal(size=(10**5, 3))
        field = vv.CentralField(vv.potentials.Yukawa(k=-1.0, length=1.0))
        scene = vv.Scene(vv.Particles(np.ones(10**5), x), *([field] if "energy" in {what!r} else []))
        if {limit}:
            resource.setrlimit(resource.RLIMIT_AS, ({limit}, {limit}))
        try:
            {what}
        except vv.InvalidInput as error:
            print(error.argument, "bytes" in error.message, "available" in error.message)
    """
    assert child(code, VISVIVA_THREADS="1") == "t True True\n"


@pytest.mark.parametrize("massive", [0, 1, 130])
@pytest.mark.parametrize("threads", [1, 3])
def test_columns_of_bodies_that_do_not_interact_count_the_mass_where_it_is(massive: int, threads: int) -> None:
    """Each body is integrated by itself; only one of them has mass."""
    rng = np.random.default_rng(5)
    mass = np.zeros(131)
    mass[massive] = 2.0
    bodies = vv.Particles(mass, rng.normal(size=(131, 3)), rng.normal(size=(131, 3)))
    out = vv.Scene(bodies).run(
        t=[0.0, 0.5, 1.0],
        method="rk4",
        dt=1 / 64,
        record=("position", "velocity", "center_of_mass", "momentum", "energy"),
        threads=threads,
    )
    assert np.array_equal(out.center_of_mass, out.position[:, massive])
    assert np.array_equal(out.momentum, 2.0 * out.velocity[:, massive])
    assert np.allclose(out.energy, (out.velocity[:, massive] ** 2).sum(axis=-1), rtol=4e-16, atol=0.0)
