// Both gears in three dimensions, drawn by three; millimetres. Cylindrical gears: tooth outlines and blanks are exact, axes
// as in the scene: gear 1 at the origin, gear 2 on +x, z along the axes. Bevel gears: flanks are exact, each gear in its seat.

import * as THREE from "./three.module.min.js";
import { View3d, matrixOf, surface } from "./view3d.js";
import { colour, mapColour, mapCss, short, unpack } from "./drawing.js";

/** Sections of helical teeth along the axis. */
const SECTIONS = 10;
/** Places with pressure that are drawn; more would be finer than the picture. */
const MOST_PLACES = 6000;
/** Milliseconds without a new answer after which a slow picture is drawn. */
const REST = 150;
/** The way along which a box is as long as its slice is wide. */
const ALONG = new THREE.Vector3(0, 0, 1);

/** The pressure at the end of the scale: nineteen twentieths of the loaded places are below. Tip edges press far more than the flank and would leave it one colour. */
export function endOfScale(answer) {
  const loaded = answer.pressure_MPa.filter((value) => value > 0).sort((a, b) => a - b);
  return loaded.length > 0 ? loaded[Math.floor(0.95 * (loaded.length - 1))] : 1;
}

/** The packed numbers of a picture. */
export function unpacked(data) {
  const scaled = ({ step, values }) => Float32Array.from(unpack(values, Uint16Array), (value) => step * value);
  const signed = ({ step, values }) => Float32Array.from(unpack(values, Int16Array), (value) => step * value);
  const floats = (text) => Array.from(unpack(text, Float32Array));
  return {
    ...data,
    gears: data.gears.map((gear) => (gear.points_mm ? { ...gear, points_mm: signed(gear.points_mm) } : gear)),
    angle_deg: floats(data.angle_deg),
    turns_rad: floats(data.turns_rad),
    pressure_MPa: scaled(data.pressure_MPa),
    width_mm: scaled(data.width_mm),
    point_mm: signed(data.point_mm),
    z_mm: signed(data.z_mm),
  };
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
  if (ring.inner_mm === null) shape.holes.push(new THREE.Path(outline(gear).reverse()));
  else if (ring.inner_mm > 0) shape.holes.push(circle(ring.inner_mm));
  for (const one of ring.openings) shape.holes.push(opening(one));
  const [low, high] = ring.z_mm;
  const isTwisted = (ring.outer_mm === null || ring.inner_mm === null) && gear.twist_rad_per_mm !== 0;
  const geometry = new THREE.ExtrudeGeometry(shape, { depth: high - low, bevelEnabled: false, curveSegments: 48, steps: isTwisted ? SECTIONS : 1 });
  geometry.translate(0, 0, low);
  if (isTwisted) {
    // The teeth turn with z; bore, openings and the outside of a ring do not.
    const radii = gear.outline_mm.map(([x, y]) => Math.hypot(x, y));
    const [least, most] = [Math.min(...radii) - 1e-3, Math.max(...radii) + 1e-3];
    const place = geometry.getAttribute("position");
    for (let k = 0; k < place.count; k++) {
      const [x, y, z] = [place.getX(k), place.getY(k), place.getZ(k)];
      const radius = Math.hypot(x, y);
      if (radius < least || radius > most) continue;
      const [s, c] = [Math.sin(z * gear.twist_rad_per_mm), Math.cos(z * gear.twist_rad_per_mm)];
      place.setXY(k, c * x - s * y, s * x + c * y);
    }
    geometry.computeVertexNormals();
  }
  return geometry;
}

/** All teeth of a bevel gear from section to section with the faces of toe and heel, and the body's inside. */
function bevelGeometries({ teeth, sections, points_mm, rim_mm }) {
  const size = points_mm.length / sections;
  const section = (k) => Array.from({ length: size / 3 }, (_, i) => points_mm.subarray(k * size + 3 * i, k * size + 3 * i + 3));
  const below = (k, [z, radius]) => section(k).map(([x, y]) => [x, y].map((part) => (radius * part) / Math.hypot(x, y)).concat(z));
  const layers = [below(0, rim_mm[0]), ...Array.from({ length: sections }, (_, k) => section(k)), below(sections - 1, rim_mm[1])];
  const columns = (teeth * size) / 3;
  const [points, quads] = [[], []];
  layers.forEach((layer, k) => {
    for (let column = 0; column < columns; column++) {
      const turn = (2 * Math.PI * Math.floor(column / layer.length)) / teeth;
      const [[s, c], [x, y, z]] = [[Math.sin(turn), Math.cos(turn)], layer[column % layer.length]];
      points.push(c * x - s * y, s * x + c * y, z);
      if (k === 0) continue;
      const beside = (column + 1) % columns;
      quads.push(...[column, beside].map((one) => (k - 1) * columns + one), ...[beside, column].map((one) => k * columns + one));
    }
  });
  const inside = rim_mm.map(([z, radius]) => new THREE.Vector2(radius, z));
  return [surface({ points_mm: points, quads }), new THREE.LatheGeometry(inside, 64).rotateX(0.5 * Math.PI)];
}

/** What a gear is made of. */
export const geometries = (gear) => gear.rings?.map((ring) => ringGeometry(gear, ring)) ?? bevelGeometries(gear);

