"""Compute slices of the map for given dependencies; runs in the worker process."""

from typing import Any

import numpy as np

from app.features.movement.walking.predicting import opened
from app.features.movement.walking.sources import Cannot, SliceQuestion, Store
from app.science.walking.maps import multilinear
from app.science.walking.models import FittedWalking, density_of
from app.science.walking.records import WalkingError

Json = dict[str, Any]


def compute_slice(store: Store, content_hash: str, question: SliceQuestion) -> Json:
    """Return one slice of the map as a `SliceView`; raise Cannot."""
    fit, _ = opened(store, content_hash)
    grid = fit.space.grid
    names = [one.name for one in grid.parameters]
    if question.held not in names:
        raise Cannot(f"there is no parameter {question.held!r}", f"There are {', '.join(names)}.")
    held = names.index(question.held)
    values = grid.values[held]
    at = float(np.clip(question.value, values[0], values[-1]))
    across, along = (axis for axis in range(len(names)) if axis != held)
    try:
        vector = fit.space.scaling.vector(dict(question.dependencies))
        blended = density_of(fit.space, fit.space.scaling.z(vector)).grid_values
        mesh = np.meshgrid(grid.values[across], grid.values[along], indexing="ij")
        points = np.empty((mesh[0].size, len(names)))
        points[:, across], points[:, along], points[:, held] = mesh[0].ravel(), mesh[1].ravel(), at
        found = multilinear(grid, blended, points).reshape(mesh[0].shape)
    except WalkingError as error:
        raise Cannot(str(error)) from None
    return {
        "x": _axis(fit, across),
        "y": _axis(fit, along),
        "held": _axis(fit, held),
        "order": names,
        "held_at": at,
        # Rows are values of y, as heat maps expect.
        "suitability": found.T.round(5).tolist(),
        "largest": float(blended.max()),
    }


def _axis(fit: FittedWalking, at: int) -> Json:
    parameter = fit.space.grid.parameters[at]
    return {
        "name": parameter.name,
        "unit": parameter.unit,
        "low": parameter.low,
        "high": parameter.high,
        "values": list(fit.space.grid.values[at]),
    }
