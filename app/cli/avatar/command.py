"""Define `avatar list|show|edit|diff|convert|save|load`: parse options, run, print the results."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.errors import reported

avatar = typer.Typer(
    help="Show, edit, compare, convert, save and load configurations of avatars.",
    no_args_is_help=True,
)
_Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]
_Source = Annotated[
    str,
    typer.Argument(
        help="A configuration's file (.json), or the key of a saved avatar: KEY for its newest"
        " version, KEY@2 for another."
    ),
]
_Out = Annotated[Path | None, typer.Option(help="File to write.")]
_Save = Annotated[
    str | None,
    typer.Option(help="Store it under a new key, or as a new version of an avatar."),
]
_Note = Annotated[str, typer.Option(help="Note stored with the version.")]
_Url = Annotated[
    str | None,
    typer.Option(help="Ask this server; without it this installation, whose server may run."),
]
_Token = Annotated[str | None, typer.Option(help="Bearer token for --url.")]
_BasedOn = Annotated[
    int | None,
    typer.Option(
        min=1,
        help="Number of the version from which the content was made; needed for an avatar with"
        " more than one, unless the source is one of them.",
    ),
]
_Title = Annotated[str | None, typer.Option(help="Title of a new avatar; else its key.")]


@avatar.command("list")
def list_avatars(url: _Url = None, token: _Token = None, as_json: _Json = False) -> None:
    """List the avatars of the lab with their versions."""
    from app.cli.avatar import library, output

    with reported(ValueError, with_valid=True):
        found = library.library_of(url, token).listed()
    _print(found, output.list_text(found), as_json=as_json)


@avatar.command()
def show(
    source: _Source,
    group: Annotated[str, typer.Option(help="Only this body group or part.")] = "all",
    single: Annotated[
        bool, typer.Option("--single", help="One joint per part: the single template.")
    ] = False,
    url: _Url = None,
    token: _Token = None,
    as_json: _Json = False,
) -> None:
    """Print a configuration as a table: gains, greatest torque and limits by axis."""
    from app.cli.avatar import library, output, run

    with reported(ValueError, OSError, with_valid=True):
        shown = run.shown(library.library_of(url, token), source, group, single=single)
    _print(shown.as_json, output.table(shown), as_json=as_json)


@avatar.command()
def edit(
    source: _Source,
    operation: Annotated[
        list[str] | None,
        typer.Option(
            help='An operation as JSON, as in \'{"operation": "mirror", "direction":'
            ' "left_to_right"}\'; repeatable, in order.'
        ),
    ] = None,
    operations: Annotated[
        Path | None, typer.Option(help="File with a JSON list of operations, made first.")
    ] = None,
    out: _Out = None,
    save: _Save = None,
    title: _Title = None,
    note: _Note = "",
    based_on: _BasedOn = None,
    url: _Url = None,
    token: _Token = None,
    as_json: _Json = False,
) -> None:
    """Edit a configuration by operations; says what changes and what a conversion loses.

    Without --out and --save nothing is written.
    """
    from app.cli.avatar import library, output, run

    order = run.EditOrder(
        source, tuple(operation or ()), operations, out, save, title, note, based_on
    )
    with reported(ValueError, OSError, with_valid=True):
        done = run.edit(library.library_of(url, token), order)
    _print(done.as_json, output.edit_text(done), as_json=as_json)


@avatar.command()
def operations(as_json: _Json = False) -> None:
    """List the operations of `edit` with their keys; --json prints their JSON schemas."""
    from app.cli.avatar import output, run

    _print(run.operation_schemas(), output.operations_text(), as_json=as_json)


@avatar.command()
def diff(
    old: _Source,
    new: _Source,
    url: _Url = None,
    token: _Token = None,
    as_json: _Json = False,
) -> None:
    """Say how two configurations differ: by value, and summed up by body group."""
    from app.cli.avatar import library, output, run

    with reported(ValueError, OSError, with_valid=True):
        found = run.compared(library.library_of(url, token), old, new)
    _print(found, output.difference_text(found), as_json=as_json)


@avatar.command()
def convert(
    source: _Source,
    to: Annotated[str, typer.Option(help="single (one joint per part) or multiple (per axis).")],
    out: Annotated[Path, typer.Option(help="File to write, in that template.")],
    url: _Url = None,
    token: _Token = None,
    as_json: _Json = False,
) -> None:
    """Write a configuration in the single or the multiple template; says what is lost."""
    from app.cli.avatar import library, output, run

    with reported(ValueError, OSError, with_valid=True):
        done = run.convert(library.library_of(url, token), source, to, out)
    _print(done.as_json, output.edit_text(done), as_json=as_json)


@avatar.command()
def save(
    file: Annotated[Path, typer.Argument(help="A configuration's file, in either template.")],
    key: Annotated[str, typer.Argument(help="A new key, or that of an avatar.")],
    based_on: _BasedOn = None,
    title: _Title = None,
    note: _Note = "",
    url: _Url = None,
    token: _Token = None,
    as_json: _Json = False,
) -> None:
    """Store a configuration's file under a new key, or as the next version of an avatar.

    Says what differs from the version before. A file that was made from an older version is
    refused, because it would take back what has been saved since.

    A server of this installation may run meanwhile. For another one give --url and --token.
    """
    from app.cli.avatar import library, output, run

    with reported(ValueError, OSError, with_valid=True):
        saved = run.save(library.library_of(url, token), file, key, title, note, based_on)
    _print(saved.as_json, output.saved_text(saved), as_json=as_json)


@avatar.command()
def load(
    source: _Source,
    out: Annotated[Path, typer.Option(help="File to write.")],
    url: _Url = None,
    token: _Token = None,
    as_json: _Json = False,
) -> None:
    """Write a saved version of an avatar as a file."""
    from app.cli.avatar import library, output, run

    with reported(ValueError, OSError, with_valid=True):
        found = run.load(library.library_of(url, token), source, out)
    _print(found, output.loaded_text(found), as_json=as_json)


def _print(figures: Any, text: str, *, as_json: bool) -> None:
    print(json.dumps(figures) if as_json else text)
