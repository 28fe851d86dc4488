"""Tests of what further dependencies are worth: a load that slows people down, and pure noise."""

from dataclasses import replace

import numpy as np
import pytest

from app.science.rotations import FloatArray
from app.science.walking.evaluation import TimesLeftOut, times_left_out
from app.science.walking.maps import WalkDatabase
from app.science.walking.models import timed_walks_of
from app.science.walking.records import PAPER_PARAMETERS, WalkingError, further_of, regular_grid
from app.science.walking.travel_times import StartingAndStopping, posterior_of
from tests.science.walking.travel_times.test_mixed_effects import made_up

PEOPLE = 12
WALK_WORSE_BY, PERSON_WORSE_BY = 0.05, 0.2
"""Share of its error by which pure noise may worsen the prediction of others: a number that differs
between walks, and one that differs between people only, of which nine are learnt from."""


def database(numbers: FloatArray, slower_per_unit: float, seed: int) -> WalkDatabase:
    """Return walks whose pace depends on a further number of each; the maps play no part."""
    timed, own = made_up(PEOPLE, np.random.default_rng(seed))
    values = np.repeat(np.pad(own, ((0, 0), (0, 2)), constant_values=(0.0, 1.0)), 8, axis=0)
    values[:, 2] = 0.0
    slowed = values + slower_per_unit * numbers[:, None] * np.array([1.0, 0.0, 0.0, 0.0])
    curve = StartingAndStopping()
    longer = curve.times_s(timed, slowed) / curve.times_s(timed, values)
    count, grid = len(timed), regular_grid(PAPER_PARAMETERS, 3)
    maps = np.zeros((count, grid.size), dtype=np.float32)
    return WalkDatabase(
        grid,
        "none",
        ("length_m", "turning_per_m", "load_kg"),
        np.stack([timed.lengths_m, np.zeros(count), numbers], axis=-1),
        maps,
        maps,
        timed.durations_s * longer,
        timed.lengths_m,
        timed.subjects,
        ("made",) * count,
        ("synthetic",) * count,
        np.ones(count),
    )


def left_out(walks: WalkDatabase) -> dict[str, TimesLeftOut]:
    """Return how well people left out are predicted, by method."""
    found = times_left_out(walks, np.random.default_rng(2), draws=200)
    return {one.method: one for one in found}


def test_a_planted_slow_down_is_learnt_within_its_interval() -> None:
    """A pace that is 2 % slower for each kilogram is found, and predicts others better."""
    loads_kg = np.tile([0.0, 0.0, 0.0, 0.0, 10.0, 10.0, 10.0, 10.0], PEOPLE)
    walks = database(loads_kg, 0.02, seed=1)
    timed, scaling = timed_walks_of(walks)
    assert scaling is not None
    learnt = posterior_of(timed, StartingAndStopping(), np.random.default_rng(3))
    slower_per_kg = learnt.coefficients[:, 4] * scaling.inverse_sds[0]
    low, high = np.quantile(slower_per_kg, [0.025, 0.975])
    assert 0.0 < low < 0.02 < high
    found = left_out(walks)
    assert found["mixed without load_kg"].crps_less_s[0] > 0.1 * found["mixed"].crps_s
    low_s = found["mixed without load_kg"].crps_less_s[1]
    assert low_s is not None
    assert low_s > 0.0


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    ("differs_between", "worse_by"), [("walks", WALK_WORSE_BY), ("people", PERSON_WORSE_BY)]
)
def test_pure_noise_hardly_worsens_the_prediction_of_others(
    seed: int, differs_between: str, worse_by: float
) -> None:
    """A number that has nothing to do with the walks costs people left out at most 5 % of CRPS.

    If only people differ in it, nine of them cannot tell it from chance: then it is at most 20 %,
    and the row of the model without the number says by how much.
    """
    rng = np.random.default_rng((9, seed))
    per_walk = 8 * PEOPLE
    noise = (
        rng.normal(size=per_walk)
        if differs_between == "walks"
        else np.repeat(rng.normal(size=PEOPLE), 8)
    )
    found = left_out(database(noise, 0.0, seed))
    plain_s, with_noise_s = found["mixed without load_kg"].crps_s, found["mixed"].crps_s
    assert with_noise_s <= (1.0 + worse_by) * plain_s
    gain_s = found["mixed without load_kg"].crps_less_s[0]
    assert gain_s == pytest.approx(plain_s - with_noise_s)


def test_each_dependency_is_judged_by_itself() -> None:
    """Of a load and a number without meaning, the rows without each say which one helps."""
    rng = np.random.default_rng(11)
    loads_kg = np.tile([0.0, 0.0, 0.0, 0.0, 10.0, 10.0, 10.0, 10.0], PEOPLE)
    walks = database(loads_kg, 0.02, seed=1)
    noise = rng.normal(size=(len(walks), 1))
    both = replace(walks, names=(*walks.names, "mood"), vectors=np.hstack([walks.vectors, noise]))
    found = left_out(both)
    assert list(found)[-2:] == ["mixed without load_kg", "mixed without mood"]
    helps, helps_not = (
        found[f"mixed without {name}"].crps_less_s[0] for name in ("load_kg", "mood")
    )
    assert helps > 0.1 * found["mixed"].crps_s
    assert abs(helps_not) < WALK_WORSE_BY * found["mixed"].crps_s


def test_a_database_without_further_dependencies_has_no_such_row() -> None:
    """Where walks depend on length, turning and stature alone, nothing is left out of mixed."""
    walks = database(np.zeros(8 * PEOPLE), 0.0, seed=1).without(["load_kg"])
    assert further_of(walks.names) == ()
    assert set(left_out(walks)) == {"mixed", "constant speed", "line", "log-log"}
    with pytest.raises(WalkingError, match=r"do not match"):
        WalkDatabase(**{**vars(walks), "names": ("length_m",)})
