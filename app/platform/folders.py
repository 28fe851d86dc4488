"""Locate a laboratory's data on disk, and protect them from other users of the machine."""

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
"""The bits of a file mode that give other users any permission."""
BEGINNING = ".beginning-"
"""The prefix of the folder in which a new database is made."""
DATABASE_SUFFIXES = ("", "-wal", "-shm", "-journal")
_MOST_LOOKED_AT = 2000
"""Maximum number of files to search for another hard link."""
_OURS = (
    *("backups", "quarantine", "scratch", "walking", "tunings", "pilots"),
    *("tls", "half-made", "erasures.jsonl"),
)
"""Our files in a folder that may contain others, apart from the database's own files."""
_TRACES = ("backups/*.reembody", "quarantine/*", "erasures.jsonl", "erasure-unfinished")
_TRACES_IN_DATA_DIR = ("*.reembody", "walking/*", "scratch/exports/*", "*/codebook.csv", "*.yaml")
"""Backups, fitted walking models, exports, tuned avatars."""


def database_file(settings: Settings) -> Path | None:
    """Return the embedded database's file; None for PostgreSQL and for a database in memory."""
    url = database_address(settings.resolved_database_url)
    if url.get_backend_name() != "sqlite" or url.database in (None, "", IN_MEMORY):
        return None
    return Path(str(url.database))


def home_of(settings: Settings) -> Path:
    """Return the folder that contains everything belonging to the database.

    It is the folder of the database file, or the data folder if there is no file.
    """
    file = database_file(settings)
    return (settings.data_dir if file is None else file.parent).absolute()


def backups_of(settings: Settings) -> Path:
    """Return the folder for automatic backups."""
    return home_of(settings) / "backups"


def is_there(file: Path) -> bool:
    """Return whether there is a database file, or a link that should lead to one.

    If a link points to a disk that is not mounted, no new database may be created. Raises OSError
    if it cannot be determined, as in a folder that may not be read.
    """
    try:
        os.lstat(file)
    except (FileNotFoundError, NotADirectoryError):
        return False
    return True


def require_one_name(settings: Settings) -> None:
    """Raise Conflict if the embedded database, its log or its index has a second hard link.

    SQLite keeps the log next to the name by which it opened the file. Under another name it finds
    another log or none, and no lock on a folder keeps the two apart. Symbolic links do no harm:
    they are followed first. A file system that does not count hard links reports 0 or 1.
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
        f"{file} has {found.st_nlink} names (hard links){also}. SQLite keeps its log next to the "
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
    """Find a second hard link to a file: in its folder, or of the same name in a sibling folder."""
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
    """List the files that a previous database has left in the data folder; empty for a new one."""
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
    """Remove other users' access to the data; return the paths for which that failed.

    Folders become 0700 and files 0600, if they have more permissions than that and belong to the
    user who runs this. The data folder itself is closed, too, unless everybody uses it (such as
    /tmp) or it is somebody's home. Links are not followed.
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
            # A file system without permission bits accepts the call and changes nothing.
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
