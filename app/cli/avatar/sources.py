"""Read what `reembody avatar` is given as a source: a file, or a saved version of an avatar."""

import re
from dataclasses import dataclass
from pathlib import Path

from app.cli.avatar.library import Library
from app.cli.avatars import check_key
from app.errors import NotFound
from app.features.movement.avatar import MAX_VERSION
from app.protocol import MAX_FILE_BYTES, ConfigError
from app.protocol.avatar import FORMAT, SINGLE_FORMAT, VERSION, load_avatar
from app.protocol.avatar_editing import Versions
from app.science.avatar.configuration import AvatarProblem, AvatarSettingsError, Configuration

_NUMBER = re.compile(r"[1-9][0-9]{0,6}")


@dataclass(frozen=True)
class Source:
    """A configuration and where it is from.

    Attributes:
        configuration: what was read.
        name: the file, or the key and version of a saved avatar.
        form: the format of the file; for a saved version that of the file that `load` writes.
        form_version: the version of that format.
        saved: the key and version of a saved avatar; None for a file.
    """

    configuration: Configuration
    name: str
    form: str = FORMAT
    form_version: int = VERSION
    saved: tuple[str, int] | None = None


def read(library: Library, source: str) -> Source:
    """Read a file, or a saved version: KEY or KEY@NUMBER.

    Raises ValueError with every problem of a file, OSError, NotFound.
    """
    if is_file(source):
        return read_file(Path(source))
    key, number = _key_and_number(source)
    found = library.version(key, number)
    name = f"{found.key}, version {found.number}"
    return Source(found.configuration, name, saved=(found.key, found.number))


def is_file(source: str) -> bool:
    """Return whether a source names a file: with a suffix or a folder, or as it exists."""
    return source.endswith(".json") or "/" in source or Path(source).exists()


def read_file(path: Path) -> Source:
    """Read a file in either template; raises ValueError, OSError."""
    try:
        text = text_of(path)
        form = SINGLE_FORMAT if SINGLE_FORMAT in text else FORMAT
        return Source(load_avatar(text).configuration, str(path), form)
    except UnicodeDecodeError:
        raise ValueError(
            f"{path} is not a text file in UTF-8: choose a file that was saved by the page Avatars"
            " or by `reembody avatar load`"
        ) from None
    except ConfigError as error:
        told = "\n".join(f"  {problem}" for problem in error.problems)
        raise ValueError(f"{path} is not a valid configuration:\n{told}") from None


def text_of(path: Path) -> str:
    """Read a text file of at most the size of a configuration; raises ValueError, OSError.

    A larger one, or a device without an end, is read no further.
    """
    with path.open("rb") as file:
        data = file.read(MAX_FILE_BYTES + 1)
    if len(data) > MAX_FILE_BYTES:
        raise ValueError(
            f"{path} is too large:\n  It has more than {MAX_FILE_BYTES} bytes, which no"
            " configuration and no list of operations has. Choose another file."
        )
    return data.decode("utf-8-sig")


def versions_of(library: Library) -> Versions:
    """Return a function that finds the saved versions to which operations refer."""

    def known(key: str, number: int | None) -> Configuration:
        try:
            return library.version(key, number).configuration
        except NotFound as error:
            problem = AvatarProblem("key", f"{error.message}.", error.value, error.valid)
            raise AvatarSettingsError((problem,)) from None

    return known


def _key_and_number(source: str) -> tuple[str, int | None]:
    key, at, number = source.partition("@")
    check_key("the avatar", key)
    if at and not (_NUMBER.fullmatch(number) and int(number) <= MAX_VERSION):
        raise ValueError(
            f"{source[:120]!r}: after @ comes the number of a version, from 1 to {MAX_VERSION}, as"
            f" in {key}@2"
        )
    return key, int(number) if at else None
