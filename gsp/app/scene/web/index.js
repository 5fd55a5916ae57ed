// The platform in space, for the page and for figures in notebooks. It gets the design once
// (`build`) and some sixty numbers at each pose (`move`). Lengths are divided by the size of the drawing.
import { THREE, OrbitControls, CSS2DRenderer, CSS2DObject } from "nicegui-scene";
import { film, save, snapshot } from "gsp-scene/film.js";

const INK = 0x1a1a1a, GREY = 0x8a8f98, ACTIVE = 0xe69f00, PURPLE = 0xaa4499, SKY = 0x3d8fc4;
const ROD = 0.011, TUBE = 0.018, BALL = 0.03, MIDDLE = 0.55, NUMBER = 0.3, BEYOND = 0.14;
// Pixels between a label and the edge of the picture.
const EDGE = 4;
// Assembly modes farther away than so many radii of the mechanism would shrink it: they may be cut.
const AWAY = 5;
// The frame of the platform is in the picture unless it makes it so many times as large.
const WITH_FRAME = 2;
const UP = new THREE.Vector3(0, 1, 0);
const VIEWS = { space: [0.9, -1.5, 0.85], plan: [0, -0.001, 1], front: [0, -1, 0.05], side: [1, 0, 0.05] };

const vector = (a, i = 0) => new THREE.Vector3(a[i], a[i + 1], a[i + 2]);

function mesh(geometry, colour, options = {}) {
  const material = new THREE.MeshStandardMaterial({ color: colour, roughness: 0.55, metalness: 0.15, ...options });
  return new THREE.Mesh(geometry, material);
}

// A cylinder of length 1 along y, which `stretch` puts between two points.
function rod(radius, colour) {
  return mesh(new THREE.CylinderGeometry(radius, radius, 1, 20), colour);
}

function stretch(object, from, to) {
  const along = to.clone().sub(from), length = along.length();
  object.visible = length > 1e-9;
  object.position.copy(from).addScaledVector(along, 0.5);
  object.scale.set(1, Math.max(length, 1e-9), 1);
  turn(object, along);
}

function turn(object, along) {
  if (along.lengthSq() > 1e-18) object.quaternion.setFromUnitVectors(UP, along.clone().normalize());
}

function label(text, kind) {
  const element = document.createElement("div");
  element.className = "gsp-label gsp-label-" + kind;
  element.textContent = text;
  return new CSS2DObject(element);
}

function segments(points, colour, options = {}) {
  const geometry = new THREE.BufferGeometry().setFromPoints(points);
  const material = options.dashSize
    ? new THREE.LineDashedMaterial({ color: colour, ...options })
    : new THREE.LineBasicMaterial({ color: colour, ...options });
  return new THREE.LineSegments(geometry, material);
}

function body(spec, size, colour) {
  const group = new THREE.Group();
  const corners = spec.faces.map((p) => vector(p).divideScalar(size));
  if (corners.length) {
    const geometry = new THREE.BufferGeometry().setFromPoints(corners);
    geometry.computeVertexNormals();
    const options = { transparent: true, opacity: 0.45, side: THREE.DoubleSide, depthWrite: false };
    group.add(mesh(geometry, colour, options));
  }
  for (let i = 0; i + 1 < spec.edges.length; i += 2) {
    const bar = rod(0.006, colour);
    stretch(bar, vector(spec.edges[i]).divideScalar(size), vector(spec.edges[i + 1]).divideScalar(size));
    group.add(bar);
  }
  return group;
}

function frame(length, name) {
  const group = new THREE.Group();
  ["x", "y", "z"].forEach((letter, i) => {
    const tip = new THREE.Vector3().setComponent(i, length);
    const colour = [0xd55e00, 0x009e73, 0x0072b2][i];
    group.add(segments([new THREE.Vector3(), tip], colour));
    const text = label(letter, "axis");
    text.position.copy(tip).multiplyScalar(1.12);
    group.add(text);
  });
  const text = label(name, "axis");
  text.position.set(-0.03, -0.03, -0.03);
  group.add(text);
  return group;
}

