"""Find a Chromium without requiring an installation.

It tries, in this order, the program `$CHROMIUM`, a system Chromium, and the npm package
`@sparticuz/chromium`, which contains Chromium's headless shell with the libraries and fonts that a
bare machine lacks. The package is installed once into `.cache/` of the checkout. (Playwright's own
download is not used: it fetches from a host that closed networks do not reach.)
"""

import hashlib
import os
import shutil
from dataclasses import dataclass, field
from pathlib import Path
from xml.sax.saxutils import escape

from tests.support.node import npm_ci, run_node
from tests.support.shared_run import locked

SYSTEM = ("/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome")
REPOSITORY = Path(__file__).resolve().parents[2]
PACKAGE = Path(__file__).resolve().parent / "chromium"
FONTS_CONFIG = "fonts-of-the-package.conf"


@dataclass(frozen=True)
class Chromium:
    """A Chromium program and the environment variables it needs."""

    executable: Path
    environment: dict[str, str] = field(default_factory=dict)


def find_chromium() -> Chromium:
    """Return the first Chromium that exists; raise `FileNotFoundError` if `$CHROMIUM` is wrong."""
    chosen = os.environ.get("CHROMIUM")
    if chosen:
        if not Path(chosen).is_file():
            raise FileNotFoundError(
                f"CHROMIUM names {chosen}, which is not a file: unset it to let the tests choose"
            )
        return Chromium(Path(chosen))
    for program in map(Path, SYSTEM):
        if program.is_file():
            return Chromium(program)
    return packaged_chromium()


def packaged_chromium() -> Chromium:
    """Return the Chromium of the npm package, unpacked on first use."""
    unpacked = installed_packages() / "unpacked"
    executable = unpacked / "chromium"
    libraries = unpacked / "al2023" / "lib"
    inherited = os.environ.get("LD_LIBRARY_PATH")
    return Chromium(
        executable,
        {
            "LD_LIBRARY_PATH": f"{libraries}:{inherited}" if inherited else str(libraries),
            "FONTCONFIG_FILE": str(unpacked / FONTS_CONFIG),
        },
    )


def axe_script() -> Path:
    """Return the path of the accessibility checker axe-core: the frontend's copy, else ours."""
    frontend = REPOSITORY / "frontend" / "node_modules" / "axe-core" / "axe.min.js"
    if frontend.is_file():
        return frontend
    return installed_packages() / "node_modules" / "axe-core" / "axe.min.js"


def installed_packages() -> Path:
    """Return the folder in `.cache/` with the packages installed and Chromium unpacked.

    Its name is the hash of the lock file and of the files generated here: another version gets
    another folder.
    """
    what = (PACKAGE / "package-lock.json").read_bytes() + FONTS_CONFIG.encode()
    key = hashlib.sha256(what).hexdigest()[:16]
    cache = REPOSITORY / ".cache" / "chromium"
    folder = cache / key
    with locked(cache / "install.lock"):
        if not (folder / "done").exists():
            shutil.rmtree(folder, ignore_errors=True)
            shutil.copytree(PACKAGE, folder)
            npm_ci(folder)
            _unpack(folder)
            (folder / "done").touch()
    return folder


def _unpack(folder: Path) -> None:
    unpacked = folder / "unpacked"
    unpacked.mkdir()
    environment = {
        # The package unpacks into the temporary folder, and its libraries only if it believes
        # that it runs where they are missing.
        "TMPDIR": str(unpacked),
        "AWS_LAMBDA_JS_RUNTIME": "nodejs24.x",
    }
    run_node("unpack.mjs", cwd=folder, environment=environment)
    # The package's own configuration looks for fonts in fixed places; a Chromium that finds none
    # ends at the first text it has to draw with a fallback.
    (unpacked / FONTS_CONFIG).write_text(
        "<?xml version='1.0'?><!DOCTYPE fontconfig SYSTEM 'fonts.dtd'><fontconfig>"
        f"<dir>{escape(str(unpacked / 'fonts'))}</dir>"
        f"<cachedir>{escape(str(unpacked / 'fonts-cache'))}</cachedir>"
        "</fontconfig>\n",
        encoding="utf-8",
    )
