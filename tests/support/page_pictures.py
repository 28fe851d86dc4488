"""Make docs/pages.md, and the pictures of other documents, from what the browser tests see.

    python -m tests.support.page_pictures                        all of them, in half an hour
    python -m tests.support.page_pictures --only statistics tour these
    python -m tests.support.page_pictures --from FOLDER          without running tests

The tests that draw a picture are found by its name; they draw into $REEMBODY_SCREENSHOTS, which may
be a FOLDER of an earlier run. The pictures have 256 colours, which makes them a third of the
browser's size, and are cropped to a height that suits the document. One that looks as before, or is
missing in the folder, is left unchanged.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
BROWSER_TESTS = ROOT / "tests" / "e2e"
PICTURES = DOCS / "images" / "pages"
COLOURS = 256
TALLEST_PX = 1400
WINDOW_PX = 800
"""The height with an open dialog: below the window the page is not dimmed."""
TABLET_WINDOW_PX = 820
"""The height of a tablet on its side: what stays at its foot lies over a taller picture's text."""
DIFFERENT = 40
"""By how much of 255 a pixel of a changed page differs; dates, codes and edges differ anyway."""
LEAST_SHARE = 0.004
"""The share of such pixels that makes a new picture."""
_DRAWN = re.compile(r'(?:screenshot|draw)\([^,()]+, (f?)"([^"]+)"')


@dataclass(frozen=True)
class Page:
    """A page of the product: the name of its screenshot, its title and its purpose."""

    shot: str
    title: str
    about: str
    tallest_px: int = TALLEST_PX


COCKPIT = "cockpit-live-1280-light"
ELSEWHERE = {
    "console": COCKPIT,
    "downloads": "downloads",
    "replay": "console-replay-light",
    "storage": "storage",
    "study": "console-overview-light",
    "tablet": "tablet-form-1180",
    "tour": "tour",
}
"""Pictures of other documents, by their name in docs/images."""

