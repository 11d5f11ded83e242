"""Pages in a real browser: headless Chromium moves the slider, plays, clicks, and looks at pixels and labels."""

import io
import json
import shutil
import time

import numpy as np
import pytest

from coupling import read_case, run_case
from coupling.saved import read_run
from studies import read_study, run_study
from views.run_page import write_run_page
from views.study_page import write_study_page

webdriver = pytest.importorskip("selenium.webdriver", reason="selenium is not installed")
from matplotlib.image import imread  # noqa: E402
from selenium.common.exceptions import WebDriverException  # noqa: E402
from selenium.webdriver.common.action_chains import ActionChains  # noqa: E402
from selenium.webdriver.common.by import By  # noqa: E402
from selenium.webdriver.common.keys import Keys  # noqa: E402

pytestmark = [pytest.mark.compiled, pytest.mark.filterwarnings("ignore::ResourceWarning")]

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
DRIVER = shutil.which("chromedriver")
PATIENCE = 120.0  # s: WebGL by software is slow on a busy machine
OFFLINE = {"offline": True, "latency": 0, "downloadThroughput": 0, "uploadThroughput": 0}
NAME = "two <script>alert(1)</script>"
CASE = """\
[plate]
shape = "disc"
radius = "300 um"
supports = "clamped"
youngs_modulus = "169 GPa"
poisson_ratio = 0.3
thickness = "5 um"
density = "2330 kg/m^3"
cell_size = "100 um"

[[actuators]]
position = ["-75 um", "0 um"]
stroke = "150 um"
frequency = "400 Hz"

[[actuators]]
position = ["75 um", "0 um"]
stroke = "150 um"
frequency = "300 Hz"

[part]
mass = "2e-9 kg"
position = ["-140 um", "20 um"]

[friction]
model = "kogut-etsion"
preset = "paper"

[run]
duration = "8 ms"
frames = 41
"""
STUDY = """\
[study]
case = "base.toml"

[[axes]]
field = "actuators.0.frequency"
name = "frequency"
range = ["300 Hz", "600 Hz"]
count = 4

[[axes]]
field = "actuators.*.stroke"
name = "stroke"
range = ["20 um", "60 um"]
count = 3
"""


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pages")
    (folder / "base.toml").write_text(CASE)
    (folder / "many.toml").write_text(STUDY)
    case = read_case(folder / "base.toml")
    run_case(case.model_copy(update={"name": "base"}), folder)
    run = read_run(folder / "base")
    object.__setattr__(run, "name", NAME)
    single = read_run(folder / "base")
    for name in ("time", "position", "velocity", "state", "normal_force", "friction_force"):
        object.__setattr__(single, name, getattr(single, name)[:1])
    study = read_study(folder / "many.toml")
    found = run_study(study)
    return {
        "run": write_run_page(run, folder / "run.html"),
        "single": write_run_page(single, folder / "single.html"),
        "sweep": write_study_page(study, found.dataset, folder / "sweep.html"),
        "few": write_study_page(study, found.dataset, folder / "few.html", 3),
    }


@pytest.fixture(scope="module")
def browser():
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


