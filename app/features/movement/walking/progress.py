"""How far a fit is, told by the process that computes it to the one that is asked.

Finished maps are appended to a file at once, so its size tells how many there are. Whoever resumes
the fit goes on behind the last whole record.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

Stage = Literal["waiting", "walks", "maps", "blending"]
STAGES: tuple[Stage, ...] = ("waiting", "walks", "maps", "blending")
RECORD_BYTES = 8
"""Of each node of a map: its deviation and its travel time."""


@dataclass(frozen=True)
class Progress:
    """How far a fit is.

    Attributes:
        stage: reading walks, making maps, choosing how to read them and blending.
        maps, maps_total: finished, of how many; total 0 while it is not known.
    """

    stage: Stage = "waiting"
    maps: int = 0
    maps_total: int = 0


@dataclass(frozen=True)
class FitFolder:
    """The files of one fit."""

    folder: Path

    @property
    def model(self) -> Path:
        """The finished model."""
        return self.folder / "model.npz"

    @property
    def maps(self) -> Path:
        """Records of finished maps: deviations, then travel times."""
        return self.folder / "maps.f32"

    @property
    def _told(self) -> Path:
        return self.folder / "told"

    def tell(self, stage: Stage, total: int, nodes: int) -> None:
        """Say what is done now; whole or not at all."""
        part = self._told.with_suffix(".part")
        part.write_text(f"{stage} {total} {nodes}", encoding="utf-8")
        part.replace(self._told)

    def progress(self) -> Progress:
        """How far it is; what was told last, and the size of the file of maps."""
        try:
            told, total, nodes = self._told.read_text(encoding="utf-8").split()
            size = self.maps.stat().st_size if self.maps.exists() else 0
            stage = next(one for one in STAGES if one == told)
        except (OSError, ValueError, StopIteration):
            return Progress()
        done = size // (RECORD_BYTES * int(nodes)) if int(nodes) else 0
        return Progress(stage, min(done, int(total)), int(total))