function ellipsoid(spec, size) {
  const group = new THREE.Group();
  const ball = new THREE.SphereGeometry(1, 32, 20);
  const options = { transparent: true, opacity: 0.15, depthWrite: false };
  group.add(mesh(ball, 0xd55e00, options));
  const lines = new THREE.LineSegments(
    new THREE.WireframeGeometry(new THREE.SphereGeometry(1, 16, 10)),
    new THREE.LineBasicMaterial({ color: 0xd55e00, transparent: true, opacity: 0.25 }),
  );
  group.add(lines);
  const r = spec.rotation, a = spec.semi_axes.map((x) => x / size), c = spec.center.map((x) => x / size);
  group.matrixAutoUpdate = false;
  group.matrix.set(
    r[0] * a[0], r[1] * a[1], r[2] * a[2], c[0],
    r[3] * a[0], r[4] * a[1], r[5] * a[2], c[1],
    r[6] * a[0], r[7] * a[1], r[8] * a[2], c[2],
    0, 0, 0, 1,
  );
  return group;
}

// Another assembly mode of the same joint values: "same" if det J has the sign of the present one.
function ghost(spec, drawing, size) {
  const group = new THREE.Group(), top = new THREE.Group();
  const colour = spec.same ? INK : PURPLE, thin = { transparent: true, opacity: 0.55 };
  const points = (list) => list.map((p) => vector(p).divideScalar(size));
  if (drawing.platform.faces.length) {
    const geometry = new THREE.BufferGeometry().setFromPoints(points(drawing.platform.faces));
    geometry.computeVertexNormals();
    top.add(mesh(geometry, colour, { transparent: true, opacity: 0.1, side: THREE.DoubleSide, depthWrite: false }));
  }
  top.add(segments(points(drawing.platform.edges), colour, thin));
  top.position.copy(vector(spec.position).divideScalar(size));
  top.quaternion.setFromRotationMatrix(new THREE.Matrix4().setFromMatrix3(new THREE.Matrix3().set(...spec.rotation)));
  const feet = spec.feet.filter((foot) => foot).flatMap((foot) => [vector(foot), vector(foot, 3)]);
  group.add(top, segments(feet.map((p) => p.divideScalar(size)), colour, { ...thin, opacity: 0.3 }));
  const name = label(spec.name, "ghost");
  name.position.copy(top.position);
  group.add(name);
  return group;
}

// A closed surface: coordinates of corners, and three numbers of corners per triangle.
function surface(spec, size) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(spec.vertices.map((x) => x / size), 3));
  geometry.setIndex(spec.faces);
  geometry.computeVertexNormals();
  const skin = { transparent: true, opacity: 0.16, depthWrite: false, roughness: 1, metalness: 0 };
  const group = new THREE.Group();
  // The far side first, so that both sides are seen.
  [THREE.BackSide, THREE.FrontSide].forEach((side, i) => {
    const part = mesh(geometry, SKY, { ...skin, side });
    part.renderOrder = 1 + i;
    group.add(part);
  });
  return group;
}

// The middle joint: P is a box, C a collar; a driven turn is a ring. Driven joints are orange.
function middle(kind, active) {
  const group = new THREE.Group();
  const slides = active.includes("slide"), turns = active.includes("turn");
  if (kind === "P") group.add(mesh(new THREE.BoxGeometry(0.05, 0.06, 0.05), slides ? ACTIVE : GREY));
  else group.add(mesh(new THREE.CylinderGeometry(0.028, 0.028, 0.07, 24), slides ? ACTIVE : GREY));
  if (turns) {
    const ring = mesh(new THREE.TorusGeometry(0.045, 0.011, 12, 32), ACTIVE);
    ring.rotation.x = Math.PI / 2;
    group.add(ring);
  }
  return group;
}

