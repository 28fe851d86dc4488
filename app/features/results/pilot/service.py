"""Order pilots of a study, let their queue follow, and show them."""

from collections.abc import Mapping
from typing import Any, Final, cast

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput, NotFound
from app.features.design.studies import (
    newest_version,
    protocol_of,
    require_open,
    study_by_key,
    used_instrument,
)
from app.features.movement.jobs import JobKind
from app.features.results.pilot.example import example_assumptions
from app.features.results.pilot.folder import NOT_BEGUN
from app.features.results.pilot.order import (
    Kind,
    PilotError,
    PilotOrder,
    most_participants,
    possible_numbers,
    require_numbers,
)
from app.features.results.pilot.pilot_queue import PilotQueue
from app.features.results.pilot.schemas import (
    Avatar,
    NewPilot,
    PhaseFigures,
    PilotDefaults,
    PilotListed,
    PilotProgress,
    PilotView,
    State,
    without_task,
)
from app.models import PilotRow, StudyVersion, new_id
from app.platform.access import Caller, is_blind
from app.platform.config_problems import invalid_config
from app.platform.context import AppContext
from app.protocol import (
    NO_NAMES,
    ConfigError,
    LoadedAssumptions,
    LoadedStudy,
    StudyProtocol,
    compile_plan,
    declared_analysis,
    load_assumptions,
    sequences,
)
from app.resources import study_configs_dir
from app.science.instruments import Instrument

PILOTS: Final = JobKind(
    table=PilotRow,
    noun="pilot",
    running="simulating",
    action="study.pilot",
    subject="pilot",
    details=lambda row: {"kind": row.kind, "study": row.options["study"]},
)
_PARTICIPANTS: Final = 12
_SHARE_OF_ACTIVE_TIME: Final[Mapping[Avatar, float]] = {
    "physics": 24.0 / 360.0,
    "physics_without_fingers": 12.0 / 360.0,
    "delayed_copy": 5.0 / 360.0,
}
"""Processor time for each second of tasks, as measured on one core (docs/benchmarks.md, pilot)."""


def pilot_defaults(db: Session, study_key: str, caller: Caller) -> PilotDefaults:
    """Return what a pilot of the study's newest version starts with; raise NotFound.

    An example of assumptions names the conditions, which a blinded study shows to nobody here.
    """
    version = newest_version(db, study_by_key(db, study_key))
    protocol = protocol_of(version)
    shipped, trouble, planned = _shipped_assumptions(study_key), None, _PARTICIPANTS
    if shipped is not None:
        try:
            loaded = _loaded(db, version, shipped)
            declared = declared_analysis(protocol, loaded.assumptions)
            planned = planned if declared is None else declared.planned_n
        except InvalidInput as error:
            trouble = error.message
    elif protocol.preregistration is not None:
        planned = protocol.preregistration.planned_n
    return PilotDefaults(
        version=version.number,
        avatar=_avatar_of(protocol),
        participants=_PARTICIPANTS,
        numbers=list(possible_numbers(protocol, planned)),
        most_participants=most_participants(protocol),
        assumptions=shipped,
        assumptions_trouble=trouble,
        example=None
        if is_blind(db, caller, protocol, None)
        else example_assumptions(protocol, _instruments(db, version)),
        person_s=_person_s(protocol),
    )


def _person_s(protocol: StudyProtocol) -> dict[Avatar, float]:
    """Return roughly the processor time that one person takes, by avatar."""
    plan = compile_plan(protocol, sequences(protocol)[0])
    active_s = sum(step.duration_s or 0.0 for step in plan if step.kind == "task")
    return {kind: active_s * share for kind, share in _SHARE_OF_ACTIVE_TIME.items()}


def pilot_list(db: Session, context: AppContext, study_key: str) -> list[PilotListed]:
    """Return the pilots of a study, newest first; raise NotFound."""
    study = study_by_key(db, study_key)
    rows = db.execute(
        select(PilotRow, StudyVersion)
        .join(StudyVersion, StudyVersion.id == PilotRow.study_version_id)
        .where(PilotRow.study_id == study.id)
        .order_by(PilotRow.at.desc(), PilotRow.id)
    )
    return [_listed(row, version, context) for row, version in rows]


