"""The reference for rigid bodies in a scene: against published figures, closed forms, what is conserved, and DOP853.

Bounds: closed forms against double-double, whose errors are the roundings of what is given: some of numbers of size
1.
"""

import json
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
import reference_dynamics as reference
from dynamics_cases import CASES
from high_order import angle_between

KEPT = json.loads((Path(__file__).parent / "dynamics_reference.json").read_text(encoding="utf-8"))


def states(name: str) -> dict[str, np.ndarray]:
    return {column: np.array(values) for column, values in KEPT[name]["states"].items()}


def alone(moments, spin, time) -> dict[str, np.ndarray]:
    """A free body at a time, by extrapolation."""
    bodies = {"mass": [1.0], "moments": [moments], "angular_velocity": [spin]}
    case = {"bodies": bodies, "forces": [], "times": [time]}
    with mpmath.workdps(30):
        found = reference.by_columns(*reference.by_extrapolation(case, 30, 1e-20))
    return {column: np.array(values)[0, 0] for column, values in found.items()}


def same(kept: Any, made: Any) -> bool:
    """Whether two cases are one, but for the last bits of a turned inertia: a product of matrices is the machine's."""
    if isinstance(kept, dict) and isinstance(made, dict):
        return kept.keys() == made.keys() and all(same(kept[key], made[key]) for key in kept)
    if isinstance(kept, list) and isinstance(made, list):
        return len(kept) == len(made) and all(map(same, kept, made))
    if isinstance(kept, float) and isinstance(made, float):
        return abs(kept - made) <= 2.0**-50 * max(abs(kept), abs(made), 0.25)
    return bool(kept == made)


def test_the_file_is_of_these_cases() -> None:
    assert same({name: kept["case"] for name, kept in KEPT.items()}, CASES)


# Figures of the cases of Hairer and Vilmart's driver, of Gazebo and of MuJoCo, found elsewhere in 34 to 40 digits from
# the decimal inputs: 1e-14 leaves the rounding of those.


def test_hairer_and_vilmarts_free_body() -> None:
    found = states("free_asymmetric")
    momentum = found["angular_velocity"][-1, 0] * [0.6, 0.8, 1.0]
    known = [1.76596250851820754, -0.695464197033089119, 0.779554981481871086]
    np.testing.assert_allclose(momentum, known, rtol=0, atol=1e-14)
    turned = [-0.570786951240350733, -0.299388571830790094, -0.206839086104673192, -0.736061364160793936]
    assert angle_between(found["orientation"][-1, 0], turned) < 1e-14


def test_tumbling_boxes() -> None:
    sides = np.array([0.1, 0.4, 0.9])
    box = ((sides @ sides - sides**2) / 12).tolist()
    found = alone(box, [0.1, 5.0, 0.1], 10.0)
    known = [2.75584040514684941, -3.7359635192162199, -3.16180900346751834]
    # Near the separatrix (1 − k² = 1.4e-4): the rounding of the moments is amplified e-fold 5 times or so.
    np.testing.assert_allclose(found["angular_velocity"], known, rtol=0, atol=1e-12)
    turned = [-0.619927562499452488, -0.277029150687194592, 0.698745723640310141, 0.225164563413958164]
    assert angle_between(found["orientation"], turned) < 1e-12
    found = alone([13 / 300, 1 / 30, 1 / 60], [1.0, 2.0, 3.0], 5.0)
    known = [0.280861940814600473, -2.43226693971279809, 2.75010148003398319]
    np.testing.assert_allclose(found["angular_velocity"], known, rtol=0, atol=2e-14)
    turned = [0.0235633573425886834, 0.0212620010520073973, -0.930519824912734775, -0.3648637429868626]
    assert angle_between(found["orientation"], turned) < 2e-14


