"""Make the bodies that come with the product again: `python -m app.cli.figure.shipped`.

It writes the models and their measures to the folder `bodies` of the checkout, and the
configuration of the standard avatar: the neutral body with mesh colliders and the gains that the
tuning finds for it.
"""

import hashlib
import json
import tempfile
import time
from dataclasses import asdict, replace
from pathlib import Path

from app.cli.figure.run import make
from app.features.movement.humanoids import SHIPPED_BODIES, Refused, measure
from app.protocol.avatar import avatar_text
from app.protocol.humanoid import parse_figure
from app.resources import bodies_dir
from app.science.avatar.mjcf import default_configuration
from app.science.avatar.tuning import TuningOptions, tune

STATURE_M = 1.75
_STANDARD = "standard.json"
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


def tuned_standard(folder: Path) -> str:
    """Return the configuration of the standard avatar as the text of its file."""
    figure = parse_figure(
        json.loads((folder / "neutral.json").read_text(encoding="utf-8"))["figure"]
    )
    model = hashlib.sha256((folder / "neutral.glb").read_bytes()).hexdigest()
    untuned = replace(default_configuration(), humanoid=model, colliders="mesh")
    report = tune(
        untuned, STATURE_M, TuningOptions(mirror=True), figure=figure, wall_s=time.monotonic
    )
    return avatar_text(report.configuration)


if __name__ == "__main__":
    make_shipped(bodies_dir())
    (bodies_dir() / _STANDARD).write_text(tuned_standard(bodies_dir()), encoding="utf-8")
