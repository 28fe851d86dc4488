"""Define all commands of `reembody`, and implement the small ones."""

import json
import os
import sys
from pathlib import Path
from typing import Annotated

import typer

from app import __version__
from app.cli.analyse.command import analyse
from app.cli.avatar.command import avatar
from app.cli.crossing.command import crossing
from app.cli.errors import INCOMPLETE, reported, warn
from app.cli.figure.command import figure
from app.cli.pilot.command import pilot
from app.cli.progress import Activity
from app.cli.reach.command import reach
from app.cli.retarget.command import retarget
from app.cli.serve.command import serve, tls
from app.cli.tracking.command import tracking
from app.cli.tune.command import tune
from app.cli.walk.command import walk

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
app.add_typer(tls, name="tls")
app.add_typer(walk, name="walk")
app.add_typer(reach, name="reach")
app.add_typer(avatar, name="avatar")
app.add_typer(pilot, name="pilot")
app.add_typer(tracking, name="tracking")
app.add_typer(crossing, name="crossing")
app.command()(retarget)
app.command()(figure)
app.command()(tune)
app.command()(analyse)
app.command()(serve)


def _print_version(requested: bool) -> None:
    if requested:
        print(f"reembody {__version__}")
        raise typer.Exit


@app.callback()
def reembody(
    _version: Annotated[
        bool, typer.Option("--version", callback=_print_version, help="Print the version.")
    ] = False,
) -> None:
    """Run, watch and analyse VR re-embodiment studies."""
    # Files that a command writes may contain personal data: only the user who runs it may read
    # them.
    os.umask(0o077)


@app.command()
def score(
    answers: Annotated[Path, typer.Argument(help="CSV with item columns; others are ids.")],
    instrument: Annotated[str, typer.Option(help="Key of the instrument, or its file.")],
    missing: Annotated[
        list[str] | None,
        typer.Option(help="A code of a missing answer besides empty and NA, as -99; repeatable."),
    ] = None,
) -> None:
    """Score a table of answers; write ids and scores as CSV to standard output."""
    from app.cli.scoring import score_file

    with reported(ValueError, OSError):
        scored = score_file(answers, instrument, missing or ())
    sys.stdout.write(scored.text)
    for note in scored.notes:
        warn(note)