CONSOLE = (
    Page("console-login-light", "Login", "For people with an account; others need an invitation."),
    Page("console-studies-light", "Studies", "Current studies, and archived ones."),
    Page(
        "console-overview-light", "A study", "Its procedure, and what to do first while it is new."
    ),
    Page("console-ledger-light", "Ledger", "Who has which order, and which slots are free again."),
    Page("console-sessions-dark", "Sessions", "One line each, with what remains to be done."),
    Page(
        "console-participants-light", "Participants", "Codes, sessions, and participants' rights."
    ),
    Page("preregistration", "Preregistration", "What was declared, what was done, and deviations."),
    Page("console-dashboard-light", "Dashboard", "Every figure with its units, n and intervals."),
    Page("statistics", "Statistics", "The study's questions, each answered in a sentence."),
    Page(
        "console-export-light", "Export", "CSV with a codebook; files are made in the background."
    ),
    Page(
        "imported",
        "Imported answers",
        "Collected with other tools, analysed separately, never pooled.",
        WINDOW_PX,
    ),
    Page("console-protocol-light", "Protocol", "What every session follows, step by step."),
    Page("pilot-power", "Pilot", "How many participants the test needs, if people are as assumed."),
    Page("study-versions", "Versions", "What changed, and whether balance starts again."),
    Page("suggestions", "Suggestions", "What experts would change."),
    Page("editor-problem", "Editor", "Form and text side by side; a problem leads to its line."),
    Page("editor-dry-run", "Dry run", "The whole procedure with its times, before anybody comes."),
    Page("editor-changes", "What changes", "Before a version is saved."),
    Page("instrument-items-light", "An instrument", "Its items, scales and scores."),
    Page("instrument-try-light", "Trying it", "The form as on the tablet, with its scores."),
    Page("instrument-editor", "Writing one", "Items and formulas, checked while they are written."),
    Page(
        "preflight", "Pre-flight", "One list of checks before the start, each passed or overridden."
    ),
    Page(
        COCKPIT,
        "Cockpit",
        "The scene in the middle, with the clock and the next action over it.",
        WINDOW_PX,
    ),
    Page("alarm-silent-dark", "An alarm", "Impossible to miss, without moving anything else."),
    Page("alarm-history-light", "Alarms so far", "When each began and ended."),
    Page("session-debriefing", "Debriefing", "Shortly before the end, with what is still missing."),
    Page(
        "session-completed",
        "A completed session",
        "What was measured, phase by phase.",
        WINDOW_PX,
    ),
    Page("console-replay-light", "Replay", "A recorded phase, synchronised with its events."),
    Page("stop-rule-console", "A held session", "A stop rule pauses it until somebody decides."),
    Page("expert-cockpit", "An expert's session", "Experts can try settings while it runs."),
    Page("consent-record", "A consent", "As signed, ready to print."),
    Page(
        "downloads", "Downloads", "Files made in the background; each can be cancelled.", WINDOW_PX
    ),
    Page("tour", "Tour", "One click starts a scripted participant."),
    Page("captures-light", "Captures", "Recorded movement in the usual formats."),
    Page(
        "capture-movement-light",
        "A capture",
        "In 3-D, with the conventions by which its file was read.",
    ),
    Page("capture-joints-light", "Its joints", "Which joint is which part of the body."),
    Page("capture-verification-light", "Verification", "The same walk on small and tall avatars."),
    Page("bodies", "Bodies", "Bodies for participants to wear, one of them in three statures."),
    Page("body", "A body", "A body from all sides, with checks, licence, and who wears it."),
    Page(
        "avatar-changed-1280-light",
        "Editing avatars",
        "Every joint with its limits and motor, in the body and as a table.",
    ),
    Page(
        "tryout-sine",
        "Trying an avatar",
        "The physics of the headset in the page: push it, and watch error and torque.",
    ),
    Page(
        "avatar-tuning-1280-light",
        "Tuning an avatar",
        "Gains found by experiment, each with its response, accepted axis by axis.",
    ),
    Page("walking", "Walking", "How long a walk takes, and how differently people walk it."),
    Page("equipment", "Equipment", "The measured latency of the lab's own equipment."),
    Page(
        "headset-test-details",
        "A headset's self-test",
        "What it measured in two minutes, each figure with its limit and what to do.",
        WINDOW_PX,
    ),
    Page("network-1280-light", "Network", "How tablets and headsets reach this machine."),
    Page("help-search-light", "Help", "These docs, searchable by heading.", WINDOW_PX),
    Page("join-light", "Joining", "An invited person chooses a name and a password."),
)
TABLET = (
    Page("tablet-pairing-1180", "Pairing", "Six characters or a QR code."),
    Page(
        "tablet-consent-1180",
        "Consent",
        "Statement by statement, with a signature if the study asks for one.",
        TABLET_WINDOW_PX,
    ),
    Page("tablet-form-820", "A form", "Large enough for a thumb, in portrait and landscape."),
    Page("tablet-offline-form", "Without a network", "The same form after its browser was killed."),
    Page("tablet-offline-sent", "Sent without a network", "Kept until the server is back."),
    Page("stop-rule-tablet", "Held", "The participant is told to wait for the operator."),
    Page("pairing-first-time", "First time", "How a device learns to trust the lab."),
)
SHOTS = frozenset({*ELSEWHERE.values(), *(page.shot for page in (*CONSOLE, *TABLET))})


def small_picture(source: Path, target: Path, tallest_px: int) -> bool:
    """Save a cropped copy of a picture with few colours; return whether it differs from before."""
    with Image.open(source) as picture:
        top = picture.crop((0, 0, picture.width, min(picture.height, tallest_px))).convert("RGB")
    if target.exists() and looks_alike(top, target):
        return False
    top.quantize(COLOURS, dither=Image.Dither.NONE).save(target, optimize=True)
    return True


