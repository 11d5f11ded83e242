// The page of the app: what is done on it goes to the program, whose answers are drawn. One change is on its way at a
// time; of what is dragged meanwhile, the latest follows.

const delays = []; // ms from an input to its path on the screen, the latest thousand
const RUNS = { now: null, saved: null };
let link = null, asked = 0, onTheWay = null, next = null, gesture = 0, gestureOf = null, caseData = null, runData = null, searching = false, noteTimer = 0;

function connect() {
  const address = new URL("socket", location.href);
  address.protocol = "ws:";
  address.searchParams.set("tab", sessionStorage.getItem("tab") ?? "");
  link = new WebSocket(address);
  link.addEventListener("message", (event) => take(JSON.parse(event.data)));
  link.addEventListener("close", () => {
    element("lost").hidden = false;
    for (const control of document.querySelectorAll("button, input, select")) control.disabled = true;
  });
}

function ask(message) { if (link.readyState === WebSocket.OPEN) link.send(JSON.stringify(message)); }

// Change fields: { path: text }.
function change(changes, rest, stamp) {
  next = { changes: { ...next?.changes, ...changes }, rest: rest || Boolean(next?.rest), stamp: next?.stamp ?? stamp, gesture };
  if (!onTheWay) sendNext();
}

function sendNext() {
  if (!next) return;
  onTheWay = { ...next, asked: ++asked };
  next = null;
  ask({ do: "set", turn: asked, gesture: onTheWay.gesture, changes: onTheWay.changes, rest: onTheWay.rest });
}

// The answer to the change that is on its way.
function arrived(answer, draw) {
  const of = answer.turn === onTheWay?.asked ? onTheWay : null;
  requestAnimationFrame(() => {
    draw();
    if (of) setTimeout(() => { // the frame is on the screen
      delays.push(performance.now() - of.stamp);
      if (delays.length > 1000) delays.shift();
    });
  });
  if (!of) return;
  onTheWay = null;
  sendNext();
}

const TAKES = {
  tab({ tab }) { sessionStorage.setItem("tab", tab); },
  menu({ examples }) {
    element("menu").hidden = false;
    element("examples").replaceChildren(...examples.map(([name, about]) => {
      const item = document.createElement("li"), button = document.createElement("button"), title = document.createElement("strong");
      title.textContent = name;
      button.type = "button";
      button.append(title, about);
      button.addEventListener("click", () => { element("menu").hidden = Boolean(caseData); ask({ do: "open", name }); });
      item.append(button);
      return item;
    }));
    document.body.dataset.ready = "menu";
  },
  passed(answer) { arrived(answer, () => {}); },
  case(data) {
    if (!next && !onTheWay && caseData && (caseData.undo !== data.undo || caseData.redo !== data.redo)) clearMistakes();
    const first = !caseData || caseData.file !== data.file || caseData.name !== data.name;
    caseData = data;
    for (const id of ["opened", "bar"]) element(id).hidden = false;
    if (first) element("menu").hidden = true;
    if (first && drifting()) askDrift(false);
    if (first) { RUNS.saved = savedPath = nowPath = null; element("run").hidden = element("trust").hidden = true; element("undo").focus(); }
    element("name").textContent = data.name + (data.changed ? ", changed" : "");
    document.title = `${data.name}: active-surface`;
    element("device").textContent = data.device;
    element("file").textContent = data.file ?? "an example; Save writes a copy";
    element("undo").disabled = !data.undo;
    element("redo").disabled = !data.redo;
    element("back").disabled = !data.changed;
    element("aim").disabled = data.map.endless; // a platform has no actuators
    element("save-folder").textContent = data.folder;
    if (first) element("save-name").value = data.file ? data.file.split(/[\\/]/).pop() : `${data.name}.toml`;
    mapData = { ...data.map, selected: data.selected };
    showSelection(data);
    showKnobs(data.groups, Boolean(next || onTheWay));
    if (!dragged) drawMap();
  },
  path(answer) {
    if (answer.turn) clearMistakes(); // before its case comes, which keeps what is wrong
    arrived(answer, () => {
      nowPath = { ...pairs(unpack(answer.line)), heading: answer.heading, coarse: answer.coarse, exact: false };
      for (const id of ["run", "trust", "drift-layer", "drift-note"]) element(id).classList.add("old");
      mapData.face = answer.face; // whose sizes may be others
      drawPath();
      if (mapData.face) placeOver();
      tellPath(answer);
    });
  },
  later(answer) { clearMistakes(); arrived(answer, () => { element("coarse").textContent = "The path follows when the plate is solved."; }); },
  refused(answer) {
    const changed = Object.keys(onTheWay?.changes ?? {});
    element("picture").disabled = false;
    if (searching && answer.mistakes.some(({ field }) => field === "target")) endSearch();
    if (element("save-dialog").open && answer.turn === null) {
      element("save-mistake").textContent = answer.mistakes.map(({ message }) => message).join("; ");
      element("save-replace").hidden = !element("save-mistake").textContent.includes("exists");
    } else arrived(answer, () => { showMistakes(answer.mistakes, changed); if (!dragged) settleHandles(); });
  },
  async run(answer) {
    nowPath = { ...pairs(unpack(answer.line)), heading: answer.heading, coarse: [], exact: true };
    runData = answer;
    if (answer.saved) { RUNS.saved = answer.rows; savedPath = nowPath; }
    RUNS.now = answer.rows;
    element("busy").textContent = "";
    element("run").hidden = false;
    element("run").classList.remove("old");
    tellPath({ ...answer, coarse: [] });
    tellTrust(answer);
    tellRows();
    await takeRun(answer.data, pageData ? time[shown] : highest(answer.data));
    drawMap();
    document.body.dataset.ready = "run";
    if (drifting()) askDrift(true); // anew
  },
  drift({ text, warnings = [], ...shown }) {
    element("busy").textContent = "";
    element("drift-note").classList.remove("old");
    element("drift-note").textContent = [text, ...warnings].join(" ");
    drawDrift(shown);
  },
  busy({ stage, done, of }) { element("busy").textContent = of ? `${stage}: ${done} of ${of} …` : `${stage} …`; },
  idle() { element("busy").textContent = ""; },
  note({ text, good = true }) {
    element("save-dialog").close();
    element("note").hidden = false;
    element("note").classList.toggle("care", !good);
    element("note").textContent = text;
    clearTimeout(noteTimer); // of an older note
    noteTimer = setTimeout(() => { element("note").hidden = true; }, 8000);
  },
  picture({ name, bytes }) {
    const data = Uint8Array.from(atob(bytes), (letter) => letter.charCodeAt(0));
    const anchor = Object.assign(document.createElement("a"), { download: name, href: URL.createObjectURL(new Blob([data], { type: "image/png" })) });
    anchor.click();
    setTimeout(() => URL.revokeObjectURL(anchor.href), 10000);
    element("picture").disabled = false;
  },
  search({ done, of, left, line, heading, away }) {
    beginSearch();
    const time = left < 90 ? `${Math.ceil(left)} s` : `${Math.round(left / 60)} min`;
    if (of) element("busy").textContent = `Searching: ${done} of at most ${of} paths, at most about ${time} left …`;
    if (!line) return;
    nowPath = { ...pairs(unpack(line)), heading, coarse: ["search"], exact: false };
    drawPath();
    element("coarse").textContent = `Best drives so far: the part ends ${away} from the target.`;
  },
  found({ text, good }) {
    endSearch();
    target = null;
    element("coarse").textContent = "";
    drawMap();
    if (text) TAKES.note({ text, good });
  },
  trouble({ text, turn }) {
    arrived({ turn }, () => {});
    element("picture").disabled = false;
    element("trouble").hidden = false;
    element("trouble").textContent = `Sorry: ${text}`;
  },
};

