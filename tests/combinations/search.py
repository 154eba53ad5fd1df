"""A long search: ``python -m tests.combinations.search --scenes 100000``.

Draws recipes at random, asks every law of each, goes on after a failure, and prints the plainest recipe of every kind
of failure as a line to be kept as an ``@example``.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import re
import sys
import time
import traceback
from pathlib import Path

os.environ["RUST_BACKTRACE"] = "0"
sys.path.insert(0, str(Path(__file__).parent))
from hypothesis import HealthCheck, Phase, given, seed, settings
from recipe import Recipe, Refused, recipes
from running import close_workers
from stated_laws import LAWS


class Enough(KeyboardInterrupt):
    """The time is up; Hypothesis lets nothing else through."""


def plainness(recipe: Recipe) -> tuple[int, int]:
    """How much of a recipe is not the default, and how long it is."""
    default = Recipe()
    different = sum(getattr(recipe, name) != getattr(default, name) for name in Recipe.__dataclass_fields__)
    return different, len(repr(recipe)) + recipe.bodies + recipe.members


def simplified(recipe: Recipe, kind: str, law: str) -> Recipe:
    """One setting after the other put back to its default, as long as the law fails in the same way."""
    from dataclasses import replace

    default = Recipe()
    best = recipe
    tries = [{name: getattr(default, name)} for name in Recipe.__dataclass_fields__]
    for _ in range(2):
        smaller = [{"bodies": n} for n in (1, 2, 3, 5, 9, 17) if n < best.bodies]
        smaller += [{"members": n} for n in (1, 2, 3, 5, 9, 17) if n < best.members]
        smaller += [{"steps": n} for n in (1, 2, 4, 8) if n < best.steps] + [
            {"outputs": n} for n in (1, 2) if n < best.outputs
        ]
        smaller += [{"forces": best.forces[:i] + best.forces[i + 1 :]} for i in range(len(best.forces))]
        smaller += [{"own": (name,)} for name in best.own if len(best.own) > 1]
        smaller += [{"massless": n} for n in (1, 2) if n < best.massless]
        for change in tries + smaller:
            candidate = replace(best, **change)
            if candidate != best and len(candidate.forces) <= len(best.forces) and failure(candidate, law)[0] == kind:
                best = candidate
    return best


def failure(recipe: Recipe, law: str) -> tuple[str, str]:
    """The kind of failure and its message, or two empty words."""
    try:
        LAWS[law](recipe)
    except Refused:
        return "", "refused"
    except AssertionError as error:
        message = str(error)
    except Exception as error:
        where = traceback.extract_tb(error.__traceback__)[-1]
        message = f"{type(error).__name__} at {Path(where.filename).name}:{where.lineno}: {error}"
    else:
        return "", ""
    told = re.sub(r"(Recipe|member|other|against).*", "", re.sub(r"-?[0-9][0-9.e+-]*", "#", message))
    return f"{law}: {told[:50]}", message


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--laws", nargs="*", default=list(LAWS), choices=list(LAWS))
    parser.add_argument("--minutes", type=float, default=float("inf"))
    asked = parser.parse_args()
    found: dict[str, tuple[int, Recipe, str]] = {}
    tried = {"scenes": 0, "judged": 0, "refused": 0}
    spent = dict.fromkeys(asked.laws, 0.0)
    began = time.monotonic()

    @seed(asked.seed)
    @settings(
        max_examples=asked.scenes,
        deadline=None,
        database=None,
        derandomize=False,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(recipes())
    def look(recipe: Recipe) -> None:
        if time.monotonic() - began > 60.0 * asked.minutes:
            raise Enough
        tried["scenes"] += 1
        if tried["scenes"] % 5000 == 0:
            print(tried, f"in {time.monotonic() - began:.0f} s", flush=True)
        for law in asked.laws:
            started = time.monotonic()
            kind, message = failure(recipe, law)
            spent[law] += time.monotonic() - started
            if message != "refused":
                tried["judged"] += 1
            else:
                tried["refused"] += 1
            if kind:
                count, best, best_message = found.get(kind, (0, recipe, message))
                if count == 0:
                    print(f"NEW {kind}\n    {message}\n    {recipe}", flush=True)
                if plainness(recipe) < plainness(best):
                    best, best_message = recipe, message
                found[kind] = (count + 1, best, best_message)

    with contextlib.suppress(Enough):
        look()
    print(f"\n{tried} in {time.monotonic() - began:.0f} s, seed {asked.seed}")
    print({law: round(seconds, 1) for law, seconds in spent.items()})
    for kind, (count, recipe, message) in sorted(found.items(), key=lambda item: -item[1][0]):
        law = kind.split(":")[0]
        plain = simplified(recipe, kind, law)
        shown = ", ".join(
            f"{name}={getattr(plain, name)!r}"
            for name in Recipe.__dataclass_fields__
            if getattr(plain, name) != getattr(Recipe(), name)
        )
        print(f"\n{count} × {law}\n    {failure(plain, law)[1] or message}\n    Recipe({shown})", flush=True)
    close_workers()
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