def looks_alike(picture: Image.Image, before: Path) -> bool:
    """Return whether a picture has the size of one made before and nearly all of its pixels."""
    with Image.open(before) as opened:
        old = np.asarray(opened.convert("RGB"), np.int16)
    new = np.asarray(picture, np.int16)
    if old.shape != new.shape:
        return False
    differs = (np.abs(new - old) > DIFFERENT).any(axis=2)
    return float(differs.mean()) < LEAST_SHARE


def section(heading: str, pages: tuple[Page, ...]) -> list[str]:
    """Return the document's section about these pages; pages without a picture are left out."""
    lines = [f"## {heading}", ""]
    for page in pages:
        if (PICTURES / f"{page.shot}.png").exists():
            lines += [f"### {page.title}", "", page.about, ""]
            lines += [f"![{page.title}](images/pages/{page.shot}.png)", ""]
    return lines


def tests_that_draw(shots: Collection[str]) -> list[Path]:
    """Return the files of browser tests that draw any of these, by the names in their source."""
    return [
        file
        for file in sorted(BROWSER_TESTS.glob("test_*.py"))
        if any(
            _pattern(name, formatted=bool(formatted)).fullmatch(shot)
            for formatted, name in _DRAWN.findall(file.read_text(encoding="utf-8"))
            for shot in shots
        )
    ]


def _pattern(name: str, *, formatted: bool) -> re.Pattern[str]:
    """Return what matches a name, in which `{...}` stands for anything if it is formatted."""
    parts = re.split(r"\{[^}]*\}", name) if formatted else [name]
    return re.compile("[a-z0-9_-]+".join(map(re.escape, parts)))


def draw(shots: Collection[str], folder: Path) -> None:
    """Run the browser tests that draw these pictures; one that fails leaves its own out."""
    files = [str(file.relative_to(ROOT)) for file in tests_that_draw(shots)]
    environment = {**os.environ, "REEMBODY_SCREENSHOTS": str(folder)}
    command = [sys.executable, "-m", "pytest", "-q", "-m", "browser", *files]
    subprocess.run(command, cwd=ROOT, env=environment, check=False)


def write(folder: Path, only: Collection[str]) -> None:
    """Write the pictures that the folder has, and the document that shows them."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    targets = [
        (shot, DOCS / "images" / f"{name}.png", WINDOW_PX) for name, shot in ELSEWHERE.items()
    ]
    targets += [
        (page.shot, PICTURES / f"{page.shot}.png", page.tallest_px) for page in (*CONSOLE, *TABLET)
    ]
    for shot, target, tallest_px in targets:
        if shot not in only:
            continue
        source = folder / f"{shot}.png"
        if not source.exists():
            sys.stderr.write(f"no {source.name}\n")
        elif small_picture(source, target, tallest_px):
            sys.stderr.write(f"new {target.relative_to(ROOT)}\n")
    lines = [
        "# Every page",
        "",
        "Pictures taken by the browser tests on a real server; no real person appears in them.",
        "Made by `python -m tests.support.page_pictures`; do not edit.",
        "",
        *section("The console", CONSOLE),
        *section("The tablet", TABLET),
    ]
    (DOCS / "pages.md").write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")


def main(arguments: Sequence[str]) -> None:
    """Draw the pictures, or take those of a folder, and write the documents."""
    parser = argparse.ArgumentParser(prog="python -m tests.support.page_pictures")
    parser.add_argument("--from", dest="folder", type=Path, metavar="FOLDER")
    parser.add_argument("--only", nargs="+", metavar="NAME", default=sorted(SHOTS))
    asked = parser.parse_args(arguments)
    unknown = sorted(set(asked.only) - SHOTS)
    if unknown:
        parser.error(f"no picture {', '.join(unknown)}; there are {', '.join(sorted(SHOTS))}")
    if asked.folder is not None:
        write(asked.folder, asked.only)
        return
    with tempfile.TemporaryDirectory(prefix="reembody-pictures-") as scratch:
        draw(asked.only, Path(scratch))
        write(Path(scratch), asked.only)


if __name__ == "__main__":
    main(sys.argv[1:])
