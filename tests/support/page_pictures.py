"""docs/pages.md: every page with a picture, from the screenshots that the browser tests take.

    REEMBODY_SCREENSHOTS=FOLDER ./run test -m browser tests/e2e
    python -m tests.support.page_pictures FOLDER

The pictures have 256 colours, a third of the size that a browser saves, and end where a reader
stops scrolling. A picture that the folder lacks is left as it was.
"""

import sys
from dataclasses import dataclass
from pathlib import Path

from PIL import Image

DOCS = Path(__file__).resolve().parents[2] / "docs"
PICTURES = DOCS / "images" / "pages"
COLOURS = 256
TALLEST_PX = 1400
WINDOW_PX = 800
"""Where a dialog is open: below the window the page is not dimmed."""


@dataclass(frozen=True)
class Page:
    """A page of the product: what the browser tests call its screenshot, and what it is for."""

    shot: str
    title: str
    about: str
    tallest_px: int = TALLEST_PX


CONSOLE = (
    Page("console-login-light", "Login", "Whoever has an account; everybody else is invited."),
    Page("console-studies-light", "Studies", "What runs, and what was put away."),
    Page(
        "console-overview-light", "A study", "Its procedure, and the first steps while it is new."
    ),
    Page("console-ledger-light", "Ledger", "Who has which order, and which slots are free again."),
    Page("console-sessions-dark", "Sessions", "One line each, with what is still open."),
    Page("console-participants-light", "Participants", "Codes, visits, and their rights."),
    Page("preregistration", "Preregistration", "What was declared, what was done, and deviations."),
    Page("console-dashboard-light", "Dashboard", "Every figure with its units, n and intervals."),
    Page("statistics", "Statistics", "The study's questions, each answered in a sentence."),
    Page(
        "console-export-light", "Export", "CSV with a codebook; files are made in the background."
    ),
    Page(
        "imported",
        "Imported answers",
        "Collected elsewhere, described apart, never pooled.",
        WINDOW_PX,
    ),
    Page("console-protocol-light", "Protocol", "What every session follows, step by step."),
    Page("study-versions", "Versions", "What changed, and whether balance begins anew."),
    Page("suggestions", "Suggestions", "What experts would set otherwise."),
    Page("editor-problem", "Editor", "Form and text side by side; a problem leads to its line."),
    Page("editor-dry-run", "Dry run", "The whole procedure in minutes before anybody comes."),
    Page("editor-changes", "What changes", "Before a version is saved."),
    Page("instrument-items-light", "An instrument", "Its items, scales and scores."),
    Page("instrument-try-light", "Trying it", "The tablet's own form, with the scores beside it."),
    Page("instrument-editor", "Writing one", "Items and formulas, checked while they are written."),
    Page("preflight", "Pre-flight", "One list before the start, green or overridden."),
    Page("cockpit-live", "Cockpit", "The next action, the clock, and both bodies in space."),
    Page("alarm-silent-dark", "An alarm", "It cannot be missed, and nothing jumps."),
    Page("alarm-history-light", "Alarms so far", "When each began and ended."),
    Page("session-debriefing", "Debriefing", "The end is close; what is missing is told."),
    Page("session-completed", "A completed session", "What was measured, phase by phase."),
    Page("console-replay-light", "Replay", "A phase again, in step with what happened in it."),
    Page("stop-rule-console", "A held session", "A stop rule holds it until somebody decides."),
    Page("expert-cockpit", "An expert's session", "Settings are tried while it runs."),
    Page("consent-record", "A consent", "As it was signed, ready to print."),
    Page("downloads", "Downloads", "Files made in the background, with cancel.", WINDOW_PX),
    Page("tour", "Tour", "One click plays a scripted participant."),
    Page("captures-light", "Captures", "Recorded movement in any of the labs' formats."),
    Page("capture-movement-light", "A capture", "In space, with how its file was read."),
    Page("capture-joints-light", "Its joints", "Which joint plays which part of the body."),
    Page("capture-verification-light", "Verification", "The same walk on small and tall avatars."),
    Page("walking", "Walking", "How long a walk takes, and how differently people walk it."),
    Page("equipment", "Equipment", "Latency that was measured on the lab's own machines."),
    Page("network-1280-light", "Network", "How tablets and headsets reach this machine."),
    Page("join-light", "Joining", "Whoever was invited chooses a password."),
)
TABLET = (
    Page("tablet-pairing-1180", "Pairing", "Six characters or a QR code."),
    Page("tablet-consent-1180", "Consent", "Statement by statement, and a signature if asked for."),
    Page("tablet-form-820", "A form", "Large enough for a thumb, upright and lying."),
    Page("tablet-offline-form", "Without a network", "The same form after its browser was killed."),
    Page("tablet-offline-sent", "Sent without a network", "Kept until the server is back."),
    Page("stop-rule-tablet", "Held", "Somebody comes."),
    Page("pairing-first-time", "First time", "How a device learns to trust the lab."),
)


def small_picture(source: Path, target: Path, tallest_px: int) -> None:
    """Write a picture with few colours."""
    with Image.open(source) as picture:
        top = picture.crop((0, 0, picture.width, min(picture.height, tallest_px)))
        few = top.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
        few.save(target, optimize=True)


def section(heading: str, pages: tuple[Page, ...]) -> list[str]:
    """The part of the document about some pages; those without a picture are not in it."""
    lines = [f"## {heading}", ""]
    for page in pages:
        if (PICTURES / f"{page.shot}.png").exists():
            lines += [f"### {page.title}", "", page.about, ""]
            lines += [f"![{page.title}](images/pages/{page.shot}.png)", ""]
    return lines


def main(folder: Path) -> None:
    """Write the pictures, and the document that shows them."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    for page in (*CONSOLE, *TABLET):
        source = folder / f"{page.shot}.png"
        if source.exists():
            small_picture(source, PICTURES / source.name, page.tallest_px)
        else:
            sys.stderr.write(f"no {source.name}\n")
    lines = [
        "# Every page",
        "",
        "Taken by the browser tests from a real server; nobody in them is a person. Made by",
        "`python -m tests.support.page_pictures`; do not edit.",
        "",
        *section("The console", CONSOLE),
        *section("The tablet", TABLET),
    ]
    (DOCS / "pages.md").write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
