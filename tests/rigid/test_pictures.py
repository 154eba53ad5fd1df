"""Pictures of rigid motions, by what is drawn: the curves must lie where Poinsot and the theory of tops have them.

Bounds: what is drawn is computed from the states by some ten operations, whose energies and momenta a run keeps to
1e-14.
"""

import sys

import numpy as np
import pytest

import visviva as vv

T = np.linspace(0.0, 30.0, 801)
MOMENTS = np.array([1.0, 2.0, 2.5])
OUT = vv.rigid.free_rotation(MOMENTS, [0.3, 0.9, -0.5], T, orientation=[0.5, -0.5, 0.5, 0.5])
TOP = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
START = {"theta": 0.3, "psi_dot": 50.0, "phi_dot": 0.2, "theta_dot": -0.1}
SPUN = TOP.solve(T, **START)


def drawn(line):
    """The three columns of a curve in space."""
    return np.array(line.get_data_3d()).T


def test_the_polhode_lies_on_both_ellipsoids():
    path = drawn(OUT.plot("polhode").axes[0].lines[0])
    assert len(path) == len(T)
    assert (MOMENTS * path**2).sum(axis=-1) == pytest.approx(1.0, rel=1e-14, abs=0)
    momentum = ((MOMENTS * path) ** 2).sum(axis=-1)
    assert momentum == pytest.approx(OUT.casimir[0] / (2 * OUT.energy[0]), rel=1e-14, abs=0)
    assert np.ptp(path, axis=0).min() > 0.1


def test_the_herpolhode_lies_on_a_plane_and_rolls():
    axes = OUT.plot("herpolhode").axes[0]
    x, y = np.array(axes.lines[0].get_xdata()), np.array(axes.lines[0].get_ydata())
    # ω·L = 2T: what is left of |ω| lies in the plane.
    momentum = np.sqrt(OUT.casimir[0])
    left = (OUT.angular_velocity**2).sum(axis=-1) - (2 * OUT.energy[0] / momentum) ** 2
    assert x**2 + y**2 == pytest.approx(left, rel=1e-11, abs=1e-13)
    # Seen from where the angular momentum points to: counterclockwise, as fast as the body's axis on average.
    turned = np.unwrap(np.arctan2(y, x))
    rate = vv.rigid.polhode(MOMENTS, [0.3, 0.9, -0.5]).precession_rate
    assert turned[-1] - turned[0] == pytest.approx(rate * T[-1], abs=np.pi)


def test_traces_are_unit_vectors_and_the_angular_momentum_is_theirs():
    *axes, along = [drawn(line) for line in OUT.plot("axes").axes[0].lines]
    assert len(axes) == 3
    for path in axes:
        assert (path**2).sum(axis=-1) == pytest.approx(1.0, rel=1e-14, abs=0)
    direction = along[1] / np.linalg.norm(along[1])
    sums = sum(OUT.body_angular_momentum[:, [at]] * path for at, path in enumerate(axes))
    assert sums == pytest.approx(np.tile(direction * np.sqrt(OUT.casimir[0]), (len(T), 1)), rel=1e-13, abs=1e-13)


def test_components_and_angles_against_time():
    lines = OUT.plot("components").axes[0].lines
    assert np.array_equal(np.array([line.get_ydata() for line in lines]).T, OUT.angular_velocity)
    (line,) = SPUN.plot("theta").axes[0].lines
    assert np.array_equal(line.get_ydata(), SPUN.theta)


def test_the_nutation_trace_stays_between_its_circles():
    low, high, path, _ = [drawn(line) for line in SPUN.plot().axes[0].lines]
    expected = TOP.nutation_range(**START)
    assert (low[0, 2], high[0, 2]) == pytest.approx(np.cos(expected), rel=1e-14, abs=0)
    assert np.array_equal(path, SPUN.axis)
    assert high[0, 2] - 1e-13 <= path[:, 2].min() < path[:, 2].max() <= low[0, 2] + 1e-13


def test_long_paths_are_thinned():
    out = vv.rigid.free_rotation(MOMENTS, [0.3, 0.9, -0.5], np.linspace(0.0, 10.0, 20_001))
    assert len(drawn(out.plot().axes[0].lines[0])) <= 5001


def test_times_in_any_order():
    mixed = np.random.default_rng(1).permutation(T)
    out = vv.rigid.free_rotation(MOMENTS, [0.3, 0.9, -0.5], mixed, orientation=[0.5, -0.5, 0.5, 0.5])
    for kind in ("polhode", "axes"):
        for line, other in zip(out.plot(kind).axes[0].lines, OUT.plot(kind).axes[0].lines, strict=True):
            assert drawn(line) == pytest.approx(drawn(other), rel=1e-14, abs=1e-15)
    assert np.array_equal(out.plot("components").axes[0].lines[0].get_xdata(), T)


def test_tops_at_the_poles():
    """Asleep, hanging, through both poles: finite, and the axis where it is."""
    for start in (
        {"theta": 0.0, "psi_dot": 50.0},
        {"theta": np.pi, "psi_dot": 0.0},
        {"theta": 0.0, "psi_dot": 3.0, "theta_dot": 2.0},
        {"theta": 1.0, "psi_dot": 0.0},
    ):
        out = TOP.solve(T, **start)
        for values in (out.angular_velocity, out.angular_momentum, out.energy, out.casimir):
            assert np.all(np.isfinite(values)), start
        _, _, path, _ = [drawn(line) for line in out.plot().axes[0].lines]
        assert np.array_equal(path, out.axis)
        assert np.abs(out.energy - out.energy[0]).max() <= 2e-14 * (np.abs(out.energy[0]) + 20.0)


