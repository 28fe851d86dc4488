"""Choose how often a test repeats: few times in the usual run, the full number with `--long`."""

_at_length = False


def repeat_at_length() -> None:
    """Use the full number of repetitions from now on; called before tests are collected."""
    global _at_length
    _at_length = True


def usually(usual: int, *, at_length: int) -> int:
    """Return the number of examples, bodies or rounds for this run."""
    return at_length if _at_length else usual
