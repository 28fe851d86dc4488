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
        tar.extractall(folder, filter="data")
        yield Path(folder)
