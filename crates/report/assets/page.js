// What all figures share: packed numbers, number format, theme, and when to draw again.
const figures = []; // functions that draw their figure for the present theme and width

function unpack(text, Kind) {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return new Kind(bytes.buffer); // little-endian, as all browsers' machines are
}

const cssColour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const isDark = () => document.documentElement.dataset.theme === "dark";

// Four significant digits, a real minus sign; a power of ten only where zeros would hide the number.
function number(v, digits = 4) {
  if (v == null || Number.isNaN(v)) return "–";
  if (v === 0) return "0";
  const size = Math.abs(v), sign = v < 0 ? "−" : "";
  if (size < 1e6 && size >= 1e-3) return sign + String(Number(size.toPrecision(digits)));
  const [m, n] = Number(size.toPrecision(digits)).toExponential().split("e");
  return sign + (m === "1" ? "" : `${m}·`) + `10${raised(Number(n))}`;
}

const raised = n => String(n).replace(/-/g, "⁻").replace(/\d/g, digit => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit]);

// A number of a logarithmic axis: 0.001 to 1000 in full, others as m × 10ⁿ.
function power(v) {
  const n = Math.floor(Math.log10(v) + 1e-9), m = Number((v / 10 ** n).toPrecision(3));
  if (n >= -3 && n <= 3) return number(v);
  return (m === 1 ? "" : `${m}·`) + `10${raised(n)}`;
}

const withUnit = (label, unit) => (unit ? `${label} [${unit}]` : label);

function element(tag, properties = {}, ...children) {
  const node = document.createElement(tag);
  Object.assign(node, properties);
  node.append(...children);
  return node;
}

function button(text, action) {
  return element("button", { type: "button", textContent: text, onclick: action });
}

// Colour maps as a few anchors of viridis and plasma (Smith and van der Walt, matplotlib, CC0), linear in between.
const VIRIDIS = [[68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142], [31, 158, 137], [53, 183, 121],
  [109, 205, 89], [180, 222, 44], [253, 231, 37]];
const PLASMA = [[13, 8, 135], [75, 3, 161], [125, 3, 168], [168, 34, 150], [203, 70, 121], [229, 107, 93], [248, 148, 65],
  [253, 195, 40], [240, 249, 33]];

function mapColour(map, place) {
  const t = Math.min(Math.max(place, 0), 1) * (map.length - 1), i = Math.min(Math.floor(t), map.length - 2), f = t - i;
  return map[i].map((c, k) => Math.round(c + f * (map[i + 1][k] - c)));
}

// A place on the ramp, cut so that it keeps its contrast on the paper.
function rampColour(place) {
  const [r, g, b] = mapColour(PLASMA, isDark() ? 0.35 + 0.6 * place : 0.72 * place);
  return `rgb(${r}, ${g}, ${b})`;
}

const seriesColour = colour => ("ramp" in colour ? rampColour(colour.ramp) : cssColour(`--c${colour.palette % 8}`));

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  document.getElementById("theme").textContent = theme === "dark" ? "Light" : "Dark";
  for (const draw of figures) draw();
}

addEventListener("DOMContentLoaded", () => {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const themeButton = document.getElementById("theme");
  themeButton.hidden = false;
  themeButton.onclick = () => setTheme(isDark() ? "light" : "dark");
  dark.addEventListener("change", () => setTheme(dark.matches ? "dark" : "light"));
  const makers = { line: lineChart, spectrum: spectrumChart, field: fieldPicture };
  for (const figure of document.querySelectorAll("figure.chart")) {
    const data = JSON.parse(figure.querySelector("script").textContent);
    makers[figure.dataset.kind](figure, figure.querySelector(".drawing"), data);
  }
  setTheme(dark.matches ? "dark" : "light");
  // Only the width matters: heights follow from it.
  let width = innerWidth;
  addEventListener("resize", () => { if (innerWidth !== width) { width = innerWidth; for (const draw of figures) draw(); } });
  // On paper: always light, and as wide as a sheet.
  let before = null;
  addEventListener("beforeprint", () => { before = document.documentElement.dataset.theme; printing = true; setTheme("light"); });
  addEventListener("afterprint", () => { printing = false; if (before) setTheme(before); });
});

let printing = false;
const PRINT_WIDTH = 680;
const drawingWidth = place => (printing ? PRINT_WIDTH : Math.max(280, place.clientWidth));
