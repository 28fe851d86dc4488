"""Tests that the example of assumptions fits every study that it is made for."""

from pathlib import Path

import pytest

from app.cli.pilot.inputs import read_study
from app.features.results.pilot.example import example_assumptions
from app.features.results.pilot.simulation import SimulatedStudy
from app.features.results.pilot.simulation.plan import Chunk
from app.protocol import declared_analysis, load_assumptions
from tests.protocol.helpers import CONFIGS

STUDIES = ["reembodiment-latency", *(path.stem for path in (CONFIGS / "templates").glob("*.yaml"))]
TEMPLATE = CONFIGS / "templates" / "two-latencies-hand.yaml"
DECLARED = """\
preregistration:
  alpha: 0.05
  planned_n: 12
  primary: {measure: MEASURE, limb: hand, test: rm_anova}
"""


@pytest.mark.parametrize("name", STUDIES)
def test_it_is_valid_for_every_shipped_study_and_can_be_simulated(name: str) -> None:
    """It names a test of the study's own score, and data sets are drawn from it."""
    file = read_study(name)
    study = file.study.protocol
    text = example_assumptions(study, file.instruments)
    if not study.procedure.block.phases:
        assert text is None
        return
    assert text is not None
    assert text.startswith("# An example for this study. Nobody has measured")
    given = load_assumptions(text, study, file.instruments).assumptions
    assert {one["source"] for one in given.stated()} == {"assumed in an example: replace it"}
    declared = declared_analysis(study, given)
    assert declared is not None
    assert declared.primary.limb in {one.limb for one in study.procedure.block.phases}
    tested = SimulatedStudy(study, given, file.instruments).tested(Chunk(12, "effect", 0, 5), 1)
    assert not tested.failed.any()


@pytest.mark.parametrize("measure", ["completions", "contact_time"])
def test_it_is_about_the_test_that_the_study_declares(measure: str, tmp_path: Path) -> None:
    """A declared measure that is no score gets means by limb and condition, and no second test."""
    path = tmp_path / "study.yaml"
    declared = DECLARED.replace("MEASURE", measure)
    path.write_text(f"{TEMPLATE.read_text(encoding='utf-8')}\n{declared}", encoding="utf-8")
    file = read_study(str(path))
    text = example_assumptions(file.study.protocol, file.instruments)
    assert text is not None
    given = load_assumptions(text, file.study.protocol, file.instruments).assumptions
    assert given.preregistration is None
    assert set(given.performance) == {measure}
