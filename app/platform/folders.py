"""Where the data of a laboratory stand on disk, and who may look at them."""

import glob
import os
import stat
from collections.abc import Iterator
from itertools import chain, islice
from pathlib import Path

from app.database_address import IN_MEMORY, database_address
from app.errors import Conflict
from app.settings import Settings

OTHERS = 0o077
"""The bits of a mode that let anybody but the owner do something."""
BEGINNING = ".beginning-"
"""How the folder's name begins in which a new database is made."""
DATABASE_SUFFIXES = ("", "-wal", "-shm", "-journal")
_MOST_LOOKED_AT = 2000
"""Files among which another name is looked for."""
_OURS = ("backups", "quarantine", "scratch", "walking", "tls", "half-made", "erasures.jsonl")
"""What is ours in a folder that may hold other things, beside the database's own files."""
_TRACES = ("backups/*.reembody", "quarantine/*", "erasures.jsonl", "erasure-unfinished")
_TRACES_IN_DATA_DIR = ("*.reembody", "walking/*", "scratch/exports/*", "*/codebook.csv", "*.yaml")
"""Backups, fits of walking models, exports, tuned avatars."""


def database_file(settings: Settings) -> Path | None:
    """The embedded database's file; None for PostgreSQL, and for one in memory."""
    url = database_address(settings.resolved_database_url)
    if url.get_backend_name() != "sqlite" or url.database in (None, "", IN_MEMORY):
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


def require_one_name(settings: Settings) -> None:
    """Raise Conflict where the embedded database, its log or its index has a second hard link.

    SQLite keeps the log beside the name by which it opened the file. By another name it finds
    another log or none, and no lock on a folder keeps the two apart. Links that lead to a name
    (symbolic ones) do no harm: they are followed first. A file system that does not count the names
    says 0 or 1.
    """
    file = database_file(settings)
    if file is None:
        return
    file = file.resolve()
    for suffix in DATABASE_SUFFIXES:
        one = file.with_name(file.name + suffix)
        try:
            found = one.stat()
        except OSError:
            continue
        if stat.S_ISREG(found.st_mode) and found.st_nlink > 1:
            raise _more_than_one_name(one, found)


def _more_than_one_name(file: Path, found: os.stat_result) -> Conflict:
    other = _another_name(file, found)
    also = "" if other is None else f", one of which is {other}"
    rest = f"find DISK -xdev -inum {found.st_ino}" if other is None else f"rm {other}"
    how = "find the other names" if other is None else "remove the other name"
    return Conflict(
        f"{file} has {found.st_nlink} names (hard links){also}. SQLite keeps its log beside the "
        "name by which it is opened, so work under two names loses what was stored and damages the "
        "database; nothing was changed",
        value=str(file) if other is None else [str(file), str(other)],
        valid="a database file with one name",
        remedy=f"Stop every server that works under one of the names. To keep one, {how}: {rest}. "
        f"To keep both, make this one a file of its own: cp -p {file} {file}.copy && "
        f"mv {file}.copy {file}. Copy a data folder with `cp -a` while no server runs, or with "
        "`./run backup`; never with `ln` or `cp -al`.",
    )


def _another_name(file: Path, found: os.stat_result) -> Path | None:
    """Another name of a file in its folder, or its own in a folder beside that: where most are."""
    near = chain(file.parent.glob("*"), file.parent.parent.glob(f"*/{glob.escape(file.name)}"))
    for one in islice(near, _MOST_LOOKED_AT):
        try:
            same = one != file and os.path.samestat(one.lstat(), found)
        except OSError:
            continue
        if same:
            return one
    return None


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
