"""Tests of reading tables of tracks: headers, units, rates and errors with their line."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.adapters.captures.capture import CaptureError
from app.adapters.walks.track_table import TrackReading, read_track_table, read_tracks
from app.science.walking.recording import walks_of

SIMPLE = "t,x,y\n0,0,0\n0.5,0.1,0.2\n1,0.3,0.5\n"


def test_a_plain_table_is_one_track() -> None:
    """A table without a column of people is one track in metres and seconds."""
    (track,) = read_tracks(SIMPLE.encode(), name="a.csv")
    assert track.times_s == pytest.approx([0.0, 0.5, 1.0])
    assert track.xy_m[2] == pytest.approx([0.3, 0.5])
    assert (track.source, track.kind, track.stature_m) == ("a.csv", "human", None)


@pytest.mark.parametrize(
    "text",
    [
        "Subject;time_ms;x_cm;y_cm\n7;0;0;0\n7;500;10;20\n7;1000;30;50\n",
        'person\tframe\t"x [mm]"\ty (mm)\n7\t100\t0\t0\n7\t101\t100\t200\n7\t102\t300\t500\n',
        "# framerate: 2 fps\n# id frame x y z\n7 4 0 0 180\n7 5 10 20 180\n7 6 30 50 180\n",
        "\ufeffid,note,T,X,Y\n7,a,5,0,0\n7,b,5.5,0.1,0.2\n7,c,6,0.3,0.5\n",
    ],
)
def test_units_separators_and_rates_are_read(text: str) -> None:
    """The same track is read in centimetres and milliseconds, in millimetres and frames."""
    reading = TrackReading(rate_hz=2.0, statures_m={"7": 1.8})
    (track,) = read_tracks(text.encode(), name="a.csv", reading=reading)
    assert track.subject == "7"
    assert track.stature_m == 1.8
    assert track.times_s == pytest.approx([0.0, 0.5, 1.0])
    assert track.xy_m == pytest.approx(np.array([[0.0, 0.0], [0.1, 0.2], [0.3, 0.5]]))


def test_people_are_kept_apart() -> None:
    """Mixed rows of two people give two tracks."""
    text = "id,t,x,y\n1,0,0,0\n2,0,5,5\n1,1,0,1\n2,1,5,6\n"
    tracks = read_tracks(text.encode(), name="a.csv")
    assert [track.subject for track in tracks] == ["1", "2"]
    assert tracks[1].xy_m[-1] == pytest.approx([5.0, 6.0])


@pytest.mark.parametrize(
    ("text", "expected_message"),
    [
        ("t,x,y\n0,0,0\n0.5,nan,0\n", "line 3: column 2 contains 'nan'"),
        ("t,x,y\n0,0,0\n0.5,,0\n", "line 3: column 2 contains ''"),
        ("t,x,y\n0,0,0\n0.5,1\n", "line 3: the row has 2 columns"),
        ("t,x\n0,0\n", "no column y"),
        ("x,y\n0,0\n", "no column of time"),
        ("frame,x,y\n0,0,0\n1,0,1\n", "give the rate"),
        ("t,x,y\n0,0,0\n", r"1 point\(s\); a walk needs at least two"),
        ("t,x,y\n0,0,0\n\n0,0,1\n", "line 4: the time of person '1' goes from 0 s to 0 s"),
        ("t,x,y\n0,0,0\n0,0,1\n", "Sort the rows by time"),
        ("t,x,y\n0,0,0\n1,0,30\n2,0,60\n", "moves at 30 m/s"),
        ("t,x,y\n", "no rows"),
        ("", "empty"),
        ("1 2 3\n", "3 columns without a header"),
    ],
)
def test_invalid_tables_are_rejected_with_their_line(text: str, expected_message: str) -> None:
    """An invalid row raises an error that names its line; it is not guessed or skipped."""
    with pytest.raises(CaptureError, match=expected_message):
        read_tracks(text.encode(), name="a.csv")


def test_a_gap_cuts_a_track_and_keeps_the_person() -> None:
    """A person who was not seen for long has another track from there on, and that is told."""
    text = "t,x,y\n0,0,0\n1,0,1\n2,0,2\n9,0,3\n10,0,4\n20,0,9\n"
    table = read_track_table(text.encode(), name="a.csv")
    assert [(one.subject, one.times_s.tolist()) for one in table.tracks] == [
        ("1", [0.0, 1.0, 2.0]),
        ("1", [0.0, 1.0]),
    ]
    said = table.assumed[-1]
    assert "2 gaps, such as the first: person '1' was not seen for 7.00 s from 2.00 s on" in said
    whole = read_track_table(b"t,x,y\n0,0,0\n1,0,1\n2,0,2\n", name="a.csv")
    assert not any("gap" in one for one in whole.assumed)


def test_a_gap_within_a_movement_makes_two_walks_that_the_recording_cuts() -> None:
    """A walk with a gap in it is two, one without its end and one without its beginning."""
    times_s = np.arange(0.0, 8.0, 0.1)
    y_m = np.clip(times_s - 2.0, 0.0, 4.0)
    rows = [f"A,{t:.1f},0,{y:.3f}" for t, y in zip(times_s, y_m, strict=True) if not 3.5 < t < 4.5]
    tracks = read_tracks("\n".join(["id,t,x,y", *rows]).encode(), name="a.csv")
    walks = [walk for track in tracks for walk in walks_of(track)]
    assert [(one.begins_still, one.ends_still) for one in walks] == [(True, False), (False, True)]
    assert {one.subject for one in walks} == {"A"}


def test_an_impossible_stature_is_rejected() -> None:
    """A stature in centimetres of one of the people is rejected."""
    with pytest.raises(CaptureError, match="Stature 180"):
        read_tracks(SIMPLE.encode(), name="a", reading=TrackReading(statures_m={"1": 180.0}))


@settings(max_examples=60, deadline=None)
@given(st.text("0123456789.,;- \t\nexyidtfram#:_cmn", max_size=60) | st.text(max_size=30))
def test_any_text_gives_tracks_or_an_error(text: str) -> None:
    """Any text is read as tracks or raises the reader's error, never another one."""
    for head in ("", "t,x,y\n", "id;frame;x_cm;y_cm\n", "# framerate: 16\n"):
        try:
            tracks = read_tracks((head + text).encode(), name="a.csv")
        except CaptureError:
            continue
        assert all(np.isfinite(track.xy_m).all() for track in tracks)


@pytest.mark.parametrize(
    ("name", "rate_hz", "people", "speed_m_s"),
    [("uo-050-180-180.txt", 16.0, 61, 1.395), ("n34_cam2.csv", 25.0, 71, 0.484)],
)
def test_trajectories_of_juelich_are_read(
    shared_data: Path, name: str, rate_hz: float, people: int, speed_m_s: float
) -> None:
    """Both layouts of the Juelich data are read, with a median walk at walking speed.

    The second file states its own speeds, such as .404 m/s in its first row.
    """
    data = (shared_data / "walking" / "pedestrian" / name).read_bytes()
    tracks = read_tracks(data, name=name, reading=TrackReading(rate_hz=rate_hz))
    assert len(tracks) == people
    walks = [walk for track in tracks for walk in walks_of(track)]
    assert not any(walk.begins_still for walk in walks)
    speeds = [walk.length_m / walk.duration_s for walk in walks]
    assert np.median(speeds) == pytest.approx(speed_m_s, abs=0.01)
