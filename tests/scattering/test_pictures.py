"""Pictures of scattering, by what is drawn: lines where there are motions, breaks where the function has them.

Bounds: what is drawn is the number itself, in degrees: some roundings.
"""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from drawn import columns, named, nothing_is_clipped

import visviva as vv

pytest.importorskip("matplotlib")
ATOM = vv.potentials.LennardJones(epsilon=1.0, sigma=1.0)
B = np.linspace(0.0, 3.0, 601)


def deflect(potential: vv.potentials.Potential, energy: Any, b: Any = B) -> vv.scattering.Deflection:
    return vv.scattering.deflect(potential, energy=energy, impact_parameter=b)


def fits(figure: Any, *, beside: bool = True) -> None:
    """Nothing is clipped, and the legend lies beside the lines."""
    nothing_is_clipped(figure)
    for axes in figure.axes:
        if beside and axes.get_legend() is not None:
            assert axes.get_legend().get_window_extent().x0 >= axes.get_window_extent().x1


def test_each_energy_is_a_line_with_its_rainbow() -> None:
    found = deflect(ATOM, [[2.0], [10.0]])
    figure = found.plot()
    axes = figure.axes[0]
    for at, label in enumerate(("E = 2", "E = 10")):
        b, psi = columns(named(axes)[label])
        assert (b == B).all()
        assert (psi == np.degrees(found.angle[at])).all()
        # The mark of the rainbow is where the line is lowest, which is found from the line alone here.
        [mark] = [
            line for line in axes.lines if line.get_marker() == "o" and line.get_color() == axes.lines[at].get_color()
        ]
        x, y = columns(mark)
        assert abs(x[0] - B[psi.argmin()]) < 0.01
        assert y[0] == pytest.approx(psi.min(), rel=1e-3, abs=0)
    # Of E = 10 one impact parameter leads straight on; at E = 2, one too: there the line crosses 0.
    glories = [columns(line) for line in axes.lines if line.get_marker() == "s"]
    assert sorted(float(x[0]) for x, _ in glories) == pytest.approx(
        [B[np.flatnonzero(np.diff(np.sign(np.degrees(row))))[0]] for row in found.angle[::-1]], abs=0.006
    )
    fits(figure)


def test_the_line_breaks_at_an_orbit_and_goes_no_farther_than_can_be_read() -> None:
    found = deflect(ATOM, 0.4)
    figure = found.plot()
    axes = figure.axes[0]
    [orbit] = vv.scattering.orbiting(ATOM, energy=0.4)
    b, psi = columns(named(axes)["E = 0.4"])
    assert np.isnan(psi[b == orbit.impact_parameter]).all()
    for (x0, y0), (x1, y1) in pairwise(zip(b, psi, strict=True)):
        assert not (x0 < orbit.impact_parameter < x1 and np.isfinite(y0) and np.isfinite(y1))
    assert any(line.get_linestyle() == ":" and columns(line)[0][0] == orbit.impact_parameter for line in axes.lines)
    low, high = axes.get_ylim()
    assert -900.0 < low < -360.0
    assert 180.0 < high < 220.0
    # Whatever is marked is within.
    for line in axes.lines:
        if line.get_marker() in ("o", "s"):
            assert low < columns(line)[1][0] < high
    fits(figure)


def test_nothing_is_drawn_of_what_is_captured() -> None:
    ion = vv.potentials.PowerLaw(-1.0, 4)
    edge = np.sqrt(vv.scattering.capture_cross_section(ion, energy=1.0) / np.pi)
    for kind in ("angle", "closest_approach"):
        b, values = columns(named(deflect(ion, 1.0).plot(kind).axes[0])["E = 1"])
        assert np.isnan(values[b < edge]).all()
        assert np.isfinite(values[b > edge]).all()


def test_a_cross_section_sums_up_to_the_total_one() -> None:
    """∫ dσ/dΩ 2π sin θ dθ over what is drawn, for a potential without a rainbow: trapezoids of half a degree, the
    first of which, where σ falls as θ⁻⁴, are a hundredth too large."""
    screened = vv.potentials.Yukawa(1.0, 1.0)
    figure = deflect(screened, [[0.5], [2.0]]).plot("cross_section")
    axes = figure.axes[0]
    assert axes.get_yscale() == "log"
    for energy, label in ((0.5, "E = 0.5"), (2.0, "E = 2")):
        degrees, sigma = columns(named(axes)[label])
        angle = np.radians(degrees)
        area = np.trapezoid(2.0 * np.pi * np.sin(angle) * sigma, angle)
        first, last = (
            vv.scattering.total_cross_section(screened, energy=energy, theta_min=at) for at in angle[[0, -1]]
        )
        assert area == pytest.approx(first - last, rel=0.02, abs=0)
    fits(figure)


