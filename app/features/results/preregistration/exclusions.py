"""Apply the declared exclusion rules to every session that is over, and report the reasons.

A rule that cannot be judged, because nothing was measured, excludes nobody; this is reported.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.design.instruments import instrument_of
from app.features.results.analysis.tables import (
    Kind,
    answers_table,
    phases_table,
    quality_table,
    sessions_table,
)
from app.features.results.preregistration.schemas import ExclusionView
from app.models import InstrumentVersion
from app.protocol import COUNTED_KINDS, ExclusionRule
from app.science.instruments import straight_lined

OVER = ("completed", "aborted", "withdrawn")


@dataclass
class Tables:
    """The tables of a study's sessions of one kind that the rules and the test need."""

    sessions: pd.DataFrame
    phases: pd.DataFrame
    quality: pd.DataFrame
    answers: pd.DataFrame
    one_sided: frozenset[tuple[str, int]]

    @property
    def tasks(self) -> pd.DataFrame:
        """Return the valid task phases."""
        return self.phases[self.phases["phase_kind"].isin(COUNTED_KINDS) & self.phases["valid"]]


@dataclass
class Excluded:
    """The excluded sessions, and the rules that could not be judged for some participants."""

    found: list[ExclusionView] = field(default_factory=list)
    not_judged: dict[str, list[str]] = field(default_factory=dict)
    session_ids: set[str] = field(default_factory=set)


def read_tables(db: Session, study_key: str, kind: Kind) -> Tables:
    """Read the tables that the rules and the test need."""
    instruments = [instrument_of(row) for row in db.scalars(select(InstrumentVersion))]
    return Tables(
        sessions=sessions_table(db, study_key, kind),
        phases=phases_table(db, study_key, kind),
        quality=quality_table(db, study_key, kind),
        answers=answers_table(db, study_key, kind),
        # If no item is reverse-keyed, the lowest answer to all of them can be an honest one.
        one_sided=frozenset(
            (one.key, one.version)
            for one in instruments
            if not any(item.reverse_keyed for item in one.items)
        ),
    )


def exclude(tables: Tables, rules: tuple[ExclusionRule, ...]) -> Excluded:
    """Apply the study's `valid_when` and then every rule to each session that is over."""
    out = Excluded()
    over = tables.sessions[tables.sessions["status"].isin(OVER)]
    rows = over[["session_id", "participant_code", "status", "valid", "reasons_not_valid"]]
    for session_id, code, status, valid, why in rows.itertuples(index=False, name=None):
        if status == "completed" and not valid:
            # The study's own rules come first; data for the other rules may be missing.
            out.found.append(ExclusionView(participant_code=code, rule="valid_when", reason=why))
            out.session_ids.add(session_id)
            continue
        for rule in rules:
            if rule.rule == "complete_session":
                found_reason = None if status == "completed" else f"the session was {status}"
            elif status != "completed":
                continue
            else:
                found_reason = _JUDGES[rule.rule](tables, session_id, rule.limit or 0.0)
            if found_reason == NOT_JUDGED:
                out.not_judged.setdefault(rule.rule, []).append(code)
            elif found_reason is not None:
                out.found.append(
                    ExclusionView(participant_code=code, rule=rule.rule, reason=found_reason)
                )
                out.session_ids.add(session_id)
    return out


NOT_JUDGED = "?"
Judge = Callable[[Tables, str, float], str | None]


def _frame_rate(tables: Tables, session_id: str, limit: float) -> str | None:
    values = _quality(tables, session_id)["frame_rate_hz"].dropna()
    if values.empty:
        return NOT_JUDGED
    lowest = float(values.min())
    return None if lowest >= limit else f"{lowest:.1f} frames per second, declared {limit:g}"


def _share(tables: Tables, session_id: str, limit: float) -> str | None:
    rows = _quality(tables, session_id)
    rows = rows[rows["span_s"] > 0]
    if rows.empty:
        return NOT_JUDGED
    lowest = float((1.0 - rows["gap_s"] / rows["span_s"]).min())
    return None if lowest >= limit else f"{lowest:.1%} of the time in frames, declared {limit:.1%}"


def _latency(tables: Tables, session_id: str, limit: float) -> str | None:
    rows = _of(tables.tasks, session_id).dropna(subset=["achieved_latency_ms"])
    if rows.empty:
        return NOT_JUDGED
    worst = float((rows["achieved_latency_ms"] - rows["latency_ms"]).abs().max())
    return None if worst <= limit else f"latency off by {worst:.0f} ms, declared {limit:g} ms"


def _active(tables: Tables, session_id: str, limit: float) -> str | None:
    values = _of(tables.tasks, session_id)["active_s"].dropna()
    if values.empty:
        return NOT_JUDGED
    shortest = float(values.min())
    return None if shortest >= limit else f"{shortest:.0f} s of active time, declared {limit:g} s"


def _straight(tables: Tables, session_id: str, limit: float) -> str | None:
    rows = _of(tables.answers, session_id)
    rows = rows[rows["valid"] & (rows["item_type"] == "likert")].dropna(subset=["value_number"])
    alike = 0
    for (_, key, version), form in rows.groupby(
        ["submission_id", "instrument", "instrument_version"]
    ):
        ratings = form["value_number"].to_numpy(dtype=np.float64)
        one_sided = (str(key), int(str(version))) in tables.one_sided
        alike += bool(straight_lined(ratings, one_sided=one_sided))
    return None if alike <= limit else f"{alike} forms with identical ratings, declared {limit:g}"


_JUDGES: dict[str, Judge] = {
    "minimum_frame_rate_hz": _frame_rate,
    "minimum_share_of_frames": _share,
    "maximum_latency_error_ms": _latency,
    "minimum_active_time_s": _active,
    "maximum_straight_lined_forms": _straight,
}


def _quality(tables: Tables, session_id: str) -> pd.DataFrame:
    rows = _of(tables.quality, session_id)
    return rows[
        (rows["stream"] == "actual") & rows["phase_kind"].isin(COUNTED_KINDS) & rows["valid"]
    ]


def _of(frame: pd.DataFrame, session_id: str) -> pd.DataFrame:
    return frame[frame["session_id"] == session_id]
