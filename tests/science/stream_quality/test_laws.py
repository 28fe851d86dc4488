"""Tests of the quality check's properties for every recording, whatever its faults."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.science.stream_quality import (
    Examination,
    Memory,
    QualityError,
    StreamQuality,
    assess,
    combine,
    examine,
)
from tests.science.simulation.people import RATE_HZ
from tests.science.stream_quality.recordings import Recording, generated

USUAL_S = 1.0 / RATE_HZ


def examined(recording: Recording, before: Memory | None = None) -> Examination:
    """Examine every frame of a recording at an expected rate of 90 Hz."""
    return examine(
        recording.times_s,
        recording.rotations,
        recording.positions_m,
        usual_s=USUAL_S,
        before=before or Memory(),
    )


def quality(recording: Recording) -> StreamQuality:
    """Return the faults of a recording, counted."""
    return assess(recording.times_s, recording.rotations, recording.positions_m)


def with_faults(seed: int) -> Recording:
    """Return a recording with a few faults of every kind."""
    rng = np.random.default_rng(seed)
    bad = generated().copy()
    for _ in range(3):
        bad.rotations[rng.integers(len(bad)), rng.integers(22), rng.integers(4)] = np.nan
        bad.rotations[rng.integers(len(bad)), rng.integers(22)] *= 1.5
        bad.times_s[rng.integers(1, len(bad))] -= 1.0
        bad.rotations[rng.integers(len(bad)), 9] = (0.0, 1.0, 0.0, 0.0)
        bad.positions_m[rng.integers(len(bad))] += 3.0
        start = int(rng.integers(300, len(bad) - 400))
        bad.rotations[start : start + 300, 5] = bad.rotations[start, 5]
    bad.times_s[rng.integers(len(bad))] = np.inf
    first = int(rng.integers(100, 2000))
    return bad.without(np.arange(first, first + 40))


@given(seed=st.integers(0, 40), cuts=st.lists(st.integers(1, 2400), max_size=6, unique=True))
@settings(max_examples=60, deadline=None)
def test_it_does_not_matter_where_a_recording_is_cut(seed: int, cuts: list[int]) -> None:
    """Examining a recording span by span, with the carried memory, gives the same flags."""
    whole = with_faults(seed)
    expected = examined(whole)
    parts, before = [], Memory()
    for begin, end in zip([0, *sorted(cuts)], [*sorted(cuts), len(whole)], strict=True):
        parts.append(examined(whole.part(slice(begin, end)), before))
        before = parts[-1].after
    for name in ("non_finite", "non_unit", "turned", "shifted", "frozen"):
        pieces = np.concatenate([getattr(part, name) for part in parts])
        assert np.array_equal(pieces, getattr(expected, name)), name
    for name in ("gap", "backwards"):
        pieces = np.concatenate([getattr(part.pacing, name) for part in parts])
        assert np.array_equal(pieces, getattr(expected.pacing, name)), name


def test_examining_does_not_change_a_recording() -> None:
    """Examining a recording does not change any bit of it."""
    bad = with_faults(3)
    before = (bad.times_s.tobytes(), bad.rotations.tobytes(), bad.positions_m.tobytes())
    examined(bad)
    assert (bad.times_s.tobytes(), bad.rotations.tobytes(), bad.positions_m.tobytes()) == before


def test_the_other_sign_of_a_quaternion_is_the_same_rotation() -> None:
    """A quaternion that changes its sign is no jump."""
    flipped = generated().copy()
    flipped.rotations[::7] *= -1.0
    assert quality(flipped).jumps == 0


def test_precision_of_the_numbers_does_not_matter() -> None:
    """A recording has the same faults in double precision."""
    bad = with_faults(4)
    wide = assess(bad.times_s, bad.rotations.astype(float), bad.positions_m.astype(float))
    assert wide == quality(bad)


def test_faults_of_runs_add_up() -> None:
    """Two runs together have the faults of both; the gap between them is unknown."""
    one, other = quality(with_faults(5)), quality(with_faults(6))
    both = combine([one, other])
    assert both.frames == one.frames + other.frames
    assert both.gaps == one.gaps + other.gaps
    assert both.longest_gap_s == max(one.longest_gap_s, other.longest_gap_s)
    assert both.frozen_s == pytest.approx(np.add(one.frozen_s, other.frozen_s))
    assert combine([]).frames == 0


def test_no_frames_have_no_faults() -> None:
    """A recording without frames has no faults and no frame rate."""
    empty = quality(generated().part(slice(0)))
    assert (empty.frames, empty.frame_rate_hz, empty.span_s) == (0, None, 0.0)
    after = examined(generated().part(slice(0))).after
    assert (after.time_s, after.pose, after.watched_s) == (None, None, 0.0)


@pytest.mark.parametrize("shape", [(5, 21, 4), (4, 22, 4), (5, 22, 3)])
def test_arrays_of_different_lengths_are_rejected(shape: tuple[int, ...]) -> None:
    """Arrays that do not fit together raise an error that states the shapes."""
    with pytest.raises(QualityError, match="do not match"):
        examine(np.zeros(5), np.zeros(shape), np.zeros((5, 3)))
    with pytest.raises(QualityError, match="do not match"):
        examine(np.zeros(5), np.zeros((5, 22, 4)), np.zeros((4, 3)))
    with pytest.raises(QualityError, match="does not match"):
        assess(np.zeros(5), np.zeros((5, 22, 4)), np.zeros((5, 3)), counted=np.ones(4, np.bool_))


@given(seed=st.integers(0, 10_000))
@settings(max_examples=60, deadline=None)
def test_any_bits_can_be_examined(seed: int) -> None:
    """Arbitrary bits raise no error and no warning, and give finite counts."""
    rng = np.random.default_rng(seed)
    odd = generated().part(slice(0, 200)).copy()
    places = rng.random(odd.rotations.shape) < 0.02
    noise = rng.integers(0, 2**32, odd.rotations.shape, dtype=np.uint32).view(np.float32)
    odd.rotations[places] = noise[places]
    far = rng.random(len(odd)) < 0.1
    odd.positions_m[far] = rng.choice([3e38, -3e38, np.nan, np.inf], (int(far.sum()), 3))
    late = rng.random(len(odd)) < 0.1
    odd.times_s[late] = rng.choice([1e308, -1e308, np.nan, np.inf, -np.inf, 1e9], int(late.sum()))
    found = quality(odd)
    figures = (found.span_s, found.gap_s, found.longest_gap_s, *found.frozen_s)
    assert np.isfinite(figures).all()
    assert found.frame_rate_hz is None or np.isfinite(found.frame_rate_hz)
    assert found.span_s >= found.gap_s >= found.longest_gap_s >= 0.0
