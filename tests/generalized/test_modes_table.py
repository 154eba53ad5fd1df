"""Small motions are told by their frequencies, in print, in a line and in a notebook.

Bounds: a table shows eight or nine digits.
"""

import math

import numpy as np
import pytest

import visviva as vv

x, y, t = vv.coordinate("x"), vv.coordinate("y"), vv.time
KINETIC = (x.diff(t) ** 2 + y.diff(t) ** 2) / 2
DOUBLE = vv.systems.double_pendulum(position=[0.0, 0.0]).normal_modes()


def rows(small: vv.generalized.Linearization) -> list[list[str]]:
    """The lines of the motions, cut where two spaces are."""
    lines = [line for line in str(small).splitlines()[2:] if line[0].isdigit()]
    return [[text.strip() for text in line.split("  ") if text] for line in lines]


def test_frequencies_come_first_and_have_a_unit() -> None:
    told = str(DOUBLE)
    header = told.splitlines()[1].split()
    assert header[:3] == ["angular", "frequency", "period"]
    assert "radians per unit of time" in told
    for row, frequency, mode in zip(rows(DOUBLE), DOUBLE.frequencies, DOUBLE.modes, strict=True):
        # Eight printed digits, and six of the modes.
        assert float(row[1]) == pytest.approx(frequency, rel=1e-8, abs=0)
        assert float(row[2]) == pytest.approx(2.0 * math.pi / frequency, rel=1e-8, abs=0)
        assert [float(text) for text in row[3].strip("()").split(",")] == pytest.approx(list(mode), rel=1e-5, abs=0)
    assert DOUBLE.coordinates == ("theta1", "theta2")
    assert "shape (theta1, theta2)" in told


def test_a_notebook_and_a_line_show_the_same() -> None:
    html = DOUBLE._repr_html_()
    assert html.index("angular frequency") < html.index("shape")
    for row in rows(DOUBLE):
        assert all(f"<td>{text}</td>" in html for text in row[1:])
    assert repr(DOUBLE) == "Linearization(frequencies=array([2.3971994, 5.7873513]), stable=True)"


def test_what_is_damped_has_rates() -> None:
    """A pair 2 ± and an overdamped coordinate: λ = −0.1 ± i√(4 − 0.01) and −2 ± √3."""
    system = vv.Lagrangian(
        KINETIC - 2 * x**2 - y**2 / 2,
        coordinates=[x, y],
        dissipation=0.1 * x.diff(t) ** 2 + 2 * y.diff(t) ** 2,
    )
    found = sorted((float(row[1]), row[2], float(row[3].split()[-1])) for row in rows(system.normal_modes()))
    assert [row[0] for row in found] == pytest.approx([0.0, 0.0, math.sqrt(3.99)], rel=4e-8, abs=0)
    assert [row[2] for row in found] == pytest.approx(
        [2.0 - math.sqrt(3.0), 2.0 + math.sqrt(3.0), 0.1], rel=2e-8, abs=0
    )
    assert [row[1] == "none" for row in found] == [True, True, False]
    assert str(system.normal_modes()).count("decays at the rate") == 3


def test_what_grows_or_stays_nowhere_says_so() -> None:
    top = vv.systems.pendulum(g=9.81, l=1.0).linearize(at=[np.pi])
    assert rows(top)[0][1:4] == ["0", "none", f"grows at the rate {math.sqrt(9.81):.9g}"]
    assert "unstable" in str(top).splitlines()[0]
    free = vv.Lagrangian(KINETIC - 2 * x**2, coordinates=[x, y]).normal_modes()
    assert [row[3] for row in rows(free)] == ["moves on, neither grows nor returns", "stays"]


def test_nothing_is_cut_within_a_number() -> None:
    many = vv.systems.coupled_oscillators(30).normal_modes()
    assert "and 18 more" in str(many)
    assert len(rows(many)) == 12
    assert all("… 22 more" in row[3] for row in rows(many))
    assert len(repr(many)) < 150
    # Of any record: what is left out is left out from a comma on.
    long = vv.generalized.Equilibrium(
        np.linspace(0.1, 1.0, 9) / 3.0, True, np.linspace(1.0, 2.0, 9) / 3.0, np.linspace(3.0, 4.0, 9) / 7.0
    )
    text = repr(long)
    assert len(text) <= 300
    assert text.endswith(", …)")
    last = float(text.removesuffix(", …)").rsplit(", ", 1)[1].split("[")[-1])
    assert np.abs(np.concatenate([long.position, long.frequencies, long.momentum]) - last).min() < 1e-8
