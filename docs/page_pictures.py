"""Screenshots of the pages that `active-surface view` writes, by a headless Chromium."""

import shutil
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

from active_surface.studies import read_study, run_study
from active_surface.views import write_run_page, write_study_page
from coupling import read_case, read_run, run_case

ROOT = Path(__file__).parent.parent
SIZE = "1360,1180"
FLAGS = ("headless=new", "no-sandbox", "hide-scrollbars", "use-gl=angle", "use-angle=swiftshader")


def draw_pages() -> None:
    """Draw docs/page.png and docs/page_sweep.png, where there is a Chromium."""
    chromium = shutil.which("chromium")
    if chromium is None:
        print("there is no chromium: docs/page.png and docs/page_sweep.png stay as they are")
        return
    with TemporaryDirectory() as folder:
        run_case(read_case(ROOT / "examples/transport.toml"), output=folder)
        page = write_run_page(read_run(Path(folder, "transport")), Path(folder, "run.html"))
        _shoot(chromium, f"{page.as_uri()}#t=43.5", ROOT / "docs/page.png")
        study = read_study(ROOT / "examples/studies/frequency_stroke.toml")
        sweep = write_study_page(study, run_study(study).dataset, Path(folder, "sweep.html"))
        _shoot(chromium, sweep.as_uri(), ROOT / "docs/page_sweep.png")


def _shoot(chromium: str, address: str, picture: Path) -> None:
    flags = [*FLAGS, "enable-unsafe-swiftshader", f"window-size={SIZE}", f"screenshot={picture}"]
    flags.append("virtual-time-budget=60000")
    subprocess.run([chromium, *(f"--{flag}" for flag in flags), address], check=True, capture_output=True)


if __name__ == "__main__":
    draw_pages()
