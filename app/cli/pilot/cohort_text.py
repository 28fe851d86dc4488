"""Print what a simulated cohort says of a study."""

import json
from collections.abc import Iterator

from app.cli.pilot.output import missing_line
from app.features.results.pilot.simulation import (
    PUBLISHED,
    CohortReport,
    failures_of,
    paragraphs,
    reach_sentence,
    reaching_lines,
    report_data,
    without_task,
    without_task_words,
)


def report_json(report: CohortReport) -> str:
    """Return the report for scripts."""
    return json.dumps(report_data(report), indent=2)


def report_text(report: CohortReport) -> str:
    """Describe the report."""
    return "\n".join(_report_lines(report))


def _report_lines(report: CohortReport) -> Iterator[str]:
    yield from _head(report)
    yield ""
    yield from _phases(report)
    if report.changes:
        yield ""
        yield from _changes(report)
    yield ""
    yield from _found(report)
    yield from _texts(report)


def _head(report: CohortReport) -> Iterator[str]:
    cohort = report.cohort
    header = cohort.header
    state = "SIMULATED, UNFINISHED" if cohort.unfinished else "SIMULATED"
    yield (
        f"{state}: {len(cohort.visits)} of {header['participants']} people in "
        f"{header['study']}, {header['avatar']}, seed {header['seed']}"
    )
    if cohort.unfinished:
        yield missing_line(cohort.unfinished, "people", cohort.missing)
    yield f"sha256 {cohort.sha256}; visits that did not come to their end: {failures_of(cohort)}"
    if cohort.real_time_factor is not None:
        yield f"{cohort.real_time_factor:.1f} s of visits for each second of processor time"
    if recorded := header.get("reaching"):
        yield from reaching_lines(recorded, cohort.visits)
    for visit in cohort.visits:
        if visit.failure is not None:
            yield f"  person {visit.number}: {visit.failure}"


def _phases(report: CohortReport) -> Iterator[str]:
    yield (
        "limb  latency  people  tasks (SD)    of lowest  sides  red, s  early  walks back, s  none"
    )
    for one in report.cells:
        share = "-" if one.share_of_lowest is None else f"{100 * one.share_of_lowest:.0f} %"
        yield (
            f"{one.limb:4} {one.latency_ms:5.0f} ms {one.people:7d}  {one.completions:5.2f} "
            f"({one.completions_sd:4.2f}) {share:>11} {one.side_contacts:6.1f} "
            f"{one.contact_time_s:7.1f} {one.out_of_order:6.2f} {one.walk_back_s:14.1f} "
            f"{100 * one.at_floor:4.0f} %"
        )
    shares = ", ".join(f"{share:g} % at {ms:g} ms" for ms, share in PUBLISHED.items())
    yield f"Published, end to end (Waltemate et al. 2016, another task): {shares}."


def _changes(report: CohortReport) -> Iterator[str]:
    yield "Paired change from the lowest to the highest latency, 95 % t interval:"
    for change in report.changes:
        yield (
            f"  {change.limb} {change.measure}: {change.mean:+.2f} "
            f"[{change.low:+.2f}, {change.high:+.2f}], n = {change.people}"
        )


def _texts(report: CohortReport) -> Iterator[str]:
    if report.cohort.unfinished:
        yield ""
        yield "The texts for the ethics form and the preregistration come with a finished cohort."
    for text in paragraphs(report).values():
        yield from ("", text)


def _found(report: CohortReport) -> Iterator[str]:
    """Yield what the check found, what it leaves out, and where people completed nothing."""
    yield reach_sentence(report.reached)
    yield "  The check has a slow person who never misses do the first task of a limb. It does"
    yield "  not say whether people complete tasks."
    for found in report.findings:
        yield f"  {found.path}: {found.message}"
    if idle := without_task(report.cells):
        many = "FOUND: many" if any(one.is_many for one in idle) else "Some"
        yield f"{many} completed no task: {without_task_words(idle)}."
