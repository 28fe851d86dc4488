"""Exploratory relations between measures, and between scores and demographics."""

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from app.features.results.analysis.demographics import relations_of, variables_of
from app.features.results.analysis.figures.contacts import mean_times, part_side_times
from app.features.results.analysis.figures.fingers import PALM, in_some_phases, mark_fingers
from app.features.results.analysis.material import Material
from app.features.results.analysis.questions.measures import Measure, completed
from app.features.results.analysis.questions.words import TestReport, bounded, p_cell
from app.protocol import COUNTED_KINDS
from app.science.skeleton import FINGER_PARTS, FINGERS, finger_of
from app.science.statistics import (
    Spearman,
    StatisticsError,
    contact_shares,
    holm,
    spearman,
)
from app.science.tasks import Side

OBJECTIVE = ("contact_time", "completions", "joint_error")
_GROUPS = {
    "Hand": "hand",
    "LowerArm": "arm",
    "UpperArm": "arm",
    "Shoulder": "arm",
    "Toes": "toes",
    "Foot": "foot",
    "LowerLeg": "leg",
    "UpperLeg": "leg",
}
_ORDER = ("finger", "hand", "arm", "toes", "foot", "leg", "trunk and head")
_SIDES = tuple(str(side) for side in Side)


def group_of(part: str) -> str:
    """Return the group of a body part: finger, hand, arm, toes, foot, leg, or trunk and head."""
    if finger_of(part) is not None:
        return "finger"
    return next((group for word, group in _GROUPS.items() if part.endswith(word)), _ORDER[-1])


def contact_share_results(material: Material) -> Iterator[TestReport]:
    """Yield, for each limb, the share of contact time by group of body parts at each latency.

    Where fingers were recorded, they are a part of their own. If that is so in some of a limb's
    phases only, it yields two reports, one of the phases with fingers and one of the others: a hand
    without its fingers and a hand whose fingers are not known apart are not averaged.
    """
    tasks, sides = _tasks_and_sides(material)
    if sides.empty:
        return
    times = part_side_times(sides).rename(columns={"body_part": "what"})
    times = times.groupby(["session_id", "phase_id", "what"])["time_s"].sum().reset_index()
    for limb, own in tasks.dropna(subset=["limb"]).groupby("limb", sort=False):
        known: tuple[bool | None, ...] = (False, True) if in_some_phases(own) else (None,)
        for with_fingers in known:
            phases = own if with_fingers is None else own[own["fingers"] == with_fingers]
            rows = []
            for latency, cell in phases.groupby("latency_ms"):
                rows += _share_rows(f"{latency:g}", cell, times)
            if rows:
                yield _shares_report(str(limb), rows, with_fingers=with_fingers)


def contact_finger_results(material: Material) -> Iterator[TestReport]:
    """Yield, for each hand task, the contact time of every finger with every side.

    Only phases in which fingers were recorded count; without such contacts nothing is yielded.
    """
    tasks, sides = _tasks_and_sides(material)
    tasks = tasks[tasks["fingers"]]
    sides = sides.merge(tasks[["session_id", "phase_id"]], on=["session_id", "phase_id"])
    fingers = sides[sides["body_part"].isin(FINGER_PARTS)]
    for limb, own in tasks.dropna(subset=["limb"]).groupby("limb", sort=False):
        used = fingers[fingers["limb"] == limb]
        if used.empty:
            continue
        named = used.assign(body_part=used["body_part"].map(finger_of))
        hand = sides[(sides["limb"] == limb) & sides["body_part"].str.endswith("Hand")]
        times = part_side_times(pd.concat((named, hand.assign(body_part=PALM))))
        yield _fingers_report(str(limb), own, times)


