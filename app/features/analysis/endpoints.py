"""Dashboards and the codebook over HTTP."""

from fastapi import APIRouter

from app.features.analysis.schemas import ColumnView, DashboardKind, DashboardView
from app.features.dependencies import Reading, SignedIn
from app.features.studies.service import study_by_key

router = APIRouter(tags=["analysis"])


@router.get("/studies/{key}/dashboard")
def get_dashboard(
    key: str, db: Reading, _: SignedIn, kind: DashboardKind = "people"
) -> DashboardView:
    """The figures of a study's sessions of one kind."""
    # Loads pandas and plotly, which the start of the server need not wait for.
    from app.features.analysis.dashboard import build_dashboard

    return build_dashboard(db, key, kind)


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
