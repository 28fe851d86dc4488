"""Tests that every invalid frame is flagged, and no valid one."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.wire import decode_batch, flag_batches, flag_frames
from tests.wire.samples import bits, every_odd_float, message, standing

TIMES_S = np.array([0.0, 0.1, 0.2])
HEAD_W = 3 + 4 * 5


def test_a_sound_frame_has_no_flag() -> None:
    """A frame with unit rotations and finite positions has no flag."""
    flags = flag_frames(TIMES_S, standing(3))
    assert not flags.bad.any()


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_non_finite_value_is_flagged(value: float) -> None:
    """A non-finite value flags its own frame only, as non-finite and not as non-unit."""
    values = standing(3)
    values[1, HEAD_W] = value
    flags = flag_frames(TIMES_S, values)
    assert flags.non_finite.tolist() == [False, True, False]
    assert not flags.non_unit.any()


def test_a_non_finite_time_is_flagged() -> None:
    """A frame with a non-finite time is flagged."""
    flags = flag_frames(np.array([0.0, np.nan, 0.2]), standing(3))
    assert flags.non_finite.tolist() == [False, True, False]


@pytest.mark.parametrize("away_m", [1000.1, -1e30, 3e38])
def test_hips_that_are_in_no_room_are_flagged(away_m: float) -> None:
    """Hips beyond a kilometre are flagged like a value that is no number; at 999 m they are not."""
    values = standing(3)
    values[0, 0], values[1, 2] = 999.0, away_m
    assert flag_frames(TIMES_S, values).non_finite.tolist() == [False, True, False]


@pytest.mark.parametrize("length", [0.0, 1e-40, 0.998, 1.002, 1e20, 3e38])
def test_a_rotation_that_is_not_of_unit_length_is_flagged(length: float) -> None:
    """Zero, denormal, shrunken and huge quaternions are flagged as non-unit."""
    values = standing(3)
    values[2, HEAD_W] = length
    flags = flag_frames(TIMES_S, values)
    assert flags.non_unit.tolist() == [False, False, True]


@pytest.mark.parametrize("length", [0.9995, 1.0005])
def test_rounding_is_no_fault(length: float) -> None:
    """Quaternions off by less than a thousandth, as by float32 rounding, are not flagged."""
    values = standing(3)
    values[:, HEAD_W] = length
    assert not flag_frames(TIMES_S, values).bad.any()


def test_flagging_does_not_change_the_samples() -> None:
    """Flagging changes no sample, keeps NaN payloads and raises no warning."""
    values = every_odd_float()
    before = bits(values).copy()
    flags = flag_frames(np.zeros(len(values)), values)
    assert flags.bad.all()
    assert np.array_equal(bits(values), before)


@given(counts=st.lists(st.integers(1, 700), max_size=12))
def test_several_batches_are_flagged_like_each_alone(counts: list[int]) -> None:
    """Frames of several batches get the same flags as each batch alone."""
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
