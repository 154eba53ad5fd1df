"""Elements of a run are told in as many lines as there are elements, however many bodies and times there are."""

import numpy as np
import pytest

import visviva as vv

OUT = vv.datasets.outer_solar_system().scene.run(t=np.linspace(0.0, 1e4, 201), method="dop853")
NAMES = vv.orbits.Elements.__slots__
LINES = len(NAMES) + 3


def row(found: vv.orbits.Elements, name: str) -> list[str]:
    line = next(line for line in str(found).splitlines() if line.startswith(name))
    return [text.strip() for text in line.split("  ") if text]


def test_a_line_says_how_many_and_between_which_ends() -> None:
    found = OUT.elements(["Jupiter", "Saturn"], about="Sun")
    text = repr(found)
    assert text.startswith("Elements(2 bodies, 201 times, 0 to 10000; semi_major_axis ")
    low, high = found.semi_major_axis.min(), found.semi_major_axis.max()
    assert f"semi_major_axis {low:.6g} to {high:.6g}" in text
    assert len(text) < 150
    assert repr(vv.orbits.elements(1.0, [1.0, 0.0, 0.0], [0.0, 1.2, 0.0])) == (
        "Elements(1 orbit; semi_major_axis 1.78571; eccentricity 0.44)"
    )


@pytest.mark.parametrize("bodies", [["Jupiter"], "Jupiter", ["Jupiter", "Saturn"], None])
def test_print_and_notebook_are_one_short_table(bodies: list[str] | str | None) -> None:
    found = OUT.elements(bodies, about="Sun")
    lines = str(found).splitlines()
    assert len(lines) == LINES
    assert [line.split()[0] for line in lines[2:-1]] == list(NAMES)
    assert max(map(len, lines)) <= 120
    html = found._repr_html_()
    assert html.startswith("<table><caption>Elements")
    assert html.count("<tr>") == len(NAMES) + 1
    for name in NAMES:
        assert all(f"<td>{text}</td>" in html for text in row(found, name)[1:])


def test_of_one_or_two_bodies_the_first_and_the_last_values_are_told() -> None:
    both = OUT.elements(["Jupiter", "Saturn"], about="Sun")
    a = both.semi_major_axis
    ends = (a[0, 0], a[-1, 0], a[0, 1], a[-1, 1])
    assert row(both, "semi_major_axis") == ["semi_major_axis", *(f"{end:.6g}" for end in ends), "length"]
    assert "Jupiter, first" in str(both)
    assert row(both, "true_anomaly")[-1] == "rad"
    assert row(both, "period")[-1] == "time"
    alone = OUT.elements("Saturn", about="Sun")
    assert row(alone, "angular_momentum")[1] == f"[{' '.join(f'{x:.6g}' for x in alone.angular_momentum[0])}]"


def test_of_more_the_range_is_told() -> None:
    found = OUT.elements(about="Sun")
    e = found.eccentricity
    assert row(found, "eccentricity") == ["eccentricity", f"{e.min():.6g}", f"{e.max():.6g}", "1"]
    lengths = np.linalg.norm(found.angular_momentum, axis=-1)
    assert row(found, "angular_momentum")[1:3] == [f"{lengths.min():.6g}", f"{lengths.max():.6g}"]
    assert "5 bodies" in str(found)
    scene = vv.problems.kepler(e=0.5).scene
    copies = scene.ensemble(velocity=np.tile(scene.particles.velocity, (3, 1, 1))).run(t=[0.0, 1.0]).elements(about=0)
    assert "3 copies" in repr(copies)
    assert str(copies).splitlines()[0] == "Elements of 3 copies, 1 body, 2 times, 0 to 1"
    many = vv.orbits.elements(1.0, np.tile([1.0, 0.0, 0.0], (50, 1)), np.tile([0.0, 1.5, 0.0], (50, 1)))
    assert row(many, "period") == ["period", "inf", "inf", "time"]
    assert row(many, "eccentric_anomaly")[-1] == "1"


def test_of_a_few_orbits_at_one_time_every_value_is_told() -> None:
    now = OUT.scene.elements(about="Sun")
    html = now._repr_html_()
    for name in ("Jupiter", "Pluto"):
        assert f"<th>{name}</th>" in html
    for value in now.semi_major_axis:
        assert f"<td>{value:.9g}</td>" in html
        assert f"{value:.9g}" in str(now)