def test_bruls_and_cardonas_top() -> None:
    found = states("bruls_cardona_top")
    places = [
        [0.6055505613771198, 0.5989576817949192, -0.5239830274300032],
        [0.173343964098386, 0.6400885920705688, -0.7484907911335813],
        [-0.1504168227456418, -0.7241655916368957, -0.6730222695604441],
    ]
    np.testing.assert_allclose(found["position"][:, 0], places, rtol=0, atol=1e-14)
    turned = [
        [0.4387810881265819, 0.5457283961454177, 0.08939975282400501, -0.7082791529743126],
        [-0.491079892550027, 0.350430030343621, -0.7879868875504857, 0.1229471350415335],
    ]
    # 300 rad later, with the 13 digits of the spin that was published as 150.
    assert (angle_between(found["orientation"][[0, 2], 0], turned) < 2e-12).all()
    spin = [0.1222332194973942, 150, -5.855624589205458]
    np.testing.assert_allclose(found["angular_velocity"][2, 0], spin, rtol=0, atol=2e-12)


def test_simo_and_wongs_top_nods_as_its_cubic_says() -> None:
    top = {
        "mass": [1.0],
        "moments": [[4.0, 4.0, 1.0]],  # 5 about the fixed point
        "position": [[0.0, -np.sin(0.3), np.cos(0.3)]],
        "orientation": [[np.sin(0.15), 0.0, 0.0, np.cos(0.15)]],
        "angular_velocity": [[0.0, 0.0, 50.0]],
        "pivot": [[0.0, 0.0, -1.0]],
    }
    period = 0.6822560158311819
    case = {"bodies": top, "forces": [["UniformField", {"g": [0.0, 0.0, -20.0]}]], "times": [period / 2, period]}
    world, found = reference.by_dop853(case)
    heights = np.array(reference.by_columns(world, found)["position"])[:, 0, 2]
    # At the ends of a nutation heights are stationary; DOP853 has them to 1e-12.
    np.testing.assert_allclose(heights, [0.9470957121658395, 0.955336489125606], rtol=0, atol=1e-12)


# Closed forms.


def test_drag_makes_the_spin_of_a_sphere_decay() -> None:
    case, found = CASES["rotational_drag"], states("rotational_drag")
    start = np.array(case["bodies"]["angular_velocity"][0])
    for at, t in enumerate(case["times"]):
        decay = np.exp(-0.1 / 0.4 * t)
        np.testing.assert_allclose(found["angular_velocity"][at, 0], start * decay, rtol=2e-15)
        angle = np.linalg.norm(start) * (1 - decay) * 0.4 / 0.1
        axis = start / np.linalg.norm(start)
        turned = [*(np.sin(angle / 2) * axis), np.cos(angle / 2)]
        assert angle_between(found["orientation"][at, 0], turned) < 1e-14


def test_a_symmetric_body_with_a_motor_on_board() -> None:
    """ω₃ grows evenly; ω₁ + i ω₂ is an integral, here by quadrature in 30 digits."""
    case, found = CASES["torque_along_body_axes"], states("torque_along_body_axes")
    a, _, c = map(mpmath.mpf, case["bodies"]["moments"][0])
    one, two, three = map(mpmath.mpf, case["bodies"]["angular_velocity"][0])
    x, y, z = map(mpmath.mpf, case["forces"][0][1]["torque"])
    with mpmath.workdps(30):

        def angle(t):
            return (c - a) / a * (three * t + z / c * t * t / 2)

        for at, t in enumerate(case["times"]):
            driven = mpmath.quad(lambda s: mpmath.expj(-angle(s)) * mpmath.mpc(x, y) / a, mpmath.linspace(0, t, 9))
            across = mpmath.expj(angle(t)) * (mpmath.mpc(one, two) + driven)
            known = [float(across.real), float(across.imag), float(three + z / c * t)]
            np.testing.assert_allclose(found["angular_velocity"][at, 0], known, rtol=0, atol=1e-15)


