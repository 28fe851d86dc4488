"""Judging frames: everything broken is flagged, everything sound is not."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.wire import decode_batch, flag_batches, flag_frames
from tests.wire.samples import bits, every_odd_float, message, standing

TIMES_S = np.array([0.0, 0.1, 0.2])
HEAD_W = 3 + 4 * 5


def test_a_sound_frame_has_no_flag() -> None:
    """Unit rotations and finite places pass."""
    flags = flag_frames(TIMES_S, standing(3))
    assert not flags.bad.any()


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_value_that_is_no_number_is_flagged(value: float) -> None:
    """Only the frame it is in, and as non-finite rather than as non-unit."""
    values = standing(3)
    values[1, HEAD_W] = value
    flags = flag_frames(TIMES_S, values)
    assert flags.non_finite.tolist() == [False, True, False]
    assert not flags.non_unit.any()


def test_a_time_that_is_no_number_is_flagged() -> None:
    """A frame without time is of no use either."""
    flags = flag_frames(np.array([0.0, np.nan, 0.2]), standing(3))
    assert flags.non_finite.tolist() == [False, True, False]


@pytest.mark.parametrize("length", [0.0, 1e-40, 0.998, 1.002, 1e20, 3e38])
def test_a_rotation_that_is_not_of_unit_length_is_flagged(length: float) -> None:
    """Zero, denormal, shrunken and huge quaternions are no rotations."""
    values = standing(3)
    values[2, HEAD_W] = length
    flags = flag_frames(TIMES_S, values)
    assert flags.non_unit.tolist() == [False, False, True]


@pytest.mark.parametrize("length", [0.9995, 1.0005])
def test_rounding_is_no_fault(length: float) -> None:
    """float32 products drift by less than a thousandth."""
    values = standing(3)
    values[:, HEAD_W] = length
    assert not flag_frames(TIMES_S, values).bad.any()


def test_judging_changes_nothing() -> None:
    """Samples stay as they came, NaN payloads included, and no warning is raised."""
    values = every_odd_float()
    before = bits(values).copy()
    flags = flag_frames(np.zeros(len(values)), values)
    assert flags.bad.all()
    assert np.array_equal(bits(values), before)


@given(counts=st.lists(st.integers(1, 700), max_size=12))
def test_many_batches_are_judged_like_each_alone(counts: list[int]) -> None:
    """Every frame gets its own flags, wherever the batches are put together."""
    batches = []
    for number, count in enumerate(counts):
        values = standing(count)
        values[number % count, HEAD_W] = np.nan
        values[-1, 3] *= 1.5
        batches.append(decode_batch(message(values)))
    together = list(flag_batches(batches))
    assert len(together) == len(counts)
    for batch, flags in zip(batches, together, strict=True):
        alone = flag_frames(batch.times_s, batch.values)
        assert np.array_equal(flags.non_finite, alone.non_finite)
        assert np.array_equal(flags.non_unit, alone.non_unit)
