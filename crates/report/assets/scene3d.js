// Both gears in three dimensions, drawn by three. Tooth outlines and blanks are exact; millimetres, axes as in the scene:
// gear 1 at the origin, gear 2 on +x, z along the axes.

import * as THREE from "./three.module.min.js";
import { View3d } from "./view3d.js";
import { colour, mapColour, mapCss, short } from "./drawing.js";

/** Sections of helical teeth along the axis. */
const SECTIONS = 10;
/** Places with pressure that are drawn; more would be finer than the picture. */
const MOST_PLACES = 6000;

/** The pressure at the end of the scale: nineteen twentieths of the loaded places are below. Tip edges press far more than the flank and would leave it one colour. */
export function endOfScale(answer) {
  const loaded = answer.pressure_MPa.filter((value) => value > 0).sort((a, b) => a - b);
  return loaded.length > 0 ? loaded[Math.floor(0.95 * (loaded.length - 1))] : 1;
}

/** The bar beside the gears. */
export function showScale(place, most) {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [160, 10];
  const context = canvas.getContext("2d");
  for (let x = 0; x < 160; x++) {
    context.fillStyle = mapCss(x / 159);
    context.fillRect(x, 0, 1, 10);
  }
  const ends = document.createElement("div");
  ends.className = "ends";
  for (const text of ["0", `${short(Math.round(most))} MPa and more`]) {
    const end = document.createElement("span");
    end.textContent = text;
    ends.append(end);
  }
  place.replaceChildren(canvas, ends);
}

function outline(gear) {
  const points = [];
  for (let tooth = 0; tooth < gear.teeth; tooth++) {
    const [s, c] = [Math.sin((2 * Math.PI * tooth) / gear.teeth), Math.cos((2 * Math.PI * tooth) / gear.teeth)];
    for (const [x, y] of gear.outline_mm) points.push(new THREE.Vector2(c * x - s * y, s * x + c * y));
  }
  return points;
}

const circle = (radius, [x, y] = [0, 0]) => new THREE.Path().absarc(x, y, radius, 0, 2 * Math.PI, true);

function opening(one) {
  if (one.hole) return circle(one.hole.radius_mm, one.hole.centre_mm);
  const { radii_mm: [inner, outer], angles_rad: [from, to] } = one.slot;
  const path = new THREE.Path();
  path.absarc(0, 0, outer, from, to, false);
  path.absarc(0, 0, inner, to, from, true);
  path.closePath();
  return path;
}

function ringGeometry(gear, ring) {
  const shape = new THREE.Shape();
  if (ring.outer_mm === null) shape.setFromPoints(outline(gear));
  else shape.absarc(0, 0, ring.outer_mm, 0, 2 * Math.PI, false);
  if (ring.inner_mm > 0) shape.holes.push(circle(ring.inner_mm));
  for (const one of ring.openings) shape.holes.push(opening(one));
  const [low, high] = ring.z_mm;
  const isTwisted = ring.outer_mm === null && gear.twist_rad_per_mm !== 0;
  const geometry = new THREE.ExtrudeGeometry(shape, { depth: high - low, bevelEnabled: false, curveSegments: 48, steps: isTwisted ? SECTIONS : 1 });
  geometry.translate(0, 0, low);
  if (isTwisted) {
    // The teeth turn with z; bore and openings do not.
    const least = Math.min(...gear.outline_mm.map(([x, y]) => Math.hypot(x, y))) - 1e-3;
    const place = geometry.getAttribute("position");
    for (let k = 0; k < place.count; k++) {
      const [x, y, z] = [place.getX(k), place.getY(k), place.getZ(k)];
      if (Math.hypot(x, y) < least) continue;
      const [s, c] = [Math.sin(z * gear.twist_rad_per_mm), Math.cos(z * gear.twist_rad_per_mm)];
      place.setXY(k, c * x - s * y, s * x + c * y);
    }
    geometry.computeVertexNormals();
  }
  return geometry;
}

