"""A browser that opens pages: headless Chromium without network, what is seen in it, and the case that pages show."""

import io
import json
import shutil
import time
from contextlib import contextmanager

import numpy as np
import pytest

webdriver = pytest.importorskip("selenium.webdriver", reason="selenium is not installed")
from matplotlib.image import imread  # noqa: E402
from selenium.common.exceptions import WebDriverException  # noqa: E402
from selenium.webdriver.common.by import By  # noqa: E402
from sweeps import PLATE, altered  # noqa: E402

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
DRIVER = shutil.which("chromedriver")
PATIENCE = 600.0  # s: WebGL by software is slow on a busy machine
OFFLINE = {"offline": True, "latency": 0, "downloadThroughput": 0, "uploadThroughput": 0}
ONLINE = OFFLINE | {"offline": False, "downloadThroughput": -1, "uploadThroughput": -1}
CASE = altered(
    PLATE,
    ('cell_size = "80 um"', 'density = "2330 kg/m^3"\ncell_size = "100 um"'),
    ('stroke = "60 um"', 'stroke = "150 um"'),
    ('model = "constant"\nlimit = "40 nN"', 'model = "kogut-etsion"\npreset = "paper"'),
    ('duration = "5 ms"', 'duration = "8 ms"\nframes = 41'),
)


@contextmanager
def chromium():
    """A browser; without one the test is skipped."""
    if CHROMIUM is None or DRIVER is None:
        pytest.skip("chromium and chromedriver are not installed (Debian: apt-get install chromium chromium-driver)")
    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    for flag in (
        "headless=new",
        "no-sandbox",
        "disable-dev-shm-usage",
        "use-gl=angle",
        "use-angle=swiftshader",
        "enable-unsafe-swiftshader",
        "window-size=1400,1200",
    ):
        options.add_argument(f"--{flag}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    try:
        driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(DRIVER))
    except WebDriverException as error:
        pytest.skip(f"chromium does not start here: {error.msg}")
    try:
        driver.set_script_timeout(PATIENCE)
        if not driver.execute_script("return !!document.createElement('canvas').getContext('webgl2')"):
            pytest.skip("chromium has no WebGL here")
        driver.execute_cdp_cmd("Network.enable", {})
        driver.execute_cdp_cmd("Network.emulateNetworkConditions", OFFLINE)
        yield driver
    finally:
        driver.quit()


@contextmanager
def opening(browser, pages):
    """Opens a page by its name; afterwards nothing was asked of the network, and the console had no error."""

    def opened(name):
        browser.get(pages[name].as_uri())
        wait(lambda: browser.execute_script("return document.body.dataset.ready") == "true")
        return browser

    yield opened
    assert not browser.find_element(By.ID, "trouble").is_displayed()
    messages = [json.loads(entry["message"])["message"] for entry in browser.get_log("performance")]
    asked = [m["params"]["request"]["url"] for m in messages if m["method"] == "Network.requestWillBeSent"]
    assert not errors(browser)
    assert asked and all(url.startswith(("file:", "data:", "blob:")) for url in asked)


def errors(browser):
    """The errors that the console had since this was last asked."""
    return [entry["message"] for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]


def wait(holds, patience=PATIENCE):
    end = time.monotonic() + patience
    while not holds():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.1)


def drawn(browser):
    """Waits until all that was asked for is drawn."""

    browser.execute_async_script("const done = arguments[0]; Promise.resolve(drawing).then(done)")
    browser.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")


def pixels(browser, name):
    """An element of the page as it is seen (rows, columns, 3), from 0 to 1."""
    return imread(io.BytesIO(browser.find_element(By.ID, name).screenshot_as_png))[..., :3]


def changed(before, after):
    """The share of pixels that are not as they were."""
    return float((np.abs(before - after).max(axis=-1) > 0.1).mean())


def reddish(image):
    return float(((image[..., 0] > 0.6) & (image[..., 1] < 0.4) & (image[..., 2] < 0.35)).mean())


def readout(browser):
    groups = browser.find_elements(By.CSS_SELECTOR, "#readout div")
    return {g.find_element(By.TAG_NAME, "dt").text: g.find_element(By.TAG_NAME, "dd").text for g in groups}
