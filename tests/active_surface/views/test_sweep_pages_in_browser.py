"""Pages of sweeps and drifts in a real browser: Chromium clicks, presses keys, and looks at pixels and labels."""

import numpy as np
import pytest
from page_files import FACED, TURNS

from active_surface.studies import read_study, run_study
from active_surface.studies.drifts import drift
from active_surface.views.pages.drift_page import write_drift_page
from active_surface.views.pages.study_page import write_study_page
from coupling import read_case, run_case

pytest.importorskip("selenium", reason="selenium is not installed")
from page_browser import CASE, changed, chromium, opening, pixels, readout, reddish, wait  # noqa: E402
from selenium.webdriver.common.action_chains import ActionChains  # noqa: E402
from selenium.webdriver.common.by import By  # noqa: E402
from selenium.webdriver.common.keys import Keys  # noqa: E402

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore::ResourceWarning")]

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


NARROW = """\
[study]
case = "base.toml"
repeats = 3
jitter = "1 um"

[[axes]]
field = "actuators.0.frequency"
name = "frequency"
values = ["10000 Hz", "10000.5 Hz", "10001 Hz"]
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pages")
    (folder / "base.toml").write_text(CASE)
    return folder


@pytest.fixture(scope="module")
def drifts(folder):
    return drift(read_case(folder / "base.toml"), "each", 12)


@pytest.fixture(scope="module")
def pages(folder, drifts):
    (folder / "many.toml").write_text(STUDY)
    study = read_study(folder / "many.toml")
    found = run_study(study)
    return {
        "sweep": write_study_page(study, found.dataset, folder / "sweep.html"),
        "few": write_study_page(study, found.dataset, folder / "few.html", 3),
        "none": write_study_page(study, found.dataset, folder / "none.html", 0),
        "repeats": repeated(folder),
        "faced": turning(folder),
        "drift": write_drift_page(drifts, folder / "drift.html"),
    }


def turning(folder):
    """The page of a sweep over the heading of a part with a face."""
    (folder / "faced.toml").write_text(FACED)
    (folder / "turns.toml").write_text(TURNS)
    study = read_study(folder / "turns.toml")
    return write_study_page(study, run_study(study).dataset, folder / "turns.html")


def repeated(folder):
    """The page of a narrow sweep with repeats, at whose first point the first start was refused."""
    (folder / "narrow.toml").write_text(NARROW)
    study = read_study(folder / "narrow.toml")
    with run_study(study).dataset as dataset:
        found = dataset.load()
    for name in ("distance", "end_x", "end_y"):
        found[name][0, 0] = np.nan
    return write_study_page(study, found, folder / "repeats.html")


@pytest.fixture(scope="module")
def browser():
    with chromium() as driver:
        yield driver


@pytest.fixture
def open_page(browser, pages):
    with opening(browser, pages) as opened:
        yield opened


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


def test_a_path_of_a_part_with_a_face_has_its_outline_at_both_ends(open_page, pages):
    browser = open_page("faced")
    browser.find_element(By.ID, "picker-0").send_keys(Keys.HOME)
    assert readout(browser)["heading"] == "\N{MINUS SIGN}1.309 rad"
    x, y = browser.execute_async_script(
        "choose(chosen).then(() => { const { x, y } = element('path').data[1]; arguments[0]([x, y]); })"
    )
    case = read_case(pages["faced"].with_name("faced.toml")).vary({"part.heading": "-75 deg"})
    path, face = run_case(case).trajectory, case.part.face
    for first, k in ((0, 0), (11, -1)):
        outline = face.outline(path.position[k], path.heading[k]) * 1e6
        assert np.column_stack([x, y])[first : first + 6].astype(float) == pytest.approx(outline, abs=1e-3)


def test_a_page_without_paths_does_not_speak_of_any(open_page):
    browser = open_page("none")
    assert browser.find_element(By.ID, "map-caption").text == ""
    said = browser.find_element(By.CLASS_NAME, "sentence").text
    assert said.endswith(" 12 points. A click on a point shows where its path starts and ends.")


def test_values_are_told_apart_and_ends_are_shown_where_the_first_start_was_refused(open_page):
    browser = open_page("repeats")
    picker = browser.find_element(By.ID, "picker-0")
    picker.send_keys(Keys.HOME)
    wait(lambda: readout(browser)["frequency"] == "10.00000 kHz")
    names = "return element('path').data.map((trace) => trace.name).filter((name) => name)"
    wait(lambda: browser.execute_script(names) == ["actuator", "ends of 3 starts"])
    assert "The first start was refused." in browser.find_element(By.ID, "path-caption").text
    said = browser.find_element(By.CLASS_NAME, "sentence").text
    assert said.endswith("if it is one of the 2, of 3, in this page.")
    picker.send_keys(Keys.ARROW_RIGHT)
    wait(lambda: readout(browser)["frequency"] == "10.00050 kHz")
    wait(lambda: browser.execute_script(names) == ["actuator", "path", "ends of 3 starts", "start", "end"])
    assert picker.get_attribute("aria-valuetext") == "10.00050 kHz"


def test_a_click_on_a_place_shows_where_a_part_from_there_ends_and_each_group_has_its_map(open_page, drifts):
    browser = open_page("drift")
    x, y, place, end = browser.execute_script(
        "element('map').scrollIntoView(); const k = shown.moving.find((one) => one !== chosen);"
        "return [starts.x[k], starts.y[k], placeSaid(starts, k), ending(k)]"
    )
    assert readout(browser)["from rest at"] != place
    chart, text = browser.find_element(By.ID, "map"), browser.find_element(By.ID, "map-caption").text
    ActionChains(browser).move_to_element_with_offset(chart, *cell_at(browser, x, y)).pause(0.5).click().perform()
    wait(lambda: readout(browser)["from rest at"] == place)
    assert readout(browser)["in the end"] == end
    drawn = "return maps.map((one) => [one.moved, one.reached].map((at) => [at.x, at.y].map((c) => [...c])))"
    for one, (moved, reached) in zip(drifts.maps, browser.execute_script(drawn), strict=True):
        np.testing.assert_allclose(1e-6 * np.transpose(moved), one.moved, rtol=1e-6)
        np.testing.assert_allclose(1e-6 * np.transpose(reached), one.basins.reached, rtol=1e-6)
    before = pixels(browser, "map")
    browser.find_element(By.ID, "group").send_keys(Keys.ARROW_DOWN)
    wait(lambda: browser.find_element(By.ID, "map-caption").text != text)
    wait(lambda: changed(before, pixels(browser, "map")) > 1e-3)
