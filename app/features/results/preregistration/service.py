"""The preregistration of a study, with its result."""

from datetime import datetime

from sqlalchemy.orm import Session

from app.features.design.studies import study_by_key, versions_of
from app.features.results.analysis import DashboardKind
from app.features.results.preregistration.declaration import declaration_of
from app.features.results.preregistration.schemas import PreregistrationView


def preregistration_of(
    db: Session, study_key: str, kind: DashboardKind, now: datetime
) -> PreregistrationView:
    """Return a study's declaration with its result; raise NotFound for an unknown study."""
    study = study_by_key(db, study_key)
    declared = declaration_of(versions_of(db, study))
    view = PreregistrationView(
        study_key=study.key,
        kind=kind,
        simulated=kind == "simulated",
        as_of=now,
        declaration=None,
        sessions=0,
        excluded=[],
        included=0,
        result=None,
        why_no_result=None,
        deviations=[],
    )
    if declared is None:
        return view
    # Imported here because it loads pandas and scipy, which would slow down the start.
    from app.features.results.preregistration.report import completed_view

    return completed_view(db, study, declared, view)
