"""Work against precision on the problems of `visviva.problems`, beside REBOUND, heyoka and SciPy in the same run.

Every method is taken through all its steps or tolerances (`visviva.work_precision`), and so is every peer; what is
timed is the integration alone: compiling, making of objects and output are not in it. SciPy gets its right-hand side in
NumPy as a careful user writes it; a right-hand side that does nothing would cost it as much. The page of the site
(docs/work-precision/index.md) with a picture for each problem, errors on x, seconds on y, is written by

    python benches/python/work_precision.py [--seconds 0.3] [--repeats 3] [--output FOLDER] [PROBLEM …]

In its quick form, `--seconds 0.1 --repeats 2`, it takes some minutes. What takes far longer than the best that there is
cannot change who is best, and is not taken further: no method of ours beyond `ENOUGH` times what DOP853 takes at its
tightest tolerance, no peer beyond its patience, a multiple of that; and no peer's run again that took hundreds of times
ours of the same error. What a peer did not reach for want of patience is told as that, with the least by which it lost.
"""

from __future__ import annotations

import argparse
import os
import re
import shlex
import sys
import warnings
from functools import partial
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from textwrap import fill, wrap
from typing import TYPE_CHECKING, Any

from _harness import Row, machine
from _peers import PEERS, Peer

import visviva as vv
from visviva.plot import new_figure

if TYPE_CHECKING:
    from collections.abc import Iterator

    from _peers import Once

PROBLEMS: dict[str, vv.problems.Problem] = {
    **{f"kepler, e = {e:g}, 10 periods": vv.problems.kepler(e=e, periods=10) for e in (0.0, 0.6, 0.9, 0.99)},
    "applegate, 3.65e6 d": vv.problems.outer_solar_system("applegate"),
    "figure-eight, 100 periods": vv.problems.figure_eight(100),
    "pythagorean, t = 30": vv.problems.pythagorean(),
    "pleiades": vv.problems.pleiades(),
    "arenstorf": vv.problems.arenstorf(),
    "driven oscillator": vv.problems.driven_oscillator(),
    "crossed fields": vv.problems.crossed_fields(),
    "projectile, quadratic drag": vv.problems.projectile(),
}
BARS = {"SciPy": 50.0, "REBOUND": 3.0, "heyoka": 1.0}
# Our methods are taken as far as so many of DOP853's most exact runs would take, and at least some milliseconds; and
# whatever is asked, as far as so many.
ENOUGH, LEAST, ASKED_OR = 20.0, 5e-3, 4.0
# What is farther off than that is no answer, and in no picture.
ROUGHEST = 1.0


class Transformed(Peer):
    """Our own leapfrog and its composition of order 8 with steps that are equal in another time."""

    def points(self) -> Iterator[vv.Point]:
        for monitor in ("potential_energy", "distance"):
            for method in ("leapfrog", "yoshida8"):
                prepare = partial(self.prepare, method, monitor)
                try:
                    self.scene.plan(self.end, method=method, dt=1e-4 * self.end, time_transformation=monitor)
                except vv.InvalidInput:  # a scene without pairs, or a problem with forces that look at velocities
                    continue
                yield from self.sweep(f"{method}, {monitor}", self.steps(), prepare)

    def prepare(self, method: Any, monitor: Any, dt: float) -> Once:
        def once() -> Any:
            out = self.scene.run(self.end, method=method, dt=dt, time_transformation=monitor)
            return out.position[-1], out.velocity[-1]

        return once


def limit(problem: vv.problems.Problem, seconds: float) -> float:
    """How long a run of ours may take before its method is taken no further."""
    exact = vv.work_precision(problem, ["dop853"], seconds=seconds, repeats=3)
    finest = max((point.seconds for point in exact.points), default=seconds)
    return min(max(seconds, ASKED_OR * finest), max(LEAST, ENOUGH * finest))


