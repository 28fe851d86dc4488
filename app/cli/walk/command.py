"""Define `walk fit`, `walk sample` and `walk evaluate`: parse options, run, print the results."""

import json
from pathlib import Path
from typing import Annotated

import typer

from app.cli.errors import reported
from app.cli.progress import Activity

walk = typer.Typer(help="Learn how people walk, and predict how others will.", no_args_is_help=True)
_Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]
_Walks = Annotated[
    list[Path],
    typer.Argument(help="Tracks (CSV: time_s, x_m, y_m, subject) or captures of any format."),
]
_Scene = Annotated[
    str | None, typer.Option(help="Scene file, or the key of a shipped scene; else open floor.")
]
_WalksScene = Annotated[
    str | None,
    typer.Option(
        help="Scene of recordings for which neither a column `scene` of their table nor one of"
        " --people names another: a scene file, or the key of a shipped scene; else open floor."
    ),
]
_People = Annotated[
    Path | None,
    typer.Option(
        help="CSV: subject, stature_m, file if files name no subject, scene, and numbers such as"
        " load_kg; a row with a file is about that recording, else about all of the subject."
    ),
]
_DependsOn = Annotated[
    list[str] | None,
    typer.Option(
        help="A column of --people or of the tables, such as load_kg, on which walks depend besides"
        " length, turning and stature; up to three times."
    ),
]
_Given = Annotated[
    list[str] | None,
    typer.Option("--with", help="A further dependency of the model, as in load_kg=8; repeatable."),
]
_Rate = Annotated[
    float | None, typer.Option(help="Frames a second, where a table's time is a frame number.")
]
_Unit = Annotated[str | None, typer.Option(help="Unit of x and y in tables: m, cm, mm or ft.")]
_Synthetic = Annotated[
    bool, typer.Option("--synthetic", help="A program made these walks, nobody walked them.")
]
_Seed = Annotated[int, typer.Option(help="Seed of all random draws.", min=0)]


@walk.command()
def fit(
    walks: _Walks,
    out: Annotated[Path, typer.Option(help="Model file to write.")],
    scene: _WalksScene = None,
    people: _People = None,
    depends_on: _DependsOn = None,
    rate_hz: _Rate = None,
    unit: _Unit = None,
    synthetic: _Synthetic = False,
    seed: _Seed = 1,
    k: Annotated[int, typer.Option(help="Neighbours used for a prediction.", min=1)] = 100,
    entries: Annotated[
        int, typer.Option(help="Walks and blends of them in the space.", min=1, max=50_000)
    ] = 5000,
    reading: Annotated[
        str, typer.Option(help="How maps become suitability: chosen, paper or time-aware.")
    ] = "chosen",
    as_json: _Json = False,
) -> None:
    """Fit a model of how people walk to walks of two people or more."""
    from app.cli.walk import output as texts
    from app.cli.walk.run import FitOrder, WalksOrder, carry_out_fit

    recorded = WalksOrder(tuple(walks), scene, people, rate_hz, unit, synthetic)
    order = FitOrder(recorded, out, seed, k, entries, reading, tuple(depends_on or ()))
    with reported(ValueError, OSError), Activity("reading the walks") as activity:
        done = carry_out_fit(order, activity.now)
    print(json.dumps(texts.fit_json(done)) if as_json else texts.fit_text(done))


@walk.command()
def sample(
    model: Annotated[Path, typer.Argument(help="A file that `walk fit` wrote.")],
    length: Annotated[float | None, typer.Option(help="A straight path, m.")] = None,
    path: Annotated[
        str | None, typer.Option(help="A path by its points, as in '0,0 0,2 1.5,3', m.")
    ] = None,
    scene: _Scene = None,
    start: Annotated[
        str | None, typer.Option("--from", help="Place of the scene, or x,y in m.")
    ] = None,
    goal: Annotated[
        str | None, typer.Option("--to", help="Place of the scene, or x,y in m.")
    ] = None,
    stature: Annotated[float | None, typer.Option(help="Of the walker, m.")] = None,
    given: _Given = None,
    count: Annotated[int, typer.Option(help="How many draws.")] = 100,
    which: Annotated[
        str | None, typer.Option("--model", help="mixed (if the file has it), prob, adapt or stat.")
    ] = None,
    seed: _Seed = 1,
    as_json: _Json = False,
) -> None:
    """Draw steering parameters and travel times for a path."""
    from app.cli.walk import output as texts
    from app.cli.walk.run import SampleOrder, carry_out_sample

    asked = (length, path, scene, start, goal, stature, count, which, seed)
    order = SampleOrder(model, *asked, tuple(given or ()))
    with reported(ValueError, OSError):
        done = carry_out_sample(order)
    print(json.dumps(texts.sample_json(done)) if as_json else texts.sample_text(done))


@walk.command()
def evaluate(
    model: Annotated[Path, typer.Argument(help="A file that `walk fit` wrote.")],
    walks: _Walks,
    scene: _WalksScene = None,
    people: _People = None,
    rate_hz: _Rate = None,
    unit: _Unit = None,
    draws: Annotated[int, typer.Option(help="Draws for each walk.")] = 200,
    seed: _Seed = 1,
    even_fitted: Annotated[
        bool, typer.Option("--even-fitted", help="Allow people that the model was fitted on.")
    ] = False,
    as_json: _Json = False,
) -> None:
    """Compare predicted travel times with walks of other people."""
    from app.cli.walk import output as texts
    from app.cli.walk.run import WalksOrder, carry_out_evaluation

    order = WalksOrder(tuple(walks), scene, people, rate_hz, unit)
    with reported(ValueError, OSError):
        done = carry_out_evaluation(model, order, draws=draws, seed=seed, even_fitted=even_fitted)
    print(json.dumps(texts.evaluation_json(done)) if as_json else texts.evaluation_text(done))
