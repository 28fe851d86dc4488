"""Decorators that compile numerical functions to machine code with Numba.

`compiled` keeps every sum in its order and fuses no operations, so that compiled and plain NumPy
forms agree to the last bit where both use only + - * / and square roots. It releases the
interpreter's lock, so several threads can run compiled code in parallel.

`compiled_fused` allows fused multiply-add, for code that runs at every frame. Sums keep their order
here too, so that equal frames give equal results within a process. What is fused depends on what
else a function is compiled with: the process that compiles and one that loads its code may differ
in the last digit. So nothing that has to be repeated to the bit may use it.

`compiled_checked` checks every index, for code that reads data from strangers: it raises an
IndexError instead of reading outside the array.

Each compiles at the first call, or loads what an earlier process compiled. Applying a decorator
loads the compiler (half a second), so kernels are kept in modules of their own, imported when first
needed.
"""

from collections.abc import Callable
from typing import TypeVar, cast

_F = TypeVar("_F", bound=Callable[..., object])


def compiled(function: _F) -> _F:
    """Compile with strict IEEE arithmetic: every operation is rounded on its own, in order."""
    return _cached(function, nogil=True)


def compiled_inside(function: _F) -> _F:
    """Compile as `compiled` does a function of another module, for calls from compiled code.

    It is not cached by itself, but as a part of its callers: Numba's cache does not tell a function
    that is compiled in two ways apart, and would load the fused form of a quaternion product here.
    """
    import numba

    return cast("_F", numba.njit(nogil=True, error_model="numpy")(function))


def compiled_fused(function: _F) -> _F:
    """Compile with fused multiply-add allowed."""
    return _cached(function, fastmath={"contract"})


def compiled_checked(function: _F) -> _F:
    """Compile with a check of every index; an index out of range raises IndexError."""
    return _cached(function, boundscheck=True)


def _cached(
    function: _F,
    *,
    nogil: bool = False,
    fastmath: bool | set[str] = False,
    boundscheck: bool = False,
) -> _F:
    import numba

    def compile_function(*, cache: bool) -> _F:
        compile_ = numba.njit(
            cache=cache,
            nogil=nogil,
            error_model="numpy",
            fastmath=fastmath,
            boundscheck=boundscheck,
        )
        return cast("_F", compile_(function))

    try:
        return compile_function(cache=True)
    except RuntimeError:  # no folder in which this user may write the cache
        return compile_function(cache=False)
