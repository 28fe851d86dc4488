"""Describe every deviation of what was done from what was declared, in plain words."""

import json
from collections.abc import Sequence
from datetime import datetime
from itertools import pairwise

import pandas as pd

from app.features.results.preregistration.declaration import (
    Declared,
    declared_in,
    rule_words,
)
from app.features.results.preregistration.exclusions import Excluded
from app.features.results.preregistration.primary_test import Values
from app.features.results.preregistration.schemas import DeviationCode, DeviationView
from app.models import StudyVersion
from app.protocol import differences

_SHOWN = 12


def deviations_of(
    declared: Declared,
    versions: Sequence[StudyVersion],
    sessions: pd.DataFrame,
    excluded: Excluded,
    found: Values,
    n_corrected: int,
) -> list[DeviationView]:
    """Return the deviations, followed by the notes."""
    deviations = [
        *_versions(declared, versions, sessions),
        *_numbers(declared, sessions, len(found.people)),
        *_by_hand(declared, sessions),
        *_unjudged(declared, excluded),
        *_values(found, n_corrected),
        *_notes(declared),
    ]
    return sorted(deviations, key=lambda one: one.is_note)


def _versions(
    declared: Declared, versions: Sequence[StudyVersion], sessions: pd.DataFrame
) -> list[DeviationView]:
    deviations: list[DeviationView] = []
    by_number = {version.number: version for version in versions}
    # Without sessions, indexing by an empty list would select columns.
    elsewhere = pd.Series(
        [
            declared_in(by_number[int(n)]) != declared.preregistration
            for n in sessions["study_version"]
        ],
        index=sessions.index,
        dtype=bool,
    )
    other = sessions[elsewhere]
    started = other[other["started_at_utc"].notna()]
    if not started.empty:
        numbers = ", ".join(str(n) for n in sorted(set(started["study_version"])))
        deviations.append(
            _deviation(
                "declared_late",
                f"{_count(len(started), 'session')} ran on version {numbers}, which did not "
                "declare this: it was declared, or changed, after data were collected.",
            )
        )
    starts = sessions["started_at_utc"].dropna()
    if starts.empty:
        return deviations
    first: datetime = starts.min().to_pydatetime()
    for before, after in pairwise(versions):
        if after.created_at <= first:
            continue
        trees = (json.loads(one.canonical_json) for one in (before, after))
        places = list(differences(*trees))
        code: DeviationCode = "changed_since_start"
        said = "the protocol"
        if any(one.path[:1] == ("preregistration",) for one in places):
            code, said = "declaration_changed", "the protocol and the declaration itself"
        deviations.append(
            _deviation(
                code,
                f"Version {after.number} changed {said} after the first session "
                f"({_count(len(places), 'place')}; Versions shows each).",
            )
        )
    return deviations


def _numbers(declared: Declared, sessions: pd.DataFrame, n: int) -> list[DeviationView]:
    deviations = []
    planned = declared.preregistration.planned_n
    still = int(sessions["status"].isin(["planned", "active"]).sum())
    if still:
        deviations.append(
            _note(
                "still_open",
                f"{_count(still, 'session')} not completed yet, and so not in the test.",
            )
        )
    if n < planned:
        said = f"{n} of {planned} declared participants are in the test."
        deviations.append(
            _deviation(
                "n_short", f"{said} A test before the last participant is an interim analysis."
            )
        )
    if n > planned:
        deviations.append(
            _deviation("n_over", f"{n} participants are in the test; {planned} were declared.")
        )
    return deviations


def _by_hand(declared: Declared, sessions: pd.DataFrame) -> list[DeviationView]:
    rules = {rule.rule for rule in declared.preregistration.exclusions}
    broken = sessions[sessions["status"].isin(["aborted", "withdrawn"])]
    if broken.empty or "complete_session" in rules:
        return []
    names = _names(list(broken["participant_code"]))
    return [
        _deviation(
            "left_out_by_hand",
            f"{_count(len(broken), 'session')} ended early and excluded, although no declared "
            f"rule says so: {names}.",
        )
    ]


def _unjudged(declared: Declared, excluded: Excluded) -> list[DeviationView]:
    words: dict[str, str] = {
        one.rule: rule_words(one) for one in declared.preregistration.exclusions
    }
    return [
        _deviation(
            "not_judged",
            f"The rule “{words[rule]}” could not be applied to {_names(codes)}, because nothing "
            "was measured. It did not exclude them.",
        )
        for rule, codes in excluded.not_judged.items()
    ]


def _values(found: Values, n_corrected: int) -> list[DeviationView]:
    deviations = []
    if found.lacking:
        deviations.append(
            _deviation(
                "missing_values",
                f"{_names(list(found.lacking))} excluded for a missing value in a condition, not "
                "by a declared rule.",
            )
        )
    if n_corrected:
        where = "corrections.csv in the export lists each with its reason."
        said = f"{_count(n_corrected, 'answer')} corrected after it was given; {where}"
        deviations.append(_note("corrected", said))
    return deviations


def _notes(declared: Declared) -> list[DeviationView]:
    deviations = []
    if not declared.preregistration.registration:
        deviations.append(
            _note(
                "not_registered",
                "No registration is given: only this server dates and hashes the declaration. A "
                "registry (OSF, AsPredicted) makes the date independent of the lab.",
            )
        )
    deviations.append(
        _note(
            "exploratory",
            "Every other test, including those on the Statistics page, is exploratory.",
        )
    )
    return deviations


def _names(codes: list[str]) -> str:
    more = len(codes) - _SHOWN
    return ", ".join(codes[:_SHOWN]) + (f" and {more} more" if more > 0 else "")


def _count(n: int, what: str) -> str:
    return f"{n} {what}{'' if n == 1 else 's'}"


def _deviation(code: DeviationCode, text: str) -> DeviationView:
    return DeviationView(code=code, is_note=False, text=text)


def _note(code: DeviationCode, text: str) -> DeviationView:
    return DeviationView(code=code, is_note=True, text=text)