@app.command()
def instrument(
    answers: Annotated[Path, typer.Argument(help="Table of answers of another tool, as CSV.")],
    key: Annotated[str | None, typer.Option(help="Key of the offered instrument.")] = None,
    title: Annotated[str | None, typer.Option(help="Its title.")] = None,
    minimum: Annotated[int | None, typer.Option(help="Lowest answer of its scale.")] = None,
    maximum: Annotated[int | None, typer.Option(help="Highest answer of its scale.")] = None,
    language: Annotated[str, typer.Option(help="Language of its items.")] = "en",
    out: Annotated[Path | None, typer.Option(help="Write the instrument's file.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Say what a table's columns are, and offer an instrument for answers that none asks."""
    from app.cli.scoring import OfferOrder, offer_instrument, offer_text

    order = OfferOrder(answers, key, title, minimum, maximum, language, out)
    with reported(ValueError, OSError, with_valid=True):
        found = offer_instrument(order)
    print(json.dumps(found) if as_json else offer_text(found))


@app.command()
def export(
    study: Annotated[str, typer.Option(help="Key of the study.")],
    to: Annotated[Path, typer.Option(help="Folder to write; an earlier export is replaced.")],
    kind: Annotated[
        str | None, typer.Option(help="people, simulated, test or all; people if there are any.")
    ] = None,
) -> None:
    """Write a study as tidy CSV with a codebook."""
    with reported(ValueError, OSError), Activity(f"exporting {study}: opening the database") as now:
        from app.cli.record import export_to_folder

        done = export_to_folder(study, to, now, kind)
    print(done)


@app.command()
def verify(
    session: Annotated[str | None, typer.Option(help="Id of a session.")] = None,
    head: Annotated[
        list[str] | None,
        typer.Option(
            help="Head of the audit trail, SEQ:HASH, as a backup or an export printed it; may be "
            "given more than once."
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the findings as JSON.")] = False,
) -> None:
    """Verify that a session, or the audit trail and every version, are unaltered.

    Versions are those of avatars, studies and instruments. The exit code is 1 if anything was
    altered.
    """
    with reported():
        from app.cli.record import heads_of, verify_record

        heads = heads_of(head or ())
        with Activity("verifying: opening the database") as now:
            text, holds = verify_record(session, heads, now, as_json=as_json)
    print(text)
    if not holds:
        raise typer.Exit(INCOMPLETE)


@app.command()
def openapi() -> None:
    """Print the HTTP interface as OpenAPI JSON."""
    from app.main import create_app
    from app.settings import Settings

    json.dump(create_app(Settings(database_url="sqlite://")).openapi(), sys.stdout, indent=2)


@app.command()
def token(
    account: Annotated[str, typer.Option(help="User name.")] = "admin",
    hours: Annotated[float, typer.Option(min=0.01, help="How long it is valid.")] = 12.0,
) -> None:
    """Print a bearer token for scripts."""
    from app.cli.installation import new_token

    with reported(LookupError):
        print(new_token(account, hours))


@app.command()
def rehearse(
    url: Annotated[str | None, typer.Option(help="Server; without it one is started.")] = None,
    token: Annotated[str | None, typer.Option(help="Bearer token for --url.")] = None,
    participants: Annotated[int, typer.Option(help="How many take part, one after the other.")] = 1,
    redo: Annotated[
        int | None,
        typer.Option(
            metavar="PHASE", help="Repeat this phase of the first participant half-way through it."
        ),
    ] = None,
    withdraw_during: Annotated[
        int | None,
        typer.Option(metavar="PHASE", help="The first participant withdraws in this phase."),
    ] = None,
    capture: Annotated[Path | None, typer.Option(help="Capture to move by.")] = None,
    speed: Annotated[float, typer.Option(help="Seconds of study time per second.")] = 1.0,
    seed: Annotated[
        int, typer.Option(help="Random seed of the first participant; each next one adds 1.")
    ] = 1,
    study: Annotated[
        str, typer.Option(help="Key of the study, or of a template.")
    ] = "reembodiment-latency",
    data: Annotated[
        Path | None, typer.Option(help="Keep the started server's data in this folder.")
    ] = None,
    physics: Annotated[
        bool,
        typer.Option("--physics", help="Use a physics avatar even if the study does not."),
    ] = False,
    fingers: Annotated[
        bool,
        typer.Option(
            "--fingers", help="Record fingers, too: those of the capture, or generated ones."
        ),
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the reports as JSON.")] = False,
) -> None:
    """Take simulated participants through whole sessions.

    A session takes the time of its phases, divided by --speed: 9 minutes
    with the study that ships. With a physics avatar, two cores reach a
    speed of about 6, so 2 minutes at best. A PHASE is its number in the
    visit, from 1; practice and free movement count.
    """
    from app.cli.rehearsing import run_rehearsal
    from app.rehearsal.rehearse import RehearsalPlan

    plan = RehearsalPlan(
        url=url or "",
        study=study,
        speed=speed,
        seed=seed,
        capture=capture,
        token=token,
        physics=physics,
        fingers=fingers,
        redo=redo,
        withdraw_during=withdraw_during,
    )
    with reported(ValueError, RuntimeError):
        whole = run_rehearsal(plan, print, participants=participants, data=data, as_json=as_json)
    if not whole:
        warn("a session was ended before its last step, so this was not a whole rehearsal")
        raise typer.Exit(INCOMPLETE)


@app.command()
def backup(
    file: Annotated[Path, typer.Argument(help="New file to write.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print the summary as JSON.")] = False,
) -> None:
    """Copy all data into one file; the server may run meanwhile."""
    with reported(), Activity(f"backing up to {file}: opening the database") as now:
        from app.cli.backups import back_up_to

        done = back_up_to(file, now, as_json=as_json)
    print(done)


@app.command()
def restore(
    file: Annotated[Path, typer.Argument(help="A file that `backup` wrote.")],
    replace: Annotated[
        bool, typer.Option("--replace", help="Replace existing data, after backing them up.")
    ] = False,
    even_though_active: Annotated[
        bool, typer.Option("--even-though-active", help="Restore even while sessions are active.")
    ] = False,
    even_though_altered: Annotated[
        bool,
        typer.Option("--even-though-altered", help="Restore even if the backup was altered."),
    ] = False,
    erasures: Annotated[
        Path | None,
        typer.Option(help="erasures.jsonl of the earlier data folder, to repeat its erasures."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the summary as JSON.")] = False,
) -> None:
    """Replace all data by those of a backup."""
    with reported(), Activity(f"restoring {file}: opening it") as now:
        from app.cli.backups import RestoreOptions, restore_from

        options = RestoreOptions(
            replace=replace,
            even_though_active=even_though_active,
            even_though_altered=even_though_altered,
            erasures=erasures,
        )
        done = restore_from(file, now, options, as_json=as_json)
    print(done)
