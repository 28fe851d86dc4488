"""Tests of `reembody walk`: fitting, sampling and evaluating from files, and refusals."""

from pathlib import Path

import numpy as np
import pytest

from tests.cli.walk_command import QUICK
from tests.cli.walk_command import figures as _figures
from tests.cli.walk_command import refusal as _refusal
from tests.cli.walk_command import run as _run
from tests.cli.walk_command import write_walks as _write_walks

OPEN = """
key: hall
bounds_m: [-2, -2, 2, 6]
obstacles:
  - {shape: box, name: table, center_m: [0, 1], size_m: [1.0, 0.4]}
places: {door: [0, 0], desk: [0, 2]}
"""
CLOSED = OPEN.replace("size_m: [1.0, 0.4]", "size_m: [3.99, 0.4]")


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with walks of four people, statures, scenes, and a model of three of them."""
    folder = tmp_path_factory.mktemp("walks")
    walks = _write_walks(folder, range(4))
    rows = [f"{number},{1.7 + 0.05 * number}" for number in range(4)]
    (folder / "people.csv").write_text("\n".join(["subject,stature_m", *rows]) + "\n")
    (folder / "hall.yaml").write_text(OPEN)
    (folder / "closed.yaml").write_text(CLOSED)
    out, people = folder / "model.npz", folder / "people.csv"
    fit = _figures("fit", *walks[:9], "--out", out, "--people", people, *QUICK)
    assert fit["walks"] == 9
    assert fit["people"] == 3
    assert fit["dependencies"] == ["length_m", "turning_per_m", "stature_m"]
    return folder


def test_the_same_walks_and_seed_fit_the_same_model(lab: Path) -> None:
    """The same walks and seed fit the same model."""
    walks = sorted(lab.glob("walker-[0-2]-*.csv"))
    out, people = lab / "again.npz", lab / "people.csv"
    repeated = _figures("fit", *walks, "--out", out, "--people", people, *QUICK)
    first, second = (
        _figures("sample", path, "--length", 2, "--stature", 1.8, "--seed", 5)
        for path in (lab / "model.npz", out)
    )
    assert len(repeated["content_hash"]) == 64
    assert first == second


def test_samples_are_draws_with_travel_times(lab: Path) -> None:
    """Samples depend only on the seed, lie within bounds, and take longer for longer paths."""
    ask = ("sample", lab / "model.npz", "--stature", 1.75, "--count", 80, "--model", "prob")
    short, long = _figures(*ask, "--length", 1.0), _figures(*ask, "--length", 3.0)
    assert len(short["vectors"]) == 80
    assert np.array(short["vectors"]).min() >= 0.1
    assert np.array(short["vectors"]).max() <= 2.0
    assert 1.0 < np.median(short["durations_s"]) < np.median(long["durations_s"]) < 6.0
    assert short["parameters"] == ["velocity", "acceleration", "angular"]
    assert _figures(*ask, "--length", 1.0) == short
    assert _figures(*ask, "--length", 1.0, "--seed", 2) != short


def test_travel_times_are_drawn_with_effects_of_people(lab: Path) -> None:
    """Without --model the times are those of mixed, which knows how people and walks differ."""
    ask = ("sample", lab / "model.npz", "--stature", 1.75, "--count", 200)
    short, long = _figures(*ask, "--length", 1.0), _figures(*ask, "--length", 3.0)
    assert short["model"] == long["model"] == "mixed"
    assert 1.0 < np.median(short["durations_s"]) < np.median(long["durations_s"]) < 6.0
    # Three people leave much open.
    low, high = np.quantile(long["durations_s"], [0.05, 0.95])
    assert high / low > 1.3
    assert np.array(short["vectors"]).min() > 0.0


def test_walks_given_twice_and_people_named_by_files_are_named(lab: Path) -> None:
    """A copy under another name is left out by name; people known by file names only are listed."""
    walks = sorted(lab.glob("walker-[0-2]-*.csv"))
    bare = lab / "bare"
    bare.mkdir()
    for walk in walks[:3]:
        rows = [line.split(",", 1)[1] for line in walk.read_text().splitlines()]
        (bare / walk.name).write_text("\n".join(rows) + "\n")
    copy = bare / "z-somebody-else.csv"
    copy.write_bytes((bare / walks[0].name).read_bytes())
    files = sorted(bare.glob("*.csv"))
    found = _figures("fit", *files, "--out", lab / "bare.npz", *QUICK)
    assert found["walks"] == 3
    assert found["people_named_by_file"] == sorted(path.stem for path in walks[:3])
    (left,) = found["left_out"]
    assert left["walk"].startswith("z-somebody-else.csv")
    assert "the same recording as walker-0-0.csv" in left["reason"]

    # Whoever draws from the model, perhaps a year later, is told the same of its walks.
    asked = ("sample", lab / "bare.npz", "--length", 2, "--count", 5)
    assert any("names of their files" in note for note in _figures(*asked)["notes"])
    told = _figures(*asked, "--stature", 1.9)["notes"]
    assert "--stature 1.9 changes nothing" in told[0]
    assert "note: the model was fitted without statures" in _run(*asked, "--stature", 1.9).stdout
    assert not any("stature" in note for note in _figures(*asked)["notes"])


def test_a_path_in_a_scene_leads_round_its_obstacles(lab: Path) -> None:
    """A path between places or points of a scene leads round its obstacles."""
    ask = ("sample", lab / "model.npz", "--stature", 1.75, "--scene", lab / "hall.yaml")
    named = _figures(*ask, "--from", "door", "--to", "desk")
    assert named["length_m"] > 2.1
    assert len(named["points_m"]) > 2
    assert _figures(*ask, "--from", "0,0", "--to", "0,2")["points_m"] == named["points_m"]
    table = _run(*ask, "--from", "door", "--to", "desk")
    assert table.exit_code == 0
    assert "duration, s" in table.stdout


def test_other_people_are_predicted(lab: Path) -> None:
    """A model is evaluated on other people; walks that it was fitted on are refused by default."""
    others, people = sorted(lab.glob("walker-3-*.csv")), lab / "people.csv"
    scores = _figures("evaluate", lab / "model.npz", *others, "--people", people, "--draws", 50)
    assert scores["walks"] == 3
    baselines = {"constant speed", "line", "log-log"}
    assert set(scores["models"]) == {"stat", "adapt", "prob"} | {"mixed"} | baselines
    assert {one["baseline"] for one in scores["against_baselines"]} == baselines
    assert all(0.0 < one["crps_s"] < 3.0 for one in scores["models"].values())
    existing = lab / "walker-0-0.csv"
    assert "fitted on 0" in _refusal("evaluate", lab / "model.npz", existing, "--people", people)
    even = _run("evaluate", lab / "model.npz", existing, "--people", people, "--even-fitted")
    assert even.exit_code == 0
    assert "CRPS" in even.stdout
    assert even.stdout.startswith("1 walk of 1 person, model fitted on 3 people, all of these")
    assert "figures are in-sample" in even.stdout.splitlines()[0]


def test_a_path_outside_what_the_model_has_seen_is_named(lab: Path) -> None:
    """Ten metres are named with the range of walks the model was fitted on, two metres are not."""
    asked = ("sample", lab / "model.npz", "--stature", 1.75, "--count", 5, "--length")
    assert _figures(*asked, 2)["outside"] == []
    assert _figures(*asked, 10)["outside"] == ["length_m"]
    text = _run(*asked, 10).stdout
    assert "length_m 10.00 is outside what the model has seen, " in text
    assert "this is a guess" in text
    assert "outside" not in _run(*asked, 2).stdout
    rows = [line.split("  ")[1] for line in text.splitlines()[3:7]]
    assert rows == [
        "duration, s",
        "maximum speed, m/s",
        "acceleration, m/s^2",
        "largest curvature, 1/m",
    ]


def test_people_of_whom_nobody_walks_are_refused(lab: Path, tmp_path: Path) -> None:
    """A list of people that names none of the walkers is refused with both and what to do."""
    people = tmp_path / "people.csv"
    people.write_text("subject,stature_m\nann,1.7\nben,1.8\n")
    walks = sorted(lab.glob("walker-[0-2]-*.csv"))
    told = _refusal("fit", *walks, "--people", people, "--out", tmp_path / "none.npz", *QUICK)
    assert "--people lists ann, ben, but the walks are of 0, 1, 2: nobody is in both" in told
    assert "`file`" in told
    assert not (tmp_path / "none.npz").exists()


def test_intervals_and_tests_need_six_people(lab: Path, tmp_path: Path) -> None:
    """Five people get neither an interval nor a p, and the reason; six get both, over people."""
    walks = _write_walks(tmp_path, range(4, 10))
    people = tmp_path / "people.csv"
    rows = [f"{number},1.8" for number in range(4, 10)]
    people.write_text("\n".join(["subject,stature_m", *rows]) + "\n")
    rest = ("--people", people, "--draws", 50)
    few = _figures("evaluate", lab / "model.npz", *walks[:15], *rest)
    assert (few["people"], few["walks"], few["in_sample_people"]) == (5, 15, [])
    for one in few["against_baselines"]:
        assert (one["low_s"], one["high_s"]) == (None, None)
        assert "6 are needed" in one["no_interval"]
    for one in few["comparisons"]:
        assert (one["p"], one["power"], one["n"]) == (None, None, 5)
        assert "6 are needed" in one["not_tested"]
    text = _run("evaluate", lab / "model.npz", *walks[:3], *rest).stdout
    assert text.startswith("3 walks of 1 person, model fitted on 3 others")
    assert "No intervals and no tests: walks of one person are not independent" in text
    assert "Wilcoxon" not in text
    assert "drawn again" not in text
    enough = _figures("evaluate", lab / "model.npz", *walks, *rest)
    for one in enough["against_baselines"]:
        assert one["low_s"] <= one["crps_less_s"] <= one["high_s"]
        assert one["low_s"] < one["high_s"]
    # Over 18 walks p could be far smaller; over six people it cannot be below 2 / 2^6.
    assert all(one["n"] == 6 and one["p"] >= 0.03125 for one in enough["comparisons"])
    told = _run("evaluate", lab / "model.npz", *walks, *rest).stdout
    assert "Wilcoxon over n = 6 people" in told
    assert "drawn again" in told


def test_a_fit_names_how_each_walk_was_used(tmp_path: Path) -> None:
    """JSON lists each walk with the distance walked and its path's, and what was left out."""
    along = np.arange(0.0, 3.0, 0.02)
    courses = {
        "A": np.stack([along, np.zeros_like(along)], axis=-1),
        "B": np.stack([np.sin(along), 1.0 - np.cos(along)], axis=-1),
        "C": np.stack([np.sin(2.1 * along), 1.0 - np.cos(2.1 * along)], axis=-1) / 2.1,
    }
    rows = [
        f"{subject},{at},{100.0 * x:.3f},{100.0 * y:.3f}"
        for subject, course in courses.items()
        for at, (x, y) in enumerate(course)
    ]
    table, model = tmp_path / "walks.csv", tmp_path / "model.npz"
    table.write_text("\n".join(["subject,frame,x,y", *rows]) + "\n")
    assert "frame rate" in _refusal("fit", table, "--out", model)
    assert "m, cm, mm are valid" in _refusal("fit", table, "--unit", "inch", "--out", model)
    with table.open("a") as more:
        more.writelines(f"D,{at},{100 + at % 2},200\n" for at in range(150))
    figures = _figures("fit", table, "--rate-hz", 60, "--unit", "cm", "--out", model, *QUICK)
    straight, curved = figures["fitted"]
    assert (straight["own_path"], curved["own_path"]) == (False, True)
    assert curved["walk"] == "walks.csv, B, walk 1"
    assert curved["walked_m"] == pytest.approx(3.0, rel=0.02)
    assert curved["turning_rad"] == pytest.approx(3.0, rel=0.15)
    standing, left_out = figures["left_out"]
    assert standing["walk"] == "walks.csv, D"
    assert standing["reason"].startswith("stood still, within 0.01 m for up to 2.48 s; a walk ends")
    assert "check the units" in standing["reason"]
    assert left_out["walk"] == "walks.csv, C, round 1"
    assert "ends within 0.25 m of its start" in left_out["reason"]


