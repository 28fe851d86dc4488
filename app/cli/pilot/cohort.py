"""Run `reembody pilot STUDY` and put its shards together: the study's files, and the report."""

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from app.cli.errors import require_folder_of
from app.cli.pilot.inputs import (
    StudyFile,
    has_assumptions,
    is_shipped,
    read_assumptions,
    read_study,
    require_sharing,
)
from app.cli.pilot.output import told
from app.features.results.pilot.simulation import (
    PUBLISHED,
    Cohort,
    CohortOrder,
    CohortReport,
    PowerOrder,
    Sharing,
    check_study,
    failures_of,
    paragraphs,
    reach_sentence,
    report_data,
    report_on,
    simulate_cohort,
    simulate_power,
)

MOST_PARTICIPANTS: Final = 10_000


@dataclass(frozen=True)
class CohortOptions:
    """The options of `pilot STUDY`."""

    study: str
    order: CohortOrder
    sharing: Sharing
    out: Path | None


def carry_out_cohort(
    options: CohortOptions, now: Callable[[str], None]
) -> tuple[StudyFile, Cohort]:
    """Simulate a cohort; `now` is told how far it is.

    Raises ValueError if the input does not allow it, OSError if the record cannot be written.
    """
    _check(options)
    require_folder_of(options.out)
    file = read_study(options.study)
    people = simulate_cohort(
        file,
        options.order,
        told(file.study.protocol.key, now),
        record=options.out,
        sharing=options.sharing,
    )
    return file, people


def study_of(cohort: Cohort, given: str | None) -> StudyFile:
    """Read the study of a merged cohort; raises ValueError if it has changed since, OSError."""
    key = str(cohort.header["study"])
    if given is None and not is_shipped(key):
        raise ValueError(
            f"the cohort's study {key!r} is no shipped one: give its file with --study"
        )
    file = read_study(given or key)
    if file.study.content_hash != cohort.header["study_sha256"]:
        raise ValueError(
            f"{file.path} is not the study that was simulated (SHA-256 "
            f"{cohort.header['study_sha256']}): give that file with --study"
        )
    return file


def full_report(
    file: StudyFile,
    cohort: Cohort,
    assumptions: Path | None,
    workers: int,
    now: Callable[[str], None],
) -> CohortReport:
    """Check the study, simulate its power if anything is assumed of answers, and report.

    Raises the errors of `simulate_power`.
    """
    tell = told(file.study.protocol.key, now)
    checked = check_study(file, tell)
    curve = None
    if has_assumptions(assumptions, file):
        loaded = read_assumptions(assumptions, file)
        order = PowerOrder(seed=int(cohort.header["seed"]))
        curve = simulate_power(file, loaded, order, tell, sharing=Sharing(workers))
    return report_on(file, cohort, checked, curve)


def report_json(report: CohortReport) -> str:
    """Return the report for scripts."""
    return json.dumps(report_data(report), indent=2)


def report_text(report: CohortReport) -> str:
    """Describe the report."""
    return "\n".join(_lines(report))


def _lines(report: CohortReport) -> Iterator[str]:
    cohort = report.cohort
    header = cohort.header
    yield (
        f"SIMULATED: {len(cohort.visits)} of {header['participants']} people in "
        f"{header['study']}, {header['avatar']}, seed {header['seed']}"
    )
    yield f"sha256 {cohort.sha256}; visits that could not be completed: {failures_of(cohort)}"
    if cohort.real_time_factor is not None:
        yield f"{cohort.real_time_factor:.1f} s of visits for each second of processor time"
    for visit in cohort.visits:
        if visit.failure is not None:
            yield f"  person {visit.number}: {visit.failure}"
    yield ""
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
    if report.changes:
        yield ""
        yield "Paired change from the lowest to the highest latency, 95 % t interval:"
    for change in report.changes:
        yield (
            f"  {change.limb} {change.measure}: {change.mean:+.2f} "
            f"[{change.low:+.2f}, {change.high:+.2f}], n = {change.people}"
        )
    yield ""
    yield reach_sentence(report)
    for found in report.findings:
        yield f"  {found.path}: {found.message}"
    for text in paragraphs(report).values():
        yield from ("", text)


def _check(options: CohortOptions) -> None:
    order, sharing = options.order, options.sharing
    if not 1 <= order.participants <= MOST_PARTICIPANTS:
        raise ValueError(f"--participants {order.participants}: 1 to {MOST_PARTICIPANTS} are valid")
    require_sharing(sharing, options.out)
    if order.seed < 0:
        raise ValueError(f"--seed {order.seed}: give 0 or a greater number")