def test_sizes_do_not_matter():
    """Spins of 1e-160 and 1e150, whose squares are no numbers, have the same polhode."""
    paths = []
    for size in (1e-160, 1.0, 1e150):
        out = vv.rigid.free_rotation(MOMENTS, size * np.array([0.3, 0.9, -0.5]), T / size)
        paths.append(drawn(out.plot().axes[0].lines[0]))
    assert paths[0] == pytest.approx(paths[1], rel=1e-12, abs=1e-12)
    assert paths[2] == pytest.approx(paths[1], rel=1e-12, abs=1e-12)


REST = vv.rigid.free_rotation(MOMENTS, [0.0, 0.0, 0.0], T)
ROD = vv.rigid.free_rotation([0.0, 1.0, 1.0], [0.0, 0.3, 0.4], T)


@pytest.mark.parametrize(
    ("call", "argument", "words"),
    [
        (lambda: OUT.plot("polhodes"), "kind", "'polhodes'; did you mean 'polhode'"),
        (lambda: OUT.plot(3), "kind", "expected one of 'polhode'"),
        (lambda: SPUN.plot("polhode"), "kind", "expected one of 'nutation', 'theta'"),
        (REST.plot, "plot", "at rest"),
        (lambda: REST.plot("herpolhode"), "plot", "at rest"),
        (lambda: REST.plot("axes"), "plot", "at rest"),
        (ROD.plot, "plot", "of a rod has no end"),
        (lambda: vv.rigid.free_rotation(MOMENTS, [1, 1, 1], 3.0).plot(), "plot", "several times, got 1 time"),
        (lambda: vv.rigid.free_rotation(MOMENTS, [1, 1, 1], []).plot(), "plot", "several times, got 0 times"),
        (lambda: TOP.solve(1.0, **START).plot(), "plot", "several times"),
    ],
)
def test_what_cannot_be_drawn(call, argument, words):
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        call()
    assert caught.value.argument == argument
    assert ROD.plot("axes").axes


def test_matplotlib_may_be_missing(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(vv.InvalidInput, match="matplotlib is not installed"):
        OUT.plot()


def test_constants_of_the_heavy_top():
    """Energy, p_φ (twice: in space, and as the Casimir function in the body) and the spin stay to rounding.

    Nearly through both poles, and in a stretch of 30 nutations; 1e-13 of the largest, 4 ε times the angle turned.
    """
    for start in (START, {"theta": 3.1415926, "psi_dot": 3.0, "theta_dot": 6.0}, {"theta": 1e-7, "psi_dot": 4.0}):
        out = TOP.solve(np.linspace(0.0, 20.0, 401), **start)
        size = np.abs(out.body_angular_momentum).max()
        scale = out.energy[0] + 2 * TOP.mass * TOP.g * TOP.R
        assert np.abs(out.energy - out.energy[0]).max() <= 1e-12 * scale
        sine, cosine = np.sin(start["theta"]), np.cos(start["theta"])
        spin = start["psi_dot"] + start.get("phi_dot", 0.0) * cosine
        p_phi = TOP.A * start.get("phi_dot", 0.0) * sine**2 + TOP.C * spin * cosine
        for constant in (out.casimir, out.angular_momentum[:, 2]):
            assert np.abs(constant - p_phi).max() <= 1e-12 * size
        assert np.abs(out.angular_velocity[:, 2] - spin).max() <= 1e-12 * size


def test_the_torque_turns_the_angular_momentum_of_a_top():
    """dL/dt = R × M g, by central differences: h² L'''/6 is 1e-6 of it at h = 1e-4."""
    t, h = np.linspace(0.0, 5.0, 41), 1e-4
    before, here, after = (TOP.solve(t + shift, **START) for shift in (-h, 0.0, h))
    change = (after.angular_momentum - before.angular_momentum) / (2 * h)
    torque = np.cross(here.axis, [0.0, 0.0, -TOP.mass * TOP.g * TOP.R])
    assert change == pytest.approx(torque, abs=3e-5)


def test_what_stays_of_a_free_body():
    momentum = OUT.body_angular_momentum
    assert OUT.casimir == pytest.approx((momentum[0] ** 2).sum(), rel=1e-13, abs=0)
    assert OUT.casimir == pytest.approx((OUT.angular_momentum**2).sum(axis=-1), rel=1e-13, abs=0)
    single = vv.rigid.free_rotation(MOMENTS, [1.0, 2.0, 3.0], 0.0)
    assert single.casimir == pytest.approx(1 + 16 + 56.25, rel=1e-14, abs=0)


def test_pictures_go_where_they_are_asked_to():
    from matplotlib.figure import Figure

    figure = Figure()
    flat, solid = figure.add_subplot(1, 2, 1), figure.add_subplot(1, 2, 2, projection="3d")
    assert OUT.plot("components", ax=flat) is figure
    assert OUT.plot("polhode", ax=solid) is figure
    assert len(flat.lines) == 3
    assert SPUN.plot("theta", ax=flat) is figure
    for motion, kind, wrong in ((OUT, "polhode", flat), (OUT, "herpolhode", solid), (SPUN, "nutation", flat)):
        with pytest.raises(vv.InvalidInput, match=r"^ax: expected axes of (two|three) dimensions"):
            motion.plot(kind, ax=wrong)
