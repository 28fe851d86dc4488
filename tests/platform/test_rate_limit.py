"""Attempts and budgets: who is slowed down, for how long, and in how much memory."""

import pytest

from app.errors import TooManyAttempts
from app.platform.rate_limit import Budget, RateLimiter, network_of

MILLION = 1_000_000


class Watch:
    """A clock that is moved by hand."""

    def __init__(self) -> None:
        self.now_s = 0.0

    def monotonic_ns(self) -> int:
        """The time."""
        return int(self.now_s * 1e9)


@pytest.mark.parametrize(
    ("address", "network"),
    [
        ("192.168.1.20", "192.168.1.20"),
        ("::ffff:192.168.1.20", "192.168.1.20"),
        ("2001:db8:1:2:3::4", "2001:db8:1:2::/64"),
        ("2001:db8:1:2:ffff::9", "2001:db8:1:2::/64"),
        ("fe80::1%eth0", "fe80::/64"),
        ("testclient", "testclient"),
        (None, ""),
    ],
)
def test_an_address_counts_for_its_network(address: str | None, network: str) -> None:
    """IPv4 by address, IPv6 by its /64: whoever has one has 2^64 of them."""
    assert network_of(address) == network


def test_a_full_window_says_how_long_to_wait() -> None:
    """After `limit` attempts the next is refused until the first is old enough."""
    watch = Watch()
    limiter = RateLimiter(2, 60.0, watch.monotonic_ns)
    limiter.attempt("a")
    watch.now_s = 20.0
    limiter.attempt("a")
    with pytest.raises(TooManyAttempts) as refused:
        limiter.attempt("a")
    assert refused.value.retry_after_s == 40.0
    limiter.attempt("b")
    watch.now_s = 60.0
    limiter.attempt("a")


def test_an_attempt_can_be_taken_back() -> None:
    """What was right, or was never looked at, does not count."""
    limiter = RateLimiter(1, 60.0, Watch().monotonic_ns)
    for _ in range(5):
        limiter.attempt("a")
        limiter.take_back("a")
    limiter.take_back("never tried")


@pytest.mark.parametrize("step_s", [0.0, 0.001])
def test_a_million_names_take_no_more_memory_than_some(step_s: float) -> None:
    """Those that were quiet for longest go, at once and as their windows end."""
    watch = Watch()
    limiter = RateLimiter(10, 1.0, watch.monotonic_ns, most_keys=500)
    budget = Budget(10.0, 1.0, watch.monotonic_ns, most_keys=500)
    most = 0
    for at in range(MILLION // 20):
        watch.now_s += step_s
        limiter.attempt(f"name {at}")
        budget.spend(f"address {at}")
        most = max(most, len(limiter), len(budget))
    assert most == 500


def test_names_of_the_past_are_forgotten() -> None:
    """A window that has ended takes no memory once anybody else tries."""
    watch = Watch()
    limiter = RateLimiter(10, 60.0, watch.monotonic_ns)
    for at in range(100):
        limiter.attempt(f"name {at}")
    watch.now_s = 61.0
    limiter.attempt("another")
    assert len(limiter) == 1


def test_a_name_that_is_under_attack_is_not_forgotten_first() -> None:
    """Who is refused again and again stays counted while others come and go."""
    limiter = RateLimiter(1, 60.0, Watch().monotonic_ns, most_keys=50)
    limiter.attempt("admin")
    for at in range(1000):
        limiter.attempt(f"name {at}")
        with pytest.raises(TooManyAttempts):
            limiter.attempt("admin")


def test_a_budget_is_refilled() -> None:
    """What was spent comes back by and by, never more than there was."""
    watch = Watch()
    budget = Budget(3.0, 0.5, watch.monotonic_ns)
    for _ in range(3):
        budget.spend("a")
    with pytest.raises(TooManyAttempts) as refused:
        budget.spend("a")
    assert refused.value.retry_after_s == 2.0
    budget.spend("b")
    watch.now_s = 2.0
    budget.spend("a")
    watch.now_s = 1000.0
    for _ in range(3):
        budget.spend("a")
    with pytest.raises(TooManyAttempts):
        budget.spend("a")


def test_what_turned_out_dear_takes_what_is_left() -> None:
    """A charge is never refused and leaves no debt."""
    watch = Watch()
    budget = Budget(3.0, 1.0, watch.monotonic_ns)
    budget.charge("a", 10.0)
    with pytest.raises(TooManyAttempts):
        budget.spend("a")
    watch.now_s = 1.0
    budget.spend("a")