// When the surface is highest.
function highest(data) {
  const moments = unpack(data.time), amplitudes = unpack(data.surface.amplitudes), rank = amplitudes.length / moments.length;
  const sizes = Array.from(moments, (_, k) => amplitudes.subarray(k * rank, (k + 1) * rank).reduce((sum, a) => sum + a * a, 0));
  return moments[sizes.indexOf(Math.max(...sizes))];
}

function take(message) { TAKES[message.kind](message); }

function tellPath({ sentence, distance, error, duration, coarse, rest }) {
  const linear = coarse.some((text) => text.startsWith("linear theory")); // may be far off
  element("quick").classList.toggle("coarse", coarse.length > 0);
  element("quick").textContent = linear && rest ? "Computing …" : `${sentence} It is ${distance}${error ? ` (estimate, ±${error})` : ""} from its start after ${duration}.`;
  const follows = rest ? "The exact path is being computed." : "The exact path follows when you let go.";
  element("coarse").textContent = coarse.length ? `Preview: ${coarse.join(", ")}. ${follows}` : "";
}

function beginSearch() {
  searching = true;
  element("aim").hidden = true;
  element("stop").hidden = false;
}

function tellTrust({ trust, warnings }) {
  const card = element("trust");
  card.hidden = false;
  card.className = `trust ${warnings.length ? "warnings" : "trusted"}`;
  element("verdict").textContent = `Trust: ${warnings.length || "no"} warning${warnings.length === 1 ? "" : "s"}.`;
  element("trust-figures").textContent = `${trust[0].toUpperCase()}${trust.slice(1)}.`;
  element("warnings").replaceChildren(...warnings.map((text) => Object.assign(document.createElement("li"), { textContent: text })));
}

function drifting() { return element("drift").getAttribute("aria-pressed") === "true"; }

function askDrift(on) {
  element("drift").setAttribute("aria-pressed", on);
  if (!on) TAKES.drift({ text: "" });
  ask({ do: "drift", on });
}

// The summary beside that of the saved case; what differs stands out.
function tellRows() {
  const beside = RUNS.saved && RUNS.saved !== RUNS.now;
  element("saved-head").hidden = !beside;
  const saved = new Map(RUNS.saved ?? []), rows = RUNS.now.map(([label, text]) => [label, text, saved.get(label) ?? ""]);
  element("rows").replaceChildren(...rows.map(([label, text, other]) => {
    const row = document.createElement("tr"), head = document.createElement("th");
    head.scope = "row";
    head.textContent = label;
    row.append(head, ...[text, ...(beside ? [other] : [])].map((words, k) => Object.assign(document.createElement("td"), {
      textContent: words, className: k === 0 && beside && text !== other ? "other" : "" })));
    return row;
  }));
}

