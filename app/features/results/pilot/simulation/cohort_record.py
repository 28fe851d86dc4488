"""The record of a cohort: a header, then a line for each visit, in the order of their numbers.

A record is text that people copy, merge and may edit, so whatever is read is checked: a visit that
is none, or one that two records tell differently, would go into a report unnoticed.
"""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import IO, Annotated, Any, Final, Literal, NoReturn, TypeVar

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from app.platform.incomplete_files import lock_file
from app.science.simulation import Build
from app.simulated_people.visits import AvatarKind, PhaseOutcome, Visit

FORMAT: Final = 1
KIND: Final = "cohort"
Header = Mapping[str, Any]
Parsed = TypeVar("Parsed")
_WHOLE = Annotated[int, Field(ge=0)]


class _KnownHeader(BaseModel):
    model_config = ConfigDict(strict=True, extra="forbid")

    format: Literal[1]
    kind: Literal["cohort"]
    simulated: Literal[True]
    study: str
    study_sha256: str
    participants: Annotated[int, Field(ge=1)]
    seed: _WHOLE
    avatar: AvatarKind
    reaching: dict[str, Any] | None = None


_VISIT: Final[TypeAdapter[Visit]] = TypeAdapter(Visit)


@dataclass(frozen=True)
class CohortRecord:
    """What a record has.

    `whole_bytes`: how long it is up to its last complete line; a killed process may have begun
    another one.
    """

    header: Header
    visits: tuple[Visit, ...]
    whole_bytes: int


def is_cohort(path: Path) -> bool:
    """Return whether a file is the record of a cohort, by its first line; raises OSError."""
    with path.open("rb") as file:
        line = file.readline(10_000)
    try:
        header = json.loads(line)
    except ValueError:
        return False
    return isinstance(header, dict) and header.get("kind") == KIND


def read_record(path: Path) -> CohortRecord:
    """Read a record.

    Raises ValueError, with the line, for what is not one; OSError if it cannot be read.
    """
    whole, _, _ = path.read_bytes().rpartition(b"\n")
    lines = whole.decode("utf-8", errors="replace").split("\n")
    if not is_cohort(path):
        raise ValueError(f"{path} is no record of a cohort; give a file that --out wrote")
    header = _checked(path, 1, lambda: _header(lines[0]))
    visits: dict[int, Visit] = {}

    def new_visit(line: str) -> Visit:
        visit = _visit(line)
        if not 0 <= visit.number < header["participants"]:
            number, people = visit.number, header["participants"]
            raise ValueError(f"there is no visit {number} of {people} people, counted from 0")
        if visit.number in visits:
            raise ValueError(f"visit {visit.number} is there already")
        return visit

    for at, line in enumerate(lines[1:], start=2):
        visit = _checked(path, at, partial(new_visit, line))
        visits[visit.number] = visit
    return CohortRecord(header, tuple(visits.values()), len(whole) + 1)


@dataclass(frozen=True)
class OpenRecord:
    """A record to which visits are added; `visits` are those that it has."""

    visits: list[Visit]
    _file: IO[bytes] | None = None

    def add(self, visit: Visit) -> None:
        """Add a visit, which is in the file when this returns."""
        self.visits.append(visit)
        if self._file is not None:
            self._file.write(line_of(plain(visit)).encode())
            self._file.flush()


@contextmanager
def open_record(path: Path | None, header: Header, own: Sequence[int]) -> Iterator[OpenRecord]:
    """Open a record to be continued, or begin it.

    No other process may write it meanwhile: two that continue one record would both add each visit.

    Args:
        path: of the record; None for one that is not kept.
        header: of the cohort that it has to be of.
        own: the numbers of the visits that it has or will have.

    Raises:
        ValueError: the record is of another cohort or another shard, is damaged, or another
            process writes it.
        OSError: it cannot be written.
    """
    if path is None:
        yield OpenRecord([])
        return
    if not (path.exists() and path.stat().st_size):
        # Renamed when it is whole, so that a record never begins in the middle.
        begun = path.with_name(f"{path.name}.begun")
        begun.write_text(line_of(header), encoding="utf-8")
        begun.replace(path)
    with path.open("r+b") as file:
        if not lock_file(file, wait=False):
            raise ValueError(f"another process is writing {path}; give each a file of its own")
        found = read_record(path)
        require_same(header, found.header, path)
        if [visit.number for visit in found.visits] != list(own[: len(found.visits)]):
            raise ValueError(f"{path} is another shard of this cohort; give each a file of its own")
        # What a killed process had begun to write.
        file.truncate(found.whole_bytes)
        file.seek(found.whole_bytes)
        yield OpenRecord(list(found.visits), file)


def merged(paths: Sequence[Path]) -> tuple[Header, tuple[Visit, ...]]:
    """Put the records of one cohort together.

    Raises ValueError for records that do not belong together or differ in a visit; OSError.
    """
    header: Header | None = None
    visits: dict[int, tuple[Visit, Path]] = {}
    for path in paths:
        found = read_record(path)
        header = header or found.header
        require_same(header, found.header, path)
        for visit in found.visits:
            other, where = visits.setdefault(visit.number, (visit, path))
            if other != visit:
                raise ValueError(
                    f"{where} and {path} tell visit {visit.number} differently, so one of them is"
                    " damaged or of another processor. Simulate it again, and merge that"
                )
    if header is None:
        raise ValueError("give the records to merge, as --out wrote them")
    return header, tuple(visits[number][0] for number in sorted(visits))


def require_same(header: Header, found: Header, path: Path) -> None:
    """Raise ValueError if a record is not of the cohort with this header."""
    differing = sorted(key for key in {*header, *found} if header.get(key) != found.get(key))
    if differing:
        raise ValueError(
            f"{path} is of another cohort: it differs in {', '.join(differing)}. Use the same "
            "study, seed, avatar, number and file of reaching, or another file"
        )


def plain(visit: Visit) -> dict[str, Any]:
    """Return a visit as its line has it: reaches are named only if they are of recordings."""
    values = asdict(visit)
    if visit.reaches is None:
        del values["reaches"]
    return values


def line_of(one: Mapping[str, Any]) -> str:
    """Return a line of a record."""
    return f"{json.dumps(one)}\n"


def _checked(path: Path, at: int, parse: Callable[[], Parsed]) -> Parsed:
    try:
        return parse()
    except ValueError as error:
        raise ValueError(
            f"{path}, line {at}, is damaged: {_words(error)}. Simulate its people again"
        ) from error


def _header(line: str) -> Header:
    header: Header = json.loads(line, parse_constant=_no_number)
    _KnownHeader.model_validate(header)
    return header


def _visit(line: str) -> Visit:
    # Times that are not finite are no numbers of JSON, but Python reads them.
    one = json.loads(line, parse_constant=_no_number)
    _VISIT.validate_json(line, strict=True)
    # As it was written, not as it was validated: 0 and 0.0 have different bytes.
    made = {
        "build": Build(**one["build"]),
        "order": tuple(one["order"]),
        "phases": tuple(PhaseOutcome(**phase) for phase in one["phases"]),
        **({"reaches": tuple(one["reaches"])} if one.get("reaches") is not None else {}),
    }
    return Visit(**{**one, **made})


def _no_number(word: str) -> NoReturn:
    raise ValueError(f"{word} is not a finite number")


def _words(error: ValueError) -> str:
    if not isinstance(error, ValidationError):
        return str(error)
    first = error.errors()[0]
    place = ".".join(str(part) for part in first["loc"])
    return f"{place}: {first['msg']}" if place else first["msg"]
