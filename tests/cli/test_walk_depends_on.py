"""Tests of `reembody walk` with dependencies that a user names, such as a load in kilograms."""

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.adapters.cosimulation import load_scene, partners_of, shipped_scenes
from app.adapters.walks.model_file import read_model
from app.science.cosimulation import CosimulationError
from app.science.rotations import FloatArray
from app.science.walking.synthetic import POPULATIONS, person_of, straight_path, walk_along
from app.science.walking.travel_times import TimedWalks
from tests.cli.walk_command import QUICK, figures, refusal, run

SLOWER_PER_KG = 0.03
"""How much longer these walks take for each kilogram, as a logarithm."""
LOADS_KG = (0.0, 8.0)


def loaded_walks(folder: Path, people: range) -> list[Path]:
    """Write walks of 2 and 3 m, one file each, of people without a load and with one of 8 kg."""
    files = []
    for number in people:
        rng = np.random.default_rng((6, number))
        person = person_of(POPULATIONS[0], number, rng)
        for load_kg in LOADS_KG:
            for length in (2.0, 3.0):
                track = walk_along(person, straight_path(length), rng)
                slower = np.exp(SLOWER_PER_KG * load_kg)
                rows = [
                    f"{number},{slower * t:.4f},{x:.4f},{y:.4f},{load_kg:g},flat"
                    for t, (x, y) in zip(track.times_s[::2], track.xy_m[::2], strict=True)
                ]
                path = folder / f"walker-{number}-{load_kg:g}-{length:g}.csv"
                header = "subject,time_s,x_m,y_m,load_kg,shoes"
                path.write_text("\n".join([header, *rows]) + "\n")
                files.append(path)
    return files


def without_column(files: list[Path], name: str) -> None:
    """Take a column out of tables."""
    for file in files:
        with file.open() as text:
            rows = list(csv.DictReader(text))
        names = [one for one in rows[0] if one != name]
        with file.open("w") as text:
            writer = csv.DictWriter(text, names, extrasaction="ignore")
            writer.writeheader()
            writer.writerows(rows)


