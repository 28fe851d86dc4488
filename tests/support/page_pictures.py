"""Generate docs/pages.md, and the pictures of other documents, from the browser tests' shots.

    REEMBODY_SCREENSHOTS=FOLDER ./run test -m browser tests/e2e

    python -m tests.support.page_pictures FOLDER

The pictures have 256 colours, which makes them a third of the browser's size, and are cropped to a
height that suits the document. A picture that is missing in the folder is left unchanged.
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
"""The height with an open dialog: below the window the page is not dimmed."""


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
    Page("session-completed", "A completed session", "What was measured, phase by phase."),
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
    ),
    Page("tablet-form-820", "A form", "Large enough for a thumb, in portrait and landscape."),
    Page("tablet-offline-form", "Without a network", "The same form after its browser was killed."),
    Page("tablet-offline-sent", "Sent without a network", "Kept until the server is back."),
    Page("stop-rule-tablet", "Held", "The participant is told to wait for the operator."),
    Page("pairing-first-time", "First time", "How a device learns to trust the lab."),
)


def small_picture(source: Path, target: Path, tallest_px: int) -> None:
    """Save a cropped copy of a picture with few colours."""
    with Image.open(source) as picture:
        top = picture.crop((0, 0, picture.width, min(picture.height, tallest_px)))
        few = top.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
        few.save(target, optimize=True)


def section(heading: str, pages: tuple[Page, ...]) -> list[str]:
    """Return the document's section about these pages; pages without a picture are left out."""
    lines = [f"## {heading}", ""]
    for page in pages:
        if (PICTURES / f"{page.shot}.png").exists():
            lines += [f"### {page.title}", "", page.about, ""]
            lines += [f"![{page.title}](images/pages/{page.shot}.png)", ""]
    return lines


def main(folder: Path) -> None:
    """Write the pictures and the document that shows them."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    for name, shot in ELSEWHERE.items():
        if (folder / f"{shot}.png").exists():
            small_picture(folder / f"{shot}.png", DOCS / "images" / f"{name}.png", WINDOW_PX)
    for page in (*CONSOLE, *TABLET):
        source = folder / f"{page.shot}.png"
        if source.exists():
            small_picture(source, PICTURES / source.name, page.tallest_px)
        else:
            sys.stderr.write(f"no {source.name}\n")
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


if __name__ == "__main__":
    main(Path(sys.argv[1]))
