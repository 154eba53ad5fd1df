"""How a run ends: the codes of the core, of results and of files."""

from visviva._made_by import NamedCode

__all__ = ["Status"]


class Status(NamedCode):
    """How a trajectory ended: `STOPPED` is by a terminal event, which is no failure.

    `OUTSIDE_DOMAIN`: bodies came to a distance or a speed at which a force is not known, as beyond a table.
    `RESTING`: spheres that bounce came to rest on each other, in ever smaller bounces or pressed together.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.problems.figure_eight().scene.run(t=1.0).status is vv.Status.OK
    True
    >>> str(vv.Status.STOPPED), int(vv.Status.STOPPED)
    ('STOPPED', 5)
    """

    OK = 0
    CLOSE_ENCOUNTER = 1
    STEP_FAILURE = 2
    INTERRUPTED = 3
    TOO_MANY_STEPS = 4
    STOPPED = 5
    OUTSIDE_DOMAIN = 6
    RESTING = 7


def __dir__() -> list[str]:
    return list(__all__)
