"""The exception classes: bases, fields, messages, pickles."""

import copy
import pickle

import pytest

from visviva import _core, errors

EXAMPLES = [
    (errors.Error("something"), Exception, {}),
    (errors.InvalidInput("dt", "expected a positive number"), ValueError, {"argument": "dt"}),
    (errors.UnknownKeyword("dtt", "expected a keyword of run"), TypeError, {"argument": "dtt"}),
    (errors.WrongArguments("dt", "expected with every call of run"), TypeError, {"argument": "dt"}),
    (errors.MissingPackage("to_pandas", "the package pandas is not installed"), ImportError, {"argument": "to_pandas"}),
    (errors.FrozenAttribute("t0", "a Scene is frozen"), AttributeError, {"argument": "t0"}),
    (errors.ConvergenceError("gave up", 2.5), RuntimeError, {"message": "gave up", "time": 2.5, "trajectory": None}),
    (
        errors.CloseEncounter(1.5, (3, 4), 1e-9),
        RuntimeError,
        {"time": 1.5, "bodies": (3, 4), "distance": 1e-9, "trajectory": None},
    ),
    (errors.Interrupted(), KeyboardInterrupt, {"message": "interrupted", "trajectory": None}),
    (errors.InternalError("broken"), RuntimeError, {"message": "broken"}),
    (errors.AccuracyWarning("nothing was resolved"), UserWarning, {}),
]


def test_every_class_has_an_example() -> None:
    assert {type(error).__name__ for error, _, _ in EXAMPLES} == set(errors.__all__)


@pytest.mark.parametrize(("error", "base", "fields"), EXAMPLES, ids=lambda value: type(value).__name__)
def test_bases_fields_and_message(error: errors.Error, base: type, fields: dict[str, object]) -> None:
    # Ctrl-C is no error: `except Exception` must not swallow it. Nor is a warning, unless a filter makes it one.
    ctrl_c, warning = isinstance(error, errors.Interrupted), isinstance(error, Warning)
    assert isinstance(error, Exception) is not ctrl_c
    assert isinstance(error, errors.Error) is not (ctrl_c or warning)
    assert isinstance(error, base)
    assert {name: getattr(error, name) for name in fields} == fields
    assert str(error)


@pytest.mark.parametrize("error", [error for error, _, _ in EXAMPLES], ids=lambda value: type(value).__name__)
@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_pickle_and_copy(error: errors.Error, protocol: int) -> None:
    error = copy.copy(error)
    error.trajectory = {"t": [1.0, 2.0]}  # type: ignore[attr-defined]  # set after the fact, as the package does
    error.add_note("a note")
    for again in (pickle.loads(pickle.dumps(error, protocol)), copy.deepcopy(error)):
        assert type(again) is type(error)
        assert again.args == error.args
        assert again.__dict__ == error.__dict__
        assert str(again) == str(error)


def test_messages() -> None:
    assert str(errors.InvalidInput("dt", "expected x, got y")) == "dt: expected x, got y"
    assert str(errors.ConvergenceError("gave up", 2.5)) == "gave up (at t = 2.5)"
    assert str(errors.ConvergenceError("gave up")) == "gave up"
    assert "bodies 3 and 4 are 1e-09 apart" in str(errors.CloseEncounter(1.5, (3, 4), 1e-9))
    assert "body 3 is 1e-09 from a fixed center" in str(errors.CloseEncounter(1.5, (3, 3), 1e-9))
    assert "trajectory" in str(errors.Interrupted("interrupted", trajectory=object()))


def test_the_core_raises_these_classes() -> None:
    with pytest.raises(errors.InvalidInput) as refused:
        _core._busy(-1.0)
    assert (refused.value.argument, refused.value.message) == ("seconds", "expected a duration, got -1")
    with pytest.raises(errors.InternalError, match=r"on request.*please report"):
        _core._busy(0.0, 1, panic=0)