def _tasks_and_sides(material: Material) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return the valid tasks, marked where fingers were recorded, and contacts with sides."""
    tested = completed(material)
    phases, contacts = tested.counting(tested.phases), tested.counting(tested.contacts)
    tasks = phases[phases["phase_kind"].isin(COUNTED_KINDS)]
    marked = mark_fingers(tasks, tested.quality, contacts)
    return marked, contacts[contacts["surface_kind"] == "side"]


def _fingers_report(limb: str, tasks: pd.DataFrame, times: pd.DataFrame) -> TestReport:
    """Return mean seconds per phase by latency, finger and side, of both hands together."""
    shown = [side for side in _SIDES if side in set(times["side"])]
    parts = [part for part in (*FINGERS, PALM) if part in set(times["body_part"])]
    means = mean_times(tasks, times.assign(what=times["body_part"] + "/" + times["side"]))
    people = tasks.groupby("latency_ms")["participant_code"].nunique()
    at_latency = {f"{ms:g}": str(n) for ms, n in people.items()}
    rows = []
    for latency, mean_s in means.mean_s.iterrows():
        for part in parts:
            own_s = [float(mean_s.get(f"{part}/{side}", 0.0)) for side in shown]
            seconds = (f"{one_s:.2f}" for one_s in (*own_s, sum(own_s)))
            rows.append((f"{latency:g}", part.lower(), *seconds, at_latency[f"{latency:g}"]))
    n = int(tasks["participant_code"].nunique())
    return TestReport(
        key=f"contact_fingers_{limb}",
        title=f"{limb.capitalize()}: Which finger touched which side?",
        sentence=(
            "Mean seconds of contact per phase over participants, of both hands. Only phases in "
            "which fingers were recorded count, those without a contact as 0. "
            f"{n} participants."
        ),
        apa="",
        columns=(
            "latency (ms)",
            "finger",
            *(f"{side.replace('_', ' ')} (s)" for side in shown),
            "all sides (s)",
            "n",
        ),
        rows=rows,
        method=(
            "The time of a finger at a side is the union over its three parts. Fingers may touch "
            "at the same time, so their times must not be added up. The palm is the hand without "
            "its fingers."
        ),
        source="Karas 2020, section 7.1.3.",
    )


def _share_rows(latency: str, cell: pd.DataFrame, times: pd.DataFrame) -> list[tuple[str, ...]]:
    keys = ["session_id", "phase_id"]
    wide = times.pivot(index=keys, columns="what", values="time_s")
    own = cell[[*keys, "participant_code"]].merge(wide, on=keys, how="left").drop(columns=keys)
    each = own.fillna(0.0).groupby("participant_code").mean()
    each = each.loc[:, each.sum() > 0.0]
    if each.empty or not each.shape[1]:
        return []
    parts = sorted(each.columns, key=lambda part: _ORDER.index(group_of(str(part))))
    found = contact_shares(
        {str(part): each[part].to_numpy(dtype=np.float64) for part in parts},
        {str(part): group_of(str(part)) for part in parts},
    )
    means = np.nanmean(found.shares, axis=0)
    n = len(each) - found.n_without_contact
    return [
        (latency, group, f"{100.0 * share:.1f} %", str(n), str(found.n_without_contact))
        for group, share in zip(found.groups, means, strict=True)
    ]


_SHARES_OF = {
    None: ("", "", ""),
    False: (
        "",
        ", without fingers",
        " Only the phases in which fingers were not recorded: there the hand includes them.",
    ),
    True: (
        "_fingers",
        ", with fingers",
        " Only the phases in which fingers were recorded: there the hand is that without them.",
    ),
}
"""Whether only phases with or without fingers count: ending of key, title and method."""


def _shares_report(
    limb: str, rows: Sequence[tuple[str, ...]], *, with_fingers: bool | None
) -> TestReport:
    key, title, hands = _SHARES_OF[with_fingers]
    return TestReport(
        key=f"contact_shares{key}_{limb}",
        title=f"{limb.capitalize()}: Which part of the body was in contact{title}?",
        sentence=(
            "Each participant’s share of contact time, averaged over participants. Shares at one "
            "latency add up to 100 %."
        ),
        apa="",
        columns=("latency (ms)", "part", "mean share", "n", "without contact"),
        rows=rows,
        method=(
            "The times of body parts are summed and may overlap, so these are not shares of the "
            f"time a side was red. Participants without a contact have no share.{hands}"
        ),
        source="Karas 2020, chapter 7.",
    )


def subjective_objective(measures: Sequence[Measure]) -> Iterator[TestReport]:
    """Yield correlations of every score with contact time, completions and joint error.

    They are computed at each latency.
    """
    scores = [one for one in measures if not one.continuous]
    others = [one for one in measures if one.key in OBJECTIVE]
    correlations = [
        (score.title, other.title, latency, found)
        for score in scores
        for other in others
        for latency in score.latencies_ms
        if (found := _pair(score, other, latency)) is not None
    ]
    if not correlations:
        return
    rows = _correlation_rows(correlations)
    yield TestReport(
        key="subjective_objective",
        title="Questionnaire scores and measured behaviour",
        sentence=(
            f"{len(rows)} rank correlations, adjusted together. Among so many, some look striking "
            "by chance: a reason for a new study, not a result of this one."
        ),
        apa="",
        columns=(
            *("score", "measure", "latency (ms)", "n", "Spearman ρ", "95 % CI", "p", "p (Holm)"),
        ),
        rows=rows,
        method=(
            "One pair of values per participant: both measures averaged over the limbs at one "
            "latency. Correlations over repeated measures would count people several times."
        ),
        source="Spearman 1904; Bonett and Wright 2000, Psychometrika 65:23.",
        exploratory=True,
    )


def _correlation_rows(
    correlations: Sequence[tuple[str, str, float, Spearman]],
) -> list[tuple[str, ...]]:
    """Return a table row per correlation, with p adjusted over all of them together."""
    adjusted = holm([found.p for _, _, _, found in correlations])
    return [
        (
            score,
            other,
            f"{latency:g}",
            str(one.n),
            bounded(one.rho, 2),
            f"[{bounded(one.low, 2)}, {bounded(one.high, 2)}]",
            p_cell(one.p),
            p_cell(p),
        )
        for (score, other, latency, one), p in zip(correlations, adjusted, strict=True)
    ]


def _pair(score: Measure, other: Measure, latency: float) -> Spearman | None:
    both = [
        one.values[one.values["latency_ms"] == latency].groupby("participant_code")["value"].mean()
        for one in (score, other)
    ]
    joined = pd.concat(both, axis=1).to_numpy(dtype=np.float64)
    try:
        return spearman(joined[:, 0], joined[:, 1])
    except StatisticsError:
        return None


def demographics(material: Material, measures: Sequence[Measure]) -> Iterator[TestReport]:
    """Yield the relation of each score, averaged over all cells, to answers outside the blocks."""
    tested = completed(material)
    answers = tested.counting(tested.answers)
    for score in (one for one in measures if not one.continuous):
        means = score.values.groupby("participant_code")["value"].mean()
        variables = variables_of(answers, list(means.index), tested.instruments)
        if not variables:
            return
        rows = [
            (
                one.variable,
                "Spearman ρ" if one.kind == "number" else "ε² (Kruskal-Wallis)",
                str(one.n),
                bounded(one.effect, 2),
                p_cell(one.p) if not one.why_not else one.why_not,
                p_cell(one.p_holm) if not one.why_not else "",
            )
            for one in relations_of(means, variables)
        ]
        yield TestReport(
            key=f"demographics_{score.key}",
            title=f"{score.title} by demographics",
            sentence=f"{len(rows)} variables, adjusted together; n is small for each.",
            apa="",
            columns=("variable", "effect size", "n", "value", "p", "p (Holm)"),
            rows=rows,
            method="Means over all latencies and limbs. Exploratory, not a hypothesis test.",
            source="Spearman 1904; Kruskal and Wallis 1952, J. Am. Stat. Assoc. 47:583.",
            exploratory=True,
        )
