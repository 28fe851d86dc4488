"""The progress of a fit, written by the worker process and read by the server.

Each finished map is appended to a file immediately, so its size gives the number of maps. A resumed
fit continues after the last complete record.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

Stage = Literal["waiting", "walks", "maps", "blending"]
STAGES: tuple[Stage, ...] = ("waiting", "walks", "maps", "blending")
RECORD_BYTES = 8
"""Bytes per node of a map: its deviation and its travel time."""


@dataclass(frozen=True)
class Progress:
    """The progress of a fit.

    Attributes:
        stage: Reading walks, making maps, or choosing the reading and blending.
        maps, maps_total: Number of finished maps, of how many; the total is 0 while it is unknown.
    """

    stage: Stage = "waiting"
    maps: int = 0
    maps_total: int = 0


@dataclass(frozen=True)
class FitFolder:
    """The folder of one fit, with its files."""

    folder: Path

    @property
    def model(self) -> Path:
        """Return the path of the finished model."""
        return self.folder / "model.npz"

    @property
    def maps(self) -> Path:
        """Return the path of the records of finished maps: deviations, then travel times."""
        return self.folder / "maps.f32"

    @property
    def _stage_file(self) -> Path:
        return self.folder / "told"

    def write_stage(self, stage: Stage, total: int, nodes: int) -> None:
        """Write the current stage atomically."""
        part = self._stage_file.with_suffix(".part")
        part.write_text(f"{stage} {total} {nodes}", encoding="utf-8")
        part.replace(self._stage_file)

    def progress(self) -> Progress:
        """Return the progress, computed from the last stage written and the maps file's size."""
        try:
            stage_text, total, nodes = self._stage_file.read_text(encoding="utf-8").split()
            size = self.maps.stat().st_size if self.maps.exists() else 0
            stage = next(one for one in STAGES if one == stage_text)
        except (OSError, ValueError, StopIteration):
            return Progress()
        done = size // (RECORD_BYTES * int(nodes)) if int(nodes) else 0
        return Progress(stage, min(done, int(total)), int(total))