def test_a_cross_section_breaks_at_its_rainbow() -> None:
    axes = deflect(ATOM, 2.0).plot("cross_section").axes[0]
    [bow] = vv.scattering.rainbows(ATOM, energy=2.0)
    edge = np.degrees(abs(bow.angle))
    degrees, sigma = columns(named(axes)["E = 2"])
    assert np.isnan(sigma[degrees == edge]).all()
    # Dark beyond, bright before: two branches more.
    bright, dark = sigma[np.flatnonzero(degrees == edge)[0] + np.array([-1, 1])]
    assert bright > 5.0 * dark
    assert (np.diff(degrees) > 0.0).all()


def test_equal_cross_sections_are_on_a_straight_scale() -> None:
    axes = deflect(vv.potentials.HardSphere(2.0), 1.0).plot("cross_section").axes[0]
    assert axes.get_yscale() == "linear"
    assert columns(axes.lines[0])[1] == pytest.approx(1.0)  # R²/4
    assert axes.get_ylim()[0] == 0.0


def test_the_closest_approach_is_beside_a_straight_line() -> None:
    found = deflect(vv.potentials.Coulomb(1.0), 1.0)
    axes = found.plot("closest_approach").axes[0]
    b, nearest = columns(named(axes)["E = 1"])
    # r of the turning point, 1/2E + √(1/4E² + b²).
    assert nearest == pytest.approx(0.5 + np.sqrt(0.25 + b**2), rel=1e-12, abs=0)
    assert "straight on" in named(axes)


def test_axes_of_ones_own_and_single_motions() -> None:
    from matplotlib.figure import Figure

    own = Figure().add_subplot()
    assert deflect(ATOM, 1.0, 2.0).plot(ax=own) is own.figure
    b, psi = columns(own.lines[0])
    assert b.tolist() == [2.0]
    angle = vv.scattering.deflection_angle(ATOM, energy=1.0, impact_parameter=2.0)
    assert np.radians(psi[0]) == pytest.approx(angle, rel=1e-14, abs=0)
    assert own.lines[0].get_marker() == "o"


@pytest.mark.parametrize(
    ("found", "kind", "argument"),
    [
        (deflect(ATOM, 1.0), "angel", "kind"),
        (deflect(ATOM, 1.0), 3, "kind"),
        (deflect(ATOM, np.linspace(1.0, 2.0, 29)[:, None], [1.0, 2.0]), "angle", "plot"),
        (deflect(ATOM, 1.0, []), "angle", "plot"),
    ],
)
def test_what_is_no_picture_is_refused_by_name(found: vv.scattering.Deflection, kind: Any, argument: str) -> None:
    with pytest.raises(vv.InvalidInput, match=rf"^{argument}: "):
        found.plot(kind)


def test_a_run_draws_all_its_tallies() -> None:
    run = vv.scattering.monte_carlo(
        vv.potentials.Coulomb(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=3.0, n_events=5000, seed=1, bins=20,
        tally=["cm_angle", ("lab_angle", "energy")],
    )  # fmt: skip
    figure = run.plot()
    one, left, joint, bar = figure.axes
    assert left.get_xlabel() == "angle in the center-of-mass frame [degrees]"
    assert one.get_shared_x_axes().joined(one, left)
    assert (joint.get_xlabel(), joint.get_ylabel()) == ("laboratory angle [degrees]", "energy afterwards")
    assert bar.get_ylabel() == "events per bin"
    counts = run["lab_angle", "energy"].counts
    [mesh] = joint.collections
    drawn = np.ma.filled(mesh.get_array().astype(float), 0.0).reshape(20, 20)  # type: ignore[union-attr]
    assert (counts == drawn.T).all()
    # What counted nothing is white, and of no color.
    assert np.ma.count_masked(np.ma.masked_invalid(mesh.get_array())) == (counts == 0).sum()  # type: ignore[arg-type]
    fits(figure, beside=False)
