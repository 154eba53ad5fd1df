"""No comparison of the tests has a bound that nobody wrote.

`pytest.approx(x, rel=…)` passes all that is within 1e-12, whatever ``rel``; `numpy.allclose` and `numpy.isclose` all
within 1e-8, whatever ``rtol``, and within a part in 1e5, whatever ``atol``; `numpy.testing.assert_allclose` all within
a part in 1e7, whatever ``atol``. Comparisons of small numbers, or to a few roundings, could not fail. Each is given
its relative and its absolute bound, 0 where only the other is meant.
"""

import ast
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]
FILES = sorted(TESTS.rglob("*.py"))
#: What pytest takes for ``abs`` and ``rel`` where they are not given.
FLOOR, RELATIVE = 1e-12, 1e-6


def written(node: ast.expr) -> object:
    """The number, or the sequence of numbers, that stands there; None where it has to be computed."""
    try:
        return ast.literal_eval(node)
    except (ValueError, TypeError):
        return None


def numbers(value: object) -> list[float]:
    """All numbers of a literal; 0 stands for what is none."""
    if isinstance(value, list | tuple):
        return [number for part in value for number in numbers(part)]
    return [float(value) if isinstance(value, int | float) else 0.0]


def rests_on_a_floor(call: ast.Call) -> bool:
    """Whether a bound that is not written may decide a comparison."""
    name = getattr(call.func, "attr", getattr(call.func, "id", None))
    given = {keyword.arg: keyword.value for keyword in call.keywords}
    if None in given:  # bounds that several comparisons share are written where they are made
        return False
    if name == "assert_allclose":  # its ``atol`` is 0
        return "rtol" not in given
    if name in {"allclose", "isclose"} and ast.unparse(call.func).startswith("np."):
        return not {"rtol", "atol"} <= {*given}
    if name != "approx" or "abs" in given:
        return False
    relative = numbers(written(given["rel"]))[0] if "rel" in given else RELATIVE
    # Numbers that are written and so large that their relative bound is above the floor.
    return any(abs(number) * relative < FLOOR for number in numbers(written(call.args[0])))


def floors(source: str) -> list[int]:
    """The lines of the comparisons that rest on a floor."""
    calls = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call)]
    return sorted(call.lineno for call in calls if rests_on_a_floor(call))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.relative_to(TESTS).as_posix())
def test_every_bound_is_written(path: Path) -> None:
    lines = floors(path.read_text(encoding="utf-8"))
    assert not lines, f"{path.relative_to(TESTS.parent)}, lines {lines}: write both bounds, 0 where one is not meant"


@pytest.mark.parametrize(
    ("comparison", "rests"),
    [
        ("pytest.approx(x, rel=1e-9)", True),
        ("pytest.approx(x)", True),
        ("pytest.approx(1.0, rel=1e-13)", True),
        ("approx([1.0, 1e-9], rel=1e-6)", True),
        ("approx([1.0, 0.0], rel=1e-6)", True),
        ("approx(-3.0, rel=bound)", True),
        ("np.allclose(x, y, rtol=1e-13)", True),
        ("np.isclose(x, y)", True),
        ("np.allclose(x, y, atol=1e-14)", True),
        ("np.testing.assert_allclose(x, y, atol=1e-14)", True),
        ("pytest.approx(x, rel=1e-9, abs=0)", False),
        ("approx([-1.0, (2.0, 1e-3)], rel=1e-9)", False),
        ("pytest.approx(0.5)", False),
        ("np.isclose(x, y, rtol=1e-13, atol=0)", False),
        ("np.testing.assert_allclose(x, y, rtol=1e-13)", False),
    ],
)
def test_floors_are_found(comparison: str, rests: bool) -> None:
    """The check must know a floor when it sees one; the files must be there."""
    assert floors(f"import pytest\nassert found == {comparison}") == [2] * rests
    assert len(FILES) > 250
