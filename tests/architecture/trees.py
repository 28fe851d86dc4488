"""Provide the tree to examine: the working tree, or a commit's tree in a temporary folder."""

import io
import subprocess
import tarfile
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]


@contextmanager
def tree_of(commit: str | None) -> Iterator[Path]:
    """Yield the root folder of a commit's files, or of the working tree if the commit is None."""
    if commit is None:
        yield REPOSITORY
        return
    archive = subprocess.run(
        ["git", "archive", "--format=tar", commit], cwd=REPOSITORY, capture_output=True, check=True
    ).stdout
    with tempfile.TemporaryDirectory() as folder, tarfile.open(fileobj=io.BytesIO(archive)) as tar:
        # Python 3.11.2, which Debian 12 has, knows no filter; git writes no path outside.
        tar.extraction_filter = getattr(tarfile, "data_filter", None)
        tar.extractall(folder)  # noqa: S202
        yield Path(folder)
