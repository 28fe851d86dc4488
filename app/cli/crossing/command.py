"""Define `crossing run`, `scenes`, `vehicle` and `install`: parse options, run, print results."""

import json
from pathlib import Path
from typing import Annotated

import typer

from app.cli.errors import INCOMPLETE, reported, warn

crossing = typer.Typer(
    help="Run scenes at a road: persons and cars of several partners on one clock.",
    no_args_is_help=True,
)
_Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]


@crossing.command()
def run(
    scene: Annotated[str, typer.Argument(help="Scene file, or the key of an included scene.")],
    seed: Annotated[int, typer.Option(help="Seed of all random draws.", min=0)] = 1,
    out: Annotated[Path | None, typer.Option(help="Write the record, as JSON lines.")] = None,
    real_time: Annotated[
        bool, typer.Option("--real-time", help="Keep to real time; else as fast as possible.")
    ] = False,
    as_json: _Json = False,
) -> None:
    """Run a scene and measure how persons crossed; exit code 1 if a partner was lost."""
    from app.cli.crossing import output as texts
    from app.cli.crossing.run import carry_out_run

    with reported(ValueError, OSError):
        done = carry_out_run(scene, seed, out, real_time=real_time, say=warn)
    print(json.dumps(texts.run_json(done)) if as_json else texts.run_text(done))
    if done.record.lost:
        warn(f"{done.record.lost} What was recorded until then is kept.")
        raise typer.Exit(INCOMPLETE)


@crossing.command()
def scenes(as_json: _Json = False) -> None:
    """List the included scenes, and what they need that is not installed."""
    from app.cli.crossing import output as texts
    from app.cli.crossing.run import listed_scenes

    listed = listed_scenes()
    print(json.dumps(texts.scenes_json(listed)) if as_json else texts.scenes_text(listed))


@crossing.command()
def vehicle(
    connect: Annotated[str, typer.Option(help="HOST:PORT of the scene.")],
    name: Annotated[str, typer.Option(help="Name of the partner in the scene.")] = "vehicle",
    lane: Annotated[str, typer.Option(help="near or far.")] = "near",
    speed: Annotated[float, typer.Option(help="Wanted speed, m/s.", min=1.0, max=60.0)] = 12.0,
    fmu: Annotated[Path | None, typer.Option(help="FMU with a_cmd, x and v.")] = None,
) -> None:
    """Take part in a scene as a car, as the example of a process that does."""
    from app.cli.crossing.run import carry_out_vehicle

    with reported(ValueError, OSError):
        carry_out_vehicle(connect, name, lane, speed, fmu)


@crossing.command()
def install(
    extra: Annotated[
        str | None, typer.Argument(help="traffic (SUMO, 510 MB unpacked) or fmu.")
    ] = None,
) -> None:
    """Install what only some scenes need, or list it.

    It is installed into the environment of this command.
    """
    from app.cli.crossing.run import install_extra, listed_extras

    with reported(ValueError, OSError):
        done = listed_extras() if extra is None else install_extra(extra)
    print(done)
