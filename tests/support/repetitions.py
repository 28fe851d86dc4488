"""How often a test repeats itself: less in the usual run, as often as it should with `--long`."""

_at_length = False


def repeat_at_length() -> None:
    """From now on; called before any test is read."""
    global _at_length
    _at_length = True


def usually(usual: int, *, at_length: int) -> int:
    """How many examples, bodies or rounds to take in this run."""
    return at_length if _at_length else usual
