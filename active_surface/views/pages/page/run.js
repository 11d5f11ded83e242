// The page of a run: a slider over its steps, with the surface and the curves of surface.js and curves.js.

const STATES = ["stuck", "slipping", "in flight"];
const slider = element("step");
let load, friction;
let stepShown = () => {}; // what else follows the clock
let playing = false, turn = 0, looking = false, drawing = null, wanted = null;

function readOut(step) {
  const here = pageData.events.find((event) => event.time === time[step]); // with its own digits
  const clock = here ? here.when : time[step].toFixed(decimals());
  const state = step === last && pageData.lost ? pageData.lost : STATES[part.state[step]];
  element("clock").textContent = `${clock} of ${said(time[last])} ${units.time}`;
  slider.setAttribute("aria-valuetext", `${clock} ${units.time}, ${state}`);
  const places = largest(part.x, part.y);
  const latest = pageData.events.filter((event) => event.time <= time[step]).pop();
  const listed = latest !== pageData.events.at(-1) || latest === here || !pageData.moreEvents; // no later one is left out
  describe(element("readout"), [
    ["state", state],
    ...(pageData.events.length && listed ? [["last event", latest ? [latest.text, latest.by].filter(Boolean).join("; ") : "none yet"]] : []),
    [`position x, y${pageData.counted}`, `${beside(part.x[step], places)}, ${beside(part.y[step], places)} ${units.length}`],
    ...(part.face ? [["heading", `${beside(degrees(part.heading[step]), degrees(largest(part.heading)))} degrees`]] : []),
    ["height", `${beside(part.height[step], largest(part.height))} ${units.height}`],
    [pageData.counted ? "speed over the platform" : "speed in the plane", `${beside(part.speed[step], largest(part.speed))} ${units.speed}`],
    ["normal load", `${beside(load[step], largest(load))} ${pageData.load.unit}`],
    ["friction", `${beside(friction[step], largest(friction))} ${pageData.friction.unit}`],
  ]);
}

function degrees(radians) { return radians * 180 / Math.PI; }

// As many decimals as tell one step from the next.
function decimals() {
  const apart = last ? (time[last] - time[0]) / last : 1;
  return Math.max(0, Math.min(6, 1 - Math.floor(Math.log10(apart || 1))));
}

// Show a step: at once if nothing is being drawn, else when that is done, and then only the latest.
function show(step) {
  shown = step;
  slider.value = step;
  readOut(step);
  stepShown(step);
  wanted = step;
  drawing ??= draw().finally(() => { drawing = null; });
  return drawing;
}

async function draw() {
  while (wanted !== null) {
    const step = wanted, now = changingAt(step);
    wanted = null;
    keepCamera();
    await Promise.all([
      Plotly.restyle("surface", { x: now.x, y: now.y, z: now.z, intensity: now.intensity }, [...now.z.keys()]),
      Plotly.relayout("curves", { "shapes[0].x0": time[step], "shapes[0].x1": time[step] }),
    ]);
  }
}

// Plotly redraws with the camera of the layout, which it updates only when the mouse lets go.
function keepCamera() {
  const plot = element("surface"), scene = plot._fullLayout?.scene, now = scene?._scene?.getCamera?.(); // none without WebGL
  if (!now || looking) return;
  plot.layout.scene.camera = scene.camera = now;
  const pressed = document.querySelector("[data-eye][aria-pressed=true]");
  if (pressed && turned(now.eye, camera(pressed.dataset.eye).eye)) press(null); // its redrawing may hide that the mouse let go
}

function turned(eye, from) {
  return Math.hypot(eye.x - from.x, eye.y - from.y, eye.z - from.z) > 0.01;
}

function play() {
  playing = !playing;
  element("play-sign").textContent = playing ? "❚❚" : "▶";
  element("play-word").textContent = playing ? "Pause" : "Play";
  if (!playing) return;
  const from = time[shown < last ? shown : 0], mine = ++turn;
  let began = null; // by the clock of frames, which may lie before the click
  const next = async (now) => {
    if (!playing || mine !== turn) return; // paused, or played anew meanwhile
    began ??= now;
    const seconds = Number(element("pace").value);
    const step = stepBefore(from + (now - began) / 1000 / seconds * (time[last] - time[0]));
    try {
      if (step !== shown || now === began) await show(step);
    } catch (error) {
      if (playing && mine === turn) play(); // the end of it
      throw error;
    }
    if (step >= last) { if (playing && mine === turn) play(); } else requestAnimationFrame(next);
  };
  requestAnimationFrame(next);
}

