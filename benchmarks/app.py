"""How soon the page of `active-surface app` draws a path after its slider moves, or an actuator is dragged.

A headless Chromium moves the slider of an actuator's frequency 60 times a second, then drags an actuator. Each delay is
from the event of the input to the frame that has the path, as the page itself measures it. First the numbers on the
page are compared with those of a run. Last, a device of 190 periods, whose path is estimated while a slider moves: how
far off estimates end for random strokes, delays, parts, friction and places, with one frequency for all drives or not.

    python benchmarks/app.py [seconds]
"""

import json
import math
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from selenium import webdriver

from active_surface.app.leaps import leaped
from coupling import SolvedPlates, build_friction, follow_part, read_case

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
ESTIMATES = 40  # of each kind
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


def measure(driver, case, seconds, *fields):
    """Delays [ms] of sliders and of an actuator that is dragged, on the page of a case."""
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
        found = {}
        for field in fields:
            found[field] = driver.execute_async_script(MOVE, field, seconds)[1]
            time.sleep(3)
        found["an actuator's place"] = driver.execute_async_script(DRAG, seconds)[1]
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


def estimate_errors(path):
    """How far off estimates of a device end, over the distance [1], and how many are beyond what they state."""
    case, plates, chance = read_case(path), SolvedPlates(), np.random.default_rng(1)
    for frequencies in ("one frequency", "unlike frequencies"):
        off, beyond = [], 0
        while len(off) < ESTIMATES:
            changes = {f"actuators.{k}.stroke": f"{chance.uniform(1, 4)} um" for k in (0, 3, 6)}
            changes |= {f"actuators.{k}.delay": f"{chance.uniform(0, 60)} us" for k in range(9)}
            if frequencies == "unlike frequencies":
                changes |= {f"actuators.{k}.frequency": f"{chance.uniform(3.8, 4.2)} kHz" for k in range(9)}
            changes |= {"part.mass": f"{chance.uniform(1, 2.5)} ug", "friction.coefficient": chance.uniform(0.1, 0.4)}
            changes |= {f"part.position.{k}": f"{chance.uniform(-300, 300)} um" for k in range(2)}
            varied = case.vary(changes)
            surface, law = plates.scene(varied).surface, build_friction(varied)
            found, exact = leaped(varied, surface, law), follow_part(varied, surface, law)
            if exact.distance > 1e-6:
                gap = math.dist(found.path.position[-1], exact.position[-1])
                off.append(gap / exact.distance)
                beyond += gap > found.error
        print(f"estimates, {frequencies}: median {np.median(off):.2%}, largest {max(off):.2%}, beyond stated {beyond}")


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    options = webdriver.ChromeOptions()
    for flag in FLAGS:
        options.add_argument(f"--{flag}")
    driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which("chromedriver")))
    driver.set_script_timeout(10 * seconds)
    print("device        what                     paths/s  median [ms]  95 % [ms]  largest [ms]")
    try:
        with tempfile.TemporaryDirectory() as folder:
            device = Path(folder, "device.toml")
            device.write_text(app_case.DEVICE)
            cases = {f"{count} actuators": [write_case(folder, count), "actuators.0.frequency"] for count in LAYOUTS}
            cases["190 periods"] = [device, "actuators.0.stroke", "friction.coefficient", "part.mass"]
            for name, (path, *fields) in cases.items():
                for what, delays in measure(driver, path, seconds, *fields).items():
                    median, most = np.percentile(delays, [50, 95])
                    rate = len(delays) / seconds
                    print(f"{name:14}{what:21}  {rate:10.1f}  {median:11.0f}  {most:9.0f}  {max(delays):12.0f}")
            estimate_errors(device)
    finally:
        driver.quit()


if __name__ == "__main__":
    main()
