// A pair of gears in space, drawn by the modules that draw it in the studio. The page carries them packed.
async function unzipped(text) {
  const stream = new Blob([unpack(text, Uint8Array)]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).text();
}

// Modules import each other by address: each becomes a blob, after those that it names.
let addresses = null;
async function loaded(name) {
  addresses ??= unzipped(document.getElementById("modules").textContent).then(text => {
    const texts = JSON.parse(text), made = {};
    const address = own => made[own] ??= URL.createObjectURL(new Blob([texts[own].replace(/(from\s*)"\.\/([^"]+)"/g, (_, from, other) => `${from}"${address(other)}"`)],
      { type: "text/javascript" }));
    return address;
  });
  return import((await addresses)(name));
}

const PACE = 90; // milliseconds from one position to the next

async function spaceView(figure, place, d) {
  const driver = withUnit("driver angle", "deg");
  const canvas = element("canvas", { tabIndex: 0 }), scale = element("div", { className: "scale" });
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `${figure.querySelector("figcaption").textContent}. Arrow keys turn the view, plus and minus zoom.`);
  const box = element("div", { className: "scene" }, canvas, scale);
  place.append(box);
  let scene = null, at = 0, torque = d.torques_Nm.length - 1, playing = null;
  try {
    const { Scene3d, endOfScale, showScale, unpacked } = await loaded("scene3d.js");
    const answer = unpacked(d), last = answer.angle_deg.length - 1;
    scene = new Scene3d(canvas, answer.gears);
    const most = endOfScale(answer), show = () => { scene.show(answer, torque, most); to(at); };
    const slider = element("input", { type: "range", min: 0, max: last, value: 0, ariaLabel: "driver angle", oninput: () => to(Number(slider.value)) });
    const angle = element("output");
    const to = k => {
      at = k;
      slider.value = k;
      angle.textContent = `${number(answer.angle_deg[k])}°`;
      scene.at(k);
      tell(driver, answer.angle_deg[k]);
    };
    const play = button("Play", () => {
      clearInterval(playing);
      playing = playing === null ? setInterval(() => to((at + 1) % (last + 1)), PACE) : null;
      play.textContent = playing === null ? "Play" : "Pause";
    });
    const choice = element("select", { onchange: () => { torque = Number(choice.value); show(); } }, ...d.torques_Nm.map((load, k) => new Option(`${number(load)} N·m`, k, false, k === torque)));
    const through = element("input", { type: "checkbox", checked: true, onchange: () => scene.seeThrough(through.checked) });
    place.before(element("div", { className: "tools" }, element("span", { className: "hint", textContent: "Drag or arrows to turn, wheel or +/− to zoom, Shift and drag to move." }),
      button("Pair", () => scene.look("pair")), button("Mesh", () => scene.look("mesh")), element("label", {}, through, "gear 2 see-through"), element("label", {}, "torque ", choice),
      ...downloads(figure, { PNG: () => canvasesToPng(figure, [canvas]) })));
    box.after(element("div", { className: "position" }, play, element("span", { textContent: "driver angle" }), slider, angle));
    showScale(scale, most);
    show();
    scene.look("mesh");
    figures.push(() => { scene.restyle(); scene.render(); });
    // A chart's cursor beyond the positions that are here says nothing.
    followers.push({ axis: `${driver} of a chart`, follow: x => {
      if (x > answer.angle_deg[last] + 1e-9) return;
      const k = answer.angle_deg.findIndex(own => own >= x - 1e-6);
      if (k >= 0 && k !== at) to(k);
    } });
  } catch (problem) {
    box.replaceWith(element("p", { className: "readout", textContent: `The gears are not drawn: ${problem.message}` }));
  }
}
