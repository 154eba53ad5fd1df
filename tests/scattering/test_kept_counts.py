"""Counts of beams and of foils: kept in files, gone on with, counted elsewhere, and refused where files are damaged."""

import multiprocessing
import pickle
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import numpy as np
import pytest
from kept_files import parts, refused, written

import visviva as vv

S = vv.scattering
REFERENCE = Path(__file__).parent.parent / "reference" / "foil_v1.npz"
YUKAWA = vv.potentials.Yukawa(1137.0, 0.3)
FOILS = {
    "plain": (S.Foil("water", 0.2, minimum_angle=3e-3), "proton", {"tally": ["lab_angle", "stopped_depth"]}),
    "forced": (
        S.Foil("gold", 0.05, potential=YUKAWA, stopping=([1e4, 1e6], [5e4, 7e4]), minimum_angle=5e-3),
        S.Ion(2, 4.0),
        {"forced_angle": 0.4, "incidence": 0.2, "tally": ["cm_angle", "transmitted_energy", "reflected_angle"]},
    ),
    "single": (
        S.Foil(S.Material(2.2, [14, 8], [28.085, 15.999], [1, 2]), 0.1, potential="coulomb", stopping="none"),
        "alpha",
        {"forced_angle": 0.4, "collisions": "single", "lowest_energy": 1e3},
    ),
}


def foil(name, n_events=400, **how):
    made, ion, asked = FOILS[name]
    return made.run(ion, beam_energy=1e5, n_events=n_events, seed=7, bins=12, **asked, **how)


def beam(n_events=400, **how):
    return S.monte_carlo(YUKAWA, beam_energy=1e3, masses=(1.0, 4.0), b_max=2.0, n_events=n_events, seed=7, bins=12,
                         tally=["cm_angle", ("lab_angle", "energy")], importance=S.Strata([0, 0.5, 2.0], [1, 1]),
                         **how)  # fmt: skip


RUNS = {**{name: (lambda n=400, name=name, **how: foil(name, n, **how)) for name in FOILS}, "beam": beam}


@pytest.mark.parametrize("name", RUNS)
def test_what_is_kept_is_what_was_counted_and_goes_on(name, tmp_path):
    run, path = RUNS[name], tmp_path / "counts.npz"
    part = run(300)
    part.save(path)
    for again in (vv.load(path), type(part).load(path), pickle.loads(pickle.dumps(part))):
        assert type(again) is type(part)
        assert again == part
        assert repr(again) == repr(part)
        assert again.resume(100, threads=1) == run(400) == part + run(100, first_event=again.next_event)
    if name != "beam":
        again = vv.load(path)
        assert (again.bombardment, again.table_error) == (part.bombardment, part.table_error)
        assert again.collisions_across == part.collisions_across
        with pytest.raises(ValueError, match="read-only"):
            again.sums[0, 0] = 1
    assert sum([vv.load(path), run(100, first_event=300)]) == run(400)


def test_files_of_version_1_load():
    kept = vv.load(REFERENCE)
    now = foil("forced", 50)
    assert kept.bombardment == now.bombardment
    assert (kept.events, kept.units, list(kept)) == (now.events, now.units, list(now))
    assert kept.resume(10).n_events == 60


def test_a_file_of_another_kind_is_refused_by_what_it_holds(tmp_path):
    path = tmp_path / "counts.npz"
    beam().save(path)
    with pytest.raises(vv.InvalidInput, match=r"^path: expected a FoilResult, but .* holds a MonteCarlo"):
        S.FoilResult.load(path)
    vv.problems.figure_eight().scene.run(t=0.1).save(path)
    with pytest.raises(vv.InvalidInput, match=r"^path: expected a MonteCarlo, but .* holds a Trajectory"):
        S.MonteCarlo.load(path)


def test_sums_of_what_is_not_the_same_are_refused_by_name():
    first = foil("plain")
    made, ion, asked = FOILS["plain"]
    how = {"beam_energy": 1e5, "n_events": 10, "seed": 8, "bins": 12, **asked}
    others = {
        "foil": S.Foil("water", 0.3, minimum_angle=3e-3).run(ion, **how),
        "ion": made.run("deuteron", **how),
        "beam_energy": made.run(ion, **{**how, "beam_energy": 9e4, "lowest_energy": 100.0}),
        "lowest_energy": made.run(ion, **how, lowest_energy=200.0),
        "incidence": made.run(ion, **how, incidence=0.1),
        "forced_angle": made.run(ion, **how, forced_angle=0.4),
    }
    for name, other in others.items():
        with pytest.raises(vv.InvalidInput, match=f"^other: expected the same {name}, "):
            first + other
    with pytest.raises(vv.InvalidInput, match=r"^other: expected the tallies"):
        first + made.run(ion, **{**how, "tally": "lab_angle"})
    with pytest.raises(TypeError):
        first + beam()
    with pytest.raises(vv.InvalidInput, match="next_event: expected events of one seed"):
        (first + made.run(ion, **how)).resume(5)


def test_ctrl_c_keeps_what_came_before_too():
    def stop(done, total):
        raise KeyboardInterrupt

    before = foil("plain", 300)
    with pytest.raises(vv.Interrupted) as caught:
        before.resume(40_000, progress=stop)
    reached = caught.value.result
    assert 300 <= reached.n_events < 40_300
    assert reached == foil("plain", reached.n_events)


class Dying(ThreadPoolExecutor):
    """Every second part is lost with its worker."""

    sent = 0

    def submit(self, function, /, *arguments, **keywords):
        self.sent += 1
        if self.sent % 2:
            lost = Future()
            lost.set_exception(BrokenProcessPool("gone"))
            return lost
        return super().submit(function, *arguments, **keywords)


