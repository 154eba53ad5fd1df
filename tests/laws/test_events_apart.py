"""Events of bodies that nothing couples: units of one make-up, each with events of its own, side by side in lanes."""

import numpy as np
import pytest

import visviva as vv

BODIES, MEMBERS = 5, 7


@pytest.mark.parametrize(
    "how", [{"method": "dop853"}, {"method": "leapfrog", "dt": 0.25}, {"method": "rk4", "dt": 0.25}]
)
@pytest.mark.parametrize("threads", [1, 3])
def test_each_body_passes_its_own_plane_when_uniform_motion_says(how: dict[str, object], threads: int) -> None:
    """Body i of member m comes to x = i at t = 1 + i + m/8. Lanes were judged by the events of the first unit."""
    member, body = np.meshgrid(np.arange(MEMBERS), np.arange(BODIES), indexing="ij")
    when = 1.0 + body + member / 8.0 + 1e-3
    position = np.zeros((MEMBERS, BODIES, 3))
    position[..., 0] = body - when
    velocity = np.zeros((BODIES, 3))
    velocity[:, 0] = 1.0
    # A field that moves nothing, but tells places apart: otherwise each body would be integrated about its own.
    field = vv.CentralField(vv.potentials.Coulomb(1e-40), center=[0.0, 1e3, 0.0])
    scene = vv.Scene(vv.Particles(np.ones(BODIES), position[0], velocity), field)
    planes = [vv.events.plane([float(i), 0.0, 0.0], [1.0, 0.0, 0.0], body=i) for i in range(BODIES)]
    found = scene.ensemble(position=position).run(t=10.0, events=planes, threads=threads, **how).events
    assert sorted(zip(found.member.tolist(), found.which.tolist(), strict=True)) == [
        (m, i) for m in range(MEMBERS) for i in range(BODIES)
    ]
    # Uniform motion is exact for every method; a few roundings of ten.
    assert np.abs(found.t - when[found.member, found.which]).max() < 2e-14
