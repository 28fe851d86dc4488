"""A server that the tests of this folder share."""

from collections.abc import Iterator

import pytest

from tests.features.record.headset.conftest import running_site
from tests.features.record.headset.site import Site


@pytest.fixture(scope="package")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    """A server; one engine is enough, since the queries are plain."""
    with running_site("sqlite", tmp_path_factory.mktemp("trackers"), {}) as site:
        yield site
