"""Print what a simulated cohort says of a study."""

import json
from collections.abc import Iterator

from app.cli.pilot.output import assumption_lines, missing_line
from app.features.results.pilot.simulation import (
    PUBLISHED,
    CohortReport,
    failures_of,
    paragraphs,
    reach_sentence,
    reaching_lines,
    report_data,
    rounded,
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
    yield ""
    yield from _length(report)
    yield from _texts(report)
    if assumed := report_data(report)["assumptions"]:
        yield ""
        yield from assumption_lines(assumed)


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
        "limb  latency  people  tasks (SD)    of lowest  sides touched  red (s)  early touches"
        "  walks back (s)  no task"
    )
    for one in report.cells:
        share = "-" if one.share_of_lowest is None else f"{rounded(100 * one.share_of_lowest, 0)} %"
        yield (
            f"{one.limb:4} {one.latency_ms:5.0f} ms {one.people:7d}  "
            f"{rounded(one.completions, 2):>5} ({rounded(one.completions_sd, 2):>4}) {share:>11} "
            f"{rounded(one.side_contacts, 1):>14} {rounded(one.contact_time_s, 1):>8} "
            f"{rounded(one.out_of_order, 2):>14} {rounded(one.walk_back_s, 1):>15} "
            f"{rounded(100 * one.at_floor, 0):>6} %"
        )
    yield "All are means per person and phase. Red time is summed over the sides that are red, so"
    yield "it can be longer than the phase."
    shares = ", ".join(f"{share:g} % at {ms:g} ms" for ms, share in PUBLISHED.items())
    yield f"Published, end to end (Waltemate et al. 2016, another task): {shares}."
    contacts = report.cohort.header["avatar"] != "delayed_copy"
    yield (
        "Known limitations: simulated people do not get used to a latency within a phase"
        + (", and with this avatar they are" if contacts else ".")
    )
    yield (
        "caught at solid edges. " if contacts else ""
    ) + "Do not rely on completions at long latencies."


_MEASURES = {
    "completions": "tasks",
    "side_contacts": "sides touched",
    "contact_time_s": "red (s)",
    "out_of_order": "early touches",
}


def _changes(report: CohortReport) -> Iterator[str]:
    yield "Paired change from the lowest to the highest latency, 95 % t interval:"
    for change in report.changes:
        interval = (
            f"[{_signed(change.low)}, {_signed(change.high)}]"
            if change.low < change.high
            else "no interval, everybody changed alike"
        )
        yield (
            f"  {change.limb} {_MEASURES[change.measure]}: {_signed(change.mean)} {interval},"
            f" n = {change.people}"
        )


def _signed(value: float) -> str:
    text = rounded(value, 2)
    return text if text.startswith("-") else f"+{text}"


def _length(report: CohortReport) -> Iterator[str]:
    yield (
        f"Length of a visit: about {rounded(report.session_min, 0)} min, not simulated as a whole:"
        f" {rounded(report.planned_min, 0)} min are set by"
    )
    yield (
        f"the protocol, {rounded(report.walk_back_min, 1)} min are simulated walks back, and the"
        " rest is an estimate of forms, texts and steps by"
    )
    yield "hand. Breaks and putting on the equipment are not included."


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
