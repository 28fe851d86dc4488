"""Tests of rate limits: who is limited, for how long, and in how much memory."""

import pytest

from app.errors import TooManyAttempts
from app.platform.rate_limit import Budget, RateLimiter, network_of

MILLION = 1_000_000


class ManualClock:
    """A clock that is set by hand."""

    def __init__(self) -> None:
        self.now_s = 0.0

    def monotonic_ns(self) -> int:
        """Return the time in nanoseconds."""
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
    """Limits apply to each IPv4 address and to each IPv6 /64, as one owner has 2^64 addresses."""
    assert network_of(address) == network


def test_a_full_window_says_how_long_to_wait() -> None:
    """After `limit` attempts the next is refused until the first leaves the window."""
    watch = ManualClock()
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
    """An attempt that is taken back does not count."""
    limiter = RateLimiter(1, 60.0, ManualClock().monotonic_ns)
    for _ in range(5):
        limiter.attempt("a")
        limiter.take_back("a")
    limiter.take_back("never tried")


@pytest.mark.parametrize("step_s", [0.0, 0.001])
def test_memory_is_bounded_for_any_number_of_names(step_s: float) -> None:
    """Limits keep at most `most_keys` names in memory, evicting the longest idle."""
    watch = ManualClock()
    limiter = RateLimiter(10, 1.0, watch.monotonic_ns, most_keys=500)
    budget = Budget(10.0, 1.0, watch.monotonic_ns, most_keys=500)
    most = 0
    for at in range(MILLION // 20):
        watch.now_s += step_s
        limiter.attempt(f"name {at}")
        budget.spend(f"address {at}")
        most = max(most, len(limiter), len(budget))
    assert most == 500


def test_expired_names_are_forgotten() -> None:
    """Names whose window has ended are forgotten at the next attempt."""
    watch = ManualClock()
    limiter = RateLimiter(10, 60.0, watch.monotonic_ns)
    for at in range(100):
        limiter.attempt(f"name {at}")
    watch.now_s = 61.0
    limiter.attempt("another")
    assert len(limiter) == 1


def test_a_refused_name_is_not_evicted() -> None:
    """A name that is refused repeatedly is not evicted by many others."""
    limiter = RateLimiter(1, 60.0, ManualClock().monotonic_ns, most_keys=50)
    limiter.attempt("admin")
    for at in range(1000):
        limiter.attempt(f"name {at}")
        with pytest.raises(TooManyAttempts):
            limiter.attempt("admin")


def test_a_budget_is_refilled() -> None:
    """A budget refills over time, up to its capacity."""
    watch = ManualClock()
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


def test_a_charge_takes_at_most_what_is_left() -> None:
    """A charge above the budget empties it and leaves no debt."""
    watch = ManualClock()
    budget = Budget(3.0, 1.0, watch.monotonic_ns)
    budget.charge("a", 10.0)
    with pytest.raises(TooManyAttempts):
        budget.spend("a")
    watch.now_s = 1.0
    budget.spend("a")
