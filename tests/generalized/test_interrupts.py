"""Ctrl-C while a run answers another question than where a motion goes: no answer comes of a part of it."""

import os
import signal
import sys
import threading
import time
from collections.abc import Callable

import pytest

import visviva as vv

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no POSIX signals on this system")

# Each takes far longer than the signal to come, and what it was asked is of no matter.
FLOWS = vv.systems.henon_heiles()
PENDULUMS = vv.systems.double_pendulum()
QUESTIONS: dict[str, Callable[[], object]] = {
    "derivatives of a flow": lambda: FLOWS.flow_jacobian(3e6),
    "exponents in long parts": lambda: FLOWS.lyapunov_exponents(3e6, interval=1e6),
    "exponents in short parts": lambda: FLOWS.lyapunov_exponents(1e5, interval=1.0),
    "a boundary value": lambda: PENDULUMS.boundary_value(60.0, [1.0, 1.0]),
    "a section": lambda: FLOWS.poincare("x", t=1e7),
}


@pytest.mark.parametrize("question", sorted(QUESTIONS))
def test_ctrl_c_ends_what_follows_motions(question: str) -> None:
    begun = time.monotonic()
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            QUESTIONS[question]()
    finally:
        timer.join()
    # Each would go on for tens of seconds; a loaded machine is slow to tell a thread.
    assert time.monotonic() - begun < 5.0
