"""Apply a preregistration to the recorded data: exclusions, the primary test and deviations."""

from datetime import datetime
from typing import cast

from sqlalchemy.orm import Session

from app.features.design.studies import newest_version, protocol_of, versions_of
from app.features.results.analysis.tables import Kind, corrections_table
from app.features.results.preregistration.declaration import Declared, declared_in, names_in
from app.features.results.preregistration.deviations import deviations_of
from app.features.results.preregistration.exclusions import OVER, Tables, exclude, read_tables
from app.features.results.preregistration.primary_test import Values, make_test, values_of
from app.features.results.preregistration.schemas import PreregistrationView, PrimaryResult
from app.models import Study, StudyVersion
from app.science.statistics import StatisticsError

MIN_TESTED = 2


def completed_view(
    db: Session, study: Study, declared: Declared, view: PreregistrationView
) -> PreregistrationView:
    """Return the view, completed with the test's participants, result and deviations."""
    kind = cast("Kind", view.kind)
    versions = versions_of(db, study)
    protocol = protocol_of(newest_version(db, study))
    tables = read_tables(db, study.key, kind)
    excluded = exclude(tables, declared.preregistration.exclusions)
    # Broken-off and invalid sessions are in no test, whether or not a declared rule says so.
    completed = tables.sessions[
        (tables.sessions["status"] == "completed") & tables.sessions["valid"]
    ]
    included_ids = set(completed["session_id"]) - excluded.session_ids
    found = values_of(db, tables, protocol, kind, included_ids)
    result, why = _result(declared, found)
    return view.model_copy(
        update={
            "declaration": declared.view(_frozen_at(versions, declared), names_in(db, declared)),
            "sessions": int(tables.sessions["status"].isin(OVER).sum()),
            "excluded": excluded.found,
            "included": len(found.people),
            "result": result,
            "why_no_result": why,
            "deviations": deviations_of(
                declared,
                versions,
                tables.sessions,
                excluded,
                found,
                _n_corrected(db, study.key, kind, tables),
            ),
        }
    )


def _result(declared: Declared, found: Values) -> tuple[PrimaryResult | None, str | None]:
    if len(found.people) < MIN_TESTED:
        return None, "Fewer than two participants have all values; there is nothing to test yet."
    try:
        return make_test(declared.preregistration, found), None
    except StatisticsError as error:
        return None, str(error)


def _frozen_at(versions: list[StudyVersion], declared: Declared) -> datetime | None:
    """Return when the first session started on a version with exactly this declaration."""
    frozen = [
        version.frozen_at
        for version in versions
        if version.number >= declared.version.number
        and version.frozen_at is not None
        and declared_in(version) == declared.preregistration
    ]
    return min(frozen, default=None)


def _n_corrected(db: Session, study_key: str, kind: Kind, tables: Tables) -> int:
    rows = corrections_table(db, study_key, kind)
    return int(rows["session_id"].isin(set(tables.sessions["session_id"])).sum())
