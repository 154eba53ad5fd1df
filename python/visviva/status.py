"""How a run ends: the codes of the core, of results and of files."""

from visviva._made_by import NamedCode

__all__ = ["Status"]


class Status(NamedCode):
    """How a trajectory ended, and what to do about it; `OK` and `STOPPED` are no failures.

    A single run that fails raises; of an ensemble each copy has its status in ``out.status``, as a number.

    Attributes
    ----------
    OK : 0
        The end was reached.
    CLOSE_ENCOUNTER : 1
        Bodies came too close for the steps: a softening, a radius and ``collisions=``, or another method.
    STEP_FAILURE : 2
        The step size fell to zero, the state was no longer finite, or the stages of an implicit method were not found:
        a smaller step, a larger `rtol`, or a look at the singularity. Or the next of equal steps would pass over a
        wall, a bump or a pulse of a formula that is narrower than the step: a shorter `dt`, or a method that chooses
        its steps. In generalized coordinates also `max_steps`.
    INTERRUPTED : 3
        Ctrl-C came, or, of a copy, before it began: run on from what there is, or again.
    TOO_MANY_STEPS : 4
        `max_steps` were taken before the end: a larger one, a larger `rtol` or `dt`, or a shorter run.
    STOPPED : 5
        A terminal event, or a collision where these stop the run, ended it: what was asked for.
    OUTSIDE_DOMAIN : 6
        Bodies came to a distance or a speed at which a force is not known, as beyond a table: give it more points, or
        end the run before it.
    RESTING : 7
        Spheres that bounce came to rest on each other, in ever smaller bounces or pressed together, or a massless one
        between two that come together bounced thousands of times, each sooner than the last: end the run before it, or
        let a soft repulsion hold them apart.

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
