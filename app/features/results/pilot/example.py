"""An example of what might be assumed of people's answers in a study, for its author to replace.

Nobody has measured any of its numbers: every source says so, and the file begins with it.
"""

from collections.abc import Iterator, Mapping
from typing import Any, Final

from app.protocol import (
    ConfigError,
    Plain,
    Preregistration,
    StudyProtocol,
    load_assumptions,
    sequences,
)
from app.science.instruments import Instrument

EXAMPLE_SOURCE: Final = "assumed in an example: replace it"
"""The source of every number that nobody has replaced yet."""
_HEAD: Final = """\
# An example for this study. Nobody has measured any of these numbers: replace each by what you
# expect of your participants, and say in its source where it comes from. docs/pilot.md explains
# each.
"""
_ALPHA: Final = 0.05
_TREND_CONDITIONS: Final = 3
"""Page's trend test compares at least so many conditions."""
_LARGEST_EFFECT: Final = 1.0
"""Logits between the shortest and the longest latency."""
_OUTERMOST_THRESHOLD: Final = 2.5
_MEANS: Final = {"completions": (6.0, 4.0), "contact_time": (2.0, 4.0)}
"""Of the shortest and of the longest latency, in the unit of the measure."""
_UNITS: Final = {"completions": "tasks", "contact_time": "s"}


def example_assumptions(study: StudyProtocol, instruments: Mapping[str, Instrument]) -> str | None:
    """Return a file of assumptions that is valid for the study; None if none can be made.

    It is about the test that the study declares, or about one that it might declare: of the first
    score that is asked after a task, or else of completed tasks.
    """
    declared = study.preregistration
    for primary in _candidates(study, instruments) if declared is None else (declared.primary,):
        given = primary if isinstance(primary, dict) else primary.model_dump(mode="json")
        text = _HEAD + _written(_file(study, instruments, given, declared))
        try:
            load_assumptions(text, study, instruments)
        except ConfigError:
            continue
        return text
    return None


def _candidates(
    study: StudyProtocol, instruments: Mapping[str, Instrument]
) -> Iterator[dict[str, Any]]:
    """Yield the tests that the study might declare, the best first."""
    phases = study.procedure.block.phases
    test = _test(study)
    for phase in phases:
        key = phase.questionnaire
        if key is None or key not in instruments:
            continue
        for score in instruments[key].scores:
            yield {
                "measure": "score",
                "instrument": key,
                "score": score.key,
                "limb": str(phase.limb),
                **test,
            }
    if phases:
        yield {"measure": "completions", "limb": str(phases[0].limb), **test}


def _test(study: StudyProtocol) -> dict[str, str]:
    conditions = _conditions(study)
    if len(conditions) >= _TREND_CONDITIONS:
        return {"test": "page_trend", "direction": "falls"}
    return {"test": "against_reference", "direction": "falls", "reference": conditions[0]}


def _conditions(study: StudyProtocol) -> list[str]:
    return [one.key for one in sorted(study.conditions, key=lambda one: one.latency_ms)]


def _file(
    study: StudyProtocol,
    instruments: Mapping[str, Instrument],
    primary: Mapping[str, Any],
    declared: Preregistration | None,
) -> dict[str, Any]:
    phases = study.procedure.block.phases
    content: dict[str, Any] = {
        "study": study.key,
        "dropout": _number(0.01, "share"),
        "excluded": _number(0.03, "share"),
    }
    # A measure that rises with latency is assumed to rise in the example, too.
    sign = 1.0 if primary["direction"] == "rises" else -1.0
    if primary["measure"] == "score":
        key = str(primary["instrument"])
        limbs = [str(one.limb) for one in phases if one.questionnaire == key]
        content["answering"] = _answering(study, key, instruments.get(key), limbs, sign)
    else:
        measure = str(primary["measure"])
        tested = (str(one.limb) for one in phases)
        limbs = [limb for limb in tested if primary["limb"] in (limb, "both")]
        content["performance"] = {measure: _performance(study, measure, limbs)}
    if declared is None:
        planned = study.orders.replicates * len(sequences(study))
        content["preregistration"] = {
            "alpha": _ALPHA,
            "planned_n": max(2, min(planned, 10_000)),
            "primary": dict(primary),
        }
    return content