function caption() {
  const [low, high] = surface.range;
  const factor = high === low ? (last ? "The surface stays flat." : "The surface is flat at this step.") : exaggeration === 1 ? "Heights are drawn to the scale of lengths." : `Heights are drawn ${Number(exaggeration.toPrecision(4))} times as large as lengths.`;
  const lines = [factor];
  if (!surface.whole && !closeBy) lines.push("Of the surface, only that around the path is shown, with fewer points where that is large.");
  if (surface.unmarked) lines.push(`${surface.unmarked} actuators, too many to be marked.`);
  const { shown: kept, stored, events } = pageData.steps;
  if (kept < stored) lines.push(`The clock stops at ${kept} of the ${stored} moments that the run has stored, evenly spread${events ? ", and at the events" : ""}; the curves have all.`);
  element("surface-caption").textContent = lines.join(" ");
}

function press(name) {
  for (const button of document.querySelectorAll("[data-eye]")) button.setAttribute("aria-pressed", button.dataset.eye === name);
}

async function look(name) {
  press(name);
  looking = true;
  await Plotly.relayout("surface", { "scene.camera": camera(name), ...heightAxis(name === "side") });
  looking = false;
}

function exaggerate() {
  const field = element("exaggeration"), factor = Number(field.value);
  if (!(factor > 0)) { field.value = exaggeration; return; }
  exaggeration = factor;
  caption();
  reframe();
}

function reframe() {
  const [low, high] = frame();
  return Plotly.relayout("surface", {
    "scene.aspectratio": proportions(), "scene.zaxis.range": heightRange(),
    "scene.xaxis.range": [low[0], high[0]], "scene.yaxis.range": [low[1], high[1]],
  }).then(() => show(shown));
}

// Show the surroundings of a short path, or all of the surface.
function come(close) {
  closeBy = close;
  element("close-by").setAttribute("aria-pressed", close);
  element("exaggeration").value = pageData.exaggeration[close ? 1 : 0];
  exaggerate();
}

// The step nearest to a time.
function stepAt(moment) {
  let best = 0;
  for (let k = 1; k <= last; k++) if (Math.abs(time[k] - moment) < Math.abs(time[best] - moment)) best = k;
  return best;
}

// The last step up to a time.
function stepBefore(moment) {
  let step = 0;
  while (step < last && time[step + 1] <= moment) step++;
  return step;
}

// The events as rows; a click on one sets the clock.
function listEvents() {
  element("events-card").hidden = !pageData.events.length;
  element("events").replaceChildren(...pageData.events.map((event) => {
    const row = document.createElement("tr");
    for (const text of [event.text, event.place, event.by]) {
      const cell = document.createElement("td");
      cell.textContent = text;
      row.append(cell);
    }
    row.addEventListener("click", () => { if (playing) play(); show(stepAt(event.time)); });
    return row;
  }));
  if (pageData.moreEvents) element("events-caption").textContent = `${pageData.moreEvents} later events are not listed.`;
}

// Show a run, or another in place of it, from its first step or the one nearest to a time.
async function takeRun(data, moment = 0) {
  if (playing) play();
  await drawing; // of the run before
  pageData = data;
  takeSurface();
  takeCurves();
  [load, friction] = [unpack(pageData.load.values), unpack(pageData.friction.values)];
  closeBy = closeBy && Boolean(pageData.window);
  exaggeration = pageData.exaggeration[closeBy ? 1 : 0];
  slider.max = last;
  listEvents();
  element("exaggeration").value = exaggeration;
  element("play").disabled = last === 0;
  element("flights").hidden = !unpack(pageData.stretches.flying).length;
  element("close-by").hidden = !pageData.window;
  element("close-by").setAttribute("aria-pressed", closeBy);
  shown = stepAt(moment);
  slider.value = shown;
  readOut(shown);
  caption();
  keepCamera();
  const first = !element("surface").data;
  const [scene, charts] = await Promise.all([drawSurface(), drawCurves()]);
  if (first) {
    scene.on("plotly_relayout", (change) => { if ("scene.camera" in change && !looking) press(null); });
    charts.on("plotly_click", (event) => {
      if (playing) play();
      show(stepAt(event.points[0].x));
    });
  }
  if (shown) await show(shown);
  stepShown(shown);
}

element("pace").addEventListener("change", () => { if (playing) { play(); play(); } });
slider.addEventListener("input", () => { if (playing) play(); show(Number(slider.value)); });
element("play").addEventListener("click", play);
element("close-by").addEventListener("click", () => come(!closeBy));
element("exaggeration").addEventListener("change", exaggerate);
for (const button of document.querySelectorAll("[data-eye]")) button.addEventListener("click", () => look(button.dataset.eye));
if (pageData) {
  const asked = location.hash.match(/^#t=([0-9.e-]+)$/); // page.html#t=12.5 opens at that time
  takeRun(pageData, asked ? Number(asked[1]) : 0).then(() => {
    document.body.dataset.ready = "true";
  }).catch((error) => tellTrouble(error.message));
}