function showSelection({ selected, map }) {
  const chosen = element("chosen"), count = map.actuators.length;
  element("chosen-label").hidden = !selected || !count;
  if (chosen.options.length !== count + 1) chosen.replaceChildren(...[...Array(count).keys(), "*"].map((k) => new Option(k === "*" ? "all" : k, k)));
  chosen.value = selected;
}

// A change of one thing is one step to undo, until the hand lets go.
function gestureFor(what) {
  if (gestureOf !== what) { gestureOf = what; gesture++; }
}

function endSearch() {
  searching = false;
  element("stop").hidden = true;
  element("aim").hidden = false;
  element("busy").textContent = "";
}

// What drives may be, as far as it is said.
function aimSettings() {
  const bounds = (key) => [0, 1].map((k) => element(`aim-${key}-${k}`).value.trim());
  const given = ["frequency", "stroke"].map((key) => [key, bounds(key)]).filter(([, ends]) => ends.some(Boolean));
  return { groups: element("aim-groups").value, ...Object.fromEntries(given) };
}

function setAiming(on) {
  aiming = on;
  element("aim-options").hidden = !on;
  element("aim").setAttribute("aria-pressed", on);
  element("map-box").classList.toggle("aiming", on);
  target = on ? target ?? [...mapData.start] : null;
  element("coarse").textContent = on ? "Click where the part is to go; Escape ends aiming." : "";
  drawMap();
  if (on) handleOf("target").focus();
}

onTurn = (knob, text, rest, stamp) => {
  gestureFor(knob.data.path);
  change({ [knob.data.path]: text }, rest, stamp);
  if (rest) gestureOf = null;
};
const placeTexts = ({ kind, number, at, moved = [true, true] }) => { // of those of x and y that have moved
  const path = kind === "start" ? "part.position" : `actuators.${number}.position`, digits = 3 - Math.floor(Math.log10(mapWidth()));
  const unit = mapData.unit.replace("µ", "u").replace("μ", "u");
  const texts = at.map((c, k) => [`${path}.${k}`, `${Number(c.toFixed(Math.max(0, Math.min(12, digits + 1))))} ${unit}`]);
  return Object.fromEntries(texts.filter((_, k) => moved[k]));
};
onDrag = (what, stamp) => {
  const texts = placeTexts(what);
  gestureFor(what.group.dataset.key);
  for (const [path, text] of Object.entries(texts)) showText(path, text, Number.parseFloat(text) / mapData.perSI);
  change(texts, false, stamp);
};
onDrop = (what) => { change(placeTexts(what), true, performance.now()); gestureOf = null; };
onPick = (number) => ask({ do: "select", actuator: String(number) });
onTarget = (place) => {
  target = place;
  aiming = false;
  element("aim").setAttribute("aria-pressed", false);
  element("map-box").classList.remove("aiming");
  element("aim-options").hidden = true;
  drawMap();
  beginSearch();
  element("busy").textContent = "Searching …";
  ask({ do: "aim", target: place.map((c) => c / mapData.perSI), settings: aimSettings() });
};
stepShown = (step) => drawHeights(step);

for (const name of ["undo", "redo", "back", "stop"]) element(name).addEventListener("click", () => ask({ do: name }));
element("menu-button").addEventListener("click", () => {
  if (element("menu").hidden) ask({ do: "menu" });
  else element("menu").hidden = true;
});
element("picture").addEventListener("click", () => { element("picture").disabled = true; ask({ do: "picture" }); });
element("drift").addEventListener("click", () => askDrift(!drifting()));
element("aim").addEventListener("click", () => setAiming(!aiming));
element("chosen").addEventListener("change", (event) => onPick(event.target.value));
element("save").addEventListener("click", () => {
  element("save-mistake").textContent = "";
  element("save-replace").hidden = true;
  element("save-dialog").showModal();
});
const saveAs = (replace) => ask({ do: "save", name: element("save-name").value.trim(), replace });
element("save-form").addEventListener("submit", (event) => { event.preventDefault(); saveAs(false); });
element("save-replace").addEventListener("click", () => saveAs(true));
element("save-cancel").addEventListener("click", () => element("save-dialog").close());
element("save-name").addEventListener("input", () => { element("save-replace").hidden = true; element("save-mistake").textContent = ""; });
for (const button of document.querySelectorAll("[data-window]")) {
  button.addEventListener("click", () => {
    around = button.dataset.window === "path";
    for (const other of document.querySelectorAll("[data-window]")) other.setAttribute("aria-pressed", other === button);
    drawMap();
  });
}
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape" && aiming) setAiming(false);
  if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z" || document.activeElement?.type === "text") return;
  event.preventDefault();
  ask({ do: event.shiftKey ? "redo" : "undo" });
});
connect();
