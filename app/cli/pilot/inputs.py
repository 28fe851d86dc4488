"""Read the inputs of `reembody pilot`: a study, its instruments, and what is assumed of people."""

import re
from dataclasses import dataclass
from pathlib import Path

from app.features.results.pilot import example_assumptions
from app.features.results.pilot.simulation import AvatarKind, PilotStudy, Sharing
from app.protocol import (
    ConfigError,
    LoadedAssumptions,
    LoadedInstrument,
    load_assumptions,
    load_instrument,
    load_study,
)
from app.resources import study_configs_dir
from app.science.reaching import FittedReaching

MOST_WORKERS = 64
_COUNTS = re.compile(r"\d+(,\d+)*")
_KEY = re.compile(r"^key: *([\w-]+)", re.MULTILINE)
_SHARD = re.compile(r"([1-9]\d*)/([1-9]\d*)")


@dataclass(frozen=True)
class StudyFile(PilotStudy):
    """A study that was read from a file."""

    path: Path


def read_study(name: str) -> StudyFile:
    """Read a study: a file, or the name of a shipped study or template.

    Its instruments are the product's, and those of a folder `instruments` beside the file.

    Raises ValueError with every problem of the file, OSError.
    """
    path = _study_path(name)
    instruments = {
        key: one.instrument
        for folder in (study_configs_dir(), path.parent)
        for key, one in _instruments(folder / "instruments").items()
    }
    try:
        loaded = load_study(path.read_text(encoding="utf-8"), instruments=instruments)
    except ConfigError as error:
        raise of_file(path, error) from error
    return StudyFile(loaded, instruments, path)


def read_assumptions(given: Path | None, study: StudyFile) -> LoadedAssumptions:
    """Read the assumptions of a study: a file, or the one that the product has for its key.

    Raises ValueError with every problem of the file, OSError.
    """
    protocol = study.study.protocol
    path = given or study_configs_dir() / "assumptions" / f"{protocol.key}.yaml"
    if given is None and not path.is_file():
        raise ValueError(
            f"nothing is known of how people would answer in {protocol.key!r}: write the "
            "assumptions to a file, as docs/pilot.md describes, and give it with --assumptions; "
            "`pilot assumptions STUDY` prints one to start from"
        )
    try:
        return load_assumptions(path.read_text(encoding="utf-8"), protocol, study.instruments)
    except ConfigError as error:
        raise of_file(path, error) from error


def has_assumptions(given: Path | None, study: StudyFile) -> bool:
    """Return whether there are assumptions of a study, given or the product's."""
    key = study.study.protocol.key
    return given is not None or (study_configs_dir() / "assumptions" / f"{key}.yaml").is_file()


def assumptions_to_copy(study: StudyFile) -> str:
    """Return the product's assumptions for a study, else an example; raises ValueError, OSError."""
    protocol = study.study.protocol
    path = study_configs_dir() / "assumptions" / f"{protocol.key}.yaml"
    if path.is_file():
        return path.read_text(encoding="utf-8")
    text = example_assumptions(protocol, study.instruments)
    if text is None:
        raise ValueError(f"no example can be made for {protocol.key!r}: see docs/pilot.md")
    return text


def read_counts(given: list[str]) -> tuple[int, ...]:
    """Return the numbers of participants of options such as `12` and `8,12,16`."""
    for one in given:
        if not _COUNTS.fullmatch(one):
            raise ValueError(f"--participants {one}: give numbers, as in 12 or 8,12,16")
    return tuple(int(number) for one in given for number in one.split(","))


def read_hands(given: Path | None) -> FittedReaching | None:
    """Read how hands move, a file that `reach fit` wrote; None for the simulation's constants.

    Raises ValueError if it is none, OSError.
    """
    if given is None:
        return None
    # Its science is loaded only where it is wanted.
    from app.adapters.reaching_file import read_reaching

    return read_reaching(given)


def read_shard(given: str | None) -> tuple[int, int]:
    """Return the number of this part, from 0, and of all parts of an option such as `2/3`."""
    if given is None:
        return 0, 1
    found = _SHARD.fullmatch(given)
    if found is None or int(found[1]) > int(found[2]):
        raise ValueError(f"--shard {given}: give which part of how many, as in 1/3, 2/3 and 3/3")
    return int(found[1]) - 1, int(found[2])


def require_sharing(sharing: Sharing, out: Path | None) -> None:
    """Raise ValueError if work cannot be shared out like this."""
    if not 1 <= sharing.workers <= MOST_WORKERS:
        raise ValueError(f"--workers {sharing.workers}: 1 to {MOST_WORKERS} are valid")
    if sharing.shard[1] > 1 and out is None:
        raise ValueError("--shard needs --out, the file whose parts `pilot merge` puts together")


def is_shipped(name: str) -> bool:
    """Return whether a name is the file's name or the key of a shipped study or template."""
    return name in _named()


def _study_path(name: str) -> Path:
    shipped = _shipped()
    path = _named().get(name, Path(name))
    if not path.is_file():
        raise ValueError(
            f"there is no study {name!r}, and no such file; there are: {', '.join(sorted(shipped))}"
        )
    return path


def _shipped() -> dict[str, Path]:
    root = study_configs_dir()
    files = [*root.glob("*.yaml"), *(root / "templates").glob("*.yaml")]
    return {file.stem: file for file in files}


def _named() -> dict[str, Path]:
    """Return the shipped studies by file name, and by the key that reports print."""
    shipped = _shipped()
    return {_key_of(file): file for file in shipped.values()} | shipped


def _key_of(file: Path) -> str:
    found = _KEY.search(file.read_text(encoding="utf-8"))
    return file.stem if found is None else found[1]


def _instruments(folder: Path) -> dict[str, LoadedInstrument]:
    found = {}
    for path in sorted(folder.glob("*.yaml")):
        try:
            found[path.stem] = load_instrument(path.read_text(encoding="utf-8"))
        except ConfigError as error:
            raise of_file(path, error) from error
    return found


def of_file(path: Path, error: ConfigError) -> ValueError:
    """Name the file in front of its problems."""
    lines = "\n".join(f"  {problem}" for problem in error.problems)
    count = len(error.problems)
    return ValueError(f"{path} has {count} problem{'s' if count > 1 else ''}:\n{lines}")


def read_avatar(given: str | None) -> AvatarKind | None:
    """Return the kind of avatar of an option; None if it is not given."""
    match given:
        case None | "physics" | "physics_without_fingers" | "delayed_copy":
            return given
        case _:
            raise ValueError(
                f"--avatar {given}: physics, physics_without_fingers and delayed_copy are valid"
            )
