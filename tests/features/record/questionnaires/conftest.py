"""Fixtures with a session whose form is due, and its tablet."""

import pytest
from fastapi.testclient import TestClient

from tests.features.lab import Lab
from tests.features.record.questionnaires.forms import FORM


@pytest.fixture
def session_id(lab: Lab) -> str:
    """Return the id of a session whose first embodiment questionnaire is due."""
    return str(lab.skip_to(lab.join(), FORM)["id"])


@pytest.fixture
def tablet(lab: Lab, session_id: str) -> TestClient:
    """Return the client of the session's tablet."""
    return lab.tablet(session_id)
