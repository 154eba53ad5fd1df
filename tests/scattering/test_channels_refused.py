"""Channels of a Monte Carlo that are refused: below their threshold, more than a whole, or none at all."""

import numpy as np
import pytest

import visviva as vv

s = vv.scattering
Channel, Spread = s.Channel, s.Spread


def run(**changes: object) -> s.MonteCarlo:
    asked = {"beam_energy": 3.0, "masses": (1.0, 4.0), "b_max": 2.0, "seed": 1, "n_events": 1000}
    return s.monte_carlo(vv.potentials.Yukawa(1.0, 1.0), **{**asked, **changes})


@pytest.mark.parametrize(
    ("changes", "lowest"),
    [
        ({"beam_energy": 1.2}, "1.2"),
        ({"beam_energy": s.Spectrum([3.0, 1.0, 2.0], [1.0, 1e-3, 1.0])}, "1.0"),
        ({"beam_energy": 1.3, "energy_spread": Spread.uniform(0.1)}, "1.2"),
        ({"beam_energy": 1.3, "energy_spread": 0.01}, "1.24"),
    ],
)
def test_a_closed_channel_is_refused_with_its_threshold(changes: dict[str, object], lowest: str) -> None:
    channels = [Channel(0.5, 0.1), Channel(-1.0, 0.0)]
    with pytest.raises(vv.errors.InvalidInput, match=r"threshold, 1\.25, that q_value = -1\.0 of channel 1") as refused:
        run(channels=channels, **changes)
    assert refused.value.argument == "channels"
    assert f"got {lowest}" in str(refused.value)


@pytest.mark.parametrize(
    ("channels", "argument"),
    [
        ([Channel(1.0, 0.6), Channel(2.0, 0.5)], "channels"),
        ([Channel(1.0, 0.01)] * 65, "channels"),
        # Together more than 1 about one energy and one impact parameter only.
        (
            [
                Channel(1.0, ([0.0, 1.0], [0.2, 0.9]), excitation_function=([1.0, 2.0, 3.0], [0.0, 1.0, 0.0])),
                Channel(1.0, 0.2),
            ],
            "channels",
        ),
        ("elastic", "channels"),
        (3, "channels"),
        (Channel(1.0, 0.5, (0.1, 0.2)), "products"),
    ],
)
def test_bad_channels_are_refused_by_name(channels: object, argument: str) -> None:
    with pytest.raises(vv.errors.InvalidInput) as refused:
        run(channels=channels)
    assert refused.value.argument == argument


@pytest.mark.parametrize(
    ("values", "argument"),
    [
        ((np.nan, 0.5), "q_value"),
        ((1.0, -0.1), "probability"),
        ((1.0, 1.5), "probability"),
        ((1.0, ([0.0, 1.0], [0.5])), "probability"),
        ((1.0, ([0.0, 1.0], [0.5, 1.5])), "probability"),
        ((1.0, ([1.0, 0.0], [0.5, 0.5])), "probability"),
        ((1.0, ([-1.0, 0.0], [0.5, 0.5])), "probability"),
        ((1.0, ([0.0], [0.5])), "probability"),
        ((1.0, (0.5,)), "probability"),
        ((1.0, 0.5, None, 0.5), "excitation_function"),
        ((1.0, 0.5, None, ([1.0, 2.0], [0.5, 1.5])), "excitation_function"),
        ((1.0, 0.5, None, ([2.0, 1.0], [0.5, 0.5])), "excitation_function"),
        ((1.0, 0.5, (1.0,)), "products"),
        ((1.0, 0.5, (1.0, 0.0)), "products"),
        ((1.0, 0.5, (1.0, np.inf)), "products"),
    ],
)
def test_what_is_no_channel_is_refused(values: tuple[object, ...], argument: str) -> None:
    with pytest.raises(vv.errors.InvalidInput) as refused:
        Channel(*values)
    assert refused.value.argument == argument


@pytest.mark.parametrize(
    ("excitation_function", "beam"),
    [
        (([1.24, 5.0], [0.0, 1.0]), {"beam_energy": 1.245}),
        # A bump below it, between what a spread reaches.
        (
            ([0.5, 0.6, 0.7, 1.25, 2.0], [0.0, 0.1, 0.0, 0.0, 1.0]),
            {"beam_energy": 1.0, "energy_spread": Spread.uniform(0.5)},
        ),
        (([0.5, 1.0], [0.1, 0.0]), {"beam_energy": s.Spectrum([0.5, 3.0], [1.0, 1.0])}),
    ],
)  # fmt: skip
def test_a_factor_below_the_threshold_is_refused(excitation_function: object, beam: dict[str, object]) -> None:
    with pytest.raises(
        vv.errors.InvalidInput, match=r"threshold, 1\.25.* or an excitation_function that is 0 below it"
    ) as refused:
        run(channels=Channel(-1.0, 0.5, excitation_function=excitation_function), **beam)
    assert refused.value.argument == "channels"


def test_a_threshold_found_by_hand_is_the_threshold() -> None:
    """−Q (m₁ + m₂)/m₂ by another rounding than the core's: an ulp below it the channel may have a probability."""
    rng = np.random.default_rng(4)
    for first, second in rng.uniform(0.5, 9.0, (100, 2)):
        threshold = 1.5 * (first + second) / second
        opening = Channel(-1.5, 0.5, excitation_function=([threshold, 10.0 * threshold], [0.0, 1.0]))
        beam = {"beam_energy": threshold, "energy_spread": Spread.uniform(0.2 * threshold)}
        run(channels=opening, masses=(first, second), n_events=10, **beam)


def test_tables_that_take_too_long_are_refused() -> None:
    places, energies = np.linspace(0.0, 2.0, 2000), np.linspace(0.0, 9.0, 2000)
    wide = Channel(1.0, (places, np.full(2000, 0.5)), excitation_function=(energies, np.ones(2000)))
    with pytest.raises(vv.errors.InvalidInput, match="pairs of an impact parameter and an energy"):
        run(channels=wide)
