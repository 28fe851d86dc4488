"""The declared test, made as declared: the same functions as everywhere, nothing chosen here."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
import pandas as pd
from sqlalchemy.orm import Session

from app.features.results.analysis.tables import Kind, scores_table
from app.features.results.preregistration.excluding import Tables
from app.features.results.preregistration.schemas import PrimaryResult
from app.protocol import Preregistration, PrimaryTest, StudyProtocol
from app.science.statistics import (
    FloatArray,
    against_reference,
    friedman,
    page_trend,
    rm_anova,
)

_COLUMNS = {"contact_time": "side_red_s", "completions": "completions"}
_SIDES: dict[str, Literal["two-sided", "greater", "less"]] = {
    "two_sided": "two-sided",
    "rises": "greater",
    "falls": "less",
}


@dataclass(frozen=True, eq=False)
class Values:
    """Participants x conditions, complete; who lacks which value is named."""

    values: FloatArray
    levels: tuple[str, ...]
    people: tuple[str, ...]
    lacking: tuple[str, ...]


def values_of(
    db: Session, tables: Tables, protocol: StudyProtocol, kind: Kind, kept: set[str]
) -> Values:
    """The measure of the sessions that are kept, by added latency from lowest to highest."""
    declared = protocol.preregistration
    assert declared is not None  # noqa: S101 - asked only where there is one
    rows = _rows(db, tables, declared.primary, protocol.key, kind)
    rows = rows[rows["session_id"].isin(kept)].dropna(subset=["value"])
    cells = rows.groupby(["participant_code", "limb", "condition"])["value"].mean().reset_index()
    n_limbs = max(1, cells["limb"].nunique())
    tasks = cells.groupby(["participant_code", "condition"])["value"].agg(["mean", "count"])
    whole = tasks[tasks["count"] == n_limbs]["mean"].reset_index()
    keys = [one.key for one in sorted(protocol.conditions, key=lambda one: one.latency_ms)]
    wide = whole.pivot(index="participant_code", columns="condition", values="mean")
    codes = sorted(tables.sessions[tables.sessions["session_id"].isin(kept)]["participant_code"])
    wide = wide.reindex(index=list(dict.fromkeys(codes)), columns=keys).astype("float64")
    complete = wide.dropna()
    lacking = [str(code) for code in wide.index if code not in complete.index]
    return Values(
        complete.to_numpy(dtype=np.float64), tuple(keys), tuple(complete.index), tuple(lacking)
    )


def make_test(declared: Preregistration, found: Values) -> PrimaryResult:
    """Make the test; raises StatisticsError where the data do not allow it."""
    makers = {
        "friedman": _friedman,
        "page_trend": _page,
        "rm_anova": _anova,
        "against_reference": _reference,
    }
    return makers[declared.primary.test](declared, found)


def _number(value: float) -> str:
    """Two decimals, and a minus as print has it."""
    return f"{value:.2f}".replace("-", "\u2212")


def _friedman(declared: Preregistration, found: Values) -> PrimaryResult:
    one = friedman(found.values)
    return PrimaryResult(
        n=one.n,
        sentence=f"χ²({one.df}) = {one.statistic:.2f}, {_p(one.p)}, W = {one.kendall_w:.3f}, "
        f"n = {one.n}",
        holds=one.p <= declared.alpha,
        columns=["condition", "mean rank"],
        rows=[
            [level, _number(rank)] for level, rank in zip(found.levels, one.mean_ranks, strict=True)
        ],
        method=f"Friedman's test, {one.method}. {one.note}".strip(),
    )


def _page(declared: Preregistration, found: Values) -> PrimaryResult:
    falls = declared.primary.direction == "falls"
    # The p given ties is of a rise; a fall is a rise of the reversed order.
    one = page_trend(found.values[:, ::-1] if falls else found.values)
    p = one.p_given_ties if math.isfinite(one.p_given_ties) else one.p
    return PrimaryResult(
        n=one.n,
        sentence=f"L = {one.statistic:g}, {_p(p)}, one-sided ({declared.primary.direction}), "
        f"n = {one.n}",
        holds=p <= declared.alpha,
        columns=["condition", "median"],
        rows=[
            [level, _number(value)]
            for level, value in zip(found.levels, np.median(found.values, axis=0), strict=True)
        ],
        method="Page's trend test; p by permutation of these ranks, ties included."
        if math.isfinite(one.p_given_ties)
        else "Page's trend test; asymptotic p.",
    )


def _anova(declared: Preregistration, found: Values) -> PrimaryResult:
    whole = rm_anova(found.values, ("latency",))
    effect = whole.effects[0]
    return PrimaryResult(
        n=whole.n,
        sentence=f"F({effect.df * effect.epsilon:.2f}, {effect.df_error * effect.epsilon:.2f}) = "
        f"{effect.f:.2f}, {_p(effect.p_gg)}, generalised η² = "
        f"{effect.generalised_eta_squared:.3f}, n = {whole.n}",
        holds=effect.p_gg <= declared.alpha,
        columns=["condition", "mean"],
        rows=[
            [level, _number(value)]
            for level, value in zip(found.levels, found.values.mean(axis=0), strict=True)
        ],
        method="Analysis of variance with repeated measures, Greenhouse-Geisser.",
    )


def _reference(declared: Preregistration, found: Values) -> PrimaryResult:
    primary = declared.primary
    alternative = _SIDES[primary.direction]
    one = against_reference(
        found.values,
        found.levels,
        primary.reference or found.levels[0],
        alternative=alternative,
        alpha=declared.alpha,
    )
    adjusted = primary.correction == "holm"
    p_values = [pair.p_holm if adjusted else pair.test.p for pair in one.comparisons]
    lowest = min(p_values)
    return PrimaryResult(
        n=len(found.values),
        sentence=f"smallest {_p(lowest)} of {len(p_values)} comparisons with {one.reference}, "
        f"{alternative}, n = {len(found.values)}",
        holds=lowest <= declared.alpha,
        columns=["comparison", "n", "median difference", "r (rank-biserial)", "p", "p declared"],
        rows=[
            [
                f"{pair.a} – {pair.b}",
                str(pair.test.n),
                _number(pair.median_difference),
                _number(pair.test.rank_biserial),
                f"{pair.test.p:.3f}",
                f"{p:.3f}",
            ]
            for pair, p in zip(one.comparisons, p_values, strict=True)
        ],
        method="Exact Wilcoxon signed-rank tests"
        + (", p adjusted by Holm's rule." if adjusted else ", p not adjusted."),
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


def _p(p: float) -> str:
    return "p < .001" if p < 0.001 else f"p = {p:.3f}".replace("0.", ".", 1)
