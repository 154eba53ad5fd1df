"""Codes print as their names, and are numbers all the same."""

import json
import pickle
from enum import IntEnum

import numpy as np
import pytest

import visviva as vv


@pytest.mark.parametrize("kind", [vv.Status, vv.scattering.DeflectionStatus])
def test_a_code_prints_as_its_name_and_counts_as_its_number(kind: type[IntEnum]) -> None:
    for at, member in enumerate(kind):
        assert str(member) == f"{member}" == member.name
        assert f"{member:>20}" == member.name.rjust(20)
        assert f"{member:03}" == f"{at:03}"
        assert f"{member:,}" == f"{member:+}".lstrip("+") == str(at)
        assert f"{member:d}" == "%d" % member == json.dumps(member) == str(at)  # noqa: UP031
        assert member == at == int(member)
        assert np.array([at], dtype=np.int8)[0] == member
        assert kind(at) is member
        assert pickle.loads(pickle.dumps(member)) is member
        assert repr(member) == f"<{kind.__name__}.{member.name}: {at}>"


def test_the_status_of_a_run_is_read_in_print(capsys: pytest.CaptureFixture[str]) -> None:
    print(vv.problems.kepler(e=0.5).scene.run(t=1.0).status)
    assert capsys.readouterr().out == "OK\n"
