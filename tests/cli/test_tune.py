"""Tests of `reembody tune`: gains, figures, files, stored versions and refusals."""

from dataclasses import asdict, replace
from pathlib import Path

import pytest

from app.adapters.humanoids import read_humanoid
from app.cli.installation import opened_database
from app.clock import Clock
from app.features.movement.avatar import (
    NewAvatar,
    avatar_by_key,
    create_avatar,
    newest_version,
    typed,
)
from app.features.movement.humanoids.worker_tasks import measured
from app.models import CaptureContent, HumanoidRow
from app.protocol.avatar import file_of, load_avatar
from app.science.avatar.body import AXIS_NAMES
from app.science.avatar.mjcf import default_configuration
from tests.cli.invoked import Invoked
from tests.science.avatar.figures import HASH, figure
from tests.support.humanoid_files import humanoid_file
from tests.support.humanoid_model import Model

_HELD = ("trunk_head", "left_leg", "right_leg", "right_arm", "left_fingers", "right_fingers")
_COMMAND = Invoked("tune")
_run, _figures, _refusal = _COMMAND.run, _COMMAND.figures, _COMMAND.refusal


@pytest.fixture
def installation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return an installation with an avatar of which only the left arm moves."""
    monkeypatch.setenv("REEMBODY_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.delenv("REEMBODY_DATABASE_URL", raising=False)
    (tmp_path / "data").mkdir()
    arm = replace(default_configuration(), locked_groups=_HELD)
    request = NewAvatar(key="arm", title="Arm", origin="by_hand", configuration=file_of(arm))
    with opened_database("test") as database, database.writing() as db:
        create_avatar(db, "tester", request, Clock().utc_now())
    return tmp_path


@pytest.mark.usefixtures("installation")
def test_json_names_every_axis_with_gains_figures_and_status() -> None:
    """The JSON has gains, figures and status of every axis, with progress on standard error."""
    figures = _figures("--avatar", "arm")
    assert [axis["name"] for axis in figures["axes"]] == list(AXIS_NAMES)
    by_name = {axis["name"]: axis for axis in figures["axes"]}
    elbow = by_name["LeftLowerArmY"]
    assert elbow["status"] == "tuned"
    assert elbow["kp"] > elbow["kd"] > 0.0
    assert 0.0 <= elbow["overshoot_percent"] <= 3.0
    assert 0.0 < elbow["settling_s"] <= 0.2
    assert elbow["relay"]["hysteresis_deg"] == 2.0
    assert elbow["relay"]["torque_from"] == "ramp"
    assert (
        elbow["relay"]["peak_torque_nm"]
        <= default_configuration().axes[elbow["name"]].max_torque_nm
    )
    assert 0.5 < figures["summary"]["greatest_torque_share"] <= 1.0
    assert by_name["SpineX"]["status"] == "locked"
    assert by_name["SpineX"]["overshoot_percent"] is None
    assert figures["summary"]["tuned"] == 8
    assert figures["summary"]["locked"] == 83


@pytest.mark.usefixtures("installation")
def test_only_the_axes_named_are_tuned() -> None:
    """With `--axis` only that axis is tuned, the others keep their gains, and it can be locked."""
    figures = _figures("--avatar", "arm", "--axis", "LeftLowerArmY", "--axis", "SpineX")
    by_name = {axis["name"]: axis for axis in figures["axes"]}
    assert by_name["LeftLowerArmY"]["status"] == "tuned"
    assert (by_name["SpineX"]["status"], by_name["LeftHandX"]["status"]) == ("locked", "kept")
    assert by_name["LeftHandX"]["kp"] == default_configuration().axes["LeftHandX"].kp
    assert (figures["summary"]["tuned"], figures["summary"]["kept"]) == (1, 7)
    assert "none of the chosen axes" in _refusal("--avatar", "arm", "--axis", "SpineX")
    assert "no axis" in _refusal("--axis", "Elbow")


def test_a_tuned_configuration_is_written_and_stored_as_versions(installation: Path) -> None:
    """A tuned configuration is written to a file and stored as the avatar's next version."""
    out = installation / "tuned.json"
    figures = _figures("--avatar", "arm", "--out", out, "--save", "arm-tuned")
    assert figures["saved"] == "arm-tuned, version 1"
    written = load_avatar(out.read_text())
    with opened_database("test") as database, database.reading() as db:
        stored = newest_version(db, avatar_by_key(db, "arm-tuned"))
        assert stored.content_hash == written.content_hash
        assert stored.origin == "tuned"
        assert stored.report is not None
        assert stored.report["summary"] == figures["summary"]
    elbow = next(axis for axis in figures["axes"] if axis["name"] == "LeftLowerArmY")
    assert written.configuration.axes["LeftLowerArmY"].kp == elbow["kp"]
    assert written.configuration.locked_groups == tuple(
        name for name in written.configuration.locked_groups if name in _HELD
    )
    repeated = _figures("--avatar", "arm", "--heuristic", "inertia", "--save", "arm-tuned")
    assert repeated["saved"] == "arm-tuned, version 2"


