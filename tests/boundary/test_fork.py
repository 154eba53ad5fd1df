"""The pool after fork and in spawned processes."""

import functools
import multiprocessing
import os
import signal
import time
import warnings

import pytest

from visviva import _core

needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")


# A partial of a built-in pickles; a function of a test module cannot be found by a spawned process.
busy = functools.partial(_core._busy, 0.02)


def exit_code_of_fork() -> int:
    """Exit code of a child that uses the pool; it is killed if it hangs for 10 s."""
    with warnings.catch_warnings():
        # Python ≥ 3.12 warns that forking a process with threads may deadlock; that it does not is what is tested.
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if child == 0:
        signal.alarm(10)
        os._exit(0 if busy(2) == (20, False) and busy(3) == (30, False) else 1)
    _, status = os.waitpid(child, 0)
    return os.waitstatus_to_exitcode(status)


@needs_fork
def test_a_forked_child_makes_its_own_pool() -> None:
    assert busy(2) == (20, False)
    assert exit_code_of_fork() == 0
    assert busy(2) == (20, False)


@needs_fork
def test_fork_while_a_run_is_under_way() -> None:
    """Fork from one thread while another is inside the pool: the child inherits a pool in any state."""
    import threading

    running = threading.Thread(target=_core._busy, args=(1.0, 2))
    running.start()
    try:
        assert [exit_code_of_fork() for _ in range(5)] == [0] * 5
    finally:
        running.join()


@needs_fork
def test_fork_in_the_progress_callback() -> None:
    """The child stands in a run whose workers it has not got; it must not wait for them."""
    children: list[int] = []

    def progress(done: int, total: int) -> None:
        if not children:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", DeprecationWarning)
                child = os.fork()
            if child == 0:
                signal.alarm(10)
            children.append(child)

    try:
        result = _core._busy(0.3, 2, progress)
    except RuntimeError as error:
        if children == [0]:
            os._exit(0 if "forked" in str(error) else 1)
        raise
    if children == [0]:
        # No worker was inside at the moment of the fork: the child has done it all.
        os._exit(0 if result == (20, False) else 1)
    assert result == (20, False)
    assert os.waitstatus_to_exitcode(os.waitpid(children[0], 0)[1]) == 0


@pytest.mark.parametrize("start", multiprocessing.get_all_start_methods())
def test_multiprocessing(start: str) -> None:
    assert busy(2) == (20, False)
    context = multiprocessing.get_context(start)
    started = time.monotonic()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        with context.Pool(2) as pool:
            assert pool.map_async(busy, [1, 2, 3]).get(timeout=30) == [(10, False), (20, False), (30, False)]
    assert time.monotonic() - started < 30
