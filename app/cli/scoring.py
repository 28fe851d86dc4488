"""Score a table of answers from the command line."""

from pathlib import Path

from app.protocol import load_instrument
from app.resources import study_configs_dir
from app.science.instruments.table import score_csv


def score_file(answers: Path, instrument_key: str) -> str:
    """Return the scored table as CSV; raise ValueError or OSError if the input is unusable."""
    folder = study_configs_dir() / "instruments"
    by_key = {path.stem: path for path in sorted(folder.glob("*.yaml"))}
    if instrument_key not in by_key:
        raise ValueError(
            f"there is no instrument {instrument_key!r}; there are: {', '.join(by_key)}"
        )
    loaded = load_instrument(by_key[instrument_key].read_text(encoding="utf-8"))
    try:
        text = answers.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{answers} is not UTF-8 text; save it as CSV UTF-8") from error
    return score_csv(loaded.instrument, text)