@pytest.mark.usefixtures("installation")
def test_the_relay_takes_the_torque_that_the_user_chooses() -> None:
    """`--relay-torque` is the relay's torque: of one axis by name, else of all of them."""
    figures = _figures("--avatar", "arm", "--relay-torque", "0.4", "--relay-torque", "LeftHandZ=2")
    relays = {axis["name"]: axis["relay"] for axis in figures["axes"] if axis["attempts"] == 1}
    assert relays["LeftHandZ"]["torque_nm"] == 2.0
    assert relays["LeftLowerArmX"]["torque_nm"] == 0.4
    assert {relay["torque_from"] for relay in relays.values()} == {"chosen"}
    assert figures["options"]["relay_torques_nm"] == {"LeftHandZ": 2.0}


@pytest.mark.usefixtures("installation")
def test_a_relay_torque_above_every_limit_is_refused() -> None:
    """A torque for all axes that none of them may take is refused before any experiment."""
    message = _refusal("--avatar", "arm", "--relay-torque", "1e9")
    assert "a relay torque is 1e+09 N m" in message
    assert "70% of its torque limit" in message


@pytest.mark.usefixtures("installation")
def test_a_chosen_torque_is_compared_with_the_ramps() -> None:
    """A chosen torque is noted with the stiffness it gives, and warned of if far worse."""
    by_ramp = {axis["name"]: axis for axis in _figures("--avatar", "arm")["axes"]}
    stiff = by_ramp["LeftUpperArmZ"]
    weak = f"LeftUpperArmZ={stiff['relay']['torque_nm'] / 30:.4f}"
    figures = _figures("--avatar", "arm", "--relay-torque", weak, "--save", "weak")
    found = {axis["name"]: axis for axis in figures["axes"]}
    soft = found["LeftUpperArmZ"]
    assert soft["kp"] < stiff["kp"] / 5
    assert "chosen by hand" in soft["note"]
    assert f"which gives kp {soft['kp']:.4g} N m/rad" in soft["note"]
    assert f"the ramp gives kp {stiff['kp']:.4g} N m/rad" in soft["note"]
    assert f"comes to rest {abs(soft['steady_error_deg']):.2f} deg" in soft["warning"]
    assert f"settles in {soft['settling_s']:.3f} s" in soft["warning"]
    assert {axis["warning"] for name, axis in found.items() if name != "LeftUpperArmZ"} == {""}
    with opened_database("test") as database, database.reading() as db:
        note = newest_version(db, avatar_by_key(db, "weak")).note
    assert "chosen by hand: LeftUpperArmZ" in note
    elbow = by_ramp["LeftLowerArmY"]["relay"]
    assert elbow["swing_deg"] == pytest.approx(8.0)
    same = f"LeftLowerArmY={elbow['torque_nm']:.6f}"
    text = _run("--avatar", "arm", "--relay-torque", same).stdout
    assert "chosen by hand" in text
    assert "Warning" not in text


@pytest.mark.usefixtures("installation")
def test_the_text_output_has_units_and_a_summary() -> None:
    """The text output has gains with units, a status per axis and a summary."""
    result = _run("--avatar", "arm", "--mass", "60", "--stature", "1.6")
    assert result.exit_code == 0, result.output
    assert "N m/rad" in result.stdout
    assert "8 tuned, 0 retried, 0 flagged, 83 locked" in result.stdout
    assert "1.6 m, 60 kg" in result.stdout
    assert "skipped: it is in a locked group" in result.stdout
    assert "relay experiment: 8 of 8 axes" in result.stderr


