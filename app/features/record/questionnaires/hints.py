"""Hints about a stored form's answers, for the operator while the participant is still there.

A hint is a reason to ask "was anything unclear?", and never more: answers are stored and scored as
they are, nothing is rejected, and the participant does not see it. There are three kinds:

- *alike*: all ratings on one scale are the same, and there are at least `ALIKE_ITEMS` of them. If
  all are the lowest step and no item is reverse-keyed, there is no hint, because a person without
  any symptoms answers a list of symptoms in this way. (Straight-lining: Curran 2016, Journal of
  Experimental Social Psychology 66, 4-19.)
- *fast*: half of the ratings took less than `FAST_S` each, and there are at least `FAST_ITEMS` of
  them. Huang et al. (2012, Journal of Business and Psychology 27, 99-114) regard less than 2 s per
  item as careless; half of that is our choice, since items here are short and a wrong hint costs
  trust. Only for answers given on the tablet: an operator types what the participant says.
- *left_out*: questions without an answer, except open ones, which are often empty for good reason.
"""

from collections.abc import Mapping
from itertools import groupby
from statistics import median
from typing import Any

from app.features.record.questionnaires.schemas import AnswerHint
from app.models import Submission
from app.science.instruments import Instrument, Item

ALIKE_ITEMS = 5
FAST_ITEMS = 5
FAST_S = 1.0
Answers = Mapping[str, str | float | None]


def hints_of(instrument: Instrument, submission: Submission, answers: Answers) -> list[AnswerHint]:
    """Return the hints about a stored form's current answers; none if they were erased."""
    rated = [
        item
        for item in instrument.items
        if item.type == "likert" and isinstance(answers.get(item.key), float)
    ]
    return [
        *_alike(instrument, rated, answers),
        *(_fast(rated, submission.item_traces or {}) if submission.mode == "tablet" else ()),
        *_left_out(instrument, answers),
    ]


def _alike(instrument: Instrument, rated: list[Item], answers: Answers) -> list[AnswerHint]:
    hints = []

    def scale_of(item: Item) -> str:
        return repr(instrument.scale_of(item))

    for _, group in groupby(sorted(rated, key=scale_of), scale_of):
        items = list(group)
        given = {answers[item.key] for item in items}
        value = given.pop()
        if given or len(items) < ALIKE_ITEMS or not isinstance(value, float):
            continue
        scale = instrument.scale_of(items[0])
        none_at_all = scale is not None and value == scale.minimum
        if none_at_all and not any(item.reverse_keyed for item in items):
            continue
        hints.append(AnswerHint(kind="alike", items=len(items), value=value))
    return hints


def _fast(rated: list[Item], traces: Mapping[str, Mapping[str, Any]]) -> list[AnswerHint]:
    times_s = [float(traces[item.key]["response_s"]) for item in rated if item.key in traces]
    if len(times_s) < FAST_ITEMS or median(times_s) >= FAST_S:
        return []
    return [AnswerHint(kind="fast", items=len(times_s), seconds=FAST_S)]


def _left_out(instrument: Instrument, answers: Answers) -> list[AnswerHint]:
    empty = [
        item
        for item in instrument.items
        if item.type != "text" and item.key in answers and answers[item.key] is None
    ]
    return [AnswerHint(kind="left_out", items=len(empty))] if empty else []