def listed(folder: Path, rows: list[str], header: str) -> Path:
    """Write a list of people and return its path."""
    path = folder / "people.csv"
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def straight_walk(length_m: float, others: FloatArray) -> TimedWalks:
    """Return a straight walk from rest to rest with further dependencies as z-scores."""
    one, none = np.ones(1), np.zeros(1)
    return TimedWalks(length_m * one, none, one, others[None], one, ("somebody",))


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with walks of six people, and a model that depends on their load."""
    folder = tmp_path_factory.mktemp("loads")
    files = loaded_walks(folder, range(6))
    asked = ("--out", folder / "model.npz", "--depends-on", "load_kg", *QUICK)
    found = figures("fit", *files, *asked)
    assert found["dependencies"] == ["length_m", "turning_per_m", "load_kg"]
    assert {one["others"]["load_kg"] for one in found["fitted"]} == set(LOADS_KG)
    return folder


def durations(lab: Path, load_kg: float, *more: object) -> dict[str, Any]:
    """Return what the model of the lab draws for 3 m with a load."""
    asked = ("--length", 3, "--with", f"load_kg={load_kg:g}", "--count", 800, *more)
    return figures("sample", lab / "model.npz", *asked)


def test_a_load_makes_predictions_as_much_slower_as_it_made_the_walks(lab: Path) -> None:
    """People with 8 kg are predicted slower by the planted share, which its interval contains."""
    fit, _, _ = read_model(lab / "model.npz")
    assert fit.mixed is not None
    assert fit.mixed.scaling is not None
    learnt, scaling = fit.mixed.posterior, fit.mixed.scaling
    times_s = [
        learnt.curve.times_s(
            straight_walk(3.0, scaling.z(np.array([load_kg]))), learnt.coefficients[:, None]
        )[:, 0]
        for load_kg in LOADS_KG
    ]
    low, high = np.quantile(np.log(times_s[1] / times_s[0]), [0.025, 0.975])
    assert 0.0 < low < 8.0 * SLOWER_PER_KG < high
    bare, loaded = (np.median(durations(lab, load)["durations_s"]) for load in LOADS_KG)
    assert np.log(loaded / bare) == pytest.approx(8.0 * SLOWER_PER_KG, abs=0.08)


@pytest.mark.parametrize("which", ["prob", "adapt"])
def test_the_papers_models_depend_on_the_load_too(lab: Path, which: str) -> None:
    """With a load, prob and adapt take their answers from walks with it, which were slower."""
    bare, loaded = (
        np.median(durations(lab, load, "--model", which)["durations_s"]) for load in LOADS_KG
    )
    assert loaded > 1.05 * bare


def test_a_sample_needs_every_dependency_of_its_model(lab: Path) -> None:
    """A missing, unknown or invalid number is refused; one beyond the walks is a guess."""
    ask = ("sample", lab / "model.npz", "--length", 3)
    told = refusal(*ask)
    assert "depends on load_kg: give --with load_kg=NUMBER" in told
    assert "0.00 to 8.00" in told
    assert "depends only on load_kg" in refusal(*ask, "--with", "mood=1")
    assert "each given once" in refusal(*ask, "--with", "load_kg=1", "--with", "load_kg=2")
    assert "'heavy' is not a number" in refusal(*ask, "--with", "load_kg=heavy")
    assert "give --stature in metres" in refusal(*ask, "--with", "stature_m=1.8")
    beyond = durations(lab, 20.0)
    assert "load_kg" in beyond["outside"]
    assert beyond["dependencies"]["load_kg"] == 20.0
    assert any("load_kg 20.00 is outside" in note for note in beyond["notes"])


@pytest.mark.parametrize("load_kg", [-1000, 1000, 1e6, -1e300])
@pytest.mark.filterwarnings("error")
def test_what_nobody_walks_is_refused_with_what_the_model_has_seen(
    lab: Path, load_kg: float
) -> None:
    """A number with which people would be faster or slower than anybody is refused by name."""
    told = refusal("sample", lab / "model.npz", "--length", 3, "--with", f"load_kg={load_kg}")
    assert f"load_kg is {load_kg:g}, and the model has seen 0.00 to 8.00" in told
    assert f"People would be {'faster' if load_kg < 0 else 'slower'} than anybody walks" in told
    assert "is not a number" in refusal(
        "sample", lab / "model.npz", "--length", 3, "--with", "load_kg=8_0"
    )


def test_columns_of_long_times_stay_apart(lab: Path) -> None:
    """Times of a very long way have a space between them."""
    printed = run("sample", lab / "model.npz", "--length", 1000, "--with", "load_kg=60").stdout
    (line,) = [one for one in printed.splitlines() if "duration" in one]
    assert len(line.replace("duration, s", "").split()) == 5


def test_an_evaluation_compares_with_the_model_without_the_dependency(
    lab: Path, tmp_path: Path
) -> None:
    """Other people's walks are predicted better with their load than without it."""
    others = loaded_walks(tmp_path, range(6, 9))
    asked = ("evaluate", lab / "model.npz", *others, "--draws", 100)
    found = figures(*asked)
    gains = {one["baseline"]: one["crps_less_s"] for one in found["against_baselines"]}
    assert gains["mixed without load_kg"] > 0.05
    assert found["models"]["mixed"]["crps_s"] < found["models"]["mixed without load_kg"]["crps_s"]
    told = run(*asked).stdout
    gain_s = gains["mixed without load_kg"]
    assert f"mixed against mixed without load_kg: CRPS {gain_s:.3f} s smaller" in told
    assert "predicted no better" not in told