def _answering(
    study: StudyProtocol, key: str, instrument: Instrument | None, limbs: list[str], sign: float
) -> dict[str, Any]:
    conditions = _conditions(study)
    last = max(len(conditions) - 1, 1)
    ratings = _ratings(instrument)
    usual = max(ratings.values(), key=list(ratings.values()).count, default=2)
    answering: dict[str, Any] = {
        "instrument": key,
        "effects": {
            condition: _number(round(sign * _LARGEST_EFFECT * at / last, 2) + 0.0, "logits")
            for at, condition in enumerate(conditions)
        },
    }
    if len(set(limbs)) > 1:
        answering["limbs"] = {limb: _number(0.0, "logits") for limb in dict.fromkeys(limbs)}
    answering |= {
        "persons": _number(1.0, "logits"),
        "reactions": _number(0.4, "logits"),
        "moments": _number(0.3, "logits"),
        "carry_over": _number(0.1, "share"),
        "period": _number(0.05, "logits"),
        "straight_lining": _number(0.02, "share"),
        "discrimination": _number(1.0, "factor"),
        "thresholds": _thresholds(usual),
    }
    others = {item: count for item, count in ratings.items() if count != usual}
    if others:
        answering["items"] = {
            item: {"thresholds": _thresholds(count)} for item, count in others.items()
        }
    return answering


def _ratings(instrument: Instrument | None) -> dict[str, int]:
    """Return how many ratings each Likert item has."""
    if instrument is None:
        return {}
    scales = {item.key: instrument.scale_of(item) for item in instrument.items}
    return {key: len(scale.steps) for key, scale in scales.items() if scale is not None}


def _thresholds(ratings: int) -> dict[str, Any]:
    count = max(ratings - 1, 1)
    width = 2.0 * _OUTERMOST_THRESHOLD / max(count - 1, 1)
    values = [round(-_OUTERMOST_THRESHOLD + width * at, 3) for at in range(count)]
    return {"values": values if count > 1 else [0.0], "unit": "logits", "source": EXAMPLE_SOURCE}


def _performance(study: StudyProtocol, measure: str, limbs: list[str]) -> dict[str, Any]:
    conditions, unit = _conditions(study), _UNITS[measure]
    first, final = _MEANS[measure]
    last = max(len(conditions) - 1, 1)
    means = {
        condition: _number(round(first + (final - first) * at / last, 2), unit)
        for at, condition in enumerate(conditions)
    }
    return {
        "means": dict.fromkeys(limbs, means),
        "persons": _number(1.5, unit),
        "reactions": _number(0.5, unit),
        "moments": _number(0.8, unit),
        "carry_over": _number(0.1, "share"),
        "period": _number(0.1, unit),
    }


def _number(value: float, unit: str) -> dict[str, Any]:
    return {"value": value, "unit": unit, "source": EXAMPLE_SOURCE}


def _written(node: Mapping[str, Any], indent: str = "") -> str:
    """Return a mapping as YAML, with a number, its unit and its source in one line."""
    lines: list[str] = []
    for key, value in node.items():
        if isinstance(value, Mapping) and "source" not in value:
            lines.append(f"{indent}{key}:\n{_written(value, f'{indent}  ')}")
        else:
            lines.append(f"{indent}{key}: {_inline(value)}\n")
    return "".join(lines)


def _inline(value: Plain) -> str:
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key}: {_inline(one)}' for key, one in value.items())}}}"
    if isinstance(value, list):
        return f"[{', '.join(map(_inline, value))}]"
    return f'"{value}"' if value == EXAMPLE_SOURCE else f"{value}"
