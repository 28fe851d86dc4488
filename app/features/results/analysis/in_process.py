"""What runs in the process that draws: figures, the rows of one, and the study's tests.

The tables stay in this process between tasks (`MaterialStore`), so that another filter of the same
data costs its drawing only. Each task looks at the state of the data in the transaction that it
reads by, so that no table of older data is taken for one of newer.
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
    """The dashboard, or one group of its figures, as JSON."""
    with _material(url, study_key, kind) as material:
        return dashboard_of(material, chosen, group).model_dump_json().encode()


def sheet(
    url: str, study_key: str, kind: DashboardKind, chosen: FigureFilter, figure: str
) -> bytes:
    """The rows of one figure as CSV; raises NotFound with the figures there are."""
    known = []
    with _material(url, study_key, kind) as material:
        for drawing in drawings_of(material, chosen):
            if drawing.key == figure:
                return sheet_of(drawing, material)
            known.append(drawing.key)
    raise NotFound("there is no such figure", value=figure, valid=known)


def compute(url: str, study_key: str, kind: DashboardKind) -> bytes:
    """The answers to the study's questions as JSON."""
    # Loads scipy and statsmodels, which figures do without.
    from app.features.results.analysis.questions import answers_of

    with _material(url, study_key, kind) as material:
        return answers_of(material).model_dump_json().encode()


@contextmanager
def _material(url: str, study_key: str, kind: DashboardKind) -> Iterator[Material]:
    with Session(_engine(url)) as db:
        yield _store.get(db, study_key, kind, state_of_data(db, study_key, kind))


@cache
def _engine(url: str) -> Engine:
    # Without a pool no connection stays open between tasks: a database can be replaced or dropped.
    return make_engine(url, pooled=False)
