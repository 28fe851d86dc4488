"""The tasks of the worker process for figures: dashboards, rows of one figure, the study's tests.

The tables stay in this process between tasks (`MaterialStore`), so that another filter of the same
data only costs its drawing. Each task determines the state of the data in the transaction that it
reads in, so that outdated tables are never used for newer data.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

from sqlalchemy import Engine
from sqlalchemy.orm import Session

from app.database import make_engine
from app.errors import NotFound
from app.features.results.analysis.dashboard import dashboard_of, drawings_of
from app.features.results.analysis.material import Material, MaterialStore
from app.features.results.analysis.schemas import DashboardKind, FigureFilter, FigureGroup
from app.features.results.analysis.sheets import sheet_of
from app.features.results.analysis.state import state_of_data

_store = MaterialStore()


def draw(
    url: str,
    study_key: str,
    kind: DashboardKind,
    chosen: FigureFilter,
    group: FigureGroup | None,
) -> bytes:
    """Return the dashboard, or one group of its figures, as JSON."""
    with _material(url, study_key, kind) as material:
        return dashboard_of(material, chosen, group).model_dump_json().encode()


def sheet(
    url: str, study_key: str, kind: DashboardKind, chosen: FigureFilter, figure: str
) -> bytes:
    """Return the rows of one figure as CSV.

    Raises NotFound, with the keys of all figures, for an unknown figure.
    """
    with _material(url, study_key, kind) as material:
        for drawing in drawings_of(material, chosen, figure=figure):
            if drawing.key == figure:
                return sheet_of(drawing, material)
        keys = [drawing.key for drawing in drawings_of(material, chosen)]
    raise NotFound("there is no such figure", value=figure, valid=keys)


def compute(url: str, study_key: str, kind: DashboardKind) -> bytes:
    """Return the results of the study's tests as JSON."""
    # Imported here because it loads scipy and every test, which figures do not need.
    from app.features.results.analysis.questions.answers import answers_of

    with _material(url, study_key, kind) as material:
        return answers_of(material).model_dump_json().encode()


@contextmanager
def _material(url: str, study_key: str, kind: DashboardKind) -> Iterator[Material]:
    with Session(_engine(url)) as db:
        yield _store.get(db, study_key, kind, state_of_data(db, study_key, kind))


@cache
def _engine(url: str) -> Engine:
    # Without a pool, no connection stays open between tasks, so the database can be replaced.
    return make_engine(url, pooled=False)