def pilot_view(db: Session, context: AppContext, study_key: str, pilot_id: str) -> PilotView:
    """Return one pilot with its figures; raise NotFound."""
    row = pilot_of(db, study_key, pilot_id)
    summary = row.summary or {}
    report, curve = summary.get("report"), summary.get("curve")
    # Earlier releases stored texts in English only, and no names.
    ethics = None if report is None else report.get("ethics") or report["paragraphs"]["ethics"]
    figures = None
    if report is not None:
        phases = [PhaseFigures(**one) for one in report["phases"]]
        added = {"without_task": without_task(phases), "ethics": _by_language(ethics)}
        figures = {**report, **added}
    power = None if curve is None else {"names": NO_NAMES, **curve}
    return PilotView.model_validate(
        {
            **_listed(row, db.get_one(StudyVersion, row.study_version_id), context).model_dump(),
            "figures": figures,
            "power": power,
            "preregistration": _by_language(summary.get("preregistration")),
            "processor_s": summary.get("processor_s"),
        }
    )


def _by_language(text: dict[str, str] | str | None) -> dict[str, str] | None:
    return {"en": text} if isinstance(text, str) else text


def pilot_of(db: Session, study_key: str, pilot_id: str) -> PilotRow:
    """Return a pilot of this study; raise NotFound if there is none."""
    study = study_by_key(db, study_key)
    row = PILOTS.by_id(db, pilot_id)
    if row.study_id != study.id:
        raise NotFound(
            "the study has no such pilot",
            value=pilot_id,
            remedy="Open one from the study's list of pilots; it may have been deleted.",
        )
    return row


def pilot_record(db: Session, study_key: str, pilot_id: str) -> tuple[PilotRow, str]:
    """Return a finished pilot with its record; raise NotFound, or NotNow if it is not ready."""
    pilot_of(db, study_key, pilot_id)
    row = PILOTS.ready(db, pilot_id)
    db.refresh(row, ["record"])
    return row, row.record or ""


def check_order(db: Session, study_key: str, request: NewPilot) -> None:
    """Check what an order asks for and assumes, against the newest version of the study.

    Call this before the transaction that stores the order: to explain every problem of a large file
    of assumptions takes seconds, in which nobody else could write.

    Raises NotFound, InvalidConfig for a faulty file, or InvalidInput for numbers that the study
    does not allow, or if neither the study nor the file names a test.
    """
    version = newest_version(db, study_by_key(db, study_key))
    protocol = protocol_of(version)
    if request.kind == "power":
        _numbers(protocol, request.participants)
    if request.assumptions is not None:
        _require_declared(protocol, _loaded(db, version, request.assumptions))


def order_pilot(
    db: Session, context: AppContext, caller: Caller, study_key: str, request: NewPilot
) -> str:
    """Store an order that was checked; return its id. `follow_pilot` starts it after the commit.

    Raises NotFound, NotNow if the study is archived, InvalidInput for numbers that the study does
    not allow, Conflict if there is the same pilot already, or Busy if too many are unfinished.
    """
    study = study_by_key(db, study_key)
    require_open(study)
    version = newest_version(db, study)
    protocol = protocol_of(version)
    options = request.model_dump(mode="json", exclude={"kind", "assumptions"})
    # The audit trail names the study, also of a pilot that is deleted with everything in it.
    options["study"] = study_key
    if request.kind == "power":
        options["participants"] = list(_numbers(protocol, request.participants))
    else:
        options["avatar"] = request.avatar or _avatar_of(protocol)
    row = PilotRow(
        id=new_id(),
        study_id=study.id,
        study_version_id=version.id,
        kind=request.kind,
        options=options,
        # A line end more or less makes no other pilot.
        assumptions=request.assumptions and request.assumptions.rstrip() + "\n",
        state="simulating",
        by=caller.actor,
        at=context.clock.utc_now(),
    )
    _require_new(db, row)
    PILOTS.order(db, context, caller, row)
    return row.id