def verdicts(name: str, found: vv.WorkPrecision, peers: dict[str, Peer]) -> Iterator[Row]:
    """Our best method against the best of each peer at equal errors, and our symplectic ones against theirs.

    A closed form is in the tables and in no verdict: peers integrate.
    """
    own = [series for series in found.series if series != "auto" and series.partition(" ")[0] not in BARS]
    symplectic = [str(method.name) for method in vv.methods() if method.symplectic]

    def best(of: list[str], error: float) -> vv.Point | None:
        points = [point for each in of if (point := found.best(error, each)) is not None]
        return min(points, key=lambda point: point.seconds, default=None)

    for error in (1e-6, 1e-9, 1e-12):
        for peer, bar in BARS.items():
            series = [each for each in found.series if each.startswith(peer)]
            if series or peers[peer].out_of_patience:
                theirs = best(series, error) or unreached(peer, peers[peer])
                yield row(f"{name}, to {error:g}", best(own, error), theirs, bar)
        if "applegate" not in name or error == 1e-12:
            continue
        for one in [f"REBOUND leapfrog {order}" for order in (4, 6, 8)] + ["REBOUND whfast", "REBOUND saba"]:
            theirs = best([one], error) or unreached(one, peers["REBOUND"])
            asked = 2.0 if "leapfrog" in one else None
            yield row(f"{name}, to {error:g}, symplectic", best(symplectic, error), theirs, asked)


def unreached(name: str, peer: Peer) -> tuple[str, float]:
    """What is told of a peer that did not come to an error, and the least time that it would take."""
    if not any(each.startswith(name) for each in peer.out_of_patience):
        return f"{name} not at all", float("inf")
    return f"{name} not in {peer.seconds:.3g} s", peer.seconds


def row(what: str, ours: vv.Point | None, theirs: vv.Point | tuple[str, float], bar: float | None) -> Row:
    """Ours against a peer's best, or against the least that it would take."""
    asked = "" if bar is None else f"≥ {bar:g} ×"
    reached = isinstance(theirs, vv.Point)
    if isinstance(theirs, vv.Point):
        told, least = f"{theirs.series} {theirs.seconds * 1e3:.3g} ms", theirs.seconds
    else:
        told, least = theirs
    if ours is None:
        return Row(what, "none", told, "", asked, False if reached and bar is not None else None)
    ratio = least / ours.seconds
    # A peer that loses by nobody knows how much, perhaps less than the bar, is no pass and no miss.
    passed = None if bar is None or (not reached and ratio < bar) else ratio >= bar
    shown = f"{'' if reached else '> '}{ratio:.2f} ×" if ratio < float("inf") else ""
    return Row(what, f"{ours.series} {ours.seconds * 1e3:.3g} ms", told, shown, asked, passed)


def leaders(found: vv.WorkPrecision) -> tuple[list[str], list[str]]:
    """Our methods and those of peers that are the fastest of their package to some error: what a picture can hold.

    A closed form, which is the fastest to all, is none of them: it is drawn by itself.
    """
    own = [each for each in found.series if each.partition(" ")[0] not in ("auto", *BARS)]
    packages = [own, *([each for each in found.series if each.partition(" ")[0] == peer] for peer in BARS)]

    def fastest(series: list[str]) -> list[str]:
        front = [point for point in found.only(series).envelope() if point.position_error < ROUGHEST]
        return [each for each in series if any(point.series == each for point in front)]

    ours, *peers = map(fastest, packages)
    return ours, [each for series in peers for each in series]


def slug(name: str) -> str:
    """The name of a problem as that of a file."""
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")


