"""Tests of the columns of a table of tracks that are about walks: scenes and further numbers."""

import numpy as np
import pytest

from app.adapters.captures.capture import CaptureError
from app.adapters.walks.track_table import TrackReading, read_track_table, read_tracks

HEADER = "id,t,x,y,scene,load_kg,note,gaze\n"
ROWS = (
    "A,0,0,0,pole,8,left,0\nA,1,0,1,pole,,left,1\nA,2,0,2,pole,8,,0\n"
    "A,0,0,2,,8,,0\nA,1,0,1,,8,,1\n"
    "B,0,0,0,rack,0,,nan\nB,1,0,1,rack,0,,0\n"
)


def test_a_change_of_scene_begins_another_track() -> None:
    """Rows of one person in two scenes are two tracks, with times of their own."""
    table = read_track_table((HEADER + ROWS).encode(), name="a.csv")
    assert [(one.subject, one.scene, len(one.times_s)) for one in table.tracks] == [
        ("A", "pole", 3),
        ("A", None, 2),
        ("B", "rack", 2),
    ]
    assert table.scenes == {"pole": 2, "rack": 7}
    with pytest.raises(CaptureError, match=r"'B' is in scene 'shelf' for one row only, at 1\.00 s"):
        read_tracks((HEADER + ROWS + "B,1,0,1,shelf,0,,0\n").encode(), name="a.csv")


def test_numbers_that_are_asked_for_are_read_where_they_are_known() -> None:
    """An empty cell is not known; others are numbers or refused with their line."""
    reading = TrackReading(numbers=("load_kg",))
    first, second, third = read_tracks((HEADER + ROWS).encode(), name="a.csv", reading=reading)
    np.testing.assert_array_equal(first.others["load_kg"], [8.0, np.nan, 8.0])
    assert list(second.others) == ["load_kg"]
    np.testing.assert_array_equal(third.others["load_kg"], [0.0, 0.0])
    wrong = HEADER + ROWS.replace("A,1,0,1,pole,,", "A,1,0,1,pole,heavy,")
    with pytest.raises(CaptureError, match="line 3: column load_kg contains 'heavy'"):
        read_tracks(wrong.encode(), name="a.csv", reading=reading)


def test_all_columns_that_are_numbers_can_be_read() -> None:
    """Without names, columns of text are passed over, and one with a wrong cell is reported."""
    reading = TrackReading(numbers=None)
    table = read_track_table((HEADER + ROWS).encode(), name="a.csv", reading=reading)
    assert (table.numbers, table.spoilt) == (("load_kg", "gaze"), ())
    assert table.columns == ("load_kg", "note", "gaze")
    wrong = HEADER + ROWS.replace("rack,0,,0", "rack,8 kg,,0")
    table = read_track_table(wrong.encode(), name="a.csv", reading=reading)
    assert table.numbers == ("gaze",)
    assert table.spoilt == ("line 8: column load_kg contains '8 kg', not a finite number",)


def test_a_column_that_is_there_twice_is_refused_if_it_is_read() -> None:
    """Which of two columns counts is not guessed; without names both are passed over and noted."""
    for name in ("load_kg", "x"):
        data = f"id,t,x,y,load_kg,{name}\nA,0,0,0,8,9\nA,1,0,1,8,9\n".encode()
        with pytest.raises(CaptureError, match=f"the column {name} is there twice"):
            read_track_table(data, name="a.csv", reading=TrackReading(numbers=("load_kg",)))
    data = b"id,t,x,y,load_kg,load_kg\nA,0,0,0,8,9\nA,1,0,1,8,9\n"
    table = read_track_table(data, name="a.csv", reading=TrackReading(numbers=None))
    assert (table.numbers, table.columns) == ((), ())
    assert table.spoilt == ("the column load_kg is there twice: keep one",)


def test_a_column_of_numbers_with_another_name_than_is_valid_is_noted() -> None:
    """A number that cannot be asked for by its name is not lost without a word."""
    data = b"id,t,x,y,load kg,my note\nA,0,0,0,8,a\nA,1,0,1,8,b\n"
    table = read_track_table(data, name="a.csv", reading=TrackReading(numbers=None))
    (told,) = table.spoilt
    assert "the column 'load kg' was passed over. The name 'load kg' is not valid" in told
    assert (table.numbers, table.columns) == ((), ())


@pytest.mark.parametrize("row", ["A,0,0,0,8_0", "A,0,0_1,0,8"])
def test_an_underscore_does_not_belong_in_a_number(row: str) -> None:
    """8_0 is no number in a table, neither in its own columns nor in those of further numbers."""
    data = f"id,t,x,y,load_kg\n{row}\nA,1,0,1,8\n".encode()
    with pytest.raises(
        CaptureError, match=r"line 2: column .* contains '.*_.*', not a finite number"
    ):
        read_track_table(data, name="a.csv", reading=TrackReading(numbers=("load_kg",)))
