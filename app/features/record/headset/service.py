"""Build what the server sends to a headset: the welcome message and the state of the session.

The state is declarative, and the headset converges to it; no list of past commands is ever sent.
"""

from datetime import datetime

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.database import referenced_row
from app.errors import Conflict
from app.features.design.studies import protocol_of
from app.features.movement.avatar import configuration_by_hash
from app.features.movement.humanoids import named_bodies
from app.features.record.alarms import Change, Condition, store_change
from app.features.record.doubts import OBSERVED
from app.features.record.headset.panels import panel_order
from app.features.record.questionnaires import answers_of
from app.features.record.sessions import (
    AvatarInForce,
    SessionState,
    avatar_in_force,
    content_body,
    contents_of,
    plan_of,
    reached_active_s,
    require_capture,
    state_of,
)
from app.features.record.telemetry import (
    abilities_of,
    assign_epoch,
    is_assigned_epoch,
    positions_of,
)
from app.models import Completion, StudySession, StudyVersion, Submission
from app.platform.access import session_by_id
from app.protocol import Step
from app.science.avatar.configuration import RunningSettings
from app.texts import chosen
from app.wire import (
    PROTOCOL_VERSION,
    AvatarOrder,
    CalibrationOrder,
    HeadsetState,
    Hello,
    LayerOrder,
    MotorOrder,
    ParticipantInfo,
    PhaseOrder,
    Welcome,
)

CENTIMETRES_PER_METRE = 100.0
_OF_ROAD = {"road", "kerb_height_m", "starts_behind_kerb_m", "step_s"}
"""What a headset needs to know of a study's road; its traffic comes as it drives."""


def worn_humanoid(db: Session, session: StudySession, body: str | None) -> str | None:
    """Return the hash of the model that an avatar wears, None if it has none.

    `body` is the name that the condition prescribes; for None the avatar's configuration decides.
    """
    if body is not None:
        return named_bodies(db).get(body)
    if session.avatar_configuration_hash is None:
        return None
    return configuration_by_hash(db, session.avatar_configuration_hash).humanoid


def welcome(db: Session, session_id: str, hello: Hello, now: datetime) -> Welcome:
    """Return the answer to a hello message; a client without an epoch is assigned the next one.

    Raises Conflict if the client cannot show the session's avatar, or cannot change it although the
    study does or an operator has.
    """
    session = session_by_id(db, session_id, lock=True)
    require_capture(db, session_id)
    _require_avatar(session, hello)
    _require_changes(db, session, hello)
    protocol = protocol_of(referenced_row(db, StudyVersion, session.study_version_id))
    if hello.epoch is not None and not is_assigned_epoch(db, session_id, hello.epoch):
        message = f"a headset claims epoch {hello.epoch}, which the server did not assign"
        record_impossible(db, session_id, message, now)
    _record_other_abilities(db, session_id, hello, now)
    return Welcome(
        protocol=PROTOCOL_VERSION,
        session_id=session.id,
        epoch=hello.epoch or assign_epoch(db, session_id, now, abilities=hello.abilities),
        time_scale=session.time_scale,
        language=session.language,
        avatar=session.avatar,
        on_disconnect=protocol.on_disconnect,
        undelayed_parts=protocol.latency.undelayed_parts,
        tasks=protocol.tasks.model_dump(mode="json"),
        texts={key: chosen(text, session.language) for key, text in protocol.texts.items()},
        positions=positions_of(db, session_id),
        state=headset_state(db, session, abilities=hello.abilities),
        bodies=protocol.bodies,
        appearance=protocol.appearance.model_dump(mode="json"),
        road={}
        if protocol.road is None
        else protocol.road.model_dump(mode="json", include=_OF_ROAD),
    )