@pytest.fixture
def open_page(browser, pages):
    """Opens a page by its name; afterwards nothing was asked of the network, and the console had no error."""

    def opened(name):
        browser.get(pages[name].as_uri())
        wait(lambda: browser.execute_script("return document.body.dataset.ready") == "true")
        return browser

    yield opened
    assert not browser.find_element(By.ID, "trouble").is_displayed()
    errors = [entry["message"] for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
    messages = [json.loads(entry["message"])["message"] for entry in browser.get_log("performance")]
    asked = [m["params"]["request"]["url"] for m in messages if m["method"] == "Network.requestWillBeSent"]
    assert not errors
    assert asked and all(url.startswith(("file:", "data:", "blob:")) for url in asked)


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


def test_the_slider_moves_surface_part_trail_and_labels(open_page):
    browser = open_page("run")
    slider, clock = browser.find_element(By.ID, "step"), browser.find_element(By.ID, "clock")
    surface, curves, told = pixels(browser, "surface"), pixels(browser, "curves"), readout(browser)
    assert surface.std() > 0.05  # something is drawn
    assert clock.text == "0.00 of 8.000 ms" and told["state"] == "stuck"
    slider.send_keys(Keys.END)
    drawn(browser)
    assert slider.get_attribute("value") == "40" and clock.text == "8.00 of 8.000 ms"
    assert changed(surface, pixels(browser, "surface")) > 0.003
    assert reddish(pixels(browser, "surface")) > reddish(surface) + 5e-4  # the trail
    assert changed(curves, pixels(browser, "curves")) > 0.001  # the cursor
    assert readout(browser)["position x, y"] != told["position x, y"]
    for _ in range(27):
        slider.send_keys(Keys.ARROW_LEFT)
    drawn(browser)
    assert clock.text == "2.60 of 8.000 ms"
    assert slider.get_attribute("aria-valuetext").startswith("2.60 ms, ")
    lifted = pixels(browser, "surface")
    assert changed(surface, lifted) > 0.01  # the plate
    assert browser.execute_script("return document.getElementById('curves').layout.shapes[0].x0") == pytest.approx(2.6)


def test_it_plays_to_the_end_and_pauses(open_page):
    browser = open_page("run")
    button, slider = browser.find_element(By.ID, "play"), browser.find_element(By.ID, "step")
    browser.execute_script("document.getElementById('pace').value = '60'")
    button.click()
    assert "Pause" in button.text
    wait(lambda: int(slider.get_attribute("value")) >= 2)
    button.click()
    assert "Play" in button.text
    drawn(browser)
    held = slider.get_attribute("value")
    time.sleep(2.0)
    assert slider.get_attribute("value") == held
    browser.execute_script("document.getElementById('pace').value = '5'")
    button.click()
    wait(lambda: slider.get_attribute("value") == "40" and "Play" in button.text)


def test_it_plays_where_the_clock_of_frames_lies_before_the_click(open_page):
    browser = open_page("run")
    browser.execute_script(
        "const next = requestAnimationFrame; window.requestAnimationFrame = (f) => next((now) => f(now - 500))"
    )
    browser.find_element(By.ID, "play").click()
    slider = browser.find_element(By.ID, "step")
    wait(lambda: int(slider.get_attribute("value")) >= 2)


def test_a_click_on_the_curves_puts_the_clock_there(open_page):
    browser = open_page("run")
    x, y = browser.execute_script(
        "const l = element('curves')._fullLayout;return [l.xaxis._offset + l.xaxis.l2p(4), l._size.t + 0.2 * l._size.h]"
    )
    chart = browser.find_element(By.ID, "curves")
    size = chart.size
    ActionChains(browser).move_to_element_with_offset(chart, x - size["width"] / 2, y - size["height"] / 2).pause(
        0.5
    ).click().perform()
    wait(lambda: browser.find_element(By.ID, "step").get_attribute("value") == "20")


def test_heights_cameras_and_texts(open_page):
    browser = open_page("run")
    assert browser.find_element(By.TAG_NAME, "h1").text == NAME and browser.title == NAME
    assert "scale of lengths" in browser.find_element(By.ID, "surface-caption").text
    before = pixels(browser, "surface")
    browser.find_element(By.CSS_SELECTOR, "[data-eye=above]").click()
    wait(lambda: changed(before, pixels(browser, "surface")) > 0.01)
    field = browser.find_element(By.ID, "exaggeration")
    field.clear()
    field.send_keys("3", Keys.ENTER)
    wait(lambda: "3 times" in browser.find_element(By.ID, "surface-caption").text)
    assert not browser.find_element(By.TAG_NAME, "pre").is_displayed()
    browser.find_element(By.CSS_SELECTOR, "details summary").click()
    assert browser.find_element(By.TAG_NAME, "pre").text.startswith("[plate]")
    assert "times its thickness" in browser.find_element(By.CLASS_NAME, "warnings").text


def test_all_controls_have_names_and_the_page_fits_a_small_window(open_page):
    browser = open_page("run")
    for control in browser.find_elements(By.CSS_SELECTOR, "main button, main input, main select"):
        assert control.accessible_name.strip() or not control.is_displayed()
    narrow = {"width": 360, "height": 640, "deviceScaleFactor": 1, "mobile": False}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", narrow)
    try:
        wait(lambda: browser.execute_script("return element('surface').querySelector('canvas').clientWidth") < 360)
        assert browser.execute_script("return document.documentElement.scrollWidth") <= 360
    finally:
        browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_a_single_step_is_shown_and_cannot_be_played(open_page):
    browser = open_page("single")
    assert not browser.find_element(By.ID, "play").is_enabled()
    assert readout(browser)["state"] == "stuck"
    assert pixels(browser, "surface").std() > 0.05


def cell_at(browser, frequency, stroke):
    """Where a cell is, from the middle of the map."""
    x, y, width, height = browser.execute_script(
        "const l = element('map')._fullLayout, r = element('map').getBoundingClientRect();"
        "const at = (axis, value) => axis._offset + axis.l2p(value);"
        "return [at(l.xaxis, arguments[0]), at(l.yaxis, arguments[1]), r.width, r.height]",
        frequency,
        stroke,
    )
    return x - width / 2, y - height / 2


def test_a_click_on_a_cell_shows_its_path(open_page):
    browser = open_page("sweep")
    chart = browser.find_element(By.ID, "map")
    assert pixels(browser, "map").std() > 0.05
    ActionChains(browser).move_to_element_with_offset(chart, *cell_at(browser, 300, 20)).pause(0.5).click().perform()
    wait(lambda: readout(browser).get("frequency") == "300.0 Hz")
    assert readout(browser)["stroke"] == "20.00 µm"
    still, marked = pixels(browser, "path"), pixels(browser, "map")
    ActionChains(browser).move_to_element_with_offset(chart, *cell_at(browser, 600, 60)).pause(0.5).click().perform()
    wait(lambda: readout(browser).get("frequency") == "600.0 Hz")
    wait(lambda: changed(still, pixels(browser, "path")) > 5e-4)
    assert reddish(pixels(browser, "path")) > reddish(still)
    assert changed(marked, pixels(browser, "map")) > 1e-3
    assert "no path" not in browser.find_element(By.ID, "path-caption").text


def test_cells_are_chosen_by_keys_and_the_map_shows_outcomes(open_page):
    browser = open_page("few")
    first = browser.find_element(By.ID, "picker-0")
    first.send_keys(Keys.HOME)
    browser.find_element(By.ID, "picker-1").send_keys(Keys.HOME)
    wait(lambda: readout(browser).get("frequency") == "300.0 Hz" and readout(browser)["stroke"] == "20.00 µm")
    captions = {browser.find_element(By.ID, "path-caption").text}
    for _ in range(3):
        first.send_keys(Keys.ARROW_RIGHT)
        captions.add(browser.find_element(By.ID, "path-caption").text)
    assert first.get_attribute("aria-valuetext") == "600.0 Hz"
    assert any("no path of this point" in caption for caption in captions)
    before = pixels(browser, "map")
    browser.find_element(By.CSS_SELECTOR, "[data-value=outcome]").click()
    wait(lambda: changed(before, pixels(browser, "map")) > 0.05)
    assert "stuck" in browser.find_element(By.ID, "outcome-key").text
