"""Tests with real controllers: one person who places objects in a virtual kitchen."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from app.adapters.captures import read_capture_file
from app.science.reaching import (
    FittedReaching,
    HandTrack,
    Reach,
    Reacher,
    ReachingError,
    ReachRules,
    evaluate_reaching,
    fitted_reaching,
    hand_tracks,
    reach_database,
    reaches_of,
)


@pytest.fixture
def kitchen(shared_data: Path) -> tuple[Path, ...]:
    """Provide the tracker files of both kitchens; skips where there are none."""
    files = tuple(sorted((shared_data / "logs" / "uxf").glob("*/10/*/trackers/VR_move_*.csv")))
    if not files:
        pytest.skip("the recordings of controllers in a kitchen are not there")
    return files


@cache
def hands_in(file: Path) -> tuple[HandTrack, ...]:
    """Return the hands of a file."""
    who = Reacher("10", f"{file.parts[-5]}/{file.name}")
    return tuple(hand_tracks(read_capture_file(file).motion, who))


@cache
def reaches_in(files: tuple[Path, ...]) -> tuple[tuple[Reach, ...], tuple[str, ...]]:
    """Return the reaches of files, and why other movements are none."""
    cut = [reaches_of(track) for file in files for track in hands_in(file)]
    return (
        tuple(reach for reaches, _ in cut for reach in reaches),
        tuple(one.reason for _, left_out in cut for one in left_out),
    )


@cache
def model_of(files: tuple[Path, ...]) -> FittedReaching:
    """Return the model of these files."""
    rules = ReachRules()
    return fitted_reaching(reach_database(reaches_in(files)[0], rules)[0], rules)


def test_only_the_controller_in_use_is_a_hand(kitchen: tuple[Path, ...]) -> None:
    """The left controller was never tracked, the head is no hand, the right one is."""
    assert {track.hand for file in kitchen for track in hands_in(file)} == {"right"}


def test_some_movements_are_reaches_and_the_others_say_why_not(kitchen: tuple[Path, ...]) -> None:
    """Of all movements of a hand in a room about a fifth is straight, whole and from rest to rest.

    Each other one has one of the reasons.
    """
    reaches, reasons = reaches_in(kitchen)
    assert (len(reaches), len(reasons)) == (45, 165)
    assert len(set(reasons)) == 6


def test_recorded_reaches_look_like_reaches(kitchen: tuple[Path, ...]) -> None:
    """They are nearly straight, with a peak of speed near the middle, and last about a second."""
    reaches, _ = reaches_in(kitchen)
    assert np.median([one.straightness for one in reaches]) > 0.93
    assert 0.3 < np.median([one.peak_share for one in reaches]) < 0.6
    assert 0.3 < np.median([one.duration_s for one in reaches]) < 1.0


def test_this_person_takes_twice_the_assumed_time(kitchen: tuple[Path, ...]) -> None:
    """Somebody who places objects with care is slower than the assumed pace of a mouse."""
    levels = model_of(kitchen).levels
    low, high = levels.interval()
    assert 1.9 < np.exp(levels.mean) < 2.5
    assert low > 1.0
    assert high > 3.0  # one person says little about others


def test_maps_predict_this_persons_times_better_than_the_constants(
    kitchen: tuple[Path, ...],
) -> None:
    """Learnt from the other recordings, they halve the error; a line does at least as well."""
    found = evaluate_reaching(model_of(kitchen), draws=200)
    maps, assumed, line = (found.score(name) for name in ("maps", "assumed", "line"))
    assert found.left_out == "recordings"
    assert maps.crps_s < 0.6 * assumed.crps_s
    assert maps.crps_s < 1.25 * line.crps_s
    assert maps.coverage_90 > 0.8


def test_a_capture_without_hands_lists_its_names(kitchen: tuple[Path, ...]) -> None:
    """Whoever asks for a body that is not there is told which there are."""
    motion = read_capture_file(kitchen[0]).motion
    with pytest.raises(ReachingError, match="nothing named 'wrist' among head, left, right"):
        hand_tracks(motion, Reacher("10", "kitchen"), named="wrist")