def _record_other_abilities(db: Session, session_id: str, hello: Hello, now: datetime) -> None:
    """Record if a run that reconnects can do something else than it said before.

    What a run records follows from what it can do, so this cannot be the same run.
    """
    before = None if hello.epoch is None else abilities_of(db, session_id).get(hello.epoch)
    if before is None or before == hello.abilities:
        return
    lost = ", ".join(sorted(before - hello.abilities)) or "nothing"
    gained = ", ".join(sorted(hello.abilities - before)) or "nothing"
    message = (
        f"the headset of epoch {hello.epoch} came back with other abilities: without {lost}, with"
        f" {gained} that it did not have"
    )
    record_impossible(db, session_id, message, now)


def record_impossible(db: Session, session_id: str, message: str, now: datetime) -> None:
    """Record that a headset has sent something impossible, which puts the session in doubt."""
    store_change(db, session_id, Change("raised", Condition(OBSERVED, message), now))


def _require_avatar(session: StudySession, hello: Hello) -> None:
    if session.avatar not in hello.avatars:
        raise Conflict(
            f"{hello.client} cannot show the avatar {session.avatar!r} of this session",
            value=session.avatar,
            valid=list(hello.avatars),
            remedy="Use a client that can, or a version of the study with another avatar.",
        )


def _require_changes(db: Session, session: StudySession, hello: Hello) -> None:
    """Raise Conflict if the study or an operator changes the avatar and the client cannot do so."""
    if hello.changes_avatar or session.avatar_configuration_hash is None:
        return
    changing = [step.key for step in plan_of(db, session) if step.avatar_changes is not None]
    if changing:
        raise Conflict(
            f"{hello.client} cannot change the avatar while it runs, as this study does in "
            f"{changing[0]}",
            value={"changes_avatar": False},
            valid={"changes_avatar": True},
            remedy="Use a client that can, or a version of the study without avatar_changes.",
        )
    in_force = avatar_in_force(db, session)
    if in_force is not None and in_force.settings != in_force.configured:
        raise Conflict(
            f"{hello.client} cannot change the avatar while it runs, and an operator has changed "
            "the avatar of this session",
            value={"changes_avatar": False},
            valid={"changes_avatar": True},
            remedy="Use a client that can, or let an operator take the change back.",
        )


def headset_state(
    db: Session, session: StudySession, *, abilities: frozenset[str] = frozenset()
) -> HeadsetState:
    """Return the state of a session as sent to its headset.

    `abilities`: what the headset's client can do, by the names of its hello. Changes of the avatar,
    panels and calibrations are sent to clients that can carry them out only: those of earlier
    releases do not know the fields, and accept no unknown ones.
    """
    state, plan = state_of(session), plan_of(db, session)
    step = None if state.current is None else plan[state.current]
    active = state.status == "active"
    changes_avatar = active and "changes_avatar" in abilities
    in_force = avatar_in_force(db, session) if changes_avatar else None
    return HeadsetState(
        version=session.version,
        status=str(state.status),
        step_index=state.current,
        step_kind=None if step is None else step.kind,
        materialised=state.materialised,
        recording=is_recording(state, step),
        phase=_phase_order(db, session, state, plan),
        participant=participant_info(db, session),
        avatar_changes=_avatar_order(in_force),
        panel=panel_order(db, session, state, step) if "panels" in abilities else None,
        calibration=_calibration_order(state) if "calibrates" in abilities else None,
    )


def _calibration_order(state: SessionState) -> CalibrationOrder | None:
    """Return what the operator ordered of the calibration; None if nothing, or if it is over."""
    ordered = state.calibration
    if ordered is None:
        return None
    return CalibrationOrder(
        revision=ordered.revision,
        calibrate=ordered.wanted,
        shifts_m=ordered.shifts_m,
    )


