"""Select the lines of texts that apply to one kind of avatar only.

A body that is moved by physics is stopped by the boxes; a delayed copy passes through them. A line
of a text that begins with `[avatar: physics]` or `[avatar: delayed_copy]` is used only in studies
with that avatar. Marks are removed, and lines for the other kind dropped, wherever a study is
loaded (`app.protocol.loading`), so no later code can show a participant the wrong one.
"""

import re
from collections.abc import Iterator, Mapping, Sequence

from app.protocol.source import Path, Plain
from app.protocol.study import StudyProtocol
from app.science.instruments import DefinitionProblem

KINDS = ("delayed_copy", "physics")
_MARK = re.compile(r"\[avatar:[ \t]*([^\]\n]*?)[ \t]*\][ \t]*")


def with_avatar_lines(protocol: StudyProtocol) -> StudyProtocol:
    """Return the study with only the text lines that apply to its avatar."""
    texts = {
        key: {
            language: lines_for_avatar(protocol.avatar, words) for language, words in text.items()
        }
        for key, text in protocol.texts.items()
    }
    return protocol if texts == protocol.texts else protocol.model_copy(update={"texts": texts})


def lines_for_avatar(avatar: str, text: str) -> str:
    """Return the lines of a text for one kind of avatar, without their marks."""
    if "[avatar:" not in text:
        return text
    selected: list[str] = []
    for line in text.split("\n"):
        mark = _MARK.match(line)
        if mark is not None and mark[1] != avatar:
            # Also drop the empty line before it, which would leave a gap.
            if selected and not selected[-1].strip():
                selected.pop()
            continue
        selected.append(line if mark is None else line[mark.end() :])
    return "\n".join(selected).strip("\n")


def mark_problems(
    path: Path, wordings: Mapping[str, str], avatar: Plain
) -> Iterator[DefinitionProblem]:
    """Yield the problems of the marks in a text.

    These are marks of an unknown kind, within a line, or outside texts; and texts left empty.
    """
    for language, words in wordings.items():
        at = (*path, language)
        marks = [mark for line in words.split("\n") for mark in _MARK.finditer(line)]
        in_text = path[0] == "texts"
        found = [one for mark in marks for one in _of_mark(at, mark, in_text=in_text)]
        yield from found
        if (
            not found
            and isinstance(avatar, str)
            and words.strip()
            and not lines_for_avatar(avatar, words).strip()
        ):
            yield DefinitionProblem(
                at,
                f"With the avatar {avatar}, this text is empty.",
                avatar,
                _marks(KINDS),
                f"Add a line that begins with [avatar: {avatar}], or one without a mark.",
            )


def _of_mark(at: Path, mark: re.Match[str], *, in_text: bool) -> Iterator[DefinitionProblem]:
    if mark[1] not in KINDS:
        yield DefinitionProblem(
            at,
            f"The mark names the avatar {mark[1]!r}, which does not exist.",
            mark[1],
            list(KINDS),
            f"Begin the line with {' or '.join(_marks(KINDS))}.",
        )
    elif mark.start() > 0 or not in_text:
        yield DefinitionProblem(
            at,
            "A mark for one kind of avatar is in a place where it has no effect.",
            mark[0].strip(),
            "the beginning of a line under texts",
            "Put it at the beginning of a line of a text, or remove it.",
        )


def _marks(kinds: Sequence[str]) -> list[str]:
    return [f"[avatar: {kind}]" for kind in kinds]
