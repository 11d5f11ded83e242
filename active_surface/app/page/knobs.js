// The fields of the case: a slider and a text each, or a choice.

const NOTCHES = 1000; // of a slider
let knobs = new Map(); // by path
let onTurn = () => {};

// Show groups of fields; what is there already is only brought up to date, so that focus and sliders stay.
function showKnobs(groups, busy) {
  const wanted = groups.flatMap((group) => group.knobs);
  const same = wanted.length === knobs.size && wanted.every((knob) => knobs.get(knob.path)?.data.scale === knob.scale);
  if (same && busy) return; // the hand knows better
  if (!same) {
    knobs = new Map();
    element("knobs").replaceChildren(...groups.map(({ title, knobs: some }) => {
      const group = document.createElement("section"), head = document.createElement("h3");
      head.textContent = title;
      group.append(head, ...some.map(addKnob));
      return group;
    }));
  }
  for (const data of wanted) refresh(knobs.get(data.path), data, !same);
}

function addKnob(data) {
  const row = document.createElement("div"), label = document.createElement("label"), mistake = document.createElement("p");
  const id = `knob-${data.path.replaceAll(/[.*]/g, "-")}`;
  row.className = "knob";
  label.textContent = data.label;
  label.htmlFor = id;
  label.title = data.help;
  mistake.className = "mistake";
  mistake.id = `${id}-mistake`;
  const knob = { data, mistake };
  if (data.scale === "choice") {
    knob.field = document.createElement("select");
    for (const choice of data.choices) knob.field.append(new Option(choice, choice));
    row.append(label, knob.field, mistake);
    knob.field.addEventListener("change", (event) => onTurn(knob, knob.field.value, true, event.timeStamp));
  } else {
    knob.field = Object.assign(document.createElement("input"), { type: "text", autocomplete: "off", spellcheck: false });
    knob.slider = Object.assign(document.createElement("input"), { type: "range", min: 0, max: NOTCHES, step: 1 });
    knob.slider.setAttribute("aria-label", data.label);
    row.append(label, knob.slider, knob.field, mistake);
    knob.slider.addEventListener("input", (event) => {
      knob.field.value = textAt(knob, Number(knob.slider.value) / NOTCHES);
      knob.slider.setAttribute("aria-valuetext", knob.field.value);
      placeHandle(knob.data, knob.field.value);
      onTurn(knob, knob.field.value, false, event.timeStamp);
    });
    knob.slider.addEventListener("change", (event) => onTurn(knob, knob.field.value, true, event.timeStamp));
    knob.field.addEventListener("change", (event) => onTurn(knob, knob.field.value, true, event.timeStamp));
  }
  knob.field.id = id;
  knob.field.setAttribute("aria-describedby", mistake.id);
  knobs.set(data.path, knob);
  return row;
}

// A slider keeps its ends while its value is well within them.
function refresh(knob, data, anew) {
  if (knob.field.getAttribute("aria-invalid") === "true" && !anew) return; // what is wrong stays to be mended
  const { low, high } = knob.data, inside = data.value > low + 0.02 * (high - low) && data.value < high - 0.02 * (high - low);
  const kept = !anew && inside && knob.data.unit === data.unit ? { low, high } : {};
  knob.data = { ...data, ...kept };
  if (anew || knob.field !== document.activeElement) knob.field.value = data.text;
  if (!knob.slider) return;
  knob.field.placeholder = data.value === null ? "mixed" : "";
  knob.slider.title = `${textAt(knob, 0)} to ${textAt(knob, 1)}; the field also takes values beyond these`;
  setSlider(knob, data.value, data.text || "mixed");
}

function shareAt({ low, high, scale }, value) {
  if (value === null) return 0.5;
  const share = scale === "log" ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  return Math.min(1, Math.max(0, share));
}

function textAt({ data: { low, high, scale, unit, whole } }, share) {
  const value = scale === "log" ? low * (high / low) ** share : low + share * (high - low);
  const number = whole ? Math.round(value) : Number(rounded(value, scale === "log" ? Math.abs(value) : Math.max(Math.abs(low), Math.abs(high))));
  return `${number} ${unit}`.trim();
}

// To four digits of the size that counts.
function rounded(value, size) { return size > 0 ? value.toFixed(Math.max(0, Math.min(15, 3 - Math.floor(Math.log10(size))))) : "0"; }

// Have a field and its slider show a length [m] that was set elsewhere.
function showText(path, text, length) {
  const knob = knobs.get(path);
  if (!knob) return;
  knob.field.value = text;
  setSlider(knob, length * perMetre(knob.data.unit), text);
}

function setSlider({ slider, data }, value, text) {
  slider.value = NOTCHES * shareAt(data, value);
  slider.setAttribute("aria-valuetext", text);
}

function clearMistakes() {
  for (const { field, mistake } of knobs.values()) {
    field.removeAttribute("aria-invalid");
    mistake.textContent = "";
  }
  element("mistakes").hidden = true;
}

// Mistakes at the fields that have them; those of none, above all.
function showMistakes(mistakes, changed) {
  clearMistakes();
  const others = [];
  for (const { field: named, message } of mistakes) {
    const field = named.replaceAll(/\[(\d+)\]/g, ".$1"), knob = knobOf(field, changed);
    if (!knob) { others.push(`${named} ${message}`.trim()); continue; }
    knob.field.setAttribute("aria-invalid", "true");
    knob.mistake.textContent = [knob.mistake.textContent, message].filter(Boolean).join("; ");
  }
  element("mistakes").hidden = !others.length;
  element("mistakes").textContent = others.join("\n");
}

function knobOf(field, changed) {
  const under = (path) => path === field || path.startsWith(`${field}.`) || field.startsWith(`${path}.`);
  return knobs.get(field) ?? changed.map((path) => knobs.get(path)).find((knob) => knob && (under(knob.data.path) || knob.data.path.replace("*", "0") === field))
    ?? [...knobs.values()].find((knob) => field && under(knob.data.path));
}