def _avatar_order(in_force: AvatarInForce | None) -> AvatarOrder | None:
    """Return how the avatar differs from its configuration, as sent to the headset.

    An axis that a cast holds where it was is sent with the angle that the headset has reported
    since, so that a restarted headset holds it there, too.
    """
    if in_force is None:
        return None
    configured, settings = in_force.configured, in_force.settings
    return AvatarOrder(
        revision=in_force.revision,
        gravity=_if_changed(configured.gravity, settings.gravity),
        self_collision=_if_changed(configured.self_collision, settings.self_collision),
        colliders={
            part: kind
            for part, kind in settings.colliders.items()
            if kind != configured.colliders[part]
        },
        layers=_layer_orders(configured, settings),
        held_rad={
            axis: in_force.held_rad.get(axis) if angle is None else angle
            for axis, angle in settings.held_rad.items()
        },
        motors={
            axis: MotorOrder(
                kp_nm_per_rad=motor.kp,
                kd_nm_s_per_rad=motor.kd,
                max_torque_nm=motor.max_torque_nm,
            )
            for axis, motor in settings.axes.items()
            if motor != configured.axes[axis]
        },
    )


def _if_changed(configured: bool, now: bool) -> bool | None:  # noqa: FBT001 - two of a kind
    return None if configured == now else now


def _layer_orders(configured: RunningSettings, settings: RunningSettings) -> tuple[LayerOrder, ...]:
    pairs = sorted(sorted(pair) for pair in configured.layers ^ settings.layers)
    return tuple(
        LayerOrder(layers=(first, second), collide=frozenset((first, second)) in settings.layers)
        for first, second in pairs
    )


def is_recording(state: SessionState, step: Step | None) -> bool:
    """Return whether movement is recorded: from entering the body until the debriefing.

    Nothing is recorded while the participant refuses to take part.
    """
    is_over = step is not None and not step.spec.records_movement
    is_active = state.status == "active" and state.materialised
    return is_active and state.refused_consent is None and not is_over


def participant_info(db: Session, session: StudySession) -> ParticipantInfo:
    """Return the participant's handedness, footedness and height, as far as they are known.

    A matched height takes precedence over a stated one.
    """
    answers = _demographics(db, session)
    stature_m = None
    stated_cm = answers.get("height_cm")
    if isinstance(stated_cm, float):
        stature_m = stated_cm / CENTIMETRES_PER_METRE
    for row in contents_of(db, session.id, "height"):
        body = content_body(row)
        if isinstance(body, dict):
            stature_m = body.get("matched") or body.get("stated") or stature_m
    return ParticipantInfo(
        handedness=_text(answers.get("handedness")),
        footedness=_text(answers.get("footedness")),
        stature_m=stature_m,
    )


def _demographics(db: Session, session: StudySession) -> dict[str, str | float | None]:
    newest = db.scalar(
        select(Submission.id)
        .where(Submission.session_id == session.id, Submission.instrument == "demographics")
        .order_by(Submission.submitted_at.desc())
        .limit(1)
    )
    return {} if newest is None else answers_of(db, newest)


def _text(value: str | float | None) -> str | None:
    return value if isinstance(value, str) else None


def _phase_order(
    db: Session, session: StudySession, state: SessionState, plan: tuple[Step, ...]
) -> PhaseOrder | None:
    phase = state.phase
    if phase is None or state.status != "active":
        return None
    step = plan[phase.step]
    completions = db.scalar(
        select(func.count())
        .select_from(Completion)
        .where(Completion.session_id == session.id, Completion.phase_id == phase.phase_id)
    )
    return PhaseOrder(
        phase_id=phase.phase_id,
        kind=step.kind,
        limb=step.limb,
        status=str(phase.status),
        latency_ms=step.latency_ms or 0.0,
        preparation_s=step.preparation_s or 0.0,
        duration_s=step.duration_s or 0.0,
        freeze_s=step.freeze_s or 0.0,
        # A headset that takes over in mid-phase resumes here, even if the loss of the other is
        # unnoticed.
        active_s=reached_active_s(db, session.id, plan, state) or 0.0,
        completions=completions or 0,
        pausing=phase.pausing,
        resuming=phase.resuming,
        until_completions=step.until_completions,
        has_road=step.spec.has_road,
        body=step.body,
    )
