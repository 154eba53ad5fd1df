"""How a run ends: the codes of the core, of results and of files."""

from enum import IntEnum
from typing import NoReturn

from visviva._made_by import refuse_value

__all__ = ["Status"]


class Status(IntEnum):
    """How a trajectory ended: `STOPPED` is by a terminal event, which is no failure.

    `OUTSIDE_DOMAIN`: bodies came to a distance or a speed at which a force is not known, as beyond a table.
    `RESTING`: spheres that bounce came to rest on each other, in ever smaller bounces or pressed together.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.problems.figure_eight().scene.run(t=1.0).status is vv.Status.OK
    True
    """

    OK = 0
    CLOSE_ENCOUNTER = 1
    STEP_FAILURE = 2
    INTERRUPTED = 3
    TOO_MANY_STEPS = 4
    STOPPED = 5
    OUTSIDE_DOMAIN = 6
    RESTING = 7

    @classmethod
    def _missing_(cls, value: object) -> NoReturn:
        refuse_value(cls, value)


def __dir__() -> list[str]:
    return list(__all__)
