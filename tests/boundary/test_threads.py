"""How many threads run, and what a wrong number gets."""

import os
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest

from visviva import _core, errors


def child(code: str, **environment: str) -> str:
    """What a fresh interpreter prints with these variables set."""
    done = subprocess.run(
        [sys.executable, "-c", code], env=os.environ | environment, capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


@pytest.mark.parametrize("threads", [0, -1, 1025, -(2**63)])
def test_a_wrong_number_is_refused_by_name(threads: int) -> None:
    with pytest.raises(errors.InvalidInput, match=r"^threads: expected .* got") as caught:
        _core._busy(0.0, threads)
    assert caught.value.argument == "threads"


def test_the_variable_is_used_and_the_argument_wins() -> None:
    code = "from visviva import _core; print(_core.info()['threads'], _core._busy(0.0)[0], _core._busy(0.0, 2)[0])"
    assert child(code, VISVIVA_THREADS="3") == "3 30 20"


@pytest.mark.parametrize("value", ["0", "two", "-1", "1.5"])
def test_a_wrong_variable_is_refused_by_name(value: str) -> None:
    code = """
from visviva import _core, errors
try:
    _core._busy(0.0)
except errors.InvalidInput as error:
    print(error)
"""
    assert child(code, VISVIVA_THREADS=value).startswith(
        f"VISVIVA_THREADS: expected a whole number from 1 to 1024, got '{value}'"
    )


def test_a_wrong_simd_tier_is_refused_at_import() -> None:
    code = """
from visviva import errors
try:
    from visviva import _core
except errors.InvalidInput as error:
    print(error.argument)
"""
    assert child(code, VISVIVA_SIMD="avx3") == "VISVIVA_SIMD"


def test_the_simd_tier_can_be_chosen() -> None:
    code = "from visviva import _core; print(_core.info()['simd'])"
    for tier in _core.info()["simd_available"]:
        assert child(code, VISVIVA_SIMD=tier) == tier


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="no affinity on this system")
def test_the_default_is_the_cores_this_process_may_use() -> None:
    code = """
import os
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
from visviva import _core
print(_core.info()["threads"])
"""
    assert child(code, VISVIVA_THREADS="") == "1"


@pytest.mark.skipif(not os.path.isdir("/proc/self/task"), reason="no /proc on this system")
def test_nothing_is_started_before_it_is_needed() -> None:
    code = """
import os
from visviva import _core
import visviva
count = len(os.listdir("/proc/self/task"))
_core._busy(0.01, 1)
one = len(os.listdir("/proc/self/task")) - count
for _ in range(3):
    _core._busy(0.01, 3)
print(one, len(os.listdir("/proc/self/task")) - count)
"""
    assert child(code) == "0 2"


def test_runs_from_many_python_threads_at_once() -> None:
    with ThreadPoolExecutor(4) as pool:
        results = list(pool.map(lambda threads: _core._busy(0.02, threads), [1, 2, 3, 4] * 3))
    assert results == [(10 * threads, False) for threads in [1, 2, 3, 4] * 3]


def test_a_long_run_does_not_hold_up_a_short_one() -> None:
    stop = False

    def progress(done: int, total: int) -> None:
        if stop:
            raise StopIteration

    def long() -> None:
        with pytest.raises(StopIteration):
            _core._busy(30.0, 2, progress)

    thread = threading.Thread(target=long)
    thread.start()
    try:
        assert _core._busy(0.01, 2) == (20, False)
        assert thread.is_alive()
    finally:
        stop = True
        thread.join()
