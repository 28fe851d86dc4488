"""Small valid files of each table format, which the fuzzing tests damage."""

import numpy as np

from app.adapters.captures import to_bvh
from tests.adapters.captures.motive_texts import Dialect, motive_text
from tests.adapters.captures.moving_rigs import random_motion, random_rig

_MOVING_JOINT = """HIERARCHY
ROOT Hips
{
  OFFSET 0 90 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Head
  {
    OFFSET 0 110 0
    CHANNELS 5 Yrotation Xposition Zrotation Yposition Xrotation
    End Site
    {
      OFFSET 0 10 0
    }
  }
}
MOTION
Frames: 3
Frame Time: 0.01
0 90 0 0 0 0 10 0 0 70 0
0 90 5 10 0 0 20 0 0 70 0
0 90 9 20 0 0 30 0 0 72 0
"""
_VICON = """Objects
100
,,Global Angle hip:hip,,,,,,Global Angle a:head,,,,,
Frame,Sub Frame,RX,RY,RZ,TX,TY,TZ,RX,RY,RZ,TX,TY,TZ
,,rad,rad,rad,mm,mm,mm,rad,rad,rad,mm,mm,mm
5,0,0,0,1.5,1000,2000,3000,0,0,0,10,20,30
6,0,0.1,0,1.6,1000,2010,3000,,,,,,
7,0,0.2,0,1.7,1000,2020,3000,0,0,0,10,20,31
"""
_UXF = """time,head_pos_x,head_pos_y,head_pos_z,head_rot_x,head_rot_y,head_rot_z,grab,trigger
189.4543,-0.780146,1.547568,-0.48988,32.79805,0.5146,358.4583,0,False
189.4656,-0.777324,1.546342,-0.486952,33.38631,1.289089,358.7749,0,False
189.4763,0,0,0,0,0,0,0,True
"""
_GERMAN = """time;pos_x;pos_y;pos_z;rot_x;rot_y;rot_z
1,5;0,25;1,5;-0,5;0;90;0
1,6;0,3;1;0;0;0;0
"""
_QUEST = """TouchButtons,HeadPosX,HeadPosY,HeadPosZ,HeadOrientationW,HeadOrientationX,\
HeadOrientationY,HeadOrientationZ,time
0,0.0516,0.0225,0.2200,0.997151,-0.0745753,-0.00635856,0.00941263,0.0169733
0,0.0517,0.0226,0.2201,0.997151,-0.0745753,-0.00635856,0.00941263,0.0335265
1,0.0518,0.0227,0.2202,0.997151,-0.0745753,-0.00635856,0.00941263,0.0497919
"""


def _motive() -> list[bytes]:
    rng = np.random.default_rng(31)
    rig = random_rig(rng, ("Hip", "Ab", "LThigh"), (-1, 0, 0))
    motion = random_motion(rng, rig, frames=4)
    dialects = (
        Dialect("1.21", labelled=False, line_end="\r\n"),
        Dialect("1.22", rotation="XYZ", labelled=False, states_settings=False, mark=True),
        Dialect("1.24", timecode=True, missing=((1, 1),)),
        Dialect("1.25", parents=True, space="Local", markers=1, trailing_commas=5),
    )
    return [motive_text(motion, dialect).encode() for dialect in dialects]


def _bvh() -> list[bytes]:
    rng = np.random.default_rng(32)
    rig = random_rig(rng, ("Hip", "Arm", "Leg"), (-1, 0, 0), ends=True)
    return [to_bvh(random_motion(rng, rig, frames=4)).encode(), _MOVING_JOINT.encode()]


def table_seeds() -> dict[str, tuple[str, list[bytes]]]:
    """Return a file name and the seeds of each format."""
    return {
        "bvh": ("a.bvh", _bvh()),
        "motive-csv": ("a.csv", _motive()),
        "vicon-tracker-csv": ("a.csv", [_VICON.encode()]),
        "uxf-tracker": ("a.csv", [_UXF.encode(), _GERMAN.encode()]),
        "quest-log": ("a.csv", [_QUEST.encode()]),
    }
