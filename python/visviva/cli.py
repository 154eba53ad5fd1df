"""The command line: ``visviva demo``, ``geiger-marsden``, ``toutatis``, ``methods``, ``stress``, ``info`` and more."""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        The words after the program's name; those of the process by default.

    Returns
    -------
    int
        0 if all went well, 1 if a request was refused or failed, 130 after Ctrl-C.

    Examples
    --------
    >>> from visviva.cli import main
    >>> main(["methods"])  # doctest: +ELLIPSIS
    method ...
    0
    """
    from visviva.errors import Error

    options = _parser().parse_args(arguments)
    try:
        return int(options.command(options) or 0)
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return 130
    except (Error, OSError) as error:
        print(f"visviva: {error}", file=sys.stderr)
        return 1


def _parser() -> argparse.ArgumentParser:
    from visviva import __version__

    parser = argparse.ArgumentParser(prog="visviva", description="Classical mechanics at native speed.")
    parser.add_argument("--version", action="version", version=f"visviva {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    demo = commands.add_parser("demo", help="the outer Solar System, and Rutherford's experiment")
    _output(demo)
    demo.add_argument("--days", type=_positive, default=1e6, help="how long to follow the planets (default: 1e6)")
    demo.add_argument("--events", type=_number, default=10**8, help="alpha particles to scatter (default: 1e8)")
    demo.add_argument("--threads", type=int, default=None, help="threads to use (default: all)")
    demo.set_defaults(command=_demo)
    swing = commands.add_parser("pendulum", help="a pendulum against elliptic functions; double pendulums that part")
    _output(swing)
    swing.add_argument("--members", type=_number, default=1000, help="double pendulums (default: 1000)")
    swing.add_argument("--threads", type=int, default=None, help="threads to use (default: all)")
    swing.set_defaults(command=_pendulum)
    foil = commands.add_parser("geiger-marsden", help="alpha particles through silver and gold, against 1913")
    _output(foil)
    foil.add_argument("--events", type=_number, default=400_000, help="alpha particles for each metal (default: 4e5)")
    foil.add_argument("--thickness", type=_positive, default=0.2, help="of the foils, in µm (default: 0.2)")
    foil.add_argument("--threads", type=int, default=None, help="threads to use (default: all)")
    foil.set_defaults(command=_geiger_marsden)
    toutatis = commands.add_parser("toutatis", help="the asteroid that tumbles, against what radar saw of it")
    _output(toutatis)
    toutatis.add_argument("--days", type=_positive, default=42.0, help="how long to follow it (default: 42)")
    toutatis.set_defaults(command=_toutatis)
    dzhanibekov = commands.add_parser("dzhanibekov", help="the handle that flips over and over")
    _output(dzhanibekov)
    dzhanibekov.add_argument("--flips", type=_number, default=6, help="how many (default: 6)")
    dzhanibekov.set_defaults(command=_dzhanibekov)
    commands.add_parser("methods", help="the integration methods").set_defaults(command=_methods)
    stress = commands.add_parser("stress", help="how each method copes with extreme scenes")
    stress.add_argument("--long", action="store_true", help="with the cases that take minutes")
    stress.add_argument("--methods", nargs="+", metavar="NAME", help="some methods (default: all)")
    stress.set_defaults(command=_stress)
    commands.add_parser("info", help="version, SIMD tier, threads, build profile").set_defaults(command=_info)
    return parser


def _output(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--output", type=Path, default=Path("demo-output"), help="folder for pictures and saved runs")


def _positive(text: str) -> float:
    value = float(text)
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"expected a positive finite number, got {text}")
    return value


def _number(text: str) -> int:
    """How many: also as 1e5."""
    value = _positive(text)
    if value < 1.0 or value != int(value):
        raise argparse.ArgumentTypeError(f"expected a whole number of 1 or more, got {text}")
    return int(value)


def _demo(options: argparse.Namespace) -> None:
    from visviva.demo import outer_solar_system, rutherford

    options.output.mkdir(parents=True, exist_ok=True)
    pictures = outer_solar_system(options.output, options.days, options.threads)
    print()
    pictures += rutherford(options.output, options.events, options.threads)
    _say(pictures)


def _pendulum(options: argparse.Namespace) -> None:
    from visviva.pendulum import pendulum

    options.output.mkdir(parents=True, exist_ok=True)
    _say(pendulum(options.output, options.members, options.threads))


def _geiger_marsden(options: argparse.Namespace) -> None:
    from visviva.geiger_marsden import geiger_marsden

    options.output.mkdir(parents=True, exist_ok=True)
    _say(geiger_marsden(options.output, options.events, options.thickness, options.threads))


def _toutatis(options: argparse.Namespace) -> None:
    from visviva.tumbling import toutatis

    options.output.mkdir(parents=True, exist_ok=True)
    _say(toutatis(options.output, options.days))


def _dzhanibekov(options: argparse.Namespace) -> None:
    from visviva.tumbling import dzhanibekov

    options.output.mkdir(parents=True, exist_ok=True)
    _say(dzhanibekov(options.output, options.flips))


def _say(pictures: list[Path]) -> None:
    print()
    if pictures:
        print("pictures:", ", ".join(map(str, pictures)))
    else:
        print("no pictures: the package matplotlib is not installed: pip install 'visviva[plot]'")


def _methods(_: argparse.Namespace) -> None:
    from visviva.integrators import methods

    rows = methods()
    width = max(len(row.name) for row in rows)
    print(f"{'method':<{width}}  order  stages  kind")
    for row in rows:
        kinds = [word for word in ("adaptive", "symplectic", "reversible") if getattr(row, word)]
        print(f"{row.name:<{width}}  {row.order:>5}  {row.stages:>6}  {', '.join(kinds) or 'fixed step'}")
        print(f"{'':<{width}}  {row.summary} [{row.reference}]")


def _stress(options: argparse.Namespace) -> int:
    from visviva.stress import run

    report = run(options.methods, long=options.long)
    print(report)
    return int(bool(report.failures))


def _info(_: argparse.Namespace) -> None:
    from visviva import _core

    for name, value in _core.info().items():
        shown = ", ".join(map(str, value)) if isinstance(value, list | tuple) else value
        print(f"{name.replace('_', ' ')}: {shown}")


def __dir__() -> list[str]:
    return list(__all__)
