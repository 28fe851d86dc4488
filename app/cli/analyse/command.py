"""Define the command `analyse`: parse its options, run the analysis, print the results."""

import json
from pathlib import Path
from typing import Annotated

import typer

from app.cli.errors import reported


def analyse(
    table: Annotated[Path, typer.Argument(help="Tidy CSV: one row per observation.")],
    subject: Annotated[str, typer.Option(help="Column that names the subject.")],
    within: Annotated[
        list[str], typer.Option(help="Column of a within-subject factor; once or twice.")
    ],
    measure: Annotated[str, typer.Option(help="Column of what was measured.")],
    reference: Annotated[
        str | None,
        typer.Option(help="Level of the first factor that every other is compared with."),
    ] = None,
    where: Annotated[
        list[str] | None,
        typer.Option(help="COLUMN=VALUE: only rows with this value; repeatable."),
    ] = None,
    order: Annotated[
        list[str] | None,
        typer.Option(
            help="FACTOR=LEVEL,LEVEL,...: the order of its levels; a trend in names needs one."
        ),
    ] = None,
    average: Annotated[
        list[str] | None,
        typer.Option(
            help="Column of words, such as a limb, to average over within each cell; repeatable."
        ),
    ] = None,
    missing: Annotated[
        list[str] | None,
        typer.Option(help="A value that stands for a missing one, as -99; repeatable."),
    ] = None,
    art: Annotated[
        bool, typer.Option("--art", help="Also the aligned rank transform, which is contested.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Compare within-subject conditions: Friedman, Wilcoxon with Holm, Page, repeated ANOVA."""
    from app.cli.analyse import output as texts
    from app.cli.analyse.output_json import as_json as to_json
    from app.cli.analyse.run import AnalyseOrder, carry_out

    asked = AnalyseOrder(
        table,
        subject,
        within,
        measure,
        reference,
        art,
        where=tuple(where or ()),
        declared_orders=tuple(order or ()),
        averaged=tuple(average or ()),
        missing=tuple(missing or ()),
    )
    with reported(ValueError, OSError):
        done = carry_out(asked)
    print(json.dumps(to_json(done), allow_nan=False) if as_json else texts.as_text(done))
