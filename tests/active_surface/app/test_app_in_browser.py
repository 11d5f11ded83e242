"""The app in a real browser: the screen shows what a run gives, nothing leaves the machine, nonsense is survived."""

import json
import random
import subprocess
import sys
import time

import numpy as np
import pytest
from app_case import DEVICE
from page_files import FACED

from coupling import read_case, run_case

pytest.importorskip("selenium", reason="selenium is not installed")
pytest.importorskip("tornado", reason="tornado is not installed")
from page_browser import CASE, ONLINE, chromium, errors, wait  # noqa: E402
from selenium.webdriver.common.action_chains import ActionChains  # noqa: E402
from selenium.webdriver.common.by import By  # noqa: E402
from selenium.webdriver.common.keys import Keys  # noqa: E402

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore::ResourceWarning")]

ACTIONS = 15
ACT = """
const [act, r, text] = arguments, all = [...knobs.values()], knob = all[Math.floor(r[0] * all.length)];
const said = (control, value, ...kinds) => {
  control.value = value;
  for (const kind of kinds) control.dispatchEvent(new Event(kind, { bubbles: true }));
};
if (act === "slide" && knob.slider) said(knob.slider, 1000 * r[1], "input", ...(r[2] < 0.5 ? ["change"] : []));
if (act === "text" && knob.slider) said(knob.field, text, "change");
if (act === "clock") said(slider, r[1] * slider.max, "input");
if (act === "drag") {
  const number = Math.floor(r[3] * mapData.actuators.length), [low, high] = mapData.box;
  const [kind, key] = r[0] < 0.5 ? ["start", "start"] : ["actuator", `actuator ${number}`];
  const group = document.querySelector(`[data-key="${key}"]`);
  const what = { kind, number, group, at: [0, 1].map((k) => low[k] + r[k + 1] * (high[k] - low[k])) };
  onDrag(what, performance.now());
  onDrop(what);
}
if (act === "press") {
  const some = [...document.querySelectorAll("#undo, #redo, #back, [data-window], [data-eye]")];
  some[Math.floor(r[1] * some.length)].click();
}
"""


@pytest.fixture(scope="module")
def browser():
    with chromium() as driver:
        driver.execute_cdp_cmd("Network.emulateNetworkConditions", ONLINE)
        yield driver


