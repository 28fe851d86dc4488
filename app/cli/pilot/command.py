"""Define `pilot STUDY`, `power`, `merge` and `check`: parse options, run, print the results."""

import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer
import typer.core

from app.cli.errors import INCOMPLETE, reported
from app.cli.progress import Activity


class _StudyOrCommand(typer.core.TyperGroup):
    """A group in which a first word that names no command is the study of the command `cohort`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Put the command in front of a study; `ctx` is of the Click that Typer brings along."""
        if args and not args[0].startswith("-") and args[0] not in self.commands:
            args = ["cohort", *args]
        return super().parse_args(ctx, args)


pilot = typer.Typer(
    cls=_StudyOrCommand,
    help="Simulate a study before anybody takes part; all of it is marked simulated. "
    "`pilot STUDY` simulates people in it, as `pilot cohort STUDY` does.",
    subcommand_metavar="STUDY | COMMAND [ARGS]...",
    no_args_is_help=True,
)
_Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]


@pilot.command()
def cohort(
    study: Annotated[str, typer.Argument(help="Study file, or the name of a shipped one.")],
    participants: Annotated[int, typer.Option(help="How many people are simulated.")] = 12,
    assumptions: Annotated[
        Path | None, typer.Option(help="File of assumptions; else the product's for the study.")
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of all random draws.")] = 1,
    workers: Annotated[int, typer.Option(help="Processes.")] = 1,
    shard: Annotated[
        str | None, typer.Option(help="Simulate one part of several only, as in 2/3.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Record every visit in this file, and continue it.")
    ] = None,
    avatar: Annotated[
        str | None,
        typer.Option(
            help="physics, physics_without_fingers or delayed_copy, each faster than the one before"
            "; else as the study has it."
        ),
    ] = None,
    reaching: Annotated[
        Path | None,
        typer.Option(help="File that `reach fit` wrote: hands then move as recorded ones did."),
    ] = None,
    as_json: _Json = False,
) -> None:
    """Simulate whole visits: reach, completions, contacts, length, storage and power."""
    from app.cli.pilot.cohort_text import report_json, report_text
    from app.cli.pilot.inputs import (
        read_assumptions,
        read_avatar,
        read_hands,
        read_shard,
        read_study,
    )
    from app.cli.pilot.run import CohortOptions, carry_out_cohort, full_report
    from app.features.results.pilot.simulation import CohortOrder, Sharing

    with reported(ValueError, OSError), Activity(f"simulating {study}: reading it") as now:
        options = CohortOptions(
            study=study,
            order=CohortOrder(participants, seed, read_avatar(avatar), read_hands(reaching)),
            sharing=Sharing(workers, read_shard(shard)),
            out=out,
        )
        if assumptions is not None:
            # A mistake in this file is reported before the work, not after it.
            read_assumptions(assumptions, read_study(study))
        file, people = carry_out_cohort(options, now.now)
        report = full_report(file, people, assumptions, workers, now.now)
    print(report_json(report) if as_json else report_text(report))


@pilot.command()
def power(
    study: Annotated[str, typer.Argument(help="Study file, or the name of a shipped one.")],
    participants: Annotated[
        list[str] | None,
        typer.Option(help="How many start: 12, or 8,12,16; else around the planned number."),
    ] = None,
    assumptions: Annotated[
        Path | None, typer.Option(help="File of assumptions; else the product's for the study.")
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of all random draws.")] = 1,
    sets: Annotated[
        int, typer.Option(help="Data sets for each number, with the effect and without.")
    ] = 1000,
    target: Annotated[float, typer.Option(help="The power that is wanted.")] = 0.8,
    workers: Annotated[int, typer.Option(help="Processes.")] = 1,
    shard: Annotated[
        str | None, typer.Option(help="Compute one part of several only, as in 2/3.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(help="Record every finished part in this file, and continue it."),
    ] = None,
    as_json: _Json = False,
) -> None:
    """Simulate data sets, and count how often the preregistered test is significant."""
    from app.cli.pilot import output as texts
    from app.cli.pilot.inputs import read_counts, read_shard
    from app.cli.pilot.run import PowerOptions, carry_out_power
    from app.features.results.pilot.simulation import PowerOrder, Sharing, curve_json

    with reported(ValueError, OSError), Activity(f"simulating {study}: reading it") as now:
        options = PowerOptions(
            study=study,
            assumptions=assumptions,
            order=PowerOrder(read_counts(participants or []), seed, sets, target),
            sharing=Sharing(workers, read_shard(shard)),
            out=out,
        )
        curve = carry_out_power(options, now.now)
    print(curve_json(curve) if as_json else texts.curve_text(curve))
    own = os.times()
    used_s = own.user + own.system + own.children_user + own.children_system
    print(f"reembody: {used_s:.0f} s of processor time", file=sys.stderr)


@pilot.command()
def check(
    study: Annotated[str, typer.Argument(help="Study file, or the name of a shipped one.")],
    scene: Annotated[
        str | None,
        typer.Option(
            help="Scene of the study's walks, to look for paths: a file or a shipped key."
        ),
    ] = None,
    as_json: _Json = False,
) -> None:
    """Find what would break a study; the exit code is 1 if anything would."""
    with reported(ValueError, OSError), Activity(f"checking {study}: reading it") as now:
        from app.cli.pilot.check import carry_out_check, check_json, check_text

        checked = carry_out_check(study, scene, now.now)
    print(json.dumps(check_json(checked), indent=2) if as_json else check_text(checked))
    if checked.findings:
        raise typer.Exit(INCOMPLETE)


@pilot.command()
def assumptions(
    study: Annotated[str, typer.Argument(help="Study file, or the name of a shipped one.")],
) -> None:
    """Print a file of assumptions to copy: the product's for the study, or an example for it."""
    from app.cli.pilot.inputs import assumptions_to_copy, read_study

    with reported(ValueError, OSError):
        text = assumptions_to_copy(read_study(study))
    print(text, end="")


@pilot.command()
def merge(
    records: Annotated[list[Path], typer.Argument(help="Files that --out wrote.")],
    study: Annotated[
        str | None, typer.Option(help="The cohort's study, if it is not a shipped one.")
    ] = None,
    assumptions: Annotated[
        Path | None, typer.Option(help="The cohort's assumptions; else the product's.")
    ] = None,
    as_json: _Json = False,
) -> None:
    """Put the parts of a simulation together; the exit code is 1 if some are missing."""
    from app.cli.pilot import output as texts
    from app.cli.pilot.cohort_text import report_json, report_text
    from app.cli.pilot.run import full_report, study_of
    from app.features.results.pilot.simulation import (
        curve_json,
        is_cohort,
        merged_cohort,
        merged_curve,
    )

    with reported(ValueError, OSError), Activity("putting records together") as now:
        if is_cohort(records[0]):
            people = merged_cohort(records)
            file = study_of(people, study)
            report = full_report(file, people, assumptions, 1, now.now)
            print(report_json(report) if as_json else report_text(report))
            _require_finished(people.unfinished, "people", people.missing)
            return
        curve = merged_curve(records)
    print(curve_json(curve) if as_json else texts.curve_text(curve))
    _require_finished(curve.unfinished, "parts", curve.missing)


def _require_finished(unfinished: int, what: str, shards: Sequence[str]) -> None:
    """End with the exit code of incomplete work if something is missing, and say what."""
    from app.cli.pilot.output import missing_line

    if unfinished:
        print(f"reembody: {missing_line(unfinished, what, shards)}", file=sys.stderr)
        raise typer.Exit(INCOMPLETE)
