"""The film of `active-surface app` in the README: a headless Chromium does what its script says, and is photographed.

python docs/app_film.py
"""

import io
import shutil
import subprocess
import sys
import time
from pathlib import Path

from PIL import Image
from selenium import webdriver
from selenium.webdriver.common.by import By

ROOT = Path(__file__).parent.parent
CASE = ROOT / "examples/studies/moderate.toml"
FILM = ROOT / "docs/app.gif"
SIZE, SHOWN = (1240, 1000), (1240, 700)  # of the window, and of its part that is filmed
SECONDS, RATE = 20.0, 8
FLAGS = ("headless=new", "no-sandbox", "disable-dev-shm-usage", "enable-unsafe-swiftshader", "hide-scrollbars")
SLIDE = """
const [path, share, end] = arguments, slider = knobs.get(path).slider;
slider.value = share * 1000;
slider.dispatchEvent(new Event("input", { bubbles: true }));
if (end) slider.dispatchEvent(new Event("change", { bubbles: true }));
"""
DRAG = """
const [key, dx, dy, end] = arguments, group = document.querySelector(`[data-key="${key}"]`);
const kind = key === "start" ? "start" : "actuator", number = kind === "start" ? null : Number(key.split(" ")[1]);
window.filmed ??= {};
const from = window.filmed[key] ??= kind === "start" ? [...mapData.start] : [...mapData.actuators[number]];
const what = { kind, number, group, at: [from[0] + dx, from[1] + dy] };
dragged = end ? null : what;
put(group, what.at);
onDrag(what, performance.now());
if (end) { onDrop(what); delete window.filmed[key]; }
"""


def script(driver):
    """Yield frame after frame, each after what is done before it."""
    run = driver.execute_script

    def wait(frames):
        yield from range(frames)

    def moved(do, frames):
        for k in range(frames):
            do((k + 1) / frames, k == frames - 1)
            yield k

    yield from wait(6)
    driver.find_element(By.CSS_SELECTOR, '[data-window="path"]').click()
    yield from wait(6)
    stroke, frequency = "actuators.0.stroke", "actuators.0.frequency"
    yield from moved(lambda t, end: run(SLIDE, stroke, 0.5 + 0.08 * t, end), 14)
    yield from wait(4)
    yield from moved(lambda t, end: run(SLIDE, frequency, 0.5 - 0.012 * t, end), 14)
    yield from wait(8)
    yield from moved(lambda t, end: run(DRAG, "start", 100 * t, 160 * t, end), 16)
    yield from wait(10)
    driver.find_element(By.CSS_SELECTOR, '[data-window="plate"]').click()
    yield from wait(5)
    yield from moved(lambda t, end: run(DRAG, "actuator 1", -250 * t, 300 * t, end), 18)
    yield from wait(22)
    driver.find_element(By.ID, "undo").click()
    yield from wait(14)
    while True:
        yield 0


def main():
    command = [sys.executable, "-m", "active_surface", "app", str(CASE), "--no-browser"]
    program = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    options = webdriver.ChromeOptions()
    for flag in (*FLAGS, f"window-size={SIZE[0]},{SIZE[1]}"):
        options.add_argument(f"--{flag}")
    driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which("chromedriver")))
    try:
        driver.get(program.stdout.readline().split()[1])
        while driver.execute_script("return document.body.dataset.ready") != "run":
            time.sleep(0.1)
        time.sleep(3)
        while driver.execute_script("return element('busy').textContent"):  # quick paths are being prepared
            time.sleep(0.5)
        driver.execute_script("element('file').hidden = true")  # its path differs from machine to machine
        frames, begun = [], time.monotonic()
        for number, _ in enumerate(script(driver)):
            if number == int(SECONDS * RATE):
                break
            time.sleep(max(0.0, begun + number / RATE - time.monotonic()))
            picture = Image.open(io.BytesIO(driver.get_screenshot_as_png())).convert("RGB")
            frames.append(
                picture.crop((0, 0, *SHOWN)).resize((SHOWN[0] * 4 // 5, SHOWN[1] * 4 // 5), Image.Resampling.LANCZOS)
            )
        print(f"{len(frames)} frames in {time.monotonic() - begun:.0f} s")
    finally:
        driver.quit()
        program.terminate()
        program.wait()
    some = frames[:: len(frames) // 8]
    strip = Image.new("RGB", (frames[0].width, frames[0].height * len(some)))
    for k, frame in enumerate(some):
        strip.paste(frame, (0, k * frame.height))
    palette = strip.quantize(255, method=Image.Quantize.MAXCOVERAGE, kmeans=5, dither=Image.Dither.NONE)
    plain = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    plain[0].save(FILM, save_all=True, append_images=plain[1:], duration=round(1000 / RATE), loop=0, optimize=True)
    print(f"wrote {FILM}, {FILM.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
