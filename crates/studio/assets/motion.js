// The gears of a multibody result in three dimensions, moment by moment, with the forces on their teeth as arrows.

import * as THREE from "./three.module.min.js";
import { View3d } from "./view3d.js";
import { colour, short } from "./curves.js";
import { Job } from "./job.js";
import { byId, fail, say } from "./said.js";

/** Milliseconds from one moment to the next. */
const PACE = 60;

function surface({ points_mm, quads }) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(points_mm, 3));
  const corners = [];
  for (let k = 0; k < quads.length; k += 4) corners.push(quads[k], quads[k + 1], quads[k + 2], quads[k], quads[k + 2], quads[k + 3]);
  geometry.setIndex(corners);
  return geometry;
}

class Mechanism extends View3d {
  /** Other bodies: {name, points_mm, quads}, and where they are: frames. */
  show({ bodies, frames }) {
    this.meshes?.forEach((mesh) => {
      mesh.geometry.dispose();
      this.scene.remove(mesh);
    });
    this.arrows?.forEach((arrow) => this.scene.remove(arrow));
    this.frames = frames;
    this.meshes = bodies.map((body) => new THREE.Mesh(surface(body), new THREE.MeshStandardMaterial({ flatShading: true, roughness: 0.75, metalness: 0.1, side: THREE.DoubleSide })));
    this.arrows = bodies.map(() => new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), 1, 0xc2410c));
    for (const arrow of this.arrows) {
      // Forces act inside the mesh and are seen through it.
      for (const part of [arrow.line, arrow.cone]) part.material.depthTest = false;
      arrow.renderOrder = 2;
    }
    this.scene.add(...this.meshes, ...this.arrows);
    this.at(0);
    const box = new THREE.Box3();
    for (const mesh of this.meshes) box.expandByObject(mesh);
    box.getCenter(this.view.target);
    this.view.size = box.getSize(new THREE.Vector3()).length();
    const amounts = frames.flatMap(({ forces }) => forces.map((one) => (one ? Math.hypot(...one.force_N) : 0)));
    this.most = Math.max(...amounts, 0);
    this.restyle();
  }

  at(number) {
    const { places, forces } = this.frames[number];
    this.meshes.forEach((mesh, k) => {
      const { rotation: r, origin_mm: o } = places[k];
      mesh.matrixAutoUpdate = false;
      mesh.matrix.set(r[0], r[1], r[2], o[0], r[3], r[4], r[5], o[1], r[6], r[7], r[8], o[2], 0, 0, 0, 1);
      mesh.matrixWorldNeedsUpdate = true;
      const [arrow, force] = [this.arrows[k], forces[k]];
      arrow.visible = force !== null && this.most > 0;
      if (!arrow.visible) return;
      const amount = new THREE.Vector3(...force.force_N);
      const long = 0.25 * this.view.size * (amount.length() / this.most);
      arrow.position.set(...force.point_mm);
      arrow.setDirection(amount.normalize());
      arrow.setLength(Math.max(long, 1e-3), Math.min(0.3 * long, 0.03 * this.view.size), 0.02 * this.view.size);
    });
    this.draw();
  }

  restyle() {
    this.meshes?.forEach((mesh, k) => mesh.material.color.set(colour(`--gear-${(k % 2) + 1}`)));
    this.arrows?.forEach((arrow) => arrow.setColor(colour("--c1")));
    this.draw();
  }
}

export class Motion {
  #mechanism = null;
  #playing = null;
  #frames = [];

  /** `stretch()`: the stretch that the curves show; `moved(at)` hears of the moment. */
  constructor(stretch, moved) {
    this.stretch = stretch;
    this.moved = moved;
    this.job = new Job((words) => say(`the gears are read: ${words}`));
    byId("motion").addEventListener("toggle", () => byId("motion").open && this.#frames.length === 0 && this.#read());
    byId("stretch").addEventListener("click", () => this.#read());
    byId("moment").addEventListener("input", () => this.#at(Number(byId("moment").value)));
    byId("moving-play").addEventListener("click", () => this.#play());
  }

  restyle() {
    this.#mechanism?.restyle();
  }

  async #read() {
    const [from, to] = this.stretch() ?? [null, null];
    try {
      const ended = await this.job.run("/api/columns/moments", { from, to });
      say("");
      fail(null);
      if (!ended) return;
      this.#mechanism ??= new Mechanism(byId("moving"));
      this.#frames = ended.result.frames;
      this.unit = ended.result.unit;
      this.#mechanism.show(ended.result);
      byId("moment").max = this.#frames.length - 1;
      byId("force-scale").textContent = this.#mechanism.most > 0 ? `longest arrow ${short(this.#mechanism.most)} N` : "no forces on teeth";
      this.#at(0);
    } catch (problem) {
      fail(problem);
    }
  }

  #at(number) {
    if (!this.#frames[number]) return;
    byId("moment").value = number;
    const { at } = this.#frames[number];
    byId("moment-at").textContent = `${short(at)} ${this.unit}`;
    this.#mechanism.at(number);
    this.moved(at);
  }

  #play() {
    clearInterval(this.#playing);
    const next = () => this.#at((Number(byId("moment").value) + 1) % this.#frames.length);
    this.#playing = this.#playing === null && this.#frames.length > 1 ? setInterval(next, PACE) : null;
    byId("moving-play").textContent = this.#playing === null ? "Play" : "Pause";
    byId("moving-play").ariaPressed = String(this.#playing !== null);
  }
}
