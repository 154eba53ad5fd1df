"""Counting on a Dask cluster of two workers, one of which is killed half-way: the counts are those made here."""

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("distributed")

PROGRAM = """
import os, signal, threading
import visviva as vv

def main():
    from dask.distributed import Client, LocalCluster

    def run(**where):
        return vv.scattering.monte_carlo(
            vv.potentials.LennardJones(1.0, 1.0), beam_energy=1.5, masses=(1.0, 4.0), b_max=3.0, seed=5,
            n_events=300_000_000, tally=["cm_angle", ("lab_angle", "energy")], **where)

    here, ended = run(), []
    with LocalCluster(2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        doomed = min(client.run(os.getpid).values())

        def kill(done, total):
            if not ended:
                ended.append(done)
                os.kill(doomed, signal.SIGKILL)

        there = run(executor=client, progress=kill)
    print(there == here, 0 < ended[0] < 300_000_000)

if __name__ == "__main__":
    main()
"""


def test_a_killed_worker_changes_nothing(tmp_path: Path) -> None:
    program = tmp_path / "program.py"
    program.write_text(PROGRAM)
    done = subprocess.run([sys.executable, program], capture_output=True, text=True, timeout=300, check=False)
    assert done.stdout.split() == ["True", "True"], done.stderr