@pytest.mark.parametrize("name", ["plain", "forced"])
def test_foils_are_counted_elsewhere_with_the_same_bits(name):
    here = foil(name, 40_000)
    told = []
    with ThreadPoolExecutor(2) as threads:
        assert foil(name, 40_000, executor=threads, progress=lambda *done: told.append(done)) == here
    assert told == [(20_000, 40_000), (40_000, 40_000)]
    with Dying(1) as dying:
        assert foil(name, 40_000, executor=dying) == here
        assert dying.sent == 2
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as processes:
        assert foil(name, 1000).resume(39_000, executor=processes) == here


def test_what_cannot_be_counted_is_refused_before_anything_is_sent():
    with Dying(1) as dying:
        with pytest.raises(vv.InvalidInput, match=r"^n_events: "):
            foil("plain", 2**40, executor=dying)
        with pytest.raises(vv.InvalidInput, match=r"^cm_angle: |^tally: "):
            FOILS["plain"][0].run("proton", beam_energy=1e5, n_events=5, seed=1, tally="cm_angle", executor=dying)
        assert dying.sent == 0
    with pytest.raises(vv.InvalidInput, match=r"^executor: expected a concurrent\.futures\.Executor"):
        foil("plain", executor="two")


@pytest.fixture(params=RUNS)
def good(request, tmp_path):
    path = tmp_path / "counts.npz"
    RUNS[request.param](50).save(path)
    return path


def test_a_truncated_file_is_refused(good):
    whole = good.read_bytes()
    for length in range(0, len(whole), 101):
        good.write_bytes(whole[:length])
        assert refused(good), length


def test_flipped_bytes_of_contents_are_refused(good):
    whole = bytearray(good.read_bytes())
    generator = np.random.default_rng(1)
    found = 0
    for place in generator.choice(len(whole), 300, replace=False):
        kept, whole[place] = whole[place], whole[place] ^ (1 << int(generator.integers(8)))
        good.write_bytes(whole)
        found += refused(good)
        whole[place] = kept
    assert found > 150  # the rest are times and attributes in the directory, which nobody reads


def test_arrays_that_are_missing_or_do_not_fit_are_refused(good):
    header, arrays = parts(good)
    assert not refused(written(good, header, arrays))
    for name, array in arrays.items():
        assert refused(written(good, header, {other: arrays[other] for other in arrays if other != name})), name
        for damaged in (array[None], array[:0], np.concatenate([array, array]), array.astype(str)):
            assert refused(written(good, header, arrays | {name: damaged})), name
    assert refused(written(good, header | {"version": header["version"] + 1}, arrays))


@pytest.mark.parametrize(
    ("events", "says"),
    [
        ([], "counts of no events"),
        ([[7, 0.0, 50]], "counts of no events"),
        ([[7, 0, 50], [8, 0, 0.5]], "counts of no events"),
        ([[-1, 0, 50]], "events that there are not"),
        ([[2**64, 0, 50]], "events that there are not"),
        ([[7, -1, 49]], "events that there are not"),
        ([[7, 0, 50], [8, 3, 3]], "events that there are not"),
        ([[7, 2**63 - 49, 2**63 + 1]], "events that there are not"),
        ([[8, 0, 25], [7, 0, 25]], "events that are not sorted"),
        ([[7, 0, 25], [7, 25, 50]], "events that are not sorted"),
    ],
)
def test_what_is_wrong_with_events_is_said(events, says, tmp_path):
    path = tmp_path / "counts.npz"
    beam(50).save(path)
    header, arrays = parts(path)
    with pytest.raises(vv.InvalidInput, match=says):
        vv.load(written(path, header | {"events": events}, arrays))


def test_the_first_and_the_last_events_of_all_are_kept(tmp_path):
    how = {"beam_energy": 1e3, "masses": (1.0, 4.0), "b_max": 2.0, "bins": 12}
    for seed, first, n in ((0, 0, 1), (2**64 - 1, 2**63 - 50, 50)):
        counted = S.monte_carlo(YUKAWA, **how, n_events=n, seed=seed, first_event=first)
        counted.save(tmp_path / "counts.npz")
        assert vv.load(tmp_path / "counts.npz") == counted


@pytest.mark.parametrize("name", FOILS)
def test_every_key_and_every_count_of_a_foil_is_looked_at(name, tmp_path):
    path = tmp_path / "counts.npz"
    foil(name, 50).save(path)
    header, arrays = parts(path)
    groups = [header, *(header[group] for group in ("foil", "material", "ion", "bombardment"))]
    for group in groups:
        for key, kept in list(group.items()):
            if key == "written_by":  # nobody reads it
                continue
            del group[key]
            assert refused(written(path, header, arrays)), key
            for wrong in ("x", [], {}, True, -1.5, [[1, 2, 3]], 10**400):
                group[key] = wrong
                number = isinstance(kept, int | float) and wrong == -1.5
                assert refused(written(path, header, arrays)) or number, (key, wrong)
            group[key] = kept
    for array in arrays:
        for place in ((0, 0), (1, 1)) if array.endswith("sums") else ((0,),):
            changed = arrays[array].copy()
            changed[place] = changed[place] + np.uint64(1) if array.endswith("sums") else 1e9
            assert refused(written(path, header, arrays | {array: changed})), (array, place)
    for events in ([], [[7, 0, 49]], [[7, 0, 51]], [[7, 25, 50], [7, 0, 25]], [[7, 0, 30], [7, 20, 40]], [[7, 50, 0]],
                   [[7, 0.0, 50]], [[-1, 0, 50]], [[7, 0]]):  # fmt: skip
        assert refused(written(path, header | {"events": events}, arrays)), events
    for more in ({"stray": np.zeros(3)}, {"9/sums": arrays["sums"]}):
        assert refused(written(path, header, arrays | more))
