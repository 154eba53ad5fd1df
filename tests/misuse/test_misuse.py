"""Wrong calls: each is refused by name, with what was expected, and nothing fails inside."""

from collections.abc import Callable
from types import FunctionType
from typing import Any

import pytest
from wrong_calls import CALLS

import visviva as vv


def shown(value: object) -> str:
    """Without the address of a function, which every process has another of."""
    return value.__qualname__ if isinstance(value, FunctionType) else f"{value!r:.40}"


WRONG = [
    pytest.param(call, good | {argument: value}, argument, id=f"{call.__qualname__}({argument}={shown(value)})")
    for call, good, arguments in CALLS
    for argument, values in arguments.items()
    for value in values
]


def test_there_are_enough() -> None:
    assert len(WRONG) >= 250


@pytest.mark.parametrize(("call", "good"), [(call, good) for call, good, _ in CALLS if call is not vv.load])
def test_the_right_call_runs(call: Callable[..., Any], good: dict[str, Any]) -> None:
    call(**good)


@pytest.mark.parametrize(("call", "given", "argument"), WRONG)
def test_refused_by_name(call: Callable[..., Any], given: dict[str, Any], argument: str) -> None:
    with pytest.raises(vv.InvalidInput) as refused:
        call(**given)
    assert argument in refused.value.argument
    assert len(str(refused.value)) > len(argument) + 10  # and not the name alone
