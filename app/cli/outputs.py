"""Check where a command writes before it does any work: nothing that it reads is written over."""

from collections.abc import Callable
from pathlib import Path


def require_folder_of(out: Path | None) -> None:
    """Raise ValueError if the folder of an output file is missing, before any work is done."""
    if out is not None and not out.absolute().parent.is_dir():
        raise ValueError(f"--out {out}: there is no folder {out.absolute().parent}")


def require_output(out: Path | None, *inputs: Path | str | None) -> None:
    """Check an output file that may not be one of the inputs.

    Links are followed.

    Args:
        out: the file to write; None for none.
        inputs: the files that are read. One may also be a name that is no file, such as a key.

    Raises:
        ValueError: its folder is missing, or it is one of the inputs.
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
    """Check that no file of another kind is lost; an empty one may be replaced.

    Args:
        out: the file to write.
        title: what is written, as in "a walking model".
        is_one: whether a file is one.

    Raises:
        ValueError: there is a file already that is of another kind.
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