def picture(name: str, found: vv.WorkPrecision, folder: Path) -> Path:
    """A picture of a problem: the fastest methods of each package, the machine below."""
    figure, (axes,) = new_figure(1, (8.0, 4.4))
    ours, peers = leaders(found)
    shown = found.only([*ours, *peers])
    shown.plot(ax=axes, peers=peers)
    closed = [point for point in found.points if point.series == "auto"]
    for point in closed:
        axes.plot(point.position_error, point.seconds, "*", markersize=10, color="black", label="auto, a closed form")
    seconds = [point.seconds for point in (*shown.points, *closed) if point.position_error < ROUGHEST]
    axes.set(title=name, xlim=(ROUGHEST, 1e-15), ylim=(0.5 * min(seconds), 2.0 * max(seconds)))
    axes.legend(fontsize="x-small", loc="upper left", bbox_to_anchor=(1.0, 1.0))
    figure.supxlabel("\n".join(wrap(machine(), 130)), fontsize=6, color="0.4")
    path, drawn = folder / f"{slug(name)}.png", BytesIO()
    figure.savefig(drawn, dpi=90)
    # A few lines have few colors: a palette is a third of the size.
    from PIL import Image  # which comes with matplotlib

    with Image.open(drawn) as image:
        image.convert("RGB").quantize(256).save(path, optimize=True)
    return path


def page(sections: list[str], rows: list[Row], load: str, folder: Path) -> None:
    """The page of the site: pictures and tables as they are, and who won."""
    command = " ".join(["python benches/python/work_precision.py", shlex.join(sys.argv[1:])]).strip()
    told = [
        f"Written with its pictures by `{command}`. {machine()} {load}",
        "What is timed is the integration alone, the least of several runs; errors are those of places at the end, "
        "against references beyond double precision. Lines are those methods of each package that are its fastest to "
        "some error: ours with full marks, peers dashed with open ones, the fastest of all in gray. Tables have every "
        "method; — is what was not reached.",
    ]
    table = "\n".join(["| what | visviva | peer | ratio | bar | |", "|---|---|---|---|---|---|", *map(str, rows)])
    head = ["# Work against precision", *(fill(each, 120, break_on_hyphens=False) for each in told)]
    text = "\n\n".join([*head, *sections, "## At equal errors", table]) + "\n"
    (folder / "index.md").write_text(text, encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("problems", nargs="*", help="only those whose names begin so")
    parser.add_argument("--seconds", type=float, default=0.3, help="no method goes on after runs that take longer")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--output", type=Path, default=Path(__file__).parents[2] / "docs" / "work-precision")
    asked = parser.parse_args()
    warnings.simplefilter("ignore", vv.AccuracyWarning)  # rough steps are meant
    # Of who else was there; on one's own it is below 1.
    load = f"Load of the machine when it began: {os.getloadavg()[0]:.1f}." if hasattr(os, "getloadavg") else ""
    drawing = find_spec("matplotlib") is not None
    sections: list[str] = []
    rows: list[Row] = []
    print("## Work against precision\n")
    for name, problem in PROBLEMS.items():
        if asked.problems and not name.startswith(tuple(asked.problems)):
            continue
        seconds = limit(problem, asked.seconds)
        found = vv.work_precision(problem, seconds=seconds, repeats=asked.repeats)
        if problem.scene.plan(problem.t_end).closed_form:
            found = found.joined(vv.work_precision(problem, ["auto"], repeats=asked.repeats).points)
        found = found.joined(Transformed(problem, found, seconds, asked.repeats).points())
        peers = {key: peer(problem, found, seconds, asked.repeats) for key, peer in PEERS.items()}
        for peer in peers.values():
            found = found.joined(peer.points())
        print(f"### {name}\n\n```\n{found}\n```\n", flush=True)
        rows.extend(verdicts(name, found, peers))
        asked.output.mkdir(parents=True, exist_ok=True)
        shown = f"![{name}: seconds against error]({picture(name, found, asked.output).name})\n\n" if drawing else ""
        sections.append(f"## {name[0].upper()}{name[1:]}\n\n{shown}```\n{found}\n```")
    print("| what | visviva | peer | ratio | bar | |\n|---|---|---|---|---|---|")
    for line in rows:
        print(line)
    print(f"\n{machine()}\n")
    page(sections, rows, load, asked.output)


if __name__ == "__main__":
    main()