@pytest.fixture
def opened(browser, tmp_path, request):
    """The page of a case, and its program; afterwards only its own address was asked for, and nothing failed."""
    path = tmp_path / "mine.toml"
    path.write_text("# Mine.\n" + getattr(request, "param", CASE))
    command = [sys.executable, "-m", "active_surface", "app", str(path), "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as program:
        address = program.stdout.readline().split()[1]
        browser.get_log("performance")
        browser.get(address)
        wait(lambda: browser.execute_script("return document.body.dataset.ready") == "run")
        yield browser, path
        messages = [json.loads(entry["message"])["message"] for entry in browser.get_log("performance")]
        asked = [m["params"]["request"]["url"] for m in messages if m["method"] == "Network.requestWillBeSent"]
        assert asked and all(url.startswith((address, "data:", "blob:")) for url in asked)
        assert not errors(browser)
        assert not browser.find_element(By.ID, "trouble").is_displayed()
        browser.get("about:blank")
        program.send_signal(2)
        assert program.wait(20) == 130
        assert program.stderr.read().strip() == "interrupted"


def rows(browser):
    return dict(browser.execute_script("return RUNS.now"))


def test_the_screen_shows_what_a_run_of_the_saved_case_gives(opened):
    browser, path = opened
    field = browser.find_element(By.ID, "knob-actuators-0-frequency")
    before = rows(browser)
    field.clear()  # which is a mistake, too
    field.send_keys("12 mm", Keys.TAB)
    mistake = browser.find_element(By.ID, "knob-actuators-0-frequency-mistake")
    wait(lambda: mistake.text == "must be a frequency such as 300 Hz; got 12 mm, a length")
    assert field.get_attribute("aria-invalid") == "true"
    field.clear()
    field.send_keys("410 Hz", Keys.TAB)
    wait(lambda: rows(browser) != before)
    browser.find_element(By.ID, "save").click()
    browser.find_element(By.ID, "save-now").click()
    wait(lambda: browser.find_element(By.ID, "save-replace").is_displayed())
    browser.find_element(By.ID, "save-replace").click()
    wait(lambda: "Saved" in browser.find_element(By.ID, "note").get_attribute("textContent"))
    assert path.read_text().startswith("# Mine.\n") and '"410 Hz"' in path.read_text()
    command = [sys.executable, "-m", "active_surface", "run", str(path), "--output", str(path.parent)]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    shown = rows(browser)
    for label in ("outcome", "end", "distance", "contact"):
        assert f"{label:<12}{shown[label]}".replace("\u00b5", "u") in printed
    figures = browser.execute_script("return runData.figures")
    assert figures["distance"] == run_case(read_case(path)).summary.distance


def test_an_actuator_moves_by_the_keyboard_and_back_by_undo(opened):
    browser, _ = opened
    places = "return caseData.map.actuators[1]"
    began = browser.execute_script(places)
    handle = browser.find_element(By.CSS_SELECTOR, '[data-key="actuator 1"]')
    browser.execute_script("arguments[0].focus()", handle)
    wait(lambda: browser.execute_script("return caseData.selected") == "1")
    browser.switch_to.active_element.send_keys(Keys.ARROW_UP)
    wait(lambda: browser.execute_script(places) != began)
    assert browser.execute_script(places)[1] > began[1]
    browser.find_element(By.ID, "undo").click()
    wait(lambda: browser.execute_script(places) == began)


@pytest.mark.parametrize("opened", [DEVICE], indirect=True)
def test_what_is_drawn_while_a_slider_is_dragged_is_a_marked_estimate_of_the_whole_path(opened):
    browser, _ = opened
    said = lambda name: browser.find_element(By.ID, name).text  # noqa: E731
    ended = said("quick").split("after ")[1]
    slide = """
const { slider } = knobs.get("actuators.0.stroke");
slider.value = 600;
slider.dispatchEvent(new Event(arguments[0]));
"""
    browser.execute_script(slide, "input")
    wait(lambda: "an estimate by" in said("coarse"))
    assert said("quick").split("after ")[1] == ended and "(estimate, ±" in said("quick")
    line = browser.find_element(By.ID, "path-line")
    assert line.value_of_css_property("stroke-dasharray") != "none"
    browser.execute_script(slide, "change")
    wait(lambda: browser.execute_script("return nowPath.exact"))
    assert "estimate" not in said("quick") and line.value_of_css_property("stroke-dasharray") == "none"


def test_where_parts_go_is_drawn_and_marked_as_old_once_something_changes(opened):
    browser, _ = opened
    note, arrows, button = (browser.find_element(By.ID, name) for name in ("drift-note", "drift-arrows", "drift"))
    button.click()
    wait(lambda: note.text.startswith("Where parts go in a period"))
    first = arrows.get_attribute("d")
    assert first.count("M") >= 2
    browser.execute_script("change({ 'part.mass': '2.1 ug' }, false, performance.now())")
    wait(lambda: note.get_attribute("class") == "caption old")
    browser.execute_script("change({ 'part.mass': '1.7 ug' }, true, performance.now())")
    wait(lambda: note.get_attribute("class") == "caption" and arrows.get_attribute("d") != first)
    button.click()
    assert not arrows.get_attribute("d") and not note.text


def test_an_aim_has_bounds_and_says_how_long_it_takes_until_it_is_stopped(opened):
    browser, _ = opened
    for name, text in (("aim", None), ("aim-frequency-0", "12 mm"), ("aim-frequency-1", "500 Hz")):
        one = browser.find_element(By.ID, name)
        one.send_keys(text) if text else one.click()
    target = '[data-key="target"]'
    browser.find_element(By.CSS_SELECTOR, target).send_keys(Keys.ARROW_RIGHT, Keys.ENTER)
    wait(lambda: "12 mm" in browser.find_element(By.ID, "mistakes").text)
    browser.find_element(By.ID, "aim").click()
    browser.execute_script("element('aim-frequency-0').value = '200 Hz'; element('aim-groups').value = 'all'")
    browser.find_element(By.CSS_SELECTOR, target).send_keys(Keys.ARROW_RIGHT, Keys.ENTER)
    wait(lambda: "left" in browser.find_element(By.ID, "busy").text or browser.execute_script("return !searching"))
    browser.execute_script("ask({ do: 'stop' })")
    wait(lambda: browser.execute_script("return !searching"))
    assert browser.find_element(By.ID, "note").get_attribute("textContent")


MAPPED = """
const [x, y] = mapAxes().map((axis) => axis.range), [{ z }] = element("map").data, heights = heightsAt(shown);
const nodes = nodesIn(x, y, mapData.perSI / perMetre(units.length));
return z.flat().every((height, k) => height === (nodes.on[k] ? valueAt(nodes, k, heights) : null));
"""


def test_on_another_mesh_the_map_has_the_heights_of_that(opened):
    browser, _ = opened
    assert browser.execute_script(MAPPED)
    browser.execute_script(
        "delete document.body.dataset.ready; change({ 'actuators.1.position.1': '40 um' }, true, performance.now())"
    )
    wait(lambda: browser.execute_script("return document.body.dataset.ready") == "run")
    assert browser.execute_script(MAPPED)


SHOWN = """
const [axis] = arguments, [x, y] = mapAxes(), { style } = handleOf("start");
const at = [x.p2l(Number.parseFloat(style.left)), y.p2l(Number.parseFloat(style.top))];
const { field, slider, data } = knobs.get(`part.position.${axis}`);
return [at[axis], Number.parseFloat(field.value), data.low + (data.high - data.low) * slider.value / NOTCHES];
"""


def test_fields_sliders_and_the_start_on_the_map_follow_each_other(opened):
    browser, path = opened

    def shown(axis):
        values = browser.execute_script(SHOWN, axis)
        assert values == pytest.approx([values[0]] * 3, abs=0.5)  # um, a notch of the sliders
        return values[0]

    began = shown(0), shown(1)
    handle = browser.find_element(By.CSS_SELECTOR, '[data-key="start"]')
    drag = ActionChains(browser).click_and_hold(handle).move_by_offset(-40, 0).move_by_offset(-20, 0)
    drag.perform()
    assert shown(0) < began[0] - 20 and shown(1) == began[1]
    ActionChains(browser).release().perform()
    wait(lambda: browser.execute_script("return caseData.changed && !onTheWay && !dragged"))
    dragged = shown(0)
    assert dragged < began[0] - 20
    slide = (
        "const { slider } = knobs.get('part.position.1'); slider.value = 600; slider.dispatchEvent(new Event('input'))"
    )
    browser.execute_script(slide)
    assert shown(1) > began[1] + 20 and shown(0) == dragged
    browser.execute_script("knobs.get('part.position.1').slider.dispatchEvent(new Event('change'))")
    field = browser.find_element(By.ID, "knob-part-position-1")
    field.send_keys(Keys.CONTROL, "a")
    field.send_keys("-31 um", Keys.ENTER)
    wait(lambda: browser.execute_script("return caseData.map.start[1]") == pytest.approx(-31))
    assert shown(1) == pytest.approx(-31, abs=0.05) and shown(0) == dragged


OUTLINE = """
const numbers = element(`${arguments[0]}-face`).getAttribute("d").match(/-?[\\d.]+(e-?\\d+)?/g).map(Number);
return [numbers.filter((_, k) => k % 2 === 0), numbers.filter((_, k) => k % 2).map((y) => -y)];
"""


@pytest.mark.parametrize("opened", [FACED], indirect=True)
def test_a_slider_turns_the_outline_at_the_start_and_the_others_follow(opened):
    browser, path = opened
    part = read_case(path).part

    def shown(which):
        return np.transpose(browser.execute_script(OUTLINE, which))[:6] * 1e-6

    assert shown("start") == pytest.approx(part.face.outline(part.position, part.heading), abs=1e-10)
    turn = "const { slider } = knobs.get('part.heading'); slider.value = 250; slider.dispatchEvent(new Event('input'));"
    browser.execute_script("delete document.body.dataset.ready;" + turn)
    turned = part.face.outline(part.position, -np.pi / 2)
    assert shown("start") == pytest.approx(turned, abs=1e-10)
    browser.execute_script("knobs.get('part.heading').slider.dispatchEvent(new Event('change')); show(last)")
    wait(lambda: browser.execute_script("return document.body.dataset.ready") == "run")
    assert shown("start") == pytest.approx(turned, abs=1e-10)
    end = run_case(read_case(path).vary({"part.heading": "-90 deg"})).trajectory
    outline = part.face.outline(end.position[-1], end.heading[-1])
    wait(lambda: shown("end") == pytest.approx(outline, abs=1e-10))  # after the path of the slider on its way
    browser.execute_script("show(last)")
    assert shown("here") == pytest.approx(outline, abs=1e-10)


def test_on_a_phone_the_map_takes_a_third_at_most(opened):
    browser, _ = opened
    metrics = {"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": True}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    try:
        wait(lambda: browser.execute_script("return innerWidth") == 390)
        box = "const box = (id) => element(id).getBoundingClientRect();"
        shades, plate = browser.execute_script(
            f"{box} return ['shades', 'map-box'].map((id) => [box(id).top, box(id).bottom])"
        )
        assert "\u00b5m" in browser.find_element(By.CSS_SELECTOR, "#map .xtitle").text
        assert shades[1] <= plate[0]
        place = "document.querySelector('#knob-part-mass').scrollIntoView({ block: 'end' });"
        plate, third = browser.execute_script(f"{box} {place} return [box('map-box').bottom, innerHeight / 3]")
        assert 0 < plate <= third
        above = (
            "return document.elementsFromPoint(195, innerHeight / 3 + 2).some((one) => one.closest('#map-box, .tools'))"
        )
        assert not browser.execute_script(above)
        place = "element('curves').scrollIntoView({ block: 'start' });"
        assert browser.execute_script(f"{box} {place} return box('map-box').bottom") <= 0
        assert browser.execute_script("return document.documentElement.scrollWidth") == 390
    finally:
        browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_random_actions_end_in_a_page_that_works(opened):
    browser, _ = opened
    chance = random.Random(5)
    for _ in range(ACTIONS):
        act = chance.choice(["slide", "slide", "slide", "text", "drag", "press", "clock"])
        text = chance.choice(["12 um", "-3 ms", "nonsense", "1e300 Hz", "5", "<b>x</b>", "", "400 Hz", "2 ug"])
        browser.execute_script(ACT, act, [chance.random() for _ in range(4)], text)
        time.sleep(chance.choice([0, 0.02, 0.1]))
    wait(lambda: browser.execute_script("return !onTheWay && !next"))
    browser.execute_script("ask({ do: 'back' })")
    wait(lambda: browser.execute_script("return !caseData.changed && !document.querySelector('#run.old')"))
    assert "outcome" in rows(browser)