@pytest.mark.usefixtures("installation")
def test_a_capture_gives_each_axis_an_angular_error(shared_data: Path) -> None:
    """With a captured walk each free axis has an error, for an arm at most 1.5 deg on average."""
    clip = shared_data / "motion" / "cmu_bvh" / "02_01.bvh"
    figures = _figures("--avatar", "arm", "--capture", clip)
    errors = {axis["name"]: axis["rms_error_deg"] for axis in figures["axes"]}
    assert 0.0 < errors["LeftLowerArmY"] < 5.0
    assert errors["SpineX"] is None
    assert 0.0 < figures["tracking"]["mean_error_deg"] <= 1.5
    assert figures["tracking"]["frames"] > 100


@pytest.mark.usefixtures("installation")
def test_existing_gains_are_evaluated_unchanged(shared_data: Path) -> None:
    """`--evaluate` reports the figures of existing gains without tuning them."""
    clip = shared_data / "motion" / "cmu_bvh" / "02_01.bvh"
    figures = _figures("--avatar", "arm", "--evaluate", "--capture", clip)
    assert figures["summary"]["accepted"] + figures["summary"]["flagged"] == 8
    assert figures["summary"]["locked"] == 83
    assert figures["options"] is None
    elbow = next(axis for axis in figures["axes"] if axis["name"] == "LeftLowerArmY")
    assert elbow["kp"] == default_configuration().axes["LeftLowerArmY"].kp
    assert elbow["relay"] is None
    tracking = figures["tracking"]
    assert tracking["unclamped"]["mean_error_deg"] >= tracking["mean_error_deg"] > 0.0
    assert tracking["clipped_share"] >= 0.0
    floor = tracking["on_floor"]
    assert floor["free"]["samples"] + floor["touching"]["samples"] == 8 * floor["frames"]


@pytest.mark.usefixtures("installation")
def test_an_avatar_with_a_humanoid_model_is_tuned() -> None:
    """An avatar with a humanoid model is tuned on the model's axes and keeps its model."""
    with opened_database("test") as database, database.writing() as db:
        db.add(CaptureContent(hash=HASH, size=1))
        db.flush()
        db.add(
            HumanoidRow(
                hash=HASH,
                file_name="four.glb",
                by="test",
                **asdict(measured(figure("Little"), read_humanoid(humanoid_file(Model())))),
                at=Clock().utc_now(),
            )
        )
        db.flush()
        arm = typed(newest_version(db, avatar_by_key(db, "arm")))
        content = file_of(replace(arm, humanoid=HASH, colliders="mesh"))
        new = NewAvatar(key="skin", title="skin", origin="by_hand", configuration=content)
        create_avatar(db, "test", new, Clock().utc_now())
    figures = _figures("--avatar", "skin", "--save", "skin-tuned")
    assert {axis["name"] for axis in figures["axes"]} == {
        name for name in AXIS_NAMES if "Little" not in name
    }
    assert figures["summary"]["tuned"] == 8
    with opened_database("test") as database, database.reading() as db:
        tuned = typed(newest_version(db, avatar_by_key(db, "skin-tuned")))
    assert (tuned.humanoid, tuned.colliders) == (HASH, "mesh")


@pytest.mark.usefixtures("installation")
def test_an_unknown_avatar_is_refused_with_the_existing_ones() -> None:
    """An unknown avatar is refused with the existing ones, including the shipped one."""
    output = _refusal("--avatar", "nobody")
    assert "nobody" in output
    assert "arm, standard" in output


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--heuristic", "guess"], "critical, inertia, ziegler-nichols-pd, tyreus-luyben-pd"),
        (["--stature", "9"], "2.6"),
        (["--mass", "0"], "mass"),
        (["--attempts", "0"], "from 1"),
        (["--capture", "nowhere.bvh"], "nowhere.bvh"),
        (["--relay-torque", "strong"], "LeftUpperLegX=20"),
        (["--relay-torque", "LeftElbow=3"], "which is no axis"),
        (["--relay-torque", "3", "--evaluate"], "no relay experiment"),
        (["--save", "Not A Key"], "lower-case letter"),
        (["--evaluate", "--save", "arm"], "changes nothing"),
    ],
)
def test_invalid_options_are_refused_before_any_experiment(
    arguments: list[str], words: str
) -> None:
    """Invalid options are refused before any experiment, with what is valid."""
    assert words in _refusal(*arguments)


@pytest.mark.long
def test_the_shipped_avatar_is_tuned_without_a_database() -> None:
    """The shipped avatar is tuned without a database, with at most 10 % overshoot on every axis."""
    figures = _figures("--mirror")
    assert figures["summary"]["worst_overshoot_percent"] <= 10.0
    assert figures["summary"]["flagged"] == 0