class Leg {
  constructor(spec, size) {
    this.spec = spec;
    this.size = size;
    this.group = new THREE.Group();
    this.tube = rod(TUBE, spec.colour);
    this.rod = rod(ROD, 0xb9c0ca);
    this.middle = middle(spec.kinds[1], spec.active[1]);
    this.ends = [spec.kinds[0], spec.kinds[2]].map((kind) =>
      kind === "C"
        ? mesh(new THREE.CylinderGeometry(0.026, 0.026, 0.09, 24), spec.colour)
        : mesh(new THREE.SphereGeometry(BALL, 24, 16), spec.colour),
    );
    this.lines = [spec.base_line, spec.platform_line].map((line) =>
      line ? segments([new THREE.Vector3(), new THREE.Vector3()], spec.colour, { dashSize: 0.03, gapSize: 0.02 }) : null,
    );
    this.number = label(spec.label, "number");
    this.name = label(spec.joints, "joint");
    this.group.add(this.tube, this.rod, this.middle, ...this.ends, ...this.lines.filter((l) => l), this.number, this.name);
  }

  place(feet, platform) {
    this.group.visible = feet !== null;
    this.number.visible = this.name.visible = feet !== null;
    if (!feet) return;
    const a = vector(feet).divideScalar(this.size), b = vector(feet, 3).divideScalar(this.size);
    const between = a.clone().lerp(b, MIDDLE), along = b.clone().sub(a);
    stretch(this.tube, a, between);
    stretch(this.rod, between, b);
    this.middle.position.copy(between);
    turn(this.middle, along);
    this.number.position.copy(a).lerp(b, NUMBER);
    this.name.position.copy(a).lerp(b, 0.72);
    [a, b].forEach((foot, side) => {
      this.ends[side].position.copy(foot);
      const line = side ? this.spec.platform_line : this.spec.base_line;
      if (!line) return;
      const direction = vector(line), anchor = vector(side ? this.spec.platform : this.spec.base).divideScalar(this.size);
      if (side) {
        direction.applyMatrix3(platform.rotation);
        anchor.applyMatrix3(platform.rotation).add(platform.position);
      }
      turn(this.ends[side], direction);
      const reach = foot.clone().sub(anchor).dot(direction);
      const low = anchor.clone().addScaledVector(direction, Math.min(0, reach) - BEYOND);
      const high = anchor.clone().addScaledVector(direction, Math.max(0, reach) + BEYOND);
      this.lines[side].geometry.setFromPoints([low, high]);
      this.lines[side].computeLineDistances();
    });
  }
}

