"""Tests that simulated data sets of a study are as assumed, and are analysed like people's."""

from functools import cache

import numpy as np
import pytest

from app.features.results.pilot.simulation import Chunk, PilotError, SimulatedStudy, make_plan
from app.protocol import Assumptions, StudyProtocol, load_assumptions, load_study
from app.resources import study_configs_dir
from app.science.statistical_tests import Sample, statistical_test
from app.science.statistics import error_rates_from_json
from tests.protocol.helpers import CONFIGS, SHIPPED, instruments

_MEASURED = """
study: reembodiment-latency
dropout: {value: 0, unit: share, source: assumed}
excluded: {value: 0, unit: share, source: assumed}
performance:
  contact_time:
    means:
      hand:
        latency_0: {value: 20, unit: s, source: assumed}
        latency_125: {value: 22, unit: s, source: assumed}
        latency_350: {value: 26, unit: s, source: assumed}
    persons: {value: 4, unit: s, source: assumed}
    reactions: {value: 2, unit: s, source: assumed}
    moments: {value: 2, unit: s, source: assumed}
    carry_over: {value: 0, unit: share, source: assumed}
    period: {value: -1, unit: s, source: assumed}
preregistration:
  alpha: 0.05
  planned_n: 12
  primary: {measure: contact_time, limb: hand, test: rm_anova}
"""


@cache
def _study() -> StudyProtocol:
    return load_study(SHIPPED, instruments=instruments()).protocol


def _simulated(text: str) -> SimulatedStudy:
    assumptions = load_assumptions(text, _study(), instruments()).assumptions
    return SimulatedStudy(_study(), assumptions, instruments())


def _shipped_assumptions() -> str:
    return (CONFIGS / "assumptions" / "reembodiment-latency.yaml").read_text(encoding="utf-8")


def test_planted_effects_of_a_measure_are_recovered() -> None:
    """A difference of 6 s is found within 5 % although every block shifts the measure by -1 s."""
    simulated = _simulated(_MEASURED)
    assert simulated.assumed_difference(1) == pytest.approx(6.0, rel=0.01)
    found = simulated.tested(Chunk(12, "effect", 0, 400), seed=7)
    assert found.estimates.mean() == pytest.approx(6.0, rel=0.05)
    null = simulated.tested(Chunk(12, "null", 0, 400), seed=7)
    assert abs(null.estimates.mean()) < 0.3
    assert not found.failed.any()
    assert set(found.in_test) == {12}


def test_planted_effects_of_a_score_are_recovered_where_nothing_disturbs_them() -> None:
    """Without carry-over and straight-lining, the mean score differs as assumed, within 5 %."""
    text = _shipped_assumptions()
    for old in ("carry_over: {value: 0.1", "straight_lining: {value: 0.02"):
        assert old in text
        text = text.replace(old, old[: old.index("value")] + "value: 0")
    simulated = _simulated(text)
    found = simulated.tested(Chunk(24, "effect", 0, 300), seed=3)
    assert found.estimates.mean() == pytest.approx(simulated.assumed_difference(3), rel=0.05)


def test_carry_over_shows_as_bias() -> None:
    """With a share of each effect carried over, the estimate is smaller than what is assumed."""
    text = _MEASURED.replace("carry_over: {value: 0", "carry_over: {value: 0.5")
    simulated = _simulated(text)
    found = simulated.tested(Chunk(12, "effect", 0, 400), seed=7)
    # Each condition follows both others equally often: half of (2 + 6) / 2 against (2 + 0) / 2, of
    # the two positions in three that follow anything.
    assert found.estimates.mean() == pytest.approx(6.0 - 0.5 * (2 / 3) * 3.0, rel=0.05)


