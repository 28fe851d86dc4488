"""A real server on each engine, for the tests of participants' rights."""

from collections.abc import Iterator

import pytest

from tests.features.record.headset.conftest import running_site
from tests.features.record.headset.site import Site


@pytest.fixture(scope="module", params=["sqlite", "postgresql"])
def site(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Site]:
    """The server with its operator signed in; each test joins sessions of its own."""
    with running_site(request.param, tmp_path_factory.mktemp("site"), {}) as site:
        yield site
