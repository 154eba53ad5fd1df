"""What is printed of copies that Ctrl-C kept from their end: they are interrupted, and none of them has failed."""

from typing import Any

import numpy as np
import pytest

import visviva as vv


def stop_on_the_way(done: float, total: float) -> None:
    if done >= 0.3 * total:
        raise KeyboardInterrupt


def interrupted(copies: Any, t: Any, **how: Any) -> Any:
    with pytest.raises(vv.Interrupted) as stopped:
        copies.run(t=t, threads=1, progress=stop_on_the_way, **how)
    return stopped.value.trajectory


def test_copies_of_a_scene_that_finished_failed_and_were_interrupted_are_told_apart() -> None:
    scene = vv.problems.kepler(e=0.5).scene
    velocity = np.repeat(scene.particles.velocity[None], 200, axis=0)
    velocity[5] = 0.0  # falls into the other
    out = interrupted(scene.ensemble(velocity=velocity), np.linspace(0.0, 1000.0, 5), method="dop853")
    late = int((out.status == vv.Status.INTERRUPTED).sum())
    assert late > 0
    assert out.status[5] == vv.Status.CLOSE_ENCOUNTER
    assert repr(out) == f"EnsembleTrajectory(200 copies, 5 times, {199 - late} finished, 1 failed, {late} interrupted)"
    assert f"of which 1 failed and {late} were interrupted, told up to there" in str(out.conservation())
    assert "of which 1 was interrupted, told" in str(out[-1:].conservation())
    with pytest.raises(vv.InvalidInput, match="failed, were stopped or interrupted"):
        _ = out.final


def test_copies_in_generalized_coordinates_that_were_interrupted_have_not_failed() -> None:
    copies = vv.systems.double_pendulum().ensemble(position=np.ones((200, 2)))
    out = interrupted(copies, np.linspace(0.0, 300.0, 5))
    late = int((out.status == vv.Status.INTERRUPTED).sum())
    assert late > 0
    counts = f"{200 - late} finished, 0 failed, {late} interrupted"
    assert repr(out) == f"GeneralizedEnsembleTrajectory(200 copies, 5 times, {counts})"
