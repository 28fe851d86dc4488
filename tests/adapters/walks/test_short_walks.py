"""Tests of reading the short walks of Carlisle and Kuo: the table and the foot paths."""

import io
from pathlib import Path
from typing import cast

import numpy as np
import pytest
from scipy.io import savemat

from app.adapters.captures.capture import CaptureError
from tests.support.short_walks import DISTANCES_M, read_foot_walk, read_short_walk_table

MEAN_PEAKS_M_S = (0.559, 0.858, 1.037, 1.176, 1.251, 1.286, 1.353, 1.400, 1.434, 1.473)
MEAN_DURATIONS_S = (2.29, 2.86, 3.25, 3.63, 3.97, 4.36, 5.22, 6.54, 8.19, 10.36)
FOLDER = Path("walking") / "short_walks"


def test_the_table_has_the_published_means(shared_data: Path) -> None:
    """Peak speeds and durations by distance are the published ones; two of 800 are missing."""
    table = read_short_walk_table((shared_data / FOLDER / "peak_speed_all_sub.mat").read_bytes())
    assert table.distances_m == DISTANCES_M
    assert table.peak_speeds_m_s.shape == (10, 10, 8)
    assert int(np.isnan(table.peak_speeds_m_s).sum()) == 2
    peaks = np.nanmean(np.nanmean(table.peak_speeds_m_s, axis=2), axis=0)
    assert peaks == pytest.approx(MEAN_PEAKS_M_S, abs=0.002)
    durations = np.nanmean(np.nanmean(table.durations_s, axis=2), axis=0)
    assert durations == pytest.approx(MEAN_DURATIONS_S, abs=0.01)


@pytest.mark.parametrize(("subject", "distance"), [(1, 3), (1, 6), (1, 8), (2, 6), (2, 8)])
def test_a_walk_is_as_long_and_as_quick_as_the_table_says(
    shared_data: Path, subject: int, distance: int
) -> None:
    """Walks last as long as in the table to 20 ms, with its peak speed to 4 % beyond 3 m."""
    table = read_short_walk_table((shared_data / FOLDER / "peak_speed_all_sub.mat").read_bytes())
    name = f"subject{subject}distance{distance}section1trial1.mat"
    walk = read_foot_walk(
        (shared_data / FOLDER / name).read_bytes(), name=name, subject=str(subject)
    )
    cell = (subject - 1, distance - 1, 0)
    assert walk.duration_s == pytest.approx(table.durations_s[cell], abs=0.02)
    assert walk.begins_still
    assert walk.ends_still
    if distance >= 6:
        assert walk.speeds_m_s.max() == pytest.approx(table.peak_speeds_m_s[cell], rel=0.04)
    if subject == 1:
        assert walk.length_m == pytest.approx(DISTANCES_M[distance - 1], rel=0.03)


def _foot(first: int) -> dict[str, object]:
    ahead = np.repeat(np.arange(5) * 0.5, 100)
    places = np.stack([0.6 * ahead, 0.8 * ahead, 0.0 * ahead], axis=-1)
    return {"P": places, "FFstart": [first, first + 100], "FFend": [first + 100, first + 200]}


def _file(**content: object) -> bytes:
    stream = io.BytesIO()
    savemat(cast("str", stream), content)  # an open file serves as well as a path
    return stream.getvalue()


def test_a_walk_is_turned_to_lead_along_y() -> None:
    """A walk leads along y without going back, from the first flat frame to the last."""
    data = _file(left_walk_info=_foot(101), right_walk_info=_foot(151))
    walk = read_foot_walk(data, name="made", subject="1", stature_m=1.7)
    assert walk.duration_s == pytest.approx(250 / 128.0)
    assert (walk.xy_m[:, 0] == 0.0).all()
    assert (np.diff(walk.xy_m[:, 1]) >= 0.0).all()
    assert walk.goal_m[1] == pytest.approx(1.0)


def test_files_of_another_kind_are_rejected() -> None:
    """Files that are not MATLAB's, or lack feet, valid frames, movement or the table, fail."""
    still = _foot(101) | {"P": np.zeros((500, 3))}
    late = _foot(401)
    for data in (
        b"nothing of MATLAB",
        _file(other=1),
        _file(left_walk_info=late, right_walk_info=late),
        _file(left_walk_info=still, right_walk_info=still),
    ):
        with pytest.raises(CaptureError):
            read_foot_walk(data, name="made", subject="1")
    with pytest.raises(CaptureError, match="peak_speed_all_sub"):
        read_short_walk_table(_file(other=1))
