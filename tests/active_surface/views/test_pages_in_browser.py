"""Pages of runs in a real browser: Chromium moves the slider, plays, clicks, and looks at pixels and labels."""

import time

import numpy as np
import pytest
from page_files import FACED

from active_surface.views.pages.run_page import write_run_page
from coupling import read_case, run_case
from coupling.results.saved import read_run

pytest.importorskip("selenium", reason="selenium is not installed")
from page_browser import CASE, changed, chromium, drawn, errors, opening, pixels, readout, reddish, wait  # noqa: E402
from selenium.webdriver.common.action_chains import ActionChains  # noqa: E402
from selenium.webdriver.common.by import By  # noqa: E402
from selenium.webdriver.common.keys import Keys  # noqa: E402

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore::ResourceWarning")]

NAME = "two <script>alert(1)</script>"


@pytest.fixture(scope="module")
def faced(tmp_path_factory):
    path = tmp_path_factory.mktemp("faced") / "faced.toml"
    path.write_text(FACED)
    return run_case(read_case(path), path.parent, picture=False)


@pytest.fixture(scope="module")
def pages(tmp_path_factory, faced):
    folder = tmp_path_factory.mktemp("pages")
    (folder / "base.toml").write_text(CASE)
    run_case(read_case(folder / "base.toml"), folder)
    run = read_run(folder / "base")
    object.__setattr__(run, "name", NAME)
    single = read_run(folder / "base")
    for name in ("time", "position", "velocity", "state", "normal_force", "friction_force"):
        object.__setattr__(single, name, getattr(single, name)[:1])
    runs = {"run": run, "single": single, "faced": read_run(faced.files[0])}
    return {name: write_run_page(one, folder / f"{name}.html") for name, one in runs.items()}


@pytest.fixture(scope="module")
def browser():
    with chromium() as driver:
        yield driver


@pytest.fixture
def open_page(browser, pages):
    with opening(browser, pages) as opened:
        yield opened


def test_the_slider_moves_surface_part_trail_and_labels(open_page):
    browser = open_page("run")
    slider, clock = browser.find_element(By.ID, "step"), browser.find_element(By.ID, "clock")
    surface, curves, told = pixels(browser, "surface"), pixels(browser, "curves"), readout(browser)
    assert surface.std() > 0.05  # something is drawn
    assert clock.text == "0.00 of 8.000 ms" and told["state"] == "stuck"
    slider.send_keys(Keys.END)
    drawn(browser)
    assert slider.get_attribute("value") == slider.get_attribute("max") and clock.text == "8.00 of 8.000 ms"
    assert changed(surface, pixels(browser, "surface")) > 0.003
    assert reddish(pixels(browser, "surface")) > reddish(surface) + 5e-4  # the trail
    assert changed(curves, pixels(browser, "curves")) > 0.001  # the cursor
    assert readout(browser)["position x, y"] != told["position x, y"]
    assert told["last event"] == "none yet" and " at " in readout(browser)["last event"]
    browser.execute_script("show(stepAt(2.6))")
    drawn(browser)
    assert clock.text == "2.60 of 8.000 ms"
    assert slider.get_attribute("aria-valuetext").startswith("2.60 ms, ")
    lifted = pixels(browser, "surface")
    assert changed(surface, lifted) > 0.01  # the plate
    assert browser.execute_script("return document.getElementById('curves').layout.shapes[0].x0") == pytest.approx(2.6)


def test_the_outline_of_a_face_is_to_scale_and_turned_at_the_last_step(open_page, faced):
    browser = open_page("faced")
    browser.find_element(By.ID, "step").send_keys(Keys.END)
    drawn(browser)
    x, y, z = browser.execute_script("const { x, y, z } = element('surface').data[PART + 1]; return [x, y, z]")
    path = faced.trajectory
    outline = faced.case.part.face.outline(path.position[-1], path.heading[-1]) * 1e6
    assert np.column_stack([x[:6], y[:6]]) == pytest.approx(outline, abs=1e-4)
    assert (x[0], y[0]) == (x[6], y[6]) and len(set(z[:6])) == 1
    hand = np.arctan2(y[9] - y[8], x[9] - x[8])
    assert hand == pytest.approx(path.heading[-1], abs=1e-6) and abs(hand - np.radians(30)) > 0.1
    assert readout(browser)["heading"] == f"{np.degrees(path.heading[-1]):.1f} degrees"
    browser.execute_script("show(0)")
    drawn(browser)
    assert readout(browser)["heading"] == "30.0 degrees"
    for name, words in (("surface", "legend"), ("curves", "annotation")):  # below the buttons
        chart = browser.find_element(By.ID, name)
        bar, first = (chart.find_element(By.CLASS_NAME, one).rect for one in ("modebar-group", words))
        assert first["y"] >= bar["y"] + bar["height"]