export class Scene3d extends View3d {
  #following = null;

  constructor(canvas, gears) {
    super(canvas);
    this.gears = gears;
    this.materials = gears.map(() => new THREE.MeshStandardMaterial({ flatShading: true, roughness: 0.75, metalness: 0.1, side: THREE.DoubleSide }));
    this.bodies = gears.map(() => new THREE.Group());
    this.seats = this.bodies.map((body) => Object.assign(new THREE.Group(), { matrixAutoUpdate: false }).add(body));
    this.scene.add(...this.seats);
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
      body.add(...geometries(gears[k]).map((geometry) => new THREE.Mesh(geometry, this.materials[k])));
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
    const { view } = this;
    if (at === "mesh") {
      if (!this.pitchPoint) return;
      view.target.copy(this.pitchPoint);
      [view.size, view.high] = [7 * Math.PI * this.module, undefined];
    } else {
      const box = new THREE.Box3();
      for (const mesh of this.bodies.flatMap((body) => body.children.filter((one) => !one.isInstancedMesh))) {
        mesh.updateWorldMatrix(true, false);
        box.expandByObject(mesh);
      }
      box.getCenter(view.target);
      const { x, y, z } = box.getSize(new THREE.Vector3());
      [view.size, view.high] = [x + 0.5 * z, 0.9 * y + 0.45 * z];
    }
    view.zoom = 1;
    this.draw();
  }

  /** A new answer: where the gears stand and what presses on the flank of gear 1. */
  show(answer, torque, most) {
    Object.assign(this, { answer, torque, most });
    const isNew = !this.pitchPoint;
    const { seats, centre_distance_mm: distance, axial_offset_mm: offset } = answer;
    // A ring's teeth count negative: it touches on the far side of the gear inside.
    const [one, other] = this.gears.map((gear) => (gear.internal ? -gear.teeth : gear.teeth));
    const matrices = seats?.map(matrixOf) ?? [new THREE.Matrix4(), new THREE.Matrix4().makeTranslation(distance, 0, offset)];
    matrices.forEach((matrix, k) => Object.assign(this.seats[k], { matrix, matrixWorldNeedsUpdate: true }));
    this.pitchPoint = new THREE.Vector3(...(answer.pitch_point_mm ?? [(distance * one) / (one + other), 0, 0]));
    this.module = Math.abs((2 * this.pitchPoint.x) / one);
    // Axes that cross are seen from the side of the apex, from above, where the flank of gear 1 faces.
    if (isNew && seats) Object.assign(this.view, { turn: this.pitchPoint.x > 0 ? -2.6 : 2.6, tilt: 0.9 });
    const places = answer.angle_deg.length * answer.slots * answer.slices;
    const every = Math.ceil(places / MOST_PLACES);
    this.trace.count = this.#place(this.trace, Array.from({ length: Math.ceil(places / every) }, (_, k) => k * every), 0.05);
    if (isNew) this.look("pair");
  }

  /**
   * `show` and `at`, of other gears if need be: at once, or, where pictures are slow, once no answer follows, so that
   * curves do not wait for them.
   */
  follow(answer, torque, most, angle, gears = this.gears) {
    clearTimeout(this.#following);
    const now = () => {
      if (gears !== this.gears) this.replace(gears);
      this.restyle();
      this.show(answer, torque, most);
      this.at(angle);
    };
    if (this.isSlow) this.#following = setTimeout(now, REST);
    else now();
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

  #point(at, place = new THREE.Vector3()) {
    const { point_mm: across, z_mm: along } = this.answer;
    return place.set(across[2 * at], across[2 * at + 1], along[at]);
  }

  /** The way from one neighbour of a slice to the other: of the line on which bevel flanks touch. */
  #along(at) {
    const { slices, width_mm: width } = this.answer;
    const line = slices * Math.floor(at / slices);
    const touches = (other) => (other >= line && other < line + slices && width[other] > 0 ? other : at);
    const way = this.#point(touches(at + 1)).sub(this.#point(touches(at - 1)));
    return way.lengthSq() > 0 ? way.normalize() : ALONG;
  }

  /** Boxes at places of the answer; as thick as a share of the module. */
  #place(boxes, places, share) {
    const { answer, torque } = this;
    const thick = share * this.module;
    const all = answer.angle_deg.length * answer.slots * answer.slices;
    const [matrix, turn, size, place] = [new THREE.Matrix4(), new THREE.Quaternion(), new THREE.Vector3(), new THREE.Vector3()];
    const tint = new THREE.Color();
    let count = 0;
    for (const at of places) {
      const pressure = answer.pressure_MPa[torque * all + at];
      if (!(pressure > 0)) continue;
      if (answer.seats) turn.setFromUnitVectors(ALONG, this.#along(at));
      boxes.setMatrixAt(count, matrix.compose(this.#point(at, place), turn, size.set(thick, thick, answer.width_mm[at])));
      const [r, g, b] = mapColour(pressure / this.most);
      boxes.setColorAt(count, tint.setRGB(r / 255, g / 255, b / 255, THREE.SRGBColorSpace));
      count += 1;
    }
    boxes.instanceMatrix.needsUpdate = true;
    if (boxes.instanceColor) boxes.instanceColor.needsUpdate = true;
    return count;
  }
}
