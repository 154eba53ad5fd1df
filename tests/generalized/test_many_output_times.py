"""Rows of output times longer than what is looked at at once: the first that turns back is named, wherever it is."""

import numpy as np
import pytest

import visviva as vv

BLOCK = 2**20


@pytest.mark.parametrize("sign", [1.0, -1.0], ids=["forwards", "backwards"])
@pytest.mark.parametrize("at", [2, BLOCK - 1, BLOCK, BLOCK + 1, 2 * BLOCK + 2])
def test_the_first_time_that_turns_back_is_named_beyond_any_block(at: int, sign: float) -> None:
    times = sign * np.arange(2 * BLOCK + 3.0)
    times[at] -= 1.5 * sign
    times[at + 1 :] -= 7.0 * sign  # that others turn back, too, tells nothing of the first
    with pytest.raises(vv.InvalidInput, match=rf"as t\[{at}\]$"):
        vv.systems.oscillator().plan(times)


def test_a_block_of_times_at_the_start_has_no_direction_yet() -> None:
    times = np.concatenate([np.zeros(BLOCK), [-1.0, -2.0, -1.0]])
    assert vv.systems.oscillator().plan(times[:-1]) is not None
    with pytest.raises(vv.InvalidInput, match=rf"got -1 after -2 as t\[{BLOCK + 2}\]$"):
        vv.systems.oscillator().plan(times)


def test_what_is_not_a_number_is_named_beyond_any_block() -> None:
    times = np.linspace(0.0, 1.0, BLOCK + 2)
    times[BLOCK + 1] = np.nan
    with pytest.raises(vv.InvalidInput, match=rf"t\[{BLOCK + 1}\] is nan"):
        vv.systems.oscillator().plan(times)
