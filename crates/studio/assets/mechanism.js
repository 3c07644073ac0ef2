// A machine in three dimensions: gears by their shapes or surfaces, shafts and bearings by their outlines, forces as arrows.

import * as THREE from "./three.module.min.js";
import { View3d, matrixOf, surface } from "./view3d.js";
import { geometries } from "./scene3d.js";
import { colour } from "./drawing.js";

/** A tube about z, its middle at the origin. */
function tube([inner, outer], length) {
  const profile = [[inner, -0.5], [outer, -0.5], [outer, 0.5], [inner, 0.5], [inner, -0.5]];
  return new THREE.LatheGeometry(profile.map(([radius, share]) => new THREE.Vector2(radius, share * length)), 64).rotateX(0.5 * Math.PI);
}

/** What the parts are drawn in, and how much shines through. */
const LOOK = { shaft: ["--shaft", 1], ring: ["--shaft", 0.3], cage: ["--c2", 0.6], body: ["--faint", 0.15] };

const material = (opacity, flatShading) => new THREE.MeshStandardMaterial({ flatShading, roughness: 0.75, metalness: 0.1, side: THREE.DoubleSide, transparent: opacity < 1, depthWrite: opacity === 1, opacity });

/** Bodies, parts and elements of a machine, moved from frame to frame: /api/columns/moments and /api/modes say what they are. */
export class Mechanism extends View3d {
  /** Another machine. */
  show({ bodies, parts, elements, frames }) {
    for (const mesh of this.drawn ?? []) {
      for (const part of [mesh, ...mesh.children]) if (part.isMesh) part.geometry.dispose();
      this.scene.remove(mesh);
    }
    [this.frames, this.parts, this.elements] = [frames, parts, elements];
    this.paints = bodies.map(() => material(1, true));
    const shapes = (body) => (body.shape ? geometries(body.shape) : [surface(body)]);
    this.meshes = bodies.map((body, k) => new THREE.Group().add(...shapes(body).map((shape) => new THREE.Mesh(shape, this.paints[k]))));
    const most = Math.max(0, ...frames.map(({ forces }) => forces.length));
    this.arrows = Array.from({ length: most }, () => new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), 1, 0xc2410c));
    for (const arrow of this.arrows) {
      // Forces act inside the mesh and are seen through it.
      for (const part of [arrow.line, arrow.cone]) part.material.depthTest = false;
      arrow.renderOrder = 2;
    }
    this.solids = parts.map((part) => new THREE.Mesh(part.edges_mm ? new THREE.BoxGeometry(...part.edges_mm) : tube(part.radii_mm, part.length_mm), material(LOOK[part.kind][1], true)));
    this.rows = elements.map(({ count, diameter_mm, length_mm, tilt_rad }) => {
      const radius = 0.5 * diameter_mm;
      // Axis along z, leaning outwards at +z.
      const shape = length_mm === null ? new THREE.SphereGeometry(radius, 24, 16) : new THREE.CylinderGeometry(radius, radius, length_mm, 24).rotateX(0.5 * Math.PI).rotateY(tilt_rad);
      const row = new THREE.InstancedMesh(shape, material(1, length_mm !== null), count);
      row.frustumCulled = false;
      return row;
    });
    this.drawn = [...this.meshes, ...this.arrows, ...this.solids, ...this.rows];
    for (const mesh of [...this.meshes, ...this.solids]) mesh.matrixAutoUpdate = false;
    this.scene.add(...this.drawn);
    this.mostLoaded = Math.max(0, ...frames.flatMap(({ element_loads_N }) => element_loads_N.flatMap((one) => one ?? [])));
    const amounts = frames.flatMap(({ forces }) => forces.map((one) => Math.hypot(...one.force_N)));
    this.most = Math.max(...amounts, 0);
    this.at(0);
    const box = new THREE.Box3();
    // What is drawn by its inertia alone may be larger than the machine: it is left out then.
    const exact = [...this.meshes, ...this.solids.filter((_, k) => parts[k].kind !== "body")];
    for (const mesh of exact.length > 0 ? exact : this.solids) {
      mesh.updateMatrixWorld(true);
      box.expandByObject(mesh);
    }
    box.getCenter(this.view.target);
    const { x, y, z } = box.getSize(new THREE.Vector3());
    [this.view.size, this.view.high] = [Math.hypot(x, y, z), 0.9 * y + 0.45 * z];
    this.solids.forEach((mesh, k) => (mesh.visible = !parts[k].edges_mm || exact.length === 0 || Math.max(...parts[k].edges_mm) < 0.7 * this.view.size));
    this.restyle();
  }

  /** The same machine, moved otherwise. */
  moved(machine, frames, isFirst) {
    if (isFirst) this.show({ ...machine, frames });
    this.frames = frames;
  }

  at(number) {
    const { places, forces, carriers, angles_rad, element_loads_N: loads } = this.frames[number];
    const put = (mesh, matrix) => {
      mesh.matrix.copy(matrix);
      mesh.matrixWorldNeedsUpdate = true;
    };
    this.meshes.forEach((mesh, k) => put(mesh, matrixOf(places[k])));
    const carried = carriers.map(matrixOf);
    const seat = ({ carrier, place }) => (carrier === null ? matrixOf(place) : carried[carrier].clone().multiply(matrixOf(place)));
    this.solids.forEach((mesh, k) => put(mesh, seat(this.parts[k])));
    this.rows.forEach((row, k) => {
      const { pitch_radius_mm: radius, height_mm: height } = this.elements[k];
      const middle = seat(this.elements[k]);
      angles_rad[k].forEach((angle, ball) => {
        const own = new THREE.Matrix4().makeRotationZ(angle).multiply(new THREE.Matrix4().makeTranslation(radius, 0, height));
        row.setMatrixAt(ball, own.premultiply(middle));
      });
      row.instanceMatrix.needsUpdate = true;
      this.#paint(row, loads[k]);
    });
    this.arrows.forEach((arrow, k) => {
      const force = forces[k];
      arrow.visible = force !== undefined && this.most > 0;
      if (!arrow.visible) return;
      const amount = new THREE.Vector3(...force.force_N);
      const long = 0.25 * this.view.size * (amount.length() / this.most);
      arrow.position.set(...force.point_mm);
      arrow.setDirection(amount.normalize());
      arrow.setLength(Math.max(long, 1e-3), Math.min(0.3 * long, 0.03 * this.view.size), 0.02 * this.view.size);
    });
    this.draw();
  }

  /** Balls or rollers by their loads, the most loaded of all moments in full colour. */
  #paint(row, loads) {
    if (!loads || !this.mostLoaded) return;
    const [free, loaded] = [new THREE.Color(colour("--shaft")), new THREE.Color(colour("--c1"))];
    loads.forEach((load, ball) => row.setColorAt(ball, free.clone().lerp(loaded, Math.min(load / this.mostLoaded, 1))));
    row.instanceColor.needsUpdate = true;
  }

  restyle() {
    this.paints?.forEach((paint, k) => paint.color.set(colour(`--gear-${(k % 2) + 1}`)));
    this.solids?.forEach((mesh, k) => mesh.material.color.set(colour(LOOK[this.parts[k].kind][0])));
    // A colour of each ball stands on white.
    this.rows?.forEach((row, k) => row.material.color.set(this.mostLoaded > 0 && this.frames[0].element_loads_N[k] ? "#ffffff" : colour("--c2")));
    this.arrows?.forEach((arrow) => arrow.setColor(colour("--c1")));
    this.draw();
  }
}
