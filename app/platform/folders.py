"""Where the data of a laboratory stand on disk, and who may look at them."""

import os
import stat
from collections.abc import Iterator
from pathlib import Path

from app.database_address import database_address
from app.settings import Settings

OTHERS = 0o077
"""The bits of a mode that let anybody but the owner do something."""
BEGINNING = ".beginning-"
"""How the folder's name begins in which a new database is made."""
DATABASE_SUFFIXES = ("", "-wal", "-shm", "-journal")
_OURS = ("backups", "quarantine", "scratch", "walking", "tls", "half-made", "erasures.jsonl")
"""What is ours in a folder that may hold other things, beside the database's own files."""
_TRACES = ("backups/*.reembody", "quarantine/*", "erasures.jsonl", "erasure-unfinished")
_TRACES_IN_DATA_DIR = ("*.reembody", "walking/*", "scratch/exports/*", "*/codebook.csv", "*.yaml")
"""Backups, fits of walking models, exports, tuned avatars."""


def database_file(settings: Settings) -> Path | None:
    """The embedded database's file; None for PostgreSQL, and for one in memory."""
    url = database_address(settings.resolved_database_url)
    if url.get_backend_name() != "sqlite" or url.database in (None, "", ":memory:"):
        return None
    return Path(str(url.database))


def home_of(settings: Settings) -> Path:
    """The folder of what belongs to the database: that of its file, else the data folder."""
    file = database_file(settings)
    return (settings.data_dir if file is None else file.parent).absolute()


def backups_of(settings: Settings) -> Path:
    """The folder for backups that are made without being asked for."""
    return home_of(settings) / "backups"


def is_there(file: Path) -> bool:
    """Whether there is a database file, or a link that should lead to one.

    A link into a disk that is not there is no place to begin a new database in. Raises OSError
    where nobody can tell, as in a folder that may not be looked into.
    """
    try:
        os.lstat(file)
    except (FileNotFoundError, NotADirectoryError):
        return False
    return True


def traces_of_a_database(settings: Settings) -> list[str]:
    """What in the folder of the data was left by a database, in words; nothing for a new folder."""
    home, found = home_of(settings), list[str]()
    patterns = [*_TRACES]
    file = database_file(settings)
    if file is not None:
        patterns += [f"{file.name}{suffix}" for suffix in DATABASE_SUFFIXES[1:]]
    if home.resolve() == settings.data_dir.resolve():
        patterns += _TRACES_IN_DATA_DIR
    link = settings.data_dir / "reembody.sqlite"
    if not settings.database_url and link.is_symlink():
        found.append(f"the link {link.name}")
    for pattern in patterns:
        there = sorted(home.glob(pattern))
        if len(there) == 1:
            found.append(str(there[0].relative_to(home)))
        elif there:
            found.append(f"{pattern} ({len(there)})")
    return found


def protect(settings: Settings) -> list[Path]:
    """Take from others what they may do with the data; what it could not be taken of.

    Folders become 0700 and files 0600, where they are more than that and belong to whoever runs
    this. The data folder itself is closed, too, unless it is everybody's (as /tmp is) or somebody's
    home. Links are not followed.
    """
    failed: list[Path] = []
    if os.name != "posix":
        return failed
    home, data_dir = home_of(settings).resolve(), settings.data_dir.resolve()
    for path in _data_in(home, data_dir, database_file(settings)):
        try:
            found = os.lstat(path)
            if stat.S_ISLNK(found.st_mode) or not found.st_mode & OTHERS:
                continue
            path.chmod(0o700 if stat.S_ISDIR(found.st_mode) else 0o600)
            # A file system without such modes takes the call and changes nothing.
            if os.lstat(path).st_mode & OTHERS:
                failed.append(path)
        except FileNotFoundError:
            continue
        except OSError:
            failed.append(path)
    return failed


def _data_in(home: Path, data_dir: Path, file: Path | None) -> Iterator[Path]:
    for folder in {home, data_dir}:
        if folder == data_dir and _is_ours_alone(folder):
            yield folder
        for name in _OURS:
            yield folder / name
            if not (folder / name).is_symlink():
                yield from (folder / name).rglob("*")
    if file is not None:
        yield from (file.absolute().with_name(file.name + suffix) for suffix in DATABASE_SUFFIXES)


def _is_ours_alone(folder: Path) -> bool:
    try:
        found = folder.lstat()
    except OSError:
        return False
    everybodys = found.st_mode & stat.S_ISVTX or os.path.ismount(folder)
    return found.st_uid == os.geteuid() and not everybodys and folder != Path.home()
