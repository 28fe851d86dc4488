"""Generate movement for the load: synthetic, looped without a seam, as compressible as captures.

Every joint turns by a random rotation vector whose spectrum falls off as in people's movement, plus
the noise of a tracker. The avatar's movement is the same, delayed and passed through a second-order
low-pass. Captured movement (CMU, retargeted, 90 Hz) takes 261 to 274 bytes a frame in the stored
chunks; this movement takes a little more (run this module to see).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.wire import VALUES_PER_FRAME
from app.wire.batch import BODY_JOINTS

RATE_HZ = 90.0
LOOP_FRAMES = 3600
SLOWEST_HZ, FALLS_OFF_HZ = 0.1, 0.6
AMPLITUDE_RAD, NOISE_RAD = 0.35, 1e-4
FOLLOWER_HZ, DELAY_S = 4.0, 0.125
ROOT_M, ROOT_NOISE_M = 0.05, 2e-4
JITTER_S = 2e-4


@dataclass(frozen=True)
class Movement:
    """A loop of n frames: `target` and `actual` (2 n, 91), stored twice, and `jitter_s` (n,)."""

    target: NDArray[np.float32]
    actual: NDArray[np.float32]
    jitter_s: NDArray[np.float64]


def make_movement(rng: np.random.Generator, frames: int = LOOP_FRAMES) -> Movement:
    """Draw a random loop whose end continues at its beginning."""
    hz: NDArray[np.float64] = np.fft.rfftfreq(frames, 1.0 / RATE_HZ).astype(np.float64)
    follows = np.exp(-2j * np.pi * hz * DELAY_S) / (1.0 + 1j * hz / FOLLOWER_HZ) ** 2
    turns = _spectra(rng, hz, 3 * BODY_JOINTS, AMPLITUDE_RAD, NOISE_RAD)
    root = _spectra(rng, hz, 3, ROOT_M, ROOT_NOISE_M)
    return Movement(
        target=_frames(root, turns, frames),
        actual=_frames(root, turns * follows[:, None], frames),
        jitter_s=rng.uniform(0.0, JITTER_S, frames),
    )


def _spectra(
    rng: np.random.Generator, hz: NDArray[np.float64], count: int, size: float, noise: float
) -> NDArray[np.complex128]:
    """Return spectra (len(hz), count) of signals with SD `size` on a floor of noise."""
    shape = np.where(hz >= SLOWEST_HZ, 1.0 / (1.0 + (hz / FALLS_OFF_HZ) ** 2), 0.0)
    frames = 2 * (len(hz) - 1)
    drawn = rng.normal(size=(len(hz), count)) + 1j * rng.normal(size=(len(hz), count))
    smooth = drawn * shape[:, None]
    smooth *= size / np.fft.irfft(smooth, frames, axis=0).std()
    floor: NDArray[np.complex128] = np.fft.rfft(
        rng.normal(scale=noise, size=(frames, count)), axis=0
    )
    return smooth + floor


def _frames(
    root: NDArray[np.complex128], turns: NDArray[np.complex128], frames: int
) -> NDArray[np.float32]:
    """Return values (2 * frames, 91): the loop twice, so that every piece is contiguous."""
    vectors_rad = np.fft.irfft(turns, frames, axis=0).reshape(frames, BODY_JOINTS, 3)
    angle = np.linalg.norm(vectors_rad, axis=2, keepdims=True)
    # sin(a/2)/a without a division by zero.
    rotations = np.concatenate(
        (np.cos(angle / 2), vectors_rad * 0.5 * np.sinc(angle / (2 * np.pi))), axis=2
    )
    values = np.empty((2 * frames, VALUES_PER_FRAME), np.float32)
    values[:frames, :3] = np.fft.irfft(root, frames, axis=0) + np.array([0.0, 0.95, 0.0])
    values[:frames, 3:] = rotations.reshape(frames, -1)
    values[frames:] = values[:frames]
    return values


def main() -> None:
    """Print how many bytes a frame of a stored chunk takes."""
    from app.features.record.telemetry.encoding import encode_frames

    movement = make_movement(np.random.default_rng(1))
    for name, values in (("target", movement.target), ("actual", movement.actual)):
        sizes = [
            len(encode_frames(at / RATE_HZ + np.arange(90) / RATE_HZ, np.ones(90, np.uint8), piece))
            for at in range(0, LOOP_FRAMES - 90, 90)
            for piece in [values[at : at + 90]]
        ]
        print(f"{name}: {np.mean(sizes) / 90:.0f} bytes a frame")


if __name__ == "__main__":
    main()
