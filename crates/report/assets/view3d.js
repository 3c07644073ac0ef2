// A canvas with a scene in three dimensions that a hand turns, moves and zooms; drawn by three.

import * as THREE from "./three.module.min.js";

// While the page scrolls, the wheel belongs to the page.
let lastScroll = -1e9;
addEventListener("scroll", () => (lastScroll = performance.now()), { passive: true });

/** A surface of quadrilaterals: corners by the numbers of points. */
export function surface({ points_mm, quads }) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(points_mm, 3));
  const corners = [];
  for (let k = 0; k < quads.length; k += 4) corners.push(quads[k], quads[k + 1], quads[k + 2], quads[k], quads[k + 2], quads[k + 3]);
  geometry.setIndex(corners);
  return geometry;
}

/** The matrix of {rotation by rows, origin_mm}. */
export const matrixOf = ({ rotation: r, origin_mm: o }) => new THREE.Matrix4().set(r[0], r[1], r[2], o[0], r[3], r[4], r[5], o[1], r[6], r[7], r[8], o[2], 0, 0, 0, 1);

/** A picture that takes longer [ms] is late for a slider that moves: without a graphics card most do. */
const LATE = 50;

export class View3d {
  #wanted = false;
  /** Whether the browser needed long for the last picture. */
  isSlow = false;

  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(30, 1, 1, 1e5);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8890a0, 1.6));
    const lamp = new THREE.DirectionalLight(0xffffff, 2.2);
    lamp.position.set(-0.4, 0.7, 1);
    this.scene.add(lamp);
    // `size`: what has to fit into the width, `high` into the height; none before something is drawn.
    this.view = { turn: -0.5, tilt: 0.45, zoom: 1, target: new THREE.Vector3() };
    this.#controls();
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  /** Draws once before the next picture of the screen, however often it is asked. */
  draw() {
    if (this.#wanted) return;
    this.#wanted = true;
    requestAnimationFrame(() => {
      this.#wanted = false;
      const begun = performance.now();
      this.render();
      // The browser asks for the next picture once this one is on its way.
      requestAnimationFrame(() => (this.isSlow = performance.now() - begun > LATE));
    });
  }

  /** Draws at once: a print does not wait for a picture of the screen. */
  render() {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    if (width === 0 || !this.view.size) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    const { turn, tilt, target, size, high = 0.45 * size, zoom } = this.view;
    const half = Math.tan((0.5 * this.camera.fov * Math.PI) / 180) * Math.min(1, this.camera.aspect);
    const wide = this.camera.aspect > 1 ? size / this.camera.aspect : size;
    const distance = (0.56 * Math.max(wide, high)) / half / zoom;
    const along = new THREE.Vector3(Math.sin(turn) * Math.cos(tilt), Math.sin(tilt), Math.cos(turn) * Math.cos(tilt));
    this.camera.position.copy(target).addScaledVector(along, distance);
    this.camera.near = distance / 100;
    this.camera.far = distance * 10;
    this.camera.lookAt(target);
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
  }

  #controls() {
    const { canvas, view } = this;
    const turn = (x, y) => {
      view.turn -= x;
      view.tilt = Math.min(Math.max(view.tilt + y, -1.5), 1.5);
      this.draw();
    };
    const zoom = (factor) => {
      view.zoom = Math.min(Math.max(view.zoom * factor, 0.3), 40);
      this.draw();
    };
    const pan = (x, y) => {
      const way = (view.size / view.zoom / canvas.clientWidth) * 1.2;
      const right = new THREE.Vector3().setFromMatrixColumn(this.camera.matrix, 0);
      const up = new THREE.Vector3().setFromMatrixColumn(this.camera.matrix, 1);
      view.target.addScaledVector(right, -x * way).addScaledVector(up, y * way);
      this.draw();
    };
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      if (!(event.buttons & 3)) return;
      if (event.shiftKey || event.buttons & 2) pan(event.movementX, event.movementY);
      else turn(0.008 * event.movementX, 0.008 * event.movementY);
    });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      if (performance.now() - lastScroll < 300) return;
      event.preventDefault();
      zoom(Math.exp(-0.0012 * event.deltaY));
    }, { passive: false });
    const keys = { ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1), "+": () => zoom(1.2), "-": () => zoom(1 / 1.2) };
    canvas.addEventListener("keydown", (event) => {
      if (!keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
    });
  }
}
