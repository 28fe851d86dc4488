"""Compute the primary test exactly as declared, with the functions of the test registry."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from sqlalchemy.orm import Session

from app.features.results.analysis.tables import Kind, scores_table
from app.features.results.preregistration.exclusions import Tables
from app.features.results.preregistration.schemas import PrimaryResult
from app.protocol import (
    Preregistration,
    PrimaryTest,
    StudyProtocol,
    compile_plan,
    sequences,
)
from app.science.statistics import FloatArray

_COLUMNS = {"contact_time": "side_red_s", "completions": "completions"}


@dataclass(frozen=True, eq=False)
class Values:
    """The values of the complete participants x conditions, and who lacks a value (`lacking`).

    `levels`: the keys of the conditions. `labels`: what the study calls them, by key.
    """

    values: FloatArray
    levels: tuple[str, ...]
    labels: Mapping[str, str]
    people: tuple[str, ...]
    lacking: tuple[str, ...]


def values_of(
    db: Session, tables: Tables, protocol: StudyProtocol, kind: Kind, session_ids: set[str]
) -> Values:
    """Return the declared measure of these sessions, by ascending added latency."""
    declared = protocol.preregistration
    assert declared is not None  # noqa: S101 - asked only where there is one
    rows = _rows(db, tables, declared.primary, protocol.key, kind)
    rows = rows[rows["session_id"].isin(session_ids)].dropna(subset=["value"])
    cells = rows.groupby(["participant_code", "limb", "condition"])["value"].mean().reset_index()
    # Those of the study, not those of the data: who skipped a limb lacks a value.
    declared_limbs = _limbs_of(protocol, declared.primary)
    n_limbs = max(1, len(declared_limbs))
    tasks = cells.groupby(["participant_code", "condition"])["value"].agg(["mean", "count"])
    whole = tasks[tasks["count"] == n_limbs]["mean"].reset_index()
    keys = [one.key for one in sorted(protocol.conditions, key=lambda one: one.latency_ms)]
    wide = whole.pivot(index="participant_code", columns="condition", values="mean")
    codes = sorted(
        tables.sessions[tables.sessions["session_id"].isin(session_ids)]["participant_code"]
    )
    wide = wide.reindex(index=list(dict.fromkeys(codes)), columns=keys).astype("float64")
    complete = wide.dropna()
    lacking = [str(code) for code in wide.index if code not in complete.index]
    return Values(
        values=complete.to_numpy(dtype=np.float64),
        levels=tuple(keys),
        labels=_labels(protocol),
        people=tuple(complete.index),
        lacking=tuple(lacking),
    )


def _limbs_of(protocol: StudyProtocol, primary: PrimaryTest) -> set[str]:
    """Return the limbs whose values the measure averages in each condition."""
    plan = compile_plan(protocol, sequences(protocol)[0])
    asked = {
        str(step.limb)
        for step in plan
        if step.block is not None
        and step.limb is not None
        and (step.instrument if primary.measure == "score" else None) == primary.instrument
    }
    return asked if primary.limb == "both" else asked & {str(primary.limb)}


def _labels(protocol: StudyProtocol) -> dict[str, str]:
    """Return the English names of the conditions; their keys if two have the same name."""
    language = "en" if "en" in protocol.languages else protocol.languages[0]
    labels = {one.key: one.label[language] for one in protocol.conditions}
    return labels if len(set(labels.values())) == len(labels) else {key: key for key in labels}


def make_test(declared: Preregistration, found: Values) -> PrimaryResult:
    """Compute the declared test; raise StatisticsError if the data do not allow it."""
    outcome = declared.outcome_of(found.values, found.levels, found.labels)
    return PrimaryResult(
        n=outcome.n,
        sentence=outcome.sentence,
        holds=declared.is_met_by(outcome),
        columns=list(outcome.columns),
        rows=[list(row) for row in outcome.rows],
        method=outcome.method,
    )


def _rows(
    db: Session, tables: Tables, primary: PrimaryTest, study_key: str, kind: Kind
) -> pd.DataFrame:
    if primary.measure == "score":
        rows = scores_table(db, study_key, kind)
        own = (rows["instrument"] == primary.instrument) & (rows["score"] == primary.score)
        rows = rows[own & rows["valid"] & rows["limb"].notna()]
    else:
        column = _COLUMNS[primary.measure]
        rows = tables.tasks.rename(columns={column: "value"}).astype({"value": "float64"})
    return rows if primary.limb == "both" else rows[rows["limb"] == primary.limb]
