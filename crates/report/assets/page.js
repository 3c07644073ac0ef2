// What all figures share: theme, and when to draw again.
const figures = []; // functions that draw their figure for the present theme and width
// Figures over one axis: { axis, follow(x) }. Who moves along the axis tells those who follow.
const followers = [], tell = (axis, x) => followers.forEach(one => one.axis === axis && one.follow(x));

const isDark = () => document.documentElement.dataset.theme === "dark";

function element(tag, properties = {}, ...children) {
  const node = document.createElement(tag);
  Object.assign(node, properties);
  node.append(...children);
  return node;
}

function button(text, action) {
  return element("button", { type: "button", textContent: text, onclick: action });
}

// Anchors of plasma (Smith and van der Walt, matplotlib, CC0).
const PLASMA = [[13, 8, 135], [75, 3, 161], [125, 3, 168], [168, 34, 150], [203, 70, 121], [229, 107, 93], [248, 148, 65],
  [253, 195, 40], [240, 249, 33]];

// A place on the ramp, cut so that it keeps its contrast on the paper.
function rampColour(place) {
  const [r, g, b] = mixed(PLASMA, isDark() ? 0.35 + 0.6 * place : 0.72 * place);
  return `rgb(${r}, ${g}, ${b})`;
}

const seriesColour = of => ("ramp" in of ? rampColour(of.ramp) : curveColour(of.palette));

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
  const makers = { line: lineChart, spectrum: spectrumChart, field: fieldPicture, space: spaceView };
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
