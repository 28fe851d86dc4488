"""Make the bodies that come with the product again: `python -m app.cli.figure.shipped`.

It writes the models and their measures to the folder `bodies` of the checkout. The configuration of
the standard avatar, the neutral body with mesh colliders and gains tuned for it, is tuned again and
compared: studies name it by its content, so gains that the tuning finds within a tenth of the
shipped ones leave it as it is, and others are written beside it, as the content of a new version.
"""

import hashlib
import json
import tempfile
import time
from dataclasses import asdict, replace
from pathlib import Path

from app.cli.figure.run import make
from app.features.movement.humanoids import SHIPPED_BODIES, Refused, measure
from app.protocol.avatar import avatar_text, parse_avatar_json
from app.protocol.humanoid import parse_figure
from app.resources import bodies_dir
from app.science.avatar.configuration import Configuration
from app.science.avatar.mjcf import default_configuration
from app.science.avatar.tuning import TuningOptions, tune

STATURE_M = 1.75
_STANDARD = "standard.json"
_CONFIRMED_SHARE = 0.1
_MAX_BYTES = 1_000_000


def make_shipped(folder: Path) -> None:
    """Write the shipped bodies and their measures to a folder."""
    for name in SHIPPED_BODIES:
        make(folder / f"{name}.glb", name, STATURE_M, ())
        (folder / f"{name}.json").write_text(measures_of(folder / f"{name}.glb"), encoding="utf-8")


def measures_of(model: Path) -> str:
    """Return the measures that the database stores with a model's file, as JSON."""
    with tempfile.TemporaryDirectory() as scratch:
        copy = Path(scratch) / model.name
        copy.write_bytes(model.read_bytes())
        measured = measure(_MAX_BYTES, copy)
    if isinstance(measured, Refused):
        raise ValueError(f"{model} is not a valid body: {measured.reason}")
    return json.dumps(asdict(measured), indent=1) + "\n"


def tuned_standard(folder: Path, locked_groups: tuple[str, ...] = ()) -> str:
    """Return the configuration of the standard avatar, tuned again, as the text of its file.

    Locked groups are not tuned; what is left keeps its results, as each axis is tuned alone.
    """
    figure = parse_figure(
        json.loads((folder / "neutral.json").read_text(encoding="utf-8"))["figure"]
    )
    model = hashlib.sha256((folder / "neutral.glb").read_bytes()).hexdigest()
    untuned = replace(
        default_configuration(), humanoid=model, colliders="mesh", locked_groups=locked_groups
    )
    report = tune(
        untuned, STATURE_M, TuningOptions(mirror=True), figure=figure, wall_s=time.monotonic
    )
    return avatar_text(report.configuration)


def farthest_gain(one: Configuration, other: Configuration) -> float:
    """Return the greatest difference between the gains of two configurations, as a share."""
    return max(
        abs(new / old - 1.0)
        for name, was in one.axes.items()
        for old, new in ((was.kp, other.axes[name].kp), (was.kd, other.axes[name].kd))
        if old
    )


def _update_standard(folder: Path) -> str:
    shipped, text = folder / _STANDARD, tuned_standard(folder)
    off = farthest_gain(
        parse_avatar_json(shipped.read_text(encoding="utf-8")), parse_avatar_json(text)
    )
    if off <= _CONFIRMED_SHARE:
        return f"{shipped} is confirmed: no gain differs by more than {off:.1%}"
    (folder / "standard-next.json").write_text(text, encoding="utf-8")
    return f"gains differ by up to {off:.1%}: {folder / 'standard-next.json'} has the new ones"


if __name__ == "__main__":
    make_shipped(bodies_dir())
    print(_update_standard(bodies_dir()))
