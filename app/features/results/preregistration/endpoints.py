"""HTTP endpoints of preregistrations: the page, and a report to upload to a registry."""

from typing import Annotated

from fastapi import APIRouter, Query, Response

from app.features.results.preregistration.markdown import as_markdown, without_codes
from app.features.results.preregistration.schemas import (
    PreregistrationQuery,
    PreregistrationView,
    ReportQuery,
)
from app.features.results.preregistration.service import preregistration_of
from app.platform.dependencies import Context, Reading, SignedIn

router = APIRouter(tags=["preregistration"])


@router.get("/studies/{key}/preregistration")
def get_preregistration(
    key: str,
    db: Reading,
    context: Context,
    _: SignedIn,
    query: Annotated[PreregistrationQuery, Query()],
) -> PreregistrationView:
    """Return a study's declaration, the result of the declared test, and every deviation."""
    return preregistration_of(db, key, query.kind, context.clock.utc_now())


@router.get(
    "/studies/{key}/preregistration/report",
    response_class=Response,
    responses={200: {"content": {"text/markdown": {}, "application/json": {}}}},
)
def get_preregistration_report(
    key: str,
    db: Reading,
    context: Context,
    _: SignedIn,
    query: Annotated[ReportQuery, Query()],
) -> Response:
    """Return the preregistration's report as a file for a registry.

    Participants are numbered, and their codes are left out.
    """
    now, is_json = context.clock.utc_now(), query.form == "json"
    view = without_codes(preregistration_of(db, key, query.kind, now))
    written = view.model_dump_json(indent=2) + "\n" if is_json else as_markdown(view)
    ending, media = ("json", "application/json") if is_json else ("md", "text/markdown")
    name = f"{key}_preregistration_{query.kind}_{now.date().isoformat()}.{ending}"
    return Response(
        written.encode(),
        media_type=f"{media}; charset=utf-8",
        headers={"content-disposition": f'attachment; filename="{name}"'},
    )