def follow_pilot(context: AppContext, study_key: str, pilot_id: str) -> PilotView:
    """Start, keep or end the work on a pilot as its committed state says, and return it."""
    context.part(PilotQueue).follow(pilot_id, _order_of)
    with context.database.reading() as db:
        return pilot_view(db, context, study_key, pilot_id)


def _order_of(db: Session, pilot_id: str) -> PilotOrder:
    row = PILOTS.by_id(db, pilot_id)
    version = db.get_one(StudyVersion, row.study_version_id)
    study = LoadedStudy(protocol_of(version), version.content_hash, version.canonical_json)
    return PilotOrder(
        cast("Kind", row.kind), study, _instruments(db, version), row.options, row.assumptions
    )


def _instruments(db: Session, version: StudyVersion) -> Mapping[str, Instrument]:
    return {key: used_instrument(db, version.id, key).instrument for key in version.instruments}


def _loaded(db: Session, version: StudyVersion, text: str) -> LoadedAssumptions:
    try:
        return load_assumptions(text, protocol_of(version), _instruments(db, version))
    except ConfigError as error:
        raise invalid_config("assumptions", error) from error


def _shipped_assumptions(study_key: str) -> str | None:
    file = study_configs_dir() / "assumptions" / f"{study_key}.yaml"
    return file.read_text(encoding="utf-8") if file.is_file() else None


def _avatar_of(protocol: StudyProtocol) -> Avatar:
    return "physics" if protocol.avatar == "physics" else "delayed_copy"


def _numbers(protocol: StudyProtocol, participants: list[int]) -> tuple[int, ...]:
    try:
        return require_numbers(protocol, participants)
    except PilotError as error:
        raise InvalidInput(
            str(error),
            value=participants,
            valid=most_participants(protocol),
            remedy="Change the numbers of participants; nothing was started.",
        ) from error


def _require_declared(protocol: StudyProtocol, loaded: LoadedAssumptions) -> None:
    if declared_analysis(protocol, loaded.assumptions) is None:
        raise InvalidInput(
            f"the study {protocol.key!r} declares no test, and the assumptions name none",
            value=protocol.key,
            valid="a preregistered test, or the key preregistration in the assumptions",
            remedy="Declare a test in a new version of the study, or add preregistration to the "
            "assumptions.",
        )


def _require_new(db: Session, row: PilotRow) -> None:
    """Raise Conflict if there is a pilot with the same order: it would have the same bytes."""
    same = select(PilotRow).where(
        PilotRow.study_version_id == row.study_version_id, PilotRow.kind == row.kind
    )
    for other in db.scalars(same):
        if (other.options, other.assumptions) == (row.options, row.assumptions):
            raise Conflict(
                f"there is this very pilot already, and it is {other.state}",
                value=other.id,
                remedy="The same order gives the same figures, to the last digit. Open that one, "
                "resume it if it has stopped, or choose another seed.",
            )


def _listed(row: PilotRow, version: StudyVersion, context: AppContext) -> PilotListed:
    report: Mapping[str, Any] = (row.summary or {}).get("report") or {}
    participants = row.options["participants"]
    return PilotListed(
        id=row.id,
        kind=cast("Kind", row.kind),
        version=version.number,
        content_hash=version.content_hash,
        participants=participants if isinstance(participants, list) else [participants],
        seed=row.options["seed"],
        avatar=row.options.get("avatar"),
        sets=row.options.get("sets"),
        state=cast("State", row.state),
        progress=_progress(row, context),
        trouble=row.trouble,
        session_min=report.get("session_min"),
        walk_back_min=report.get("walk_back_min"),
        by=row.by,
        at=row.at,
        ended_at=row.ended_at,
    )


def _progress(row: PilotRow, context: AppContext) -> PilotProgress | None:
    """Return how far a pilot is that is not ready."""
    if row.state == "ready":
        return None
    queue = context.part(PilotQueue)
    files, place = queue.files(row.id), queue.place_of(row.id)
    told = files.progress() or NOT_BEGUN
    runs = row.state == "simulating"
    has_process = place == "started"
    return PilotProgress(
        waiting=runs and not has_process,
        held=runs and has_process and files.is_held,
        stage=told.stage,
        done=told.done,
        total=told.total,
        remaining_s=told.remaining_s if runs else None,
    )
