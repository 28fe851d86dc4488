"""Functions compiled to machine code: once with no liberty, once with one.

`compiled` keeps every sum in its order and fuses nothing, so that compiled and plain NumPy forms
agree to the last bit where both use only + - * / and square roots. The interpreter's lock is
released: threads work side by side.

`compiled_fused` allows fused multiply-add, for what runs at every frame. Sums keep their order here
too, so that equal frames come out equal.

Either compiles at the first call, or reads what an earlier process compiled. Decorating loads the
compiler (half a second), so kernels are kept in modules of their own, imported when first needed.
"""

from collections.abc import Callable
from typing import TypeVar, cast

_F = TypeVar("_F", bound=Callable[..., object])


def compiled(function: _F) -> _F:
    """Compile strictly: the result is that of IEEE arithmetic, operation by operation."""
    return _cached(function, nogil=True)


def compiled_fused(function: _F) -> _F:
    """Compile with fused multiply-add allowed."""
    return _cached(function, fastmath={"contract"})


def _cached(function: _F, *, nogil: bool = False, fastmath: bool | set[str] = False) -> _F:
    import numba

    def made(*, cache: bool) -> _F:
        compile_ = numba.njit(cache=cache, nogil=nogil, error_model="numpy", fastmath=fastmath)
        return cast("_F", compile_(function))

    try:
        return made(cache=True)
    except RuntimeError:  # there is no folder that this user may write to
        return made(cache=False)
