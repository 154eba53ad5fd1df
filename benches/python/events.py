"""What events cost: a run in which a hundred zeros are located, against the same run without events.

Whole `scene.run` calls, table and all. The peers' ratios are those that their authors and users give: heyoka 1.7 times,
Julia's Vern9 9 times.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from _harness import Row, minima, report

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Iterator

BAR = 1.5


def rows() -> Iterator[Row]:
    solar = vv.problems.outer_solar_system().scene
    # Jupiter's apsides about the Sun come every 2166 days.
    apsides = [vv.events.apsis(1, 0)]
    yield cost("six bodies, dop853, apsides", solar, 100.5 * 2166.0, apsides, {"method": "dop853", "rtol": 1e-12})
    kepler = vv.problems.kepler(e=0.5).scene
    pericenters = [vv.events.apsis(1, 0)]
    plane = [vv.events.plane([0, 0, 0], [0, 1.0, 0], body=1)]
    near = [vv.events.distance(0, 1, below=0.8, direction=0)]
    end = 50.2 * 2.0 * np.pi
    for name, asked in (("apsides", pericenters), ("a plane", plane), ("a distance", near)):
        yield cost(f"two bodies, dop853, {name}", kepler, end, asked, {"method": "dop853", "rtol": 1e-9})
    dt = 2.0 * np.pi / 500.0
    yield cost("two bodies, leapfrog, apsides", kepler, end, pericenters, {"method": "leapfrog", "dt": dt})
    yield cost("six bodies, leapfrog, apsides", solar, 100.5 * 2166.0, apsides, {"method": "leapfrog", "dt": 10.0})
    eight = vv.problems.figure_eight().scene
    copies = eight.ensemble(velocity=eight.particles.velocity * (1.0 + 1e-3 * np.arange(64))[:, None, None])
    yield cost("64 copies of three bodies, dop853, apsides", copies, 100.0, apsides, {"method": "dop853"}, bar=None)


def cost(
    name: str,
    scene: vv.Scene | vv.EnsembleScene,
    end: float,
    asked: list[vv.events.Event],
    options: dict[str, object],
    bar: float | None = BAR,
) -> Row:
    found = len(scene.run(t=end, events=asked, threads=1, **options).events)
    without, watched = minima(
        lambda: scene.run(t=end, threads=1, **options),
        lambda: scene.run(t=end, events=asked, threads=1, **options),
        repeats=60,
    )
    ratio = watched / without
    return Row(
        f"{name} ({found} found)",
        f"{watched * 1e3:.2f} ms against {without * 1e3:.2f}: {ratio:.3f} ×",
        "",
        "",
        "" if bar is None else f"≤ {bar:g} ×",
        None if bar is None else ratio <= bar,
    )


if __name__ == "__main__":
    report("Events", rows(), "Time of a run that locates events over that of the same run without.")
