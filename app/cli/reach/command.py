"""Define `reach fit`, `reach evaluate` and `reach sample`: parse options, run, print."""

import json
from pathlib import Path
from typing import Annotated

import typer

from app.cli.errors import reported
from app.cli.progress import Activity

reach = typer.Typer(
    help="Learn from recorded hands how people reach, for the simulated people of a pilot.",
    no_args_is_help=True,
)
_Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]
_Seed = Annotated[int, typer.Option(help="Seed of all random draws.", min=0)]
_Model = Annotated[Path, typer.Argument(help="A file that `reach fit` wrote.")]


@reach.command()
def fit(
    recordings: Annotated[
        list[Path], typer.Argument(help="Captures with hands, or samples of an export.")
    ],
    out: Annotated[Path, typer.Option(help="File to write.")],
    people: Annotated[
        Path | None,
        typer.Option(
            help="CSV: file, subject; width_m of targets where known, stature_m for samples."
        ),
    ] = None,
    hand: Annotated[
        str | None,
        typer.Option(help="Name of the body, marker or joint that is the hand; else by its name."),
    ] = None,
    synthetic: Annotated[
        bool, typer.Option("--synthetic", help="A program moved these hands, nobody did.")
    ] = False,
    seed: _Seed = 1,
    as_json: _Json = False,
) -> None:
    """Fit how people reach to recorded hands."""
    from app.cli.reach import output as texts
    from app.cli.reach.inputs import HandsOrder
    from app.cli.reach.run import carry_out_fit

    order = HandsOrder(tuple(recordings), people, hand, synthetic)
    with reported(ValueError, OSError), Activity("reading the recordings") as activity:
        done = carry_out_fit(order, out, seed, activity.now)
    print(json.dumps(texts.fit_json(done)) if as_json else texts.fit_text(done))


@reach.command()
def evaluate(
    model: _Model,
    draws: Annotated[int, typer.Option(help="Draws for each reach.", min=1, max=10_000)] = 400,
    seed: _Seed = 1,
    as_json: _Json = False,
) -> None:
    """Predict each person of a file from the others, beside assumed constants and a line."""
    from app.cli.reach import output as texts
    from app.cli.reach.run import carry_out_evaluation

    with reported(ValueError, OSError), Activity("leaving out one after the other"):
        done = carry_out_evaluation(model, draws, seed)
    print(json.dumps(texts.evaluation_json(done)) if as_json else texts.evaluation_text(done))


@reach.command()
def sample(
    model: _Model,
    distance: Annotated[float, typer.Option(help="Distance of the reach, m.")],
    width: Annotated[
        float | None, typer.Option(help="Width of the target, m, if the file knows widths.")
    ] = None,
    count: Annotated[int, typer.Option(help="How many draws.", min=1, max=100_000)] = 1000,
    seed: _Seed = 1,
    as_json: _Json = False,
) -> None:
    """Draw movement times and skews of new people for a distance."""
    from app.cli.reach import output as texts
    from app.cli.reach.run import SampleOrder, carry_out_sample

    order = SampleOrder(model, distance, width, count, seed)
    with reported(ValueError, OSError):
        done = carry_out_sample(order)
    print(json.dumps(texts.sample_json(done)) if as_json else texts.sample_text(done))
