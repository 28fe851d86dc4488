"""The folder of an unfinished tuning: its progress, and a journal of what it has measured.

The journal has one line of JSON for each result, which is appended immediately. A tuning that is
resumed takes the results from there. JSON keeps every digit of a number, so it ends with the same
gains as a tuning that was never stopped. A last line that was not completed is discarded.
"""

import json
import os
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final, Literal, Self

from pydantic import BaseModel, ConfigDict, TypeAdapter

from app.science.avatar.tuning import (
    Experiment,
    NoOscillation,
    Phase,
    StepFigures,
    TuningProgress,
)

_KINDS: Final[dict[str, TypeAdapter[Any]]] = {
    one.__name__: TypeAdapter(one) for one in (Experiment, NoOscillation, StepFigures)
}
_PROGRESS: Final = TypeAdapter(TuningProgress)


class DamagedProgress(ValueError):
    """The progress of a tuning cannot be read; the message says why."""


class _Line(BaseModel):
    """A line of the journal; what its result holds follows from `kind`."""

    model_config = ConfigDict(strict=True, extra="forbid")

    run: int
    attempt: int
    phase: Phase
    axis: str
    kind: Literal["Experiment", "NoOscillation", "StepFigures"]
    result: Any


@dataclass(frozen=True)
class Measured:
    """One result in the journal: of an axis, in a run and phase of an attempt."""

    run: int
    attempt: int
    phase: Phase
    axis: str
    result: Experiment | NoOscillation | StepFigures

    @classmethod
    def parsed(cls, line: bytes) -> Self:
        """Return the result in a line of the journal; raise ValueError if it is broken."""
        entry = _Line.model_validate(json.loads(line))
        result = _KINDS[entry.kind].validate_python(entry.result)
        return cls(entry.run, entry.attempt, entry.phase, entry.axis, result)


@dataclass(frozen=True)
class TuningFolder:
    """The folder of one tuning."""

    folder: Path

    @property
    def _journal(self) -> Path:
        return self.folder / "journal.jsonl"

    @property
    def _progress(self) -> Path:
        return self.folder / "progress.json"

    def write_progress(self, at: TuningProgress) -> None:
        """Write the present progress atomically."""
        part = self._progress.with_suffix(".part")
        part.write_text(json.dumps(asdict(at)), encoding="utf-8")
        part.replace(self._progress)

    def progress(self) -> TuningProgress | None:
        """Return the progress that was written last; None if there is none yet.

        Raises DamagedProgress if the file is not what a tuning writes.
        """
        try:
            return _PROGRESS.validate_json(self._progress.read_bytes(), strict=True)
        except FileNotFoundError:
            return None
        except (OSError, ValueError) as error:
            raise DamagedProgress(f"{self._progress.name} cannot be read") from error

    def measured(self) -> Iterator[Measured]:
        """Yield the results in the journal, in the order in which they were measured."""
        with suppress(FileNotFoundError):
            for line in self._journal.read_bytes().split(b"\n")[:-1]:
                # A line may be broken where a run of the tuning was ended in the middle of it.
                # A damaged one is passed over, too: resuming measures its axis again.
                with suppress(ValueError):
                    yield Measured.parsed(line)

    def opened(self) -> "FileJournal":
        """Open the journal to go on from it."""
        known = {(one.run, one.axis): one.result for one in self.measured()}
        return FileJournal(self._journal, known)


class FileJournal:
    """A journal in a file, for one run of the tuning; see `TuningJournal`."""

    def __init__(self, path: Path, known: Mapping[tuple[int, str], object]) -> None:
        self._path, self._known = path, known
        if path.exists() and not path.read_bytes().endswith(b"\n"):
            with path.open("ab") as file:
                file.write(b"\n")

    def known(self, run: int, axis: str) -> object | None:
        """Return the result of an axis in a run; None if there is none."""
        return self._known.get((run, axis))

    def keep(self, run: int, attempt: int, phase: Phase, axis: str, result: object) -> None:
        """Append a result, and make sure that it survives a loss of power."""
        kind = type(result).__name__
        entry = {
            "run": run,
            "attempt": attempt,
            "phase": phase,
            "axis": axis,
            "kind": kind,
            "result": _KINDS[kind].dump_python(result, mode="json"),
        }
        with self._path.open("ab") as file:
            file.write(json.dumps(entry).encode() + b"\n")
            file.flush()
            os.fsync(file.fileno())
