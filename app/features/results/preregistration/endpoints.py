"""HTTP endpoints of preregistrations: the page, and a report to upload to a registry."""

from typing import Literal

from fastapi import APIRouter, Response

from app.features.results.analysis import DashboardKind
from app.features.results.preregistration.markdown import as_markdown, without_codes
from app.features.results.preregistration.schemas import PreregistrationView
from app.features.results.preregistration.service import preregistration_of
from app.platform.dependencies import Context, Reading, SignedIn

router = APIRouter(tags=["preregistration"])


@router.get("/studies/{key}/preregistration")
def get_preregistration(
    key: str, db: Reading, context: Context, _: SignedIn, kind: DashboardKind = "people"
) -> PreregistrationView:
    """Return a study's declaration, the result of the declared test, and every deviation."""
    return preregistration_of(db, key, kind, context.clock.utc_now())


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
    kind: DashboardKind = "people",
    form: Literal["markdown", "json"] = "markdown",
) -> Response:
    """Return the preregistration's report as a file for a registry.

    Participants are numbered, and their codes are left out.
    """
    now = context.clock.utc_now()
    view = without_codes(preregistration_of(db, key, kind, now))
    written = view.model_dump_json(indent=2) + "\n" if form == "json" else as_markdown(view)
    ending, media = ("json", "application/json") if form == "json" else ("md", "text/markdown")
    name = f"{key}_preregistration_{kind}_{now.date().isoformat()}.{ending}"
    return Response(
        written.encode(),
        media_type=f"{media}; charset=utf-8",
        headers={"content-disposition": f'attachment; filename="{name}"'},
    )
