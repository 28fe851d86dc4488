"""The tokens of the formula language: numbers, names, + - * / ( ) and the comma."""

import re
from dataclasses import dataclass

from app.science.instruments.errors import FormulaError

FUNCTIONS = ("mean", "sum", "min", "max")
MAX_LENGTH = 1000
# Each operator of a chain like 1+1+1... is one level of the tree: the limit keeps any traversal of
# the tree far below Python's recursion limit.
MAX_TOKENS = 400

_TOKEN = re.compile(
    r"\s*(?:(?P<number>[0-9]{1,15}(?:\.[0-9]{1,15})?(?![0-9A-Za-z_.]))"
    r"|(?P<name>[A-Za-z_][A-Za-z0-9_]*)|(?P<symbol>[-+*/(),]))"
)
_BLANKS = re.compile(r"\s*")


@dataclass(frozen=True)
class Token:
    """One token of a formula.

    `kind` is number, name, symbol or end; `position` counts characters from 0.
    """

    kind: str
    text: str
    position: int


def tokenize(text: str) -> tuple[Token, ...]:
    """Split a formula into tokens; the last one is always of kind "end".

    Raises FormulaError for a character outside the language, and for a formula that exceeds the
    limits of its length.
    """
    if len(text) > MAX_LENGTH:
        raise FormulaError(
            text,
            MAX_LENGTH,
            f"The formula has {len(text)} characters, more than {MAX_LENGTH}",
            "Split it into several scores.",
        )
    tokens: list[Token] = []
    end = len(text.rstrip())
    at = 0
    while at < end:
        found = _TOKEN.match(text, at)
        if found is None:
            raise _unreadable(text, at)
        kind = str(found.lastgroup)
        tokens.append(Token(kind, found[kind], found.start(kind)))
        at = found.end()
        if len(tokens) > MAX_TOKENS:
            raise FormulaError(
                text,
                at,
                f"The formula has more than {MAX_TOKENS} parts",
                "Split it into several scores.",
            )
    return (*tokens, Token("end", "", end))


def _unreadable(text: str, at: int) -> FormulaError:
    blanks = _BLANKS.match(text, at)
    position = at if blanks is None else blanks.end()
    return FormulaError(
        text,
        position,
        f"{text[position]!r} does not begin a number, a name or an operator",
        "Use numbers such as 4 or 0.5 (up to 15 digits), item keys, earlier scores, + - * / ( ), "
        + ", ".join(FUNCTIONS)
        + ".",
    )
