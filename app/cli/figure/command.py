"""Define the command `figure`: parse its options, run it, print what was written."""

from pathlib import Path
from typing import Annotated

import typer

from app.cli.errors import fail, reported
from app.cli.outputs import require_folder_of


def figure(
    out: Annotated[Path, typer.Option(help="File to write, such as body.glb or body.vrm.")],
    population: Annotated[
        str, typer.Option(help="Shape of the body: male, female or neutral.")
    ] = "neutral",
    stature_m: Annotated[float, typer.Option(help="Body height in metres.")] = 1.75,
    segment: Annotated[
        list[str] | None,
        typer.Option(
            help="A measured length in metres, such as thigh=0.41; may be given more than once."
        ),
    ] = None,
) -> None:
    """Make a skinned body of any proportions, with fingers, as a file that is glTF and VRM 1.0."""
    from app.cli.figure.run import POPULATIONS, make

    if population not in POPULATIONS:
        fail(f"--population {population!r}: {', '.join(POPULATIONS)} are valid")
    with reported(ValueError, OSError):
        require_folder_of(out)
        made = make(out, population, stature_m, segment or ())
    print(made)
