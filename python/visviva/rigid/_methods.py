"""The methods that rigid bodies in a scene can be stepped with."""

from __future__ import annotations

from visviva._keywords import known_keywords
from visviva.integrators import Method, _records

__all__ = ["methods"]


@known_keywords
def methods() -> list[Method]:
    """Every method that steps rigid bodies which torques turn, for ``Scene.run(method=...)``.

    Splittings alternate kicks with drifts in which bodies turn exactly, and have the order that they have for points;
    Runge–Kutta methods run on the group of rotations and take forces that look at velocities, too. Methods that choose
    their steps integrate quaternions and momenta beside the points, to `rtol` of each; they find events on the way, and
    take whatever forces look at. ``rattle`` and the
    ``moser_veselov`` methods are for rigid bodies alone: in their drifts bodies turn by a discrete motion that keeps
    energy and angular momentum. Their order is that of a body that nothing turns; with torques it is 2.

    Without a method and a step, a run is cut into 64 equal parts (the steps that it tells), each of which is done by
    ``kahan_li8`` in ever shorter steps until it stays the same to `rtol`, or to what rounding leaves; a copy that comes
    to no agreement ends as not finite. With events, `atol` or `max_step`, beside points that no force couples to a
    body, and where something looks at velocities, ``verner98`` chooses its steps. With a step `dt` ``kahan_li8`` goes
    in such steps, or ``rk4`` where something looks at velocities.

    Returns
    -------
    list of Method

    Examples
    --------
    >>> import visviva as vv
    >>> [method.name for method in vv.rigid.methods() if method.order == 10]
    ['sofroniou_spaletta10', 'moser_veselov10']
    """
    return _records(rigid=True)
