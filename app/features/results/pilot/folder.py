"""The folder of an unfinished pilot: its records, how far it is, and whether it has to wait.

The records are those of `reembody pilot --out`: a line for each finished visit or part. A pilot
that is resumed goes on from there and ends with the same bytes.
"""

import json
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final, Literal

from pydantic import TypeAdapter, ValidationError

Stage = Literal["check", "people", "power"]
COHORT, POWER = "cohort.jsonl", "power.jsonl"


@dataclass(frozen=True)
class StageProgress:
    """How far a stage of a pilot is: `done` of `total` bodies, people or parts of a power curve.

    `remaining_s`: the estimated time to the stage's end, without waiting; None if nothing was
    finished since the pilot was started or resumed.
    """

    stage: Stage
    done: int
    total: int
    remaining_s: float | None = None


NOT_BEGUN: Final = StageProgress("check", 0, 0)
"""The progress of a pilot that has not written any: nothing of nothing."""
_PROGRESS: Final = TypeAdapter(StageProgress)


@dataclass(frozen=True)
class PilotFolder:
    """The folder of one pilot."""

    folder: Path

    @property
    def cohort(self) -> Path:
        """The record of the simulated visits."""
        return self.folder / COHORT

    @property
    def power(self) -> Path:
        """The record of the power curve."""
        return self.folder / POWER

    @property
    def is_held(self) -> bool:
        """Whether the pilot has to wait."""
        return self._hold.exists()

    def hold(self) -> None:
        """Let the pilot wait from its next frame or part on."""
        self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        self._hold.touch()

    def let_go(self) -> None:
        """Let the pilot go on."""
        self._hold.unlink(missing_ok=True)

    def write_progress(self, at: StageProgress) -> None:
        """Write the present progress atomically."""
        part = self._progress.with_suffix(".part")
        part.write_text(json.dumps(asdict(at)), encoding="utf-8")
        part.replace(self._progress)

    def progress(self) -> StageProgress | None:
        """Return the progress that was written last; None if there is none that can be read."""
        with suppress(OSError, ValidationError):
            return _PROGRESS.validate_json(self._progress.read_bytes(), strict=True)
        return None

    def record(self) -> str:
        """Return the record as `--out` has it: the visits, or the parts of a power run."""
        file = self.cohort if self.cohort.exists() else self.power
        return file.read_text(encoding="utf-8")

    @property
    def _hold(self) -> Path:
        return self.folder / "hold"

    @property
    def _progress(self) -> Path:
        return self.folder / "progress.json"
