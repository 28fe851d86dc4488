"""Let test servers ship studies whose avatar is a delayed copy instead of a physics avatar.

The product's studies use a physics avatar, and a headset that cannot simulate one is refused. Most
tests concern something else, and their headsets are a few lines long. A test of physics stores
`tests.protocol.helpers.SHIPPED`, or rehearses with `physics=True`.
"""

from pathlib import Path

from tests.protocol.helpers import CONFIGS, as_delayed_copy
from tests.support.shared_run import once, run_folder


def delayed_copies() -> Path:
    """Return the folder with the changed studies, created once in a run."""
    folder = run_folder() / "shipped-studies"
    with once("shipped-studies") as mark:
        if mark:
            write_delayed_copies(folder)
            mark.touch()
    return folder


def write_delayed_copies(folder: Path) -> None:
    """Create the folder with the changed studies."""
    folder.mkdir()
    for file in CONFIGS.glob("*.yaml"):
        text = as_delayed_copy(file.read_text(encoding="utf-8"))
        (folder / file.name).write_text(text, encoding="utf-8")
