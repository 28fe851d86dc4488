"""Tests of the files of fitted models: what P_mixed learnt, and files of earlier versions."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.adapters.walks.model_file import read_model, write_model
from app.science.walking.following import FollowingRules, SteeringFollower
from app.science.walking.maps import TIME_AWARE, MapMaker, database_of, maps_of
from app.science.walking.models import FitOptions, FittedWalking, Predictor, fitted
from app.science.walking.recording import dependencies_of
from app.science.walking.records import (
    LENGTH,
    PAPER_PARAMETERS,
    TURNING,
    PlannedPath,
    WalkingError,
    regular_grid,
)
from app.science.walking.synthetic import POPULATIONS, Sample, laboratory_scenes, synthetic_walks


@pytest.fixture(scope="module")
def fit() -> FittedWalking:
    """Return a small model of three synthetic people."""
    entries = list(synthetic_walks(POPULATIONS[0], laboratory_scenes()[:4], Sample(3, seed=1)))
    maker = MapMaker(regular_grid(PAPER_PARAMETERS, 3))
    database = database_of(entries, [one for _, one in maps_of(entries, maker)], (LENGTH, TURNING))
    return fitted(database, FitOptions(seed=3, k=5, entries=40, reading=TIME_AWARE))


def test_what_was_learnt_of_travel_times_is_stored(fit: FittedWalking, tmp_path: Path) -> None:
    """A model that is read again draws the same travel times, without learning them again."""
    path = tmp_path / "model.npz"
    write_model(path, fit, FollowingRules())
    again, _, _ = read_model(path)
    assert fit.mixed is not None
    assert again.stored is not None
    walk = PlannedPath(np.array([[0.0, 0.0], [0.0, 2.0], [1.5, 3.0]]))
    first, second = (
        Predictor(one.usual, SteeringFollower()).predict(
            walk, dependencies_of(walk), 50, np.random.default_rng(1)
        )
        for one in (fit, again)
    )
    np.testing.assert_array_equal(first.durations_s, second.durations_s)
    assert again.usual.name == "mixed"


def test_a_file_of_an_earlier_version_predicts_with_the_papers_model(
    fit: FittedWalking, tmp_path: Path
) -> None:
    """A file without travel times is read as before: P_prob predicts, and mixed is refused."""
    path = tmp_path / "earlier.npz"
    earlier = replace(fit, database=replace(fit.database, resting=None))
    write_model(path, earlier, FollowingRules())
    with np.load(path, allow_pickle=False) as archive:
        header = json.loads(archive["header"].tobytes().decode())
    assert not {"resting", "travel_times"} & set(header)
    again, _, _ = read_model(path)
    assert again.mixed is None
    assert again.usual.name == "prob"
    with pytest.raises(WalkingError, match="no model 'mixed' in this file, only prob, stat, adapt"):
        again.named("mixed")


def test_agents_take_the_drawn_times(fit: FittedWalking) -> None:
    """Agents of P_mixed arrive when the drawn travel times say, also round a corner."""
    for points in ([[0.0, 0.0], [0.0, 0.6]], [[0.0, 0.0], [0.0, 2.0], [1.5, 3.0]]):
        path = PlannedPath(np.array(points))
        predictor = Predictor(fit.usual, SteeringFollower())
        found = predictor.predict(path, dependencies_of(path), 40, np.random.default_rng(1))
        arrival_s = predictor.walked(path, found.vectors, samples=1).arrival_s
        np.testing.assert_allclose(arrival_s, found.durations_s, atol=0.05)
