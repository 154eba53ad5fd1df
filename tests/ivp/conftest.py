"""Marks and fixtures that SciPy's own tests expect of the plugins that SciPy uses."""

import pytest


def pytest_configure(config: pytest.Config) -> None:
    for mark in ("thread_unsafe", "fail_slow", "slow"):
        config.addinivalue_line("markers", f"{mark}: of SciPy's tests; means nothing here")


@pytest.fixture
def num_parallel_threads() -> int:
    return 1
