"use strict";
// What the pages of runs and of sweeps have in common.

let pageData = JSON.parse(document.getElementById("data").textContent); // null: it comes later
const ARRAYS = { f4: Float32Array, f8: Float64Array, u1: Uint8Array, u2: Uint16Array, i2: Int16Array, u4: Uint32Array };
// The colours of page.css, which has others for the dark.
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
const INK = colour("ink"), SOFT = colour("soft"), PATH = colour("path"), CARD = colour("card"), GRID = colour("grid");
const FONT = { family: 'system-ui, "Segoe UI", Roboto, sans-serif', size: 13, color: INK };
// Plotly keeps the colours that it was given.
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => location.reload());
const NARROW = window.innerWidth < 700;
const CONFIG = { responsive: true, displaylogo: false, displayModeBar: !NARROW, modeBarButtonsToRemove: ["select2d", "lasso2d", "resetCameraLastSave3d"] };

window.addEventListener("error", (event) => tellTrouble(event.message));
window.addEventListener("unhandledrejection", (event) => tellTrouble(event.reason?.message ?? event.reason));

function element(id) { return document.getElementById(id); }

function tellTrouble(text) {
  element("trouble").hidden = false;
  element("trouble").textContent = `A drawing of this page failed: ${text}`;
}

// An array that active_surface/views/pages/packed.py has packed.
function unpack(array) {
  const text = atob(array.bytes);
  const bytes = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  return new ARRAYS[array.kind](bytes.buffer);
}

// The rows that packed_rows has packed, as arrays of numbers.
function unpackRows(packed) {
  const all = unpack(packed.rows), count = packed.scales.length, length = all.length / count;
  return packed.scales.map((scale, row) => Float32Array.from(all.subarray(row * length, (row + 1) * length), (n) => n * scale));
}

// A number for people, with about four digits, and as many as tell it from others that are a step away.
function said(number, step = 0) {
  if (number === 0 || !Number.isFinite(number)) return String(number || 0);
  const size = Math.abs(number), order = Math.floor(Math.log10(size)), least = step > 0 ? 1 - Math.floor(Math.log10(step)) : 0;
  if (size >= 1e5 || size < 1e-3) return number.toExponential(Math.min(15, Math.max(2, order + least))).replaceAll("-", "−").replace("e", " × 10^").replace("+", "");
  return number.toFixed(Math.min(15, Math.max(0, least, Math.min(4, 3 - order)))).replace("-", "−");
}

// As many decimals as the largest number of a kind needs for four digits.
function decimalsOf(largest) {
  return largest > 0 ? Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(largest)))) : 0;
}

// A number for people, with as many decimals as others up to the largest have.
function beside(number, largest) {
  const text = number.toFixed(decimalsOf(largest));
  return Number(text) === 0 ? "0" : text.replace("-", "−");
}

// The same for Plotly, without zeros at the end: what is nothing beside the largest is 0.
function besideFormat(largest) { return `.${decimalsOf(largest)}~f`; }

function largest(...arrays) {
  return Math.max(...arrays.map((array) => array.reduce((size, value) => Math.max(size, Math.abs(value) || 0), 0)));
}

// A face with these corners at a place, turned by a heading [rad]: its outline, and a hand from its middle along its x.
function faceAt(corners, [x, y], heading) {
  const [c, s] = [Math.cos(heading), Math.sin(heading)], tip = [Math.max(...corners.map(([along]) => along)), 0];
  return [[...corners, corners[0]], [[0, 0], tip]].map((line) => line.map(([a, b]) => [x + c * a - s * b, y + s * a + c * b]));
}

// Plotly reads markup in labels; a text of the user's has none.
function plain(text) {
  return String(text).replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");
}

// Terms and their descriptions into a <dl>, as text.
function describe(list, terms) {
  list.replaceChildren(...terms.map(([term, text]) => {
    const group = document.createElement("div");
    const name = document.createElement("dt"), value = document.createElement("dd");
    name.textContent = term;
    value.textContent = text;
    group.append(name, value);
    return group;
  }));
}
