"""Tests of a movement as CSV: titles with units, one row per frame, unseen values empty."""

import csv
import io

import numpy as np

from app.adapters.captures import to_csv
from app.science.rig import BodyMotion, MarkerMotion, RigMotion
from tests.adapters.captures.moving_rigs import motive_body, random_motion, random_rig


def _table(motion: RigMotion | MarkerMotion | BodyMotion) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO("".join(to_csv(motion)))))


def test_a_skeleton_is_written_as_positions_and_rotations() -> None:
    """Each row of the exported table has every joint's world position and rotation."""
    rng = np.random.default_rng(5)
    motion = random_motion(rng, random_rig(rng, *motive_body(), rest=True), frames=1100)
    motion.observed[7, 3] = False
    rows = _table(motion)
    assert len(rows) == 1100
    assert [rows[n]["observed"] for n in (6, 7, 8)] == ["1", "0", "1"]
    places, turns = motion.world()
    for joint, name in enumerate(motion.rig.names):
        found = [[float(row[f"{name}.{axis}_m"]) for axis in "xyz"] for row in rows]
        np.testing.assert_allclose(found, places[:, joint], atol=1e-8)
        found = [[float(row[f"{name}.q{axis}"]) for axis in "wxyz"] for row in rows]
        np.testing.assert_allclose(found, turns[:, joint], atol=1e-8)
    assert float(rows[-1]["time_s"]) == round(1099 / 120.0, 6)


def test_rows_come_in_pieces() -> None:
    """The export yields the titles and then some hundred rows at a time, to save memory."""
    rng = np.random.default_rng(6)
    pieces = list(to_csv(random_motion(rng, random_rig(rng, *motive_body()), frames=1100)))
    assert len(pieces) == 4
    assert pieces[0].startswith("frame,time_s,Hip.x_m,")
    assert all(piece.endswith("\n") for piece in pieces)


def test_unseen_values_are_empty() -> None:
    """Gaps of markers and rigid bodies are exported as empty cells, not as zeros."""
    places = np.array([[[1.0, 2.0, 3.0]], [[np.nan, np.nan, np.nan]]])
    rows = _table(MarkerMotion(("LKNE",), 50.0, places))
    assert rows[0] == {
        "frame": "0",
        "time_s": "0.000000",
        "LKNE.x_m": "1",
        "LKNE.y_m": "2",
        "LKNE.z_m": "3",
    }
    assert rows[1]["LKNE.y_m"] == ""
    turns = np.full((2, 1, 4), np.nan)
    turns[0] = (1.0, 0.0, 0.0, 0.0)
    bodies = _table(BodyMotion(("head",), np.array((0.0, 0.012)), places, turns))
    assert bodies[1]["time_s"] == "0.012000"
    assert bodies[0]["head.qw"] == "1"
    assert bodies[1]["head.qw"] == ""
