"""Draws the still of an animation that the documentation shows."""

from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image

from active_surface.views import still
from coupling import read_case, run_case

ROOT = Path(__file__).parent.parent
MOMENT = 43.5e-3  # s


def draw_animation() -> None:
    with TemporaryDirectory() as folder:
        run_case(read_case(ROOT / "examples/transport.toml"), output=folder)
        picture = still(Path(folder) / "transport", MOMENT)
    Image.fromarray(picture).save(ROOT / "docs/animation.png", optimize=True)


if __name__ == "__main__":
    draw_animation()