def test_a_pendulum_swings_as_elliptic_functions_say() -> None:
    """From the horizontal, m g l = 8.829 and 0.84 about the fixed point: sin(θ/2) = k cd(ω t), k² = ½ from below."""
    found, times = states("physical_pendulum"), CASES["physical_pendulum"]["times"]
    rate = np.sqrt(1.5 * 9.81 * 0.6 / (0.3 + 1.5 * 0.36))
    for at, t in enumerate(times):
        sine = np.sqrt(0.5) * float(mpmath.ellipfun("cd", rate * t, m=0.5))
        # The angle from below, π/2 at the start: the center is 0.6 (sin θ, −cos θ) from the fixed point, the origin.
        known = [0.0, 1.2 * sine * np.sqrt(1 - sine**2), -0.6 * (1 - 2 * sine**2)]
        np.testing.assert_allclose(found["position"][at, 0], known, rtol=0, atol=1e-14)


# What is conserved, of the states by DOP853.

ENERGY = [
    "free_asymmetric",
    "bruls_cardona_top",
    "asymmetric_top",
    "physical_pendulum",
    "gravity_gradient",
    "binary",
    "spring_to_a_place",
    "particles_about_a_body",
    "spring_to_a_particle",
]
MOMENTUM = [
    "binary",
    "gravity_gradient",
    "damped_springs_between_bodies",
    "particles_about_a_body",
    "spring_to_a_particle",
]


@pytest.mark.parametrize("name", CASES)
def test_another_integrator_agrees_and_conserves(name: str) -> None:
    case = CASES[name]
    world, found = reference.by_dop853(case)
    columns, kept = reference.by_columns(world, found), states(name)
    # Relative tolerance 1e-13 of a step, over up to some thousand steps.
    assert (angle_between(columns["orientation"], kept["orientation"]) < 2e-10).all()
    for column in ("position", "velocity", "angular_velocity"):
        np.testing.assert_allclose(columns[column], kept[column], rtol=2e-10, atol=2e-10)
    start = world.start()
    if name in ENERGY:
        assert world.energy(found[-1]) == pytest.approx(world.energy(start), rel=1e-11, abs=1e-11)
    if name in MOMENTUM:
        np.testing.assert_allclose(world.momentum(found[-1]), world.momentum(start), rtol=0, atol=1e-12)
        np.testing.assert_allclose(world.angular_momentum(found[-1]), world.angular_momentum(start), rtol=0, atol=1e-12)


def test_a_body_of_points_feels_what_the_points_feel() -> None:
    """MacCullagh's terms against the sums over the points of a small body, to the next order in its size."""
    rng = np.random.default_rng(5)
    shape = rng.normal(size=(8, 3))
    shape = np.concatenate([shape, -shape])  # no third moments: the next order is the fourth
    far, errors = np.array([0.7, -0.5, 0.4]), []
    for size in (0.02, 0.01):
        points = size * shape
        inertia = sum((p @ p * np.eye(3) - np.outer(p, p)) for p in points) / 16
        case = {
            "particles": {"mass": [2.0], "position": [far.tolist()]},
            "bodies": {"mass": [1.0], "inertia": [inertia.tolist()]},
            "forces": [["Gravity", {"G": 1.5}]],
        }
        world = reference.World(case)
        acceleration, torque = world.loads(0.0, *world.parts(world.start()), [np.eye(3).tolist()])
        d = far - points
        each = 1.5 * 2.0 / 16 * d / np.linalg.norm(d, axis=1)[:, None] ** 3
        exact = np.array([*each.sum(axis=0), *np.cross(points, each).sum(axis=0)])
        plain = np.array([*(1.5 * 2.0 * far / np.linalg.norm(far) ** 3), 0.0, 0.0, 0.0])
        found = np.array([*acceleration[1], *torque[0]])
        errors.append(np.abs(found - exact).max())
        assert errors[-1] < 0.02 * np.abs(found - plain).max()
    # Half the size, a sixteenth of what is left out.
    assert errors[0] / errors[1] == pytest.approx(16, rel=0.1)
