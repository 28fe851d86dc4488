"""Read and make the vectors of a posed skin; `tests/vectors/skin/README.md` describes them."""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from app.adapters.humanoids import ReadSkin, read_humanoid, read_skin
from app.science.avatar.body import Binding, SkinPiece, posed_nodes, posed_vertices
from app.science.rotations import FloatArray, from_rotation_vector
from tests.support.humanoid_files import humanoid_file
from tests.support.humanoid_model import Model, mixamo_name

FOLDER = Path(__file__).resolve().parents[2] / "vectors" / "skin"
BODY, VECTORS = FOLDER / "body.glb", FOLDER / "skin.json"
_MOST_ROWS = 150
_DIGITS = 7
Json = dict[str, Any]


def body() -> bytes:
    """Return the body made by code whose vectors are in the repository."""
    return humanoid_file(
        Model(
            name=mixamo_name,
            units_per_metre=100.0,
            root_scale=0.01,
            arms_down_rad=0.6,
            facing_rad=0.4,
            hair=True,
        )
    )


def poses(binding: Binding) -> dict[str, tuple[float, FloatArray, FloatArray]]:
    """Return poses by name: stature, place of the hips, and rotations (P, 4)."""
    parts = len(binding.parts)
    rng = np.random.default_rng(52)
    still = from_rotation_vector(np.zeros((parts, 3)))
    bent = from_rotation_vector(rng.uniform(-0.5, 0.5, size=(parts, 3)))
    wild = from_rotation_vector(rng.uniform(-1.5, 1.5, size=(parts, 3)))
    own = binding.stature_m
    return {
        "T-pose": (own, binding.joints_m[0], still),
        "bent": (own, np.array((0.5, 0.9, -1.0)), bent),
        "wild, 1.9 m tall": (1.9, np.array((-2.0, 1.2, 0.3)), wild),
    }


def binding_json(binding: Binding) -> Json:
    """Return a binding as the server sends it to pages."""
    return {
        "stature_m": binding.stature_m,
        "parts": list(binding.parts),
        "parents": list(binding.parents),
        "joints_m": binding.joints_m.tolist(),
        "nodes": list(binding.nodes),
        "part_from_node": binding.part_from_node.reshape(-1, 16).tolist(),
    }


def vectors(data: bytes) -> Json:
    """Return the vectors of a model."""
    binding, skin = read_humanoid(data).binding, read_skin(data)
    return {
        "binding": binding_json(binding),
        "cases": [
            {
                "name": name,
                "stature_m": stature_m,
                "hips_m": hips_m.tolist(),
                "rotations": turns.tolist(),
                "vertices": _places(skin, binding.scaled(stature_m), hips_m, turns),
            }
            for name, (stature_m, hips_m, turns) in poses(binding).items()
        ],
    }


def _places(skin: ReadSkin, binding: Binding, hips_m: FloatArray, turns: FloatArray) -> list[Json]:
    world = posed_nodes(skin.tree, binding, binding.world_from_nodes(hips_m.tolist(), turns))
    return [_rows(piece, world) for piece in skin.pieces]


def _rows(piece: SkinPiece, world: FloatArray) -> Json:
    step = -(-len(piece.used) // _MOST_ROWS)
    rows = piece.used[:: max(1, step)]
    return {
        "node": piece.node,
        "primitive": piece.primitive,
        "rows": rows.tolist(),
        "places_m": np.round(posed_vertices(piece, world, rows), _DIGITS).tolist(),
    }


def main() -> None:
    """Write the vectors of the repository, or print those of the model that is named."""
    if len(sys.argv) > 1:
        sys.stdout.write(json.dumps(vectors(Path(sys.argv[1]).read_bytes())))
        return
    FOLDER.mkdir(parents=True, exist_ok=True)
    BODY.write_bytes(body())
    VECTORS.write_text(json.dumps(vectors(body()), separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