def test_a_number_may_stand_in_the_list_of_people(tmp_path: Path) -> None:
    """A row with a file is about that recording, one without about all of the person's."""
    files = loaded_walks(tmp_path, range(2))
    without_column(files, "load_kg")
    rows = ["0,,0,1", "1,,2.5,0", "0,walker-0-8-2.csv,8,", "0,walker-0-8-3.csv,8,"]
    people = listed(tmp_path, rows, "subject,file,load_kg,gaze_on_display")
    asked = ("--people", people, "--out", tmp_path / "model.npz", *QUICK)
    names = ("--depends-on", "load_kg", "--depends-on", "gaze_on_display")
    found = figures("fit", *files, *asked, *names)
    loads = {one["walk"][:12]: one["others"]["load_kg"] for one in found["fitted"]}
    assert loads == {"walker-0-0-2": 0, "walker-0-0-3": 0, "walker-0-8-2": 8, "walker-0-8-3": 8,
                     "walker-1-0-2": 2.5, "walker-1-0-3": 2.5, "walker-1-8-2": 2.5,
                     "walker-1-8-3": 2.5}  # fmt: skip
    assert {one["others"]["gaze_on_display"] for one in found["fitted"]} == {0, 1}
    assert found["dependencies"] == ["length_m", "turning_per_m", "load_kg", "gaze_on_display"]


def test_a_walk_without_the_number_is_left_out_with_its_reason(tmp_path: Path) -> None:
    """Unknown or changing numbers leave their walk out; if few walks have it, it is refused."""
    files = loaded_walks(tmp_path, range(2))
    without_column(files[:1], "load_kg")
    lines = files[2].read_text().splitlines()
    amid = len(lines) // 2
    lines[amid] = lines[amid].replace(",8,flat", ",4,flat")
    lines[amid + 1] = lines[amid + 1].replace(",8,flat", ",,flat")
    files[2].write_text("\n".join(lines) + "\n")
    out = ("--out", tmp_path / "model.npz", "--depends-on", "load_kg", *QUICK)
    found = figures("fit", *files, *out)
    assert {one["walk"]: one["reason"] for one in found["left_out"]} == {
        "walker-0-0-2.csv, 0, walk 1": "load_kg is not known",
        "walker-0-8-2.csv, 0, walk 1": "load_kg changes from 4 to 8 during it, and a model needs a"
        " number that is known before the walk: give one for the whole walk",
    }
    assert found["walks"] == 6
    without_column(files[1:5], "load_kg")
    told = refusal("fit", *files, *out)
    assert "load_kg is known for 3 of 8 walks, and at least half are needed" in told


def test_a_dependency_that_cannot_be_used_is_refused(tmp_path: Path) -> None:
    """Names that are taken or invalid, unknown columns, text and constants are refused."""
    files = loaded_walks(tmp_path, range(2))
    fit = ("fit", *files, "--out", tmp_path / "model.npz", *QUICK, "--depends-on")
    for name in ("stature", "length_m", "Turning"):
        told = refusal(*fit, name)
        assert f"The name {name!r} is taken" in told
        assert "Choose another, such as load_kg" in told
    assert "begins with a letter" in refusal(*fit, "load (kg)")
    told = refusal(*fit, "weight_kg")
    assert "there is no column weight_kg" in told
    assert "columns that a model could depend on are load_kg, shoes" in told
    assert "line 2: column shoes contains 'flat', not a finite number" in refusal(*fit, "shoes")
    more = [word for name in ("a", "b", "c") for word in ("--depends-on", name)]
    assert "up to 3" in refusal(*fit, "load_kg", *more)
    people = listed(tmp_path, ["0,light"], "subject,pack_kg")
    told = refusal(*fit, "pack_kg", "--people", people)
    assert "people.csv, line 2: pack_kg is 'light', not a number" in told
    people = listed(tmp_path, ["0,5", "1,5"], "subject,pack_kg")
    told = refusal(*fit, "pack_kg", "--people", people)
    assert "pack_kg is 5 for all 8 walks" in told
    assert not (tmp_path / "model.npz").exists()


def test_a_road_scene_refuses_a_model_that_needs_more_than_a_path(lab: Path) -> None:
    """A walker on a road has no load, so a model that depends on one is refused with the remedy."""
    road = lab / "road.yaml"
    shipped = shipped_scenes()["crossing-by-sumo"].read_text()
    walker = shipped[: shipped.index("  - name: traffic")]
    road.write_text(walker.replace("leaves_s: 9", "model: model.npz"))
    refused = pytest.raises(CosimulationError, match="depends on load_kg, which a scene does not")
    with refused, partners_of(load_scene(road), seed=1):
        pass
