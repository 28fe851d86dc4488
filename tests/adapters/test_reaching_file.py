"""Tests of the files of how people reach."""

import json
from pathlib import Path

import numpy as np
import pytest

from app.adapters.reaching_file import read_reaching, write_reaching
from app.science.reaching import FittedReaching, ReachingError
from tests.science.reaching.test_model import fit_to, reaches_by


@pytest.fixture(scope="module")
def fit() -> FittedReaching:
    """Return a small model of two planted people."""
    return fit_to(reaches_by((1.0, 1.4), 6))


def test_a_model_that_is_read_again_draws_the_same_people(
    fit: FittedReaching, tmp_path: Path
) -> None:
    """Level, times and skews are the same to the last bit, and the hash is that of the file."""
    path = tmp_path / "reaching.npz"
    written = write_reaching(path, fit)
    again = read_reaching(path)
    assert again.content_hash == written.content_hash
    assert len(again.content_hash) == 64
    drawn = []
    for one in (fit, again):
        rng = np.random.default_rng(1)
        person = one.person(rng)
        drawn.append([person.level, *(person.movement(0.3, 0.05, rng) for _ in range(9))])
    assert drawn[0] == drawn[1]


def test_the_same_model_has_the_same_hash(fit: FittedReaching, tmp_path: Path) -> None:
    """The hash is of the content, so writing it twice gives the same."""
    hashes = {write_reaching(tmp_path / f"{at}.npz", fit).content_hash for at in range(2)}
    assert len(hashes) == 1


def test_a_truncated_file_is_refused(fit: FittedReaching, tmp_path: Path) -> None:
    """Half a file is no model, and the message names the command that writes one."""
    path = tmp_path / "reaching.npz"
    write_reaching(path, fit)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    with pytest.raises(ReachingError, match=r"not a file of how people reach; `./run reach fit`"):
        read_reaching(path)


def test_a_changed_file_is_refused(fit: FittedReaching, tmp_path: Path) -> None:
    """Somebody else's name or another duration does not match the hash."""
    path = tmp_path / "reaching.npz"
    write_reaching(path, fit)
    with np.load(path, allow_pickle=False) as archive:
        tables = {name: archive[name] for name in archive.files}
    tables["durations_s"] = tables["durations_s"] * 2.0
    np.savez_compressed(path, allow_pickle=False, **tables)
    with pytest.raises(ReachingError, match="damaged, its content does not match its hash"):
        read_reaching(path)


def test_a_file_of_another_kind_is_refused(fit: FittedReaching, tmp_path: Path) -> None:
    """A model of walking, whose tables have the same names, is not taken for one of reaching."""
    path = tmp_path / "reaching.npz"
    write_reaching(path, fit)
    with np.load(path, allow_pickle=False) as archive:
        tables = {name: archive[name] for name in archive.files}
    header = json.loads(tables["header"].tobytes()) | {"format": "reembody-walking-model"}
    tables["header"] = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    np.savez_compressed(path, allow_pickle=False, **tables)
    with pytest.raises(ReachingError, match="not a file of how people reach"):
        read_reaching(path)
