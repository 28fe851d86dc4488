"""Tests of the positions for previews: format, rate and size limits."""

import numpy as np
import pytest

from app.features.movement.captures import preview
from app.features.movement.captures.preview import Points, encode, points_of
from app.science.rig import BodyMotion, MarkerMotion
from app.science.rotations import identity
from tests.features.lab import Lab, error
from tests.features.movement.captures.files import (
    ANKLE_M,
    HIPS_M,
    SPEED_M_S,
    positions_of,
    uploaded,
    walk_bvh,
)

pytestmark = pytest.mark.one_engine

HAND = Points("markers", ("LHAND", "RHÄND"), (-1, -1), 100.0, np.zeros((10, 2, 3)))


def test_a_page_can_read_a_preview(lab: Lab) -> None:
    """A preview has names, parents and positions in metres, with the capture's height and speed."""
    view = uploaded(lab.operator, walk_bvh())
    answer = lab.operator.get(f"/api/captures/{view['id']}/motion")
    assert answer.headers["content-type"] == "application/octet-stream"
    header, positions_m = positions_of(answer.content)
    assert header["names"] == view["summary"]["names"]
    assert header["parents"] == view["summary"]["skeleton"]["parents"]
    assert (header["kind"], header["frames"], header["rate_hz"]) == ("skeleton", 150, 30.0)
    hips, ankle = (header["names"].index(name) for name in ("Hips", "LeftFoot"))
    np.testing.assert_allclose(positions_m[0, hips], (0.0, HIPS_M, 0.0), atol=1e-6)
    np.testing.assert_allclose(positions_m[30, hips, 2], SPEED_M_S, atol=1e-5)
    assert positions_m[:, ankle, 1].min() == pytest.approx(ANKLE_M, abs=1e-5)


def test_the_numbers_of_a_preview_are_aligned() -> None:
    """The numbers of a preview begin at a multiple of four bytes, whatever the names."""
    for name in ("L", "LH", "LHA", "LHÄ", "LHAND"):
        body = encode(Points("markers", (name,), (-1,), 50.0, np.ones((3, 1, 3))))
        assert (4 + int.from_bytes(body[:4], "little")) % 4 == 0
        assert positions_of(body)[1].tolist() == np.ones((3, 1, 3)).tolist()


def test_a_fast_recording_is_downsampled() -> None:
    """A recording above 60 Hz is downsampled to every n-th frame, at most 60 Hz."""
    positions_m = np.arange(240.0 * 3).reshape(240, 1, 3)
    header, seen = positions_of(encode(Points("markers", ("M",), (-1,), 240.0, positions_m)))
    assert (header["rate_hz"], header["recorded_rate_hz"], header["frames"]) == (60.0, 240.0, 60)
    np.testing.assert_array_equal(seen, positions_m[::4])


def test_a_long_recording_stays_within_its_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    """A preview of a long recording stays within its size limit."""
    long = Points("markers", ("M",), (-1,), 60.0, np.zeros((500_000, 1, 3)))
    monkeypatch.setattr(preview, "MAX_NUMBERS", 30_000)
    step = preview.step_for(500_000, 60.0, 3, preview.MAX_NUMBERS)
    assert 3 * len(long.positions_m[::step]) <= 30_000


def test_a_hidden_marker_is_nan() -> None:
    """A marker that was hidden has NaN as its position."""
    positions_m = np.zeros((4, 2, 3))
    positions_m[1, 0] = np.nan
    header, seen = positions_of(encode(points_of(MarkerMotion(HAND.names, 50.0, positions_m))))
    assert header["names"] == list(HAND.names)
    assert np.isnan(seen[1, 0]).all()
    assert np.isfinite(seen).sum() == 7 * 3


def test_uneven_samples_are_resampled_with_gaps() -> None:
    """Samples at uneven times are resampled to an even rate, with NaN in gaps."""
    times_s = np.concatenate((np.arange(50) * 0.02, 5.0 + np.arange(50) * 0.02))
    positions_m = np.repeat(times_s, 3).reshape(100, 1, 3)
    motion = BodyMotion(("hand",), times_s, positions_m, identity(100)[:, None])
    header, seen = positions_of(encode(points_of(motion)))
    assert header["rate_hz"] == pytest.approx(50.0)
    at_s = np.arange(header["frames"]) / header["rate_hz"]
    there = np.isfinite(seen[:, 0, 0])
    np.testing.assert_allclose(seen[there, 0, 0], at_s[there], atol=0.02)
    assert not there[(at_s > 1.1) & (at_s < 4.9)].any()
    assert there.sum() == pytest.approx(100, abs=4)


def test_an_unknown_preview_is_refused(lab: Lab) -> None:
    """A preview of an unknown capture or of an unknown kind is refused."""
    error(lab.operator.get(f"/api/captures/{'0' * 32}/motion"), 404, "not_found")
    view = uploaded(lab.operator, walk_bvh())
    answer = lab.operator.get(f"/api/captures/{view['id']}/motion?shown=ghost")
    error(answer, 422, "invalid_input")
