"""Tests that three.js poses the skin of models as the server does."""

import json
from pathlib import Path

from tests.adapters.humanoids.fuzzing import published_seeds
from tests.adapters.humanoids.vector_files import vectors
from tests.support.compressed_files import meshopt_file
from tests.support.humanoid_files import humanoid_file
from tests.support.humanoid_model import Model
from tests.support.node import install_packages, run_node

WITHIN_M = 1e-5
FRONTEND = Path(__file__).resolve().parents[3] / "frontend"
SCRIPT = Path(__file__).with_name("three_skin.mjs")


def test_three_poses_skins_as_the_server_does(tmp_path: Path) -> None:
    """Vertices of bodies in three poses are within 1e-5 m, also of published models, if present."""
    models = {
        "plain.glb": humanoid_file(Model(arms_down_rad=0.7, facing_rad=1.0, hair=True)),
        "meshopt.glb": meshopt_file(humanoid_file(Model(vrm=1))),
        **published_seeds(),
    }
    arguments = []
    for name, data in models.items():
        model, facts = tmp_path / name, tmp_path / f"{name}.json"
        model.write_bytes(data)
        facts.write_text(json.dumps(vectors(data)))
        arguments += [str(model), str(facts)]
    install_packages(FRONTEND)
    three = FRONTEND / "node_modules" / "three"
    found = json.loads(run_node(str(SCRIPT), str(three), *arguments, cwd=FRONTEND))
    for name, one in zip(models, found, strict=True):
        assert one["worst_m"] < WITHIN_M, name
        assert one["vertices"] > 400, name
