"""The shipped study as text, and functions that change it."""

from functools import cache
from pathlib import Path

import pytest

from app.protocol import (
    ConfigError,
    ConfigProblem,
    LoadedStudy,
    StudyProtocol,
    load_instrument,
    load_study,
)
from app.science.instruments import Instrument

CONFIGS = Path(__file__).parents[2] / "study_configs"
SHIPPED = (CONFIGS / "reembodiment-latency.yaml").read_text(encoding="utf-8")
"""The shipped latency study."""


def as_delayed_copy(text: str) -> str:
    """Return a study with a delayed-copy avatar, which needs no headset that simulates."""
    moved = "avatar: physics\navatar_configuration: {key: standard, version: 2}\n"
    assert moved in text
    return text.replace(moved, "avatar: delayed_copy\n", 1)


STUDY = as_delayed_copy(SHIPPED)
"""The shipped latency study with a delayed copy, since most tests do not concern physics."""


@cache
def instruments() -> dict[str, Instrument]:
    """Return the shipped instruments by their keys."""
    files = sorted((CONFIGS / "instruments").glob("*.yaml"))
    loaded = [load_instrument(file.read_text(encoding="utf-8")).instrument for file in files]
    return {instrument.key: instrument for instrument in loaded}


BEFORE_RULES = Path(__file__).with_name("study_before_rules.yaml").read_text(encoding="utf-8")
"""The latency study as shipped before studies had rules of validity."""


def edited(*changes: tuple[str, str]) -> str:
    """Return the shipped study with words replaced, each of which must occur."""
    text = STUDY
    for old, new in changes:
        assert old in text, f"{old!r} is not in the study"
        text = text.replace(old, new, 1)
    return text


def loaded(text: str = STUDY) -> LoadedStudy:
    """Return a study loaded with the shipped instruments."""
    return load_study(text, instruments=instruments())


def study(*changes: tuple[str, str]) -> StudyProtocol:
    """Return the protocol of the shipped study with words replaced."""
    return loaded(edited(*changes)).protocol


def levels(n: int) -> str:
    """Return the conditions section of a study with n levels."""
    lines = [
        f"  - {{key: c{level}, latency_ms: {level}, label: {{en: a, de: a}}}}" for level in range(n)
    ]
    return "conditions:\n" + "\n".join(lines) + "\n"


def with_levels(n: int) -> str:
    """Return the shipped study with n conditions."""
    start, end = STUDY.index("conditions:\n"), STUDY.index("# All 3!")
    return STUDY[:start] + levels(n) + STUDY[end:]


def problems(text: str) -> tuple[ConfigProblem, ...]:
    """Return the problems of an invalid study file; there must be some."""
    with pytest.raises(ConfigError) as caught:
        loaded(text)
    return caught.value.problems
