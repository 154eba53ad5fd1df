"""Where constraints lose their rank on the way, no energy is lost in silence.

Bounds: a constraint is kept to some roundings, 1e-14, which near the change point the slope of one coordinate by the
other amplifies; energies over ten turns part by 1e-14, and ten times that is allowed.
"""

import numpy as np
import pytest
from scipy.integrate import quad

import visviva as vv

START = 0.5
#: x = 2 cos θ, so (1 + 4 sin²θ) θ'² is conserved; θ comes to π/2, where the gradient of the constraint vanishes, then.
CHANGE = quad(lambda a: np.sqrt((1 + 4 * np.sin(a) ** 2) / (1 + 4 * np.sin(START) ** 2)), START, np.pi / 2)[0]


def slider_crank() -> vv.Lagrangian:
    """A rod as long as the crank: at θ = π/2 the slider stands on the crank's axle, and may stay there."""
    return vv.Lagrangian(
        lambda q, v, t: v @ v / 2,
        ["theta", "x"],
        position=[START, 2 * np.cos(START)],
        velocity=[1.0, -2 * np.sin(START)],
        constraints=[lambda q, v, t: (q[1] - np.cos(q[0])) ** 2 + np.sin(q[0]) ** 2 - 1],
    )


@pytest.mark.parametrize("method", ["gauss16", "gauss8", "gauss4", "dop853", "taylor"])
@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-12])
def test_a_change_point_is_named_or_passed(method: str, rtol: float) -> None:
    t = np.linspace(0.0, 3.0, 61)
    try:
        out = slider_crank().run(t, method=method, rtol=rtol)
    except vv.ConvergenceError as failed:
        error: vv.ConvergenceError | None = failed
    else:
        error = None
    if error is not None:
        # A step may pass it, and a reading or a stage next to it fail.
        assert "singular configuration" in str(error) or "do not converge" in str(error)
        assert error.time == pytest.approx(CHANGE, abs=5e-2)
        assert isinstance(error.trajectory, vv.generalized.GeneralizedTrajectory)
        out = error.trajectory
        assert len(out.t) >= np.searchsorted(t, CHANGE) - 1
    # Velocities put right by no more than a millionth of their size, or a thousand tolerances.
    np.testing.assert_allclose(out.energy, out.energy[0], rtol=4 * max(1e-6, 1000 * rtol))


def test_up_to_the_change_point_the_motion_is_right() -> None:
    out = slider_crank().run(0.99 * CHANGE)
    np.testing.assert_allclose(out["x"], 2 * np.cos(out["theta"]), rtol=0, atol=4e-14)
    np.testing.assert_allclose(out.energy, out.energy[0], rtol=1e-14)


@pytest.mark.parametrize("length", [1.2, 2.0])
def test_a_longer_rod_has_no_change_point(length: float) -> None:
    """x = cos θ + √(l² − sin²θ) is regular everywhere: ten turns keep the energy."""
    crank = vv.Lagrangian(
        lambda q, v, t: v @ v / 2,
        ["theta", "x"],
        position=[0.0, 1.0 + length],
        velocity=[1.0, 0.0],
        constraints=[lambda q, v, t: (q[1] - np.cos(q[0])) ** 2 + np.sin(q[0]) ** 2 - length**2],
    )
    out = crank.run(60.0)
    assert out["theta"][-1] > 2 * np.pi
    np.testing.assert_allclose(out.energy, out.energy[0], rtol=2e-13)
