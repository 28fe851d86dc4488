"""The record of a power run: a line for what is computed, then one for each finished chunk.

A line that was written stays valid whatever happens afterwards, so a pilot that was stopped goes on
where it was, and records of several machines can be put together. The numbers are written with all
their digits.
"""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from app.features.results.pilot.simulation.plan import Chunk, Scenario
from app.science.pilot import Results

FORMAT = 1
Header = Mapping[str, Any]


@dataclass(frozen=True)
class Record:
    """What was computed, and the results by chunk."""

    header: Header
    results: Mapping[Chunk, Results]


class RecordFile:
    """A record on disk, to which finished chunks are appended."""

    def __init__(self, path: Path, header: Header) -> None:
        """Begin a record, or continue one of the same pilot; raises ValueError, OSError."""
        self._path = path
        self.results: dict[Chunk, Results] = {}
        if path.exists() and path.stat().st_size:
            record, length = _read(path)
            _require_same(header, record.header, path)
            self.results.update(record.results)
            # What a killed process had begun to write.
            with path.open("r+b") as file:
                file.truncate(length)
            return
        # Renamed when it is whole, so that a record never begins in the middle.
        begun = path.with_name(f"{path.name}.begun")
        begun.write_text(f"{json.dumps(header)}\n", encoding="utf-8")
        begun.replace(path)

    def add(self, chunk: Chunk, tested: Results) -> None:
        """Append one result."""
        self.results[chunk] = tested
        with self._path.open("a", encoding="utf-8") as file:
            file.write(f"{json.dumps(_as_json(chunk, tested))}\n")


def merged(paths: Sequence[Path]) -> Record:
    """Put records of one pilot together; raises ValueError, OSError."""
    results: dict[Chunk, Results] = {}
    first: Header | None = None
    for path in paths:
        record, _ = _read(path)
        if first is None:
            first = record.header
        _require_same(first, record.header, path)
        results.update(record.results)
    if first is None:
        raise ValueError("give the records to merge, as --out wrote them")
    return Record(first, results)


def together(results: Iterable[Results]) -> Results:
    """Return the results of several chunks as one."""
    parts = list(results)
    return Results(
        np.concatenate([one.significant for one in parts]),
        np.concatenate([one.failed for one in parts]),
        np.concatenate([one.estimates for one in parts]),
        np.concatenate([one.in_test for one in parts]),
    )


def _read(path: Path) -> tuple[Record, int]:
    """Return a record, and how many of its bytes are complete lines."""
    whole, _, _ = path.read_bytes().rpartition(b"\n")
    lines = whole.decode("utf-8", errors="replace").split("\n")
    try:
        header = json.loads(lines[0])
        if isinstance(header, dict) and "kind" in header:
            kind = header["kind"]
            raise ValueError(
                f"it is the record of a {kind}, and not of a power curve; name another file"
            )
        known = isinstance(header, dict) and header.get("format") == FORMAT
        results = dict(_chunks(lines[1:])) if known else {}
    except json.JSONDecodeError as error:
        raise ValueError(f"{path} is no record of a pilot; give a file that --out wrote") from error
    except ValueError as error:
        raise ValueError(f"{path} is no record of a pilot's power: {error}") from error
    except (KeyError, TypeError) as error:
        raise ValueError(f"{path} is no record of a pilot's power: a line lacks {error}") from error
    if not known:
        raise ValueError(f"{path} is no record of a pilot; give a file that --out wrote")
    return Record(header, results), len(whole) + 1


def _chunks(lines: Iterable[str]) -> Iterator[tuple[Chunk, Results]]:
    for line in lines:
        one = json.loads(line)
        chunk = Chunk(one["n"], _scenario(one["scenario"]), one["index"], one["sets"])
        estimates = [np.nan if value is None else value for value in one["estimates"]]
        yield (
            chunk,
            Results(
                np.array(one["significant"], dtype=np.bool_),
                np.array(one["failed"], dtype=np.bool_),
                np.array(estimates, dtype=np.float64),
                np.array(one["in_test"], dtype=np.int64),
            ),
        )


def _scenario(word: str) -> Scenario:
    if word == "effect":
        return "effect"
    if word == "null":
        return "null"
    raise ValueError(f"{word!r} is neither effect nor null")


def _as_json(chunk: Chunk, tested: Results) -> dict[str, Any]:
    return {
        "n": chunk.n,
        "scenario": chunk.scenario,
        "index": chunk.index,
        "sets": chunk.sets,
        "significant": [int(one) for one in tested.significant],
        "failed": [int(one) for one in tested.failed],
        "estimates": [float(one) if np.isfinite(one) else None for one in tested.estimates],
        "in_test": [int(one) for one in tested.in_test],
    }


def _require_same(header: Header, found: Header, path: Path) -> None:
    differing = sorted(key for key in {*header, *found} if header.get(key) != found.get(key))
    if differing:
        raise ValueError(
            f"{path} is of another pilot: it differs in {', '.join(differing)}. Use the same "
            "study, assumptions, seed and numbers, or another file"
        )
