"""Open captures, and retarget them to avatars; runs in the worker process for captures.

The last capture stays open. The process has a memory limit, so that a malicious file fails here
without harming the server.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from app.adapters.captures import Capture, CaptureError, Limits, Reading, read_capture
from app.features.movement.captures.source import Cannot, Source
from app.features.movement.files import stored_files
from app.science.anatomy import Notice
from app.science.retargeting import (
    REFERENCE_JOINT_MAP,
    AvatarError,
    JointMap,
    Retargeted,
    checked_skeleton,
    named_avatar,
    propose_joint_map,
    retarget_motion,
)
from app.science.rig import BodyMotion, RigError, RigMotion

if TYPE_CHECKING:
    from app.science.fitting import Fitted

MapPairs = tuple[tuple[str, str], ...]
"""A joint map as a hashable value."""


@dataclass(frozen=True, eq=False)
class Opened:
    """A capture with its skeleton: its own, a fitted one, or the reason why there is none.

    `notices` say what anatomy does not allow in either skeleton.
    """

    capture: Capture
    skeleton: RigMotion | None
    fitted: "Fitted | None"
    no_skeleton: str | None
    notices: tuple[Notice, ...] = ()

    @property
    def moving(self) -> RigMotion:
        """Return the skeleton's movement; raise Cannot if there is no skeleton."""
        if self.skeleton is None:
            raise Cannot(f"the capture has no skeleton: {self.no_skeleton}")
        return self.skeleton

    @property
    def start_s(self) -> float:
        """Return when the skeleton's movement begins, from the recording's first frame."""
        if self.fitted is None or isinstance(self.capture.motion, RigMotion):
            return 0.0
        motion, first = self.capture.motion, self.fitted.first_frame
        if isinstance(motion, BodyMotion):
            return float(motion.times_s[first] - motion.times_s[0])
        return first / motion.rate_hz


@dataclass(frozen=True)
class Store:
    """The source of file contents: the database's URL, and the largest allowed file size."""

    url: str
    max_bytes: int


_last: dict[Source, Opened] = {}


def open_stored(store: Store, source: Source) -> Opened:
    """Return the capture with these contents, read from the database; raise Cannot."""
    if source in _last:
        return _last[source]
    files = stored_files(store.url, source.hashes)
    if not all(files.values()):
        raise Cannot("the capture was deleted in the meantime", source.name)
    return _open(store.max_bytes, source, files)


def open_files(max_bytes: int, source: Source, paths: Iterable[Path]) -> Opened:
    """Return the capture in these files, in the order of `source.hashes`; raise Cannot."""
    files = {one: path.read_bytes() for one, path in zip(source.hashes, paths, strict=True)}
    return _open(max_bytes, source, files)


def _open(max_bytes: int, source: Source, files: Mapping[str, bytes]) -> Opened:
    _last.clear()
    companions = {}
    if source.companion_name is not None and source.companion_hash is not None:
        companions = {source.companion_name: files[source.companion_hash]}
    reading = Reading(metres_per_unit=source.metres_per_unit, up=source.up, companions=companions)
    try:
        capture = read_capture(
            files[source.hash], name=source.name, reading=reading, limits=Limits(bytes=max_bytes)
        )
    except CaptureError as error:
        raise Cannot(error.reason, source.name, error.line) from None
    opened = _with_skeleton(capture)
    _last[source] = opened
    return opened


def _with_skeleton(capture: Capture) -> Opened:
    if isinstance(capture.motion, RigMotion):
        joint_map = propose_joint_map(capture.motion.rig).joint_map
        motion, notices = checked_skeleton(capture.motion, joint_map)
        return Opened(capture, motion, None, None, (*capture.notices, *notices))
    # Imported here because it is slow to load; the server's process imports this module, too.
    from app.science.fitting import FitError, fit_skeleton

    try:
        fitted = fit_skeleton(capture.motion)
    except FitError as error:
        return Opened(capture, None, None, str(error))
    return Opened(capture, fitted.motion, fitted, None, (*capture.notices, *fitted.notices))


@dataclass(frozen=True)
class Mapped:
    """A stored capture, its conventions and its joint map."""

    store: Store
    source: Source
    joint_map: MapPairs

    @property
    def moving(self) -> RigMotion:
        """Return the skeleton's movement; raise Cannot if there is no skeleton."""
        return open_stored(self.store, self.source).moving


def on_avatar(mapped: Mapped, avatar: str, *, lock_feet: bool) -> Retargeted:
    """Return the movement on the avatar of a stature, such as "165cm"; raise Cannot."""
    return rig_on_avatar(mapped.moving, dict(mapped.joint_map), avatar, lock_feet=lock_feet)


def rig_on_avatar(
    moving: RigMotion, joint_map: JointMap, avatar: str, *, lock_feet: bool
) -> Retargeted:
    """Return any skeleton's movement on the avatar of a stature; raise Cannot."""
    try:
        return retarget_motion(
            moving, joint_map, named_avatar(avatar), REFERENCE_JOINT_MAP, lock=lock_feet
        )
    except (RigError, AvatarError) as error:
        raise Cannot(str(error)) from None
