"""Performers and recordings as responses."""

from functools import lru_cache

import numpy as np
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.features.movement.captures import map_of_rig
from app.features.movement.live import SILENT_S
from app.features.movement.performers.performer import Performer
from app.features.movement.performers.recording import Recording
from app.features.movement.performers.schemas import (
    BodyState,
    PerformersView,
    PerformerView,
    RecordingView,
)
from app.features.movement.performers.service import Performers
from app.models import SavedJointMap
from app.science.retargeting import JointMap, JointMapError, check_joint_map, propose_joint_map
from app.science.rig import Rig
from app.science.rotations import identity

LISTED = 8
"""The most bones that are missing or wrong which a response lists."""


def performers_view(db: Session, performers: Performers) -> PerformersView:
    """Return everything about performers that the page shows."""
    return PerformersView(
        performers=[_performer(db, performers, one) for one in performers.all()],
        recordings=[recording_view(one) for one in performers.recordings()],
    )


def joint_map_of(db: Session, rig: Rig) -> tuple[JointMap, tuple[str, ...]]:
    """Return the joint map of a live skeleton, and what makes it unusable.

    A map that somebody saved for captures of this skeleton is used for it live, too.
    """
    saved = select(func.count()).where(SavedJointMap.fingerprint == rig.fingerprint)
    if db.scalar(saved):
        current = map_of_rig(db, rig)
        return current.joint_map, tuple(f"{at}: {problem}" for at, problem in current.problems)
    return _proposed(rig.names, rig.parents)


def body_state(
    performer: Performer | None, others: tuple[str, ...], problems: tuple[str, ...], now_s: float
) -> BodyState:
    """Return why a body that a performer shall move does, or does not.

    `others` are other senders of the performer's name, `problems` those of the joint map.
    """
    if performer is None:
        return BodyState(state="absent")
    told = {"address": performer.address, "others": list(others)}
    if performer.newest is None:
        missing = list(performer.missing[:LISTED])
        return BodyState(state="gathering", missing=missing, **told)
    if problems:
        return BodyState(state="unusable", problems=list(problems[:LISTED]), **told)
    if now_s - performer.last_s > SILENT_S:
        return BodyState(state="silent", **told)
    return BodyState(state="ready", **told)


@lru_cache(maxsize=64)
def _proposed(names: tuple[str, ...], parents: tuple[int, ...]) -> tuple[JointMap, tuple[str, ...]]:
    # Only names and hierarchy matter for a map.
    rig = Rig(names, parents, np.zeros((len(names), 3)), identity(len(names)))
    joint_map = propose_joint_map(rig).joint_map
    try:
        check_joint_map(rig, joint_map)
    except JointMapError as error:
        return joint_map, tuple(f"{joint}: {problem}" for joint, problem in error.problems)
    if joint_map.keys() == {"Hips"}:
        # The body would glide about in its T-pose.
        named = ", ".join(names[:LISTED])
        return joint_map, (
            f"of its bones ({named}) only the hips are known: name them by the body",
        )
    return joint_map, ()


def recording_view(one: Recording) -> RecordingView:
    """Return a recording as a response."""
    return RecordingView(
        id=one.id,
        door=one.name.door,
        source=one.name.source,
        skeleton=one.name.skeleton,
        by=one.by,
        since=one.since,
        state=one.state,
        duration_s=one.duration_s,
        frames=one.frames,
        limit_s=one.limit_s,
    )


def _performer(db: Session, performers: Performers, one: Performer) -> PerformerView:
    now_s = performers.now_s()
    used, others = performers.used(one.name)
    agreed = one.agreed
    problems: tuple[str, ...] = ()
    if agreed is not None:
        _, problems = joint_map_of(db, agreed.rig)
    missing = one.missing
    return PerformerView(
        door=one.name.door,
        source=one.name.source,
        address=one.address,
        skeleton=one.name.skeleton,
        bones=len(missing) if agreed is None else agreed.rig.joint_count,
        rate_hz=performers.rate_hz(one),
        silent_s=now_s - one.last_s,
        is_silent=now_s - one.last_s > SILENT_S,
        state="gathering" if agreed is None else "unusable" if problems else "ready",
        missing=list(missing[:LISTED]),
        problems=list(problems[:LISTED]),
        in_parent=None if agreed is None else agreed.skeleton.in_parent,
        is_t_pose_shown=agreed is not None and agreed.is_t_pose_shown,
        is_used=used is one,
        others=list(others) if used is one else [],
    )