def _fit(lab: Path, *arguments: object) -> str:
    out = lab / "refused.npz"
    output = _refusal("fit", *arguments, "--out", out, *QUICK)
    assert not out.exists()
    assert not list(lab.glob(".refused*"))
    return output


def test_invalid_walks_are_refused(lab: Path) -> None:
    """Invalid walks, or walks of only one subject, are refused and nothing is written."""
    bad = lab / "bad.csv"
    bad.write_text("subject,time_s,x_m,y_m\n7,0,0,0\n")
    assert "two" in _fit(lab, bad)
    bad.write_text("subject,time_s,x_m,y_m\n7,0,0,0\n7,0.1,nan,0\n7,0.2,0,1\n")
    assert "line 3" in _fit(lab, bad)
    bad.write_text("subject,time_s,x_m,y_m\n7,0,0,0\n7,0.1,0,0\n7,0.2,0,0.01\n")
    told = _fit(lab, bad)
    assert "contains no walk" in told
    assert "people stood still, within 0.01 m for up to 0.2 s" in told
    assert "check the units" in told
    assert "one subject, '0'" in _fit(lab, *sorted(lab.glob("walker-0-*.csv")))
    assert "gone.csv" in _fit(lab, lab / "gone.csv")


def test_invalid_scenes_and_places_are_refused(lab: Path) -> None:
    """A scene without a path, a goal in an obstacle, and unknown places or scenes are refused."""
    walks = sorted(lab.glob("walker-[0-1]-1.csv"))
    assert "no way" in _fit(lab, *walks, "--scene", lab / "closed.yaml")
    ask = ("sample", lab / "model.npz", "--stature", 1.75, "--scene", lab / "hall.yaml")
    assert "inside obstacle 'table'" in _refusal(*ask, "--from", "door", "--to", "0,1")
    assert "door, desk" in _refusal(*ask, "--from", "door", "--to", "window")
    assert "car-and-three-racks" in _fit(lab, *walks, "--scene", "kitchen")


