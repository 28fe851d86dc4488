"""Store a fitted walking model as a file: the tables of its walks, and how it was fitted.

The file is an archive that notices damage (`hashed_archive`), with the tables of the database. The
space is not stored, because the seed reproduces it. What P_mixed learnt is in the header, where a
file of an earlier version has nothing: it predicts with P_prob, and earlier programs read new files
as they did before.
"""

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from app.adapters.hashed_archive import ArchiveKind
from app.adapters.map_tables import TABLES, database_from, header_of, tables_of
from app.science.walking.following import FollowingRules
from app.science.walking.maps import SuitabilityOptions
from app.science.walking.models import FitOptions, FittedWalking, ReadingScore, StaticFit, restored
from app.science.walking.records import WalkingError
from app.science.walking.travel_times import Posterior, StartingAndStopping

FORMAT, VERSION = "reembody-walking-model", 1
_KIND = ArchiveKind(FORMAT, VERSION, TABLES, "a walking model", "./run walk fit", WalkingError)


def write_model(path: Path, fit: FittedWalking, rules: FollowingRules) -> str:
    """Write a model atomically and return its content hash; raise OSError."""
    return _KIND.write(path, _header(fit, rules), tables_of(fit.database))


def is_model(path: Path) -> bool:
    """Return whether a file is a walking model, of any version; raise OSError."""
    return _KIND.is_one(path)


def read_model(path: Path) -> tuple[FittedWalking, FollowingRules, str]:
    """Read a model; return it with the rules its agents walk by, and its content hash.

    Raises:
        WalkingError: the file is not a model, of a later version, or damaged.
        OSError: it cannot be opened.
    """
    header, tables, digest = _KIND.read(path)
    try:
        return _fit_of(header, tables), FollowingRules(**header["rules"]), digest
    except (LookupError, TypeError, AttributeError) as error:
        raise WalkingError(f"{path}: incomplete ({error}); fit it again.") from error


def _header(fit: FittedWalking, rules: FollowingRules) -> dict[str, Any]:
    base, static = fit.database, fit.static
    return {
        **_travel_times(fit),
        **header_of(base),
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
    database = database_from(header, tables)
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
