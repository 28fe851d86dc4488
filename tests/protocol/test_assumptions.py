"""Tests of files of assumptions: the shipped ones are valid, and problems say what to do."""

import pytest

from app.protocol import ConfigError, StudyProtocol, load_assumptions, load_study
from tests.protocol.helpers import CONFIGS, SHIPPED, instruments

_TEXT = (CONFIGS / "assumptions" / "reembodiment-latency.yaml").read_text(encoding="utf-8")


def _study(text: str = SHIPPED) -> StudyProtocol:
    return load_study(text, instruments=instruments()).protocol


def test_shipped_assumptions_fit_their_studies() -> None:
    """Every shipped file is valid for the study that has its key."""
    files = [*CONFIGS.glob("*.yaml"), *(CONFIGS / "templates").glob("*.yaml")]
    studies = {one.key: one for one in (_study(file.read_text("utf-8")) for file in files)}
    shipped = sorted((CONFIGS / "assumptions").glob("*.yaml"))
    assert shipped
    for file in shipped:
        load_assumptions(file.read_text("utf-8"), studies[file.stem], instruments())


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("study: reembodiment-latency", "study: other", "for another study"),
        ("unit: share, source: assumed", "unit: share", "source"),
        ("dropout: {value: 0.01", "dropout: {value: 1.2", "at most 1"),
        ("dropout: {value: 0.01, unit: share", "dropout: {value: 0.01, unit: percent", "share"),
        ("    latency_125:", "    latency_130:", "no number for the condition latency_125"),
        ("[-3.0, -2.2,", "[-2.2, -3.0,", "do not ascend"),
        ("[-3.0, -2.2,", "[-3.0,", "6 thresholds are between them; there are 5"),
        ("    q8:", "    q99:", "no Likert item 'q99'"),
        ("instrument: karas2020\n  # Eff", "instrument: veq\n  # Eff", "score of 'karas2020'"),
        ("measure: score\n    instrument: karas2020\n    score: agency", "measure: completions",
         "nothing says how large it is"),
        ("persons: {value: 1.0", "persons: {value: -1.0", "at least 0"),
        ("carry_over:", "carry_ovr:", "carry_ovr"),
    ],
)  # fmt: skip
def test_problems_are_named_with_their_line(old: str, new: str, said: str) -> None:
    """A file that does not fit is refused with the place of each problem."""
    assert old in _TEXT
    with pytest.raises(ConfigError) as refused:
        load_assumptions(_TEXT.replace(old, new, 1), _study(), instruments())
    assert said in str(refused.value)
    assert all(problem.line for problem in refused.value.problems)


def test_a_study_with_a_test_of_its_own_keeps_it() -> None:
    """Assumptions cannot replace what a study has preregistered."""
    declared = _TEXT[_TEXT.index("preregistration:") :]
    with pytest.raises(ConfigError, match="declares its own test"):
        load_assumptions(_TEXT, _study(f"{SHIPPED}\n{declared}"), instruments())


def test_no_test_anywhere_is_a_problem() -> None:
    """Without a declared test there is no power, and the message says where to declare one."""
    undeclared = _TEXT[: _TEXT.index("preregistration:")]
    with pytest.raises(ConfigError, match=r"Declare it in the study"):
        load_assumptions(undeclared, _study(), instruments())
