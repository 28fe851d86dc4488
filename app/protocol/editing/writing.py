"""Format values as YAML text: on one line if that is readable, otherwise as an indented block."""

import json
import textwrap

import yaml

from app.protocol.errors import ConfigError
from app.protocol.source import Plain, read_source

WIDTH = 100
_RESOLVER = yaml.SafeLoader("")


def inline(value: Plain) -> str:
    """Format the value on one line, in flow style, quoting words only if necessary."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_word(key)}: {inline(one)}" for key, one in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(inline, value)) + "]"
    return _word(value) if isinstance(value, str) else _plain(value)


def scalar(value: Plain, style: str | None = None) -> str:
    """Format a scalar on one line outside brackets, keeping its previous quotes if possible."""
    if not isinstance(value, str):
        return _plain(value)
    if style == '"' or "\n" in value:
        return _quoted(value)
    if style == "'":
        return "'" + value.replace("'", "''") + "'"
    return value if _reads_back(f"k: {value}\n", {"k": value}, value) else _quoted(value)


def block(value: Plain, indent: int, style: str | None = None) -> list[str]:
    """Format the value as lines after a key or a dash.

    The first line belongs on the line of the key or dash; the others, below, include their
    `indent`. `style`: the style of the scalar that is replaced.
    """
    if isinstance(value, str):
        return _text(value, indent, style)
    if not isinstance(value, dict | list):
        return [_plain(value)]
    short = inline(value)
    if not value or (_is_flat(value) and len(short) + indent <= WIDTH - 8):
        return [short]
    return ["", *_lines(value, indent)]


def entry(key: str, value: Plain, indent: int) -> list[str]:
    """Format a mapping's entry as lines, all including their `indent`."""
    first, *rest = block(value, indent + 2)
    return [" " * indent + f"{_word(key)}:" + (f" {first}" if first else ""), *rest]


def item(value: Plain, indent: int, *, spread: bool = False) -> list[str]:
    """Format a list's entry as lines, all including their `indent`.

    `spread`: one key per line, however short.
    """
    first, *rest = block(value, indent + 2)
    if spread and isinstance(value, dict) and value:
        first, rest = "", _lines(value, indent + 2)
    if first == "" and rest:
        first, *rest = rest
    return [" " * indent + "- " + first.lstrip(), *rest]


def mapping_text(tree: dict[str, Plain]) -> str:
    """Format a new file that people will edit: a part after another, a setting on each line."""
    lines: list[str] = []
    for key, value in tree.items():
        if isinstance(value, dict) and value:
            part = [f"{_word(key)}:", *_lines(value, 2)]
        elif isinstance(value, list) and any(isinstance(one, dict) for one in value):
            each = [line for one in value for line in item(one, 2, spread=True)]
            part = [f"{_word(key)}:", *each]
        else:
            part = entry(key, value, 0)
        gap = [""] if lines and len(part) > 2 else []
        lines += [*gap, *part]
    return "\n".join(lines) + "\n"


def _lines(value: dict[str, Plain] | list[Plain], indent: int) -> list[str]:
    if isinstance(value, dict):
        return [line for key, one in value.items() for line in entry(key, one, indent)]
    return [line for one in value for line in item(one, indent)]


def _is_flat(value: dict[str, Plain] | list[Plain]) -> bool:
    """Return whether a value contains only short words, or mappings of them such as labels."""
    inner = value.values() if isinstance(value, dict) else value
    return all(
        not (isinstance(one, dict | list) or (isinstance(one, str) and "\n" in one))
        or (isinstance(value, dict) and isinstance(one, dict | list) and _is_flat(one))
        for one in inner
    )


def _text(value: str, indent: int, style: str | None) -> list[str]:
    pad = " " * max(indent, 1)
    if "\n" in value:
        lines = [pad + line if line else "" for line in value.split("\n")]
        sign = "|-" if not value.endswith("\n") else "|"
        literal = [sign, *(lines if sign == "|-" else lines[:-1])]
        if _reads_back("k: " + "\n".join(literal) + "\n", {"k": value}):
            return literal
        return [_quoted(value)]
    if style == ">" and len(value) + indent > WIDTH - 20:
        wrapped = textwrap.wrap(
            value, max(WIDTH - indent, 30), break_long_words=False, break_on_hyphens=False
        )
        folded = [">-", *(pad + line for line in wrapped)]
        if _reads_back("k: " + "\n".join(folded) + "\n", {"k": value}):
            return folded
    return [scalar(value, style)]


def _plain(value: Plain) -> str:
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return "null" if value is None else json.dumps(value)


def _word(value: str) -> str:
    return value if _reads_back(f"[{value}]\n", [value], value) else _quoted(value)


def _quoted(value: str) -> str:
    """Quote a text with double quotes, escaping all line breaks that YAML recognises."""
    escaped = json.dumps(value, ensure_ascii=False)
    for mark in ("\x7f", "\x85", "\u2028", "\u2029", "\ufeff"):
        escaped = escaped.replace(mark, f"\\u{ord(mark):04x}")
    return escaped


def _reads_back(text: str, expected: Plain, word: str | None = None) -> bool:
    """Return whether the text is parsed as `expected`.

    A bare `word` must also be read as text by parsers of YAML 1.1.
    """
    if word is not None and (word != word.strip() or not word or _is_special(word)):
        return False
    try:
        return read_source(text).tree == expected
    except ConfigError:
        return False


def _is_special(word: str) -> bool:
    """Return whether YAML 1.1 gives the bare word another meaning, such as false for no."""
    tag: str = _RESOLVER.resolve(yaml.ScalarNode, word, (True, False))  # type: ignore[no-untyped-call]  # PyYAML
    return tag != "tag:yaml.org,2002:str"
