"""HTTP endpoints of dashboards, the rows of their figures, the study's tests and the codebook."""

import json
from typing import Annotated

from fastapi import APIRouter, Path, Query, Response

from app.features.design.studies import study_by_key
from app.features.people.audit import count_sessions, download_place, record, record_copy
from app.features.results.analysis.drawing import Drawings, Drawn
from app.features.results.analysis.schemas import (
    ColumnView,
    DashboardKind,
    DashboardQuery,
    DashboardView,
    GroupQuery,
    StatisticsView,
)
from app.gc_tuning import loading_modules
from app.platform.dependencies import Context, Reading, SignedIn

router = APIRouter(tags=["analysis"])
FigureKey = Annotated[str, Path(pattern=r"^[a-z][a-z0-9_]{0,79}$")]


@router.get("/studies/{key}/dashboard", response_model=DashboardView)
def get_dashboard(
    key: str, context: Context, _: SignedIn, query: Annotated[GroupQuery, Query()]
) -> Response:
    """Return the latest figures of sessions of one kind; repeat the request until they are current.

    The filter selects sessions and rows before anything is drawn. One group of the figures is ready
    sooner than all of them.
    """
    return _answer(*context.part(Drawings).dashboard(key, query.kind, query.filter, query.group))


@router.get(
    "/studies/{key}/dashboard/{figure}/rows",
    response_class=Response,
    responses={200: {"content": {"text/csv": {}}, "description": "The rows of a figure."}},
)
def get_figure_rows(
    key: str,
    figure: FigureKey,
    context: Context,
    caller: SignedIn,
    query: Annotated[DashboardQuery, Query()],
) -> Response:
    """Return the rows that a figure is drawn from as CSV, with comment lines that describe them."""
    body = context.part(Drawings).sheet(key, query.kind, query.filter, figure)
    now = context.clock.utc_now()
    # People's data leave the database, so the copy is recorded for a later erasure.
    with context.database.writing() as writing:
        study = study_by_key(writing, key)
        record_copy(
            writing,
            kind="export",
            study_id=study.id,
            session_kind=query.kind,
            place=f"{download_place(caller.actor)}: rows of the figure {figure}",
            by=caller.actor,
            now=now,
            sessions=count_sessions(writing, study, query.kind),
            size_bytes=len(body),
        )
        record(
            writing,
            actor=caller.actor,
            action="study.exported",
            subject=f"study:{study.key}",
            details={"kind": query.kind, "figure": figure},
            now=now,
        )
    name = f"{key}_{figure}_{query.kind}_{now.date().isoformat()}.csv"
    return Response(
        body,
        media_type="text/csv; charset=utf-8",
        headers={"content-disposition": f'attachment; filename="{name}"'},
    )


@router.get("/studies/{key}/statistics", response_model=StatisticsView)
def get_statistics(
    key: str, context: Context, _: SignedIn, kind: DashboardKind = "people"
) -> Response:
    """Return the results of the study's tests on valid sessions; repeat while they are not current.

    There is no filter, so that what is tested cannot be chosen after seeing the data.
    """
    return _answer(*context.part(Drawings).statistics(key, kind))


@router.get("/studies/{key}/codebook")
def get_codebook(key: str, db: Reading, _: SignedIn) -> list[ColumnView]:
    """Return the description of every column of the study's export."""
    # Imported here because it loads pandas, which would slow down the server's start.
    with loading_modules():
        from app.features.results.analysis.codebook import codebook
        from app.features.results.analysis.tables import has_rules

    rules = has_rules(db, study_by_key(db, key))
    return [
        ColumnView(
            table=column.table,
            column=column.name,
            meaning=column.meaning,
            unit=column.unit,
            type=column.type,
            levels=column.levels,
        )
        for column in codebook(rules=rules)
    ]


def _answer(drawn: Drawn, current: bool) -> Response:  # noqa: FBT001 - as `Drawings` gives it
    when = json.dumps({"drawn_at": drawn.at.isoformat(), "current": current})
    # The JSON is spliced, not parsed: the figures of a thousand participants are large.
    return Response(f"{when[:-1]},".encode() + drawn.body[1:], media_type="application/json")
