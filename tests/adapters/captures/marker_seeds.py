"""Small valid marker files and ASF/AMC pairs, which the fuzzing tests damage."""

from collections.abc import Mapping

import numpy as np

from tests.adapters.captures.c3d_files import DEC, INTEL, MIPS, C3dFile

TRC = """PathFileType\t4\t(X/Y/Z)\tsmall.trc
DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate
100.0\t100.0\t3\t2\tcm\t100.0
Frame#\tTime\tHead\t\t\tFoot\t\t\t
\t\tX1\tY1\tZ1\tX2\tY2\tZ2

1\t0.00\t0\t170\t0\t10\t5\t0
2\t0.01\t1\t170\t0\t\t\t
3\t0.02\t2\t170\t0\t12\t5\t0
"""
ASF = """# a comment
:version 1.10
:name SMALL
:units
  mass 1.0
  length 0.45
  angle deg
:documentation
   made for a test
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name thigh
     direction 0 -1 0
     length 8
     axis 0 0 90 XYZ
    dof rx rz
    limits (-160.0 20.0)
           (-70.0 70.0)
  end
  begin
     id 2
     name shin
     direction 0 -1 0
     length 7
     axis 0 0 0 XYZ
    dof rx
  end
:hierarchy
  begin
    root thigh
    thigh shin
  end
"""
AMC = """#!OML:ASF somewhere.ASF
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 0 0 0
thigh 0 0
shin 0
2
root 1 2 3 0 90 0
thigh 90 0
shin 30
"""


def c3d_seeds() -> list[bytes]:
    """Return C3D files of each processor and number type, with and without optional parts."""
    rng = np.random.default_rng(8)
    places = rng.uniform(-900.0, 900.0, (5, 3, 3))
    places[2, 1] = np.nan
    labels = ("Ann:LKNE", "Ann:RKNE", "Ann:RKNE")
    described = ("left knee", "right knee", "inner knee")
    return [
        C3dFile(places, labels, processor, real, descriptions=described, analogue=n).to_bytes()
        for n, (processor, real) in enumerate(
            ((INTEL, True), (INTEL, False), (DEC, True), (DEC, False), (MIPS, True), (MIPS, False))
        )
    ] + [C3dFile(places, labels, texts={}, long=True).to_bytes()]


def marker_seeds() -> dict[str, tuple[str, list[tuple[Mapping[str, bytes], bytes]]]]:
    """Return a file name and the seeds of each format, each with its companion files."""
    return {
        "c3d": ("a.c3d", [({}, seed) for seed in c3d_seeds()]),
        "trc": ("a.trc", [({}, TRC.encode())]),
        "asf-amc": ("a_01.amc", [({"a.asf": ASF.encode()}, AMC.encode())]),
    }
