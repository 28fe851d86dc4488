"""Run `reembody pilot STUDY` and `pilot power`: the study's files, and the options."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from app.cli.outputs import require_folder_of
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
    Cohort,
    CohortOrder,
    CohortReport,
    Curve,
    PowerOrder,
    Sharing,
    check_study,
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
    unknown = f"the cohort's study {key!r} is no shipped one: give its file with --study"
    if given is None and not is_shipped(key):
        raise ValueError(unknown)
    file = read_study(given or key)
    if given is None and file.study.content_hash != cohort.header["study_sha256"]:
        # Another study of the same key, or an earlier version of the shipped one.
        raise ValueError(f"{unknown} (SHA-256 {cohort.header['study_sha256']})")
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


@dataclass(frozen=True)
class PowerOptions:
    """The options of `pilot power`."""

    study: str
    assumptions: Path | None
    order: PowerOrder
    sharing: Sharing
    out: Path | None


def carry_out_power(options: PowerOptions, now: Callable[[str], None]) -> Curve:
    """Compute a power curve; `now` is told what is being done.

    Raises ValueError if the input does not allow it, OSError if the record cannot be written.
    """
    require_sharing(options.sharing, options.out)
    if not 0.0 < options.order.target < 1.0:
        raise ValueError(
            f"--target {options.order.target:g}: give a power between 0 and 1, as in 0.8"
        )
    require_folder_of(options.out)
    file = read_study(options.study)
    return simulate_power(
        file,
        read_assumptions(options.assumptions, file),
        options.order,
        told(file.study.protocol.key, now),
        record=options.out,
        sharing=options.sharing,
    )


def _check(options: CohortOptions) -> None:
    order, sharing = options.order, options.sharing
    if not 1 <= order.participants <= MOST_PARTICIPANTS:
        raise ValueError(f"--participants {order.participants}: 1 to {MOST_PARTICIPANTS} are valid")
    require_sharing(sharing, options.out)
    if order.seed < 0:
        raise ValueError(f"--seed {order.seed}: give 0 or a greater number")