export class Scene3d extends View3d {
  constructor(canvas, gears) {
    super(canvas);
    this.gears = gears;
    this.materials = gears.map(() => new THREE.MeshStandardMaterial({ flatShading: true, roughness: 0.75, metalness: 0.1, side: THREE.DoubleSide }));
    this.bodies = gears.map(() => new THREE.Group());
    this.scene.add(...this.bodies);
    const box = new THREE.BoxGeometry(1, 1, 1);
    const lit = (depthTest) => new THREE.MeshBasicMaterial({ depthTest, toneMapped: false });
    this.trace = new THREE.InstancedMesh(box, lit(true), MOST_PLACES);
    this.lines = new THREE.InstancedMesh(box, lit(false), 512);
    this.lines.renderOrder = 2;
    this.trace.frustumCulled = this.lines.frustumCulled = false;
    this.replace(gears);
    this.seeThrough(true);
    this.restyle();
  }

  /** Other gears in the place of those that are drawn. */
  replace(gears) {
    this.gears = gears;
    this.bodies.forEach((body, k) => {
      for (const old of body.children) if (!old.isInstancedMesh) old.geometry.dispose();
      body.clear();
      for (const ring of gears[k].rings) body.add(new THREE.Mesh(ringGeometry(gears[k], ring), this.materials[k]));
    });
    this.bodies[0].add(this.trace, this.lines);
    this.draw();
  }

  restyle() {
    this.materials.forEach((material, k) => material.color.set(colour(`--gear-${k + 1}`)));
    this.draw();
  }

  seeThrough(isSo) {
    const [, material] = this.materials;
    Object.assign(material, { transparent: isSo, opacity: isSo ? 0.3 : 1, depthWrite: !isSo, needsUpdate: true });
    this.bodies[1].renderOrder = 1;
    this.draw();
  }

  /** The whole pair, or the teeth in mesh. */
  look(at) {
    const [first, second] = this.gears.map((gear) => 0.5 * gear.tip_diameter_mm);
    const distance = this.distance ?? first + second;
    const pitch = (distance * this.gears[0].teeth) / (this.gears[0].teeth + this.gears[1].teeth);
    if (at === "mesh") {
      this.view.target.set(pitch, 0, 0);
      this.view.size = 7 * ((Math.PI * 2 * pitch) / this.gears[0].teeth);
    } else {
      this.view.target.set(0.5 * (distance + second - first), 0, 0);
      this.view.size = distance + first + second;
    }
    this.view.zoom = 1;
    this.draw();
  }

  /** A new answer: where the gears stand and what presses on the flank of gear 1. */
  show(answer, torque, most) {
    Object.assign(this, { answer, torque, most });
    const isNew = this.distance === undefined;
    this.distance = answer.centre_distance_mm;
    this.bodies[1].position.set(answer.centre_distance_mm, 0, answer.axial_offset_mm);
    const places = answer.angle_deg.length * answer.slots * answer.slices;
    const every = Math.ceil(places / MOST_PLACES);
    this.trace.count = this.#place(this.trace, Array.from({ length: Math.ceil(places / every) }, (_, k) => k * every), 0.05);
    if (isNew) this.look("pair");
  }

  /** Turns the gears to a position. */
  at(angle) {
    const { answer } = this;
    if (!answer) return;
    this.bodies.forEach((body, k) => (body.rotation.z = answer.turns_rad[2 * angle + k]));
    const block = answer.slots * answer.slices;
    this.lines.count = this.#place(this.lines, Array.from({ length: Math.min(block, 512) }, (_, k) => angle * block + k), 0.16);
    this.draw();
  }

  /** Boxes at places of the answer; as thick as a share of the module. */
  #place(boxes, places, share) {
    const { answer, torque } = this;
    const gear = this.gears[0];
    const thick = (share * gear.tip_diameter_mm) / gear.teeth;
    const all = answer.angle_deg.length * answer.slots * answer.slices;
    const matrix = new THREE.Matrix4();
    const tint = new THREE.Color();
    let count = 0;
    for (const at of places) {
      const pressure = answer.pressure_MPa[torque * all + at];
      if (!(pressure > 0)) continue;
      matrix.makeScale(thick, thick, answer.width_mm[at]);
      matrix.setPosition(answer.point_mm[2 * at], answer.point_mm[2 * at + 1], answer.z_mm[at]);
      boxes.setMatrixAt(count, matrix);
      const [r, g, b] = mapColour(pressure / this.most);
      boxes.setColorAt(count, tint.setRGB(r / 255, g / 255, b / 255, THREE.SRGBColorSpace));
      count += 1;
    }
    boxes.instanceMatrix.needsUpdate = true;
    if (boxes.instanceColor) boxes.instanceColor.needsUpdate = true;
    return count;
  }
}
