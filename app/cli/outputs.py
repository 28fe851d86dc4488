"""Check where a command writes before it does any work: nothing that it reads is written over."""

from collections.abc import Callable
from pathlib import Path

from app.cli.errors import require_folder_of


def require_output(out: Path | None, *inputs: Path | str | None) -> None:
    """Raise ValueError if the folder of an output file is missing, or if it is one of the inputs.

    Links are followed. An input may also be a name that is no file.
    """
    require_folder_of(out)
    if out is None:
        return
    for one in inputs:
        if one is not None and _is_same(out, Path(one)):
            raise ValueError(
                f"--out {out}: that is {one}, which is read, and it would be lost: name another"
                " file to write"
            )


def require_replaceable(out: Path, title: str, is_one: Callable[[Path], bool]) -> None:
    """Raise ValueError if there is a file already that is of another kind than the one written.

    `title` says what is written, as in "a walking model". An empty file may be replaced.
    """
    if out.is_file() and out.stat().st_size and not is_one(out):
        raise ValueError(
            f"--out {out}: there is a file already that is not {title}, and it would be lost: name"
            " another file, or delete that one first"
        )


def _is_same(out: Path, other: Path) -> bool:
    try:
        return out.samefile(other)
    except (OSError, ValueError):  # one of them does not exist, or is no path
        return False
