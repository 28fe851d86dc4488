"""Build the dashboard of a study: figures of its valid rows, by group.

Sessions of people, simulations and tests are never drawn together. In a blinded study only
completed sessions are drawn, so that the figures cannot reveal the latencies of a session that is
still running.
"""

from collections.abc import Iterator
from dataclasses import replace

from sqlalchemy.orm import Session

from app.features.results.analysis.figures import FIGURES, Drawing, Figure, Rows, orders_of
from app.features.results.analysis.material import Material, read_material
from app.features.results.analysis.schemas import (
    NO_FILTER,
    DashboardFigures,
    DashboardKind,
    FigureFilter,
    FigureGroup,
    FigureView,
    FilterChoices,
)
from app.features.results.analysis.tables import n_not_valid

TITLE_PREFIX = {"people": "", "simulated": "Simulated: ", "test": "Test: "}
NONE_COUNTS = "There are data, but none are valid: choose Rows: All to see them."
BLINDED_NOTE = "The study is blinded: measures of open sessions are left out."


def build_dashboard(
    db: Session, study_key: str, kind: DashboardKind, chosen: FigureFilter = NO_FILTER
) -> DashboardFigures:
    """Return every figure of a study's sessions of one kind; raise NotFound."""
    return dashboard_of(read_material(db, study_key, kind), chosen)


def dashboard_of(
    material: Material, chosen: FigureFilter = NO_FILTER, group: FigureGroup | None = None
) -> DashboardFigures:
    """Return the figures of the rows that pass the filter, and the values that the filter can take.

    `group` limits the result to one group of figures. Only the tables that these figures need are
    read from `material`.
    """
    chosen = material.with_body(chosen)
    filtered = material.chosen(chosen)
    return DashboardFigures(
        kind=material.kind,
        simulated=material.kind == "simulated",
        n_sessions=len(filtered.sessions),
        n_completed=int((filtered.sessions["status"] == "completed").sum()),
        n_not_valid=n_not_valid(filtered.sessions),
        n_running=int((filtered.visible["status"] == "active").sum()),
        avatar=sorted(set(filtered.sessions["avatar"])),
        filter=chosen,
        choices=_choices(material),
        figures=[_view(drawing, chosen.body) for drawing in drawings_of(material, chosen, group)],
    )


def drawings_of(
    material: Material,
    chosen: FigureFilter = NO_FILTER,
    group: FigureGroup | None = None,
    *,
    figure: str | None = None,
) -> Iterator[Drawing]:
    """Yield the figures of one or of all groups, each marked with what the filter selected.

    `figure` limits them to those that are drawn together with the figure of this key.
    """
    chosen = material.with_body(chosen)
    prefix = TITLE_PREFIX[material.kind]
    blinded = BLINDED_NOTE if material.blinded else ""
    # Filtered by body first: in a blinded study a filter by body must not reveal open sessions.
    every_body = chosen.model_copy(update={"body": None})
    rows = Rows(
        material.chosen(chosen),
        invalid=chosen.rows == "all",
        every_body=material.chosen(every_body) if material.bodies else None,
    )
    # Sessions of an earlier version may have had boxes that the newest one lacks.
    has_boxes = bool(material.protocol.procedure.block.phases) or bool(material.limbs)
    for entry in FIGURES:
        if group not in (None, entry.group) or not (figure is None or entry.may_draw(figure)):
            continue
        for drawing in _explained(entry, rows):
            if drawing.empty is not None and entry.of_boxes and not has_boxes:
                continue
            shown = drawing if chosen.is_all else drawing.among_chosen()
            words = every_body.words() if drawing.every_body else chosen.words()
            yield shown.marked(prefix, f"{words} {blinded}".strip())


def _explained(figure: Figure, rows: Rows) -> Iterator[Drawing]:
    """Yield the drawings of a figure; an empty one says if there are only invalid rows."""
    everything: dict[str, Drawing] | None = None
    for drawing in figure.draw(rows):
        if drawing.empty is not None and not rows.invalid and not rows.filtered.sessions.empty:
            if everything is None:
                everything = {
                    one.key: one for one in figure.draw(Rows(rows.filtered, invalid=True))
                }
            other = everything.get(drawing.key)
            if other is not None and other.empty is None:
                yield replace(drawing, empty=f"{drawing.empty} {NONE_COUNTS}")
                continue
        yield drawing


def _choices(material: Material) -> FilterChoices:
    sessions = material.sessions
    days = sessions["created_at_utc"].dt.date
    return FilterChoices(
        participants=sorted(set(sessions["participant_code"])),
        orders=orders_of(material.protocol),
        limbs=sorted(material.limbs, reverse=True),
        bodies=list(material.bodies),
        first_day=None if sessions.empty else days.min(),
        last_day=None if sessions.empty else days.max(),
    )


def _view(drawing: Drawing, body: str | None) -> FigureView:
    """Return a drawing as a view; where bodies are analysed one at a time, so are its tests."""
    measure = drawing.measure and "_".join(filter(None, (drawing.measure, body)))
    return FigureView(
        key=drawing.key,
        title=drawing.title,
        caption=drawing.caption,
        figure=drawing.as_json(),
        empty=drawing.empty,
        n=drawing.n,
        group=drawing.group,
        wide=drawing.wide,
        measure=measure or None,
    )
