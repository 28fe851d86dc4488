"""Functions compiled to machine code, without the liberties that change a result.

Sums keep their order and nothing is fused, so that compiled and plain NumPy forms agree to the last
bit where both use only + - * / and square roots. The interpreter's lock is released: threads work
side by side. Importing this loads the compiler (half a second), so only kernels do, and kernels
are imported when first needed.
"""

from collections.abc import Callable
from typing import TypeVar, cast

import numba

_F = TypeVar("_F", bound=Callable[..., object])


def compiled(function: _F) -> _F:
    """Compile at the first call, or read what an earlier process compiled."""
    try:
        return _njit(function, cache=True)
    except RuntimeError:  # there is no folder that this user may write to
        return _njit(function, cache=False)


def _njit(function: _F, *, cache: bool) -> _F:
    return cast("_F", numba.njit(cache=cache, nogil=True, error_model="numpy")(function))