def test_the_level_is_that_of_the_table_of_error_rates() -> None:
    """Without effect and period, the declared rm ANOVA has the table's rate within 2 SE."""
    text = (study_configs_dir().parent / "app/science/statistics/error_rates.json").read_text()
    row = error_rates_from_json(text).near("rm_anova_gg", 24)
    assert row is not None
    still = _MEASURED.replace("period: {value: -1", "period: {value: 0")
    null = _simulated(still).tested(Chunk(24, "null", 0, 2000), seed=11)
    se = np.hypot(row.standard_error, np.sqrt(0.05 * 0.95 / 2000))
    assert null.significant.mean() == pytest.approx(row.rate, abs=2 * se)


def test_straight_lined_forms_exclude_by_the_declared_rule() -> None:
    """With every tenth form straight-lined, people without one of six forms are half the sample."""
    text = _shipped_assumptions().replace(
        "straight_lining: {value: 0.02", "straight_lining: {value: 0.1"
    )
    _, kept = _simulated(text).data_sets(Chunk(40, "effect", 0, 50), seed=5)
    assert kept.mean() == pytest.approx(0.9**6 * 0.99**3 * 0.97, abs=0.03)
    lenient = text.replace(
        "maximum_straight_lined_forms, limit: 0", "maximum_straight_lined_forms, limit: 6"
    )
    _, kept = _simulated(lenient).data_sets(Chunk(40, "effect", 0, 50), seed=5)
    assert kept.mean() == pytest.approx(0.99**3 * 0.97, abs=0.02)


def test_the_declared_test_decides() -> None:
    """Each data set is significant exactly if the registered test's p is at most alpha."""
    simulated, chunk = _simulated(_shipped_assumptions()), Chunk(12, "effect", 0, 20)
    values, kept = simulated.data_sets(chunk, seed=1)
    page = statistical_test("page_trend").load()
    levels = ("latency_0", "latency_125", "latency_350")
    p = [
        page(Sample(one[keep], levels, direction="falls")).p
        for one, keep in zip(values, kept, strict=True)
    ]
    assert simulated.tested(chunk, seed=1).significant.tolist() == [one <= 0.05 for one in p]


def test_data_sets_depend_on_nothing_but_their_chunk() -> None:
    """The same chunk gives the same values again, and another one other values."""
    simulated = _simulated(_MEASURED)
    first, again = (simulated.data_sets(Chunk(8, "effect", 3, 5), 2)[0] for _ in range(2))
    assert np.array_equal(first, again)
    for other in (Chunk(8, "effect", 4, 5), Chunk(8, "null", 3, 5)):
        assert not np.array_equal(first, simulated.data_sets(other, 2)[0])


def test_too_few_people_fail_and_are_counted() -> None:
    """If almost everybody stops, tests fail; they are counted and never significant."""
    text = _MEASURED.replace("dropout: {value: 0,", "dropout: {value: 0.9,")
    found = _simulated(text).tested(Chunk(4, "effect", 0, 50), seed=1)
    assert found.failed.sum() > 40
    assert not found.significant[found.failed].any()


def test_more_people_than_a_closed_ledger_has_are_refused() -> None:
    """A closed ledger of 12 slots refuses 13 participants, and the message says what to do."""
    closed = load_study(
        SHIPPED.replace("when_full: grow", "when_full: closed"), instruments=instruments()
    ).protocol
    with pytest.raises(PilotError, match=r"12 slots .* orders.replicates"):
        make_plan(closed, [13], 100, 1)
    assert make_plan(closed, [12, 6, 12], 100, 1).participants == (6, 12)


def test_assumptions_are_stated_with_unit_and_source() -> None:
    """Every number of the file is listed with its unit and its source."""
    given = load_assumptions(_shipped_assumptions(), _study(), instruments()).assumptions
    assert isinstance(given, Assumptions)
    stated = {str(one["name"]): one for one in given.stated()}
    assert stated["answering.effects.latency_350"]["value"] == -1.2
    assert all(one["unit"] and one["source"] for one in stated.values())
    assert len(stated) == _shipped_assumptions().count("source:")
