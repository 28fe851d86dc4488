"""Every command, each a few lines: parse, call, print."""

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from app import __version__
from app.cli.analyse.command import analyse
from app.cli.failing import fail
from app.cli.retarget.command import retarget
from app.cli.serve.tls_command import tls
from app.cli.tune.command import tune
from app.cli.walk.command import walk

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
app.add_typer(tls, name="tls")
app.add_typer(walk, name="walk")
app.command()(retarget)
app.command()(tune)
app.command()(analyse)
INCOMPLETE = 1


def _tell_version(asked: bool) -> None:
    if asked:
        print(f"reembody {__version__}")
        raise typer.Exit


@app.callback()
def reembody(
    version: Annotated[
        bool, typer.Option("--version", callback=_tell_version, help="Print the version.")
    ] = False,
) -> None:
    """Runs, watches and analyses VR re-embodiment studies."""


@app.command()
def serve(
    port: Annotated[int | None, typer.Option(help="Port to listen on.")] = None,
    host: Annotated[str | None, typer.Option(help="Address to listen on.")] = None,
    lan: Annotated[
        bool | None, typer.Option("--lan", help="Also https on the lab's network.")
    ] = None,
    lan_port: Annotated[int | None, typer.Option(help="Port of https (8443).")] = None,
    lan_host: Annotated[
        str | None, typer.Option(help="Address of https; every one of this machine if left out.")
    ] = None,
    help_port: Annotated[
        int | None, typer.Option(help="Port of the page that helps devices (8080).")
    ] = None,
    certificate: Annotated[
        Path | None, typer.Option(help="Your own certificate with its chain, PEM.")
    ] = None,
    key: Annotated[Path | None, typer.Option(help="Its key, PEM.")] = None,
    without_tls: Annotated[
        bool | None, typer.Option("--without-tls", help="Reachable by others, unencrypted.")
    ] = None,
    new_database: Annotated[
        bool, typer.Option("--new-database", help="Begin an empty one behind one in quarantine.")
    ] = False,
    until_input_ends: Annotated[bool, typer.Option("--until-input-ends", hidden=True)] = False,
) -> None:
    """Serve the product on this machine, with --lan also on the lab's network."""
    from app.cli.serve.run import serve_forever

    given = {
        "port": port,
        "host": host,
        "lan": lan,
        "lan_port": lan_port,
        "lan_host": lan_host,
        "help_port": help_port,
        "certificate": certificate,
        "key": key,
        "without_tls": without_tls,
    }
    serve_forever(given, new_database=new_database, until_input_ends=until_input_ends)


@app.command()
def score(
    answers: Annotated[Path, typer.Argument(help="CSV with item columns; others are ids.")],
    instrument: Annotated[str, typer.Option(help="Key of the instrument.")],
) -> None:
    """Score a table of answers; writes ids and scores as CSV to standard output."""
    from app.cli.scoring import score_file

    try:
        sys.stdout.write(score_file(answers, instrument))
    except (ValueError, OSError) as error:
        fail(str(error))


@app.command()
def export(
    study: Annotated[str, typer.Option(help="Key of the study.")],
    to: Annotated[Path, typer.Option(help="Folder to write; an earlier export is replaced.")],
    kind: Annotated[
        str | None, typer.Option(help="people, simulated, test or all; people if there are any.")
    ] = None,
) -> None:
    """Write a study as tidy CSV with a codebook."""
    from app.cli.exporting import export_to_folder
    from app.errors import ReembodyError

    try:
        print(export_to_folder(study, to, kind))
    except ReembodyError as error:
        fail(f"{error.message}. {error.remedy}".strip())
    except (ValueError, OSError) as error:
        fail(str(error))


@app.command()
def verify(
    session: Annotated[str, typer.Option(help="Id of the session.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print the receipt as JSON.")] = False,
) -> None:
    """Prove from the record what of a session is there; exit code 1 if anything is missing."""
    from app.cli.verifying import verify_session
    from app.errors import ReembodyError

    try:
        text, complete = verify_session(session, as_json=as_json)
    except ReembodyError as error:
        fail(f"{error.message}. {error.remedy}".strip())
    print(text)
    if not complete:
        raise typer.Exit(INCOMPLETE)


@app.command()
def openapi() -> None:
    """Print the interface as OpenAPI JSON."""
    from app.main import create_app
    from app.settings import Settings

    json.dump(create_app(Settings(database_url="sqlite://")).openapi(), sys.stdout, indent=2)


@app.command()
def token(
    account: Annotated[str, typer.Option(help="User name.")] = "admin",
    hours: Annotated[float, typer.Option(help="How long it is valid.")] = 12.0,
) -> None:
    """Print a bearer token for scripts."""
    from app.cli.tokens import new_token
    from app.errors import ReembodyError

    try:
        print(new_token(account, hours))
    except ReembodyError as error:
        fail(f"{error.message}. {error.remedy}".strip())
    except LookupError as error:
        fail(str(error))


@app.command()
def rehearse(
    url: Annotated[str | None, typer.Option(help="Server; without it one is started.")] = None,
    token: Annotated[str | None, typer.Option(help="Bearer token for --url.")] = None,
    capture: Annotated[Path | None, typer.Option(help="Capture to move by.")] = None,
    speed: Annotated[float, typer.Option(help="Seconds of study time per second.")] = 1.0,
    seed: Annotated[int, typer.Option(help="Seed of everything that is drawn.")] = 1,
    study: Annotated[str, typer.Option(help="Key of the study.")] = "reembodiment-latency",
    data: Annotated[
        Path | None, typer.Option(help="Keep the started server's data in this folder.")
    ] = None,
    physics: Annotated[
        bool,
        typer.Option("--physics", help="With an avatar that follows by forces."),
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the report as JSON.")] = False,
) -> None:
    """Take a simulated participant through a whole session."""
    from app.cli.rehearsing import run_rehearsal

    try:
        print(
            run_rehearsal(
                url=url,
                token=token,
                capture=capture,
                speed=speed,
                seed=seed,
                study=study,
                data=data,
                physics=physics,
                as_json=as_json,
            )
        )
    except (ValueError, RuntimeError) as error:
        fail(str(error))


@app.command()
def backup(
    file: Annotated[Path, typer.Argument(help="New file to write.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print the summary as JSON.")] = False,
) -> None:
    """Copy everything into one file, while the server runs or not."""
    from app.cli.backing_up import back_up_to
    from app.errors import ReembodyError

    try:
        print(back_up_to(file, as_json=as_json))
    except ReembodyError as error:
        fail(f"{error.message}. {error.remedy}".strip())


@app.command()
def restore(
    file: Annotated[Path, typer.Argument(help="A file that `backup` wrote.")],
    replace: Annotated[
        bool, typer.Option("--replace", help="Replace what is there; it is backed up first.")
    ] = False,
    even_though_active: Annotated[
        bool, typer.Option("--even-though-active", help="Also while sessions are active.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the summary as JSON.")] = False,
) -> None:
    """Put a backup in the place of everything that is there."""
    from app.cli.restoring import restore_from
    from app.errors import ReembodyError

    try:
        print(
            restore_from(
                file, replace=replace, even_though_active=even_though_active, as_json=as_json
            )
        )
    except ReembodyError as error:
        fail(f"{error.message}. {error.remedy}".strip())
