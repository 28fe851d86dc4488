"""Dashboards and the codebook over HTTP."""

import json

from fastapi import APIRouter, Response

from app.features.analysis.schemas import ColumnView, DashboardKind, DashboardView
from app.features.dependencies import Context, Reading, SignedIn
from app.features.studies.service import study_by_key

router = APIRouter(tags=["analysis"])


@router.get("/studies/{key}/dashboard", response_model=DashboardView)
def get_dashboard(
    key: str, db: Reading, context: Context, _: SignedIn, kind: DashboardKind = "people"
) -> Response:
    """The figures of a study's sessions of one kind, as drawn last; ask again while not current."""
    drawn, current = context.drawings.dashboard(db, key, kind)
    when = json.dumps({"drawn_at": drawn.at.isoformat(), "current": current})
    # Not read and written once more: figures of a thousand participants are large.
    return Response(f"{when[:-1]},".encode() + drawn.body[1:], media_type="application/json")


@router.get("/studies/{key}/codebook")
def get_codebook(key: str, db: Reading, _: SignedIn) -> list[ColumnView]:
    """What every column of the study's export holds."""
    # Loads pandas, which the start of the server need not wait for.
    from app.features.analysis.codebook import CODEBOOK

    study_by_key(db, key)
    return [
        ColumnView(
            table=column.table,
            column=column.name,
            meaning=column.meaning,
            unit=column.unit,
            type=column.type,
            levels=column.levels,
        )
        for column in CODEBOOK
    ]
