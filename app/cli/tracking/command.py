"""Define `tracking align`: parse its options, run it, print the results."""

import json
from pathlib import Path
from typing import Annotated

import typer

from app.cli.errors import fail, reported

tracking = typer.Typer(
    help="Bring a lab's trackers into the world of a headset.", no_args_is_help=True
)


@tracking.callback()
def _tracking() -> None:
    """Keep `align` a command of its own, although it is the only one."""


@tracking.command()
def align(
    headset: Annotated[
        Path, typer.Argument(help="The head by the headset: CSV of time_s, x_m..z_m, qw..qz.")
    ],
    tracker: Annotated[Path, typer.Argument(help="A tracker fixed to the headset, likewise.")],
    move: Annotated[
        Path | None, typer.Option(help="Another tracker of the same system, likewise.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="File for --move in the headset's world and time.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Align two recorded streams, and bring another tracker into the headset's world."""
    if (move is None) != (out is None):
        fail("--move and --out are needed together: a tracker's file, and the file to write")
    from app.cli.tracking import output as texts
    from app.cli.tracking.run import AlignOrder, carry_out

    with reported(ValueError, OSError):
        done = carry_out(AlignOrder(headset, tracker, move, out))
    print(json.dumps(texts.as_json(done)) if as_json else texts.as_text(done))
