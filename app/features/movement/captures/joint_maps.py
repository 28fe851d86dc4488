"""Joint maps of skeletons: proposed from names and hierarchy, edited by hand, stored as versions.

A saved map applies to all captures with the same skeleton. Resetting to the proposal is a version,
too, so that a better proposal of a later release is used.
"""

from dataclasses import dataclass

import numpy as np
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput, StaleVersion
from app.features.movement.captures.opening import Mapped
from app.features.movement.captures.schemas import (
    CaptureSummary,
    JointMapView,
    JointMapWish,
    JointSource,
    SkeletonView,
)
from app.features.movement.captures.service import capture_by_id, store_of
from app.features.movement.captures.source import source_of
from app.features.people.audit import record
from app.models import CaptureRow, SavedJointMap
from app.platform.access import Caller
from app.platform.context import AppContext
from app.science.retargeting import (
    JointMapError,
    Proposal,
    check_joint_map,
    propose_joint_map,
    unmapped_body_joints,
    unmapped_rig_joints,
)
from app.science.rig import Rig
from app.science.rotations import identity
from app.science.skeleton import JOINT_NAMES


@dataclass(frozen=True)
class CurrentMap:
    """The current map of a skeleton: the newest saved version, else the proposal."""

    rig: Rig
    proposal: Proposal
    saved: SavedJointMap | None

    @property
    def chosen(self) -> bool:
        """Return whether a person chose the map."""
        return self.saved is not None and self.saved.chosen

    @property
    def joint_map(self) -> dict[str, str]:
        """Return the map from body joints to joints of the skeleton, in the order of the body's."""
        chosen = self.saved.joint_map if self.saved is not None and self.saved.chosen else None
        mapping = dict(self.proposal.joint_map) if chosen is None else chosen
        return {joint: str(mapping[joint]) for joint in JOINT_NAMES if joint in mapping}

    @property
    def problems(self) -> tuple[tuple[str, str], ...]:
        """Return each (body joint, problem) that makes the map unusable."""
        try:
            check_joint_map(self.rig, self.joint_map)
        except JointMapError as error:
            return error.problems
        return ()


def current_map(db: Session, capture: CaptureRow) -> CurrentMap:
    """Return the joint map of the capture's skeleton; raise Conflict if it has no skeleton."""
    summary = CaptureSummary.model_validate(capture.summary)
    if summary.skeleton is None:
        raise Conflict(
            f"the capture has no skeleton: {summary.no_skeleton}",
            value=capture.id,
            remedy="Use a capture that has one, or record markers that show the whole body.",
        )
    return map_of_rig(db, _rig(summary.skeleton))


def map_of_rig(db: Session, rig: Rig) -> CurrentMap:
    """Return the joint map of any skeleton, stored or live; only names and hierarchy matter."""
    newest = (
        select(SavedJointMap)
        .where(SavedJointMap.fingerprint == rig.fingerprint)
        .order_by(SavedJointMap.version.desc())
        .limit(1)
    )
    return CurrentMap(rig, propose_joint_map(rig), db.scalars(newest).first())


def mapped_capture(context: AppContext, capture_id: str) -> Mapped:
    """Return a capture that can be retargeted; raise NotFound, or Conflict if it cannot."""
    with context.database.reading() as db:
        row = capture_by_id(db, capture_id)
        current = current_map(db, row)
        if current.problems:
            raise Conflict(
                "the joint map of this skeleton cannot be used yet",
                value=row.title,
                remedy="Complete the joint map, then try again.",
                details=[
                    {"path": joint, "message": problem} for joint, problem in current.problems
                ],
            )
        return Mapped(store_of(context), source_of(row), tuple(current.joint_map.items()))


def joint_map_view(db: Session, capture_id: str) -> JointMapView:
    """Return the map as a response model; raise NotFound or Conflict."""
    current = current_map(db, capture_by_id(db, capture_id))
    joint_map, saved = current.joint_map, current.saved
    sources: dict[str, JointSource] = (
        dict.fromkeys(joint_map, "chosen") if current.chosen else dict(current.proposal.sources)
    )
    users = select(func.count()).where(CaptureRow.fingerprint == current.rig.fingerprint)
    return JointMapView(
        fingerprint=current.rig.fingerprint,
        version=0 if saved is None else saved.version,
        chosen=current.chosen,
        by=None if saved is None else saved.by,
        at=None if saved is None else saved.at,
        joint_map=joint_map,
        proposal=dict(current.proposal.joint_map),
        sources=sources,
        body_joints=list(JOINT_NAMES),
        rig_joints=list(current.rig.names),
        rig_parents=list(current.rig.parents),
        unmapped_body_joints=list(unmapped_body_joints(joint_map)),
        unmapped_rig_joints=list(unmapped_rig_joints(current.rig, joint_map)),
        usable=not current.problems,
        missing=[f"{joint}: {problem}" for joint, problem in current.problems],
        captures=db.scalars(users).one(),
    )


def save_map(
    db: Session, context: AppContext, caller: Caller, capture_id: str, request: JointMapWish
) -> None:
    """Save a map as a new version.

    Raises InvalidInput with every problem of the map, StaleVersion if somebody saved one meanwhile,
    NotFound, Conflict.
    """
    capture = capture_by_id(db, capture_id)
    current = current_map(db, capture)
    try:
        check_joint_map(current.rig, request.joint_map)
    except JointMapError as error:
        raise InvalidInput(
            "the joint map does not fit the skeleton",
            value=request.joint_map,
            valid={"body_joints": JOINT_NAMES, "joints": current.rig.names},
            remedy="Correct the joints named below; nothing was saved.",
            details=[{"path": joint, "message": problem} for joint, problem in error.problems],
        ) from None
    _append(db, context, caller, capture, current, request, action="capture.mapped")


def reset_map(
    db: Session, context: AppContext, caller: Caller, capture_id: str, version: int
) -> None:
    """Reset the map to the proposal, as a new version; raise StaleVersion, NotFound or Conflict."""
    capture = capture_by_id(db, capture_id)
    proposed = JointMapWish(joint_map={}, version=version)
    current = current_map(db, capture)
    _append(db, context, caller, capture, current, proposed, action="capture.unmapped")


def _append(
    db: Session,
    context: AppContext,
    caller: Caller,
    capture: CaptureRow,
    current: CurrentMap,
    request: JointMapWish,
    *,
    action: str,
) -> None:
    newest = 0 if current.saved is None else current.saved.version
    if request.version != newest:
        raise StaleVersion(
            "somebody else has changed the joint map of this skeleton in the meantime",
            value=request.version,
            valid=newest,
            remedy="Look at its current state, then decide.",
        )
    now = context.clock.utc_now()
    fingerprint = current.rig.fingerprint
    db.add(
        SavedJointMap(
            fingerprint=fingerprint,
            version=newest + 1,
            # A map without the hips cannot be saved, so an empty one means the proposal.
            chosen=bool(request.joint_map),
            joint_map=request.joint_map,
            by=caller.actor,
            at=now,
        )
    )
    db.flush()
    record(
        db,
        actor=caller.actor,
        action=action,
        subject=f"capture:{capture.id}",
        details={"skeleton": fingerprint[:12], "version": newest + 1},
        now=now,
    )


def _rig(skeleton: SkeletonView) -> Rig:
    """Return a rig with only names and hierarchy, which is all that a map needs."""
    count = len(skeleton.joints)
    return Rig(
        names=tuple(skeleton.joints),
        parents=tuple(skeleton.parents),
        offsets_m=np.zeros((count, 3)),
        rest_rotations=identity(count),
    )
