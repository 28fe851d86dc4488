"""Write an export as a folder, in a temporary folder first, and then rename it.

A reader sees either the previous export or the new one, never an incomplete one. An export replaces
an earlier Reembody export; any other existing content is refused.
"""

from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager
from pathlib import Path

from app.errors import Conflict
from app.features.results.exports.writing.contents import FOLDERS, README, TOP_LEVEL, Member
from app.features.results.exports.writing.readme import MARK

Progress = Callable[[str], None]


def silent(path: str) -> None:
    """Ignore the progress (the default callback)."""


FolderFactory = Callable[[Path], AbstractContextManager[Path]]
"""A context manager that creates a temporary folder beside a path."""


def write_folder(
    members: Iterable[Member],
    to: Path,
    *,
    temporary_folder: FolderFactory,
    progress: Progress = silent,
) -> None:
    """Write `members` to the folder `to`, and call `progress` with each path before it is written.

    Raises Conflict if something else is at `to`, and OSError if it cannot be written; in both cases
    nothing has changed.
    """
    to = to.absolute()
    check_target(to)
    to.parent.mkdir(parents=True, exist_ok=True)
    with temporary_folder(to) as workplace:
        fresh = workplace / "new"
        for folder in FOLDERS:
            (fresh / folder).mkdir(parents=True)
        for member in members:
            progress(member.path)
            with (fresh / member.path).open("xb") as file:
                file.writelines(member.pieces)
        check_target(to)
        _swap(fresh, to, workplace / "old")


def check_target(to: Path) -> None:
    """Raise Conflict unless `to` is missing, an empty folder or an earlier Reembody export."""
    if to.is_symlink() or (to.exists() and not to.is_dir()):
        raise _refused(to, "is not a folder")
    if not to.exists() or not any(to.iterdir()):
        return
    readme = to / README
    if not (readme.is_file() and readme.read_text(encoding="utf-8").startswith(MARK + "\n")):
        raise _refused(to, "is not a Reembody export")
    for path in sorted(to.rglob("*")):
        inside = path.relative_to(to)
        ours = str(inside) in TOP_LEVEL or _is_in_folder(inside)
        if not ours or path.is_symlink():
            raise _refused(to, f"also contains {inside}, which is not part of an export")


def _is_in_folder(inside: Path) -> bool:
    return any(
        inside == Path(folder) or (inside.parent == Path(folder) and inside.suffix == suffix)
        for folder, suffix in FOLDERS.items()
    )


def _swap(fresh: Path, to: Path, old: Path) -> None:
    if not to.exists():
        fresh.rename(to)
        return
    to.rename(old)
    try:
        fresh.rename(to)
    except OSError:
        old.rename(to)
        raise


def _refused(to: Path, why: str) -> Conflict:
    return Conflict(
        f"{to} {why}; nothing was written",
        value=str(to),
        valid="a new or empty folder, or an earlier export",
        remedy="Name another folder, or move what is there.",
    )