def test_it_plays_to_the_end_and_pauses(open_page):
    browser = open_page("run")
    button, slider = browser.find_element(By.ID, "play"), browser.find_element(By.ID, "step")
    browser.execute_script("document.getElementById('pace').value = '60'")
    button.click()
    wait(lambda: "Pause" in button.text)  # a busy page takes a click later
    wait(lambda: int(slider.get_attribute("value")) >= 2)
    button.click()
    wait(lambda: "Play" in button.text)
    drawn(browser)
    held = slider.get_attribute("value")
    time.sleep(2.0)
    assert slider.get_attribute("value") == held
    browser.execute_script("document.getElementById('pace').value = '5'")
    button.click()
    wait(lambda: slider.get_attribute("value") == slider.get_attribute("max") and "Play" in button.text)


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
    chart, size = browser.find_element(By.ID, "curves"), browser.find_element(By.ID, "curves").size
    x, y = browser.execute_script(  # offsets of a click are from the middle of what is visible: make it all
        "const l = element('curves')._fullLayout; element('curves').scrollIntoView();"
        "return [l.xaxis._offset + l.xaxis.l2p(4), l._size.t + 0.2 * l._size.h]"
    )
    place = x - size["width"] / 2, y - size["height"] / 2
    ActionChains(browser).move_to_element_with_offset(chart, *place).pause(0.5).click().perform()
    wait(lambda: browser.find_element(By.ID, "clock").text.startswith("4.0"))


def test_a_click_on_an_event_shows_its_own_time_and_labels_have_few_digits(open_page):
    browser = open_page("run")
    first = browser.find_element(By.CSS_SELECTOR, "#events tr")
    text = first.find_element(By.TAG_NAME, "td").text
    first.click()
    drawn(browser)
    clock = browser.find_element(By.ID, "clock").text
    assert clock.split(" ")[0] in text and text.startswith("slips at ") and "adds most to the pull" in first.text
    told = readout(browser)
    assert told["state"] == "slipping" and told["last event"].startswith(text)
    assert told["speed in the plane"].split(" ")[0] == "0"
    labels = browser.execute_script(
        "const y = element('curves').data.findIndex((trace) => trace.name === 'along y');"
        "element('curves').data[y].y[3] = 7.088e-7;"
        "Plotly.Fx.hover('curves', [{ curveNumber: y, pointNumber: 3 }], 'xy3');"
        "return element('curves').querySelector('.hoverlayer').textContent"
    )
    assert "along y 0 mm/s" in labels
    names = browser.execute_script("return element('curves').layout.annotations.map((one) => one.text).join()")
    assert "◆ first slip" in names and "◆ nearest to coming off" in names


def test_heights_cameras_and_texts(open_page):
    browser = open_page("run")
    assert browser.find_element(By.CLASS_NAME, "name").text == NAME and browser.title.startswith(NAME)
    assert browser.find_element(By.TAG_NAME, "h1").text.startswith("A clamped disc 600 µm across")
    assert "scale of lengths" in browser.find_element(By.ID, "surface-caption").text
    before = pixels(browser, "surface")
    browser.find_element(By.CSS_SELECTOR, "[data-eye=above]").click()
    wait(lambda: changed(before, pixels(browser, "surface")) > 0.01)
    field = browser.find_element(By.ID, "exaggeration")
    field.send_keys(Keys.CONTROL, "a", Keys.NULL, "3", Keys.ENTER)
    wait(lambda: "3 times as large as lengths" in browser.find_element(By.ID, "surface-caption").text)
    for refused in ("-3", "0", Keys.BACKSPACE):
        field.send_keys(Keys.CONTROL, "a", Keys.NULL, refused, Keys.TAB)
        assert field.get_attribute("value") == "3"
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


def test_a_drawing_that_fails_while_it_plays_is_told_and_ends_the_play(open_page):
    browser = open_page("run")
    browser.execute_script(  # as a program of the page: of others' rejections Chromium tells it nothing
        "const program = document.createElement('script');"
        "program.textContent = `Plotly.restyle = async () => { throw new Error('no ink'); }`;"
        "document.head.append(program)"
    )
    browser.find_element(By.ID, "play").click()
    trouble = browser.find_element(By.ID, "trouble")
    wait(trouble.is_displayed)
    assert trouble.text == "A drawing of this page failed: no ink"
    assert "Play" in browser.find_element(By.ID, "play").text
    assert any("no ink" in error for error in errors(browser))
    browser.refresh()


def eye(browser):
    """From where the surface is seen."""
    return browser.execute_script(
        "const { eye } = element('surface')._fullLayout.scene._scene.getCamera(); return [eye.x, eye.y, eye.z]"
    )


def test_the_surface_is_turned_by_the_mouse_while_it_plays(open_page):
    browser = open_page("run")
    shown = lambda: int(browser.find_element(By.ID, "step").get_attribute("value"))  # noqa: E731
    browser.execute_script("document.getElementById('pace').value = '60'")
    slanted = eye(browser)
    browser.find_element(By.ID, "play").click()
    canvas = browser.find_element(By.CSS_SELECTOR, "#surface canvas")
    dragging = ActionChains(browser, duration=100).move_to_element(canvas).click_and_hold()
    for _ in range(5):
        dragging.move_by_offset(15, 0).pause(0.1)
    dragging.perform()
    for held in (True, False):
        before = shown()
        wait(lambda since=before: shown() >= since + 2)
        assert eye(browser) != pytest.approx(slanted, abs=0.1)
        if held:
            ActionChains(browser).release().perform()
    wait(lambda: not browser.find_elements(By.CSS_SELECTOR, "[data-eye][aria-pressed=true]"))
    browser.find_element(By.CSS_SELECTOR, "[data-eye=above]").click()
    before = shown()
    wait(lambda: shown() >= before + 2)
    assert eye(browser) == pytest.approx([0, 0, 1.5], abs=1e-3)
    assert "Pause" in browser.find_element(By.ID, "play").text
