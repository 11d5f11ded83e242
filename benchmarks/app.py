"""How soon the page of `active-surface app` draws a path after its slider moves, or an actuator is dragged.

A headless Chromium moves the slider of an actuator's frequency 60 times a second, then drags an actuator. Each delay is
from the event of the input to the frame that has the path, as the page itself measures it. First the numbers on the
page are compared with those of a run.

    python benchmarks/app.py [seconds]
"""

import json
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from selenium import webdriver

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "reference"))
import app_case  # noqa: E402

PLATE, OTHERS = app_case.CASE.split("# The only one.")
PART = OTHERS[OTHERS.index("[part]") :]
for of_tests, here in (
    ("80 um", "50 um"),
    ("3 ms", "40 ms"),
    ('model = "constant"\nlimit = "40 nN"', 'model = "kogut-etsion"\npreset = "paper"'),
):
    PART = PART.replace(of_tests, here)
ACTUATOR = """
[[actuators]]
position = ["{x:g} um", "{y:g} um"]
stroke = "{stroke:g} um"
frequency = "{frequency:g} Hz"
delay = "{delay:g} ms"
"""
LAYOUTS = {
    2: [(-75, 0), (75, 0)],
    9: [(x, y) for x in (-100, 0, 100) for y in (-100, 0, 100)],
    25: [(x, y) for x in (-140, -70, 0, 70, 140) for y in (-140, -70, 0, 70, 140)],
}
FLAGS = ("headless=new", "no-sandbox", "disable-dev-shm-usage", "enable-unsafe-swiftshader", "window-size=1400,1300")
MOVE = """
const [path, seconds, done] = arguments, slider = knobs.get(path).slider, begun = performance.now();
delays.length = 0;
let moves = 0;
const step = (now) => {
  const t = (now - begun) / 1000;
  if (t > seconds) { setTimeout(() => done([moves, delays]), 300); return; }
  slider.value = 500 + 150 * Math.sin(2 * t);
  slider.dispatchEvent(new Event("input", { bubbles: true }));
  moves++;
  requestAnimationFrame(step);
};
requestAnimationFrame(step);
"""
DRAG = """
const [seconds, done] = arguments, begun = performance.now(), group = document.querySelector('[data-key="actuator 0"]');
const what = { kind: "actuator", number: 0, at: [...mapData.actuators[0]], group }, from = [...what.at];
delays.length = 0;
let moves = 0;
dragged = what;
const step = (now) => {
  const t = (now - begun) / 1000;
  if (t > seconds) { dragged = null; onDrop(what); setTimeout(() => done([moves, delays]), 300); return; }
  what.at = [from[0] + 10 * Math.sin(2 * t), from[1] + 10 * Math.sin(3 * t)];
  onDrag(what, now);
  moves++;
  requestAnimationFrame(step);
};
requestAnimationFrame(step);
"""


def write_case(folder, count):
    """A case with so many actuators."""
    stroke = {2: 150, 9: 50, 25: 20}[count]
    drives = [
        ACTUATOR.format(x=x, y=y, stroke=stroke, frequency=500 + 7 * k, delay=0.8 * (k % 3))
        for k, (x, y) in enumerate(LAYOUTS[count])
    ]
    path = Path(folder, f"actuators_{count}.toml")
    path.write_text(PLATE + "".join(drives) + "\n" + PART)
    return path


def measure(driver, case, seconds):
    """Delays [ms] of a slider and of an actuator that is dragged, on the page of a case."""
    command = [sys.executable, "-m", "active_surface", "app", str(case), "--no-browser"]
    program = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        driver.get(program.stdout.readline().split()[1])
        ready(driver)
        shown = driver.execute_script("return runData.figures")
        figures = json.loads(
            subprocess.run(
                [sys.executable, "-m", "active_surface", "run", str(case), "--json", "--output", str(case.parent)],
                check=True, capture_output=True, text=True,
            ).stdout
        )  # fmt: skip
        assert (shown["distance"], shown["end"]) == (figures["distance"], figures["end_position"])
        found = [driver.execute_async_script(MOVE, "actuators.0.frequency", seconds)]
        time.sleep(3)
        found.append(driver.execute_async_script(DRAG, seconds))
        return found
    finally:
        program.terminate()
        program.wait()


def ready(driver):
    """Wait until the run is shown."""
    end = time.monotonic() + 120
    while driver.execute_script("return document.body.dataset.ready") != "run":
        assert time.monotonic() < end
        time.sleep(0.1)


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    options = webdriver.ChromeOptions()
    for flag in FLAGS:
        options.add_argument(f"--{flag}")
    driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which("chromedriver")))
    driver.set_script_timeout(10 * seconds)
    print("actuators  what      paths/s  median [ms]  95 % [ms]  largest [ms]")
    try:
        with tempfile.TemporaryDirectory() as folder:
            for count in LAYOUTS:
                for what, (_, delays) in zip(
                    ("slider", "actuator"), measure(driver, write_case(folder, count), seconds), strict=True
                ):
                    median, most = np.percentile(delays, [50, 95])
                    rate = len(delays) / seconds
                    print(f"{count:9}  {what:8}  {rate:7.1f}  {median:11.0f}  {most:9.0f}  {max(delays):12.0f}")
    finally:
        driver.quit()


if __name__ == "__main__":
    main()
