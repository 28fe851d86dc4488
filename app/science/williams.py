"""Williams designs: small sets of orders that balance position and first-order carry-over.

Williams 1949, Experimental designs balanced for the estimation of residual effects of treatments.
"""

Row = tuple[int, ...]


def williams(n: int) -> tuple[Row, ...]:
    """Return the orders of n treatments 0..n-1: n rows for an even n, 2n for an odd one.

    Every treatment is equally often at every position (once; twice for an odd n), and every ordered
    pair of different treatments is adjacent equally often. For n = 3 these are all six
    permutations. Raises ValueError for n below 1.
    """
    if n < 1:
        raise ValueError(f"{n} treatments cannot be ordered; give at least 1.")
    # 0, 1, n-1, 2, n-2, ...: the differences of neighbours, modulo n, are all different.
    first = [(place + 1) // 2 if place % 2 else -(place // 2) for place in range(n)]
    rows = [tuple((treatment + shift) % n for treatment in first) for shift in range(n)]
    if n % 2 == 0 or n == 1:
        return tuple(rows)
    # For an odd n these rows contain half of the ordered pairs; reversed, the other half.
    return (*rows, *(row[::-1] for row in rows))
