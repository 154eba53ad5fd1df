"""Every picture of a course of mechanics is a method of what it is of, and shows what is computed elsewhere."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import visviva as vv

pytest.importorskip("matplotlib")
from matplotlib.axes import Axes
from matplotlib.figure import Figure

ROUND = vv.systems.spherical_pendulum(position=[1.0, 0.0], velocity=[0.0, 2.0])
SWING = vv.systems.pendulum(g=9.81, l=1.0, position=[1.0])
SPRING = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]]), vv.Harmonic(k=4.0))
ROSETTE = vv.Scene(
    vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 0.5, 0.0]]), vv.CentralField(vv.potentials.Plummer(-1.0, 0.5))
)
PASSES = vv.events.plane([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], direction=1)
SECTION = ROSETTE.run(t=60.0, events=[PASSES]).events
POINTS = tuple(vv.Point("rk4", 0.1 / k, 1e-3 * k, 1e-3 / k**4, 1e-3 / k**4) for k in (1, 2, 4))
COUNTED = vv.scattering.monte_carlo(
    vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=100, seed=1, bins=4
)
WELL = vv.potentials.LennardJones(epsilon=1.0, sigma=1.0)
T = np.linspace(0.0, 3.0, 31)

#: By what is drawn: how it is called, of what it is of, and a name of an axis.
PICTURES: dict[str, tuple[Callable[[], Any], str]] = {
    "phase portrait of a Lagrangian": (lambda: SWING.plot_phase_portrait((-4, 4), (-8, 8), points=40), "theta"),
    "phase portrait of a Hamiltonian": (
        lambda: SWING.hamiltonian().plot_phase_portrait((-4, 4), (-8, 8), points=40), "theta"),
    "path of a run in phase space": (lambda: SWING.run(t=T).plot_phase(), "theta"),
    "path of a body in phase space": (lambda: SPRING.run(t=T).plot_phase(), "position, x"),
    "Poincaré section of a Hamiltonian": (lambda: vv.systems.henon_heiles().poincare("x", t=50.0).plot(), "y"),
    "Poincaré section of a scene": (lambda: SECTION.plot("y"), "position, y"),
    "polhode": (lambda: vv.rigid.polhode([1.0, 2.0, 3.0], [0.1, 1.0, 0.3]).plot(), "ωx / √2T"),
    "polhode of a free rotation": (
        lambda: vv.rigid.free_rotation([1.0, 2.0, 3.0], [0.1, 1.0, 0.3], T).plot("polhode"), "ωx / √2T"),
    "polhode of a body in a scene": (
        lambda: vv.Scene(vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0.0])).run(t=T)
        .body(0).turning.plot("polhode"), "ωx / √2T"),
    "effective potential of a Lagrangian": (lambda: ROUND.routhian().plot_effective_potential((0.1, 3.0)), "theta"),
    "effective potential of a Hamiltonian": (
        lambda: SWING.hamiltonian().plot_effective_potential((-4.0, 4.0)), "theta"),
    "effective potential of an orbit": (
        lambda: vv.orbits.central_orbit(
            vv.potentials.Coulomb(-1.0), position=[1.0, 0.0, 0.0], velocity=[0.0, 1.2, 0.0]
        ).plot("effective_potential"), "r"),
    "effective potential of a top": (
        lambda: vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0).solve(T, theta=0.3, psi_dot=50.0)
        .plot("effective_potential"), "θ"),
    "cross section of a potential": (
        lambda: vv.scattering.deflect(WELL, energy=2.0, impact_parameter=[0.5, 1.0]).plot("cross_section"),
        "angle in the center-of-mass frame [degrees]"),
    "cross section of a Monte Carlo": (
        COUNTED["cm_angle"].plot, ""),
    "work against precision": (lambda: vv.WorkPrecision("test", POINTS).plot(), "error of positions"),
}  # fmt: skip


@pytest.mark.parametrize("name", PICTURES)
def test_every_picture_is_a_method_of_what_it_is_of(name: str) -> None:
    call, label = PICTURES[name]
    drawn = call()
    assert isinstance(drawn, (Axes, Figure))
    axes = drawn if isinstance(drawn, Axes) else drawn.axes[0]
    assert axes.get_xlabel() == label
    lines = [np.array(line.get_data()) for line in axes.lines]
    assert any(line.size > 2 and np.isfinite(line).any() for line in lines) or axes.collections or axes.patches


def test_the_potential_of_a_reduced_system_is_that_of_the_book() -> None:
    """Goldstein: of a spherical pendulum p²/(2 m l² sin²θ) − m g l cos θ; the dots are where it turns."""
    reduced = ROUND.routhian()
    axes = reduced.plot_effective_potential((0.1, 3.0), points=401)
    curve, level, turns = axes.lines
    q, found = np.array(curve.get_data())
    mass, g, length = (ROUND.parameters[each] for each in ("m", "g", "l"))
    p_phi = float(ROUND.at(position=[1.0, 0.0], velocity=[0.0, 2.0]).momentum[1])
    expected = p_phi**2 / (2.0 * mass * length**2 * np.sin(q) ** 2) - mass * g * length * np.cos(q)
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    assert level.get_ydata()[0] == pytest.approx(ROUND.energy, rel=1e-14, abs=0.0)
    out = ROUND.run(t=np.linspace(0.0, 20.0, 4001))
    ends = np.sort(np.array(turns.get_xdata()))
    # Of straight lines between 401 places.
    np.testing.assert_allclose(ends, [out["theta"].min(), out["theta"].max()], rtol=0, atol=2e-4)
    # Walls go beyond what is shown.
    assert found.max() > axes.get_ylim()[1]


def test_potentials_of_both_kinds_of_systems_are_one() -> None:
    both = [each.plot_effective_potential((-4.0, 4.0)).lines[0].get_ydata() for each in (SWING, SWING.hamiltonian())]
    np.testing.assert_allclose(*both, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(both[0], -9.81 * np.cos(np.linspace(-4.0, 4.0, 600)), rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize(
    ("system", "position", "words"),
    [
        (vv.systems.double_pendulum(), (-1.0, 1.0), "one coordinate.*routhian"),
        (SWING, (1.0, -1.0), "the smaller end first"),
        (SWING, (0.0, np.nan), "position"),
        (
            vv.Hamiltonian(lambda q, p, t: np.cos(p[0]) + np.cos(q[0]), ["q"]),
            (-1.0, 1.0),
            "quadratic.*plot_phase_portrait",
        ),
        (vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - np.log(q[0]), ["q"], position=[1.0]), (-2.0, -1.0), "no|none"),
    ],
)
def test_potentials_that_cannot_be_drawn_are_refused_with_a_cure(system: Any, position: Any, words: str) -> None:
    with pytest.raises(vv.InvalidInput, match=words):
        system.plot_effective_potential(position)


def test_separatrices_look_alike_whatever_their_energies_are() -> None:
    """Of a bead on a turning hoop one passes the bottom, at −g, and one the top, at g."""
    hoop = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + 16.0 * np.sin(q[0]) ** 2) / 2 + 9.81 * np.cos(q[0]), ["theta"], position=[0.3]
    )
    axes = hoop.plot_phase_portrait((-4.0, 4.0), (-6.0, 6.0), points=80)
    strong = [lines for lines in axes.collections if np.allclose(lines.get_linewidths(), 1.4, rtol=1e-12, atol=0)]
    assert {round(float(lines.levels[0]), 6) for lines in strong} == {-9.81, 9.81}
    assert all(dashes is None for lines in strong for _, dashes in lines.get_linestyles())


def test_the_portrait_has_its_first_name_too() -> None:
    calls = (SWING.phase_portrait, SWING.plot_phase_portrait)
    levels = [call((-4, 4), (-8, 8), points=40).collections[0].levels for call in calls]
    assert np.array_equal(*levels)


def test_a_spring_goes_round_an_ellipse_in_phase_space() -> None:
    out = SPRING.run(t=np.linspace(0.0, 3.0, 201))
    axes = out.plot_phase()
    x, v = np.array(axes.lines[0].get_data())
    np.testing.assert_allclose(x**2 + v**2 / 4.0, 1.0, rtol=1e-13)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("position, x", "velocity, x")
    assert axes.lines[1].get_xydata()[0] == pytest.approx([x[-1], v[-1]], rel=1e-12, abs=0.0)
    planets = vv.problems.outer_solar_system().scene.run(t=np.linspace(0.0, 6e3, 61))
    two = planets.plot_phase("z", bodies=["Jupiter", "Saturn"])
    assert [text.get_text() for text in two.get_legend().get_texts()] == ["Jupiter", "Saturn"]
    saturn = planets["Saturn"]
    assert np.array_equal(two.lines[2].get_xydata(), np.column_stack([saturn.position[:, 2], saturn.velocity[:, 2]]))


def test_a_section_shows_the_events_and_nothing_else() -> None:
    axes = SECTION.plot()  # all of them have x = 0: the largest extent is y's
    assert np.array_equal(
        axes.lines[0].get_xydata(), np.column_stack([SECTION.position[:, 0, 1], SECTION.velocity[:, 0, 1]])
    )
    both = ROSETTE.run(t=60.0, events=[PASSES, vv.events.plane([0.0, 0.0, 0.0], [0.0, 1.0, 0.0])]).events
    assert [text.get_text() for text in both.plot("x").get_legend().get_texts()] == ["0 plane", "1 plane"]
    faster = ROSETTE.particles.velocity * np.linspace(0.5, 1.5, 5)[:, None, None]
    many = ROSETTE.ensemble(velocity=faster).run(t=60.0, events=[PASSES]).events
    drawn = many.plot("y")
    assert len(drawn.lines) == 5  # a color for each copy
    assert drawn.get_legend() is None
    assert sum(len(line.get_xdata()) for line in drawn.lines) == len(many)
    # Of files that are older than definitions.
    bare = replace(both, definitions=())
    assert len(bare.plot("x").lines) == 2


def test_a_section_of_many_copies_is_that_of_each() -> None:
    stars = vv.systems.henon_heiles().ensemble(position=[[0.0, 0.1], [0.0, 0.2]], momentum=[[0.4, 0.1], [0.4, 0.0]])
    table = stars.run(t=60.0, events=[vv.events.coordinate("x", direction=1)]).events
    axes = table.plot()  # y, the last
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("y", "momentum of y")
    for copy, line in enumerate(axes.lines):
        section = stars[copy].poincare("x", t=60.0)
        found = np.column_stack([section.position[:, 1], section.momentum[:, 1]])
        np.testing.assert_allclose(line.get_xydata(), found, rtol=0, atol=1e-9)
    assert table.plot("x").get_xlabel() == "x"
    assert table[:3].coordinates == table.of(0).coordinates == ("x", "y")
    for call, words in (
        (lambda: table.plot("z"), "name: expected one of"),
        (table[:0].plot, "plot: expected at least one event"),
    ):
        with pytest.raises(vv.InvalidInput, match=words):
            call()


def test_pictures_in_phase_space_refuse_by_name() -> None:
    out = vv.problems.figure_eight().scene.run(t=[0.0, 1.0], record=("position",))
    pair = vv.problems.kepler(e=0.5).scene.run(t=20.0, events=[vv.events.apsis(1, 0)]).events
    for call, words in (
        (out.plot_phase, "record: velocity was not recorded"),
        (lambda: SPRING.run(t=T).plot_phase("w"), "component: expected one of"),
        (lambda: SPRING.run(t=T).plot_phase(bodies=[3]), "bodies"),
        (lambda: SPRING.run(t=T).plot_phase(ax=3), "ax: expected axes of matplotlib"),
        (pair.plot, "body: say of which of 2 bodies, as body=0"),
        (lambda: pair.plot(body=2), "body"),
        (lambda: pair.plot("w", body=0), "component: expected one of"),
        (SECTION[:0].plot, "plot: expected at least one event"),
    ):
        with pytest.raises(vv.InvalidInput, match=f"^{words}"):
            call()


def test_the_whole_polhode_is_closed_and_between_its_separatrices() -> None:
    moments, spin = np.array([3.0, 1.0, 2.0]), np.array([0.3, 0.1, 1.0])
    path, _, *edges = vv.rigid.polhode(moments, spin).plot().axes[0].lines
    points = np.array(path.get_data_3d())
    np.testing.assert_allclose(points[:, 0], points[:, -1], rtol=0, atol=1e-12)
    np.testing.assert_allclose(moments @ points**2, 1.0, rtol=1e-14)
    ratio = (moments * spin) @ (moments * spin) / (moments @ spin**2)
    np.testing.assert_allclose(moments**2 @ points**2, ratio, rtol=1e-12)
    assert len(edges) == 2
    for edge in edges:
        line = np.array(edge.get_data_3d())
        np.testing.assert_allclose(moments @ line**2, 1.0, rtol=1e-13)
        np.testing.assert_allclose(moments**2 @ line**2, 2.0, rtol=1e-13)


def test_polhodes_that_take_forever_or_stand_still() -> None:
    moments = np.array([1.0, 2.0, 3.0])
    # L² = 2 T I₂: I₁ (I₂ − I₁) ω₁² = I₃ (I₃ − I₂) ω₃².
    found = vv.rigid.polhode([1.0, 2.0, 2.25], [0.75, 1.0, 1.0])
    assert found.kind == "separatrix"
    points = np.array(found.plot().axes[0].lines[0].get_data_3d())
    # From one end of the middle axis to the other.
    np.testing.assert_allclose(points[1, [0, -1]], [-(2.0**-0.5), 2.0**-0.5], rtol=0, atol=1e-8)
    still = np.array(vv.rigid.polhode(moments, [0.0, 1.0, 0.0]).plot().axes[0].lines[0].get_data_3d())
    assert np.ptp(still, axis=1) == pytest.approx([0.0, 0.0, 0.0], abs=1e-14)
    assert len(vv.rigid.polhode([1.0, 1.0, 2.0], [0.3, 0.0, 1.0]).plot().axes[0].lines) == 2  # no separatrix
    for given, words in (((moments, [0.0, 0.0, 0.0]), "at rest"), (([0.0, 1.0, 1.0], [0.0, 1.0, 0.0]), "of a rod")):
        with pytest.raises(vv.InvalidInput, match=words):
            vv.rigid.polhode(*given).plot()
