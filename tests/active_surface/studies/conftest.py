"""What tests of sweeps share."""

from pathlib import Path

import pytest


@pytest.fixture
def without_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sweeps leave an empty picture: drawing one takes longer than their paths."""

    def blank(study: object, dataset: object, path: Path) -> Path:
        path.touch()
        return path

    monkeypatch.setattr("active_surface.studies.run.draw_sweep", blank)