// A mechanism in an element: a canvas, a layer of labels, and a note for browsers without WebGL.
export class Scene {
  constructor(root, { drawing, place, shown, view }) {
    this.root = root;
    root.innerHTML =
      '<canvas></canvas><div class="gsp-scene-labels"></div>' +
      '<p class="gsp-scene-note" hidden>This browser has no WebGL: the numbers work, the picture does not.</p>';
    const [canvas, labels, note] = root.children;
    try {
      this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    } catch (error) {
      note.hidden = false;
      throw error;
    }
    this.texts = new CSS2DRenderer({ element: labels });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x9aa3ad, 2.0));
    const sun = new THREE.DirectionalLight(0xffffff, 1.8);
    sun.position.set(2, -3, 5);
    this.scene.add(sun);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("start", () => (this.touched = true));
    root.addEventListener("keydown", (event) => this.key(event));
    this.watcher = new ResizeObserver(() => this.resize());
    this.watcher.observe(root);
    this.build(drawing, place);
    this.options(shown);
    this.look(view || "space");
  }

  remove() {
    this.watcher.disconnect();
    this.controls.dispose();
    this.clear();
    this.renderer.dispose();
  }

  clear() {
    if (this.world) this.discard(this.world);
    this.others = this.region = null;
  }

  discard(group) {
    group.removeFromParent();
    group.traverse((object) => {
      object.geometry?.dispose();
      object.material?.dispose();
      object.element?.remove();
    });
  }

  build(drawing, place) {
    this.clear();
    this.drawing = drawing;
    const size = (this.size = drawing.size);
    this.world = new THREE.Group();
    const origin = vector(drawing.origin).divideScalar(-size), near = origin.lengthSq() === 0;
    const floor = Math.min(...(near ? [0] : []), ...drawing.base.edges.map((p) => p[2] / size));
    const grid = new THREE.GridHelper(4, 20, 0xb8c0c8, 0xdde2e7);
    grid.rotation.x = Math.PI / 2;
    grid.position.z = (Number.isFinite(floor) ? floor : 0) - 0.012;
    this.base = body(drawing.base, size, GREY);
    this.platform = new THREE.Group();
    this.top = body(drawing.platform, size, 0x0072b2);
    this.platform.add(this.top);
    this.frames = [frame(0.2, "O"), frame(0.2, "P")];
    this.frames[0].position.copy(origin);
    this.platform.add(this.frames[1]);
    this.ellipsoid = drawing.ellipsoid ? ellipsoid(drawing.ellipsoid, size) : null;
    if (this.ellipsoid) this.platform.add(this.ellipsoid);
    this.legs = drawing.legs.map((spec) => new Leg(spec, size));
    this.screw = segments([new THREE.Vector3(), new THREE.Vector3()], PURPLE, { dashSize: 0.06, gapSize: 0.03 });
    this.pitch = label("", "screw");
    this.world.add(grid, this.base, this.platform, this.frames[0], this.screw, this.pitch);
    this.legs.forEach((leg) => this.world.add(leg.group));
    this.scene.add(this.world);
    this.move(place);
    this.options(this.on);
  }

  move(place) {
    this.last = place;
    const r = place.rotation, platform = {
      position: vector(place.position).divideScalar(this.size),
      rotation: new THREE.Matrix3().set(...r),
    };
    this.platform.position.copy(platform.position);
    this.platform.quaternion.setFromRotationMatrix(new THREE.Matrix4().setFromMatrix3(platform.rotation));
    this.top.traverse((object) => object.material?.color.set(place.colour));
    this.legs.forEach((leg, i) => leg.place(place.feet[i], platform));
    this.options(this.on);
  }

  options(shown) {
    if (!shown) return;
    this.on = shown;
    this.legs.forEach((leg, i) => {
      const there = this.last.feet[i] !== null;
      leg.number.visible = there && shown.numbers;
      leg.name.visible = there && shown.names;
    });
    this.frames.forEach((one) => one.traverse((object) => (object.visible = shown.axes)));
    if (this.ellipsoid) this.ellipsoid.visible = shown.ellipsoid;
    const screw = shown.screw ? this.last.screw : null;
    this.screw.visible = this.pitch.visible = screw !== null;
    if (screw) {
      // The part of the axis that is nearest to the platform.
      const axis = vector(screw, 3), near = vector(screw).divideScalar(this.size);
      near.addScaledVector(axis, axis.dot(this.platform.position.clone().sub(near)));
      this.screw.geometry.setFromPoints([near.clone().addScaledVector(axis, -1.2), near.clone().addScaledVector(axis, 1.2)]);
      this.screw.computeLineDistances();
      this.pitch.position.copy(near).addScaledVector(axis, 0.6);
      this.pitch.element.textContent = "screw axis, pitch " + Number(screw[6].toPrecision(3));
    }
    this.draw();
  }

  // Show other assembly modes, all of them in the picture; an empty list removes them.
  ghosts(list) {
    const before = this.others?.children.length > 0;
    if (this.others) this.discard(this.others);
    this.others = new THREE.Group();
    list.forEach((spec) => this.others.add(ghost(spec, this.drawing, this.size)));
    this.world.add(this.others);
    if (before !== list.length > 0 && (list.length || !this.touched)) this.fit(this.arm().normalize());
    this.draw();
  }

  // Show a region of positions; null removes it.
  reach(spec) {
    if (this.region) this.discard(this.region);
    this.region = spec ? surface(spec, this.size) : null;
    if (spec) this.world.add(this.region);
    this.draw();
  }

  look(name) {
    this.named = name;
    this.touched = false;
    this.fit(vector(VIEWS[name]).normalize());
    this.draw();
  }

  // From the middle of the picture to the camera.
  arm() {
    return this.camera.position.clone().sub(this.controls.target);
  }

  // Put the camera where the whole mechanism is in the picture, in a direction from its middle.
  fit(direction) {
    const box = new THREE.Box3();
    [this.base, this.top, ...this.legs.flatMap((leg) => leg.ends)].forEach((one) => box.expandByObject(one));
    // Frame and ellipsoid of a platform whose origin is far from its anchors would shrink the mechanism.
    [this.frames[1], this.ellipsoid].forEach((one) => {
      const its = one ? new THREE.Box3().setFromObject(one) : box;
      const both = box.clone().union(its).getBoundingSphere(new THREE.Sphere());
      if (both.radius < WITH_FRAME * box.getBoundingSphere(new THREE.Sphere()).radius) box.union(its);
    });
    const own = box.getBoundingSphere(new THREE.Sphere()), far = AWAY * own.radius;
    this.others?.children.forEach((one) => {
      const its = new THREE.Box3().setFromObject(one), ball = its.getBoundingSphere(new THREE.Sphere());
      if (ball.center.distanceTo(own.center) + ball.radius < far) box.union(its);
    });
    const ball = box.getBoundingSphere(new THREE.Sphere());
    const aspect = Math.min(1, this.camera.aspect);
    const distance = (0.98 * ball.radius) / Math.sin((this.camera.fov * Math.PI) / 360) / aspect;
    this.camera.position.copy(ball.center).addScaledVector(direction, distance);
    this.controls.target.copy(ball.center);
    this.controls.update();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (!width || !height) return;
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(width, height, false);
    this.texts.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.touched) this.look(this.named || "space");
    this.draw();
  }

  key(event) {
    const turns = { ArrowLeft: [-0.12, 0], ArrowRight: [0.12, 0], ArrowUp: [0, -0.12], ArrowDown: [0, 0.12] };
    const zoom = { "+": 0.9, "-": 1.1 }[event.key], way = turns[event.key];
    if (!zoom && !way) return;
    event.preventDefault();
    const arm = this.arm();
    if (zoom) arm.multiplyScalar(zoom);
    else {
      const round = new THREE.Spherical().setFromVector3(new THREE.Vector3(arm.y, arm.z, arm.x));
      round.theta += way[0];
      round.phi = Math.min(Math.max(round.phi + way[1], 0.01), Math.PI - 0.01);
      const turned = new THREE.Vector3().setFromSpherical(round);
      arm.set(turned.z, turned.x, turned.y);
    }
    this.touched = true;
    this.camera.position.copy(this.controls.target).add(arm);
    this.controls.update();
  }

  draw() {
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => {
      this.waiting = null;
      this.render();
    });
  }

  render() {
    this.renderer.render(this.scene, this.camera);
    this.texts.render(this.scene, this.camera);
    if (this.pitch.visible) this.keepInside(this.pitch);
  }

  // Move a label that would be cut off at an edge of the picture.
  keepInside(text) {
    const { clientWidth: width, clientHeight: height } = this.root, { style, offsetWidth, offsetHeight } = text.element;
    const at = text.getWorldPosition(new THREE.Vector3()).project(this.camera);
    const moved = (x, most, size) => Math.min(Math.max(x, size / 2 + EDGE), most - size / 2 - EDGE) - x;
    style.marginLeft = `${moved(((at.x + 1) * width) / 2, width, offsetWidth)}px`;
    style.marginTop = `${moved(((1 - at.y) * height) / 2, height, offsetHeight)}px`;
  }

  picture(name) {
    snapshot(this).toBlob((blob) => save(blob, name));
  }

  // Save a motion, "gif" or "video": a list of places, evenly in time, over so many seconds.
  async film(kind, places, seconds, name) {
    const last = this.last;
    try {
      return await film(this, kind, places, seconds, name);
    } finally {
      this.move(last);
    }
  }
}
