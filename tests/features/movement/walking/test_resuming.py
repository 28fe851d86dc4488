"""A test that an interrupted fit continues after its last complete map."""

from pathlib import Path

from app.features.movement.walking.fit_task import fit
from app.features.movement.walking.progress import RECORD_BYTES, FitFolder, Progress
from app.features.movement.walking.sources import FitOrder, PopulationSource, Store

SCENE = """key: hall
bounds_m: [-2, -2, 2, 4]
places: {start: [0, -1], middle: [0.5, 1], goal: [0, 3]}
paths:
  - {name: there, from: start, to: goal}
  - {name: half, from: start, to: middle}
"""
NODES = 27


def test_an_interrupted_fit_gives_the_same_model(tmp_path: Path) -> None:
    """A fit that is interrupted within a map discards that map and gives the same model."""
    order = FitOrder(
        PopulationSource("workers", 2, 2, 1, SCENE),
        scene=None,
        steps=3,
        seed=1,
        k=3,
        entries=12,
        reading="paper",
    )
    whole, cut = FitFolder(tmp_path / "whole"), FitFolder(tmp_path / "cut")
    for files in (whole, cut):
        files.folder.mkdir()
    store = Store("")
    expected = fit(store, order, whole.folder)["model_hash"]
    assert whole.progress() == Progress("blending", 8, 8)
    records = whole.maps.read_bytes()
    cut.maps.write_bytes(records[: int(2.5 * RECORD_BYTES * NODES)])
    assert fit(store, order, cut.folder)["model_hash"] == expected
    assert cut.maps.read_bytes() == records