def test_invalid_requests_for_samples_are_refused(lab: Path) -> None:
    """Sampling without a path or stature, or from a damaged or foreign file, is refused."""
    model = lab / "model.npz"
    assert "one of --length" in _refusal("sample", model)
    assert "stature" in _refusal("sample", model, "--length", 2)
    assert "metres" in _refusal("sample", model, "--length", 2, "--stature", 175)
    for asked in (("--length", 1e6), ("--length", 0), ("--path", "0,0 0,900 900,900")):
        told = _refusal("sample", model, *asked, "--stature", 1.75)
        assert "more than 0 and at most 1000 m are valid" in told
        assert "in parts" in told
    assert "not a walking model" in _refusal("sample", lab / "people.csv", "--length", 2)
    content = bytearray(model.read_bytes())
    content[len(content) // 2] ^= 0xFF
    broken = lab / "broken.npz"
    broken.write_bytes(bytes(content))
    assert "model" in _refusal("sample", broken, "--length", 2, "--stature", 1.75)


def test_a_model_is_replaced_whole_or_not_at_all(lab: Path) -> None:
    """A fit that fails leaves the existing model file unchanged."""
    out = lab / "kept.npz"
    out.write_bytes((lab / "model.npz").read_bytes())
    before = out.read_bytes()
    _refusal("fit", lab / "walker-0-0.csv", "--out", out, *QUICK)
    assert out.read_bytes() == before


def test_units_that_are_assumed_are_said_and_doubted(tmp_path: Path) -> None:
    """Feet without a unit are read as metres, said so, and doubted by speeds and steps."""
    folder = tmp_path / "metres"
    folder.mkdir()
    tables = []
    for file in _write_walks(folder, range(2)):
        rows = [line.split(",") for line in file.read_text().splitlines()[1:]]
        feet = [f"{who},{t},{float(x) / 0.3048:.4f},{float(y) / 0.3048:.4f}"
                for who, t, x, y in rows]  # fmt: skip
        path = tmp_path / file.name
        path.write_text("\n".join(["subject,time,x,y", *feet]) + "\n")
        tables.append(path)
    out = tmp_path / "model.npz"
    taken = _figures("fit", *tables, "--out", out, *QUICK)
    text = "\n".join(taken["notices"])
    assert "walker-0-2.csv: the columns x and y name no unit: taken as metres" in text
    assert "walker-0-2.csv: the column time names no unit: taken as seconds" in text
    assert "times as fast as people usually walk such distances" in text
    assert "check the unit of x and y (--unit ft, m, cm, mm) and the rate" in text
    assert "notice" in _run("fit", *tables, "--out", out, *QUICK).stdout
    said = _figures("fit", *tables, "--out", out, "--unit", "ft", *QUICK)
    assert {one.split(": ", 1)[1] for one in said["notices"]} == {
        "the column time names no unit: taken as seconds"
    }
    assert said["fitted"][2]["walked_m"] == pytest.approx(3.0, rel=0.05)


def test_milliseconds_that_are_read_as_seconds_are_named(lab: Path) -> None:
    """Times in milliseconds in a column `time` are refused for that reason, not for gaps."""
    table = lab / "milliseconds.csv"
    rows = [line.split(",") for line in (lab / "walker-0-1.csv").read_text().splitlines()[1:]]
    slow = [f"{who},{1000.0 * float(t):.1f},{x},{y}" for who, t, x, y in rows]
    table.write_text("\n".join(["subject,time,x_m,y_m", *slow]) + "\n")
    told = _fit(lab, table)
    assert "apart as a rule, by the column time" in told
    assert "If these are milliseconds, name the column time_ms" in told


def test_a_walk_that_cannot_be_evaluated_is_left_out_by_name(lab: Path, tmp_path: Path) -> None:
    """A walk that ends inside an obstacle is left out by name and counted; the other is used."""
    _, two, three = _write_walks(tmp_path, range(3, 4))

    def moved(walk: Path, name: str, right_m: float, ahead_m: float) -> Path:
        rows = [line.split(",") for line in walk.read_text().splitlines()[1:]]
        placed = [f"{who},{t},{float(x) + right_m},{float(y) + ahead_m}" for who, t, x, y in rows]
        path = tmp_path / name
        path.write_text("\n".join(["subject,time_s,x_m,y_m", *placed]) + "\n")
        return path

    inside, beside = moved(two, "inside.csv", 0.0, 1.0), moved(three, "beside.csv", 1.2, 0.0)
    people = ("--people", lab / "people.csv", "--draws", 20)
    scene = ("--scene", lab / "hall.yaml")
    found = _figures("evaluate", lab / "model.npz", inside, beside, *people, *scene)
    assert found["walks"] == 1
    (left_out,) = found["left_out"]
    assert left_out["walk"] == "inside.csv, 3, walk 1"
    assert "inside obstacle 'table'" in left_out["reason"]
    told = _run("evaluate", lab / "model.npz", inside, beside, *people, *scene).stdout
    assert "left out      1 walk: inside.csv, 3, walk 1: " in told


def test_what_a_program_walked_is_marked_wherever_it_is_predicted(tmp_path: Path) -> None:
    """With --synthetic the file says so, and so does each prediction from it, in both forms."""
    files, model = _write_walks(tmp_path, range(2)), tmp_path / "model.npz"
    for option, synthetic in (("--synthetic", True), (None, False)):
        asked = [option] if option else []
        found = _figures("fit", *files, "--out", model, *QUICK, *asked)
        assert found["kinds"] == ["synthetic" if synthetic else "human"]
        sample = ("sample", model, "--length", 2, "--count", 5)
        drawn = _figures(*sample)
        assert (drawn["synthetic"], drawn["kinds"]) == (synthetic, found["kinds"])
        assert ("SYNTHETIC" in _run(*sample).stdout) == synthetic


def test_everything_that_a_prediction_needs_is_asked_for_at_once(tmp_path: Path) -> None:
    """Stature and further numbers that are missing are told in one message, with their ranges."""
    files = _write_walks(tmp_path, range(2))
    rows = ["0,1.70,1", "1,1.80,2"]
    (tmp_path / "people.csv").write_text("\n".join(["subject,stature_m,load_kg", *rows]))
    listed = ("--people", tmp_path / "people.csv", "--depends-on", "load_kg")
    _figures("fit", *files, *listed, "--out", tmp_path / "model.npz", *QUICK)
    told = _refusal("sample", tmp_path / "model.npz", "--length", 2)
    assert "depends on stature and load_kg: give --stature METRES (1.70 to 1.80 in its" in told
    assert "--with load_kg=NUMBER (1.00 to 2.00 in its walks)" in told
