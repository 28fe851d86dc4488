"""Tests of the files of a session's companion: every pose as it was shown, and no tracker's."""

from datetime import timedelta

import numpy as np
import pytest

from app.features.record.companion.frames import ShownFrame
from app.features.record.companion.recording import store_frames
from app.features.record.sessions import Companion
from app.features.results.analysis.codebook import COMPANION_POSE
from app.features.results.exports.writing.contents import Contents
from tests.features.builders import NOW, SessionSpec, build_session
from tests.features.lab import STUDY, Lab

COMPANION = Companion("json", "=mime", "Hips", "170cm", None, "left", (-1.5, 0.0), -1.57)


@pytest.mark.one_engine
def test_the_poses_of_a_companion_are_exported_as_they_were_shown(fresh_lab: Lab) -> None:
    """One row per pose with its four times and 91 values; there is no file of trackers."""
    values = (np.arange(len(COMPANION_POSE)) / 64).astype(np.float32)
    shown = [
        (COMPANION, ShownFrame("127.0.0.1:5", 3.5, 100.25, 100.2, 100.26, values)),
        (COMPANION, ShownFrame("127.0.0.1:5", None, 100.5, 100.5, 100.51, -values)),
    ]
    with fresh_lab.database.writing() as db:
        session_id = build_session(db, SessionSpec("one", kind="people"), STUDY).id
        assert store_frames(db, session_id, shown, now=NOW, now_s=101.0) == 2
    with fresh_lab.database.reading() as db:
        members = {
            member.path: b"".join(member.pieces).decode()
            for member in Contents(db, STUDY, "people", NOW).members()
        }
    assert not any(one.startswith("trackers/") for one in members)
    (path,) = (one for one in members if one.startswith("companions/"))
    head, *rows = members[path].splitlines()
    first, second = (dict(zip(head.split(","), row.split(","), strict=True)) for row in rows)
    assert [float(first[name]) for name in COMPANION_POSE] == values.tolist()
    assert (first["source"], first["source_s"], second["source_s"]) == ("'=mime", "3.5", "")
    sent = NOW - timedelta(seconds=0.74)
    assert first["sent_at_utc"] == sent.isoformat(timespec="microseconds").replace("+00:00", "Z")
