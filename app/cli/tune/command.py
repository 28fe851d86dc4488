"""Define the command `tune`: parse its options, run the tuning, print the results."""

import json
from pathlib import Path
from typing import Annotated

import typer

from app.cli.errors import fail, reported


def tune(
    avatar: Annotated[
        str | None,
        typer.Option(help="Key of a stored configuration; without it the product's own."),
    ] = None,
    stature: Annotated[float, typer.Option(help="Stature of the body, m.")] = 1.75,
    mass: Annotated[
        float | None, typer.Option(help="Mass of the body, kg; else the configuration's.")
    ] = None,
    heuristic: Annotated[
        str,
        typer.Option(help="critical, inertia, ziegler-nichols-pd or tyreus-luyben-pd."),
    ] = "critical",
    mirror: Annotated[
        bool, typer.Option("--mirror", help="Tune the left side and copy it to the right.")
    ] = False,
    evaluate: Annotated[
        bool,
        typer.Option("--evaluate", help="Test the existing gains without changing them."),
    ] = False,
    axis: Annotated[
        list[str] | None,
        typer.Option(
            help="Tune this axis only, as in LeftUpperLegX; repeatable. With --mirror, a left one"
            " includes its right counterpart."
        ),
    ] = None,
    attempts: Annotated[int, typer.Option(help="Experiments per axis at most.")] = 3,
    relay_torque: Annotated[
        list[str] | None,
        typer.Option(
            help="Torque of the relay, N m: one for all axes, or AXIS=N m; repeatable. Without it"
            " a ramp finds each axis' own."
        ),
    ] = None,
    workers: Annotated[int, typer.Option(help="Threads.")] = 2,
    capture: Annotated[
        Path | None, typer.Option(help="Also follow this capture, for the angular error.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Write the tuned configuration as a JSON file.")
    ] = None,
    save: Annotated[
        str | None,
        typer.Option(help="Store it in the database under a new key, or as a new version of one."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Find gains for every axis of the avatar by relay experiments, and test them."""
    from app.cli.tune import output as texts
    from app.cli.tune.run import TuneOrder, carry_out
    from app.science.avatar.tuning import TuningCancelled

    order = TuneOrder(
        avatar=avatar,
        stature_m=stature,
        mass_kg=mass,
        heuristic=heuristic,
        mirror=mirror,
        evaluate=evaluate,
        axes=None if axis is None else tuple(axis),
        attempts=attempts,
        relay_torques=tuple(relay_torque or ()),
        workers=workers,
        capture=capture,
        out=out,
        save=save,
    )
    with reported(ValueError, OSError, with_valid=True):
        try:
            done = carry_out(order)
        except TuningCancelled:
            fail("the tuning was cancelled; nothing was written or stored")
    print(json.dumps(texts.as_json(done)) if as_json else texts.as_text(done))
