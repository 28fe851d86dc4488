"""Marker sets as data: which label in a laboratory's set denotes which landmark of the body.

Landmarks (L and R before those on both sides): ASI, PSI front and back of the pelvis, SACR between
the PSI; KNE, KNM outer and inner knee; ANK, ANM outer and inner ankle; HEE heel, TOE head of the
second metatarsal, MT1, MT5 of the first and fifth; C7 and T10 vertebrae, CLAV top and STRN bottom
of the breast bone; ACR top of the shoulder; ELB, ELM outer and inner elbow; WRA, WRB thumb and
little-finger side of the wrist, WRI one marker on it; FIN knuckles; FHD, BHD front and back of the
head.

Labels are compared in upper case, without dots, spaces and underscores.
"""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class MarkerSet:
    """The labels of one marker set.

    `labels` maps each landmark to its possible labels. "_" stands for L or R, in landmark and
    label.
    """

    title: str
    labels: Mapping[str, tuple[str, ...]]

    def found_in(self, names: tuple[str, ...]) -> dict[str, str]:
        """Return the marker of each landmark that is found among these markers."""
        prefix = _common_prefix(names)
        by_label = {normalised_label(name.removeprefix(prefix)): name for name in reversed(names)}
        found: dict[str, str] = {}
        for landmark, labels in self._both_sides():
            marker = next((by_label[label] for label in labels if label in by_label), None)
            if marker is not None:
                found[landmark] = marker
        return found

    def _both_sides(self) -> list[tuple[str, list[str]]]:
        out = []
        for landmark, labels in self.labels.items():
            for side in ("L", "R") if "_" in landmark else ("",):
                plain_labels = [normalised_label(label.replace("_", side)) for label in labels]
                out.append((landmark.replace("_", side), plain_labels))
        return out


def _common_prefix(names: tuple[str, ...]) -> str:
    """Return the prefix (up to the first underscore) that most names share; "" if there is none.

    It is the name of a person or a marker set.
    """
    counts = Counter(name.split("_", 1)[0] for name in names if "_" in name)
    for prefix, count in counts.most_common(1):
        if 2 * count > len(names):
            return f"{prefix}_"
    return ""


def normalised_label(label: str) -> str:
    """Return a label in upper case without punctuation and spaces, which laboratories vary."""
    return "".join(letter for letter in label.upper() if letter.isalnum())


VICON = MarkerSet(
    "Vicon full body (Plug-in Gait, CMU)",
    {
        "_ASI": ("_ASI", "_FWT"),
        "_PSI": ("_PSI", "_BWT"),
        "SACR": ("SACR",),
        "_KNE": ("_KNE",),
        "_KNM": ("_KNM", "_KNEM", "_MKNE"),
        "_ANK": ("_ANK",),
        "_ANM": ("_ANM", "_ANKM", "_MED"),
        "_HEE": ("_HEE",),
        "_TOE": ("_TOE",),
        "_MT1": ("_MT1",),
        "_MT5": ("_MT5",),
        "C7": ("C7",),
        "T10": ("T10",),
        "CLAV": ("CLAV",),
        "STRN": ("STRN",),
        "_ACR": ("_SHO",),
        "_ELB": ("_ELB",),
        "_ELM": ("_ELM", "_ELBM"),
        "_WRA": ("_WRA",),
        "_WRB": ("_WRB",),
        "_FIN": ("_FIN",),
        "_FHD": ("_FHD",),
        "_BHD": ("_BHD",),
    },
)
MOTION_ANALYSIS = MarkerSet(
    "Motion Analysis (Helen Hayes)",
    {
        "_ASI": ("_.ASIS",),
        "_PSI": ("_.PSIS",),
        "SACR": ("V.Sacral", "Sacral", "V.Sacrum", "Sacrum"),
        "_KNE": ("_.Knee", "_.Knee.Lateral"),
        "_KNM": ("_.Knee.Medial",),
        "_ANK": ("_.Ankle", "_.Ankle.Lateral"),
        "_ANM": ("_.Ankle.Medial",),
        "_HEE": ("_.Heel",),
        "_TOE": ("_.Toe", "_.MT2"),
        "_MT1": ("_.MT1", "_.Foot.Medial"),
        "_MT5": ("_.MT5", "_.Foot.Lateral"),
        "C7": ("C7",),
        "T10": ("T10",),
        "CLAV": ("IJ", "Clavicle"),
        "STRN": ("PX", "Sternum"),
        "_ACR": ("_.Shoulder", "_.Acromion"),
        "_ELB": ("_.Elbow", "_.Elbow.Lateral"),
        "_ELM": ("_.Elbow.Medial",),
        "_WRI": ("_.Wrist",),
        "_WRA": ("_.Radius", "_.Wrist.Lateral"),
        "_WRB": ("_.Ulna", "_.Wrist.Medial"),
    },
)
OPTITRACK = MarkerSet(
    "OptiTrack Motive (Baseline) and Qualisys (Animation)",
    {
        "_ASI": ("Waist_Front",),
        "_PSI": ("Waist_Back",),
        "SACR": ("WaistBack",),
        "_KNE": ("_KneeOut",),
        "_KNM": ("_KneeIn",),
        "_ANK": ("_AnkleOut",),
        "_ANM": ("_AnkleIn",),
        "_HEE": ("_Heel", "_HeelBack"),
        "_MT1": ("_ToeIn", "_ForefootIn"),
        "_MT5": ("_ToeOut", "_ForefootOut"),
        "C7": ("BackTop", "SpineTop"),
        "CLAV": ("ChestTop", "Chest"),
        "_ACR": ("_ShoulderTop",),
        "_ELB": ("_ElbowOut",),
        "_ELM": ("_ElbowIn",),
        "_WRA": ("_WristIn",),
        "_WRB": ("_WristOut",),
    },
)
MARKER_SETS = (VICON, MOTION_ANALYSIS, OPTITRACK)
