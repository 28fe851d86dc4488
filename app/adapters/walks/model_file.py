"""Store a fitted walking model as a file: the tables of its walks, and how it was fitted.

The file is a NumPy archive without pickles: `header`, a JSON text, and the tables of the database.
The space is not stored, because the seed reproduces it. The header contains a hash of everything
else, so that a truncated or changed file is rejected. What P_mixed learnt is in the header, where a
file of an earlier version has nothing: it predicts with P_prob, and earlier programs read new files
as they did before. The file is written next to its destination
and then moved there: a reader finds either the old or the new file, complete.
"""

import hashlib
import json
import zipfile
from dataclasses import asdict
from pathlib import Path
from typing import IO, Any

import numpy as np

from app.science.walking.following import FollowingRules
from app.science.walking.maps import SuitabilityOptions, WalkDatabase
from app.science.walking.models import FitOptions, FittedWalking, ReadingScore, StaticFit, restored
from app.science.walking.records import ParameterGrid, SteeringParameter, WalkingError
from app.science.walking.travel_times import Posterior, StartingAndStopping
from app.whole_files import write_whole

FORMAT, VERSION = "reembody-walking-model", 1
MOST_BYTES = 2_000_000_000
_TABLES = ("vectors", "deviations", "arrivals_s", "durations_s", "lengths_m")


def write_model(path: Path, fit: FittedWalking, rules: FollowingRules) -> str:
    """Write a model atomically and return its content hash; raise OSError."""
    tables = {name: np.ascontiguousarray(getattr(fit.database, name)) for name in _TABLES}
    header = _header(fit, rules)
    digest = content_hash(header, tables)
    text = json.dumps({**header, "content_hash": digest}, sort_keys=True)
    letters = np.frombuffer(text.encode(), dtype=np.uint8)

    def write(file: IO[bytes]) -> None:
        np.savez_compressed(file, allow_pickle=False, header=letters, **tables)

    write_whole(path, write)
    return digest


def read_model(path: Path) -> tuple[FittedWalking, FollowingRules, str]:
    """Read a model; return it with the rules its agents walk by, and its content hash.

    Raises:
        WalkingError: the file is not a model, of a later version, or damaged.
        OSError: it cannot be opened.
    """
    if path.stat().st_size > MOST_BYTES:
        raise WalkingError(f"{path}: larger than {MOST_BYTES} bytes, which no model is.")
    try:
        with np.load(path, allow_pickle=False) as archive:
            header = json.loads(archive["header"].tobytes().decode())
            tables = {name: archive[name] for name in _TABLES}
    except (ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise WalkingError(f"{path}: not a walking model; `./run walk fit` writes one.") from error
    _check_header(path, header)
    digest = str(header.pop("content_hash", ""))
    if digest != content_hash(header, tables):
        raise WalkingError(f"{path}: damaged, its content does not match its hash; fit it again.")
    try:
        return _fit_of(header, tables), FollowingRules(**header["rules"]), digest
    except (KeyError, TypeError) as error:
        raise WalkingError(f"{path}: incomplete ({error}); fit it again.") from error


def content_hash(header: dict[str, Any], tables: dict[str, Any]) -> str:
    """Return the SHA-256 of the header, without its own hash, and the tables."""
    digest = hashlib.sha256(json.dumps(header, sort_keys=True).encode())
    for name in _TABLES:
        table = tables[name]
        digest.update(f"{name} {table.dtype.str} {table.shape}".encode())
        digest.update(np.ascontiguousarray(table).tobytes())
    return digest.hexdigest()


def _check_header(path: Path, header: object) -> None:
    if not isinstance(header, dict) or header.get("format") != FORMAT:
        raise WalkingError(f"{path}: not a walking model.")
    if header.get("version") != VERSION:
        raise WalkingError(
            f"{path}: version {header.get('version')} of the format, this program reads {VERSION}."
        )


def _header(fit: FittedWalking, rules: FollowingRules) -> dict[str, Any]:
    base, static = fit.database, fit.static
    return {
        **_travel_times(fit),
        "format": FORMAT,
        "version": VERSION,
        "parameters": [asdict(one) for one in base.grid.parameters],
        "values": [list(values) for values in base.grid.values],
        "metric": base.metric,
        "names": list(base.names),
        "subjects": list(base.subjects),
        "sources": list(base.sources),
        "kinds": list(base.kinds),
        "rules": asdict(rules),
        "seed": fit.options.seed,
        "k": fit.options.k,
        "entries": fit.options.entries,
        "reading": asdict(fit.reading),
        "reading_chosen": fit.options.reading is None,
        "scores": [{"options": asdict(one.options), "crps_s": one.crps_s} for one in fit.scores],
        "static": {
            "vector": static.vector.tolist(),
            "deviation": static.deviation,
            "node": static.node.tolist(),
            "node_deviation": static.node_deviation,
        },
        # Files without caveats stay as they were, with the hash that they had.
        **({"caveats": list(fit.caveats)} if fit.caveats else {}),
    }


def _travel_times(fit: FittedWalking) -> dict[str, Any]:
    if fit.mixed is None or fit.database.resting is None:
        return {}
    learnt = fit.mixed.posterior
    return {
        "resting": fit.database.resting.tolist(),
        "travel_times": {
            "curve": learnt.curve.name,
            "coefficients": learnt.coefficients.tolist(),
            "between": learnt.between.tolist(),
            "within": learnt.within.tolist(),
            "tails": learnt.tails,
        },
    }


def _posterior_of(header: dict[str, Any]) -> Posterior | None:
    stored = header.get("travel_times")
    if stored is None:
        return None
    curve = StartingAndStopping()
    if stored["curve"] != curve.name:
        raise WalkingError(
            f"The model's travel times follow the curve {stored['curve']!r}; this program knows"
            f" {curve.name!r} only."
        )
    return Posterior(
        curve,
        coefficients=np.array(stored["coefficients"], dtype=np.float64),
        between=np.array(stored["between"], dtype=np.float64),
        within=np.array(stored["within"], dtype=np.float64),
        tails=float(stored["tails"]),
    )


def _fit_of(header: dict[str, Any], tables: dict[str, Any]) -> FittedWalking:
    grid = ParameterGrid(
        tuple(SteeringParameter(**one) for one in header["parameters"]),
        tuple(tuple(values) for values in header["values"]),
    )
    database = WalkDatabase(
        grid=grid,
        metric=header["metric"],
        names=tuple(header["names"]),
        subjects=tuple(header["subjects"]),
        sources=tuple(header["sources"]),
        kinds=tuple(header["kinds"]),
        resting=np.array(header["resting"]) if "resting" in header else None,
        **tables,
    )
    reading = SuitabilityOptions(**header["reading"])
    given = None if header["reading_chosen"] else reading
    options = FitOptions(header["seed"], header["k"], header["entries"], given)
    scores = [
        ReadingScore(SuitabilityOptions(**one["options"]), one["crps_s"])
        for one in header["scores"]
    ]
    stored = header["static"]
    static = StaticFit(
        np.array(stored["vector"]),
        stored["deviation"],
        np.array(stored["node"]),
        stored["node_deviation"],
    )
    return restored(
        database,
        options,
        reading,
        scores,
        static,
        _posterior_of(header),
        caveats=[str(one) for one in header.get("caveats", ())],
    )
