"""Work on a study file that is not stored yet: templates, checks, edits and dry runs."""

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

from sqlalchemy.orm import Session

from app.errors import InvalidInput
from app.features.design.instruments import parsed_instruments
from app.features.design.studies.schemas import (
    ChangeRequest,
    CheckResult,
    EstimateRule,
    StudyFigures,
    TemplateView,
    TimelineRequest,
    TimelineStep,
    TimelineView,
)
from app.features.design.studies.service import check_study
from app.features.movement.avatar import configurations, newest_numbers
from app.features.movement.humanoids import named_bodies
from app.platform.config_problems import invalid_config, problem_views
from app.protocol import (
    BY_HAND_S,
    ITEM_S,
    OPENING_S,
    READING_WORDS_PER_S,
    ConfigError,
    LedgerRow,
    Plain,
    StudyProtocol,
    TimedStep,
    compile_plan,
    ledger_block,
    load_study,
    path_text,
    planned_s,
    read_source,
    sequences,
    timeline,
    total_s,
    visit_time,
)
from app.protocol.editing import Change, edit_text
from app.resources import study_configs_dir

RULE = EstimateRule(
    reading_words_per_s=READING_WORDS_PER_S,
    opening_s=OPENING_S,
    by_hand_s=BY_HAND_S,
    item_s=ITEM_S,
)


def template_files() -> tuple[Path, ...]:
    """Return the shipped studies, followed by the templates from the smallest to the largest."""
    root = study_configs_dir()
    templates = sorted((root / "templates").glob("*.yaml"), key=lambda file: file.stat().st_size)
    return (*sorted(root.glob("*.yaml")), *templates)


@lru_cache(maxsize=1)
def templates() -> tuple[TemplateView, ...]:
    """Return each template with its title in all its languages."""
    return tuple(_view(file) for file in template_files())


def _view(file: Path) -> TemplateView:
    text = file.read_text(encoding="utf-8")
    tree = read_source(text).tree
    assert isinstance(tree, dict)  # noqa: S101 - a test loads every one of them
    return TemplateView(
        key=file.stem,
        title=_texts(tree.get("title")),
        description=_texts(tree.get("description")),
        needs_feet=_has_foot_task(tree),
        yaml=text,
    )


def _has_foot_task(tree: Plain) -> bool:
    """Return whether any part of a study's file is done with the feet."""
    if isinstance(tree, dict):
        return tree.get("limb") == "foot" or any(map(_has_foot_task, tree.values()))
    return isinstance(tree, list) and any(map(_has_foot_task, tree))


def _texts(value: Plain) -> dict[str, str]:
    return {key: str(words) for key, words in value.items()} if isinstance(value, dict) else {}


def check(db: Session, text: str) -> CheckResult:
    """Return every problem of a file, or a summary of a valid study.

    The result has the file's values whenever the file can be parsed.
    """
    instruments = parsed_instruments(db)
    tree, lines = _tree(text)
    try:
        loaded = load_study(
            text,
            instruments=instruments,
            avatars=newest_numbers(db),
            bodies=named_bodies(db),
            configured=configurations(db),
        )
    except ConfigError as error:
        return CheckResult(ok=False, problems=problem_views(error), tree=tree, lines=lines)
    protocol = loaded.protocol
    orders = sequences(protocol)
    plan = compile_plan(protocol, orders[0])
    visit = visit_time(protocol, instruments)
    return CheckResult(
        ok=True,
        key=protocol.key,
        content_hash=loaded.content_hash,
        design_hash=protocol.design_hash,
        tree=tree,
        lines=lines,
        summary=StudyFigures(
            conditions=len(protocol.conditions),
            orders=len(orders),
            replicates=protocol.orders.replicates,
            slots=len(orders) * protocol.orders.replicates,
            blocks=len(protocol.conditions),
            administrations=sum(step.instrument is not None for step in plan),
            instruments=list(protocol.instrument_keys),
            planned_minutes=visit.planned,
            minutes=visit.total,
        ),
    )


def edit(text: str, changes: Sequence[ChangeRequest]) -> str:
    """Return the text after the changes; raise InvalidConfig if it cannot be parsed or changed."""
    parsed_changes = [Change(tuple(one.path), one.action, one.value, one.to) for one in changes]
    try:
        return edit_text(text, parsed_changes)
    except ConfigError as error:
        raise invalid_config("study", error) from error


def dry_run(db: Session, request: TimelineRequest) -> TimelineView:
    """Return one participant's visit, step by step; raise InvalidConfig or InvalidInput."""
    protocol = check_study(db, request.yaml).protocol
    orders = sequences(protocol)
    slot, row = _row(protocol, orders, request)
    language = (
        request.language if request.language in protocol.languages else (protocol.languages[0])
    )
    plan = compile_plan(protocol, row.sequence, block_limb_flip=slot % 2 == 1)
    bodies = protocol.bodies_of(row.sequence)
    steps = timeline(protocol, plan, parsed_instruments(db), language=language)
    return TimelineView(
        slot=slot,
        slots=len(orders) * protocol.orders.replicates,
        replicate=row.replicate,
        sequence=list(row.sequence),
        latencies_ms=[protocol.condition(key).latency_ms for key in row.sequence],
        bodies=None if bodies is None else list(bodies),
        steps=[_step(protocol, step, language) for step in steps],
        planned_s=planned_s(steps),
        total_s=total_s(steps),
        language=language,
        languages=list(protocol.languages),
        rule=RULE,
    )


def _row(
    protocol: StudyProtocol, orders: Sequence[tuple[str, ...]], request: TimelineRequest
) -> tuple[int, LedgerRow]:
    """Return the requested slot and its ledger row, or the first slot with the requested order."""
    if request.sequence_index is not None:
        if request.sequence_index >= len(orders):
            raise InvalidInput(
                "the study has no such order",
                value=request.sequence_index,
                valid=f"0 to {len(orders) - 1}",
            )
        sequence = orders[request.sequence_index]
        block = ledger_block(protocol, 0)
        return next((at, row) for at, row in enumerate(block) if row.sequence == sequence)
    slot = request.slot or 0
    return slot, ledger_block(protocol, slot // len(orders))[slot % len(orders)]


def _step(protocol: StudyProtocol, timed: TimedStep, language: str) -> TimelineStep:
    step = timed.step
    label = None if step.condition is None else protocol.condition(step.condition).label
    words = None if step.text is None else protocol.texts.get(step.text)
    return TimelineStep(
        index=step.index,
        key=step.key,
        kind=step.kind,
        title=step.title[language],
        block=step.block,
        condition=step.condition,
        condition_label=None if label is None else label[language],
        latency_ms=step.latency_ms,
        limb=step.limb,
        instrument=step.instrument,
        preparation_s=step.preparation_s,
        duration_s=step.duration_s,
        freeze_s=step.freeze_s,
        start_s=timed.start_s,
        length_s=timed.length_s,
        estimated=timed.estimated,
        text=None if words is None else words[language],
        avatar_changes=step.avatar_changes,
    )


def _tree(text: str) -> tuple[dict[str, Plain] | None, dict[str, int]]:
    """Return the values of a file and their lines; nothing if it cannot be parsed."""
    try:
        source = read_source(text)
    except ConfigError:
        return None, {}
    if not isinstance(source.tree, dict):
        return None, {}
    marks = {**source.values, **source.keys}
    return source.tree, {path_text(path): mark.line for path, mark in marks.items()}
